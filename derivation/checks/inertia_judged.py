"""Whether a plate that moves is what its bounds say: random scenes against a richer model.

Scenes are drawn one by one from a seed and their number, log-uniform over shapes, stiffnesses,
densities and speeds. The caller places tolerances on both sides of the selection threshold. The
truth is the same scene with every effect, twice the modes and all branches, solved by the caller
too, so that this file knows no scene.
"""

import json
import math
import random
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from derivation.checks.random_scenes import OUTPUTS, Scene, Tell, spreading
from derivation.engine.measure.record import plain

SEED = 1


@dataclass(frozen=True)
class InertiaFound:
    """A scene's outcome, if it is not refused.

    Parameters
    ----------
    rtol
        The tolerance asked for [1].
    included
        Whether the selection included inertia.
    values, truth
        The results, and those of the richer model.
    bound
        What the results may be off by, as stated [1].
    total_time, true_total_time
        From the first contact to the last release [s]; of a plate at rest its contact time.
    still
        The results of every effect on a plate at rest.
    price
        What leaving inertia out may change, as stated [1].
    contacts, modes, oscillators
        Of the truth: contacts, wave numbers and oscillators.
    """

    rtol: float
    included: bool
    values: Sequence[float]
    truth: Sequence[float]
    bound: float
    total_time: float
    true_total_time: float
    still: Sequence[float]
    price: float
    contacts: int
    modes: int
    oscillators: int


@dataclass(frozen=True)
class InertiaRow:
    """How the bounds held in a scene.

    Parameters
    ----------
    number, rtol
        The scene and its tolerance.
    included
        Whether the selection included inertia.
    bound, error, quantity
        Stated bound, largest difference from the truth, and of which result [1].
    total_time
        That of the time to the last release [1].
    price, alone, worth
        What leaving inertia out may change, as stated, does change, and in which result [1].
    contacts, modes, oscillators
        Of the truth.
    """

    number: int
    rtol: float
    included: bool
    bound: float
    error: float
    quantity: str
    total_time: float
    price: float
    alone: float
    worth: str
    contacts: int
    modes: int
    oscillators: int


@dataclass(frozen=True)
class InertiaJudged:
    """Random scenes, judged.

    Parameters
    ----------
    drawn
        How many were drawn, until enough were within what is looked at.
    passed_over
        Reasons why others were not, with how often.
    refused
        What the messages of refused ones begin with, with how often.
    rows
        The others.
    """

    drawn: int
    passed_over: Mapping[str, int]
    refused: Mapping[str, int]
    rows: tuple[InertiaRow, ...]


@dataclass(frozen=True)
class Side:
    """How the bounds held on one side of the selection threshold.

    Parameters
    ----------
    included
        Which side.
    scenes
        How many there are.
    ratio, quantity, number
        Largest difference over the tolerance, of which result, and in which scene.
    tightest
        Largest difference over the bound stated.
    price
        Largest change by leaving inertia out over what is stated of it.
    """

    included: bool
    scenes: int
    ratio: float
    quantity: str
    number: int
    tightest: float
    price: float

    @property
    def kept(self) -> bool:
        """Whether no difference was above its tolerance or its bound."""
        return max(self.ratio, self.tightest, self.price) <= 1.0


Solve = Callable[[Scene, float], InertiaFound | str]
"""A scene with a number in [0, 1) that places its tolerance, or how the message that refuses it
begins."""
PassOver = Callable[[Scene], str]
"""Why a scene is not looked at; empty if it is."""


def scene(number: int, seed: int = SEED) -> tuple[dict[str, dict[str, Any]], float]:
    """The scene of a number: grains to boulders on panes, plates and blocks; and a number in
    [0, 1) that places its tolerance.
    """
    generator = random.Random(f"inertia {seed} {number}")
    spread = spreading(generator)
    b = spread(0.05, 5.0)
    plate: dict[str, Any] = {
        "radius": b,
        "half_thickness": b * spread(2e-3, 1.0),
        "youngs_modulus": spread(1e6, 1e12),
        "poissons_ratio": generator.uniform(-0.5, 0.49),
        "density": spread(100.0, 2e4),
        "edge": generator.choice(["paper", "simply-supported", "clamped"]),
    }
    sphere: dict[str, Any] = {"radius": b * spread(5e-3, 2.0), "density": spread(100.0, 2e4)}
    if generator.random() < 0.5:
        sphere["material"] = generator.choice(["steel", "glass", "aluminium", "PMMA"])
    impact: dict[str, Any] = {"speed": spread(1e-4, 30.0)}
    if generator.random() < 0.4:
        impact["gravity"] = 9.81
    branches = "all" if generator.random() < 0.2 else "A0"
    tables = {"sphere": sphere, "plate": plate, "impact": impact}
    asked = {"effects": {"inertia": "auto"}, "inertia": {"branches": branches}}
    return tables | asked, generator.random()


