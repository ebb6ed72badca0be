"""The generated contact law with one thing wrong, in memory: the oracles notice it."""

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from code_cases import (
    BEYOND_ALL,
    GUARDS,
    LAME,
    ORDER,
    SAME,
    SIZE,
    START,
    STEPS,
    Case,
    Point,
    assert_noticed,
    by_balls,
)
from sensitivity_table import ROWS, scene_in, sensitivities_of

from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle import forces as contact_forces

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
def law_cases() -> list[Case]:
    depths, past = (
        [(float(contact_balls.indentation(*p, digits=18)), *p[1:]) for p in points]
        for points in (PLATES, PAST)
    )
    forces = [(float(contact_forces.force_of_radius(*p, digits=18)), *p[1:]) for p in SOLIDS]
    return [
        by_balls("indentation", PLATES, contact_balls.indentation, BEYOND),
        by_balls("indentation", PLATES, contact_balls.indentation),
        by_balls("contact_radius", depths, contact_balls.contact_radius, [*past, *DEEP]),
        Case("contact_radius", [(-0.0, *p[1:]) for p in PLATES], [0.0] * len(PLATES)),
        by_balls("force", [(*p, *LAME) for p in depths], contact_forces.force),
        by_balls("stiffness", [(*p, *LAME) for p in PLATES], contact_balls.stiffness,
                 [(*p, *LAME) for p in BEYOND]),
        by_balls("force_of_radius", SOLIDS, contact_forces.force_of_radius, NO_SOLIDS),
        by_balls("max_pressure", SOLIDS, contact_forces.max_pressure, NO_SOLIDS),
        by_balls("radius_of_force", forces, contact_forces.radius_of_force, NO_SOLIDS),
    ]  # fmt: skip


ONE_PLATE = 0.9, 0.06, 0.3
"""R, h, b."""
NEAR, FURTHER, FAR = (0.004, 0.029), (0.031, 0.1, 0.17), (0.19, 0.25, 0.29)
"""Radii that the short polynomial serves, the first one, and the second."""


def on_one_plate(module: ModuleType) -> Callable[..., Any]:
    """One sphere and one plate for all radii have a law of their own."""
    return lambda a: module.indentation(a, *ONE_PLATE)


def of_coefficients(module: ModuleType) -> Callable[..., Any]:
    """The indentation over a^2/R by the coefficients that a user gets."""

    def lift(A: np.ndarray, eta: np.ndarray) -> np.ndarray:
        powers = module.plate_coefficients(eta)
        share = np.asarray(A / np.minimum(3, 1 / eta))[..., None] ** 2
        return 1 + A * (powers * share ** np.arange(powers.shape[-1])).sum(axis=-1)

    return lift


def of_second(**several: Sequence[float]) -> Callable[[ModuleType], Callable[..., Any]]:
    """The indentation for the second of several spheres or plates."""

    def function(module: ModuleType) -> Callable[..., Any]:
        scene = dict(zip("Rhb", ONE_PLATE, strict=True)) | several
        return lambda a: module.indentation(np.asarray(a)[..., None], **scene)[..., 1]

    return function


def series_cases() -> list[Case]:
    return [*law_cases(), *piece_cases(), *end_cases(), *sensitivity_cases()]


@cache
def piece_cases() -> list[Case]:
    """Every table of the law on both sides of its ends."""
    radii = [NEAR, (*FURTHER, *NEAR), (*FAR, *NEAR, *FURTHER), FAR]
    depths = {
        a: float(contact_balls.indentation(a, *ONE_PLATE, digits=18))
        for a in (*NEAR, *FURTHER, *FAR)
    }
    nowhere = [(-0.1,), (0.31,), (math.nan,)]
    R, h, b = ONE_PLATE
    others = [(2 * R, h, b), (R, 0.05, b)]
    beside = [
        [float(contact_balls.indentation(a, *other, digits=18)) for a in NEAR] for other in others
    ]
    plates = [(A, 50.0, 1.0, v) for v in (3.3, 5.0, 9.0, 20.0) for A in (0.4, 2.8, 3.2, 4.9, 6.5)
              if v > A]  # fmt: skip
    inner = [(A, 1 / v) for A, _, _, v in plates if A < 3]
    lifts = [float(contact_balls.indentation(A, 1, 1, v, digits=18)) / A**2 for A, v in
             ((A, 1 / eta) for A, eta in inner)]  # fmt: skip
    return [
        Case(of_second(R=[R, 2 * R]), [(a,) for a in NEAR], beside[0]),
        Case(of_second(h=[h, 0.05]), [(a,) for a in NEAR], beside[1]),
        *(Case(on_one_plate, [(a,) for a in some], [depths[a] for a in some]) for some in radii),
        Case(on_one_plate, [(NEAR[0],), *nowhere], [depths[NEAR[0]], *([math.nan] * 3)]),
        by_balls("indentation", plates, contact_balls.indentation),
        by_balls("stiffness", [(*p, *LAME) for p in plates], contact_balls.stiffness),
        Case(of_coefficients, inner, lifts),
    ]


