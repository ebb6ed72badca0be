"""The contact law of viscoelastic contacts: force, indentation and elastic part, in tables.

Laws are those of one scene, or of many as columns.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from derivation.scene import kernels
from derivation.scene.contact_law.law import ContactLaw, Shape
from derivation.scene.effects.edge import MAX_A_OVER_B
from derivation.scene.effects.effect import Numbers
from derivation.scene.numerics.chebyshev import by_growth, chebyshev, points
from derivation.scene.numerics.quadrature import mapped
from generated.arrays import Double as Array

DEGREE, FITTED = 30, 1e-12
"""Degree of the tables of the law, and the relative error up to which they are used."""
BEYOND = 2.0
"""Largest Hertz radius of the viscoelastic force over that of the elastic force."""
Mask = NDArray[np.bool_]


class Units(NamedTuple):
    """Units of radius [m], force [N] and indentation [m]: columns of many scenes, or numbers."""

    a: Numbers
    force: Numbers
    depth: Numbers


class CurvePoints(NamedTuple):
    """Force P, indentation d, dP/da and dd/da at contact radii a."""

    force: Array
    depth: Array
    force_a: Array
    depth_a: Array


@dataclass(frozen=True)
class Curve:
    """Force and indentation of the law as functions of the contact radius, in some units."""

    law: ContactLaw
    units: Units

    def at(self, a: Array) -> CurvePoints:
        """Return force and indentation at radii."""
        law, unit = self.law, self.units
        radius = unit.a * a
        shape = law.at(radius)
        slope = 2.0 * (radius / law.model.R) * shape.slope
        return CurvePoints(
            law.force(radius, shape) / unit.force,
            law.indentation(radius, shape) / unit.depth,
            law.stiffness(radius, shape) * slope * (unit.a / unit.force),
            slope * (unit.a / unit.depth),
        )

    def take(self, index: Any) -> "Curve":
        """Return the curves of some of many scenes."""
        return Curve(self.law.take(index), Units(*(part_of(x, index) for x in self.units)))


@dataclass(frozen=True)
class TabulatedCurve:
    """Force and indentation by faster polynomials of x = a/top.

    Attributes
    ----------
    top
        Largest radius, in a column.
    table
        Coefficients for each scene: columns for P/x^3, d/x^2, (dP/da)/x^2 and (dd/da)/x.
    """

    top: Array
    table: Array

    def at(self, a: Array) -> CurvePoints:
        """Return force and indentation at radii; NaN above `top`."""
        x = a / self.top
        force, depth, force_a, depth_a = _values(self.table, x)
        square = x * x
        return CurvePoints(force * (square * x), depth * square, force_a * square, depth_a * x)

    def take(self, index: Any) -> "TabulatedCurve":
        """Return the curves of some of many scenes."""
        return TabulatedCurve(self.top[index], self.table[index])


def _coefficients(values: Array, degree: int) -> Array:
    """Return Chebyshev coefficients up to a degree of values at `_knots`."""
    return mapped(points(2 * degree + 2, degree)[1], values)


def _grown(coefficients: Array) -> Array:
    """Return the Chebyshev coefficients of x df/dx."""
    return mapped(_growth(coefficients.shape[-1]), coefficients)


@cache
def _growth(count: int) -> Array:
    """Return the matrix of `_grown`."""
    return by_growth(np.eye(count)) if count > 1 else np.zeros((1, 1))


def _values(table: Array, x: Array) -> tuple[Array, ...]:
    """Return the values of each column of a table at x in [0, 1]; NaN beyond."""
    values = chebyshev(2.0 * x - 1.0, table.shape[-2] - 1) @ table
    return tuple(values[..., column] for column in range(table.shape[-1]))


def _table(*columns: Array) -> Array:
    """Return coefficients as the columns of a table of each scene."""
    return np.ascontiguousarray(np.stack(columns, axis=-1))


def _knots(degree: int) -> Array:
    """Return Chebyshev points on [0, 1], about twice as many as the degree."""
    return points(2 * degree + 2, degree)[0]


def tables_of(law: ContactLaw, a: Array, units: Units) -> tuple[TabulatedCurve, Mask]:
    """Return the laws up to contact radii [m] in tables, and which are accurate enough.

    Viscosity does not increase the radii, which are columns. Hertz's law needs no degree.
    """
    degree = 0 if law.hertzian else DEGREE
    top, direct = np.minimum(1.001 * a, law.limit) / units.a, Curve(law, units)
    x = _knots(degree)
    at, square = direct.at(top * x), x * x
    force = _coefficients(at.force / (square * x), degree)
    depth = _coefficients(at.depth / square, degree)
    force_a, depth_a = (3.0 * force + _grown(force)) / top, (2.0 * depth + _grown(depth)) / top
    curve = TabulatedCurve(top, _table(force, depth, force_a, depth_a))
    x = _knots(DEGREE)
    between = top * ((x[1:] + x[:-1]) / 2.0)
    pairs = zip(curve.at(between), direct.at(between), strict=True)
    errors = [np.max(np.abs(one / other - 1.0), axis=-1) for one, other in pairs]
    return curve, np.maximum.reduce(errors) <= FITTED


@dataclass(frozen=True)
class ElasticBending:
    """The elastic part of the deflection in a viscoelastic contact: bending, with its edge.

    Attributes
    ----------
    other_edge
        Whether the edge of the plate differs from the paper's.
    top
        Largest force of the table; infinite for scenes without bending.
    table
        Deflection over force, and slope of the deflection, as columns of coefficients in x, the
        Hertz radius of the force over that of `top`; None without elastic bending.
    """

    other_edge: bool = False
    top: Numbers = 1.0
    table: Array | None = None

    def at(self, force: Array) -> tuple[Array, Array]:
        """Return deflections and their slopes at forces; NaN above `top`."""
        if self.table is None:
            return np.zeros_like(force), np.zeros_like(force)
        compliance, slope = _values(self.table, np.cbrt(np.abs(force) / self.top))
        return force * compliance, slope

    def take(self, index: Any) -> "ElasticBending":
        """Return the bending of some of many scenes."""
        if self.table is None:
            return self
        return ElasticBending(self.other_edge, part_of(self.top, index), self.table[index])


def part_of(numbers: Numbers, index: Any) -> Numbers:
    """Return the numbers of some of many scenes, or the same number of all scenes."""
    return numbers[index] if np.ndim(numbers) else numbers  # type: ignore[index]


def bending_of(
    law: ContactLaw, a: Numbers, units: Units = Units(1.0, 1.0, 1.0)
) -> ElasticBending:
    """Return elastic bending with the edge, up to contact radii [m], in some units.

    There is none if the edge of a thick plate cancels bending.
    """
    bent = law.only(lambda e: e.bends or e.other_edge)
    if not law.bends:
        return ElasticBending()
    some = bent.deflection(np.atleast_1d(a)).slope > 0.0
    if not some.any():
        return ElasticBending()
    top, x = np.minimum(BEYOND * a, MAX_A_OVER_B * law.model.b), _knots(DEGREE)
    radius = top * x
    depth = radius * (radius / law.model.R) * bent.deflection(radius).depth
    one = np.ones_like(radius)
    force, depth = law.force(radius, Shape(one, one, one, one)), depth / (1.0 + law.softness)
    compliance = _coefficients((depth / units.depth) / (force / units.force), DEGREE)
    table = _table(compliance, compliance + _grown(compliance) / 3.0)
    largest = np.atleast_1d(top)
    one = np.ones_like(largest)
    highest = law.force(largest, Shape(one, one, one, one)) / units.force
    if not some.all():
        table[~some[:, 0]], highest = 0.0, np.where(some, highest, np.inf)
    return ElasticBending(bent.other_edge, highest, table)
