"""Tests impacts with plate inertia on random scenes, against twice the modes, all branches."""

import itertools
import math
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np

from derivation.checks import inertia_rows as inertia
from derivation.checks.inertia_rows import InertiaResults, InertiaRow
from derivation.checks.random_scenes import Scene, largest_change
from derivation.engine.activity import Progress, quiet
from derivation.engine.files import measurements
from derivation.engine.threads import one_thread
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import waves
from derivation.scene.dynamic.mode_count import count_of
from derivation.scene.dynamic.wave_motion import DynamicImpact
from derivation.scene.effects import EFFECTS
from derivation.scene.effects.effect import weight_work_ratio
from derivation.scene.effects.inertia import higher_branch_error
from derivation.scene.errors import SceneError
from derivation.scene.impact import selected_effects
from derivation.scene.model import InertiaSettings, Model, model_of
from derivation.scene.quasi_static import motion
from derivation.scene.scales import zener_number
from derivation.scene.scene import read
from derivation.scene.selection.effect_selection import decide
from derivation.scene.selection.method_selection import dynamic_impact, moved, solve_selected
from generated.inertia import bending_frequency

MEASURED: Path = measurements() / "inertia.json"
MAX_ZENER = 5.0
"""Largest Zener parameter of the scenes."""
MAX_WEIGHT_WORK = 100.0
"""Largest work of the sphere's weight over its initial kinetic energy, of the scenes."""
MODES = {"A0": 100, "all": 10}
"""Largest number of modes with which `simulate` begins, by branches; other scenes are skipped."""
MAX_MODES = 1300
"""Largest number of modes of the reference simulation."""
BOUND_RTOL, INERTIA_THRESHOLD = 1.0, 0.3
"""Tolerance with which the bound on the change by inertia is computed, and the value of that bound
from which inertia is included [1]."""
DYNAMIC_EFFECTS = frozenset(e.name for e in EFFECTS if "inertia" in (e.name, e.within))
"""Effects that a quasi-static plate lacks: plate inertia and its damping."""
BRANCH_BOUND_FACTOR, LEAST_RTOL = 3.0, 1e-4
"""Factor of the bound on the omitted branches, and summand, of the smallest tolerance [1]."""


def judge(count: int, seed: int = inertia.SEED, progress: Progress = quiet) -> InertiaResults:
    """Draw and simulate scenes until `count` of them are neither skipped nor rejected."""
    skipped, rejected, rows = Counter[str](), Counter[str](), list[InertiaRow]()
    for number in itertools.count():
        data, position = inertia.scene(number, seed)
        reason = reason_to_skip(data)
        if reason:
            skipped[reason] += 1
            continue
        progress("scene", len(rows) + 1, count)
        results = solve(number, data, position)
        if isinstance(results, str):
            rejected[results] += 1
            continue
        rows.append(results)
        if len(rows) == count:
            break
    return InertiaResults(number + 1, skipped, rejected, tuple(rows))


def reason_to_skip(data: Scene) -> str:
    """Return the reason for which a scene is skipped; empty if it is not."""
    model = replace(model_of(read(data)), inertia=InertiaSettings())
    if zener_number(model) > MAX_ZENER:
        return f"Zener parameter above {MAX_ZENER:g}"
    still = quasi_static(model)
    if still is None:
        return "no impact on the quasi-static plate"
    if weight_work_ratio(model, still.max_indentation) > MAX_WEIGHT_WORK:
        return f"work of the weight over the initial kinetic energy above {MAX_WEIGHT_WORK:g}"
    most = MODES[data["inertia"]["branches"]]
    if count_of(ContactLaw(model, frozenset({"hertz", "inertia"}))) > most:
        return "too many modes"
    return ""


