"""Collocation on an element: Radau's nodes, and what is found at them as polynomials."""

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import legder, leggauss, legroots, legvander

from derivation.scene.effects.effect import Array

_HALVINGS, _REAL = 60, 1e-9


class Radau(NamedTuple):
    """Nodes on (0, 1], the integral from 0 to each, and Legendre coefficients."""

    x: Array
    integral: Array
    analysis: Array


@cache
def radau(n: int) -> Radau:
    """Radau's nodes, the right end among them, and what becomes of values at them."""
    last = np.zeros(n + 1)
    last[n - 1 :] = 1.0
    nodes = np.sort(-legroots(last))
    nodes[-1] = 1.0
    analysis = np.linalg.inv(legvander(nodes, n - 1))
    x, weights = leggauss(n)
    half = (1.0 + nodes) / 2.0
    values = legvander(np.outer(half, 1.0 + x) - 1.0, n - 1) @ analysis
    integral = np.einsum("i,j,ijk->ik", half, weights / 2.0, values)
    return Radau(half, integral, np.asarray(analysis, dtype=np.float64))


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

    def _basis(self, x: Array) -> Array:
        s = 2.0 * (x - self.x) / self.length - 1.0
        return np.asarray(legvander(s, self.slope.size - 1).T, dtype=np.float64)

    def end(self, row: int) -> float:
        """Where a row falls through zero."""
        low, high = self.x, self.x + self.length
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            above = float(self.at(np.array([middle]))[row, 0]) > 0.0
            low, high = (middle, high) if above else (low, middle)
        return low

    def largest(self, row: int) -> float:
        """The largest value of a row: at an end or where its slope is zero."""
        inner = legroots(legder(self.rows[row]))
        inner = inner.real[(np.abs(inner.imag) < _REAL) & (np.abs(inner.real) < 1.0)]
        basis = legvander(np.concatenate(([-1.0, 1.0], inner)), self.slope.size - 1)
        return float(np.max(basis @ self.rows[row]))
