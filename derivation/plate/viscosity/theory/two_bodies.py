"""Step 24: the retardation time of a contact between two viscoelastic bodies.

Under one pressure p the surface of a body of retardation time A_i follows C_i p with a delay,
(1 + A_i D) w_i = C_i p with D = d/dt and C_i = 1/E_i*, if shear and volume have the same A_i. The
indentation is w = w_p + w_s, and with C = C_p + C_s

    p = (1 + A_v D) w/C + O(A^2),   A_v = (C_p A_p + C_s A_s)/C,

the contact law of one body (Kuwabara and Kono 1987; Brilliantov et al. 1996 for two alike). It is
exact for A_p = A_s; otherwise its error is of second order in the difference.
"""

from functools import cache
from typing import NamedTuple

import sympy as sp

from derivation.engine.formula.proof import Proof, prove

plate_time, sphere_time, softness = sp.symbols("plate_time sphere_time softness", nonnegative=True)
"""A_p, A_s and C_s/C_p = E_p*/E_s*, 0 for a rigid sphere."""
_C_p, _C_s, _D, _small = sp.symbols("C_p C_s D epsilon", positive=True)


class ContactTime(NamedTuple):
    """Retardation time of the contact in terms of those of the bodies, and the proof."""

    expression: sp.Expr
    proof: Proof


@cache
def contact_time() -> ContactTime:
    """Return the mean of the bodies' retardation times, weighted with their compliances."""
    both = _C_p + _C_s
    mean = (_C_p * plate_time + _C_s * sphere_time) / both
    delays = {plate_time: _small * plate_time, sphere_time: _small * sphere_time}
    stiffness = 1 / (_C_p / (1 + plate_time * _D) + _C_s / (1 + sphere_time * _D))
    slope = sp.diff(stiffness.xreplace(delays), _small).subs(_small, 0)
    rest = _C_p * _C_s * (plate_time - sphere_time) ** 2 * _D**2 / both**2
    rest /= both + (_C_p * sphere_time + _C_s * plate_time) * _D
    by_ratio = (plate_time + softness * sphere_time) / (1 + softness)
    alike = {sphere_time: plate_time}
    proof = prove(
        "Two viscoelastic bodies in contact",
        "The ratio of pressure and indentation is expanded, with D for the time derivative. The "
        "error of the mean vanishes for equal bodies and is of second order in the times.",
        {
            "first order": sp.together(slope - mean * _D / both),
            "second order": sp.simplify(stiffness - (1 + mean * _D) / both + rest),
            "equal bodies": sp.simplify((stiffness - (1 + mean * _D) / both).subs(alike)),
            "by the ratio": sp.simplify(mean.subs(_C_s, softness * _C_p) - by_ratio),
            "rigid sphere": by_ratio.subs(softness, 0) - plate_time,
        },
    )
    return ContactTime(by_ratio, proof)
