"""Leading-order size of what a law neglects: exact pressure, spherical profile, stretching."""

import math

import numpy as np

from derivation.scene import kernels
from derivation.scene.effects.edge import CLAMPED, SUPPORTED
from derivation.scene.kernels import Numbers
from derivation.scene.model import Model

SMALL_CORRECTION = 0.3
"""Relative correction above which its leading term is no longer an estimate."""
_STIFFENING = {
    SUPPORTED: kernels.stiffening_supported,
    CLAMPED: kernels.stiffening_clamped,
}
_TENSION = {SUPPORTED: kernels.tension_supported, CLAMPED: kernels.tension_clamped}
"""Stiffening by stretching divided by (w/H)^2, and the ratio of tension to bending stress divided
by w/H, as functions of Poisson's ratio; other edges are the paper's."""


def stretching(model: Model, deflection: Numbers) -> Numbers:
    """Return the relative stiffening of a plate by stretching [1], to first order.

    Parameters
    ----------
    model
        The plate; the stiffening depends on its edge.
    deflection
        Deflection on the axis under a static load [m].
    """
    nu = np.asarray(model.poissons_ratio)
    ratio = deflection / (2.0 * model.h)
    # NumPy rounds the power of one number differently from that of an array.
    first_order = _STIFFENING.get(model.edge, kernels.stiffening_paper)(np.atleast_1d(nu))
    size: Numbers = first_order.reshape(nu.shape) * ratio * ratio
    return size


def membrane_stress(model: Model, deflection: Numbers) -> Numbers:
    """Return the tension of a stretched middle plane on the axis over the bending stress [1].

    To first order and under a static load, an upper bound in contacts narrower than 0.4 b.

    Parameters
    ----------
    deflection
        Largest deflection on the axis [m].
    """
    factor = _TENSION.get(model.edge, kernels.tension_paper)(np.asarray(model.poissons_ratio))
    ratio: Numbers = factor * (deflection / (2.0 * model.h))
    return ratio


def doubling_deflection(model: Model) -> float:
    """Return the deflection [m] at which stretching doubles a plate's stiffness, to first order."""
    thickness = 2.0 * float(model.h)
    return thickness / math.sqrt(float(stretching(model, thickness)))


def pressure_correction(model: Model, a: Numbers, indentation: Numbers) -> Numbers:
    """Return the relative changes of indentations [m] at equal force by the exact pressure [1].

    To leading order the exact pressure changes c3 of delta = (a^2/R) (1 + c1 A + c3 A^3 + ...),
    A = a/h, into (8/3) c3. A combination of values at a and a/2 isolates the c3 term:
    delta(a) - 8 delta(a/2) + a^2/R = (3/4) c3 A^3 a^2/R.
    """
    half, full = (kernels.indentation(x, model.R, model.h, model.b) for x in (a / 2, a))
    cubic = 4 / 3 * (full - 8 * half + a * (a / model.R))
    change: Numbers = 5 / 3 * cubic / indentation
    return change


def profile_correction(model: Model, a: float, indentation: float) -> float:
    """Return the relative change of the indentation at equal force by the spherical profile [1].

    To leading order Sneddon's law for the spherical profile, indentation (a/2) ln((R+a)/(R-a)),
    adds (1/15) (a/R)^2 times a^2/R, including the smaller contact radius at that force.
    """
    return (a / model.R) ** 2 / 15 * a * (a / model.R) / indentation


def correction_in_words(change: float) -> str:
    """Return a relative correction of the indentation [1] in words."""
    percent = f"{100 * change:+.2g} % of the indentation"
    if abs(change) > SMALL_CORRECTION:
        return f"no reliable error estimate: the leading-order correction is {percent}"
    return f"the correction, which is neglected, is about {percent} at this force"
