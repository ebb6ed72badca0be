"""Generated code of plates and impacts with one thing wrong, in memory: the oracles notice it."""

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cache

import pytest
from code_cases import (
    BEYOND_ALL,
    GUARDS,
    LAME,
    ORDER,
    PROMISES,
    SAME,
    SIZE,
    START,
    STEPS,
    Case,
    Point,
    assert_noticed,
)

from derivation.plate import oracle as balls
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle import forces as contact_forces
from derivation.plate.impact.oracle import impact as contact_impact

Numbers = Mapping[str, float]


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


# R, m, v0, h, b
IMPACTS = [(0.13, 72.2, 1.0, 0.1, 1.0, *LAME), (0.13, 72.2, 1.0, 10.0, 1.0, *LAME),
           (2.0, 3e4, 12.0, 0.06, 0.6, *LAME)]  # fmt: skip
SLOW = [(0.13, 0.5, 1e-4, 0.1, 1.0, *LAME)]
SEAMS = [(2.0, 3e4, v0, 0.06, 0.6, *LAME) for v0 in (7.2, 7.5, 50.0)]
SEAMS += [(2.0, 3e4, 2.05, 0.06, 0.2, *LAME)]
"""On both sides of the first polynomial's end, a = 3 h, and before the last one's, 6 h."""
TOO_FAST = [
    (2.0, 3e4, 51.5, 0.06, 0.6, *LAME),
    (0.13, 72.2, 1e9, 0.1, 1.0, *LAME),
    (0.13, -1.0, 1.0, 0.1, 1.0, *LAME),
]


@cache
def impact_cases() -> list[Case]:
    every = [*IMPACTS, *SLOW, *SEAMS]
    found = [[float(x) for x in contact_impact.impact(*p, digits=18)] for p in every]
    nowhere = [[math.nan] * 4] * len(TOO_FAST)
    return [Case("impact", [*every, *TOO_FAST], [*found, *nowhere]), *map(by_history, IMPACTS)]


def by_history(scene: Point) -> Case:
    """Radii shortly after the start, half way and near the deepest, when they are reached."""
    time, _, _, largest = (float(x) for x in contact_impact.impact(*scene, digits=18))
    R, m, v0, h, b, lam, mu = scene
    radii = [0.3 * largest, 0.7 * largest, 0.97 * largest]
    times = [float(x) for x in contact_impact.history(radii, *scene, digits=18)]
    energy = [float(contact_impact.stored_energy(a, R, h, b, lam, mu, digits=18)) for a in radii]
    rows = [
        (
            float(contact_balls.indentation(a, R, h, b, digits=18)),
            math.sqrt(v0**2 - 2 * work / m),
            a,
            float(contact_forces.force_of_radius(a, R, lam, mu, digits=18)),
        )
        for a, work in zip(radii, energy, strict=True)
    ]
    again = [(depth, -speed, a, load) for depth, speed, a, load in rows]
    start, free = (0.0, v0, 0.0, 0.0), [(0.0, v0, 0.0, 0.0), (0.0, -v0, 0.0, 0.0)]
    moments = [0.0, *times, *(time - t for t in times), -0.1 * time, 1.1 * time]
    return Case("history", [(t, *scene) for t in moments], [start, *rows, *again, *free])


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
    "impact": {
        PROMISES: [
            "(COARSE_QUADRATURE, FULL_QUADRATURE): 9e-09 -> 1.8e-08 in (9e-09, 1e-14)",
            "(COARSE_QUADRATURE, FULL_QUADRATURE): 1e-14 -> 2e-14 in (9e-09, 1e-14)",
            "ROUNDING: 4e-14 -> 8e-14 in ROUNDING = 4e-14",
        ],
        ORDER: [
            *STEPS,
            *(f"_deepest: {change}" for change in HALLEY),
            "_state: 0.1 -> 0.2 in 0.1 * w",
            "_state: 1.0 -> 2.0 in np.clip(w + 2.0 * time * residual / slope, 0.1 * w, 1.0)",
            "_state: _CLOSE * goal -> _CLOSE / goal",
            "_far_deepest: _CLOSE * goal -> _CLOSE / goal",
        ],
        START: [
            "_state: 0.5 * whole[owner] -> 0.5 / whole[owner]",
            "_state: 0.5 -> 1.0 in 0.5 * whole[owner]",
            (
                "_state: np.minimum(goal / np.sqrt(half), 1.0) -> "
                "np.maximum(goal / np.sqrt(half), 1.0)"
            ),
            "_state: goal / np.sqrt(half) -> goal * np.sqrt(half)",
            "_state: np.sqrt(half) -> np.cbrt(half)",
            "_state: 1.0 -> 2.0 in np.minimum(goal / np.sqrt(half), 1.0)",
            "_deepest: 0.0 -> 1 in np.maximum(np.asarray(piece.coefficients[0]), 0.0)",
            "_deepest: 0.4 -> 0.8 in 0.4 / bending",
            "_deepest: 6.0 -> 12.0 in 1.0 / 6.0",
            (
                "_deepest: np.minimum(np.minimum(thin, 1.0), most) -> "
                "np.maximum(np.minimum(thin, 1.0), most)"
            ),
            "_deepest: np.minimum(thin, 1.0) -> np.maximum(thin, 1.0)",
            "_deepest: 1.0 -> 2.0 in np.minimum(thin, 1.0)",
            (
                "_far_deepest: np.minimum(near * (goal / known) ** 0.2, end) -> "
                "np.maximum(near * (goal / known) ** 0.2, end)"
            ),
            "_far_deepest: near * (goal / known) ** 0.2 -> near / (goal / known) ** 0.2",
            "_far_deepest: goal / known -> goal * known",
            "_far_deepest: 0.2 -> 1.2 in (goal / known) ** 0.2",
        ],
        GUARDS: [
            "history: 1.0 -> 2.0 in np.where(t > 0, t, 1.0)",
            "_far_shapes: 1.0 -> 2.0 in np.minimum(q / ratio, 1.0)",
            "_far_shapes: 0.0 -> 1 in np.where(outside, 0.0, left - gap)",
            "_far_shapes: 1.0 -> 2.0 in np.where(outside, 1.0, left)",
            "_solve: 1e+200 -> 2e+200 in np.minimum(np.ravel(hertz / h), 1e+200)",
            "_solve: ROUNDED * b -> ROUNDED / b",
            (
                "_far_deepest: (known + end ** 5 * rise(end)) * ROUNDED -> "
                "(known + end ** 5 * rise(end)) / ROUNDED"
            ),
            "_solve: 1 -> 2 in -1",  # any negative number says that there is none
        ],
        SAME: [
            "_near_shapes: terms[-1][:, None] + 0.0 * s -> terms[-1][:, None] - 0.0 * s",
            "_near_shapes: tails[-1][:, None] + 0.0 * s -> tails[-1][:, None] - 0.0 * s",
            "_near_shapes: 0.0 * s -> 0.0 / s",
            "_near_shapes: 0.0 * s -> 0.0 / s",
        ],
        SIZE: [
            "_SCENES: 512 -> 1024 in _SCENES = 512",
            "_solve: 8 -> 16 in _parts(over_h.size, 8)",
        ],
    },
}  # fmt: skip
"""Mutants that change no result, by the reason; every other one must be noticed."""

CASES: Mapping[str, Callable[[], list[Case]]] = {
    "influence": influence_cases,
    "impact": impact_cases,
}


@pytest.mark.parametrize("name", CASES)
def test_every_mutant_of_the_code_is_noticed_or_changes_nothing(name: str) -> None:
    assert_noticed(name, CASES[name](), EQUIVALENT[name])
