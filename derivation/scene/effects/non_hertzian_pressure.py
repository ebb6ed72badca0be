"""Non-Hertzian pressure, from an integral equation, for contacts that are not small against h."""

from typing import TYPE_CHECKING

import numpy as np

from derivation.scene import kernels
from derivation.scene.effects import edge
from derivation.scene.effects.effect import Bound, BoundContext, Effect, Reach
from derivation.scene.effects.finite_thickness import WHOLE_PLATE
from derivation.scene.model import Model

if TYPE_CHECKING:
    from derivation.scene.contact_law.law import ContactLaw

MAX_A_OVER_H = 6.0
"""Contact radius over half-thickness at which contact may be lost at the centre."""
MAX_A_OVER_R = 0.95
"""Contact radius over sphere radius up to which the quadrature resolves the pressure."""
BOUND_A_OVER_B = 0.4
"""Largest contact radius over plate radius for which the bound is valid."""
BOUND_THETA = 0.2
"""Largest theta for which the bound is valid."""


class NonHertzianPressure(Effect):
    """Fredholm equation for the pressure of the whole plate; it contains all plate effects."""

    name = "non_hertzian_pressure"
    adds = "contact pressure from the integral equation"
    equation = "chi + int N chi ds = (E*/pi) (delta - f), chi(a) = 0, P = 2 pi int chi dt"
    parameter = "a/H"
    source = "Abel transform of the mixed problem; step 20"
    contains = WHOLE_PLATE | {"spherical_profile", "sphere_elasticity"}
    requires = WHOLE_PLATE
    reach = Reach(edge.MAX_A_OVER_B, MAX_A_OVER_R, MAX_A_OVER_H)
    solved = True

    def value(self, model: Model, a: float) -> float:
        """Return contact radius over thickness."""
        return a / (2.0 * model.h)

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """Return 5/3 (down) and 2/3 (up) of theta >= (-(15/2) c_3 + (2/25) eta^3 + |N_s|) A^3.

        -(5/2) c_3 is at most K_3. N_s is the coefficient of another edge; if it is positive, the
        kernel may have both signs and both factors are 5/2. The bound is proved for a paraboloid;
        the pressure of a sphere is steeper, and theta is multiplied by its force over that of the
        paraboloid.
        """
        a, edge = context.radii, model.edge_curvature
        cubic = (
            3.0 * model.correction.rest
            + kernels.PRESSURE_LATERAL * model.eta * model.eta * model.eta
            + np.abs(edge)
        )
        A = a / model.h
        theta = cubic * (A * A * A) * context.sphere_force(model.R)
        theta = np.where(np.isnan(theta), np.inf, theta)
        known = (theta <= BOUND_THETA) & (a <= BOUND_A_OVER_B * model.b)
        below, above = (
            np.where(np.asarray(edge) > 0.0, kernels.PRESSURE_EITHER, c)
            for c in (kernels.PRESSURE_BELOW, kernels.PRESSURE_ABOVE)
        )
        low, up = (np.where(known, c * theta, np.inf) for c in (below, above))
        last = np.where(known, theta, np.nan)[..., -1:]
        radius = np.where(np.isnan(last), np.inf, -np.log1p(-last) / 3.0)
        return Bound(low, up, radius=radius)

    def proved(self, law: "ContactLaw") -> bool:
        """Return whether the profile is a paraboloid."""
        return not law.spherical
