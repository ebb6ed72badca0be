"""Generated code of the contact law with one thing wrong, in memory: the oracles notice it."""

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Any

import pytest
from mutated_code import BEYOND_ALL, GUARDS, ORDER, SAME, START, Case, named, survivors

from derivation.plate import oracle as balls
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle import forces as contact_forces

Point = tuple[float, ...]
Numbers = Mapping[str, float]
LAME = 0.36e9, 0.43e9


# --- what the oracles say


def by_chain(name: str, points: Sequence[dict[str, float]], outside: Sequence[Numbers]) -> Case:
    true = [float(balls.truth(name, point, 20)) for point in points]
    values = [tuple(point.values()) for point in (*points, *outside)]
    return Case(name, values, [*true, *(math.nan for _ in outside)])


def influence_cases() -> list[Case]:
    """Thin to thick: to where e^(-T) underflows, though what it is part of does not.

    And both sides of where the domain begins, at phi h = 1e-151 or T = 1e-151.
    """
    thinnest, too_thin = {"phi": 1.5e-151, "h": 1.0}, {"phi": 1e-100, "h": 1e-100}
    T = [{"T": x} for x in (0.7, 0.02, 2.5, 30.0, 200.0, 352.5, 705.0, 1.5e-151)]
    elastic = [(1.3, 0.7), (-0.5, 0.8), (-1.8, 3.0), (1.3, 0.7), (-1.9e-30, 3e-30)]
    sizes = (0.7, 0.02, 2.5, 40.0, 705.0)
    faces = [
        {"phi": 2 * x, "h": 0.25, "lam": lam, "mu": mu}
        for x, (lam, mu) in zip(sizes, elastic, strict=True)
    ]
    faces.append({"phi": 735.0 * 2, "h": 0.25, "lam": 1e-30, "mu": 1e-30})
    faces.append(faces[0] | thinnest)
    K = [{"phi": 2 * x, "h": 0.25, "b": 0.6, "R": 0.7, "J1": 0.4} for x in sizes]
    K += [{"phi": 1470.0, "h": 0.25, "b": 1e-20, "R": 1e-20, "J1": 1.0}, K[0] | thinnest]
    return [
        *(
            by_chain(name, T, [{"T": 0.0}, {"T": -1.0}, {"T": 0.9e-151}])
            for name in ("G", "G_m", "G_minus_1", "G_slope")
        ),
        *(
            by_chain(
                name,
                faces,
                [faces[0] | wrong for wrong in ({"lam": -0.7, "mu": 1.0}, {"mu": -1.0}, too_thin)],
            )
            for name in ("C_top", "C_bottom")
        ),
        *(
            by_chain(name, K, [K[0] | too_thin, *(K[0] | {key: 0.0} for key in K[0])])
            for name in ("K_j", "K_j_bottom")
        ),
    ]


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


OUTER = "exponent * residual * (1.0 + 0.5 * (exponent - 1.0) * residual)"
INNER = "1.0 + 0.5 * (exponent - 1.0) * residual"
HALLEY = [
    f"{OUTER} -> {OUTER.replace('* (1', '/ (1')}",
    f"{INNER} -> {INNER.replace('+', '-')}",
    "0.5 * (exponent - 1.0) -> 0.5 / (exponent - 1.0)",
    "0.5 -> 1.0 in 0.5 * (exponent - 1.0)",
    "exponent - 1.0 -> exponent + 1.0",
    "1.0 -> 2.0 in exponent - 1.0",
    "0.3 -> 0.6 in np.clip(1.0 + step, 0.3, 3.0)",
    "3.0 -> 6.0 in np.clip(1.0 + step, 0.3, 3.0)",
]
"""Halley's share of the step, and the clip of a step too far."""
STEPS = ["_STEPS: 60 -> 120 in _STEPS = 60", "_CLOSE: 1e-09 -> 2e-09 in _CLOSE = 1e-09"]
THIN = "1.0 / np.cbrt(eps * linear)"

EQUIVALENT: Mapping[str, Mapping[str, Sequence[str]]] = {
    "influence": {
        BEYOND_ALL: [
            f"{name}: {change} in {where}"
            for name, T in (
                *((name, "T") for name in ("G", "G_m", "G_minus_1", "G_slope")),
                *((name, "h * phi") for name in ("C_top", "C_bottom", "K_j", "K_j_bottom")),
            )
            for change, where in (
                ("1000000000 -> 2000000000", f"np.minimum({T}, 1000000000)"),
                ("5e-324 -> 1e-323", f"np.maximum(np.minimum({T}, 1000000000), 5e-324)"),
            )
        ],
        SAME: ["G_slope: -np.expm1(-2 * T) -> np.expm1(-2 * T)"],  # it is squared
    },
    "contact_law": {
        ORDER: [*STEPS, *(f"_invert: {change}" for change in HALLEY[-2:])],
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
}  # fmt: skip
"""Mutants that change no result, by the reason; every other one must be noticed."""

CASES: Mapping[str, Callable[[], list[Case]]] = {
    "influence": influence_cases,
    "contact_law": law_cases,
}


@pytest.mark.parametrize("name", CASES)
def test_every_mutant_of_the_code_is_noticed_or_changes_nothing(name: str) -> None:
    found = [mutant.name for mutant in survivors(name, CASES[name]())]
    assert sorted(found) == named(EQUIVALENT[name])
