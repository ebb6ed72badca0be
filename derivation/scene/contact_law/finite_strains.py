"""Model errors by finite strains of both bodies, which the law treats as infinitely small.

Strains are of the order of a/R in every contact. At equal force they change indentation, contact
radius and pressure by fractions of this order, which depend on the material. The error is the
larger change of two materials with the same Lame constants: St. Venant-Kirchhoff's, whose second
Piola-Kirchhoff stress is linear in Green's strain, and a compressible neo-Hookean one. They are
measured with finite elements on a half-space; the tests use the same elements. The error of the
indentation is at least the part that does not depend on the material, the motion of the faces
towards the axis (derivation, step 35).
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from derivation.scene import kernels
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import Values
from generated.arrays import Double as Array

POISSON = (-0.97, -0.5, 0.0, 0.3, 0.499)
"""Poisson's ratios of the measured changes [1], between which they are interpolated."""
OF_DEPTH, OF_RADIUS, OF_PRESSURE = (
    (0.20, 0.23, 0.18, 0.22, 0.42),
    (0.23, 0.24, 0.18, 0.18, 0.35),
    (0.45, 0.60, 0.48, 0.61, 1.07),
)
"""Changes of indentation, contact radius and pressure over a/R, to first order [1]. The first ones
are 15 % larger than on a half-space, because a plate four contact radii thick changes by more."""
SECOND = 0.6
"""Largest change of second order, over (a/R)^2 [1], for a/R up to 0.4."""
LARGEST = 0.99
"""Largest change of a result; towards it, the error becomes infinite."""


def sphere_fraction(law: ContactLaw) -> Any:
    """Return the compliance of the sphere over that of both bodies [1]."""
    return law.softness / (1.0 + law.softness)


def depth_change(law: ContactLaw, a: Values) -> Values:
    """Return the change of the local indentation at equal force [1].

    Parameters
    ----------
    a
        Largest contact radius [m].
    """
    moved: Any = _of_both(law, kernels.face_motion) * (a / law.model.R)
    change: Values = np.maximum(moved, _measured(law, a, OF_DEPTH))
    return change


def radius_error(law: ContactLaw, a: Values) -> Values:
    """Return the error of the contact radius at equal force [1].

    Parameters
    ----------
    a
        Largest contact radius [m].
    """
    return error_of_change(_measured(law, a, OF_RADIUS))


def more_than_radius(law: ContactLaw, a: Values) -> Values:
    """Return by how much the error of the pressure exceeds that of the contact radius [1].

    The pressure is proportional to the radius, but finite strains change it more.

    Parameters
    ----------
    a
        Largest contact radius [m].
    """
    more: Any = error_of_change(_measured(law, a, OF_PRESSURE)) - radius_error(law, a)
    error: Values = np.maximum(more, 0.0)
    return error


def error_of_change(change: Values) -> Values:
    """Return the relative error of a result that decreases by a relative change [1]."""
    bounded: Any = np.minimum(change, LARGEST)
    error: Values = bounded / (1.0 - bounded)
    return error


def _measured(law: ContactLaw, a: Values, changes: tuple[float, ...]) -> Values:
    """Return a measured change, from its first order over a/R at the ratios of `POISSON`."""
    ratio: Any = a / law.model.R
    first = _of_both(law, lambda nu: np.interp(nu, POISSON, changes))
    change: Values = ratio * (first + SECOND * ratio * _of_both(law, np.ones_like))
    return change


def _of_both(law: ContactLaw, change: Callable[[Array], Any]) -> Any:
    """Return a change by the strains of both bodies, each with its Poisson's ratio.

    A strain is the part of the body of the compliance times a/R, and the displacement that it
    changes is this part of the indentation: the change has the square of the part.
    """
    model, part = law.model, sphere_fraction(law)
    of_sphere = part * part * change(np.asarray(model.sphere_poissons_ratio))
    of_plate = (1.0 - part) * (1.0 - part) * change(np.asarray(model.poissons_ratio))
    return of_sphere + of_plate
