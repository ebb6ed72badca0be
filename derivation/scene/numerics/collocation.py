"""Collocation on a time element in x = (t/T)^(1/6): nodes, Newton's step, polynomials."""

import math
from collections.abc import Iterable
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import legder, leggauss, legroots, legval, legvander

from derivation.scene.numerics.crossing import rise
from generated.arrays import Double as Array

ONSET = 6
"""Exponent in t = T x^6: at first contact, a is analytic in t^(1/2) on a half-space and in t^(1/3)
on a plate that bends."""
NEWTON = 30
"""Largest number of steps of Newton's iteration."""
CLOSE, NEARLY = 1e-15, 1e-12
"""Relative steps of Newton's iteration that are due to rounding: in any case, and if they do not
decrease [1]."""
NEXT = 1e-14
"""Relative step of Newton's iteration that is due to rounding [1]."""
_GROWTH = 3.0  # largest factor of the length from one element to the next
_SAFETY = 0.9  # part of the length that the sizes of the coefficients allow
_LEAST = 0.01  # least square of a continued row, over the square at the end of its element
_LOW = 0.1  # least over largest value at the nodes above which a row has no zero between them
_REAL = 1e-9  # largest imaginary part of a real root, due to rounding
_ROSE = 1e-10  # least rise before a zero, over the largest value, that is not due to rounding


class Radau(NamedTuple):
    """Radau's nodes on (0, 1], and matrices that act on values at the nodes.

    `integral` gives the integrals from 0 to each node, `analysis` the Legendre coefficients, and
    `ahead` the linear and quadratic coefficient, at the end of the element, of a parabola fitted by
    least squares. `values` gives values at the nodes from coefficients.
    """

    x: Array
    integral: Array
    analysis: Array
    values: Array
    ahead: Array


@cache
def radau(n: int) -> Radau:
    """Return Radau's rule with n nodes, of which the last is the right end."""
    last = np.zeros(n + 1)
    last[n - 1 :] = 1.0
    nodes = np.sort(-legroots(last))
    nodes[-1] = 1.0
    values = legvander(nodes, n - 1)
    analysis = np.linalg.inv(values)
    x, weights = leggauss(n)
    half = (1.0 + nodes) / 2.0
    inner = legvander(np.outer(half, 1.0 + x) - 1.0, n - 1) @ analysis
    integral = np.einsum("i,j,ijk->ik", half, weights / 2.0, inner)
    weights = np.sqrt(0.025 + half)[:, None]
    fit = np.linalg.pinv(weights * np.vander(half - 1.0, 3, increasing=True)) * weights[:, 0]
    matrices = (np.asarray(x, dtype=np.float64) for x in (analysis, values, fit[1:]))
    return Radau(half, integral, *matrices)


def newton_step(
    system: Array, residual: Array, by_x: Array, a: Array
) -> tuple[Array, float] | None:
    """Return a step of da/dx, shortened so that no radius falls below half, and its full size.

    Parameters
    ----------
    system
        Decrease of the residual per da/dx.
    by_x
        Matrix of the integrals to the nodes.
    a
        Radii at the nodes.

    Returns
    -------
    tuple or None
        None if the system has no finite solution.
    """
    try:
        step = np.linalg.solve(system, residual)
    except np.linalg.LinAlgError:
        return None
    moved = by_x @ step
    size = float(np.abs(moved).max() / a.max())
    if not math.isfinite(size):
        return None
    shorter = step / max(1.0, -2.0 * float((moved / a).min()))
    return np.asarray(shorter, dtype=np.float64), size


def settled(size: float, before: float) -> bool:
    """Return whether steps are due to rounding: tiny, or small and no longer decreasing."""
    return size <= CLOSE or (size <= NEARLY and size > 0.1 * before)


def converged(size: float, before: float, order: int, enough: float = NEXT) -> bool:
    """Return whether the step after one of this size would be due to rounding, or small enough.

    Parameters
    ----------
    size, before
        Sizes of the last step and of the one before it, infinite if there was none.
    order
        Order of convergence: 2 for Newton's iteration, 1 with an approximate derivative.
    enough
        Size of a step that is small enough.
    """
    if settled(size, before):
        return True
    return size < before < math.inf and size * (size / before) ** order <= enough


def change_of_length(sizes: Array, tolerance: float) -> tuple[float, float]:
    """Return the error of an element and the factor for the length of the next.

    Both follow from the sizes of its Legendre coefficients.
    """
    n, error = sizes.size, float(sizes[-2:].max())
    if error > tolerance:
        return error, min(0.8, max(0.1, math.pow(0.1 * tolerance / error, 1.0 / n)))
    larger = sizes > tolerance
    needed = n - int(larger[::-1].argmax()) if larger.any() else 1
    return error, min(_GROWTH, _SAFETY * n / (needed + 2))


