"""Tables of a contact law with the modes of a plate: forces, depth and modal weights by radius."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.modal import ModalPlate, Modes
from derivation.scene.numerics.chebyshev import by_growth, chebyshev, knots
from generated.arrays import Double as Array
from generated.effect_kernels import hertz_force
from generated.pressure_kernels import force_of_waves

DEGREE, RESOLVED = 32, 0.75
"""Smallest degree of the tables, and its increase per largest wave number times a."""
DIGITS = 33.0
"""The degree of the tables for a sphere gives the relative accuracy exp(-DIGITS)."""
TAIL, LAST, FINER, HIGHEST = 1e-13, 4, 1.5, 150
"""Smallest tolerance for the last coefficients of force and depth, over the largest one; number of
these coefficients; factor by which the degree grows until they meet it, and largest degree."""


FLATTEST = 0.1
"""Least force over that of the law at the same radius: the plate is then nearly as curved as the
sphere, and the change by the curvature is no longer proportional to it."""
SMALL, STEPS = 1e-3, 2
"""Relative change of the force up to which the radius follows from the growth of the force alone;
number of Newton's steps for larger changes."""


class ContactSamples(NamedTuple):
    """The contact at radii, with derivatives `_a` with respect to the radius.

    `forces` has the contact force and then the forces that drive the shapes [N], in columns;
    `depth` is the quasi-static depth [m]; `weights_less_one` is s_j - 1 of each shape [1].
    """

    forces: Array
    forces_a: Array
    depth: Array
    depth_a: Array
    weights_less_one: Array
    less_a: Array

    @property
    def force(self) -> Array:
        """Contact force [N]."""
        return self.forces[:, 0]

    @property
    def force_a(self) -> Array:
        """Derivative of the contact force with respect to the radius [N/m]."""
        return self.forces_a[:, 0]

    @property
    def modal_forces(self) -> Array:
        """The forces that drive the shapes [N]."""
        return self.forces[:, 1:]


@dataclass(frozen=True)
class ContactTables:
    """Tables of a contact with dynamic modes, up to a contact radius `top` [m].

    With x the radius over `top`, `table` contains Chebyshev coefficients of the forces over x^3, of
    depth and s_j - 1 over x^2, and of the derivatives of both over x^2 and x: four tables with a
    row for each polynomial.

    If the plate is curved less or more than under a static load, the force at a given radius
    changes. `static_change` contains the coefficients of the change by the static curvature that is
    part of the law, over x^3 [N]; None if the law has the Hertz pressure, without any curvature.
    """

    modes: Modes
    R: float
    top: float
    table: Array
    pointwise: bool
    modulus: float
    static_change: Array | None

    @property
    def degree(self) -> int:
        """Degree of the polynomials."""
        return int(self.table.shape[1]) - 1

    def at(self, a: Array) -> ContactSamples:
        """Return the contact at radii [m]; NaN below 0 and above `top`."""
        x = self._places(a)
        powers = np.empty((4, *x.shape))
        np.multiply(x, x, out=powers[1])
        np.multiply(powers[1], x, out=powers[0])
        np.divide(powers[1], self.top, out=powers[2])
        np.divide(x, self.top, out=powers[3])
        # There are fewer polynomials to scale than values.
        scaled = powers[..., None] * chebyshev(2.0 * x - 1.0, self.degree)
        forces, squares, forces_a, squares_a = scaled @ self.table
        return ContactSamples(
            forces, forces_a, squares[:, 0], squares_a[:, 0], squares[:, 1:], squares_a[:, 1:]
        )

    def forces(self, a: Array) -> Array:
        """Return only the forces of `at`."""
        x = self._places(a)
        return np.asarray((x**3)[:, None] * chebyshev(2.0 * x - 1.0, self.degree) @ self.table[0])

    def radius_ratio(self, a: Array, q: Array) -> Array:
        """Return the contact radius over that of the law at the same force [1].

        A change of curvature that is the same everywhere under the contact acts like another radius
        of the sphere: it multiplies all forces of the law by the same factor. The factor is that of
        the force of waves on a half-space (step 20) over Hertz's, with the weights s_j of the law.
        The indentation at a given force does not change to first order, because
        s_j = dP_j/dP.

        Parameters
        ----------
        a
            Contact radii [m] of the law.
        q
            Deflection of each shape [m], shape (radii, shapes).
        """
        if self.static_change is None:
            return np.ones_like(a)
        x = self._places(a)
        polynomials = chebyshev(2.0 * x - 1.0, self.degree)
        # Only the required part of `at`; the factor x^3 of both forces is omitted until the end.
        less_a = (x / self.top)[:, None] * (polynomials @ self.table[3, :, 1:])
        force, static = polynomials @ self.table[0, :, 0], polynomials @ self.static_change
        waves = force_of_waves(np.array(self.modulus), a, np.vecdot(less_a, q))
        hertz = hertz_force(np.array(self.top), np.array(self.R), np.array(self.modulus))
        change = (waves / x**3 - static) / hertz
        lower = np.log(np.maximum(FLATTEST, 1.0 + change))
        narrower = -lower / (polynomials @ self.table[2, :, 0] / force)
        if (np.abs(lower) > SMALL).any():
            narrower = self._narrower(x, force, lower, narrower)
        return np.exp(narrower)

    def _narrower(self, x: Array, force: Array, lower: Array, guess: Array) -> Array:
        """Return the logarithm of the radius at which the law has a force divided by a factor.

        Parameters
        ----------
        x, force
            Radii over `top`, and the force over x^3 there [N].
        lower, guess
            Logarithm of the factor, and an estimate of the result, which is kept beyond `top`.
        """
        narrower = guess
        for _ in range(STEPS):
            ratio = np.exp(narrower)
            polynomials = chebyshev(2.0 * np.minimum(ratio * x, 1.0) - 1.0, self.degree)
            other = polynomials @ self.table[0, :, 0]
            growth = polynomials @ self.table[2, :, 0] / other
            narrower = narrower - (np.log(other / force) + 3.0 * narrower + lower) / growth
        return np.where(np.exp(narrower) * x <= 1.0, narrower, guess)

    def _places(self, a: Array) -> Array:
        """Return radii [m] over `top`; NaN below 0 and above it."""
        x = a / self.top
        x[~((a >= 0.0) & (a <= self.top))] = np.nan
        return x