def judge(
    count: int,
    solve: Solve,
    pass_over: PassOver,
    seed: int = SEED,
    tell: Tell | None = None,
) -> InertiaJudged:
    """So many scenes that are neither passed over nor refused."""
    passed_over, refused, rows = Counter[str](), Counter[str](), list[InertiaRow]()
    number = 0
    while len(rows) < count:
        data, place = scene(number, seed)
        number += 1
        reason = pass_over(data)
        if reason:
            passed_over[reason] += 1
            continue
        if tell is not None:
            tell("scene", len(rows) + 1, count)
        found = solve(data, place)
        if isinstance(found, str):
            refused[found] += 1
        else:
            rows.append(_row(number - 1, found))
    return InertiaJudged(number, passed_over, refused, tuple(rows))


def sides(rows: Sequence[InertiaRow]) -> tuple[Side, ...]:
    """Both sides of the threshold, those there are."""
    parted = ([row for row in rows if row.included is side] for side in (True, False))
    return tuple(_side(part) for part in parted if part)


def _side(rows: Sequence[InertiaRow]) -> Side:
    worst = max(rows, key=lambda row: row.error / row.rtol)
    return Side(
        worst.included,
        len(rows),
        worst.error / worst.rtol,
        worst.quantity,
        worst.number,
        max(row.error / row.bound for row in rows),
        max(row.alone / row.price for row in rows),
    )


def _row(number: int, found: InertiaFound) -> InertiaRow:
    error, quantity = _worst(found.values, found.truth)
    alone, worth = _worst(found.still, found.truth)
    total = abs(found.total_time / found.true_total_time - 1.0)
    return InertiaRow(
        number, found.rtol, found.included, found.bound, error, quantity, total,
        found.price, alone, worth, found.contacts, found.modes, found.oscillators,
    )  # fmt: skip


def _worst(values: Sequence[float], truth: Sequence[float]) -> tuple[float, str]:
    """Largest relative difference, and of which result."""
    errors = [abs(value / x - 1.0) for value, x in zip(values, truth, strict=True)]
    errors = [error if math.isfinite(error) else math.inf for error in errors]
    return max(errors), OUTPUTS[errors.index(max(errors))]


COLUMNS = (
    "inertia", "#scenes", "#worst error/rtol", "worst result", "#error/bound",
    "#change/bound if omitted",
)  # fmt: skip
"""Heads of the table of sides; the price is what leaving inertia out may change."""


def cells(judged: InertiaJudged) -> list[tuple[str, ...]]:
    """A line of the table for each side."""
    return [
        ("included" if side.included else "omitted", str(side.scenes), f"{side.ratio:.3f}",
         side.quantity, f"{side.tightest:.3f}", f"{side.price:.3f}")
        for side in sides(judged.rows)
    ]  # fmt: skip


def as_data(judged: InertiaJudged, seed: int) -> dict[str, Any]:
    """What was judged as plain data, infinite prices as null."""
    rows = [asdict(row) for row in judged.rows]
    for row in rows:
        row["price"] = row["price"] if math.isfinite(row["price"]) else None
    return {
        "drawn": judged.drawn,
        "seed": seed,
        "passed_over": dict(sorted(judged.passed_over.items())),
        "refused": dict(sorted(judged.refused.items())),
        "sides": plain([asdict(side) for side in sides(judged.rows)]),
        "rows": plain(rows),
    }


def to_json(judged: InertiaJudged, seed: int) -> str:
    """The same as JSON, a row to a line."""
    data = as_data(judged, seed)
    lines = [f"{json.dumps(key)}: {json.dumps(data[key])}" for key in data if key != "rows"]
    rows = ",\n ".join(json.dumps(row) for row in data["rows"])
    return "{" + ",\n".join(lines) + f',\n"rows": [\n {rows}\n]}}\n'
