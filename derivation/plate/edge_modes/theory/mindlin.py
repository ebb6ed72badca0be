"""Step 30, first part: waves of a shear-deformable plate by Mindlin's equations, b = 1.

With the deflection w(r) cos(omega t), the rotation psi(r) cos(omega t) of the cross-section and the
shear strain w' + psi, Hooke's law for moment and shear force in units of 2 mu h and the balances of
force and moment are

    Q = k_s (w' + psi),   M = eta^2/(3 n) (psi' + nu psi/r),   n = (1 - nu)/2,
    (r Q)'/r + kap/eta^2 w = 0,   eta^2/(3 n) (psi' + psi/r)' - Q + kap/3 psi = 0.

w = J0(k r) - c I0(k2 r), psi = g1 k J1(k r) + c g2 k2 I1(k2 r) with

    g1 = 1 - kap/(k_s x^2),   g2 = 1 + kap/(k_s eta^2 k2^2),   x = k eta,
    k2^2 = k^2 - (kap/eta^2)(1/k_s + n)

satisfies the first for any kap. In the second it leaves, for both parts, a multiple of

    3 n xi - x^2 u1 u2,   xi = kap/x^2,   u1 = g1,   u2 = g2 k2^2/k^2 = 1 - n xi,

which is 0 on both of Mindlin's branches: k^2 and -k2^2 are the roots of his dispersion relation at
one frequency, and the formula for k2^2 is their sum. On the lower branch

    kap = x^4/(3 n) [1 - (1/k_s + n) x^2/(3 n) + ...],

which equals the exact branch A0 of step 27 to this order for k_s = 5/(6 - nu) only. Therefore
clamped and supported plates use kap of A0, and everything else from here: at A0 the expression
above is of order x^6.

For two motions of frequencies kap_1 and kap_2 (Lagrange's identity)

    [r (Q_1 w_2 - Q_2 w_1 + M_1 psi_2 - M_2 psi_1)]' = (kap_2 - kap_1)/eta^2
                                                        (w_1 w_2 + eta^2/3 psi_1 psi_2) r:

motions with the same edge conditions are orthogonal. For neighbouring frequencies and w(1) = 0,

    M^2 d(psi/M)/dkap = (1/eta^2) int_0^1 (w^2 + eta^2/3 psi^2) r dr > 0 at r = 1,

so that psi/M increases with the frequency of Mindlin's plate from pole to pole.
"""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import Proof, lower_bessel, prove
from derivation.plate.modes.theory.equilibrium import without_functions
from derivation.plate.vocabulary import Formula, eta, gam, k_n, kap, nu, x_h
from derivation.plate.waves.theory.bending_branch import thin_powers

k_2, xi = sp.symbols("k_2 xi", positive=True)
"""Wave number of the evanescent wave times b; kap/x^2."""
c, shear = sp.symbols("c s", real=True)
"""Amplitude of I0; 1/k_s."""
ROTARY = (1 - nu) / 2
"""n: rotary inertia times eta^2 k^4, divided by kap times a third of the bending stiffness."""
_r = sp.Symbol("r", positive=True)
_J0, _J1 = sp.besselj(0, k_n * _r), sp.besselj(1, k_n * _r)
_I0, _I1 = sp.besseli(0, k_2 * _r), sp.besseli(1, k_2 * _r)
DEFLECTION = _J0 - c * _I0
"""w of the wave numbers k and k2, as functions of r."""