def contact_of(
    law: ContactLaw, plate: ModalPlate, top: float, pointwise: bool, tail: float = TAIL
) -> ContactTables:
    """Return the tables of a law with the paper's edge and the modes of a plate.

    Parameters
    ----------
    top
        Largest contact radius [m].
    pointwise
        Whether the indentation is defined at the axis: s_j = 1.
    tail
        Largest value of the last coefficients over the largest one [1].
    """
    # sin(a phi) requires a polynomial of a degree above a phi/2.
    fastest = float(np.max(plate.removed.phi, initial=0.0))
    degree = max(DEGREE, int(16 + RESOLVED * top * fastest), _of_sphere(law, top))
    sampled = _sampled(law, top, degree)
    while degree < HIGHEST and not sampled.resolved(knots(degree)[1], tail):
        degree = math.ceil(FINER * degree)
        sampled = _sampled(law, top, degree)
    x, analysis, mean = knots(degree)
    a, growth = top * x, sampled.growth[:, None]

    def driven(modes: Modes) -> tuple[Array, Array]:
        """Return P_j over x^3, and s_j - 1."""
        weights_less_one = modes.modal_weights_less_one(a)
        forces = mean @ (analysis @ (growth * (1.0 + weights_less_one)))
        return forces, 0.0 * weights_less_one if pointwise else weights_less_one

    def moved(modes: Modes) -> Array:
        """Return the static deflection of modes over x^2."""
        modal_forces, weights_less_one = driven(modes)
        return np.asarray(
            (modal_forces * (1.0 + weights_less_one)) @ modes.compliance * x, dtype=np.float64
        )

    def curved(modes: Modes) -> Array:
        """Return the change of the force by the static curvature of modes over x^3."""
        growths = analysis @ (modes.modal_weights_less_one(a) / x[:, None] ** 2)
        bracket = chebyshev(2.0 * x - 1.0, degree) @ (by_growth(growths) + 2.0 * growths)
        growth = x / top * ((driven(modes)[0] * bracket) @ modes.compliance)
        return force_of_waves(np.array(law.modulus), a, growth)

    modal_forces, weights_less_one = driven(plate.modes)
    rest = sampled.depth - moved(plate.removed)
    static = curved(plate.removed) if law.solved and not pointwise else None
    if plate.added is not None:
        rest += moved(plate.added)
        static = None if static is None else static - curved(plate.added)
    values = np.column_stack(
        (sampled.force, modal_forces, rest, weights_less_one / x[:, None] ** 2)
    )
    table = analysis @ values
    growths = by_growth(table)
    count = table.shape[1] // 2
    growths[:, :count] += 3.0 * table[:, :count]  # d(x^3 f)/dx = x^2 (3 f + x f')
    growths[:, count:] += 2.0 * table[:, count:]
    tables = (table[:, :count], table[:, count:], growths[:, :count], growths[:, count:])
    static_change = None if static is None else analysis @ static
    R, modulus = law.model.R, law.modulus
    return ContactTables(plate.modes, R, top, np.array(tables), pointwise, modulus, static_change)


class _Samples(NamedTuple):
    """P over x^3, depth over x^2 and dP/dx over x^2 at the nodes, which are smooth in x.

    The mean of the last one, weighted by x^2, is P over x^3.
    """

    force: Array
    depth: Array
    growth: Array

    def resolved(self, analysis: Array, tail: float) -> bool:
        """Return whether the last coefficients of the polynomials are small enough."""
        sizes = np.abs(analysis @ np.column_stack(self))
        return bool(np.all(sizes[-LAST:] <= tail * np.max(sizes, axis=0)))


def _sampled(law: ContactLaw, top: float, degree: int) -> _Samples:
    """Return the law at the nodes of a degree, for radii [m] up to `top`."""
    x = knots(degree)[0]
    a = top * x
    shape = law.at(a)
    slope = 2.0 * (a / law.model.R) * shape.slope
    force, depth = law.force(a, shape), law.indentation(a, shape)
    return _Samples(force / x**3, depth / x**2, law.stiffness(a, shape) * slope * top / x**2)


def _of_sphere(law: ContactLaw, top: float) -> int:
    """Return the degree that a sphere requires, whose slope is infinite at the radius R.

    Chebyshev coefficients on [0, top] decrease as z^-n, with z + 1/z = 2 (2 R/top - 1).
    """
    if not law.spherical:
        return 0
    middle = 2.0 * law.model.R / top - 1.0
    return math.ceil(DIGITS / math.acosh(middle))
