"""Tests the effect selection: random scenes at several tolerances against all applicable effects.

Each scene is drawn from the seed and its number, log-uniformly over materials, sizes and speeds.
The reference is a quasi-static simulation of the same scene with every applicable effect.
"""

import random
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from derivation.checks.random_scenes import Scene, largest_change, log_uniform_draw
from derivation.engine.activity import Progress, quiet
from derivation.engine.files import measurements
from derivation.engine.measure.result import CheckResult, all_passed
from derivation.engine.outputs import json_by_line, plain_rows
from derivation.engine.text import paragraph
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.effects import EFFECTS
from derivation.scene.errors import SceneError
from derivation.scene.impact import selected_effects
from derivation.scene.model import model_of
from derivation.scene.scene import read
from derivation.scene.selection.method_selection import moved, solve_selected

MEASURED: Path = measurements() / "effects.json"
SEED = 1
TOLERANCES = (1e-2, 1e-4, 1e-6, 1e-9)
COLUMNS = (
    "#rtol", "#scenes", "#of rtol", "#of bound", "result", "#effects", "#rejected",
)  # fmt: skip
NOTE = (
    "of rtol, of bound: largest difference from the simulation with all applicable effects, as a "
    "fraction of the tolerance and of the stated bound; result: the one with the largest fraction "
    "of rtol; effects: mean number of included/applicable effects."
)
"""Explanation of `COLUMNS`."""


@dataclass(frozen=True)
class EffectCheckRow:
    """The largest differences at one tolerance.

    Parameters
    ----------
    rtol
        The tolerance.
    scenes
        Number of compared scenes: within the range of the models, and not rejected.
    error_over_rtol
        Largest relative difference from the reference, over the tolerance [1].
    error_over_bound
        Largest relative difference over the stated bound [1].
    included
        Mean number of included effects, Hertz's contact not counted.
    applicable
        Mean number of applicable effects, Hertz's contact not counted.
    quantity, number
        The result and the scene with the largest `error_over_rtol`.
    rejected
        Number of scenes that were rejected at this tolerance.
    """

    rtol: float
    scenes: int
    error_over_rtol: float
    error_over_bound: float
    included: float
    applicable: float
    quantity: str
    number: int
    rejected: int

    @property
    def passed(self) -> bool:
        """Whether no difference exceeds its tolerance or its bound."""
        return self.error_over_rtol <= 1.0 and self.error_over_bound <= 1.0


def check_effects(count: int, progress: Progress = quiet) -> CheckResult:
    """Compare `count` random scenes at several tolerances with all applicable effects."""
    rows = judge(count, progress=progress)
    cells = [
        (f"{r.rtol:g}", r.scenes, f"{r.error_over_rtol:.3f}", f"{r.error_over_bound:.3f}",
         r.quantity, f"{r.included:.1f}/{r.applicable:.1f}", r.rejected)
        for r in rows
    ]  # fmt: skip
    return CheckResult(
        f"Effect selection in {count} scenes",
        COLUMNS,
        cells,
        lambda: plain_rows(rows),
        all_passed(rows),
        note=paragraph(NOTE, 0),
        recorded=lambda: json_by_line(
            {"drawn": count, "seed": SEED, "rows": plain_rows(rows)}, "rows"
        ),
    )


def scene(number: int, seed: int = SEED) -> dict[str, dict[str, Any]]:
    """Return the scene with a number.

    Over the plate radius, the sphere radius is 0.01 to 10 and half the thickness 0.001 to 10.
    """
    generator = random.Random(f"effects {seed} {number}")
    spread = log_uniform_draw(generator)
    b = spread(1e-2, 10.0)
    plate: dict[str, Any] = {
        "radius": b,
        "half_thickness": b * spread(1e-3, 10.0),
        "youngs_modulus": spread(1e7, 1e12),
        "poissons_ratio": generator.uniform(-0.5, 0.49),
        "edge": generator.choice(["paper", "simply-supported", "clamped"]),
    }
    sphere: dict[str, Any] = {"radius": b * spread(1e-2, 10.0), "density": spread(500.0, 2e4)}
    if generator.random() < 0.6:
        sphere["material"] = generator.choice(["steel", "glass", "aluminium", "concrete", "PMMA"])
    impact: dict[str, Any] = {"speed": spread(1e-3, 50.0)}
    if generator.random() < 0.5:
        impact["gravity"] = 9.81
    if generator.random() < 0.3:
        # From negligible to large compared with the time in which the sphere moves by its radius.
        plate["retardation_time"] = sphere["radius"] / impact["speed"] * spread(1e-12, 1e-1)
    effects = {"inertia": False}  # `check inertia` tests plate inertia
    return {"sphere": sphere, "plate": plate, "impact": impact, "effects": effects}


def judge(count: int, seed: int = SEED, progress: Progress = quiet) -> tuple[EffectCheckRow, ...]:
    """Simulate `count` scenes at every tolerance; return a row for each tolerance.

    Scenes outside the range of the models are skipped.
    """
    rows_by_tolerance: dict[float, list[EffectCheckRow]] = {rtol: [] for rtol in TOLERANCES}
    rejected = dict.fromkeys(TOLERANCES, 0)
    for number in range(count):
        progress("scene", number + 1, count)
        data = scene(number, seed)
        full_impact = all_effects_impact(data)
        if full_impact is None:
            continue
        true, applicable = full_impact
        for rtol in TOLERANCES:
            solved = selected_impact(data, rtol)
            if solved is None:
                rejected[rtol] += 1
                continue
            values, effects, bound = solved
            error, name = largest_change(values, true)
            more = len(effects) - 1, len(applicable) - 1
            rows_by_tolerance[rtol].append(
                EffectCheckRow(rtol, 1, error / rtol, error / bound, *more, name, number, 0)
            )
    return tuple(_combined_row(rows, rejected[rtol]) for rtol, rows in rows_by_tolerance.items())


def _combined_row(rows: Sequence[EffectCheckRow], rejected: int) -> EffectCheckRow:
    """Combine the rows of single scenes at one tolerance."""
    return replace(
        max(
            rows,
            key=lambda row: (row.error_over_rtol, row.error_over_bound, row.quantity, row.number),
        ),
        scenes=len(rows),
        error_over_bound=max(row.error_over_bound for row in rows),
        included=sum(row.included for row in rows) / len(rows),
        applicable=sum(row.applicable for row in rows) / len(rows),
        rejected=rejected,
    )


def selected_impact(
    data: Scene, rtol: float
) -> tuple[Sequence[float], Sequence[str], float] | None:
    """Return results, included effects and bound of `simulate` for a scene at a tolerance.

    The bound does not contain model errors. Returns None if the scene is rejected.
    """
    _, selected = selected_effects(read(data), rtol)
    try:
        values, accuracy = solve_selected(selected, rtol)
    except SceneError:
        return None
    return values, sorted(selected.law.effects), accuracy.bound


def all_effects_impact(data: Scene) -> tuple[Sequence[float], Sequence[str]] | None:
    """Return results and effects of a scene with every applicable effect, on a quasi-static plate.

    Returns None outside the range of the models.
    """
    model = model_of(read(data))
    present = sorted(
        e.name for e in EFFECTS if not e.not_applicable_reason(model) and e.name != "inertia"
    )
    try:
        motion = moved(ContactLaw(model, frozenset(present)))
    except SceneError:
        return None
    return motion.numbers, present
