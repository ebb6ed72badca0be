"""Step 24: viscoelastic contact and its loss of speed.

Kuwabara and Kono (1987), Brilliantov et al. (1996): the indentation of the half-space lags the
force, P = P_e + A_v dP_e/dt, A_v a retardation time, and the contact ends with P = 0, because
the force cannot be tensile. With the elastic energy U, s = sqrt(2 U/m), v = dz/dt,
Omega = P_e/(m s) and
epsilon(s) = A_v P_e'(z) s/P_e,

    s = rho sin(phi),  v = rho cos(phi):   rho' = -epsilon Omega rho cos^2(phi),
                                           phi' = Omega (1 + epsilon sin(phi) cos(phi)),
                                           P = m Omega rho (sin(phi) + epsilon cos(phi)).

The impact runs from phi = 0 over the turning point phi = pi/2 to tan(phi) = -epsilon. The module
`bounds` bounds its effect.
"""

from functools import cache
from typing import NamedTuple

import flint
import sympy as sp

from derivation.engine.formula.ball import refine
from derivation.engine.formula.functions import unspecified_function
from derivation.engine.formula.proof import Proof, prove
from derivation.plate.modes.theory.influence import PLANE_STRAIN_MODULUS
from derivation.plate.vocabulary import Formula, R, m, v0, viscous_time, x_v

_FIFTH = sp.Rational(1, 5)
epsilon, phi = sp.symbols("epsilon phi", positive=True)
_s, _v, _Omega, _rho = sp.symbols("s v Omega rho", positive=True)
_K, _z = sp.symbols("K z", positive=True)


def spiral() -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Return rho'/(Omega rho), phi'/Omega and P/(m Omega rho), in epsilon and phi."""
    turning = 1 + epsilon * sp.sin(phi) * sp.cos(phi)
    return -epsilon * sp.cos(phi) ** 2, turning, sp.sin(phi) + epsilon * sp.cos(phi)


def on_circle(x: sp.Expr) -> sp.Expr:
    """Return the expression in powers of the cosine, with at most one sine."""
    return sp.expand(sp.expand(x).subs(sp.sin(phi) ** 2, 1 - sp.cos(phi) ** 2))


@cache
def polar() -> Proof:
    """Prove the motion in the plane of s and v, in polar coordinates."""
    # m s s' = P_e v, and m v' = -(P_e + A P_e' v) with A P_e' = epsilon P_e/s.
    rate_s = _Omega * _v
    rate_v = -_Omega * _s - epsilon * _Omega * _v
    there = {_s: _rho * sp.sin(phi), _v: _rho * sp.cos(phi)}

    def turned(x: sp.Expr) -> sp.Expr:
        return on_circle(x.subs(there))

    radial, turning, force = spiral()
    return prove(
        "Viscoelastic contact in polar coordinates",
        "s' = Omega v and v' = -Omega (s + epsilon v) with s = rho sin phi, v = rho cos phi.",
        {
            "radius": turned((_s * rate_s + _v * rate_v) / _rho**2 - _Omega * radial),
            "angle": turned((_v * rate_s - _s * rate_v) / _rho**2 - _Omega * turning),
            "force": turned(-rate_v - _Omega * _rho * force),
        },
    )


@cache
def viscous_number() -> Formula:
    """Return x, the only parameter of Hertz's impact; epsilon is (4/5)^(2/5) x at the turn."""
    polar()
    # Hertz: P = K z^(3/2), U = (2/5) K z^(5/2).
    speed = sp.sqrt(sp.Rational(4, 5) * _K * _z ** sp.Rational(5, 2) / m)
    force = _K * _z ** sp.Rational(3, 2)
    ratio = sp.powsimp(sp.diff(force, _z) * viscous_time * speed / force)
    deepest = (sp.Rational(5, 4) * m * v0**2 / _K) ** sp.Rational(2, 5)
    hertz = sp.Rational(4, 3) * PLANE_STRAIN_MODULUS
    rate = hertz ** sp.Rational(2, 5) * (R * v0 / m**2) ** _FIFTH
    number = sp.Rational(3, 2) * viscous_time * rate
    rise = sp.powsimp(ratio / speed**_FIFTH)

    def plain(x: sp.Expr) -> sp.Expr:
        return sp.powsimp(sp.expand_power_base(sp.powdenest(x, force=True), force=True))

    proof = prove(
        "Viscous number",
        r"The parameter $\varepsilon$ of Hertz's law is proportional to $s^{1/5}$, and $s = v_0$ "
        r"at the turning point.",
        lambda number: {
            "power of the speed": sp.diff(plain(rise), _z),
            "turning point": ratio.subs(_z, deepest).subs(_K, hertz * sp.sqrt(R))
            / (sp.Rational(4, 5) ** sp.Rational(2, 5) * number)
            - 1,
        },
        number,
    )
    return Formula(
        "viscous_number",
        "x_v",
        "viscous parameter, to leading order proportional to the relative loss of speed",
        number,
        "1",
        "",
        ("C_half",),
        proof,
    )


