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
from derivation.scene.support_series import support_share

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
        if model.edge == SUPPORTED and a.ndim > 1:
            return self._supported(model, a)
        plate = model.h, model.b, model.lam, model.mu
        if model.edge == SUPPORTED:
            runs = kernels.supported_edge, kernels.supported_edge_slope
        else:
            runs = kernels.clamped_edge, kernels.clamped_edge_slope
        return Contribution(*(run(a, *plate) for run in runs))

    def _supported(self, model: Model, a: Array) -> Contribution:
        """The sums of many plates by their series, and of wide contacts as they are."""
        depth, slope = support_share(model.supports, a / model.b)
        wide = np.isnan(depth) & np.isfinite(a)
        if wide.any():
            plate = (np.broadcast_to(x, a.shape)[wide] for x in model.numbers[3:])
            h, b, lam, mu = plate
            depth[wide] = kernels.supported_edge(a[wide], h, b, lam, mu)
            slope[wide] = kernels.supported_edge_slope(a[wide], h, b, lam, mu)
        return Contribution(depth, slope)