@cache
def shear_coefficient() -> Formula:
    """Return k_s for which Mindlin's lower branch equals A0 to one more order."""
    s, y_0, y_1 = sp.symbols("s y_0 y_1", positive=True)
    # kap = x^4 (y_0 + y_1 s), s = x^2, in the dispersion relation over x^2.
    value = s * (y_0 + y_1 * s)
    left = sp.expand(dispersion(sp.sqrt(s)).subs(xi, value) / s)
    powers = [left.coeff(s, order) for order in range(2)]
    exact = [sp.cancel(row.subs(gam, (1 - 2 * nu) / (2 * (1 - nu)))) for row in thin_powers(3)[0]]
    known = {y_0: exact[0], y_1: exact[1]}
    (solution,) = sp.solve(powers[1].subs(known), shear)
    value = sp.together(1 / sp.expand(solution))
    third = y_0 + y_1 * s + exact[2] * s**2
    next_order = sp.expand(dispersion(sp.sqrt(s)).subs(xi, s * third) / s).coeff(s, 2)
    lacking = sp.factor(next_order.subs(known).subs(shear, solution))
    if lacking == 0:
        raise ArithmeticError("Mindlin's branch does not equal A0 to three orders as stated")
    proof = prove(
        "Shear coefficient",
        "A0's power series, of step 27, is inserted into Mindlin's dispersion relation. The first "
        "order vanishes for any $k_s$, the second for this one, the third for none.",
        lambda value: {
            "first order": sp.cancel(powers[0].subs(known)),
            "second order": sp.cancel(powers[1].subs(known).subs(shear, 1 / value)),
            "in nu": value - 5 / (6 - nu),
        },
        value,
    )
    return Formula(
        "shear_coefficient", "k_s", "shear coefficient for which Mindlin's lower branch follows A0",
        value, "1", "", ("bending_kap_thin",), proof,
    )  # fmt: skip


def slack() -> sp.Expr:
    """Return 1/k_s."""
    return sp.expand(1 / shear_coefficient().expression)


# --- in xi = kap/x^2, of any k_s


def u_1() -> sp.Expr:
    """Return g1."""
    return 1 - shear * xi


def u_2() -> sp.Expr:
    """Return g2 k2^2/k^2."""
    return 1 - ROTARY * xi


def left() -> sp.Expr:
    """Return k2^2/k^2."""
    return 1 - (shear + ROTARY) * xi


def dispersion(x: sp.Expr) -> sp.Expr:
    """Return the expression that is 0 on Mindlin's branches."""
    return 3 * ROTARY * xi - x**2 * u_1() * u_2()


def rotation(g_1: sp.Expr, g_2: sp.Expr) -> sp.Expr:
    """Return psi as a function of r."""
    return g_1 * k_n * _J1 + c * g_2 * k_2 * _I1


