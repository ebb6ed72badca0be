"""Formulas of the paper's own motion as its template needs them: from the records, proved.

In units of the linear motion's rate and largest indentation, s = delta_0/delta_max, all of (15)
to (18) depends on one number, excess = -(radicand of (17), (18) where that motion turns)/v0^2.
The radicand vanishes at s = last; s = last x^3, x = 1 - u^2 makes the integrals of (16) smooth.
"""

from functools import cache

import sympy as sp

from derivation.engine.emit.printer import to_numpy
from derivation.engine.formula.proof import Proof, prove
from derivation.plate.contact.theory.divergence import printed_term
from derivation.plate.contact.theory.hertz import contact_radius
from derivation.plate.contact.theory.law import contact_law
from derivation.plate.contact.theory.reversion import formal_coefficients
from derivation.plate.impact.theory.impact import geometric, linear_motion, linearisation
from derivation.plate.printed.motion import PRINTED_MOTION
from derivation.plate.vocabulary import P, a, delta_0, m, t, v0, xi_k

K, ratio = sp.symbols("K ratio", positive=True)
excess, last, s, u, x = sp.symbols("excess last s u x", positive=True)
lead, square = sp.symbols("lead square", positive=True)

LEAD = last**2 * geometric(6, x) + excess * last ** sp.Rational(8, 3) * geometric(8, x)
"""The radicand over v0^2 u^2."""
SQUARE = u**2 * lead + excess * s ** sp.Rational(8, 3)
"""delta_0'^2 over v0^2."""
STEP = 6 * last * x**2 * u
"""-ds/du."""
_force = s + sp.Rational(4, 3) * excess * s ** sp.Rational(5, 3)
F_STEP = STEP / u * _force / sp.sqrt(lead * square)
"""-F dt/du."""
G_STEP = STEP * excess * s ** sp.Rational(8, 3) / (square + u * sp.sqrt(lead * square))
"""-G dt/du over the linear motion's largest indentation."""


def perturbation_context() -> dict[str, str]:
    """What the template of the paper's own motion needs, formulas as text."""
    smooth_forms()
    derived = {f.name: f.expression for f in formal_coefficients()}
    printed = {p.name: p.expression for p in PRINTED_MOTION}
    found = {
        "cube": a**3 / contact_radius().expression,
        "gamma_2": mode_share(2),
        "gamma_3": mode_share(3),
        "xi_2": derived["xi_2"],
        "xi_3": derived["xi_3"],
        "xi_3_printed": printed["xi_3"],
        "delta_0": linear_motion().expression,
        "excess": -linearisation()[2].expression / v0**2,
        "lead": LEAD,
        "square": SQUARE,
        "F_step": F_STEP,
        "G_step": G_STEP,
    }
    return {name: to_numpy(value) for name, value in found.items()}


def mode_share(k: int) -> sp.Expr:
    """One mode's share of gamma_k in K_j = K and a/P^(1/3) = ratio."""
    share = printed_term(k) / contact_law()[0].expression
    return K * sp.powsimp(share.subs(a, ratio * P ** sp.Rational(1, 3)), force=True)


@cache
def smooth_forms() -> Proof:
    """The forms in u from F and G of the theory, where the radicand vanishes at u = 0.

    `last` and x are taken as p/(1 + p), so that any positive p, q are a point of the motion;
    1 = last^2 + excess last^(8/3) gives the excess, and that xi_3.
    """
    F, G, at_turn = (formula.expression for formula in linearisation())
    peak = linear_motion().expression.subs(sp.sin(t * sp.sqrt(xi_k[2]) / sp.sqrt(m)), 1)
    p, q = sp.symbols("p q", positive=True)
    end, cube_root = p / (1 + p), q / (1 + q)
    number = (1 - end**2) / end ** sp.Rational(8, 3)
    coefficient = xi_k[3] * number / (-at_turn / v0**2)
    place = {last: end, x: cube_root, u: sp.sqrt(1 - cube_root), excess: number}
    inner = end * cube_root**3

    def of_theory(expression: sp.Expr) -> sp.Expr:
        return expression.subs({xi_k[3]: coefficient, delta_0: inner * peak})

    def of_ours(expression: sp.Expr) -> sp.Expr:
        return expression.subs(square, SQUARE).subs(lead, LEAD).subs(s, inner).subs(place)

    speed = sp.sqrt(v0**2 - xi_k[2] / m * delta_0**2)
    path = of_ours(STEP) * peak / of_theory(speed)
    return prove(
        "Motion of (16) to (18) in smooth variables",
        "F dt and G dt, with dt = d delta_0/delta_0', s = last x^3 and x = 1 - u^2.",
        {
            "step": STEP.subs(x, 1 - u**2) + sp.diff(last * (1 - u**2) ** 3, u),
            "F": of_theory(F) * path - of_ours(F_STEP),
            "G": of_theory(G) * path / peak - of_ours(G_STEP),
        },
    )
