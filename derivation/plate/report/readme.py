"""Accuracy and run time from the benchmark record, for the README and the documentation site."""

from collections.abc import Iterator, Mapping
from textwrap import wrap
from typing import Any

from derivation.plate.report.accuracy import duration, shown_case

Data = Mapping[str, Any]

BEGIN = "<!-- measured: `platecontact report` writes this block -->"
END = "<!-- end of what was measured -->"

DIGITS = (3, 6, 9, 12, 15)


def updated_readme(text: str, data: Data) -> str:
    """Return the text of a README with a new block between its markers.

    Raises
    ------
    ValueError
        If the two markers do not occur once each, in this order.
    """
    before, begin, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not (begin and end) or BEGIN in after or END in before + after:
        raise ValueError(f"expected in the README, once each: {BEGIN} and {END}")
    return "\n".join([before + BEGIN, *wrap(headline(data), 95), END + after])


def lines(data: Data) -> Iterator[str]:
    """Yield the lines of the comparison, the fastest methods, and the run time of an impact."""
    yield from wrap(headline(data), 95)
    yield ""
    yield f"| correct digits (case `{shown_case(data)}`) | fastest method for arrays | per point |"
    yield "|---|---|---|"
    yield from winners(data)
    yield ""
    yield "Methods `hertz` and `leading` were timed as functions of one impact, called in a loop;"
    yield "`coarse` and `full` as a function of arrays. `simulate` evaluates all of them in arrays."
    yield ""
    yield "| method | one impact | each of many | number of impacts |"
    yield "|---|---|---|---|"
    yield from impacts(data)


def headline(data: Data) -> str:
    """Return a comparison of the generated law with the best direct summation."""
    row = data["headline"]
    best, with_setup = row["direct_sum"][-1], row["seconds_with_setup"]
    return (
        f"Measured on {data['machine']['processor']}: the generated contact law has "
        f"{row['digits']:.1f} correct digits and takes {time(with_setup)} per point. For "
        f"{best['digits']} digits, direct summation needs {best['modes']:,} modes and "
        f"{time(best['seconds'])}, {best['seconds'] / with_setup:.2g} times as long."
    )


def winners(data: Data) -> Iterator[str]:
    """Yield the rows of the law's fastest methods for arrays."""
    for won in data["pareto"]:
        mine = (won["task"], won["case"], won["kind"]) == ("law", shown_case(data), "vector")
        if mine and won["digits"] in DIGITS:
            name = ", ".join(part for part in (won["family"], won["setting"]) if part)
            tied = f" (or {', '.join(won['ties'])})" if won["ties"] else ""
            yield f"| {won['digits']} | {name}{tied} | {time(won['seconds'])} |"


def impacts(data: Data) -> Iterator[str]:
    """Yield the run times of impacts: of one, and of the largest number measured."""
    for growth in data["scaling"]:
        if growth["quantity"] == "scenes":
            sizes, seconds = growth["x"], growth["seconds"]
            each = time(seconds[-1] / sizes[-1])
            yield f"| {growth['method']} | {time(seconds[0] / sizes[0])} | {each} | {sizes[-1]:,} |"


def time(seconds: float) -> str:
    """Return a time to two figures as plain text."""
    return duration(seconds).replace(r"\,", " ").replace(r"$\mu$s", "µs")
