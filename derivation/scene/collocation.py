"""Collocation on an element of a contact in x = (t/T)^(1/6): nodes, Newton's step, polynomials."""

import math
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import legder, leggauss, legroots, legval, legvander

from derivation.scene.effects.effect import Array

ONSET = 6
"""t = T x^6: a half-space's onset goes by t^(1/2), a bent plate's by t^(1/3)."""
NEWTON = 30
"""Steps of Newton's iteration at most."""
_CLOSE, _NEARLY = 1e-15, 1e-12
NEXT = 1e-14
"""Size of a step of Newton's iteration, of the radii, that is rounding."""
_SAFETY = 0.9  # part of the length that the sizes of the coefficients allow
_LEAST = 0.01  # least square of a continued row, over the square at the end of its element
_HALVINGS = 60
_LOW = 0.1  # least over largest value at the nodes above which a row has no zero between them
_REAL = 1e-9  # largest imaginary part of a real root, due to rounding


class Radau(NamedTuple):
    """Nodes on (0, 1], the integral from 0 to each, and Legendre coefficients.

    `values` gives values at the nodes from coefficients; `ahead` slope and curvature, in lengths
    of the element, of the parabola through such values by least squares, at their end.
    """

    x: Array
    integral: Array
    analysis: Array
    values: Array
    ahead: Array


@cache
def radau(n: int) -> Radau:
    """Radau's nodes, the right end among them, and what becomes of values at them."""
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
    """Step of da/dx, so short that radii at most halve, and its own size; None if there is none.

    Parameters
    ----------
    system
        What the residual falls by per da/dx.
    by_x
        Integrals to the nodes.
    a
        Radii there.
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
    """Whether steps of the radii are rounding: tiny, or small and no longer falling."""
    return size <= _CLOSE or (size <= _NEARLY and size > 0.1 * before)


def converged(size: float, before: float, order: int, enough: float = NEXT) -> bool:
    """Whether the step after one of this size would be rounding, or small enough.

    Parameters
    ----------
    size, before
        Sizes of the last step and of the one before it, infinite if there was none.
    order
        Order of convergence: 2 of Newton's iteration, 1 where its slope is approximate.
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
    n, error = sizes.size, float(np.max(sizes[-2:]))
    if error > tolerance:
        return error, min(0.8, max(0.1, math.pow(0.1 * tolerance / error, 1.0 / n)))
    needed = n - int(np.argmax(sizes[::-1] > tolerance)) if np.any(sizes > tolerance) else 1
    return error, min(2.0, _SAFETY * n / (needed + 2))


class Element(NamedTuple):
    """Legendre coefficients on [x, x + length], a row per quantity, and of the slope solved for."""

    x: float
    length: float
    rows: Array
    slope: Array

    def at(self, x: Array) -> Array:
        """The rows at x."""
        return np.asarray(self.rows @ self._basis(x), dtype=np.float64)

    def slope_at(self, x: Array) -> Array:
        """That slope at x, within the element or somewhat beyond."""
        return np.asarray(self.slope @ self._basis(x), dtype=np.float64)

    def slope_beyond(self, row: int, x: Array) -> Array:
        """Slope of a row beyond the element, whose square goes on like a parabola.

        The square of a radius is smooth where the contact closes too.
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
        """Where a row first falls through zero, also if it rises again; None if it does not."""
        values = radau(self.slope.size).values @ self.rows[row]
        if values.min() > _LOW * values.max():
            return None
        roots = legroots(self.rows[row])
        inner = np.sort(roots.real[(np.abs(roots.imag) < _REAL) & (np.abs(roots.real) <= 1.0)])
        falls = inner[legval(inner, legder(self.rows[row])) < 0.0]
        if falls.size:
            return self.x + self.length * (1.0 + float(falls[0])) / 2.0
        return self.x + self.length if values[-1] <= 0.0 else None

    def end(self, row: int) -> float:
        """Where a row that is positive before it and negative after it falls through zero."""
        low, high = self.x, self.x + self.length
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            above = float(self.at(np.array([middle]))[row, 0]) > 0.0
            low, high = (middle, high) if above else (low, middle)
        return low

    def zero_near_end(self, row: int) -> float:
        """Where a row falls through zero, by Newton's step from the element's end."""
        values = self.rows[row]
        rise = 2.0 / self.length * float(legval(1.0, legder(values)))
        return self.x + self.length - (float(values.sum()) / rise if rise < 0.0 else 0.0)

    def largest(self, row: int) -> float:
        """The largest value of a row: at an end or where its slope is zero."""
        inner = legroots(legder(self.rows[row]))
        inner = inner.real[(np.abs(inner.imag) < _REAL) & (np.abs(inner.real) < 1.0)]
        basis = legvander(np.concatenate(([-1.0, 1.0], inner)), self.slope.size - 1)
        return float(np.max(basis @ self.rows[row]))