class DelayedForce(NamedTuple):
    """Force of a viscoelastic contact, and the rate of its elastic force P_e, with their proof.

    Attributes
    ----------
    by_rate
        The force at a rate of the indentation, if nothing but the contact deforms.
    force, elastic_rate
        The force, and the rate of P_e, if the plate bends elastically.
    proof
        The proof of the three.
    """

    by_rate: sp.Expr
    force: sp.Expr
    elastic_rate: sp.Expr
    proof: Proof


P_e, stiffness, rate, lag, compliance = sp.symbols("P_e stiffness rate lag compliance", real=True)
"""Elastic force, its derivative by the indentation, rate of the indentation, indentation minus that
of a static contact under P_e, and bending compliance of the plate."""


@cache
def delayed_force() -> DelayedForce:
    """Return the force P = P_e + A_v dP_e/dt of a contact, on a plate that does or does not bend.

    A plate that bends follows the force at once. Under P_e alone the contact would have the
    indentation of a static contact; bending under P - P_e adds the rest.
    """
    t, P, slope = sp.symbols("t P slope", real=True)
    stiffness_of = unspecified_function("stiffness_of")
    z, elastic = sp.Function("z")(t), unspecified_function("elastic", stiffness_of)
    (solved,) = sp.solve(
        (P - P_e - viscous_time * slope, compliance * (P - P_e) - lag), (P, slope), dict=True
    )
    names = {sp.diff(z, t): rate, elastic(z): P_e, stiffness_of(z): stiffness}
    delayed = (elastic(z) + viscous_time * sp.diff(elastic(z), t)).subs(names)

    def residuals(by_rate: sp.Expr, force: sp.Expr, elastic_rate: sp.Expr) -> dict[str, sp.Expr]:
        return {
            "by rate": by_rate - delayed,
            "delay": force - P_e - viscous_time * elastic_rate,
            "bending": compliance * (force - P_e) - lag,
        }

    claims = P_e + viscous_time * stiffness * rate, solved[P], solved[slope]
    proof = prove(
        "Force of a viscoelastic contact",
        "The elastic force is differentiated along the motion; with bending, the delay of the "
        "force and the indentation are two linear equations for the force and the rate.",
        residuals,
        *claims,
    )
    return DelayedForce(*claims, proof)


C_1 = sp.Rational(4, 5) ** sp.Rational(2, 5) * sp.beta(sp.Rational(3, 5), sp.Rational(3, 2))
"""First coefficient of the restitution: (4/5)^(2/5) B(3/5, 3/2)."""


@cache
def weak_restitution() -> Formula:
    """Return e to second order in x; the third term is of order x^(5/2), due to the early end.

    To first order -log e = int_0^pi epsilon cos^2 phi dphi with epsilon ~ sin^(1/5) phi. Reversed
    in time, an impact at e v0 with -A_v ends at v0: e(x) e(-x e^(1/5)) = 1.
    """
    viscous_number()
    c_1, c_2, x = sp.symbols("c_1 c_2 x", positive=True)
    back = 1 + c_1 * x * (1 - c_1 * x) ** _FIFTH + c_2 * x**2
    product = sp.series((1 - c_1 * x + c_2 * x**2) * back, x, 0, 3).removeO()
    integrand = phi**_FIFTH * sp.sqrt(1 - phi**2)  # phi -> arcsin, both halves: twice
    loss = 2 * sp.hyperexpand(sp.integrate(integrand, (phi, 0, 1)))
    loss *= sp.Rational(4, 5) ** sp.Rational(2, 5)
    second = sp.solve(product.coeff(x, 2), c_2)[0].subs(c_1, C_1)
    value = 1 - C_1 * x_v + sp.Rational(3, 5) * C_1**2 * x_v**2
    proof = prove(
        "Restitution of a weakly viscoelastic contact",
        "The first term is the loss along the elastic motion; the second follows from the "
        "time-reversed motion.",
        lambda e: {
            "loss": sp.gammasimp((loss - C_1).rewrite(sp.gamma)),
            "to second order": sp.expand(e - 1 + C_1 * x_v - second * x_v**2),
        },
        value,
    )
    return Formula(
        "restitution_weak",
        "e",
        "coefficient of restitution of a weakly viscoelastic contact, to second order",
        value,
        "1",
        "",
        ("viscous_number",),
        proof,
    )


def loss_ball(digits: int = 20) -> flint.arb:
    """Return C_1 as a ball."""

    def compute() -> flint.arb:
        two, three = flint.arb(3) / 5, flint.arb(3) / 2
        beta = two.gamma() * three.gamma() / (two + three).gamma()
        return (flint.arb(4) / 5) ** (flint.arb(2) / 5) * beta

    return refine(compute, digits, "the restitution's first coefficient")
