"""Explains a scene: which effects it requires, by which parameters, and their evaluation times."""

import math
import time
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np

from derivation.engine.text import paragraph
from derivation.scene.effect_selection import SelectedEffects
from derivation.scene.effects import BY_NAME, EFFECTS
from derivation.scene.effects.effect import NO_BOUND, Effect
from derivation.scene.impact import selected_effects
from derivation.scene.law import ContactLaw
from derivation.scene.limits import ZENER_LIMIT, zener_number
from derivation.scene.quadrature import NODES, rule
from derivation.scene.quantity import prefixed
from derivation.scene.scene import OUTPUTS, Scene


@dataclass(frozen=True)
class Explanation:
    """The effects table of a scene; nothing is simulated.

    Attributes
    ----------
    effects
        The effects included, and the effects table.
    evaluation_times
        Time to evaluate a law with each included effect alone at an impact's nodes, measured now
        [s].
    notes
        What else to know.
    """

    effects: SelectedEffects
    evaluation_times: dict[str, float]
    notes: tuple[str, ...]

    def details(self) -> str:
        """The decision, then the effects table with the run time of each effect."""
        times = {
            name: " ".join(prefixed(seconds, "s", RUN_TIME_DIGITS))
            for name, seconds in self.evaluation_times.items()
        }
        return f"{paragraph(str(self), 0)}\n\n{self.effects.to_text(times)}"

    def __str__(self) -> str:
        """The decision in a sentence."""
        effects = ", ".join(self.effects.included)
        of = "each result"
        if self.effects.outputs != OUTPUTS:
            of = "each of " + ", ".join(name.replace("_", " ") for name in self.effects.outputs)
        omitted = any(row.bound and not (row.included or row.disabled) for row in self.effects.rows)
        said = (
            f"The omitted effects change {of} by at most {self.effects.error:.1e} "
            f"(tolerance {self.effects.rtol:.3g})."
            if omitted
            else "No applicable effect was omitted automatically."
        )
        disabled = ", ".join(
            f"{row.name} ({_change(row.bound)})" for row in self.effects.rows if row.disabled
        )
        more = f" The scene disables {disabled}." if disabled else ""
        return f"Included effects: {effects}. {said}{more}"

    def to_json(self) -> dict[str, Any]:
        """Decision and table under fixed keys; evaluation times differ from run to run."""
        return {
            "included": list(self.effects.included),
            "rtol": self.effects.rtol,
            "bound": self.effects.error if np.isfinite(self.effects.error) else None,
            "effects": [row.to_json() for row in self.effects.rows],
            "evaluation_times": self.evaluation_times,
            "notes": list(self.notes),
        }

    def _repr_html_(self) -> str:
        """The table for a notebook."""
        return f"<p>{escape(str(self))}</p>{self.effects.to_html()}"


def _change(bound: float) -> str:
    """What disabling an effect changes at most."""
    return f"changes the results by at most {bound:.1e}" if bound < NO_BOUND else "no bound"


RUN_TIME_DIGITS = 2
"""Significant digits of a run time that are shown."""
REPEATS, SHORT = 3, 1e-3
"""How often a term is timed, of which the least counts, unless once takes longer [s]."""


def explain(scene: Scene, rtol: float | None = None) -> Explanation:
    """Return the effects that a scene requires, with the reasons.

    Parameters
    ----------
    scene
        The scene, as `load` returns it.
    rtol
        Relative tolerance [1]; without it that of the scene counts, or else 1e-3.

    Raises
    ------
    SceneError
        If the tolerance is not between 1e-13 and 1.
    """
    _, selected = selected_effects(scene, rtol)
    law = selected.law
    times = {
        effect.name: _evaluation_time(law, effect) for effect in EFFECTS if effect in law.chosen
    }
    return Explanation(selected, times, (_inertia(selected),))


def _evaluation_time(law: ContactLaw, effect: Effect) -> float:
    """Time [s] that a law with this effect alone takes at an impact's nodes.

    Of plate inertia that of its modes and tables.
    """
    a = rule(NODES[0]).x * min(law.limit, law.model.h)
    alone = law.only(lambda e: e.always_included or e == effect)
    best = math.inf
    with np.errstate(all="ignore"):
        for _ in range(REPEATS):
            start = time.perf_counter()
            if effect.dynamic:
                from derivation.scene import mode_count, waves

                waves.problem_of(law, 2 * mode_count.count_of(law))
            else:
                alone.at(a)
            best = min(best, time.perf_counter() - start)
            if best > SHORT:
                break
    return best


def _inertia(selected: SelectedEffects) -> str:
    """What can be said of the plate's inertia before the impact is computed."""
    law, model = selected.law, selected.law.model
    if law.dynamic:
        from derivation.scene.mode_count import count_of

        plate = f"{2 * count_of(law)} bending modes to begin with"
        if model.inertia.infinite_plate:
            plate += ", on a plate too large for a wave to return from its edge"
        number = f"Zener's number lambda = {zener_number(model):.3g}"
        return f"The plate's inertia is included: {number}; {plate}."
    if not model.density:
        [row] = [row for row in selected.rows if BY_NAME[row.name].dynamic]
        if row.bound and row.name not in selected.forced_out:
            return "The plate's inertia is omitted by its bound, whatever the plate's density."
        return "The plate's inertia is not judged: no plate.density or material of known density."
    return (
        f"The plate's inertia is omitted: Zener's number lambda = {zener_number(model):.3g} "
        f"(small: below {ZENER_LIMIT}); simulate also compares the contact time with the first "
        "bending period."
    )
