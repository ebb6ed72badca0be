"""Link 24: a viscous contact, how much of the speed it takes and what it can change at most.

Kuwabara and Kono (1987), Brilliantov et al. (1996): the indentation of the half-space lags the
force, P = P_e + A_v dP_e/dt, A_v a retardation time, and the contact ends with P = 0, for it
cannot pull. With the elastic energy U, s = sqrt(2 U/m), v = dz/dt, Omega = P_e/(m s) and
epsilon(s) = A_v P_e'(z) s/P_e,

    s = rho sin(phi),  v = rho cos(phi):   rho' = -epsilon Omega rho cos^2(phi),
                                           phi' = Omega (1 + epsilon sin(phi) cos(phi)),
                                           P = m Omega rho (sin(phi) + epsilon cos(phi)).

The impact runs from phi = 0 over the turning point phi = pi/2 to tan(phi) = -epsilon. Let
epsilon stand for its largest value below, s <= v0; n = d log P_e/d log z at its largest over
that at the turning point; and d log Omega/d log s lie between -nu_- and nu_+. Then

    at the turning point   0 <= -log(s/v0) <= (pi/4) epsilon,     as |sin phi cos phi| <= 1/2
    in the end             0 <= -log(rho/v0) <= Lambda = (pi/2) epsilon/(1 - epsilon/2)
    largest force          P_e(s) <= P <= P_m sqrt(1 + epsilon^2)
    restitution            1 >= e >= exp(-Lambda)/sqrt(1 + epsilon^2)
    contact time, over     exp(nu_+ Lambda)/(1 - epsilon/2)
      that without         (1 - n epsilon/2) exp(-nu_- Lambda)/(1 + epsilon/2)

where the elastic motion from tan(phi) = -epsilon on, left out, has z <= n_z A_v |v| to go and
lasts n_z A_v at most, while the whole lasts 2 delta_m/v0 at least. Proved for a half-space
without weight; with a plate, whose bending is elastic, epsilon is taken of the whole law.
The weight, sinking by delta_m, makes the largest U that of the sphere times u > 1. Of this the
same share is lost, so that e^2 >= 1 - u (1 - exp(-2 Lambda)/(1 + epsilon^2)); and what sinks less
than it rises, z <= n_z A_v |v| at the end, may leave faster: e^2 <= 1 + (u - 1) n epsilon.
The time of a sphere that rises against its weight grows like what it lost of its speed, by which
its bound is widened. What is said of the end takes epsilon(s) and P_e to fall with s, P_e
convex; with weight and plates these are no proofs, and random scenes hold them.
"""

from functools import cache

import flint
import sympy as sp

from derivation.engine.formula.ball import refine
from derivation.engine.formula.proof import Proof, prove
from derivation.plate.modes.theory.influence import PLANE_STRAIN_MODULUS
from derivation.plate.vocabulary import Formula, R, m, v0, viscous_time, x_v

_FIFTH = sp.Rational(1, 5)
_s, _v, _Omega, _e, _phi, _rho = sp.symbols("s v Omega epsilon phi rho", positive=True)
_K, _z = sp.symbols("K z", positive=True)


@cache
def polar() -> Proof:
    """The motion in the plane of s and v, in polar coordinates."""
    # m s s' = P_e v, and m v' = -(P_e + A P_e' v) with A P_e' = epsilon P_e/s.
    rate_s = _Omega * _v
    rate_v = -_Omega * _s - _e * _Omega * _v
    there = {_s: _rho * sp.sin(_phi), _v: _rho * sp.cos(_phi)}

    def on_circle(x: sp.Expr) -> sp.Expr:
        return sp.expand(sp.expand(x.subs(there)).subs(sp.sin(_phi) ** 2, 1 - sp.cos(_phi) ** 2))

    radial = (_s * rate_s + _v * rate_v) / _rho
    turning = (_v * rate_s - _s * rate_v) / _rho**2
    across = _e * sp.sin(_phi) * sp.cos(_phi)
    return prove(
        "Viscous contact in polar coordinates",
        "s' = Omega v and v' = -Omega (s + epsilon v) with s = rho sin phi, v = rho cos phi.",
        {
            "radius": on_circle(radial + _e * _Omega * _rho * sp.cos(_phi) ** 2),
            "angle": on_circle(turning - _Omega * (1 + across)),
            "quarter": sp.integrate(sp.cos(_phi) ** 2, (_phi, 0, sp.pi / 2)) - sp.pi / 4,
            "half": sp.integrate(sp.cos(_phi) ** 2, (_phi, 0, sp.pi)) - sp.pi / 2,
            "across": sp.expand_trig(across - _e * sp.sin(2 * _phi) / 2),
        },
    )


