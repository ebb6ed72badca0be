"""Table of the report: error bounds of random impacts with plate inertia."""

from collections.abc import Mapping
from typing import Any

from derivation.engine.report.latex import escape

REASONS = {
    "rtol": "the tolerance cannot be met",
    "plate.edge": "the model error of the edge is too large",
    "reference: incomplete": "the reference simulation is incomplete",
}
"""Reasons for which scenes are rejected, by the key in the message."""


def inertia_context(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of the template from the measurement."""
    rejected, skipped = data["rejected"], data["skipped"]
    return {
        "drawn": data["drawn"],
        "compared": len(data["rows"]),
        "rejected": sum(rejected.values()),
        "reasons": ", ".join(f"{n}: {_reason(key)}" for key, n in rejected.items()),
        "skipped": sum(skipped.values()),
        "skipped_reasons": ", ".join(f"{n}: {escape(reason)}" for reason, n in skipped.items()),
        "contacts": _contacts(max(row["contacts"] for row in data["rows"])),
        "rows": [_row(side) for side in data["sides"]],
    }


def _reason(key: str) -> str:
    """Return why scenes were rejected; `key` begins the message of the program."""
    if key in REASONS:
        return REASONS[key]
    who, _, text = key.partition(": ")
    return f"the {who} needs {text}" if text else rf"\texttt{{{escape(key)}}}"


def _contacts(most: int) -> str:
    """Return the largest number of contacts as text."""
    return "each with one contact" if most == 1 else f"with up to {most} contacts"


def _row(side: Mapping[str, Any]) -> str:
    """Return the cells of one side of the selection threshold."""
    cells = [
        side["dissipation"],
        "included" if side["included"] else "omitted",
        str(side["scenes"]),
    ]
    cells += [
        f"{side[key]:.2f}" for key in ("error_over_rtol", "error_over_bound", "change_over_bound")
    ]
    return " & ".join([*cells, escape(side["quantity"].replace("_", " "))])
