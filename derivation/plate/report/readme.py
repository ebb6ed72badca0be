"""The README's measured numbers: a block between two markers, from the committed measurement."""

from collections.abc import Iterator, Mapping
from textwrap import wrap
from typing import Any

from derivation.plate.report.accuracy import duration

Data = Mapping[str, Any]

BEGIN = "<!-- measured: `platecontact report` writes this block -->"
END = "<!-- end of what was measured -->"

DIGITS = (3, 6, 9, 12, 15)


def renewed(text: str, data: Data) -> str:
    """A README with its block written anew.

    Raises
    ------
    ValueError
        If the markers are not there, once each and in order.
    """
    before, begin, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not (begin and end) or BEGIN in after or END in before + after:
        raise ValueError(f"expected in the README, once each: {BEGIN} and {END}")
    return "\n".join([before + BEGIN, *lines(data), END + after])


def lines(data: Data) -> Iterator[str]:
    """The headline, the law's cheapest methods, and what an impact costs."""
    yield from wrap(headline(data), 95)
    yield ""
    yield f"| digits of the law, {case(data)} | cheapest method in arrays | a point |"
    yield "|---|---|---|"
    yield from winners(data)
    yield ""
    yield "| impact by method of `simulate` | one scene | of many, each | how many |"
    yield "|---|---|---|---|"
    yield from impacts(data)


def case(data: Data) -> str:
    """The regime shown: the paper's, unless a scene took its place."""
    return str(data["regimes"][1]["name"])


def headline(data: Data) -> str:
    """The generated law over the best direct summation."""
    found = data["headline"]
    best = found["reached"][-1]
    return (
        f"Measured on {data['machine']['processor']}: the generated law gives "
        f"{found['digits']:.1f} digits in {time(found['called'])} a point; direct summation takes "
        f"{best['modes']:,} modes and {time(best['seconds'])} for {best['digits']} digits, "
        f"{best['seconds'] / found['called']:.2g} times as long."
    )


def winners(data: Data) -> Iterator[str]:
    """Rows of the law's cheapest methods in arrays."""
    for won in data["pareto"]:
        mine = (won["task"], won["regime"], won["kind"]) == ("law", case(data), "vector")
        if mine and won["digits"] in DIGITS:
            name = ", ".join(part for part in (won["family"], won["setting"]) if part)
            tied = f" (or {', '.join(won['ties'])})" if won["ties"] else ""
            yield f"| {won['digits']} | {name}{tied} | {time(won['seconds'])} |"


def impacts(data: Data) -> Iterator[str]:
    """Rows of what scenes cost: the first and the last of each growth."""
    for growth in data["scaling"]:
        if growth["what"] == "scenes":
            sizes, seconds = growth["x"], growth["seconds"]
            each = time(seconds[-1] / sizes[-1])
            yield f"| {growth['method']} | {time(seconds[0] / sizes[0])} | {each} | {sizes[-1]:,} |"


def time(seconds: float) -> str:
    """A time to two figures, as plain text."""
    return duration(seconds).replace(r"\,", " ").replace(r"$\mu$s", "us")
