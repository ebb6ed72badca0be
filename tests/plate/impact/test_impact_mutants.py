"""The runtime of the impact with one thing wrong, in memory: the oracles notice it."""

import math
from functools import cache

import pytest
from mutated_code import GUARDS, SIZE, START, Answer, Case, Expected, Judged, unnoticed

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
    return [
        Case("impact", [*every, *TOO_FAST], [*found, *nowhere]),
        *map(by_history, IMPACTS),
        *(to_the_end(*sizes) for sizes in ((0.6, 2.0, 2.0), (0.6, 6.0, 3.6))),
    ]


def to_the_end(h: float, b: float, end: float) -> Answer:
    """An impact whose contact becomes as wide as the plate, or as the law holds for."""
    R, m = 20.0, 3e7
    energy = contact_impact.stored_energy(math.nextafter(end, 0.0), R, h, b, *LAME, digits=18)
    scene = R, m, math.sqrt(2 * float(energy) / m), h, b, *LAME
    return Answer(lambda module: module.impact(*scene).max_contact_radius, end)


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


JUDGED = {
    "impact": Judged(
        impact_cases,
        {
            "_state": (7, START),
            "_deepest": (6, START),
            "_far_deepest": (1, START),
            "_solve": (3, f"{SIZE}; and {GUARDS}"),
            **dict.fromkeys(("_BATCH", "rise"), (1, SIZE)),
        },
        steps=6,
    ),
    "impact_shapes": Judged(
        impact_cases,
        {"_far_shapes": (1, GUARDS), "_POINTS": (1, SIZE)},
        users=["impact"],
        steps=6,
    ),
    "impact_kernels": Judged(
        impact_cases, {"deeper_step": (6, START)}, users=["impact_shapes", "impact"], steps=6
    ),
}


@pytest.mark.parametrize("name", JUDGED)
def test_every_mutant_is_noticed_or_may_pass(name: str) -> None:
    assert unnoticed(name, JUDGED[name]) == {}
