"""The generated contact law with one thing wrong, in memory: the oracles notice it."""

import math
from collections.abc import Callable, Sequence
from functools import cache
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from mutated_code import BEYOND_ALL, SIZE, START, Answer, Case, Expected, Judged, unnoticed
from sensitivity_table import ROWS, scene_in, sensitivities_of

from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle import forces as contact_forces

Point = tuple[float, ...]
LAME = 0.36e9, 0.43e9


def by_balls(
    name: str, points: Sequence[Point], oracle: Callable[..., Any], outside: Sequence[Point] = ()
) -> Case:
    true = [float(oracle(*p, digits=18)) for p in points]
    return Case(name, [*points, *outside], [*true, *(math.nan for _ in outside)])


# a, R, h, b: thin, medium, thick, and on to the end of where the law holds, 6 h.
PLATES: Sequence[Point] = [
    (0.004, 0.13, 0.01, 1.0), (0.05, 0.9, 0.05, 0.3), (0.1, 0.3, 9.0, 1.0), (0.05, 0.13, 0.01, 1.0),
    (0.041, 0.13, 0.01, 1.0), (0.0599, 0.13, 0.01, 1.0), (0.29, 0.9, 0.06, 0.3),
    (0.041, 0.13, 0.01, 0.045), (0.0305, 0.13, 0.01, 0.08),
]  # fmt: skip
BEYOND: Sequence[Point] = [(0.2, 0.13, 0.05, 1.0), (0.2, 0.9, 0.05, 0.19), (-0.1, 0.9, 0.05, 1.0)]
"""More than R, than b, and less than 0."""
PAST: Sequence[Point] = [(0.0605, 0.13, 0.01, 0.08)]
"""A contact beyond 6 h, which has an indentation and is no answer."""
DEEP: Sequence[Point] = [(210.0, 0.13, 0.01, 1.0), (0.5, 0.3, 0.5, 0.2), (-0.1, 0.9, 0.05, 1.0)]
SOLIDS: Sequence[Point] = [
    (0.2, 1.3, *LAME), (0.1, 0.7, 2e9, 1e9), (0.3, 0.8, -0.5, 0.8), (0.3, 0.8, -1.8, 3.0),
    (1e-3, 0.7, 0.1, 1.2e308),
]  # fmt: skip
NO_SOLIDS: Sequence[Point] = [(0.3, 0.8, -0.7, 1.0), (0.3, 0.8, 1.0, -1.0), (-0.3, 0.8, *LAME)]


@cache
def law_cases() -> list[Expected]:
    depths, past = (
        [(float(contact_balls.indentation(*p, digits=18)), *p[1:]) for p in points]
        for points in (PLATES, PAST)
    )
    forces = [(float(contact_forces.force_of_radius(*p, digits=18)), *p[1:]) for p in SOLIDS]
    return [
        by_balls("indentation", PLATES, contact_balls.indentation, BEYOND),
        by_balls("indentation", PLATES, contact_balls.indentation),
        by_balls("contact_radius", depths, contact_balls.contact_radius, [*past, *DEEP]),
        Case("contact_radius", *zip(*map(to_the_edge, (0.6, 2.0, 9.0)), strict=True)),
        Case("contact_radius", [(-0.0, *p[1:]) for p in PLATES], [0.0] * len(PLATES)),
        by_balls("force", [(*p, *LAME) for p in depths], contact_forces.force),
        by_balls("stiffness", [(*p, *LAME) for p in PLATES], contact_balls.stiffness,
                 [(*p, *LAME) for p in BEYOND]),
        by_balls("force_of_radius", SOLIDS, contact_forces.force_of_radius, NO_SOLIDS),
        by_balls("max_pressure", SOLIDS, contact_forces.max_pressure, NO_SOLIDS),
        by_balls("radius_of_force", forces, contact_forces.radius_of_force, NO_SOLIDS),
    ]  # fmt: skip


def to_the_edge(h: float) -> tuple[Point, float]:
    """An indentation at which a contact is as wide as the plate to the last digit."""
    R, b = 9.0, 3.0
    return (truth(math.nextafter(b, 0.0), R, h, b), R, h, b), b


ONE_PLATE = 0.9, 0.06, 0.3
"""R, h, b."""
NEAR, FURTHER, FAR = (0.004, 0.029), (0.031, 0.1, 0.17), (0.19, 0.25, 0.29)
"""Radii that the short polynomial serves, the first one, and the second."""


