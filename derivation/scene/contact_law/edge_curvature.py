"""Model error of radius and pressure by the curvature of a simply supported or clamped plate."""

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from derivation.scene.contact_law.closed_contact import closed_up_to
from derivation.scene.contact_law.solved_contact import force_at

if TYPE_CHECKING:
    from derivation.scene.contact_law.law import ContactLaw

LINEAR, SQUARE = 0.05, 0.2
"""The curvature has at most this error over h/b, or this one over (h/b)^2 if it is larger [1].

In finite elements the difference was at most 0.9 % for h/b = 0.2, 1.7 % for 0.3 and 5 % for 0.5,
for Poisson's ratios from -0.4 to 0.45."""
SHAPE = 5.0
"""Error of the central pressure over the mean one, divided by that of the radius: at most 3.9 in
ten contacts with plates of finite elements."""


class CurvatureErrors(NamedTuple):
    """Relative model errors by the curvature: of all results, and of the central pressure [1]."""

    results: float
    pressure: float


def edge_curvature_errors(law: "ContactLaw", a: float) -> CurvatureErrors:
    """Return the model errors by the curvature of the plate, at a contact radius [m].

    The error of the force at a given contact radius is a fraction of the change of the force by the
    edge. At a given force, radius and indentation change by a third of that or less. The central
    pressure of a wide contact is small and depends on the shape of the plate, too: its error is
    relative to the mean pressure.
    """
    if not (law.solved and law.edge_curvature):
        return CurvatureErrors(0.0, 0.0)
    eta, case = law.model.eta, law.case
    part = max(LINEAR * eta, SQUARE * eta * eta)
    other = case._replace(edge=0.0)
    plain = force_at(a, other)
    if math.isnan(plain):  # with the paper's edge contact may be lost at the centre before
        a = closed_up_to(other, law.limit)
        plain = force_at(a, other)
    radius = np.array([a])
    [force] = law.force(radius, law.at(radius))
    mean = force / (math.pi * a * a)
    change = part / 3.0 * abs(force / plain - 1.0)
    peak = law.max_pressure(a) / mean
    errors = change, SHAPE * change * max(1.0, 1.0 / peak)
    return CurvatureErrors(*(x if math.isfinite(x) else math.inf for x in errors))
