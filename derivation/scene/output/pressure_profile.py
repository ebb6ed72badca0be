"""The pressure over the distance from the axis, at the largest contact radius of an impact."""

from numbers import Integral

import numpy as np
from numpy.polynomial.chebyshev import chebval

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.errors import SceneError
from derivation.scene.kernels import hertz_profile
from derivation.scene.numerics.chebyshev import knots
from derivation.scene.numerics.crossing import rise
from derivation.scene.output.history import Pressures
from generated.arrays import Double as Array

NODES = 200
"""Number of nodes of the quadrature of the pressure."""
LARGEST = 1e3
"""Largest factor of the elastic pressure of a plastic contact."""

DIRECT, BLOCK = 2000, 4096
"""Largest number of distances at which the pressure is computed directly; number of distances at
which it is interpolated at once."""
DEGREES, ROUNDING = (32, 64, 128), 1e-14
"""Degrees of the interpolation, and its last coefficients over the largest one that suffice [1]."""


def pressure_profile(law: ContactLaw, a: float, force: float, points: int) -> Pressures:
    """Return the pressure of a contact, and Hertz's pressure of the same force.

    The elastic pressure at the contact radius is multiplied by a factor and limited where the
    contact yields, so that it carries the force.

    Parameters
    ----------
    a
        Contact radius [m].
    force
        Contact force [N].
    points
        Number of distances from the axis.

    Raises
    ------
    SceneError
        If the number of distances is less than 2.
    """
    if not (isinstance(points, Integral) and points >= 2):
        raise SceneError(f"points: expected a whole number of at least 2, got {points!r}")
    hertz = float(law.hertz_radius(np.array(force)))
    # Denser towards the contact edge, where the pressure falls as a square root.
    r = max(a, hertz) * np.sin(np.linspace(0.0, np.pi / 2, points))
    pressure = _factor(law, a, force) * _pressure(law, np.minimum(r, a), a)
    values = np.where(r < a, np.minimum(pressure, law.pressure_limit), 0.0)
    return Pressures(r, values, -hertz_profile(np.minimum(r, hertz), hertz, force))


def _pressure(law: ContactLaw, r: Array, a: float) -> Array:
    """Return the elastic pressure [Pa] at distances [m]; many of them are interpolated.

    Each distance takes an integral over all wave numbers. The pressure over sqrt(1 - (r/a)^2) is an
    analytic function of (r/a)^2, of which a polynomial differs by rounding errors.
    """
    if r.size <= DIRECT:
        return law.pressure(r, a)
    for degree in DEGREES:
        squares, analysis, _ = knots(degree)
        nodes = a * np.sqrt(squares)
        coefficients = analysis @ (law.pressure(nodes, a) / _width(nodes, a))
        if np.max(np.abs(coefficients[-4:])) <= ROUNDING * np.max(np.abs(coefficients)):
            blocks = np.array_split(r, -(-r.size // BLOCK))
            return np.concatenate(
                [
                    chebval(2.0 * (part / a) ** 2 - 1.0, coefficients) * _width(part, a)
                    for part in blocks
                ]
            )
    return law.pressure(r, a)


def _width(r: Array, a: float) -> Array:
    """Return sqrt(1 - (r/a)^2)."""
    return np.asarray(np.sqrt((a - r) * (a + r)) / a)


def _factor(law: ContactLaw, a: float, force: float) -> float:
    """Return the factor of the elastic pressure at a radius [m] with which it carries a force [N].

    It is 1 in a static elastic contact. On a plate with inertia the pressure is that of the law
    with another curvature of the plate, and Hertz's law gives the force of a plastic contact.
    """
    elastic = float(law.force(np.array([a]), law.at(np.array([a])))[0])
    if not law.plastic:
        return force / elastic
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    angles = 0.25 * np.pi * (1.0 + nodes)
    pressure = law.pressure(a * np.sin(angles), a)
    areas = 0.25 * np.pi**2 * a * a * np.sin(2.0 * angles) * weights

    def excess(factor: float) -> float:
        return float(areas @ np.minimum(factor * pressure, law.pressure_limit)) - force

    return rise(excess, 0.0, LARGEST) if excess(LARGEST) > 0.0 else LARGEST
