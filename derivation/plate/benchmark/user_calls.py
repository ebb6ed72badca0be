"""Times of the public functions of the contact law and the impact, called as by a user."""

from collections.abc import Callable
from functools import partial

import numpy as np

from derivation.plate.benchmark.speed import ROUNDS, SpeedTiming, interleaved, ratio, scenes
from generated import contact_law
from generated.impact import impact
from generated.prepared_plate import prepare

REPEATS = 200
"""Number of calls in a timed block."""
MICRO = 1e6
PLATE = 0.1, 1.0
"""h and b [m] of the plate."""
SOLID = 0.36e9, 0.43e9
"""lam and mu [Pa]."""
A, R = 0.004, 0.13
"""Contact radius and sphere radius [m]."""
SCENE = 0.13, 72.2, 1.0, *PLATE, *SOLID
"""R, m, v0, h, b, lam and mu of the paper's impact."""
PLATES, POINTS = 10, 1_000_000
SMALL = 100

Planned = tuple[str, Callable[[], SpeedTiming]]


def per_call(
    name: str, call: Callable[[], object], limit: float, repeats: int = REPEATS
) -> SpeedTiming:
    """Measure the time of one call [us] in blocks of `repeats` calls."""

    def block() -> None:
        for _ in range(repeats):
            call()

    (duration,), spread = interleaved((block,), ROUNDS)
    value = MICRO * duration / repeats
    return SpeedTiming(name, value, "µs", limit, spread, value <= limit)


def several_plates(own_axis_last: bool, limit: float) -> SpeedTiming:
    """Measure the indentation for ten plates over that for one, at the same points."""
    radii = np.random.default_rng(1).uniform(1e-3, 0.03, (PLATES, POINTS // PLATES))
    h, b = np.linspace(0.08, 0.12, PLATES)[:, None], PLATE[1]
    if own_axis_last:
        radii, h = np.ascontiguousarray(radii.T), h.T
    axis = "last" if own_axis_last else "first"
    name = (
        f"indentation of {POINTS:,} points, {PLATES} plates along the {axis} axis, relative to one"
    )
    return ratio(
        name,
        lambda: contact_law.indentation(radii, R, h, b),
        lambda: contact_law.indentation(radii, R, PLATE[0], b),
        limit,
    )


def comparisons() -> tuple[Planned, ...]:
    """Return the names of the comparisons, each with the function that measures it."""
    plate = prepare(*PLATE)
    delta = float(plate.indentation(A, R))
    small = np.linspace(0.1 * A, A, SMALL)
    depths, batch = plate.indentation(small, R), scenes(0.01, 2.9, SMALL)
    calls: tuple[tuple[str, Callable[[], object], float], ...] = (
        ("prepared plate, indentation of one value", lambda: plate.indentation(A, R), 30.0),
        ("prepared plate, force of one value", lambda: plate.force(delta, R, *SOLID), 30.0),
        ("prepare a plate", lambda: prepare(*PLATE), 1000.0),
        ("indentation of one value", lambda: contact_law.indentation(A, R, *PLATE), 1000.0),
        ("force of one value", lambda: contact_law.force(delta, R, *PLATE, *SOLID), 1000.0),
        (
            f"prepared plate, indentation of {SMALL} values",
            lambda: plate.indentation(small, R),
            300.0,
        ),
        (
            f"prepared plate, force of {SMALL} values",
            lambda: plate.force(depths, R, *SOLID),
            1500.0,
        ),
        ("impact of one scene", lambda: impact(*SCENE), 5000.0),
        (f"impact of {SMALL} scenes", lambda: impact(**batch), 20000.0),
    )
    return (
        *((name, partial(per_call, f"{name}, one call", call, limit, repeats))
          for (name, call, limit), repeats in zip(calls, (REPEATS,) * 7 + (20, 20), strict=True)),
        ("plates along the first axis", partial(several_plates, False, 2.0)),
        ("plates along the last axis", partial(several_plates, True, 4.0)),
    )  # fmt: skip
