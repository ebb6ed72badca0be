"""Gauss' rule on [0, 1], and matrices that integrate the polynomial through its nodes."""

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import legder, leggauss, legvander

from derivation.scene.effects.effect import Array

NODES = (24, 48, 96, 192)
"""Numbers of nodes tried."""


class Rule(NamedTuple):
    """Nodes x and weights on [0, 1], and what they do to values of a polynomial at them.

    `at_times` gives its values at 1 - x^2, `work` the mean of q^4 times it over [1 - x^2, 1],
    `path` that of q times it; `derivative` its slope at the nodes.
    """

    x: Array
    weights: Array
    at_times: Array
    work: Array
    path: Array
    derivative: Array


@cache
def rule(n: int) -> Rule:
    """Gauss' rule of n nodes and its matrices."""
    nodes, weights = leggauss(n)
    x, w = ((1.0 + nodes) / 2.0).astype(np.float64), (weights / 2.0).astype(np.float64)
    # Legendre coefficients of the polynomial through values at the nodes.
    analysis = (legvander(nodes, n - 1) * weights[:, None] * (np.arange(n) + 0.5)).T

    def values(q: Array) -> Array:
        return np.asarray(legvander(2.0 * q - 1.0, n - 1) @ analysis, dtype=np.float64)

    q = 1.0 - x * x
    inner = q[:, None] + (1.0 - q)[:, None] * x
    spread = values(inner)
    slopes = legder(np.eye(n), axis=0)
    derivative = 2.0 * legvander(nodes, n - 2) @ slopes @ analysis
    work = np.einsum("ij,ijk->ik", w * inner**4, spread)
    path = np.einsum("ij,ijk->ik", w * inner, spread)
    return Rule(x, w, values(q), work, path, derivative)
