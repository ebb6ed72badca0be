"""Step 34: stress that a free wave causes on the back face, opposite the contact.

A wave w(+h) J0(phi r) of one branch of step 26 has, on the axis of the back face, the radial stress

    sigma = (mu/h) S w(+h),   S_a = (3 - 4 gam) (2 x^2 - kap) tanh(p)/(2 p),
                              S_s = (4 gam - 3) (2 x^2 - kap) coth(p)/(2 p),

in bending and in extension: the faces are free, so that the stress is that of the radial strain
alone, whose ratio to w follows from the shear stress. Tension is positive, and w(+h) is along the
load. For thin plates S_a is x^2 (1 + nu)/(1 - nu), that of a bent plate.

A mode of a clamped or supported plate (step 30) has the rotation psi = g1 k J1 + c g2 k2 I1. On the
axis the bending stress is proportional to psi' + psi/r = g1 k^2 + c g2 k2^2, and the contact face
deflects 1 - c t, both for a J0 of amplitude 1. With S_a of A0 for this J0,

    sigma = (mu/h) S_a (1 + c g2 k2^2/(g1 k^2))/(1 - c t) w(+h).
"""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import lower_bessel, prove
from derivation.plate.edge_modes.theory import mindlin
from derivation.plate.edge_modes.theory.waves import g_1, g_2, in_k, t
from derivation.plate.modes.theory.equilibrium import BESSEL_J0, BESSEL_J1, hooke
from derivation.plate.vocabulary import (
    C1,
    C3,
    Formula,
    eta,
    gam,
    h,
    k_n,
    kap,
    lam,
    mu,
    nu,
    phi,
    r,
    x_h,
    z,
)
from derivation.plate.waves.theory.dynamic_modes import (
    in_p_and_q,
    p,
    q,
    stiffness,
    wave,
    with_roots,
)

OF_Q = sp.Symbol("t_q", positive=True)
OF_P = 4 * x_h**2 * p * q * OF_Q / (x_h**2 + q**2) ** 2
"""tanh(q), and tanh(p) of a wave in bending, where both faces are free: B_a = 0. In extension they
are coth(q) and coth(p)."""
S_A = sp.Symbol("S_a", real=True)
MODE = S_A * (1 + mindlin.c * g_2 * mindlin.k_2**2 / (g_1 * k_n**2)) / (1 - mindlin.c * t)
"""Stress of a mode of a clamped or supported plate, in S_a of its part J0."""


def stress(tanh_p: sp.Expr, bends: bool) -> sp.Expr:
    """Return S_a for tanh(p), or S_s for coth(p), in x, kap, gam and p."""
    sign = 1 if bends else -1
    return sign * (3 - 4 * gam) * (2 * x_h**2 - kap) * tanh_p / (2 * p)


def _on_axis(expression: sp.Expr) -> sp.Expr:
    """Return a stress on the axis, where J0(phi r) = 1 and J1(phi r)/r = phi/2."""
    plain = sp.expand(lower_bessel(expression.doit()))
    return plain.subs(BESSEL_J1 / r, phi / 2).subs({BESSEL_J0: 1, BESSEL_J1: 0})


def _residual(bends: bool) -> sp.Expr:
    """Return the error of S for a wave of free faces; h = mu = 1."""
    shape = sp.cosh if bends else sp.sinh
    free = wave(C1 * shape(p * z / h), C3 * shape(q * z / h) / phi)
    radial = _on_axis(hooke(free.g * phi * BESSEL_J1, free.f * BESSEL_J0).rr)
    (amplitude,) = sp.solve(in_p_and_q(free.rz).subs(z, 1), C3)
    # A load along w is a pressure on the upper face, towards the back face.
    ratio = (-in_p_and_q(radial).subs(z, -1) / in_p_and_q(free.f).subs(z, 1)).subs(C3, amplitude)
    tanh = {p: OF_P, q: OF_Q} if bends else {p: 1 / OF_P, q: 1 / OF_Q}
    plain = ratio.replace(sp.sinh, lambda y: sp.cosh(y) * tanh[y])
    return sp.cancel(plain - in_p_and_q(stress(OF_P, bends)))


