"""Model error by the finite size of an elastic sphere, which the law treats as a half-space.

Under the contact pressure, which its inertia balances, a sphere of an ordinary material is
compressed less than a half-space: at equal force by a fraction of the order of a/R of its own
indentation. An auxetic sphere is compressed more. The sphere also vibrates after the impact.

The estimates below were compared with the series of a sphere in Legendre polynomials, whose terms
are exact (Lurie 1964), and with impacts of its spheroidal modes; the tests repeat this.
"""

import math

import numpy as np

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import Values, local_indentation
from derivation.scene.effects.effect import Results
from generated.arrays import Double as Array

STIFFER = 0.75
"""Largest decrease of the indentation of a sphere at equal force, over a/R: for an incompressible
sphere, 0.58 of narrow contacts and 0.743 at a/R = 0.56."""
AUXETIC = 0.5
"""Increase by a negative Poisson's ratio over (a/R) (-nu)/(1 + nu), to which a sphere is soft under
pressure: at most 0.95 of the estimate for nu from -0.99 to -0.7."""
VIBRATION = 2.0 / 3.0
"""Relative decrease of the restitution by vibration of the sphere, over the change of the
indentation and (a/R)^2: at most 0.38 (a/R)^3 for Poisson's ratios of 0 to 0.48."""
LOSS = 1.5
"""Change of the logarithm of the restitution e over -log(e) and the change of the indentation: at
most 0.91 in 128 random elastic and yielding impacts, and 1.0 in 38 that yield, for small e."""
LARGEST = 0.99
"""Largest change of the indentation; the change of the other results grows beyond all bounds."""


def finite_sphere_error(law: ContactLaw, a: Values, indentation: Values) -> Values:
    """Return the relative change of indentation, force, radius and time of a contact [1].

    The shape of the arguments is kept. On a plate with inertia the force may rise before the plate
    has deflected, so that the change of the local indentation counts as a whole.

    Parameters
    ----------
    a, indentation
        Largest contact radius and indentation [m].
    """
    model = law.model
    share = law.softness / (1.0 + law.softness)
    if not np.any(share):
        return 0.0 * a
    nu, ratio = model.sphere_poissons_ratio, a / model.R
    # Not of higher order in a/R than the rest: the pressure of a curved face acts on its sides.
    curved = 2.0 / (3.0 * math.pi) * (1.0 - 2.0 * nu) ** 2 / (1.0 - nu) * np.log(1.0 / ratio)
    slope = np.maximum(STIFFER, curved + AUXETIC * np.maximum(-nu, 0.0) / (1.0 + nu))
    part: float | Array = 1.0
    if not law.dynamic:
        part = np.minimum(local_indentation(law, a) / indentation, 1.0)
    change = np.minimum(share * part * ratio * slope, LARGEST)
    error: Values = change / (1.0 - change)
    return error


def vibration_error(law: ContactLaw, a: Values, error: Values) -> Values:
    """Return the relative change of the restitution by vibration of the sphere [1].

    `error` is that of `finite_sphere_error` at the contact radius a [m].
    """
    ratio = a / law.model.R
    change: Values = VIBRATION * ratio * ratio * error
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
    rebound = float(vibration_error(law, a, size))
    if law.dynamic or law.viscous or law.plastic:
        rest = max(abs(restitution), 1e-6) if math.isfinite(restitution) else 1.0
        rebound += size * max(1.0, LOSS * abs(math.log(rest)))
    time, deep, force, radius, speed = growth
    return time * size, deep * size, force * size, radius * size, speed * rebound
