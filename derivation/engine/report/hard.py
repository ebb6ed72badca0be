"""The hard cases in the report: a table of groups, and a table of the cases of each group."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.report.latex import escape
from derivation.engine.report.sentences import typeset_sentence

SHOWN = 7
"""Number of digits of a reference that are shown; the data contain more."""

_DECIMAL = re.compile(r"(-?)(\d*)\.?(\d*)(?:e([+-]?\d+))?$")


def hard_context(data: Mapping[str, Any], vocabulary: Vocabulary) -> dict[str, Any]:
    """Return the context of the section: groups in order of appearance, with their cases."""
    groups: dict[str, list[Mapping[str, Any]]] = {}
    for case in data["cases"]:
        groups.setdefault(case["group"], []).append(case)
    return {
        "count": len(data["cases"]),
        "digits": data["provenance"]["digits"],
        "failed": sum(not case["passed"] for case in data["cases"]),
        "summary": [summary_row(name, cases, vocabulary) for name, cases in groups.items()],
        "nearest": [case_row(max(cases, key=used), vocabulary) for cases in groups.values()],
        "groups": [
            {
                "name": typeset_sentence(name, vocabulary),
                "rows": [case_row(case, vocabulary) for case in cases],
            }
            for name, cases in groups.items()
        ],
    }


def summary_row(name: str, cases: Sequence[Mapping[str, Any]], vocabulary: Vocabulary) -> str:
    """Return the cells of a group: number of cases, largest errors, number of failed cases."""
    printed = [float(case["printed"]) for case in cases if case["printed"] is not None]
    failed = sum(not case["passed"] for case in cases)
    cells = [typeset_sentence(name, vocabulary), str(len(cases)), error(max(map(used, cases)))]
    return " & ".join([*cells, error(max(printed)) if printed else "", str(failed)])


def used(case: Mapping[str, Any]) -> float:
    """Return error over allowance of a case; without an allowance the error in ULP."""
    return float(case["error"]) / float(case["allowed"] or 1)


def case_row(case: Mapping[str, Any], vocabulary: Vocabulary) -> str:
    """Return the cells of a case: function, cause, reference, errors; then its exact inputs."""
    note = "" if case["passed"] else r" \textbf{Failed.}"
    kernel = rf"\texttt{{{escape(case['kernel'])}}}"
    cause = typeset_sentence(case["cause"], vocabulary)
    cells = [f"{kernel}: {cause}{note}", references(case["references"])]
    printed = "" if case["printed"] is None else error(case["printed"])
    first = " & ".join([*cells, error(case["error"]), printed, error(case["allowed"])])
    return rf"{first}\kept{chr(10)}\given{{{inputs(case)}}}"


def inputs(case: Mapping[str, Any]) -> str:
    """Return the exact arguments and their form; lines may be broken between numbers."""
    forms = "" if case["form"] == "scalar" else f" ({case['form']})"
    modes = f", modes = {case['modes']}" if "modes" in case else ""
    given = [
        rf"\texttt{{{escape(name)} = {r', '.join(map(hexadecimal, texts)) or 'none'}}}"
        for name, texts in case["inputs"].items()
    ]
    return "; ".join(given) + escape(modes + forms)


def hexadecimal(text: str) -> str:
    """Return a hexadecimal double without trailing zeros of the significand."""
    return re.sub(r"\.?0+p", "p", text)


def references(stored: Sequence[Mapping[str, str]]) -> str:
    """Return the first reference value as LaTeX, and the number of further ones."""
    if not stored:
        return "none"
    more = f", {len(stored) - 1} more" if len(stored) > 1 else ""
    return reference(stored[0]["value"]) + more


def reference(text: str) -> str:
    """Return a decimal number as LaTeX, truncated to the digits shown."""
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
    """Return an error as LaTeX: two decimals, or a power of ten; "0" means exactly zero."""
    number = float(value)
    if number == 0:
        return "0"
    if number == float("inf"):
        return r"$\infty$"
    if number and (number < 1e-2 or number >= 1e3):
        mantissa, _, exponent = f"{number:.1e}".partition("e")
        return rf"${mantissa}\cdot10^{{{int(exponent)}}}$"
    return f"{number:.2f}"