def _thin() -> sp.Expr:
    """Return the error of a bent plate's stress for x -> 0."""
    small = x_h**4 * sp.Symbol("slope", positive=True)
    value = with_roots(stress(sp.tanh(p), True)).subs(kap, small)
    bent = x_h**2 * (1 + nu) / (1 - nu)
    ratio = value.subs(gam, (1 - 2 * nu) / (2 * (1 - nu))) / bent
    return sp.simplify(sp.limit(ratio, x_h, 0) - 1)


@cache
def wave_stress() -> tuple[Formula, ...]:
    """Return the formulas of the step."""
    residuals = {
        "free faces": sp.cancel(in_p_and_q(stiffness(OF_P, OF_Q))),
        "bending": _residual(True),
        "extension": _residual(False),
        "thin plate": _thin(),
    }
    expressions = {"bending": stress(sp.tanh(p), True), "extension": stress(sp.coth(p), False)}
    proof = prove(
        "Stress of a wave on the back face",
        "The amplitude of the part without dilatation follows from the shear stress on the faces, "
        r"and $\tanh p$, or $\coth p$, from their normal stress: $B = 0$. Both are inserted into "
        "the radial stress on the axis.",
        lambda *claims: (
            residuals
            | {
                f"{kind} in {of}": value - expected
                for (kind, expected), one in zip(
                    expressions.items(), (claims[:2], claims[2:]), strict=True
                )
                for of, value, expected in (
                    ("x", one[0], with_roots(expected)),
                    ("p", one[1], expected),
                )
            }
        ),
        *(part for stated in expressions.values() for part in (with_roots(stated), stated)),
    )
    rows = (
        ("bending_wave_stress", "S_a", "bending", sp.tanh(p), True, "B_a"),
        ("extension_wave_stress", "S_s", "extension", sp.coth(p), False, "B_s"),
    )
    waves = tuple(
        Formula(
            name, latex, f"stress of a wave in {kind} on the axis of the back face, over its "
            r"deflection of the contact face, times $h/\mu$",
            with_roots(stress(tanh_p, bends)), "1", "", (source,), proof,
            stated=stress(tanh_p, bends),
        )
        for name, latex, kind, tanh_p, bends, source in rows
    )  # fmt: skip
    psi = mindlin.rotation(g_1, g_2)
    distance = sp.Symbol("r", positive=True)
    curved = sp.limit(sp.diff(psi, distance) + psi / distance, distance, 0)
    own = curved.subs(mindlin.c, 0)
    of_part = waves[0].expression.subs(x_h, k_n * eta)
    of_nu = (1 - 2 * nu) / (2 * (1 - nu))
    value = in_k(MODE).subs(S_A, of_part.subs(gam, of_nu))
    of_mode = prove(
        "Stress of a mode on the back face",
        r"$\psi' + \psi/r$ is evaluated on the axis, and divided by its value for the part $J_0$.",
        lambda value, stated: {
            "axis": sp.cancel(S_A * curved / own / (1 - mindlin.c * t) - stated),
            "gamma": of_nu.subs(nu, lam / (2 * (lam + mu))) - mu / (lam + 2 * mu),
            "in k": value.subs(k_n, x_h / eta)
            - in_k(stated).subs(k_n, x_h / eta).subs(S_A, waves[0].expression.subs(gam, of_nu)),
        },
        *(value, MODE),
    )
    mode = Formula(
        "mode_stress", "S_n", "stress of a mode of a clamped or supported plate on the axis of the "
        r"back face, over its deflection of the contact face, times $h/\mu$",
        value, "1", "",
        (waves[0].name, "face_ratio", "wave_rotation", "evanescent_rotation"), of_mode, stated=MODE,
    )  # fmt: skip
    return *waves, mode
