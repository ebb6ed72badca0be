"""Whether leaving effects out is honest: random scenes at several tolerances, against all effects.

Scenes are drawn one by one from a seed and their number, log-uniform over materials, sizes and
speeds. "Everything" is the same scene with every effect that applies; both are solved by the
caller, so that this file knows no scene.
"""

import json
import math
import random
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from derivation.checks.random_scenes import OUTPUTS, Scene, Tell, spreading
from derivation.engine.measure.record import plain

SEED = 1
TOLERANCES = (1e-2, 1e-4, 1e-6, 1e-9)

Solve = Callable[[Scene, float], tuple[Sequence[float], Sequence[str], float] | None]
"""Results, effects included and bound of a scene at a tolerance; None if it is refused."""
Everything = Callable[[Scene], tuple[Sequence[float], Sequence[str]] | None]
"""Results and effects of a scene with every effect; None if it is out of every model's range."""


@dataclass(frozen=True)
class EffectCheckRow:
    """How the bounds held at one tolerance.

    Parameters
    ----------
    rtol
        The tolerance.
    scenes
        How many were within the models' range.
    ratio
        Largest difference from everything over the tolerance.
    tightest
        Largest difference over the bound stated.
    included
        Effects taken in, on average, beside the one that always is.
    applicable
        Effects that applied, on average, beside it.
    quantity, number
        Of which result the largest ratio was, and in which scene.
    refused
        How many scenes were told that the tolerance is out of reach.
    """

    rtol: float
    scenes: int
    ratio: float
    tightest: float
    included: float
    applicable: float
    quantity: str
    number: int
    refused: int

    @property
    def kept(self) -> bool:
        """Whether no difference was above its tolerance or its bound."""
        return self.ratio <= 1.0 and self.tightest <= 1.0


def scene(number: int, seed: int = SEED) -> dict[str, dict[str, Any]]:
    """The scene of a number: pebbles to boulders on panes, plates and blocks."""
    generator = random.Random(f"effects {seed} {number}")
    spread = spreading(generator)
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
        # From nothing to much beside a fall through the sphere's own radius.
        plate["retardation_time"] = sphere["radius"] / impact["speed"] * spread(1e-12, 1e-1)
    still = {"inertia": False}  # what that is worth is another check
    return {"sphere": sphere, "plate": plate, "impact": impact, "effects": still}


def judge(
    count: int, solve: Solve, everything: Everything, seed: int = SEED, tell: Tell | None = None
) -> tuple[EffectCheckRow, ...]:
    """Every scene at every tolerance, the rows by tolerance."""
    found: dict[float, list[tuple[float, float, str, int, int, int]]] = {
        rtol: [] for rtol in TOLERANCES
    }
    refused = dict.fromkeys(TOLERANCES, 0)
    for number in range(count):
        if tell is not None:
            tell("scene", number + 1, count)
        data = scene(number, seed)
        whole = everything(data)
        if whole is None:
            continue
        true, applicable = whole
        for rtol in TOLERANCES:
            solved = solve(data, rtol)
            if solved is None:
                refused[rtol] += 1
                continue
            values, effects, bound = solved
            errors = [abs(value / x - 1.0) for value, x in zip(values, true, strict=True)]
            error = max(errors) if all(map(math.isfinite, errors)) else math.inf
            name = OUTPUTS[errors.index(max(errors))]
            found[rtol].append(
                (error / rtol, error / bound, name, number, len(effects) - 1, len(applicable) - 1)
            )
    return tuple(_row(rtol, rows, refused[rtol]) for rtol, rows in found.items())


def _row(
    rtol: float, rows: Sequence[tuple[float, float, str, int, int, int]], refused: int
) -> EffectCheckRow:
    worst = max(rows)
    n = len(rows)
    return EffectCheckRow(
        rtol,
        n,
        worst[0],
        max(row[1] for row in rows),
        sum(row[4] for row in rows) / n,
        sum(row[5] for row in rows) / n,
        worst[2],
        worst[3],
        refused,
    )


def to_json(rows: Sequence[EffectCheckRow], count: int) -> str:
    """The rows as JSON, one to a line."""
    body = ",\n ".join(json.dumps(plain(asdict(row))) for row in rows)
    return f'{{"drawn": {count},\n"seed": {SEED},\n"rows": [\n {body}\n]}}\n'
