"""Contacts with non-Hertzian pressure: solved, or interpolated between solved contacts.

The bounds on omitted effects and the motion need a contact at many radii. Its force, indentation,
stiffness and slope over those of Hertz's law are smooth functions of the radius, after the part of
the indentation that is proportional to the force is removed: it may be very large in a thin plate.
"""

from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebval

from derivation.scene import kernels
from derivation.scene.numerics.chebyshev import points
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from generated.non_hertzian_pressure import Contact, Plate

DEGREES = 23, 47
"""Degrees of the polynomials, tried in this order."""
TAIL = 1e-15
"""Largest of the last coefficients over the least value, with which a degree is sufficient [1]."""
NARROW = 0.5
"""Largest radius of the first polynomial, over the smallest one of h, b and R; each of the others
is for radii up to twice that of the one before."""
INTERPOLATION = 4e-14
"""Tested limit of the relative difference between an interpolated contact and its solution."""
MANY = 8192
"""Number of contacts whose polynomials are kept: those of scenes that are computed together."""


class SolvedCase(NamedTuple):
    """The quantities that determine the contact of a law at a radius.

    Attributes
    ----------
    h, b, R
        Half the thickness and radius of the plate, and radius of the sphere [m].
    modulus, plate_modulus
        E* of the contact and of the plate alone [Pa].
    edge
        Coefficient of (t^2 + s^2)/h^3 in the kernel by another edge [1].
    sphere
        Whether the profile is that of a sphere instead of its paraboloid.
    """

    h: float
    b: float
    R: float
    modulus: float
    plate_modulus: float
    edge: float
    sphere: bool


class SolvedShape(NamedTuple):
    """A contact over that of Hertz's law at the same radius, without the linear deflection [1].

    Attributes
    ----------
    force, depth, compliance, growth, centre
        Force P, indentation, d delta/dP, dP/da and pressure at the centre.
    """

    force: Array
    depth: Array
    compliance: Array
    growth: Array
    centre: Array

    def with_linear(self, linear: Array) -> tuple[Array, Array]:
        """Return indentation, and d delta/dP over that of Hertz's law at the same force.

        Parameters
        ----------
        linear
            d delta/dP of the linear deflection over that of Hertz's law at the same force [1].
        """
        root = np.cbrt(self.force)
        return self.depth + root * root * (2.0 / 3.0 * linear), root * self.compliance + linear


@lru_cache(maxsize=MANY)
def plate_of(h: float, b: float, edge: float) -> "Plate":
    """Return the kernel of a plate, see `generated.non_hertzian_pressure.plate`."""
    from generated import non_hertzian_pressure

    return non_hertzian_pressure.plate(h, b, edge)


@lru_cache(maxsize=MANY)
def linear_deflection(case: SolvedCase) -> float:
    """Return d delta/dP of the deflection proportional to the force, over Hertz's at 1 m [1/m].

    Hertz's is inversely proportional to the radius.
    """
    plate = plate_of(case.h, case.b, case.edge)
    return case.modulus / case.plate_modulus * plate.first / plate.unit


def shape_at(a: Array, case: SolvedCase, limit: float) -> SolvedShape:
    """Return the shape of contacts at radii [m].

    Parameters
    ----------
    a
        Contact radii [m], not too small.
    case
        Plate and sphere.
    limit
        Radius [m] up to which the contact is closed at its centre.
    """
    narrow = NARROW * min(case.h, case.b, case.R)
    panels = np.maximum(np.ceil(np.log2(a / narrow)), 0.0)
    shape = np.full((len(SolvedShape._fields), *a.shape), np.nan)
    for panel in sorted(set(panels[np.isfinite(panels)].tolist())):
        last = narrow * 2.0**panel
        first = last / 2.0 if panel else 0.0
        within = panels == panel
        shape[:, within] = _interpolated(a[within], case, first, min(last, limit))
    return SolvedShape(*shape)


def _interpolated(a: Array, case: SolvedCase, first: float, last: float) -> SolvedShape:
    """Return the shape at radii of one polynomial [m], which is between two radii."""
    table = _table(case, first, last) if np.max(a) <= last else None
    if table is None:
        return _shape(a, case)
    return SolvedShape(*chebval(2.0 * ((a - first) / (last - first)) - 1.0, table))


@lru_cache(maxsize=MANY)
def _table(case: SolvedCase, first: float, last: float) -> Array | None:
    """Return coefficients of the shape between two radii [m]; None if no degree is sufficient."""
    for degree in DEGREES:
        x, analysis = points(degree + 1, degree)
        a = first + (last - first) * x
        shape = _shape(a, case)
        # Depth and compliance of a thin plate may be 0 or negative without the linear deflection;
        # the error of pressures is relative to the mean pressure.
        root = np.cbrt(shape.force)
        depth, additive = shape.with_linear(linear_deflection(case) * a * root)
        whole = shape.force, depth, additive / root, shape.growth, shape.force
        table = analysis @ np.array(shape).T
        if np.all(np.abs(table[-2:]) <= TAIL * np.min(whole, axis=1)):
            return table
    return None


def _shape(a: Array, case: SolvedCase) -> SolvedShape:
    """Return the shape by the solution at each radius [m]."""
    one, R = _solved(a, case, linear=False), case.R
    bodies = np.asarray(R), np.asarray(case.modulus)
    force = one.force / kernels.hertz_force(a, *bodies)
    stiffness = one.stiffness / kernels.hertz_stiffness(a, bodies[1])
    growth = stiffness * one.slope * (R / a) / 2.0
    centre = one.centre_pressure / kernels.hertz_pressure(a, *bodies)
    return SolvedShape(force, one.indentation / a * (R / a), 1.0 / stiffness, growth, centre)


def pressure_at(r: Array, a: float, case: SolvedCase) -> Array:
    """Return the contact pressure [Pa] at distances r [m] from the axis, 0 <= r <= a."""
    from generated import non_hertzian_pressure

    h, b, R, modulus, plate_modulus, edge, sphere = case
    plate = plate_of(h, b, edge)
    return non_hertzian_pressure.pressure(r, plate, a, R, modulus, plate_modulus, sphere=sphere)


@lru_cache(maxsize=MANY)
def force_at(a: float, case: SolvedCase) -> float:
    """Return the force at a contact radius [m]; NaN if contact is lost at the centre."""
    return float(_solved(np.array([a]), case).force[0])


def centres_at(a: Array, case: SolvedCase) -> Array:
    """Return the pressure at the centre over the mean one at radii [m]; NaN if contact is lost."""
    contact = _solved(a, case)
    return np.asarray(contact.centre_pressure / contact.mean_pressure)


def _solved(a: Array, case: SolvedCase, linear: bool = True) -> "Contact":
    """Solve the integral equation at radii [m], with or without the linear deflection."""
    from generated import non_hertzian_pressure

    plate = plate_of(case.h, case.b, case.edge)
    if not linear:
        plate = plate._replace(first=0.0)
    bodies = case.R, case.modulus, case.plate_modulus
    return non_hertzian_pressure.contact(plate, a, *bodies, sphere=case.sphere)
