"""Table of the report: files of measurements, their commands, and their provenance."""

import hashlib
from collections.abc import Iterator, Mapping
from typing import Any

from derivation.engine.report.latex import escape

UPDATE_COMMANDS = {
    "accuracy": "platecontact benchmark --update",
    "bounds": "platecontact check error-bounds -n 2000 --update",
    "check": "platecontact check --update",
    "contact": "platecontact check contact-law --update",
    "edge_remainder": "python -m derivation.plate.edge.remainder",
    "edge_strip": "python -m derivation.plate.edge.strip",
    "effects": "platecontact check effects -n 3000 --update",
    "elastodynamics": "python -m derivation.checks.finite_elements",
    "hard": "platecontact check hard-cases --update",
    "inertia": "platecontact check inertia -n 600 --seed 3 --update",
    "moving": "platecontact benchmark --dynamic --update",
    "rewrite": "platecontact rewrite --update",
    "speed": "platecontact check timing --update",
}
"""Command that repeats a measurement."""
DIGITS = 16
COUNTS = ("cores", "digits", "modes")
"""Values that are shown before their names."""


def reproducibility_context(
    data: Mapping[str, bytes], measured: Mapping[str, Mapping[str, Any]]
) -> dict[str, Any]:
    """Return a row for each file, and the provenance that each states."""
    return {
        "files": [file_row(name, content) for name, content in sorted(data.items())],
        "provenance": [
            {"name": f"{name}.json", "says": ", ".join(_provenance_text(values))}
            for name, values in sorted(measured.items())
            if values.keys() & {"provenance", "machine"}
        ],
    }


def file_row(name: str, content: bytes) -> str:
    """Return name, command, size and hash."""
    command = escape(UPDATE_COMMANDS.get(name, "")).replace("--", "-{}-")
    digest = hashlib.sha256(content).hexdigest()[:DIGITS]
    shown = rf"\texttt{{{command}}}" if command else "see CONTRIBUTING.md"
    return rf"\texttt{{{escape(name)}.json}} & {shown} & {len(content)} & \texttt{{{digest}}}"


def _provenance_text(values: Mapping[str, Any]) -> Iterator[str]:
    provenance, machine = values.get("provenance", {}), values.get("machine", {})
    others = {name: value for name, value in machine.items() if name not in provenance}
    for name, value in (*sorted(provenance.items()), *sorted(others.items())):
        if name == "generated":
            yield f"the package with the hash {escape(str(value)[:DIGITS])}"
        elif name in COUNTS:
            yield f"{escape(str(value))} {escape(name)}"
        else:
            yield f"{escape(name)} {escape(str(value))}"