@cache
def end_cases() -> list[Case]:
    """Where the law ends, and where the short polynomial does."""
    thinnest = 1.5e-90
    bent = 1 + 0.5 / (4 * math.pi * thinnest**2)
    """F of a thin plate, but for a share of eta^2 log(eta)."""
    ends = [(0.5, thinnest), (0.5, 0.9e-90), (0.0, 1.1e90)]
    wide = (6.0, 50.0, 1.0, 20.0)
    deepest = float(contact_balls.indentation(*wide, digits=18)) * (1 + 7e-16)
    return [
        Case(of_coefficients, ends, [bent, math.nan, math.nan]),
        Case("contact_radius", [(deepest, *wide[1:])], [wide[0]]),
        by_balls(
            "indentation", [(4.0, 50.0, 1.0, 1e6), (3.2, 50.0, 1.0, 9.0)], contact_balls.indentation
        ),
        by_balls(
            "indentation", [(0.498, 1.0, 1.0, 3.1)], contact_balls.indentation, tolerance=4e-15
        ),
        by_balls("indentation", [(6.5, 50.0, 1.0, 1 / 1.5e-5)], contact_balls.indentation),
    ]


@cache
def sensitivity_cases() -> list[Case]:
    slopes = [float(contact_balls.slope(*p, 22)) for p in PLATES]
    sure = [np.array(sensitivities_of(row), dtype=float).T for row in ROWS]
    nowhere = [(0.13, 1.0, 1e9, 0.1, 1.0, *LAME), (0.13, -1.0, 1.0, 0.1, 1.0, *LAME)]
    lost = [np.full((7, 4), math.nan)] * len(nowhere)
    return [
        Case("indentation_slope", [*PLATES, *BEYOND], [*slopes, *([math.nan] * len(BEYOND))]),
        Case(
            "impact_sensitivities",
            [*map(scene_in, ROWS), *nowhere],
            np.array([*sure, *lost]),
            least=1.0,
        ),
    ]


CLIP = "np.clip(1.0 + step, 0.3, 3.0)"
THIN = "1.0 / np.cbrt(eps * linear)"
EQUIVALENT: Mapping[str, Mapping[str, Sequence[str]]] = {
    "contact_law": {
        ORDER: [*STEPS, f"_invert: 0.3 -> 0.6 in {CLIP}", f"_invert: 3.0 -> 6.0 in {CLIP}"],
        START: [
            "_invert: 0.0 -> 1 in np.maximum(plates.first.coefficients[0][pick], 0.0)",
            f"_invert: 1.0 -> 2.0 in {THIN}",
            f"_invert: 1.0 -> 2.0 in np.minimum({THIN}, 1.0)",
        ],
        GUARDS: [
            "indentation: 0 -> 1 in radius.min() >= 0",  # the slow way to the same
            "_contact: ROUNDED * b -> ROUNDED / b",
            "_plates: 1.0 -> 2.0 in np.where(sound, b, 1.0)",
        ],
    },
    "contact_points": {
        SIZE: ["flat: 1 -> 2 in np.prod(shape) != 1", "cut: 0 -> 1 in x.strides[0] == 0"],
    },
    "contact_cells": {
        SAME: ["horner: coefficients[-1] + 0.0 * t -> coefficients[-1] - 0.0 * t"],
    },
    "contact_series": {
        SIZE: [
            "_BLOCK: 32768 -> 65536 in _BLOCK = 32768",
            "_MODE_BLOCK: 4096 -> 8192 in _MODE_BLOCK = 4096",
            "direct: 1 -> 2 in max(1, 65536 // min(zeros.size, _MODE_BLOCK))",
            "direct: 65536 -> 131072 in 65536 // min(zeros.size, _MODE_BLOCK)",
        ],
        GUARDS: [  # the slow way to the same; and both polynomials hold at their common end
            *(
                f"{name}: {low} -> 2{low[1:]} in ({ends})"
                for name, ends in (("_ORDINARY", "1e-100, 1e+100"), ("_USUAL", "1e-20, 1e+20"))
                for low in ends.split(", ")
            ),
            *(
                f"{name}: reach * ROUNDED -> reach / ROUNDED"
                for name in ("sphere_on_plate", "correction", "correction_with_slope")
            ),
        ],
        BEYOND_ALL: [
            "direct: int(3.9 / eta) + 2 -> int(3.9 / eta) - 2",
            "direct: 3.9 -> 7.8 in 3.9 / eta",
            "direct: 2 -> 4 in int(3.9 / eta) + 2",
        ],
        SAME: [
            "_tabulated: rows[-1] + 0.0 * tau -> rows[-1] - 0.0 * tau",
            "with_slopes: piece.coefficients[-1] + 0.0 * t -> piece.coefficients[-1] - 0.0 * t",
            "with_slopes: 0.0 * t -> 0.0 / t",
        ],
    },
    "contact_thickness": {},
    "sensitivity": {
        SAME: [
            (
                f"_near_sums: {last}[-1][:, None] + 0.0 * s -> {last}[-1][:, None] - 0.0 * s"
            ) for last in ("(2 * count + 1) * law.terms", "law.tails")
        ] + 2 * ["_near_sums: 0.0 * s -> 0.0 / s"],
    },
}  # fmt: skip
"""Mutants that change no result, by the reason; every other one must be noticed."""

CASES: Mapping[str, Callable[[], list[Case]]] = {
    "contact_law": law_cases,
    "contact_points": law_cases,
    "contact_cells": series_cases,
    "contact_series": series_cases,
    "contact_thickness": sensitivity_cases,
    "sensitivity": sensitivity_cases,
}


@pytest.mark.parametrize("name", CASES)
def test_every_mutant_of_the_code_is_noticed_or_changes_nothing(name: str) -> None:
    assert_noticed(name, CASES[name](), EQUIVALENT[name])
