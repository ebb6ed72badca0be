"""Step 20: the change of the contact force by waves that curve the plate under the contact.

A deflection q J0(phi r) of the plate subtracts q cos(phi t) from the right-hand side of the
integral equation, by Abel's operator. On a half-space, with chi(a) = 0 at the same contact radius,
the force changes by 2 E* q (a cos(phi a) - sin(phi a)/phi). A flat punch moves with the mean
deflection s q, s = sin(phi a)/(phi a), and the change is 2 E* a^2 q ds/da.
"""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import prove
from derivation.plate.modes.theory.influence import PLANE_STRAIN_MODULUS
from derivation.plate.pressure.theory.integral_equation import abel_of_bessel
from derivation.plate.vocabulary import Formula, a, phi

_t = sp.Symbol("t", positive=True)


def mean_deflection() -> sp.Expr:
    """Return s, the mean of J0(phi r) under a flat punch."""
    return sp.sin(phi * a) / (phi * a)


@cache
def force_of_wave() -> Formula:
    """Return the change of the force at a given contact radius, for a wave J0(phi r)."""
    abel_of_bessel()
    transform = sp.diff(sp.sin(phi * _t) / phi, _t)
    chi = PLANE_STRAIN_MODULUS / sp.pi * (transform.subs(_t, a) - transform)
    value = 2 * PLANE_STRAIN_MODULUS * (a * sp.cos(phi * a) - sp.sin(phi * a) / phi)
    proof = prove(
        "Force by a wave under the contact",
        r"$\chi$ is integrated, with $\chi(a) = 0$; $s$ is differentiated with respect to $a$.",
        lambda value: {
            "force": sp.integrate(2 * sp.pi * chi, (_t, 0, a)) - value,
            "mean deflection": 2 * PLANE_STRAIN_MODULUS * a**2 * sp.diff(mean_deflection(), a)
            - value,
        },
        value,
    )
    meaning = r"change of the force at a given contact radius over the deflection $q$ of a wave"
    return Formula("force_of_wave", r"\Delta P/q", meaning, value, "N/m", "", ("k_modes",), proof)
