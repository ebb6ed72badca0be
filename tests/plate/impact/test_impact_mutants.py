"""The runtime of the impact with one thing wrong, in memory: the oracles notice it."""

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cache

import pytest
from mutated_code import (
    GUARDS,
    ORDER,
    SAME,
    SIZE,
    START,
    Case,
    Expected,
    named,
    survivors,
)

from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle import forces as contact_forces
from derivation.plate.impact.oracle import impact as contact_impact

Point = tuple[float, ...]
LAME = 0.36e9, 0.43e9

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
def impact_cases() -> list[Expected]:
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


# --- what changes nothing

STEPS = ["_STEPS: 60 -> 120 in _STEPS = 60", "_CLOSE: 1e-09 -> 2e-09 in _CLOSE = 1e-09"]
EQUIVALENT: Mapping[str, Mapping[str, Sequence[str]]] = {
    "impact": {
        ORDER: [
            *STEPS,
            "_deepest: 0.3 -> 0.6 in np.clip(1.0 + step, 0.3, 3.0)",
            "_deepest: 3.0 -> 6.0 in np.clip(1.0 + step, 0.3, 3.0)",
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
            "_solve: 1e+200 -> 2e+200 in np.minimum(np.ravel(hertz / h), 1e+200)",
            "_solve: ROUNDED * b -> ROUNDED / b",
            (
                "_far_deepest: kernels.far_work(known, end, rise(end)) * ROUNDED -> "
                "kernels.far_work(known, end, rise(end)) / ROUNDED"
            ),
            "_solve: 1 -> 2 in -1",  # any negative number says that there is none
        ],
        SIZE: [
            "_SCENES: 512 -> 1024 in _SCENES = 512",
            "_solve: 8 -> 16 in _parts(over_h.size, 8)",
        ],
    },
    "impact_shapes": {
        GUARDS: [
            "_far_shapes: 1.0 -> 2.0 in np.minimum(q / ratio, 1.0)",
            "_far_shapes: 0.0 -> 1 in np.where(outside, 0.0, left - gap)",
            "_far_shapes: 1.0 -> 2.0 in np.where(outside, 1.0, left)",
        ],
        SAME: [
            "_near_shapes: terms[-1][:, None] + 0.0 * s -> terms[-1][:, None] - 0.0 * s",
            "_near_shapes: tails[-1][:, None] + 0.0 * s -> tails[-1][:, None] - 0.0 * s",
            "_near_shapes: 0.0 * s -> 0.0 / s",
            "_near_shapes: 0.0 * s -> 0.0 / s",
        ],
    },
    "impact_kernels": {
        ORDER: [
            "deeper_step: 1 -> 2 in exponent - 1",
            "deeper_step: 2 -> 4 in residual * (exponent - 1) / 2",
            "deeper_step: exponent * residual * (inner + 1) -> exponent * residual / (inner + 1)",
            "deeper_step: exponent - 1 -> exponent + 1",
            "deeper_step: residual * (exponent - 1) -> residual / (exponent - 1)",
            "deeper_step: residual * (exponent - 1) / 2 -> residual * (exponent - 1) * 2",
        ],
    },
}
"""Mutants that change no result, by the reason; every other one must be noticed."""

USERS: Mapping[str, Sequence[str]] = {
    "impact_shapes": ["impact"],
    "impact_kernels": ["impact_shapes", "impact"],
}
"""By whose functions a module is judged that has none of its own."""
CASES: Mapping[str, Callable[[], Sequence[Expected]]] = {
    "impact": impact_cases,
    "impact_shapes": impact_cases,
    "impact_kernels": impact_cases,
}


@pytest.mark.parametrize("name", CASES)
def test_every_mutant_is_noticed_or_changes_nothing(name: str) -> None:
    found = [mutant.name for mutant in survivors(name, CASES[name](), USERS.get(name, ()))]
    assert sorted(found) == named(EQUIVALENT[name])
