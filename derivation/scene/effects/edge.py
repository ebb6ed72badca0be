"""Edge: a simply supported or clamped plate instead of the paper's edge."""

import numpy as np

from derivation.scene import kernels
from derivation.scene.effects.effect import (
    Array,
    Bound,
    BoundContext,
    Contribution,
    PlateEffect,
    Reach,
    none_of,
)
from derivation.scene.model import Model

SUPPORTED, CLAMPED = "simply-supported", "clamped"
MAX_A_OVER_B = 0.9
"""Contact radius over plate radius up to which its sums are known."""


class Edge(PlateEffect):
    """The edge moment and force of the paper's edge taken away, or its displacement.

    By the exact polynomial states of bending and stretching; a clamp has w = 0 on the whole edge
    and forbids the plate's thinning there. See `edge.remainder` for what these leave.
    """

    name = "edge"
    adds = "a plate simply supported or clamped"
    equation = "F = (1 - nu)/(1 + nu) X supported, -X_c clamped"
    parameter = "edge's c_1 a/h, at most"
    source = "polynomial states of bending and stretching; link 19"
    reach = Reach(plate=MAX_A_OVER_B)
    other_edge = True

    def not_applicable_reason(self, model: Model) -> str:
        """The law begins with the paper's edge."""
        return "" if model.edge in (SUPPORTED, CLAMPED) else "the plate has the paper's edge"

    def value(self, model: Model, a: float) -> float:
        """Its share of the indentation over Hertz's at most, two thirds of its bound."""
        low, up = self._range(model, np.array([a]))
        return float(up[0] - low[0]) / 1.5

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """Of one sign; the bound holds at all smaller radii too."""
        return Bound(*self._range(model, context.radii))

    def _range(self, model: Model, a: Array) -> tuple[Array, Array]:
        """How far S may be below and above."""
        plate = model.h, model.b, model.lam, model.mu
        if model.edge == SUPPORTED:
            return none_of(a), kernels.supported_edge_bound(a, *plate)
        return kernels.clamped_edge_bound(a, *plate), none_of(a)

    def contribution(self, model: Model, a: Array) -> Contribution:
        """By sums over a few modes, or the thin plate's closed form."""
        plate = model.h, model.b, model.lam, model.mu
        if model.edge == SUPPORTED:
            runs = kernels.supported_edge, kernels.supported_edge_slope
        else:
            runs = kernels.clamped_edge, kernels.clamped_edge_slope
        return Contribution(*(run(a, *plate) for run in runs))
