"""Gauss quadrature on [0, 1], and matrices that integrate the polynomial through the nodes."""

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import legder, leggauss, legint, legvander

from generated.arrays import Double as Array

NODES = (24, 48, 96, 192)
"""Numbers of nodes, tried in this order."""
MORE_TIMES = (384, 768, 1536)
"""Numbers of nodes in time for a slow, heavy sphere, whose motion changes fast at the start."""


class Rule(NamedTuple):
    """Nodes and weights on [0, 1], and matrices that act on values of a polynomial at the nodes.

    `u` and `u_weights` are nodes in time. `at_times` gives the polynomial at q = 1 - u^2,
    `work` the mean of q^4 times it over [1 - u^2, 1], `path` that of q times it; `derivative`
    its slope at the nodes x.
    """

    x: Array
    weights: Array
    u: Array
    u_weights: Array
    at_times: Array
    work: Array
    path: Array
    derivative: Array


def mapped(matrix: Array, values: Array) -> Array:
    """Multiply values along their last axis by a matrix, for one scene or many.

    Unlike those of a matrix product, the rounding errors of a scene do not depend on the others.
    """
    return np.asarray(np.vecdot(matrix, values[..., None, :]), dtype=np.float64)


@cache
def rule(n: int, times: int | None = None) -> Rule:
    """Return Gauss' rule with n nodes and its matrices; `times` nodes in time, by default n."""
    x, w = gauss(n)
    u, u_weights = gauss(times or n)
    analysis = analysis_of(n)

    def values(q: Array) -> Array:
        return np.asarray(legvander(2.0 * q - 1.0, n - 1) @ analysis, dtype=np.float64)

    q = 1.0 - u * u
    inner = q[:, None] + (1.0 - q)[:, None] * x
    spread = values(inner)
    work = np.einsum("ij,ijk->ik", w * inner**4, spread)
    path = np.einsum("ij,ijk->ik", w * inner, spread)
    return Rule(x, w, u, u_weights, values(q), work, path, derivative(n))


@cache
def _on_both_sides(n: int) -> tuple[Array, Array]:
    """Return Gauss' nodes and weights on [-1, 1]."""
    nodes, weights = leggauss(n)
    return nodes, weights


@cache
def analysis_of(n: int) -> Array:
    """Return the matrix of the Legendre coefficients of the polynomial through the nodes."""
    nodes, weights = _on_both_sides(n)
    return np.asarray((legvander(nodes, n - 1) * weights[:, None] * (np.arange(n) + 0.5)).T)


@cache
def derivative(n: int) -> Array:
    """Return the matrix of the slope of a polynomial at the nodes."""
    slopes = legder(np.eye(n), axis=0)
    return np.asarray(2.0 * legvander(_on_both_sides(n)[0], n - 2) @ slopes @ analysis_of(n))


@cache
def up_to(n: int) -> Array:
    """Return the matrix of the integral of a polynomial from 0 to each node."""
    integrals = legint(np.eye(n), lbnd=-1, axis=0)
    return np.asarray(0.5 * legvander(_on_both_sides(n)[0], n) @ integrals @ analysis_of(n))


@cache
def stored(n: int) -> Array:
    """Return the matrix of the integral of q^4 times a polynomial from 0 to each node."""
    x, w = gauss(n)
    inner = np.outer(x, x)
    values = legvander(2.0 * inner - 1.0, n - 1) @ analysis_of(n)
    return np.asarray(np.einsum("i,ij,ijk->ik", x, w * inner**4, values), dtype=np.float64)


@cache
def gauss(n: int) -> tuple[Array, Array]:
    """Return Gauss' nodes and weights on [0, 1]; for many nodes by SciPy, which is faster."""
    if n > NODES[-1]:
        from scipy.special import roots_legendre

        nodes, weights = roots_legendre(n)
    else:
        nodes, weights = _on_both_sides(n)
    return ((1.0 + nodes) / 2.0).astype(np.float64), (weights / 2.0).astype(np.float64)
