"""Formulas of the paper's own motion, proved.

In units of the linear motion's rate and largest indentation, s = delta_0/delta_max, equations (15)
to (18) depend on one parameter, excess = -(radicand of (17), (18) at that motion's turning
point)/v0^2. The radicand vanishes at s = last; s = last x^3, x = 1 - u^2 makes the integrals
of (16) smooth.
"""

import sympy as sp

from derivation.engine.emit.modules import Routines
from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import QUIET_SCALARS, Facts, Let
from derivation.plate.contact.theory.divergence import printed_term
from derivation.plate.contact.theory.hertz import contact_radius
from derivation.plate.contact.theory.law import contact_law
from derivation.plate.contact.theory.reversion import formal_coefficients
from derivation.plate.impact.theory.impact import (
    formal_speed_squared,
    geometric,
    linear_motion,
    linearisation,
)
from derivation.plate.printed.motion import PRINTED_MOTION
from derivation.plate.vocabulary import (
    P,
    R,
    a,
    delta,
    delta_0,
    gamma_k,
    lam,
    m,
    mu,
    phi,
    t,
    v0,
    xi_k,
)

K, ratio, over = sp.symbols("K ratio over", positive=True)
excess, last, s, u, x, y = sp.symbols("excess last s u x y", positive=True)
lead, square = sp.symbols("lead square", positive=True)
MOTION = m, v0, xi_k[2]
_p, _q = sp.symbols("p q", positive=True)
PLACE: Facts = {
    last: _p / (1 + _p),
    u: sp.sqrt(1 - _q / (1 + _q)),
    excess: (1 - (_p / (1 + _p)) ** 2) / (_p / (1 + _p)) ** sp.Rational(8, 3),
}
"""Any p, q > 0 are a point of the motion; excess follows from 1 = last^2 + excess last^(8/3)."""


def _rate() -> sp.Expr:
    """Return the angular frequency of the linear motion."""
    (wave,) = linear_motion().expression.atoms(sp.sin)
    return wave.args[0] / t


def _peak() -> sp.Expr:
    """Return the largest indentation of the linear motion."""
    return linear_motion().expression.subs(sp.sin(_rate() * t), 1)


def _number() -> sp.Expr:
    """Return the radicand at the turning point of the linear motion, over -v0^2."""
    return -linearisation()[2].expression / v0**2


@named_routine
def linear() -> Claims:
    """Return the indentation by the linear term, (15)."""
    return Claims(
        (t, *MOTION), (), (linear_motion().expression,), (linear_motion().expression,), {}
    )


@named_routine
def turning_point() -> Claims:
    """Return contact time and largest indentation of the linear motion, (15)."""
    return Claims(
        MOTION,
        (Let(over, m / xi_k[2]),),
        (sp.pi * sp.sqrt(over), v0 * sp.sqrt(over)),
        (sp.pi / _rate(), _peak()),
        {},
    )


@named_routine
def excess_at_turn() -> Claims:
    """Return the radicand of (17), (18) at the linear motion's turning point, over -v0^2."""
    return Claims((*MOTION, xi_k[3]), (), (_number(),), (_number(),), {})


@named_routine
def end_of_radicand() -> Claims:
    """Return the radicand over -v0^2 at s^2 = y^3, and its derivative with respect to y."""
    cube = sp.Symbol("cube", positive=True)
    claim = -(formal_speed_squared() / v0**2).subs(delta, _peak() * y ** sp.Rational(3, 2))
    return Claims(
        (y, excess),
        (Let(cube, y**3),),
        (cube + excess * y * cube - 1, 3 * y**2 + 4 * excess * cube),
        (claim, sp.diff(claim, y)),
        {excess: _number()},
    )


@named_routine
def cosine_at_end() -> Claims:
    """Return sqrt(1 - s^2) at s = last from the radicand, also where s is almost 1."""
    return Claims(
        (excess, last),
        (),
        (sp.sqrt(excess) * last ** sp.Rational(4, 3),),
        (sp.sqrt(1 - PLACE[last] ** 2),),
        PLACE,
    )


