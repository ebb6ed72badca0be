"""Model error of radius and pressure by the curvature of a simply supported or clamped plate."""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from derivation.scene.contact_law.closed_contact import closed_up_to
from derivation.scene.contact_law.solved_law import cases, solution
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from derivation.scene.contact_law.law import ContactLaw

LINEAR, SQUARE = 0.05, 0.2
"""The curvature has at most this error over h/b, or this one over (h/b)^2 if it is larger [1].

In finite elements the difference was at most 0.9 % for h/b = 0.2, 1.7 % for 0.3 and 5 % for 0.5,
for Poisson's ratios from -0.4 to 0.45."""
SHAPE = 5.0
"""Error of the central pressure over the mean one, divided by that of the radius: at most 3.9 in
ten contacts with plates of finite elements."""

HERTZ_PEAK = 1.5
"""Pressure at the centre over the mean one of Hertz's law [1]."""


class CurvatureErrors(NamedTuple):
    """Relative model errors by the curvature: of all results, and of the central pressure [1]."""

    results: float
    pressure: float


def edge_curvature_errors(law: "ContactLaw", a: float) -> CurvatureErrors:
    """Return the model errors by the curvature of the plate, at a contact radius [m]."""
    return CurvatureErrors(*(float(x[0]) for x in curvature_errors(law, np.array([a]))))


def curvature_errors(law: "ContactLaw", a: Array) -> tuple[Array, Array]:
    """Return the errors of `edge_curvature_errors` at one radius [m], or a column of radii.

    The error of the force at a given contact radius is a fraction of the change of the force by the
    edge. At a given force, radius and indentation change by a third of that or less. The central
    pressure of a wide contact is small and depends on the shape of the plate, too: its error is
    relative to the mean pressure.
    """
    if not (law.solved and np.any(law.edge_curvature)):
        return np.zeros_like(a), np.zeros_like(a)
    eta, plain = law.model.eta, solution(law, a, own_edge=False)
    lost = np.flatnonzero(np.isnan(plain.force) & np.isfinite(a))
    if lost.size:  # with the paper's edge contact may be lost at the centre before
        others, limits = cases(law, own_edge=False), np.ravel(law.limit)
        a = a.copy()
        a.flat[lost] = [closed_up_to(others[row], float(limits[row])) for row in lost]
        plain = solution(law, a, own_edge=False)
    held = solution(law, a)
    part = np.maximum(LINEAR * eta, SQUARE * eta * eta)
    change = part / 3.0 * np.abs(held.force / plain.force - 1.0)
    peak = HERTZ_PEAK * held.centre / held.force
    errors = change, SHAPE * change * np.maximum(1.0, 1.0 / peak)
    results, pressure = (np.where(np.isfinite(x), x, np.inf) for x in errors)
    return results, pressure
