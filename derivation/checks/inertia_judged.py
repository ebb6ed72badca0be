"""Random scenes of plates with inertia, and how the stated bounds held in them.

Scenes are drawn one by one from a seed and their number, log-uniform over shapes, stiffnesses,
densities and speeds. The truth is the same scene with every effect, twice the modes and all
branches.
"""

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from derivation.checks.random_scenes import spreading
from derivation.engine.measure.result import CheckResult, all_kept
from derivation.engine.outputs import json_by_line, plain_rows

SEED = 1


@dataclass(frozen=True)
class InertiaRow:
    """How the bounds held in a scene that is not refused.

    Parameters
    ----------
    number, rtol
        The scene and its tolerance.
    included
        Whether the selection included inertia.
    bound, error, quantity
        Stated bound, largest difference from the truth, and of which result [1].
    total_time
        Difference of the time from the first contact to the last release [1]; of a quasi-static
        plate that is its contact time.
    price, alone, worth
        What leaving inertia out may change, as stated, does change, and in which result [1].
    contacts, modes, oscillators
        Of the truth: contacts, wave numbers and oscillators.
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


COLUMNS = (
    "inertia", "#scenes", "#worst error/rtol", "worst result", "#error/bound",
    "#change/bound if omitted",
)  # fmt: skip
"""Heads of the table of sides; the price is what leaving inertia out may change."""


def as_data(judged: InertiaJudged, seed: int) -> dict[str, Any]:
    """What was judged as plain data, infinite prices as null."""
    rows = plain_rows(judged.rows)
    for row in rows:
        row["price"] = None if isinstance(row["price"], str) else row["price"]
    return {
        "drawn": judged.drawn,
        "seed": seed,
        "passed_over": dict(sorted(judged.passed_over.items())),
        "refused": dict(sorted(judged.refused.items())),
        "sides": plain_rows(sides(judged.rows)),
        "rows": rows,
    }


def result(judged: InertiaJudged, seed: int) -> CheckResult:
    """A line of the table for each side, and why other scenes do not count."""
    cells = [
        ("included" if side.included else "omitted", side.scenes, f"{side.ratio:.3f}",
         side.quantity, f"{side.tightest:.3f}", f"{side.price:.3f}")
        for side in sides(judged.rows)
    ]  # fmt: skip
    reasons = {"refused": judged.refused, "passed over": judged.passed_over}
    others = [f"{n} {what}: {why}" for what, by in reasons.items() for why, n in by.items()]
    return CheckResult(
        f"Inertia in {len(judged.rows)} of {judged.drawn} scenes drawn",
        COLUMNS,
        cells,
        lambda: as_data(judged, seed),
        all_kept(sides(judged.rows)),
        listings=[("The others", others)],
        recorded=lambda: json_by_line(as_data(judged, seed), "rows"),
    )
