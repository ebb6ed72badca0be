"""Edge: how the plate is held, if not by the paper's soft hinge."""

import numpy as np

from derivation.scene import kernels
from derivation.scene.effects.effect import Array, Bound, Place, PlateEffect, Share, none_of
from derivation.scene.model import Model

SUPPORTED, CLAMPED = "simply-supported", "clamped"


class Edge(PlateEffect):
    """The soft hinge's edge moment and force taken away, or its mean rotation and displacement.

    By the exact polynomial states of bending and stretching, w = 0 on the middle plane's rim.
    What these leave dies within a thickness of the edge; see `edge_remainder`.
    """

    name = "edge"
    adds = "a plate simply supported or clamped"
    equation = "F = (1 - nu)/(1 + nu) X supported, -X clamped"
    number = "edge's c_1 a/h, at most"
    source = "polynomial states of bending and stretching; link 19"

    def absent(self, model: Model) -> str:
        """The law begins with the paper's edge."""
        return "" if model.edge in (SUPPORTED, CLAMPED) else "the plate's edge is a soft hinge"

    def value(self, model: Model, a: float) -> float:
        """Its share of the indentation over Hertz's at most, two thirds of its bound."""
        low, up = self._range(model, np.array([a]))
        return float(up[0] - low[0]) / 1.5

    def bound(self, model: Model, place: Place) -> Bound:
        """Of one sign; the bound holds at all smaller radii too."""
        return Bound(*self._range(model, place.radii))

    def _range(self, model: Model, a: Array) -> tuple[Array, Array]:
        """How far S may be below and above."""
        plate = model.h, model.b, model.lam, model.mu
        if model.edge == SUPPORTED:
            return none_of(a), kernels.supported_edge_bound(a, *plate)
        return kernels.clamped_edge_bound(a, *plate), none_of(a)

    def share(self, model: Model, a: Array) -> Share:
        """By sums over a few modes, or the thin plate's closed form."""
        plate = model.h, model.b, model.lam, model.mu
        if model.edge == SUPPORTED:
            runs = kernels.supported_edge, kernels.supported_edge_slope
        else:
            runs = kernels.clamped_edge, kernels.clamped_edge_slope
        return Share(*(run(a, *plate) for run in runs))
