"""Table of the report: error bounds of random impacts with plate inertia."""

from collections.abc import Mapping
from typing import Any

from derivation.engine.report.latex import escape


def inertia_context(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of the template from the measurement."""
    refused = data["refused"]
    return {
        "drawn": data["drawn"],
        "compared": len(data["rows"]),
        "refused": sum(refused.values()),
        "reasons": ", ".join(rf"{n} by \texttt{{{escape(key)}}}" for key, n in refused.items()),
        "passed": sum(data["passed_over"].values()),
        "most_contacts": max(row["contacts"] for row in data["rows"]),
        "rows": [_row(side) for side in data["sides"]],
    }


def _row(side: Mapping[str, Any]) -> str:
    """Return the cells of one side of the selection threshold."""
    cells = [
        side["dissipation"],
        "included" if side["included"] else "omitted",
        str(side["scenes"]),
    ]
    cells += [f"{side[key]:.2f}" for key in ("ratio", "tightest", "price")]
    return " & ".join([*cells, escape(side["quantity"].replace("_", " "))])
