"""The contact law of a viscoelastic contact: force, indentation and elastic part, in tables."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebder, chebfit

from derivation.scene.contact_law.law import ContactLaw, Shape
from derivation.scene.effects.edge import MAX_A_OVER_B
from derivation.scene.numerics.chebyshev import chebyshev
from generated.arrays import Double as Array

DEGREE, FITTED = 30, 1e-12
"""Degree of the tables of the law, and the relative error up to which they are used."""
BEYOND = 2.0
"""Largest Hertz radius of the viscoelastic force over that of the elastic force."""


class CurvePoints(NamedTuple):
    """Force P [N], indentation d [m], dP/da and dd/da at contact radii a [m]."""

    force: Array
    depth: Array
    force_a: Array
    depth_a: Array


@dataclass(frozen=True)
class Curve:
    """Force and indentation of the law as functions of the contact radius."""

    law: ContactLaw

    def at(self, a: Array) -> CurvePoints:
        """Return force and indentation at radii [m]."""
        law = self.law
        shape = law.at(a)
        slope = 2.0 * (a / law.model.R) * shape.slope
        force_a = law.stiffness(a, shape) * slope
        return CurvePoints(law.force(a, shape), law.indentation(a, shape), force_a, slope)


@dataclass(frozen=True)
class TabulatedCurve(Curve):
    """Force and indentation by faster polynomials of x = a/top, for force/x^3 and depth/x^2."""

    top: float
    table: Array

    def at(self, a: Array) -> CurvePoints:
        """Return force and indentation at radii [m]; NaN above `top`."""
        x = np.where(a <= self.top, a / self.top, np.nan)
        force, depth, force_x, depth_x = _values(self.table, x)
        force_a = (3.0 * force + x * force_x) * x * x / self.top
        depth_a = (2.0 * depth + x * depth_x) * x / self.top
        return CurvePoints(force * x**3, depth * x * x, force_a, depth_a)


def tabulated(x: Array, *values: Array) -> Array:
    """Return Chebyshev coefficients of values at x in [0, 1] by least squares, and of slopes."""
    rows = np.array([chebfit(2.0 * x - 1.0, row, DEGREE) for row in values])
    slopes = np.zeros_like(rows)
    slopes[:, :-1] = 2.0 * chebder(rows, axis=1)
    return np.concatenate((rows, slopes)).T


def _values(table: Array, x: Array) -> tuple[Array, ...]:
    """Return the values of each column of a table at x in [0, 1]; NaN where x is NaN."""
    values = chebyshev(2.0 * x - 1.0, DEGREE) @ table
    return tuple(values[..., column] for column in range(table.shape[1]))


def _knots() -> Array:
    """Return Chebyshev points on [0, 1], twice as many as the degree."""
    n = 2 * DEGREE
    return np.asarray((1.0 - np.cos(np.pi * (np.arange(n) + 0.5) / n)) / 2.0, dtype=np.float64)


def curve_of(law: ContactLaw, a: float) -> Curve:
    """Return the law up to a contact radius [m], which viscosity does not increase."""
    top, x, direct = min(1.001 * a, law.limit), _knots(), Curve(law)
    points = direct.at(top * x)
    made = TabulatedCurve(law, top, tabulated(x, points.force / x**3, points.depth / x**2))
    between = top * (x[1:] + x[:-1]) / 2.0
    pairs = zip(made.at(between), direct.at(between), strict=True)
    error = max(float(np.max(np.abs(one / other - 1.0))) for one, other in pairs)
    return made if error <= FITTED else direct


@dataclass(frozen=True)
class ElasticBending:
    """The elastic part of the deflection in a viscoelastic contact: bending, with its edge.

    Attributes
    ----------
    law
        The law of bending and edge only; without effects if they do not apply.
    top
        Largest Hertz radius [m] of the table of deflection over force.
    table
        The table; None without elastic bending.
    """

    law: ContactLaw
    top: float = 1.0
    table: Array | None = None

    def at(self, force: Array) -> tuple[Array, Array]:
        """Return deflection [m] and its slope [m/N] at forces [N]; NaN above `top`."""
        if self.table is None:
            return np.zeros_like(force), np.zeros_like(force)
        x = self.law.hertz_radius(np.abs(force)) / self.top
        compliance, slope = _values(self.table, np.where(x <= 1.0, x, np.nan))
        return force * compliance, compliance + x * slope / 3.0


def bending_of(law: ContactLaw, a: float) -> ElasticBending:
    """Return elastic bending with the edge; none if the edge of a thick plate cancels bending."""
    bent = law.only(lambda e: e.bends or e.other_edge)
    if not law.bends or float(bent.deflection(np.array([a])).slope[0]) <= 0.0:
        return ElasticBending(replace(law, effects=frozenset()))
    top, x = min(BEYOND * a, MAX_A_OVER_B * law.model.b), _knots()
    radius = top * x
    depth = radius * (radius / law.model.R) * bent.deflection(radius).depth
    force = law.force(radius, Shape(*(np.ones_like(x),) * 4))
    return ElasticBending(bent, top, tabulated(x, depth / (1.0 + law.softness) / force))
