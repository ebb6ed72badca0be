"""Compares simulated impacts with the recorded finite-element solutions of the same scenes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from derivation.checks.finite_elements import record
from derivation.checks.finite_elements.record import MEASURED, RESULTS
from derivation.engine.activity import Progress, quiet
from derivation.engine.files import expect_writable, write_file
from derivation.engine.measure.result import CheckResult, all_kept
from derivation.engine.outputs import plain_rows
from derivation.scene.impact import simulate
from derivation.scene.scene import OUTPUTS, SceneError, read

COLUMNS = (
    "case", "#finite-element error", "#difference", "worst result", "#bound", "#model error",
    "#contacts", "passed",
)  # fmt: skip


@dataclass(frozen=True)
class Compared:
    """A case with the differences between simulation and finite-element solution.

    Parameters
    ----------
    name
        Name of the case.
    differences
        Relative difference of each result from that of the finite elements [1].
    errors
        Relative errors of the finite elements [1].
    bound, model_error
        Error bound and model error stated by the simulation [1].
    contacts
        Number of contacts, of the finite elements and of the simulation.
    refused
        The error message if the simulation rejects the scene; then all else is empty.
    """

    name: str
    differences: Mapping[str, float]
    errors: Mapping[str, float]
    bound: float
    model_error: float
    contacts: tuple[int, int]
    refused: str = ""

    @property
    def excess(self) -> dict[str, float]:
        """Difference over the sum of bound, model error and finite-element error [1]."""
        stated = self.bound + self.model_error
        return {k: abs(self.differences[k]) / (stated + self.errors[k]) for k in self.differences}

    @property
    def worst(self) -> str:
        """The result with the largest difference over the allowed one."""
        return max(self.excess, key=self.excess.__getitem__)

    @property
    def kept(self) -> bool:
        """Whether no difference is larger than allowed."""
        return bool(self.refused) or max(self.excess.values()) <= 1.0


def compare(
    path: Path = MEASURED, *, save: bool = False, progress: Progress = quiet
) -> tuple[Compared, ...]:
    """Simulate every recorded case, without finite elements; save the results if requested.

    Raises
    ------
    ValueError
        If nothing is recorded.
    """
    data = record.read(path)
    if not data["impacts"]:
        raise ValueError(
            f"{path}: expected recorded cases, got none; "
            "run `python -m derivation.checks.finite_elements`"
        )
    if save:
        expect_writable(path)
    rows = []
    for number, row in enumerate(data["impacts"]):
        progress(row["name"], number + 1, len(data["impacts"]))
        rows.append(row | {"program": simulated(row)})
    if save:
        write_file(path, record.to_json(data | {"impacts": rows}))
    return tuple(compared(row) for row in rows)


def result(found: Sequence[Compared]) -> CheckResult:
    """Return the cases as a table, and those that are rejected."""
    refused = [f"{case.name}: {case.refused}" for case in found if case.refused]
    return CheckResult(
        "Impacts against finite elements",
        COLUMNS,
        [cells(case) for case in found],
        lambda: plain_rows(found),
        all_kept(found),
        listings=[(f"{len(refused)} rejected", refused)],
    )


def simulated(row: Mapping[str, Any]) -> dict[str, Any]:
    """Return what `simulate` gives for a recorded case.

    Without a tolerance, with as many modes and branches as the program chooses.
    """
    effects = {"spherical_profile": row["spherical_profile"], "inertia": True}
    try:
        found = simulate(read({**row["scene"], "effects": effects}))
    except SceneError as error:
        return {"refused": str(error)}
    dynamics = found.dynamics
    assert dynamics is not None  # inertia is required
    values: dict[str, float] = {name: getattr(found, name) for name in OUTPUTS}
    values["total_time"] = dynamics.inertia.total_time
    return {
        "branches": dynamics.law.model.inertia.branches,
        "values": {name: float(f"{values[name]:.8g}") for name in RESULTS},
        "bound": float(f"{found.accuracy.bound:.3g}"),
        "model_error": float(f"{found.model_error:.3g}"),
        "contacts": len(dynamics.inertia.contacts),
    }


def compared(row: Mapping[str, Any]) -> Compared:
    """Return a case with its differences, from a row with the program's results."""
    program = row["program"]
    if "refused" in program:
        return Compared(row["name"], {}, {}, 0.0, 0.0, (row["contacts"], 0), program["refused"])
    names = _judged(row)
    differences = {k: program["values"][k] / row["elements"][k] - 1.0 for k in names}
    errors = {k: row["errors"][k] for k in names}
    contacts = (row["contacts"], program["contacts"])
    return Compared(
        row["name"], differences, errors, program["bound"], program["model_error"], contacts
    )


def _judged(row: Mapping[str, Any]) -> Sequence[str]:
    """Return the results with a bound, without total time and contact radius."""
    return [name for name in OUTPUTS if name in row["elements"] and name != "max_contact_radius"]


def cells(case: Compared) -> tuple[str, ...]:
    """Return a case's entries under `COLUMNS`, as text."""
    if case.refused:
        return (case.name, "", "", case.refused.partition(":")[0] + " rejected", "", "", "", "")
    worst, numbers = case.worst, case.contacts
    return (
        case.name,
        f"{case.errors[worst]:.1e}",
        f"{case.differences[worst]:+.1e}",
        worst,
        f"{case.bound:.1e}",
        f"{case.model_error:.1e}",
        f"{numbers[0]}/{numbers[1]}",
        "yes" if case.kept else "NO",
    )