def balances(w: sp.Expr, psi: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return the residuals of force and moment in Mindlin's equations, over 2 mu h."""
    force = (sp.diff(w, _r) + psi) / shear
    turned = sp.diff(sp.diff(psi, _r) + psi / _r, _r)
    return (
        sp.diff(_r * force, _r) / _r + kap / eta**2 * w,
        eta**2 / (3 * ROTARY) * turned - force + kap / 3 * psi,
    )


@cache
def waves() -> tuple[Formula, ...]:
    """Return k2, g1 and g2, with the proof that they satisfy Mindlin's equations."""
    of_kap = {xi: kap / (k_n * eta) ** 2}
    g_1, g_2 = u_1(), u_2() * k_n**2 / k_2**2
    partner = k_n**2 * left().subs(of_kap)
    psi = rotation(g_1, g_2).subs(of_kap)
    by_partner = {kap: (k_n**2 - k_2**2) * eta**2 / (shear + ROTARY)}
    force, moment = balances(DEFLECTION, psi)
    number = dispersion(k_n * eta).subs(of_kap)
    left_over = number * k_n**2 / (3 * ROTARY) * (_J1 / k_n - c * _I1 / k_2)
    # -k2^2 for k^2 at the same kap.
    other = dispersion(k_n * eta).subs(of_kap).subs(k_n, sp.I * k_2)
    stated = 1 + kap * shear / (eta * k_2) ** 2
    known, k_s = {shear: slack()}, shear_coefficient().expression
    partner_k = sp.sqrt(partner.subs(known))
    values = (
        partner_k, g_1.subs(of_kap).subs(known), stated.subs(known).subs(k_2, partner_k),
        stated.subs(known),
    )  # fmt: skip
    general = {
        "by partner": (k_n**2 - k_2**2 - kap / eta**2 * (shear + ROTARY)).subs(by_partner),
        "force": lower_bessel(force.doit()).subs(by_partner),
        "moment": lower_bessel((moment - left_over).doit()).subs(by_partner),
        "partner": sp.cancel((other * k_2**2 + number * k_n**2).subs(by_partner)),
        "k_2": sp.cancel((partner - k_2**2).subs(by_partner)),
        "g_2": sp.cancel((g_2.subs(of_kap) - stated).subs(by_partner)),
        "sum": sp.expand(left() - u_1() - u_2() + 1),
    }
    proof = prove(
        "Waves of Mindlin's plate",
        r"$w$ and $\psi$ are inserted into both balances for any $\kappa$ and $k_s$, with $\kappa$ "
        "in terms of $k$ and $k_2$. The dispersion relation is quadratic in $k^2$; its other root "
        "is $-k_2^2$.",
        lambda k2, first, second, in_k2: (
            general
            | {
                "k_2 of A0": k2**2 - k_n**2 + kap / eta**2 * (1 / k_s + ROTARY),
                "g_1 of A0": first - 1 + kap / (k_s * (k_n * eta) ** 2),
                "g_2 of A0": second * k2**2 - k_n**2 * u_2().subs(of_kap),
                "g_2 in k_2": second - in_k2.subs(k_2, k2),
            }
        ),
        *values,
    )
    rows = (
        (
            "evanescent_wave_number", "k_2", "wave number of a mode's evanescent part times $b$",
            None, ("shear_coefficient",),
        ),
        (
            "wave_rotation", "g_1", "rotation divided by slope, of the part $J_0$",
            None, ("shear_coefficient",),
        ),
        (
            "evanescent_rotation", "g_2", "rotation divided by slope, of the part $I_0$",
            values[3], ("evanescent_wave_number",),
        ),
    )  # fmt: skip
    return tuple(
        Formula(name, latex, meaning, value, "1", "", sources, proof, stated=said)
        for (name, latex, meaning, said, sources), value in zip(rows, values[:3], strict=True)
    )


@cache
def lagrange() -> Proof:
    """Prove Lagrange's identity for motions of two frequencies."""
    one, two = sp.symbols("kap_1 kap_2", positive=True)
    w_1, w_2, psi_1, psi_2 = (sp.Function(f)(_r) for f in ("w_1", "w_2", "psi_1", "psi_2"))

    def resultants(w: sp.Expr, psi: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        stiffness = eta**2 / (3 * ROTARY)
        return (sp.diff(w, _r) + psi) / shear, stiffness * (sp.diff(psi, _r) + nu * psi / _r)

    motion = {}
    for w, psi, rate in ((w_1, psi_1, one), (w_2, psi_2, two)):
        force, moment = (part.subs(kap, rate) for part in balances(w, psi))
        for balance, unknown in ((force, w), (moment, psi)):
            second = sp.diff(unknown, _r, 2)
            motion[second] = sp.solve(sp.expand(balance.doit()), second)[0]
    (Q_1, M_1), (Q_2, M_2) = resultants(w_1, psi_1), resultants(w_2, psi_2)
    flow = _r * (Q_1 * w_2 - Q_2 * w_1 + M_1 * psi_2 - M_2 * psi_1)
    kinetic = (two - one) / eta**2 * (w_1 * w_2 + eta**2 / 3 * psi_1 * psi_2) * _r
    grown = sp.diff(flow, _r).subs(motion)
    p, m, p_1, m_1, step = sp.symbols("psi M psi' M' d", real=True)
    # At the edge w = 0; the second motion has psi + psi' d and M + M' d.
    edge = m * (p + p_1 * step) - (m + m_1 * step) * p
    return prove(
        "Lagrange's identity of Mindlin's plate",
        "The flow of force and moment is differentiated with both motions' balances; at an edge "
        "without deflection the flow of neighbouring motions is M^2 d(psi/M).",
        {
            "flow": sp.expand(without_functions(grown - kinetic, w_1, w_2, psi_1, psi_2)),
            "edge": sp.expand(edge - step * (m * p_1 - p * m_1)),
        },
    )


def on_lower_branch() -> sp.Expr:
    """Return d log(xi)/d log(x) of Mindlin's lower branch, in xi."""
    relation = dispersion(x_h)
    return -x_h * sp.diff(relation, x_h) / (xi * sp.diff(relation, xi))
