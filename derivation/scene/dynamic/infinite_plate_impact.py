"""Integrates Zener's equation of an elastic impact on an infinite thin plate, with gravity."""

import math
from functools import lru_cache

import numpy as np

from derivation.scene import kernels
from derivation.scene.errors import SceneError
from generated.arrays import Double as Array

RTOL = 1e-10
"""Relative tolerance of the integration."""
SLOW = 10.0
"""A sphere without weight is in contact for less than SLOW (1 + zener)^2."""


@lru_cache(maxsize=64)
def infinite_plate_impact(
    zener: float, weight: float = 0.0, longest: float | None = None
) -> tuple[float, float]:
    """Return the contact time and the restitution of an elastic impact on an infinite thin plate.

    Units are the impact speed v0 and T^5 = m^2/(K^2 v0), K = (4/3) E* sqrt(R) (Zener, 1941).

    Parameters
    ----------
    zener
        Zener parameter [1].
    weight
        Gravitational acceleration, in units of v0/T.
    longest
        Time after which the contact is assumed never to end, in units of T; by default longer than
        any contact without gravity.

    Returns
    -------
    float
        Contact time in units of T; infinite if the contact does not end, which is possible with
        gravity.
    float
        Coefficient of restitution [1]; 0 if the contact does not end.

    Raises
    ------
    SceneError
        If the integration fails.
    """
    from scipy.integrate import solve_ivp

    parameters = np.array([zener, weight])

    def rate(_: float, state: Array) -> tuple[Array, Array]:
        return kernels.zener_rates(np.maximum(state[0], 0.0), state[1], *parameters)

    def released(_: float, state: Array) -> float:
        return float(state[0])

    released.terminal, released.direction = True, -1.0  # type: ignore[attr-defined]
    times, begin = (0.0, longest or SLOW * (1.0 + zener) ** 2), (0.0, 1.0)
    run = solve_ivp(rate, times, begin, "LSODA", events=released, rtol=RTOL, atol=1e-2 * RTOL)
    if run.status < 0:
        raise SceneError(
            "inertia.extent: expected a contact whose time can be computed, got the Zener "
            f'parameter {zener:.3g}; remove extent = "infinite"'
        )
    if run.status == 0:
        return math.inf, 0.0
    return float(run.t[-1]), max(0.0, -float(run.y[1, -1]))
