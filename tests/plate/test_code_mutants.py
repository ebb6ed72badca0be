"""Generated code of plate factors with one thing wrong, in memory: the oracles notice it."""

import math
from collections.abc import Mapping, Sequence

import pytest
from mutated_code import BEYOND_ALL, Case, Judged, unnoticed

from derivation.plate import oracle as balls

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


JUDGED = {
    "influence": Judged(
        influence_cases,
        {
            **dict.fromkeys(
                ("G", "G_m", "G_minus_1", "C_top", "C_bottom", "K_j", "K_j_bottom"), (2, BEYOND_ALL)
            ),
            "G_slope": (3, f"{BEYOND_ALL}; and a sign, which is squared"),
        },
    )
}


@pytest.mark.parametrize("name", JUDGED)
def test_every_mutant_is_noticed_or_may_pass(name: str) -> None:
    assert unnoticed(name, JUDGED[name]) == {}