def with_tolerance(data: Scene, position: float) -> tuple[Scene, float]:
    """Return a scene and its tolerance, from a number `position` in [0, 1).

    If the bound on the change by inertia is below `INERTIA_THRESHOLD`, and `position` is below 1/2
    or no tolerance that requires inertia can be met, the scene has all other effects and a
    tolerance with which inertia is omitted. Otherwise the tolerance can be met and, if possible,
    requires inertia.
    """
    model = model_of(read(data))
    still = quasi_static(model)
    assert still is not None  # such scenes are skipped
    others = dict.fromkeys(selectable_effects(model) - DYNAMIC_EFFECTS - {"hertz"}, True)
    omission_bound = decide(model, others | {"inertia": "auto"}, BOUND_RTOL).error
    radiated = max(
        map(float, higher_branch_error(model, still.max_contact_radius, still.contact_time))
    )
    least = (
        BRANCH_BOUND_FACTOR
        * radiated
        * (1.0 + float(weight_work_ratio(model, still.max_indentation)))
        + LEAST_RTOL
    )
    if omission_bound < INERTIA_THRESHOLD and (position < 0.5 or least > omission_bound):
        return {**data, "effects": {**others, "inertia": "auto"}}, omission_bound * (1.0 + position)
    return data, min(
        least * math.pow(10.0, 2.0 * position - 1.0),
        max(least, 0.9 * min(omission_bound, BOUND_RTOL)),
    )


def solve(number: int, data: Scene, position: float) -> InertiaRow | str:
    """Compare `simulate` with the reference; return the key of the error of a rejected scene.

    Parameters
    ----------
    number, data
        The scene.
    position
        A number in [0, 1) that determines the tolerance, see `with_tolerance`.
    """
    try:
        data, rtol = with_tolerance(data, position)
        # The reference is a plate that does not stretch.
        data = {**data, "effects": {**data.get("effects", {}), "stretching": False}}
        _, selected = selected_effects(read(data), rtol)
        values, accuracy = solve_selected(selected, rtol)
        known = "inertia" in selected.law.effects
        used = dynamic_impact(selected, rtol) if known else None
        model = replace(selected.law.model, inertia=InertiaSettings())
        modes = _modes(used or _moving(model, rtol))
        branches = "A0" if model.retardation_time else "all"
        # Even and odd numbers, because contributions of successive modes alternate in sign.
        twice = 2 * modes + number % 2
        many = replace(model, inertia=InertiaSettings(modes=twice, branches=branches))
        if mode_count(many) > MAX_MODES:
            return f"reference: more than {MAX_MODES} modes"
        reference = _moving(many, rtol)
    except SceneError as problem:
        return str(problem).partition(":")[0]
    if not reference.inertia.complete:
        return "reference: incomplete"
    still = quasi_static(model)
    assert still is not None  # such scenes are skipped
    [omission_bound] = [row.bound for row in selected.rows if row.name == "inertia"]
    total = used.inertia.total_time if used is not None else values[0]
    error, quantity = largest_change(values, reference.numbers)
    change, changed = largest_change(still.numbers, reference.numbers)
    lasted = abs(total / reference.inertia.total_time - 1.0)
    contacts, count = len(reference.inertia.contacts), reference.inertia.modes
    return InertiaRow(
        number, rtol, inertia.dissipation_of(data), known, accuracy.bound, error, quantity, lasted,
        omission_bound, change, changed, contacts, _modes(reference), count,
    )  # fmt: skip


def quasi_static(model: Model) -> motion.Motion | None:
    """Return the impact with every effect of a quasi-static plate; None outside its range."""
    try:
        return moved(ContactLaw(model, selectable_effects(model) - DYNAMIC_EFFECTS))
    except SceneError:
        return None


def selectable_effects(model: Model) -> frozenset[str]:
    """Return the names of all applicable effects that can be selected."""
    return frozenset(e.name for e in EFFECTS if e.selectable and not e.not_applicable_reason(model))


def mode_count(model: Model) -> int:
    """Return the approximate number of modes of all branches, by Weyl's law.

    Below the frequency Omega there are (2/pi) sqrt(Omega^2 - x^2) branches of shear waves, and
    likewise of pressure waves with gam Omega^2, where x = phi h = n pi eta.
    """
    modes, gam = model.inertia.modes, model.mu / (model.lam + 2.0 * model.mu)
    root = bending_frequency(np.array([modes * math.pi * model.eta]), model.poissons_ratio)
    return modes + int((1.0 + gam) * float(root[0]) ** 2 / (2.0 * math.pi * model.eta))


def _moving(model: Model, rtol: float) -> DynamicImpact:
    """Return the impact with every applicable effect."""
    with one_thread(), np.errstate(all="ignore"):
        return waves.impact(ContactLaw(model, selectable_effects(model)), waves.goal(rtol))


def _modes(impact: DynamicImpact) -> int:
    """Return the number of wave numbers of a simulation; each has a mode of every branch."""
    return len(np.unique(impact.impact_history.problem.contact.modes.phi))
