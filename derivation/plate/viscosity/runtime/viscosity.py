"""Viscoelastic contact, P = P_e + A_v dP_e/dt: loss of speed, and bounds of its effect.

Arithmetic: the bound for the restitution extends that for the contact time.
"""

from __future__ import annotations

from math import inf
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from generated import viscosity_kernels as kernels
from generated.arrays import as_doubles, as_result, in_manifest, inside, quiet
from generated.viscosity_bounds import rebound_bounds, spiral_bounds


class ImpactExtremes(NamedTuple):
    """Largest values during an impact computed without viscosity, from which bounds follow.

    With indentation z, force P, energy U, s = sqrt(2 U/m) and Omega = P/(m s):

    Attributes
    ----------
    epsilon
        A_v (dP/dz) s/P [1].
    steepness
        d log P/d log z divided by its value at the turning point [1].
    fall, rise
        d log Omega/d log s is between -fall and rise [1].
    depth, radius
        d log z/d log s, and the same for the contact radius [1].
    energy
        U divided by the kinetic energy of the sphere, 1 without gravity [1].
    """

    epsilon: float
    steepness: float
    fall: float
    rise: float
    depth: float
    radius: float
    energy: float = 1.0


@in_manifest("x", domain="R > 0, m > 0, v0 > 0, 3 * lam > -2 * mu, mu > 0, viscous_time > 0")
@quiet
def viscous_number(
    R: ArrayLike,
    m: ArrayLike,
    v0: ArrayLike,
    lam: ArrayLike,
    mu: ArrayLike,
    viscous_time: ArrayLike,
) -> np.ndarray:
    """Compute the viscous parameter, which is proportional to the loss of speed to leading order.

    Formula (Kuwabara and Kono, 1987; Schwager and Poeschel, 1998)::

        x_v = (3/2) A_v (K/m)^(2/5) v0^(1/5),   K = (4/3) E* sqrt(R)

    Parameters
    ----------
    R : array_like
        sphere radius [m]; R > 0
    m : array_like
        sphere mass [kg]; m > 0
    v0 : array_like
        impact speed of the sphere [m/s]; v0 > 0
    lam, mu : array_like
        Lame constants of the plate [Pa]; mu > 0, 3 lam > -2 mu
    viscous_time : array_like
        retardation time of the viscoelastic contact [s]; viscous_time > 0

    Returns
    -------
    float or ndarray
        Viscous parameter x_v [1] in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import viscous_number
    >>> print(f"{viscous_number(0.01, 0.0327, 2.0, 22.5e9, 28.7e9, 1e-6):.6g}")
    0.0671614
    """
    kind, [R, m, v0, lam, mu, viscous_time] = as_doubles(R, m, v0, lam, mu, viscous_time)
    [R, m, v0] = inside([R, m, v0], R > 0, m > 0, v0 > 0)
    [lam, mu, viscous_time] = inside(
        [lam, mu, viscous_time], mu > 0, 3 * lam > -2 * mu, viscous_time > 0
    )
    return as_result(kernels.viscous_number_of_factors(R, m, v0, lam, mu, viscous_time), kind)


@in_manifest("e", domain="x_v >= 0")
@quiet
def restitution_weak(x_v: ArrayLike) -> np.ndarray:
    """Compute the restitution of a weakly viscoelastic contact to second order.

    Formula (Schwager and Poeschel, 1998; Ramirez et al., 1999)::

        e = 1 - C_1 x_v + (3/5) C_1^2 x_v^2,   C_1 = (4/5)^(2/5) B(3/5, 3/2) = 1.1534

    Parameters
    ----------
    x_v : array_like
        viscous parameter x_v [1]; x_v >= 0

    Returns
    -------
    float or ndarray
        Coefficient of restitution [1] in the shape of the argument; NaN outside the domain. The
        neglected terms are of order x_v^(5/2).

    Examples
    --------
    >>> from generated import restitution_weak
    >>> print(f"{restitution_weak(0.1):.6g}")
    0.892638
    """
    kind, [x_v] = as_doubles(x_v)
    [x_v] = inside([x_v], x_v >= 0)
    return as_result(kernels.restitution_of_number(x_v), kind)


def viscous_logarithms(extremes: ImpactExtremes) -> tuple[float, float, float, float, float]:
    """Return bounds of the factors by which viscosity can change the results of an impact.

    Parameters
    ----------
    extremes
        The impact without viscosity.

    Returns
    -------
    tuple of float
        Logarithms of the factors, not negative [1], for contact time, peak indentation, force,
        contact radius and restitution. They are inf where no bound is proved: for epsilon >= 1
        or steepness epsilon >= 2, or if the weight may prevent separation.
    """
    epsilon, steepness, *_, energy = extremes
    if not (epsilon < 1.0 and steepness * epsilon < 2.0):
        return inf, inf, inf, inf, inf
    longer, shorter, shallower, narrower, pull, weaker, energy_loss = spiral_bounds(*extremes)
    if not energy_loss < 1.0:
        return inf, inf, inf, inf, inf  # the weight may prevent separation
    leaving = max(rebound_bounds(energy_loss, epsilon, steepness, energy))
    time = max(longer, shorter)
    if energy > 1.0:  # a slower sphere needs more time to rise against its weight
        time += leaving
    return time, shallower, max(pull, weaker), narrower, leaving