def on_one_plate(radii: Sequence[float]) -> Answer:
    """One sphere and one plate for all radii have a law of their own."""
    lengths = dict(zip("Rhb", ONE_PLATE, strict=True))
    true = [truth(a, *ONE_PLATE) if 0 <= a < lengths["b"] else math.nan for a in radii]
    return Answer(lambda module: module.indentation(np.array(radii), **lengths), true)


def of_second(**several: Sequence[float]) -> Answer:
    """The indentation for the second of several spheres or plates."""
    lengths = dict(zip("Rhb", ONE_PLATE, strict=True)) | several
    second = {key: value[1] for key, value in several.items()}
    true = [truth(a, *(dict(zip("Rhb", ONE_PLATE, strict=True)) | second).values()) for a in NEAR]
    radii = np.array(NEAR)[:, None]
    return Answer(lambda module: module.indentation(radii, **lengths)[:, 1], true)


@cache
def layout_cases() -> list[Expected]:
    """Plates along an axis of their own with many points each, and plates repeated."""
    R, h, b = 0.9, np.array([0.06, 0.05]), np.array([0.3])
    few = [*NEAR, *FURTHER]
    radii = np.resize(few, 606)
    true = np.resize([[truth(a, R, float(half), 0.3) for half in h] for a in few], (606, 2))
    return [
        *law_cases(),
        Answer(lambda module: module.indentation(radii[:, None], R, h, b), true),
        Answer(lambda module: module.indentation(radii, R, h[:, None], b), true.T),
        Answer(lambda module: module.indentation(radii[:500, None], R, h, b), true[:500]),
        Answer(lambda module: module.indentation(radii, R, np.resize(h, 606), b),
               np.where(np.arange(606) % 2, true[:, 1], true[:, 0])),
    ]  # fmt: skip


@cache
def plain_cases() -> list[Expected]:
    """The law at one point after the other, in plain numbers."""
    depths = [(truth(*p), *p[1:]) for p in PLATES]
    bad = [(0.004, 0.13, 0.1, 1.0, -0.7e9, 1e9), (0.004, 0.13, 0.1, 1.0, 1e9, -1e9)]
    solid = -0.5e9, 0.8e9
    return [
        *law_cases(),
        alone("indentation", PLATES, contact_balls.indentation, BEYOND),
        alone("contact_radius", depths, contact_balls.contact_radius, DEEP),
        alone("force", [(*p, *solid) for p in depths], contact_forces.force, bad),
        alone("stiffness", [(*p, *solid) for p in PLATES], contact_balls.stiffness,
              [*bad, *((*p, *solid) for p in BEYOND)]),
    ]  # fmt: skip


def alone(
    name: str, points: Sequence[Point], oracle: Callable[..., Any], outside: Sequence[Point]
) -> Answer:
    """The results of one call after the other."""
    true = [*(float(oracle(*p, digits=18)) for p in points), *(math.nan for _ in outside)]
    return Answer(lambda m: [getattr(m, name)(*p) for p in (*points, *outside)], true)


def of_coefficients(points: Sequence[tuple[float, float]], true: Sequence[float]) -> Answer:
    """The indentation over a^2/R by the coefficients that a user gets."""
    A, eta = np.array(points).T

    def lift(module: ModuleType) -> np.ndarray:
        powers = module.plate_coefficients(eta)
        share = (A / np.minimum(3, 1 / eta))[:, None] ** 2
        return 1 + A * (powers * share ** np.arange(powers.shape[-1])).sum(axis=-1)

    return Answer(lift, true)


@cache
def truth(a: float, R: float, h: float, b: float) -> float:
    return float(contact_balls.indentation(a, R, h, b, digits=18))


def series_cases() -> list[Expected]:
    return [*law_cases(), *piece_cases(), *end_cases(), *sensitivity_cases()]


@cache
def piece_cases() -> list[Expected]:
    """Every table of the law on both sides of its ends."""
    radii = [NEAR, (*FURTHER, *NEAR), (*FAR, *NEAR, *FURTHER), FAR, (*NEAR, -0.1, 0.31, math.nan)]
    R, h, _ = ONE_PLATE
    plates = [(A, 50.0, 1.0, v) for v in (3.3, 5.0, 9.0, 20.0) for A in (0.4, 2.8, 3.2, 4.9, 6.5)
              if v > A]  # fmt: skip
    inner = [(A, 1 / v) for A, _, _, v in plates if A < 3]
    return [
        of_second(R=[R, 2 * R]),
        of_second(h=[h, 0.05]),
        *map(on_one_plate, radii),
        by_balls("indentation", plates, contact_balls.indentation),
        by_balls("stiffness", [(*p, *LAME) for p in plates], contact_balls.stiffness),
        of_coefficients(inner, [truth(A, 1, 1, 1 / eta) / A**2 for A, eta in inner]),
    ]


