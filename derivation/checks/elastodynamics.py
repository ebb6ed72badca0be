"""Comparison of simulated impacts with recorded finite-element solutions of the same scenes."""

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from derivation.checks.finite_elements import record
from derivation.checks.finite_elements.impact import largest_stress
from derivation.checks.finite_elements.record import BEST, MEASURED, RESULTS
from derivation.engine.activity import Progress, quiet
from derivation.engine.files import expect_writable, write_file
from derivation.engine.measure.result import CheckResult, all_passed
from derivation.engine.outputs import plain_rows
from derivation.engine.text import aligned, paragraph
from derivation.scene.dynamic.back_face import StressHistory
from derivation.scene.dynamic.model_error import ROUGHLY_RESOLVED, inertia_error, stress_error
from derivation.scene.errors import SceneError
from derivation.scene.impact import simulate
from derivation.scene.scene import OUTPUTS, read

STRESS = "max_tensile_stress"
COLUMNS = ("edge", "worst result", "#difference", "#allowed", "#contacts", "passed")
NOTE = (
    "difference: of the simulation from the finite elements, relative; worst result: the one with "
    "the largest difference over the allowed one; allowed: sum of error bound, model error and "
    "finite-element error; contacts: number in finite elements/simulation."
)
"""Explanation of `COLUMNS`."""


@dataclass(frozen=True)
class ComparedCase:
    """A case with the differences between simulation and finite-element solution.

    Parameters
    ----------
    name
        Name of the case.
    differences
        Relative difference of each result from that of the finite elements [1].
    errors
        Estimated relative errors of the finite-element results [1].
    bound, model_error
        Error bound and model error stated by the simulation [1].
    stress_error
        Error of the largest tensile stress stated by the simulation, apart from the bound [1].
    contacts
        Number of contacts in the finite-element solution and in the simulation.
    rejected
        The error message if the simulation rejects the scene; then there are no differences.
    """

    name: str
    differences: Mapping[str, float]
    errors: Mapping[str, float]
    bound: float
    model_error: float
    stress_error: float
    contacts: tuple[int, int]
    rejected: str = ""

    @property
    def excess(self) -> dict[str, float]:
        """Difference over the allowed difference, for each result [1]."""
        return {k: abs(x) / self.allowed(k) for k, x in self.differences.items()}

    @property
    def worst(self) -> str:
        """The result with the largest difference over the allowed one."""
        return max(self.excess, key=self.excess.__getitem__)

    @property
    def passed(self) -> bool:
        """Whether no difference is larger than allowed, or the scene is rejected."""
        return bool(self.rejected) or max(self.excess.values()) <= 1.0

    def allowed(self, name: str) -> float:
        """Return the allowed difference of a result: the sum of all stated errors [1]."""
        stated = self.stress_error if name == STRESS else self.model_error
        return self.bound + stated + self.errors[name]


def compare(
    path: Path = MEASURED, *, save: bool = False, progress: Progress = quiet
) -> tuple[ComparedCase, ...]:
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


def result(cases: Sequence[ComparedCase]) -> CheckResult:
    """Return the cases as lines of text, and those that are rejected."""
    rejected = [f"{case.name}: {case.rejected}" for case in cases if case.rejected]
    return CheckResult(
        "Impacts against finite elements",
        (),
        (),
        lambda: plain_rows(cases),
        all_passed(cases),
        note=paragraph(NOTE, 0),
        listings=[
            ("Impacts against finite elements", table(cases)),
            (f"{len(rejected)} rejected", rejected),
        ],
    )


def table(cases: Sequence[ComparedCase]) -> list[str]:
    """Return the cases in lines of at most 80 columns, below the name of their group."""
    head, rule, *rows = aligned(COLUMNS, [cells(case) for case in cases]).splitlines()
    lines = [f"  {head}", f"  {rule}"]
    names = (case.name.rpartition(" ")[0] for case in cases)
    for group, numbered in itertools.groupby(zip(names, rows, strict=True), lambda x: x[0]):
        lines += [group, *(f"  {row}" for _, row in numbered)]
    return lines


