"""Viscosity: viscoelastic contact, in which the indentation lags the force (Kuwabara-Kono)."""

from typing import TYPE_CHECKING

import numpy as np

from derivation.scene import kernels, scales
from derivation.scene.effects.effect import (
    Bound,
    BoundContext,
    Changes,
    Effect,
    Numbers,
    none_of,
)
from derivation.scene.model import Model
from derivation.scene.numerics import columns
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from derivation.scene.contact_law.law import ContactLaw

MARGIN = 1.05
"""Factor on the largest values along the law, because these are sampled."""
DISSIPATION = 1.2, 0.4
"""Coefficients of x_v and x_v^2 in a bound on 1/e - 1, e the restitution of Hertz's contact."""
VIBRATION = 1000.0
"""Increase of the bound by vibration of the plate, over that of the restitution and the change by
inertia (at most 1). In 323 random scenes the changes were at most 0.66 of the bound."""


HERTZ_TIME = 3.218
"""Contact time of Hertz's impact over (m/K)^(2/5) v0^(-1/5) [1]."""
UNLIKE = 30.0
"""Change of the results, over the square of the spread of the retardation times over Hertz's
contact time, if both bodies have their own retardation time: at most 20.5 in 940 random impacts.
The contact time may change by more, see `later_end`."""
END, LATEST = 0.7, 1.5
"""Change of the end of a contact by bodies with their own retardation times, over A_v, divided by
the power 4/3 of the spread of the times over A_v; and its largest value."""


class Viscosity(Effect):
    """Viscoelastic local indentation without tensile forces; A_v is a retardation time."""

    name = "viscosity"
    adds = "viscoelastic contact"
    equation = "P = P_e + A_v dP_e/dt >= 0, P_e the half-space's force"
    parameter = "x_v = (3/2) A_v (K/m)^(2/5) v0^(1/5)"
    source = "Kuwabara and Kono 1987, Brilliantov et al. 1996; step 24"
    static = False
    hertzian = True
    viscous = True
    remedy = "give plate.retardation_time or sphere.retardation_time [s]"

    def not_applicable_reason(self, model: Model) -> str:
        """Return a reason if no retardation time is given."""
        return "" if model.retardation_time else "neither plate nor sphere has a retardation_time"

    def value(self, model: Model, a: float) -> float:  # noqa: ARG002
        """Return the viscous parameter of Hertz's contact."""
        return float(viscous_number(model))

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """Return the bound of derivation step 24, proved for a half-space.

        An elastic plate decreases the change.
        """
        force, depth, stiffness, energy, growth = context.samples
        speed = np.sqrt(2.0 * (energy / model.m))
        steepness = stiffness / force * depth
        steepening = 2.0 * stiffness / force * (energy / force) - 1.0
        deepening = 2.0 * energy / force / depth
        extremes = np.concatenate(
            (
                MARGIN * (model.retardation_time * columns.most(stiffness / force * speed)),
                MARGIN * (columns.most(steepness) / steepness[..., -1:]),
                MARGIN * np.maximum(0.0, -columns.least(steepening)),
                MARGIN * np.maximum(0.0, columns.most(steepening)),
                MARGIN * columns.most(deepening),
                MARGIN * columns.most(deepening / growth),
                np.maximum(1.0, MARGIN * (energy[..., -1:] / model.m) * 2.0 / model.v0 / model.v0),
            ),
            axis=-1,
        )
        rows = (kernels.ImpactExtremes(*row) for row in np.atleast_2d(extremes).tolist())
        logs = np.array([kernels.viscous_logarithms(row) for row in rows])
        none = none_of(context.radii)
        time, peak, pull, radius, leaving = (
            columns.number(x.reshape(extremes[..., :1].shape)) for x in logs.T
        )
        return Bound(none, none, results=(time, peak, pull, radius, leaving))

    def proved(self, law: "ContactLaw") -> bool:  # noqa: ARG002
        """Return False: proved only for a half-space."""
        return False


def on_vibrating_plate(changes: Changes, inertia: Numbers) -> Changes:
    """Return the changes of the results on a plate with inertia, from those on one without.

    On a light or compliant plate the contact outlasts many oscillations of sphere and plate on the
    stiffness of the contact. Each of them dissipates as much energy as a whole impact, which
    changes the force.

    Parameters
    ----------
    changes
        Bounds of the results on a quasi-static plate.
    inertia
        Largest change of a result by plate inertia [1]; 1 if it is larger or unknown.
    """
    more = VIBRATION * inertia * changes[-1]
    time, depth, force, radius, speed = (change + more for change in changes)
    return time, depth, force, radius, speed


def inverse_restitution(viscous: Numbers) -> Numbers:
    """Return a bound on 1/e of Hertz's contact, by its viscous parameter x_v [1]."""
    one, two = DISSIPATION
    return 1.0 + viscous * (one + two * viscous)


def unlike_bodies_error(model: Model) -> float:
    """Return the estimated model error by two bodies with different retardation times [1].

    The law has their mean, weighted with the compliances, which is correct to first order. In
    fact each body follows the force with its own delay.
    """
    return float(_unlike_bodies_error(model))


def later_end(model: Model, contact_time: float) -> float:
    """Return the change of a contact's duration if each body has its own time, over the duration.

    A contact with the mean A_v of both times ends 3/2 A_v before an elastic one, while it is still
    indented. This applies to any speed of separation. If each body follows the force with its
    own time, the end changes most if one body is far stiffer than the other and without
    retardation: by 0.67 A_v x^(4/3), x the spread of the times over A_v, for small x. The change is
    at most 3/2 A_v, because neither body can be in tension.
    """
    return float(_later_end(model, contact_time))


def unlike_bodies_on_static_plate(model: Model, contact_time: Array) -> tuple[Numbers, Array]:
    """Return the model errors of results and of contact times on quasi-static plates [1]."""
    size = _unlike_bodies_error(model)
    return size, size + np.where(np.asarray(size) > 0.0, _later_end(model, contact_time), 0.0)


def _unlike_bodies_error(model: Model) -> Numbers:
    """Return `unlike_bodies_error` of one scene, or of many as a column."""
    if not np.any(model.retardation_spread):
        return 0.0
    # Hertz's contact time, from x_v = (3/2) A_v/(m/K)^(2/5) v0^(1/5).
    time = HERTZ_TIME * 1.5 * model.retardation_time / viscous_number(model)
    ratio = model.retardation_spread / time
    return UNLIKE * (ratio * ratio)


def _later_end(model: Model, contact_time: Numbers) -> Numbers:
    """Return `later_end` of one scene, or of many as a column."""
    if not np.any(model.retardation_spread):
        return 0.0
    x = model.retardation_spread / model.retardation_time
    change: Numbers = np.minimum(LATEST, END * (x * np.cbrt(x)))
    return change * model.retardation_time / contact_time


def viscous_number(model: Model) -> Numbers:
    """Return the viscous parameter x_v of Hertz's contact [1]; 0 without a retardation time."""
    if not np.any(model.retardation_time):
        return 0.0
    number = scales.evaluated(
        kernels.viscous_number,
        *(model.R, model.m, model.v0, model.lam, model.mu, model.retardation_time),
    )
    parameter: Numbers = number * np.power(1.0 + model.softness, -0.4)
    return parameter