class Element(NamedTuple):
    """Legendre coefficients on [x, x + length]: a row for each quantity, and the slope da/dx."""

    x: float
    length: float
    rows: Array
    slope: Array

    def at(self, x: Array) -> Array:
        """Return the rows at x."""
        return np.asarray(self.rows @ self._basis(x), dtype=np.float64)

    def slope_at(self, x: Array) -> Array:
        """Return da/dx at x, within the element or slightly beyond it."""
        return np.asarray(self.slope @ self._basis(x), dtype=np.float64)

    def slope_beyond(self, row: int, x: Array) -> Array:
        """Return the slope of a row beyond the element, its square extrapolated by a parabola.

        The square of the radius is smooth even at the end of contact.
        """
        rule, s = radau(self.slope.size), (x - self.x) / self.length - 1.0
        square = (rule.values @ self.rows[row]) ** 2
        growth, bent = rule.ahead @ square
        ahead = np.maximum(square[-1] + s * (growth + s * bent), _LEAST * square[-1])
        slope = (0.5 * growth + s * bent) / (self.length * np.sqrt(ahead))
        return np.asarray(slope, dtype=np.float64)

    def _basis(self, x: Array) -> Array:
        s = 2.0 * (x - self.x) / self.length - 1.0
        return np.asarray(legvander(s, self.slope.size - 1).T, dtype=np.float64)

    def fall(self, row: int) -> float | None:
        """Return x where a row first falls through zero while the radius decreases, or None."""
        values = radau(self.slope.size).values @ self.rows[row]
        if values.min() > _LOW * values.max():
            return None
        roots = legroots(self.rows[row])
        inner = roots.real[(np.abs(roots.imag) < _REAL) & (np.abs(roots.real) <= 1.0)]
        # Rounding may hide a zero at the end.
        inner = np.append(np.sort(inner), 1.0) if values[-1] <= 0.0 else np.sort(inner)
        slope = legval(inner, legder(self.rows[row]))
        # At the start of a contact the force vanishes, and rounding causes zeros nearby.
        rose = -slope * (1.0 + inner) > _ROSE * values.max()
        falls = inner[rose & (legval(inner, self.slope) < 0.0)]
        return self.x + self.length * (1.0 + float(falls[0])) / 2.0 if falls.size else None

    def end(self, row: int) -> float:
        """Return x where a row with a single zero, positive before it, falls through zero."""
        values = self.rows[row]
        end = rise(lambda s: -float(legval(s, values)), -1.0, 1.0)
        return self.x + self.length * (1.0 + end) / 2.0

    def zero_near_end(self, row: int) -> float:
        """Return x where a row falls through zero, by Newton's step from the end."""
        values = self.rows[row]
        rise = 2.0 / self.length * float(legval(1.0, legder(values)))
        return self.x + self.length - (float(values.sum()) / rise if rise < 0.0 else 0.0)

    def largest(self, row: int) -> float:
        """Return the largest value of a row: at an end or where its slope is zero."""
        values = self.rows[row]
        slope = _slopes(values.size) @ values
        if 2.0 * abs(slope[0]) >= np.abs(slope).sum():  # it has no zero
            return max(float(values.sum()), float(values[::2].sum() - values[1::2].sum()))
        inner = legroots(slope)
        inner = inner.real[(np.abs(inner.imag) < _REAL) & (np.abs(inner.real) < 1.0)]
        basis = legvander(np.concatenate(([-1.0, 1.0], inner)), self.slope.size - 1)
        return float(np.max(basis @ values))


@cache
def _slopes(n: int) -> Array:
    """Return the matrix from Legendre coefficients to those of the slope on [-1, 1]."""
    return np.asarray(legder(np.eye(n)), dtype=np.float64)


def largest_of(elements: Iterable[Element], row: int) -> float:
    """Return the largest value of a row over all elements.

    The sum of the absolute coefficients is an upper bound, because no Legendre polynomial exceeds
    1. Elements with a bound below the largest value found are skipped.
    """
    largest = -math.inf
    bounds = [(float(np.abs(element.rows[row]).sum()), element) for element in elements]
    for bound, element in sorted(bounds, key=lambda pair: -pair[0]):
        if bound <= largest:
            break
        largest = max(largest, element.largest(row))
    return largest