def simulated(row: Mapping[str, Any]) -> dict[str, Any]:
    """Return the simulated results of a recorded case, with plate inertia.

    No tolerance is given, and the program selects the numbers of modes and branches.
    """
    # The finite elements are linear.
    effects = {
        "spherical_profile": row["spherical_profile"], "inertia": True, "stretching": False,
    }  # fmt: skip
    try:
        result = simulate(read({**row["scene"], "effects": effects}))
    except SceneError as error:
        return {"rejected": str(error)}
    dynamics = result.dynamics
    assert dynamics is not None  # inertia is required
    values: dict[str, float] = {name: getattr(result, name) for name in (*OUTPUTS, STRESS)}
    values["total_time"] = dynamics.inertia.total_time
    if dynamics.back_face.course is not None:
        values[STRESS] = smoothed_peak(dynamics.back_face.course, result.contact_time)
    # Finite elements are linear: the errors by stretching are not included.
    impact = result.model, result.max_contact_radius, result.contact_time
    return {
        "branches": dynamics.law.model.inertia.branches,
        "values": {name: _rounded(values[name], 8) for name in RESULTS},
        "bound": _rounded(result.accuracy.bound, 3),
        "model_error": _rounded(max(inertia_error(*impact).values()), 3),
        "stress_error": _rounded(dynamics.back_face.error + stress_error(*impact), 3),
        "contacts": len(dynamics.inertia.contacts),
    }


def smoothed_peak(course: StressHistory, contact_time: float) -> float:
    """Return the largest stress [Pa] of a time history, smoothed like that of finite elements.

    Otherwise the smoothing would be part of the difference.
    """
    last = float(course.times[-1])
    times = np.linspace(0.0, last, 1 + math.ceil(BEST.steps * last / contact_time))
    return largest_stress(times, np.interp(times, *course), contact_time, last)


def _rounded(value: float, digits: int) -> float | None:
    """Return a number with few digits for the record; None if it is not finite."""
    return float(f"{value:.{digits}g}") if math.isfinite(value) else None


def compared(row: Mapping[str, Any]) -> ComparedCase:
    """Return a case with its differences, from a recorded row with the simulated results."""
    program = row["program"]
    if "rejected" in program:
        return ComparedCase(
            row["name"], {}, {}, 0.0, 0.0, 0.0, (row["contacts"], 0), program["rejected"]
        )
    names = _compared_results(row)
    differences = {k: program["values"][k] / row["elements"][k] - 1.0 for k in names}
    errors = {k: row["errors"][k] for k in names}
    stated = program["bound"], program["model_error"], program["stress_error"]
    contacts = (row["contacts"], program["contacts"])
    return ComparedCase(row["name"], differences, errors, *stated, contacts)


def _compared_results(row: Mapping[str, Any]) -> Sequence[str]:
    """Return the names of the compared results; total time and contact radius have no bound.

    The tensile stress is compared if the finite elements resolve it and the simulation states it.
    """
    names = [name for name in OUTPUTS if name in row["elements"] and name != "max_contact_radius"]
    stated = row["program"]["values"][STRESS] is not None
    return [*names, STRESS] if stated and row["errors"][STRESS] <= ROUGHLY_RESOLVED else names


def cells(case: ComparedCase) -> tuple[str, ...]:
    """Return a case's entries under `COLUMNS`, as text."""
    edge = case.name.rpartition(" ")[2]
    if case.rejected:
        return (edge, "rejected", "", "", "", "")
    worst = case.worst
    return (
        edge,
        worst,
        f"{case.differences[worst]:+.1e}",
        f"{case.allowed(worst):.1e}",
        f"{case.contacts[0]}/{case.contacts[1]}",
        "yes" if case.passed else "NO",
    )
