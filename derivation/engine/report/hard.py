"""The hard cases as the report shows them: a table of groups, and one of cases for each."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

from derivation.engine.report.latex import escape, prose

SHOWN = 7
"""Digits shown of a reference, of which the data hold more."""

_DECIMAL = re.compile(r"(-?)(\d*)\.?(\d*)(?:e([+-]?\d+))?$")


def hard_context(data: Mapping[str, Any]) -> dict[str, Any]:
    """Groups in the order in which they first come, each with its cases."""
    groups: dict[str, list[Mapping[str, Any]]] = {}
    for case in data["cases"]:
        groups.setdefault(case["group"], []).append(case)
    return {
        "count": len(data["cases"]),
        "digits": data["provenance"]["digits"],
        "failed": sum(not case["kept"] for case in data["cases"]),
        "summary": [summary_row(name, cases) for name, cases in groups.items()],
        "nearest": [case_row(max(cases, key=used)) for cases in groups.values()],
        "groups": [
            {"name": name, "rows": [case_row(case) for case in cases]}
            for name, cases in groups.items()
        ],
    }


def summary_row(name: str, cases: Sequence[Mapping[str, Any]]) -> str:
    """Cells of a group: how many cases, the largest errors, and how many failed."""
    printed = [float(case["printed"]) for case in cases if case["printed"] is not None]
    failed = sum(not case["kept"] for case in cases)
    cells = [prose(name), str(len(cases)), error(max(map(used, cases)))]
    return " & ".join([*cells, error(max(printed)) if printed else "", str(failed)])


def used(case: Mapping[str, Any]) -> float:
    """How much of what is allowed a case takes."""
    return float(case["error"]) / float(case["allowed"] or 1)


def case_row(case: Mapping[str, Any]) -> str:
    """Cells of a case: kernel and cause, reference, errors; below them its exact inputs."""
    note = "" if case["kept"] else r" \textbf{Failed.}"
    kernel = rf"\texttt{{{escape(case['kernel'])}}}"
    cells = [f"{kernel}: {prose(case['cause'])}{note}", references(case["references"])]
    printed = "" if case["printed"] is None else error(case["printed"])
    first = " & ".join([*cells, error(case["error"]), printed, error(case["allowed"])])
    return rf"{first}\kept{chr(10)}\given{{{inputs(case)}}}"


def inputs(case: Mapping[str, Any]) -> str:
    """Exact arguments and the form in which they come, to be broken between numbers."""
    forms = "" if case["form"] == "scalar" else f" ({case['form']})"
    modes = f", modes = {case['modes']}" if "modes" in case else ""
    given = [
        rf"\texttt{{{escape(name)} = {r', '.join(map(hexadecimal, texts)) or 'none'}}}"
        for name, texts in case["inputs"].items()
    ]
    return "; ".join(given) + escape(modes + forms)


def hexadecimal(text: str) -> str:
    """A hexadecimal double without the zeros at its end."""
    return re.sub(r"\.?0+p", "p", text)


def references(stored: Sequence[Mapping[str, str]]) -> str:
    """The first reference, and how many more there are."""
    if not stored:
        return "none"
    more = rf", +\,{len(stored) - 1}" if len(stored) > 1 else ""
    return reference(stored[0]["value"]) + more


def reference(text: str) -> str:
    """A decimal string cut to the digits shown."""
    match = _DECIMAL.fullmatch(text)
    if match is None:
        return {"nan": "NaN", "inf": r"$\infty$", "-inf": r"$-\infty$"}[text]
    sign, whole, part, power = match.groups()
    digits = (whole + part).lstrip("0")
    if not digits:
        return "$0$"
    place = len(whole) - 1 - (len(whole + part) - len(digits)) + int(power or 0)
    shown = digits[:SHOWN].ljust(2, "0").rstrip("0").ljust(2, "0")
    tail = "" if place == 0 else rf"\cdot10^{{{place}}}"
    cut = r"\ldots" if len(digits.rstrip("0")) > SHOWN else ""
    return rf"${sign}{shown[0]}.{shown[1:]}{cut}{tail}$"


def error(value: float | str) -> str:
    """Two figures or three, large ones as powers of ten; 0 is exact."""
    number = float(value)
    if number == 0:
        return "0"
    if number == float("inf"):
        return r"$\infty$"
    if number and (number < 1e-2 or number >= 1e3):
        mantissa, _, exponent = f"{number:.1e}".partition("e")
        return rf"${mantissa}\cdot10^{{{int(exponent)}}}$"
    return f"{number:.2f}"
