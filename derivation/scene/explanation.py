"""Explains a scene: the required effects with parameters, error bounds and evaluation times."""

import math
import time
from contextlib import suppress
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np

from derivation.engine.text import paragraph
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import ZENER_LIMIT
from derivation.scene.effects import BY_NAME, EFFECTS
from derivation.scene.effects.effect import NO_BOUND, Effect
from derivation.scene.errors import SceneError
from derivation.scene.impact import selected_effects
from derivation.scene.numerics.quadrature import NODES, rule
from derivation.scene.quantity import prefixed, rounded_up
from derivation.scene.scales import zener_number
from derivation.scene.scene import Scene
from derivation.scene.selection.effect_selection import SelectedEffects, named


@dataclass(frozen=True)
class Explanation:
    """The effects table of a scene, computed without a simulation.

    Attributes
    ----------
    effects
        The included effects, and the effects table.
    evaluation_times
        For each included effect, the measured time [s] to evaluate the law with this effect alone
        at the nodes of an impact; for plate inertia and damping, to compute modes and tables.
    notes
        A remark about plate inertia.
    """

    effects: SelectedEffects
    evaluation_times: dict[str, float]
    notes: tuple[str, ...]

    def details(self) -> str:
        """Return the selected effects, then the effects table with run times."""
        times = {
            name: " ".join(prefixed(seconds, "s", RUN_TIME_DIGITS))
            for name, seconds in self.evaluation_times.items()
        }
        return f"{paragraph(str(self), 0)}\n\n{self.effects.to_text(times)}"

    def __str__(self) -> str:
        """Return the selected effects and the error bound of the omitted ones."""
        effects = ", ".join(self.effects.included)
        results = named(self.effects.outputs, "each result")
        most = rounded_up(self.effects.stated_error)
        omitted = (
            f"The omitted effects change {results} by at most {most} "
            f"(tolerance {self.effects.rtol:.3g})."
            if self.effects.omits
            else "No applicable effect was omitted automatically."
        )
        disabled = ", ".join(
            f"{row.name} ({_change(row.bound)})" for row in self.effects.rows if row.disabled
        )
        more = f" The scene disables {disabled}." if disabled else ""
        return f"Included effects: {effects}. {omitted}{more}"

    def to_json(self) -> dict[str, Any]:
        """Return effects, bound and table under fixed keys; evaluation times vary between runs."""
        return {
            "included": list(self.effects.included),
            "rtol": self.effects.rtol,
            "bound": self.effects.error if np.isfinite(self.effects.error) else None,
            "effects": [row.to_json() for row in self.effects.rows],
            "evaluation_times": self.evaluation_times,
            "notes": list(self.notes),
        }

    def _repr_html_(self) -> str:
        """Return the effects table for a notebook."""
        return f"<p>{escape(str(self))}</p>{self.effects.to_html()}"


def _change(bound: float) -> str:
    """Return the bound on the change by a disabled effect, in words."""
    return f"changes the results by at most {rounded_up(bound)}" if bound < NO_BOUND else "no bound"


RUN_TIME_DIGITS = 2
"""Significant digits of a run time that are shown."""
REPEATS, SHORT = 3, 1e-3
"""Largest number of timings, of which the shortest counts, and duration [s] that ends them."""


def explain(scene: Scene, rtol: float | None = None) -> Explanation:
    """Return the effects that a scene requires, with the reasons.

    Parameters
    ----------
    scene
        The scene, as `load` returns it.
    rtol
        Relative tolerance [1]; by default that of the scene, or 1e-3 if the scene has none.

    Returns
    -------
    Explanation
        The effects with parameters, error bounds and reasons.

    Raises
    ------
    SceneError
        If the tolerance is not between 1e-13 and 1, or a required effect cannot be computed.

    Examples
    --------
    >>> import platecontact as pc
    >>> scene = pc.Scene(
    ...     sphere=pc.Sphere(radius=0.01, material="steel"),
    ...     plate=pc.Plate(radius=0.3, thickness=0.05, material="glass"),
    ...     impact=pc.Impact(speed=1.0),
    ... )
    >>> "inertia" in pc.explain(scene).effects.included
    True
    """
    _, selected = selected_effects(scene, rtol)
    law = selected.law
    timed = [
        effect
        for effect in EFFECTS
        if effect in law.chosen
        and not effect.stretches  # it is not a part of the contact law
        and not (effect.dynamic and _has_most_modes(law))
    ]
    times = {effect.name: _evaluation_time(law, effect) for effect in timed}
    return Explanation(selected, times, (_inertia(selected),))


def _has_most_modes(law: ContactLaw) -> bool:
    """Return whether the first run has so many modes that their tables take long to compute."""
    from derivation.scene.dynamic.mode_count import MOST, count_of

    return count_of(law) >= MOST


def _evaluation_time(law: ContactLaw, effect: Effect) -> float:
    """Return the time [s] to evaluate the law with one effect alone at the nodes of an impact.

    For plate inertia, the time to compute its modes and tables.
    """
    a = rule(NODES[0]).x * min(law.limit, law.model.h)
    alone = law.only(lambda e: e.always_included or e == effect)
    best = math.inf
    with np.errstate(all="ignore"):
        for _ in range(REPEATS):
            start = time.perf_counter()
            if effect.dynamic:
                from derivation.scene.dynamic import mode_count
                from derivation.scene.dynamic.wave_problem import problem_of

                problem_of(law, mode_count.finer(law, mode_count.count_of(law)))
            else:
                alone.at(a)
            best = min(best, time.perf_counter() - start)
            if best > SHORT:
                break
    return best


def _inertia(selected: SelectedEffects) -> str:
    """Return a remark about plate inertia, before the impact is computed."""
    law, model = selected.law, selected.law.model
    if law.dynamic:
        from derivation.scene.dynamic.mode_count import count_of, finer
        from derivation.scene.dynamic.runs import time_tolerance
        from derivation.scene.dynamic.time_in_contact import slow_count
        from derivation.scene.dynamic.waves import goal

        modes = f"the simulation starts with {finer(law, count_of(law))} bending modes"
        with suppress(SceneError):  # which the simulation states
            if count := slow_count(law, time_tolerance(goal(selected.rtol))):
                modes = f"{count} bending modes, because the impact lasts too long for faster ones"
        if model.inertia.infinite_plate:
            modes += ", on a plate so large that no wave returns from its edge"
        return f"Plate inertia is included: Zener parameter {zener_number(model):.3g}; {modes}."
    if not model.density:
        [row] = [row for row in selected.rows if BY_NAME[row.name].dynamic]
        if row.bound and row.name not in selected.forced_out:
            return (
                "Plate inertia is omitted: its error bound is small for any density of the plate."
            )
        return (
            "Plate inertia cannot be assessed because the density of the plate is unknown; give "
            "plate.density or a material with known density."
        )
    return (
        f"Plate inertia is omitted: Zener parameter {zener_number(model):.3g} (negligible below "
        f"{ZENER_LIMIT}); `simulate` also compares the contact time with the first bending period."
    )
