"""Random scenes with plate inertia, and the ratios of their errors to the stated bounds.

Each scene is drawn from the seed and its number, log-uniformly over shapes, stiffnesses, densities
and speeds; half of the scenes have a viscoelastic contact, a yield stress or a loss factor. The
reference has every applicable effect, twice the modes and all branches (of a viscoelastic contact,
the bending branch alone).
"""

import itertools
import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from derivation.checks.random_scenes import log_uniform_draw
from derivation.engine.measure.result import CheckResult, all_passed
from derivation.engine.outputs import json_by_line, plain_rows

SEED = 1
KEYS = {
    "viscosity": "retardation_time",
    "plasticity": "yield_stress",
    "damping": "loss_factor",
}
"""Effects that dissipate energy, which half of the scenes have, and their keys of the plate."""
ELASTIC, SEVERAL = "none", "several"
"""Names of scenes without such an effect, and with more than one."""


@dataclass(frozen=True)
class InertiaRow:
    """The errors and bounds of a scene that is not rejected.

    Parameters
    ----------
    number, rtol
        The scene and its tolerance.
    dissipation
        Name of its effect that dissipates energy; "none", or "several".
    included
        Whether the selection included inertia.
    bound, error, quantity
        Stated bound [1], largest relative difference from the reference [1], and its result.
    total_time
        Relative difference from the reference's total time [1]: of the total time, or of the
        contact time if inertia is omitted.
    omission_bound, omission_change, omission_quantity
        Stated bound on the change if inertia and damping are omitted [1], largest actual change
        [1], and the result that changes most.
    contacts, wave_numbers, modes
        Numbers of contacts, wave numbers and modes (of all branches) of the reference.
    """

    number: int
    rtol: float
    dissipation: str
    included: bool
    bound: float
    error: float
    quantity: str
    total_time: float
    omission_bound: float
    omission_change: float
    omission_quantity: str
    contacts: int
    wave_numbers: int
    modes: int


@dataclass(frozen=True)
class InertiaResults:
    """The results of random scenes.

    Parameters
    ----------
    drawn
        Number of scenes drawn.
    skipped
        Number of skipped scenes by reason.
    rejected
        Number of rejected scenes by the key of the error message.
    rows
        Results of the other scenes.
    """

    drawn: int
    skipped: Mapping[str, int]
    rejected: Mapping[str, int]
    rows: tuple[InertiaRow, ...]


@dataclass(frozen=True)
class Side:
    """The largest errors over the bounds on one side of the threshold, of one kind of dissipation.

    Parameters
    ----------
    dissipation
        Effect that dissipates energy; "none", or "several".
    included
        Whether inertia is included on this side.
    scenes
        Number of scenes.
    error_over_rtol, quantity, number
        Largest relative difference over the tolerance [1], with its result and scene.
    error_over_bound
        Largest relative difference over the stated bound [1].
    change_over_bound
        Largest ratio of the change if inertia is omitted to its stated bound [1].
    """

    dissipation: str
    included: bool
    scenes: int
    error_over_rtol: float
    quantity: str
    number: int
    error_over_bound: float
    change_over_bound: float

    @property
    def passed(self) -> bool:
        """Whether no difference exceeds its tolerance or its bound."""
        return max(self.error_over_rtol, self.error_over_bound, self.change_over_bound) <= 1.0


def scene(number: int, seed: int = SEED) -> tuple[dict[str, dict[str, Any]], float]:
    """Return the scene with a number, and a number in [0, 1) that determines its tolerance.

    Over the plate radius, the sphere radius is 0.005 to 2 and half the thickness 0.002 to 1.
    """
    generator = random.Random(f"inertia {seed} {number}")
    spread = log_uniform_draw(generator)
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
    position = generator.random()
    _add_dissipation(tables | asked, random.Random(f"dissipation {seed} {number}"))
    return tables | asked, position


def _add_dissipation(tables: dict[str, dict[str, Any]], generator: random.Random) -> None:
    """Give half of the scenes one or two effects that dissipate energy.

    The scales are estimates of the contact time and of Hertz's pressure of the scene.
    """
    if generator.random() < 0.5:
        return
    spread = log_uniform_draw(generator)
    sphere, plate, v0 = tables["sphere"], tables["plate"], tables["impact"]["speed"]
    E = plate["youngs_modulus"]
    speed = sphere["density"] * v0 * v0 / E
    for name in generator.sample(tuple(KEYS), generator.choice([1, 1, 1, 2])):
        if name == "viscosity":
            plate["retardation_time"] = sphere["radius"] / v0 * speed**0.4 * spread(1e-3, 3.0)
            tables["inertia"]["branches"] = "A0"
        elif name == "plasticity":
            plate["yield_stress"] = E * speed**0.2 * spread(3e-2, 1.0)
        else:
            plate["loss_factor"] = spread(1e-3, 1.0)


def dissipation_of(data: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the effect of a scene that dissipates energy; "none", or "several"."""
    sources = [name for name, key in KEYS.items() if key in data["plate"]]
    return (sources or [ELASTIC])[0] if len(sources) < 2 else SEVERAL


def sides(rows: Sequence[InertiaRow]) -> tuple[Side, ...]:
    """Return the sides of the threshold on which there are scenes, by dissipation."""
    kinds = itertools.product((ELASTIC, *KEYS, SEVERAL), (True, False))
    parted = ([row for row in rows if (row.dissipation, row.included) == kind] for kind in kinds)
    return tuple(_side(part) for part in parted if part)


def _side(rows: Sequence[InertiaRow]) -> Side:
    worst = max(rows, key=lambda row: row.error / row.rtol)
    return Side(
        worst.dissipation,
        worst.included,
        len(rows),
        worst.error / worst.rtol,
        worst.quantity,
        worst.number,
        max(row.error / row.bound for row in rows),
        max(row.omission_change / row.omission_bound for row in rows),
    )


COLUMNS = (
    "dissipation", "inertia", "#scenes", "#error/rtol", "#error/bound", "#change/bound",
)  # fmt: skip
"""Column heads of the table of sides; `Side` describes the ratios, the largest of its scenes."""


def as_data(judged: InertiaResults, seed: int) -> dict[str, Any]:
    """Return the results as plain data; infinite bounds become null."""
    rows = plain_rows(judged.rows)
    for row in rows:
        row["omission_bound"] = (
            None if isinstance(row["omission_bound"], str) else row["omission_bound"]
        )
    return {
        "drawn": judged.drawn,
        "seed": seed,
        "skipped": dict(sorted(judged.skipped.items())),
        "rejected": dict(sorted(judged.rejected.items())),
        "sides": plain_rows(sides(judged.rows)),
        "rows": rows,
    }


def result(judged: InertiaResults, seed: int) -> CheckResult:
    """Return the table of sides, and the reasons why scenes were rejected or skipped."""
    cells = [
        (side.dissipation, "included" if side.included else "omitted", side.scenes,
         f"{side.error_over_rtol:.3f}", f"{side.error_over_bound:.3f}",
         f"{side.change_over_bound:.3f}")
        for side in sides(judged.rows)
    ]  # fmt: skip
    reasons = {"rejected": judged.rejected, "skipped": judged.skipped}
    others = [f"{n} {what}: {why}" for what, by in reasons.items() for why, n in by.items()]
    return CheckResult(
        f"Plate inertia in {len(judged.rows)} of {judged.drawn} random scenes",
        COLUMNS,
        cells,
        lambda: as_data(judged, seed),
        all_passed(sides(judged.rows)),
        listings=[("Other scenes", others)],
        recorded=lambda: json_by_line(as_data(judged, seed), "rows"),
    )
