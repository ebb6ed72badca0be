"""Edge: simply supported or clamped plate instead of the paper's edge condition."""

from typing import TYPE_CHECKING

import numpy as np

from derivation.scene import kernels
from derivation.scene.contact_law.edge_remainder import (
    LARGEST_H_OVER_B,
    LEAST_A_OVER_B,
    largest_neighbours,
)
from derivation.scene.contact_law.support_series import support_contribution
from derivation.scene.effects.effect import (
    Bound,
    BoundContext,
    Contribution,
    Numbers,
    PlateEffect,
    Reach,
    none_of,
)
from derivation.scene.model import Model
from derivation.scene.scene import Scene
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from derivation.scene.contact_law.law import ContactLaw

SUPPORTED, CLAMPED = "simply-supported", "clamped"
MAX_A_OVER_B = 0.9
"""Largest contact radius over plate radius of the edge model."""


class Edge(PlateEffect):
    """Correction for a simply supported or clamped edge.

    It removes the moment and force of the paper's edge, or its displacement, and uses the exact
    polynomial states of bending and in-plane extension. A clamped edge has w = 0 on the whole
    lateral surface and prevents thinning there. `edge.remainder` measures the error of this model.
    """

    name = "edge"
    adds = "simply supported or clamped edge"
    equation = "F = (1 - nu)/(1 + nu) X supported, -X_c clamped"
    parameter = "upper bound of c_1 a/h of the edge"
    source = "polynomial states of bending and in-plane extension; step 19"
    remedy = 'set plate.edge to "simply-supported" or "clamped"'
    reach = Reach(plate=MAX_A_OVER_B)
    other_edge = True

    def not_applicable_reason(self, model: Model) -> str:
        """Return a reason if the plate has the paper's edge, which the law already contains."""
        return "" if model.edge in (SUPPORTED, CLAMPED) else "the plate has the paper's edge"

    def without_change(self, scene: Scene) -> bool:
        """Return whether the scene gives such an edge, which an infinite plate does not have."""
        return scene.plate.edge in (SUPPORTED, CLAMPED)

    def value(self, model: Model, a: float) -> float:
        """Return an upper bound of its contribution to the indentation over Hertz's."""
        low, up = self._range(model, np.array([a]), model.h)
        return float(up[0] - low[0]) / 1.5

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """Return the bound of the law, valid at all smaller radii, plus the error of the law.

        For h > b the true effect of the edge is about that for h = b, while that of the law
        decreases or increases further. The bound is infinite where the error of the law is unknown.
        """
        a, plate = context.radii, model.correction
        ranges = (self._range(model, a, h) for h in (model.h, np.minimum(model.h, model.b)))
        low, up = (np.maximum(*both) for both in zip(*ranges, strict=True))
        # Narrower contacts have the same error per force, and the force is proportional to a^3.
        known = np.maximum(a, LEAST_A_OVER_B * model.b)
        error = largest_neighbours(model, known, np.minimum(model.eta, LARGEST_H_OVER_B))
        wall = kernels.LATERAL_LINEAR + kernels.LATERAL_CUBIC * (known / model.b) ** 2
        part = (plate.bend + plate.bend_error) / model.h + wall / model.b
        whole = 1.0 + (part + np.max(up / known, axis=-1, keepdims=True)) * known
        change = 1.5 * np.where(np.isnan(error), np.inf, error) * whole
        change = np.where(a > 0.0, np.maximum.accumulate(change * (a / known), axis=-1), 0.0)
        return Bound(low + change, up + change)

    def proved(self, law: "ContactLaw") -> bool:  # noqa: ARG002
        """Return False: the error of the law is measured."""
        return False

    def _range(self, model: Model, a: Array, h: Numbers) -> tuple[Array, Array]:
        """Return the largest decrease and increase of S by the law with a half-thickness [m]."""
        plate = h, model.b, model.lam, model.mu
        if model.edge == SUPPORTED:
            return none_of(a), kernels.supported_edge_bound(a, *plate)
        return kernels.clamped_edge_bound(a, *plate), none_of(a)

    def contribution(self, model: Model, a: Array) -> Contribution:
        """Return the contribution by sums over a few modes, or a closed form for thin plates."""
        if model.edge == SUPPORTED:
            depth, slope = self._supported(model, np.atleast_2d(a))
            return Contribution(depth.reshape(a.shape), slope.reshape(a.shape))
        plate = model.h, model.b, model.lam, model.mu
        runs = kernels.clamped_edge, kernels.clamped_edge_slope
        return Contribution(*(run(a, *plate) for run in runs))

    def _supported(self, model: Model, a: Array) -> Contribution:
        """Return the sums of one or many plates by their series; directly for wide contacts."""
        depth, slope = support_contribution(model.supports, a / model.b)
        wide = np.isnan(depth) & np.isfinite(a)
        if wide.any():
            plate = (np.broadcast_to(x, a.shape)[wide] for x in model.numbers[3:])
            h, b, lam, mu = plate
            depth[wide] = kernels.supported_edge(a[wide], h, b, lam, mu)
            slope[wide] = kernels.supported_edge_slope(a[wide], h, b, lam, mu)
        return Contribution(depth, slope)
