"""Model error by the finite size of an elastic sphere, and by finite strains.

The law treats the sphere as a half-space. Its finite size changes the indentation at equal force by
a fraction of the order of a/R. The derivation (step 35) has the first order, for a sphere whose
inertia balances the contact pressure. The sphere also vibrates after the impact. Finite strains
(`finite_strains`) have an effect of the same order.

Constants below are measured, by the series of a sphere in Legendre polynomials, whose terms are
exact, and by impacts of its spheroidal modes; the tests repeat this.
"""

from typing import Any

import numpy as np

from derivation.scene import kernels
from derivation.scene.contact_law.finite_strains import (
    depth_change,
    error_of_change,
    radius_error,
    sphere_fraction,
)
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import Values, local_indentation
from derivation.scene.effects.effect import Results
from derivation.scene.kernels import Numbers
from generated.arrays import Double as Array

DEGREES, REST = 60, 0.003
"""Largest degree of a Legendre polynomial in the sum of the first order, and a bound on the rest of
the sum, from that of the terms in the derivation."""
SECOND, AUXETIC = 0.5, 0.25
"""Change of second order over (a/R)^2: the first number plus the second one over 1 + nu. The series
has at most 0.9 of it for nu from -0.99 to 0.5 and a/R from 0.1 to 0.47."""
STIFFER, VIBRATION = 0.75, 2.0 / 3.0
"""Smallest change of the indentation, over a/R, from which vibration of the sphere is estimated;
relative decrease of the restitution by vibration, over this change and (a/R)^2: at most
0.38 (a/R)^3 for Poisson's ratios of 0 to 0.48."""
LOSS = 1.5
"""Change of the logarithm of the restitution e over -log(e) and the change of the indentation: at
most 0.91 in 128 random elastic and yielding impacts, and 1.0 in 38 that yield, for small e."""


def finite_size(nu: Numbers, ratio: Values) -> Values:
    """Return the change of the indentation of a sphere by its finite size, to first order [1].

    It is relative, at equal force, and negative if the sphere is compressed less than a half-space.

    Parameters
    ----------
    nu, ratio
        Poisson's ratio and a/R [1].
    """
    poisson = np.asarray(nu, dtype=np.float64)
    terms = kernels.sphere_term(np.arange(2.0, DEGREES + 1.0), poisson[..., None])
    # The sum of (k + 1/2)^-2 over larger k is 1/(DEGREES + 1) to 1e-6.
    constant: Any = np.sum(terms, axis=-1) + kernels.sphere_tail(poisson) / (DEGREES + 1.0)
    constant = constant + kernels.sphere_start(poisson)
    change: Values = ratio * (constant - kernels.sphere_logarithm(poisson) * np.log(ratio))
    return change


def _of_sphere(law: ContactLaw, a: Values) -> Values:
    """Return the change of the local indentation by the finite size of the sphere [1]."""
    share = sphere_fraction(law)
    if not np.any(share):
        return 0.0 * a
    nu: Any = law.model.sphere_poissons_ratio
    ratio = a / law.model.R
    second = ratio * ratio * (SECOND + AUXETIC / (1.0 + nu))
    change: Values = share * (np.abs(finite_size(nu, ratio)) + REST * ratio + second)
    return change


def finite_sphere_error(law: ContactLaw, a: Values, indentation: Values) -> Values:
    """Return the relative change of indentation, force, radius and time of a contact [1].

    The shape of the arguments is kept. On a plate with inertia the force may rise before the plate
    has deflected, so that the change is relative to the local indentation alone.

    Parameters
    ----------
    a, indentation
        Largest contact radius and indentation [m].
    """
    part: float | Array = 1.0
    if not law.dynamic:
        part = np.minimum(local_indentation(law, a) / indentation, 1.0)
    change: Any = part * (_of_sphere(law, a) + depth_change(law, a))
    error: Values = error_of_change(change)
    return error


def vibration_error(law: ContactLaw, a: Values) -> Values:
    """Return the relative change of the restitution by vibration of the sphere [1].

    Parameters
    ----------
    a
        Largest contact radius [m].
    """
    ratio = a / law.model.R
    least = STIFFER * sphere_fraction(law) * ratio
    change: Values = VIBRATION * ratio * ratio * np.maximum(_of_sphere(law, a), least)
    return change


def finite_sphere_errors(law: ContactLaw, numbers: Results, growth: Results) -> Results:
    """Return the relative changes of the outputs of an impact [1], in their order.

    Parameters
    ----------
    numbers
        The outputs; the restitution of an incomplete impact is NaN.
    growth
        Factors by which vibration of the plate increases changes of the outputs [1].
    """
    _, depth, _, a, restitution = numbers
    size = float(finite_sphere_error(law, a, depth))
    rebound = float(rebound_error(law, a, size, np.asarray(restitution)))
    wider = float(radius_error(law, a))  # at equal force: the vibration does not increase it
    time, deep, force, radius, speed = growth
    return time * size, deep * size, force * size, radius * size + wider, speed * rebound


def rebound_error(law: ContactLaw, a: Values, size: Values, restitution: Array) -> Array:
    """Return the relative change of the restitution [1], without the growth by vibration.

    Parameters
    ----------
    a, size
        Largest contact radius [m], and relative change of the other results [1].
    restitution
        Restitution [1]; NaN if unknown.
    """
    error: Array = np.asarray(vibration_error(law, a))
    if not (law.dynamic or law.viscous or law.plastic):
        return error
    known = np.where(np.isfinite(restitution), np.maximum(np.abs(restitution), 1e-6), 1.0)
    return np.asarray(error + size * np.maximum(1.0, LOSS * np.abs(np.log(known))))