@cache
def viscous_number() -> Formula:
    """x, on which Hertz's impact depends alone: epsilon = (4/5)^(2/5) x at the turning point."""
    polar()
    # Hertz: P = K z^(3/2), U = (2/5) K z^(5/2).
    speed = sp.sqrt(sp.Rational(4, 5) * _K * _z ** sp.Rational(5, 2) / m)
    force = _K * _z ** sp.Rational(3, 2)
    ratio = sp.powsimp(sp.diff(force, _z) * viscous_time * speed / force)
    deepest = (sp.Rational(5, 4) * m * v0**2 / _K) ** sp.Rational(2, 5)
    number = sp.Rational(3, 2) * viscous_time * (_K / m) ** sp.Rational(2, 5) * v0**_FIFTH
    rise = sp.powsimp(ratio / speed**_FIFTH)

    def plain(x: sp.Expr) -> sp.Expr:
        return sp.powsimp(sp.expand_power_base(sp.powdenest(x, force=True), force=True))

    proof = prove(
        "Viscous number",
        r"$\varepsilon$ of Hertz's law goes with $s^{1/5}$; at the turning point $s = v_0$.",
        {
            "rise": sp.diff(plain(rise), _z),
            "turning point": plain(ratio.subs(_z, deepest))
            / plain(sp.Rational(4, 5) ** sp.Rational(2, 5) * number)
            - 1,
        },
    )
    hertz = sp.Rational(4, 3) * PLANE_STRAIN_MODULUS
    rate = hertz ** sp.Rational(2, 5) * (R * v0 / m**2) ** _FIFTH
    return Formula(
        "viscous_number",
        "x_v",
        "viscous number: what a viscous contact takes of the speed, to leading order",
        sp.Rational(3, 2) * viscous_time * rate,
        "1",
        "",
        ("C_half",),
        proof,
    )


C_1 = sp.Rational(4, 5) ** sp.Rational(2, 5) * sp.beta(sp.Rational(3, 5), sp.Rational(3, 2))
"""First coefficient of the restitution: (4/5)^(2/5) B(3/5, 3/2)."""


@cache
def weak_restitution() -> Formula:
    """e to second order in x; the third term is of order x^(5/2), by the early end.

    To first order -log e = int_0^pi epsilon cos^2 phi dphi with epsilon ~ sin^(1/5) phi. Run
    backwards in time an impact at e v0 with -A_v ends at v0: e(x) e(-x e^(1/5)) = 1.
    """
    viscous_number()
    c_1, c_2, x = sp.symbols("c_1 c_2 x", positive=True)
    back = 1 + c_1 * x * (1 - c_1 * x) ** _FIFTH + c_2 * x**2
    product = sp.series((1 - c_1 * x + c_2 * x**2) * back, x, 0, 3).removeO()
    share = _phi**_FIFTH * sp.sqrt(1 - _phi**2)  # phi -> arcsin, both halves: twice
    loss = 2 * sp.hyperexpand(sp.integrate(share, (_phi, 0, 1)))
    loss *= sp.Rational(4, 5) ** sp.Rational(2, 5)
    proof = prove(
        "Weakly viscous restitution",
        "The loss along the elastic motion; the second term from the motion run backwards.",
        {
            "first": sp.gammasimp((loss - C_1).rewrite(sp.gamma)),
            "second": product.coeff(x, 2).subs(c_2, sp.Rational(3, 5) * c_1**2),
        },
    )
    return Formula(
        "restitution_weak",
        "e",
        "restitution of a weakly viscous contact, to second order",
        1 - C_1 * x_v + sp.Rational(3, 5) * C_1**2 * x_v**2,
        "1",
        "",
        ("viscous_number",),
        proof,
    )


def viscosity() -> tuple[Formula, ...]:
    """The formulas of the link."""
    return viscous_number(), weak_restitution()


def loss_ball(digits: int = 20) -> flint.arb:
    """C_1 as a ball."""

    def compute() -> flint.arb:
        two, three = flint.arb(3) / 5, flint.arb(3) / 2
        beta = two.gamma() * three.gamma() / (two + three).gamma()
        return (flint.arb(4) / 5) ** (flint.arb(2) / 5) * beta

    return refine(compute, digits, "the restitution's first coefficient")