@named_routine
def integrands() -> Claims:
    """Return -F dt/du of (17), and -G dt/du of (18) over the largest indentation."""
    F, G, _ = (formula.expression for formula in linearisation())
    coefficient = xi_k[3] * PLACE[excess] / _number()
    inner = PLACE[last] * (_q / (1 + _q)) ** 3

    def of_theory(expression: sp.Expr) -> sp.Expr:
        by_theory: sp.Expr = expression.subs({xi_k[3]: coefficient, delta_0: inner * _peak()})
        return by_theory

    path = -sp.diff(last * (1 - u**2) ** 3, u).subs(PLACE) * _peak()
    path /= of_theory(sp.sqrt(v0**2 - xi_k[2] / m * delta_0**2))
    power = excess * s ** sp.Rational(8, 3)
    step = 6 * last * x**2
    force = s + sp.Rational(4, 3) * excess * s ** sp.Rational(5, 3)
    root = sp.Symbol("root", positive=True)
    return Claims(
        (u, excess, last),
        (
            Let(x, (1 - u) * (1 + u)),
            Let(s, last * x**3),
            Let(
                lead,
                last**2 * geometric(6, x) + excess * last ** sp.Rational(8, 3) * geometric(8, x),
                "the radicand over v0^2 u^2",
            ),
            Let(square, u**2 * lead + power, "(delta_0'/v0)^2"),
            Let(root, sp.sqrt(lead * square)),
        ),
        (step * force / root, u * step * power / (square + u * root)),
        (of_theory(F) * path, of_theory(G) * path / _peak()),
        PLACE,
    )


@named_routine
def radius_cubed() -> Claims:
    """Return a^3/P by (7)."""
    value = a**3 / contact_radius().expression
    return Claims((R, lam, mu), (), (value,), (value,), {})


@named_routine
def mode_terms() -> Claims:
    """Return one mode's terms of gamma_2 and gamma_3 of (10), from K_j and a/P^(1/3)."""
    values = tuple(mode_mean(k) for k in (2, 3))
    return Claims(
        (phi, K, ratio),
        (),
        values,
        tuple(printed_term(k) for k in (2, 3)),
        {K: contact_law()[0].expression, ratio: a / P ** sp.Rational(1, 3)},
    )


def mode_mean(k: int) -> sp.Expr:
    """Return one mode's term of gamma_k in K_j = K and a/P^(1/3) = ratio."""
    relative = printed_term(k) / contact_law()[0].expression
    return K * sp.powsimp(relative.subs(a, ratio * P ** sp.Rational(1, 3)), force=True)


@named_routine
def coefficients() -> Claims:
    """Return xi_2, and xi_3 as derived and as published, of (10)."""
    derived = {f.name: f.expression for f in formal_coefficients()}
    printed = {p.name: p.expression for p in PRINTED_MOTION}
    values = derived["xi_2"], derived["xi_3"], printed["xi_3"]
    return Claims((gamma_k[2], gamma_k[3]), (), values, values, {})


ROUTINES = linear, integrands, mode_terms
OF_ONE_MOTION = (
    turning_point,
    excess_at_turn,
    end_of_radicand,
    cosine_at_end,
    radius_cubed,
    coefficients,
)


def perturbation_kernels() -> Routines:
    """Return the routines of the paper's own motion, printed from proved expressions."""
    title = "The paper's own motion, (10) and (14) to (18)."
    return Routines("perturbation_kernels", title, tuple(make() for make in ROUTINES), {})


def motion_kernels() -> Routines:
    """Return the routines for the constants of a single motion."""
    title = "Numbers of the paper's own motion, (10) and (15) to (18)."
    made = tuple(make() for make in OF_ONE_MOTION)
    return Routines("motion_kernels", title, made, {}, QUIET_SCALARS)
