"""What a viscous contact knows of the law: force and depth by the radius, and what is elastic."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebder, chebfit, chebval

from derivation.scene.effects.edge import MAX_A_OVER_B
from derivation.scene.effects.effect import Array
from derivation.scene.law import ContactLaw, Shape

DEGREE, FITTED = 30, 1e-12
"""Degree of the law's tables, and the relative error up to which they stand for it."""
BEYOND = 2.0
"""How far a viscous contact's force may go beyond a calm one's, in Hertz's radii."""


class CurvePoints(NamedTuple):
    """Force [N] and indentation [m] of the law at radii [m], and their slopes by the radius."""

    force: Array
    depth: Array
    force_a: Array
    depth_a: Array


@dataclass(frozen=True)
class Curve:
    """The law's force and indentation by the contact radius."""

    law: ContactLaw

    def at(self, a: Array) -> CurvePoints:
        """Force and indentation at radii [m]."""
        law = self.law
        shape = law.at(a)
        slope = 2.0 * (a / law.model.R) * shape.slope
        force_a = law.stiffness(a, shape) * slope
        return CurvePoints(law.force(a, shape), law.indentation(a, shape), force_a, slope)


@dataclass(frozen=True)
class Tabled(Curve):
    """The same by polynomials of a/top, which cost less: of force and depth over their powers."""

    top: float
    table: Array

    def at(self, a: Array) -> CurvePoints:
        """Force and indentation at radii [m]; NaN beyond the top."""
        x = np.where(a <= self.top, a / self.top, np.nan)
        force, depth, force_x, depth_x = chebval(2.0 * x - 1.0, self.table)
        force_a = (3.0 * force + x * force_x) * x * x / self.top
        depth_a = (2.0 * depth + x * depth_x) * x / self.top
        return CurvePoints(force * x**3, depth * x * x, force_a, depth_a)


def tabled(x: Array, *values: Array) -> Array:
    """Chebyshev coefficients of polynomials through values at x in [0, 1], and of their slopes."""
    rows = np.array([chebfit(2.0 * x - 1.0, row, DEGREE) for row in values])
    slopes = np.zeros_like(rows)
    slopes[:, :-1] = 2.0 * chebder(rows, axis=1)
    return np.concatenate((rows, slopes)).T


def _knots() -> Array:
    """Chebyshev's points on [0, 1], twice as many as coefficients."""
    n = 2 * DEGREE
    return np.asarray((1.0 - np.cos(np.pi * (np.arange(n) + 0.5) / n)) / 2.0, dtype=np.float64)


def curve_of(law: ContactLaw, a: float) -> Curve:
    """The law up to a contact radius [m], which viscosity does not let grow."""
    top, x, direct = min(1.001 * a, law.limit), _knots(), Curve(law)
    found = direct.at(top * x)
    made = Tabled(law, top, tabled(x, found.force / x**3, found.depth / x**2))
    between = top * (x[1:] + x[:-1]) / 2.0
    pairs = zip(made.at(between), direct.at(between), strict=True)
    error = max(float(np.max(np.abs(one / other - 1.0))) for one, other in pairs)
    return made if error <= FITTED else direct


@dataclass(frozen=True)
class ElasticBending:
    """What of the plate's deflection does not lag: bending, on its edge, where that yields.

    Attributes
    ----------
    law
        Bending and edge alone; no effect where nothing is left of them.
    top
        Hertz's radius [m] up to which deflection over force is tabled.
    """

    law: ContactLaw
    top: float = 1.0
    table: Array | None = None

    def at(self, force: Array) -> tuple[Array, Array]:
        """Deflection [m] at forces [N], odd in them, and its slope [m/N]; NaN beyond the top."""
        if self.table is None:
            return np.zeros_like(force), np.zeros_like(force)
        x = self.law.hertz_radius(np.abs(force)) / self.top
        yields, slope = chebval(2.0 * np.where(x <= 1.0, x, np.nan) - 1.0, self.table)
        return force * yields, yields + x * slope / 3.0


def bending_of(law: ContactLaw, a: float) -> ElasticBending:
    """Bending and the edge; nothing where a thick plate's edge takes more than bending gives."""
    bent = law.only(lambda e: e.bends or e.other_edge)
    if not law.bends or float(bent.deflection(np.array([a])).slope[0]) <= 0.0:
        return ElasticBending(replace(law, effects=frozenset()))
    top, x = min(BEYOND * a, MAX_A_OVER_B * law.model.b), _knots()
    radius = top * x
    depth = radius * (radius / law.model.R) * bent.deflection(radius).depth
    force = law.force(radius, Shape(*(np.ones_like(x),) * 4))
    return ElasticBending(bent, top, tabled(x, depth / (1.0 + law.softness) / force))