@cache
def end_cases() -> list[Expected]:
    """Where the law ends, and where the short polynomial does."""
    thinnest = 1.5e-90
    bent = 1 + 0.5 / (4 * math.pi * thinnest**2)
    """F of a thin plate, but for a share of eta^2 log(eta)."""
    ends = [(0.5, thinnest), (0.5, 0.9e-90), (0.0, 1.1e90)]
    wide, short = (6.0, 50.0, 1.0, 20.0), (0.498, 1.0, 1.0, 3.1)
    further = [(4.0, 50.0, 1.0, 1e6), (3.2, 50.0, 1.0, 9.0)]
    return [
        of_coefficients(ends, [bent, math.nan, math.nan]),
        Case("contact_radius", [(truth(*wide) * (1 + 7e-16), *wide[1:])], [wide[0]]),
        by_balls("indentation", further, contact_balls.indentation),
        Answer(lambda module: module.indentation(*short), truth(*short), tolerance=4e-15),
        by_balls("indentation", [(6.5, 50.0, 1.0, 1 / 1.5e-5)], contact_balls.indentation),
    ]


@cache
def sensitivity_cases() -> list[Expected]:
    slopes = [float(contact_balls.slope(*p, 22)) for p in PLATES]
    sure = [np.array(sensitivities_of(row), dtype=float) for row in ROWS]
    nowhere = [(0.13, 1.0, 1e9, 0.1, 1.0, *LAME), (0.13, -1.0, 1.0, 0.1, 1.0, *LAME)]
    true = np.stack([*sure, *[np.full((4, 7), math.nan)] * len(nowhere)], axis=-1)
    scenes = np.array([*map(scene_in, ROWS), *nowhere])
    return [
        Case("indentation_slope", [*PLATES, *BEYOND], [*slopes, *([math.nan] * len(BEYOND))]),
        Answer(lambda module: module.impact_sensitivities(*scenes.T), true, least=1.0),
        Answer(lambda module: module.impact_sensitivities(*scenes[0]), sure[0], least=1.0),
    ]


SLOW = "the slow way to the same"
LAW = ["plate_arrays", "plate_points", "prepared_plate", "contact_law"]
"""Modules from the polynomials to the law, each upon those before."""
JUDGED = {
    "contact_law": Judged(law_cases),
    "contact_domain": Judged(
        layout_cases, dict.fromkeys(("_MANY", "_SAMPLE"), (1, SLOW)), users=LAW
    ),
    "plate_arrays": Judged(
        layout_cases,
        {
            "_invert": (5, START),
            "_indentations": (1, SLOW),
            "_APART": (1, SLOW),
            "_plate_by_plate": (2, SLOW),
            "_forces": (1, "the sign of zero, of which other tests tell"),
        },
        users=LAW[1:],
    ),
    "plate_points": Judged(
        plain_cases,
        {
            "_invert": (8, START),
            "linear": (1, START),
            "_modulus": (3, SLOW),
            "_ORDINARY": (2, SLOW),
            "_USUAL": (2, SLOW),
            **dict.fromkeys(
                ("_piece_at", "indentation"), (1, "both polynomials hold at their common end")
            ),
        },
        users=LAW[2:],
    ),
    "contact_points": Judged(
        layout_cases, {"flat": (1, SLOW), "cut": (1, SLOW), "pieces": (2, SLOW)}, users=LAW
    ),
    "contact_cells": Judged(
        series_cases,
        users=["contact_series", "contact_domain", *LAW, "contact_thickness", "sensitivity"],
    ),
    "contact_series": Judged(
        series_cases,
        {
            **dict.fromkeys(("_ORDINARY", "_USUAL"), (2, SLOW)),
            **dict.fromkeys(
                ("sphere_on_plate", "correction", "correction_with_slope"),
                (1, "both polynomials hold at their common end"),
            ),
            "direct": (5, f"{BEYOND_ALL}; and {SIZE}"),
        },
        users=["contact_domain", *LAW, "contact_thickness", "sensitivity"],
    ),
    "contact_thickness": Judged(sensitivity_cases, users=["sensitivity"]),
    "sensitivity": Judged(sensitivity_cases, {"_near_sums": (4, "a zero of the right shape")}),
}


@pytest.mark.parametrize("name", JUDGED)
def test_every_mutant_is_noticed_or_may_pass(name: str) -> None:
    assert unnoticed(name, JUDGED[name]) == {}
