"""Explains a scene: which effects it calls for, by which numbers, and what their terms cost."""

import math
import time
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np

from derivation.scene.effects import EFFECTS
from derivation.scene.effects.effect import Effect
from derivation.scene.gate import HEADS, Gate
from derivation.scene.impact import gated
from derivation.scene.law import Law
from derivation.scene.limits import ZENER_LIMIT, zener_number
from derivation.scene.quadrature import NODES, rule
from derivation.scene.scene import OUTPUTS, Scene


@dataclass(frozen=True)
class Explanation:
    """The effects table of a scene; nothing is simulated.

    Attributes
    ----------
    gate
        What was decided.
    costs
        Time of a law with each included effect alone at an impact's nodes, measured now [s].
    notes
        What else to know.
    """

    gate: Gate
    costs: dict[str, float]
    notes: tuple[str, ...]

    def lines(self) -> list[tuple[str, ...]]:
        """The effects table with the cost of each term, to be read by people."""
        shown = (
            f"{1e6 * self.costs[line[0]]:.0f} us" if line[0] in self.costs else "-"
            for line in self.gate.lines()
        )
        return [(*line, time) for line, time in zip(self.gate.lines(), shown, strict=True)]

    def __str__(self) -> str:
        """The decision in a sentence."""
        effects = ", ".join(row.name for row in self.gate.rows if row.included)
        of = "no result"
        if self.gate.outputs != OUTPUTS:
            of = "none of " + ", ".join(name.replace("_", " ") for name in self.gate.outputs)
        forced = ", ".join(self.gate.forced_out)
        priced = f"; the scene leaves out {forced}, at the price in the table" if forced else ""
        return (
            f"included: {effects}; all that the gate leaves out changes {of} by more than "
            f"{self.gate.error:.1e} (tolerance {self.gate.rtol:.3g}){priced}"
        )

    def to_json(self) -> dict[str, Any]:
        """Decision and table under fixed keys; costs differ from run to run."""
        return {
            "included": [row.name for row in self.gate.rows if row.included],
            "rtol": self.gate.rtol,
            "bound": self.gate.error if np.isfinite(self.gate.error) else None,
            "effects": [row.to_json() for row in self.gate.rows],
            "costs": self.costs,
            "notes": list(self.notes),
        }

    def _repr_html_(self) -> str:
        """The table for a notebook."""
        return f"<p>{escape(str(self))}</p>{self.gate.to_html()}"


COLUMNS = (*HEADS, "term takes")
"""Heads of the table."""
REPEATS, SHORT = 3, 1e-3
"""How often a term is timed, of which the least counts, unless once takes longer [s]."""


def explain(scene: Scene, rtol: float | None = None) -> Explanation:
    """Say which effects a scene calls for, and why.

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
    _, gate = gated(scene, rtol)
    costs = {
        effect.name: _cost(gate.law, effect)
        for effect in EFFECTS
        if effect.name in gate.law.effects
    }
    return Explanation(gate, costs, (_inertia(gate),))


def _cost(law: Law, effect: Effect) -> float:
    """Time [s] that a law with this effect alone takes at an impact's nodes.

    Of inertia what its oscillators and tables take.
    """
    a = rule(NODES[0]).x * min(law.limit, law.model.h)
    alone = Law(law.model, frozenset({"hertz", effect.name}))
    best = math.inf
    with np.errstate(all="ignore"):
        for _ in range(REPEATS):
            start = time.perf_counter()
            if effect.name == "inertia":
                from derivation.scene import waves

                waves.problem_of(law, 2 * waves.count_of(law))
            else:
                alone.at(a)
            best = min(best, time.perf_counter() - start)
            if best > SHORT:
                break
    return best


def _inertia(gate: Gate) -> str:
    """What can be said of the plate's inertia before the impact is computed."""
    law, model = gate.law, gate.law.model
    if "inertia" in law.effects:
        plate = "an endless plate"
        if not model.inertia.infinite_plate:
            from derivation.scene.waves import count_of

            plate = f"{2 * count_of(law)} bending modes to begin with"
        return f"the plate moves: Zener's number lambda = {zener_number(model):.3g}; {plate}"
    if not model.density:
        [row] = [row for row in gate.rows if row.name == "inertia"]
        if row.bound and row.name not in gate.forced_out:
            return "the plate's inertia is left out by its bound, whatever the plate's density"
        return "the plate's inertia is not judged: no plate.density or material of known density"
    return (
        f"the plate's inertia is left out: Zener's number lambda = {zener_number(model):.3g} "
        f"(small: below {ZENER_LIMIT}); simulate also compares the contact time with the first "
        "bending period"
    )
