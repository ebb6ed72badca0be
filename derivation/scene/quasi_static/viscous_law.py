"""The contact law of viscoelastic contacts: force, indentation and elastic part, in tables.

Laws are those of one scene, or of many as columns.
"""

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from derivation.scene.contact_law.law import ContactLaw, Shape
from derivation.scene.effects.edge import MAX_A_OVER_B
from derivation.scene.effects.effect import Numbers
from derivation.scene.numerics.chebyshev import chebyshev, points
from derivation.scene.numerics.quadrature import mapped
from generated.arrays import Double as Array

DEGREES, FITTED = (3, 12, 30), 1e-12
"""Degrees of the tables of the law, and the relative error up to which they are used."""
NEGLIGIBLE = 1e-14
"""Sum of coefficients, over the first one, that are due to rounding and are omitted [1]."""
BEYOND = 2.0
"""Largest Hertz radius of the viscoelastic force over that of the elastic force."""
Mask = NDArray[np.bool_]


class Units(NamedTuple):
    """Units of radius [m], force [N] and indentation [m]: columns of many scenes, or numbers."""

    a: Numbers
    force: Numbers
    depth: Numbers


SI = Units(1.0, 1.0, 1.0)


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

    def cut(self, degree: int) -> "TabulatedCurve":
        """Return the curves by polynomials of a lower degree."""
        return TabulatedCurve(self.top, _cut(self.table, degree))


def _table(*values: Array) -> Array:
    """Return Chebyshev coefficients of values at `_knots`, in a column for each of them."""
    _, analysis = points(2 * DEGREES[-1], DEGREES[-1])
    return np.stack([mapped(analysis, each) for each in values], axis=-1)


def _cut(table: Array, degree: int) -> Array:
    """Return the coefficients up to a degree."""
    return np.ascontiguousarray(table[..., : degree + 1, :])


def _knots() -> Array:
    """Return Chebyshev points on [0, 1], twice as many as the degree."""
    return points(2 * DEGREES[-1], DEGREES[-1])[0]


def _values(table: Array, x: Array) -> tuple[Array, ...]:
    """Return the values of each column of a table at x in [0, 1]; NaN beyond."""
    values = chebyshev(2.0 * x - 1.0, table.shape[-2] - 1) @ table
    return tuple(values[..., column] for column in range(table.shape[-1]))


def degrees_of(curve: TabulatedCurve, bending: "ElasticBending") -> NDArray[np.intp]:
    """Return the one of `DEGREES` that suffices for each scene."""
    tables = [table for table in (curve.table, bending.table) if table is not None]
    sizes = np.abs(np.concatenate(tables, axis=-1))
    lowest = np.full(len(sizes), DEGREES[-1])
    for degree in DEGREES[-2::-1]:
        omitted = sizes[:, degree + 1 :].sum(axis=1)
        lowest[(omitted <= NEGLIGIBLE * sizes[:, 0]).all(axis=-1)] = degree
    return lowest


def tables_of(law: ContactLaw, a: Array, units: Units) -> tuple[TabulatedCurve, Mask]:
    """Return the laws up to contact radii [m] in tables, and which are accurate enough.

    Viscosity does not increase the radii, which are columns.
    """
    top, x, direct = np.minimum(1.001 * a, law.limit) / units.a, _knots(), Curve(law, units)
    at, square = direct.at(top * x), x * x
    values = at.force / (square * x), at.depth / square, at.force_a / square, at.depth_a / x
    curve = TabulatedCurve(top, _table(*values))
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

    def cut(self, degree: int) -> "ElasticBending":
        """Return the bending by polynomials of a lower degree."""
        if self.table is None:
            return self
        return replace(self, table=_cut(self.table, degree))


def part_of(numbers: Numbers, index: Any) -> Numbers:
    """Return the numbers of some of many scenes, or the same number of all scenes."""
    return numbers[index] if np.ndim(numbers) else numbers  # type: ignore[index]


def number_of(numbers: Numbers) -> float:
    """Return the number of a single scene."""
    return float(np.asarray(numbers).item())


def bending_of(law: ContactLaw, a: Numbers, units: Units = SI) -> ElasticBending:
    """Return elastic bending with the edge, up to contact radii [m], in some units.

    There is none if the edge of a thick plate cancels bending.
    """
    bent = law.only(lambda e: e.bends or e.other_edge)
    if not law.bends:
        return ElasticBending()
    some = bent.deflection(np.atleast_1d(a)).slope > 0.0
    if not some.any():
        return ElasticBending()
    top, x = np.minimum(BEYOND * a, MAX_A_OVER_B * law.model.b), _knots()
    radius = top * x
    one = np.ones_like(radius)
    force = law.force(radius, Shape(one, one, one, one)) * (1.0 + law.softness)
    per_force = radius * (radius / law.model.R) / force * (units.force / units.depth)
    plate = bent.deflection(radius)
    table = _table(per_force * plate.depth, per_force * plate.slope * (2.0 / 3.0))
    largest = np.atleast_1d(top)
    one = np.ones_like(largest)
    highest = law.force(largest, Shape(one, one, one, one)) / units.force
    if not some.all():
        table[~some[:, 0]], highest = 0.0, np.where(some, highest, np.inf)
    return ElasticBending(bent.other_edge, highest, table)
