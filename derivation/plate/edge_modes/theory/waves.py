"""Step 30: bending waves of a plate of finite thickness with a clamped or supported edge.

With w, psi, k2, g1 and g2 of `mindlin`, b = 1, kap = (omega h/c_T)^2 of A0 at x = k eta and
w = 0 at the edge, c = J0(k)/I0(k2), rotation and moment there are

    psi = J0 S,                 S = g1 k J1/J0 + g2 k2 I1/I0,
    psi' = J0 (Gam - S),        Gam = g1 k^2 + g2 k2^2 = k^2 + k2^2,

and every edge condition is S = beta Gam. Without moment, psi' + nu psi = 0, beta = 1/(1 - nu). A
clamped edge has psi = chi eta psi', beta = chi eta/(1 + chi eta): chi = 0 suppresses the rotation
alone; CHI is the value for a clamp on the whole edge, which also prevents Poisson's bulging. The
paper's edge has J0 = 0, psi' + psi = 0 and beta = oo.

psi/M increases with the frequency of Mindlin's plate and M ~ Gam - (1 - nu) S, so that S/Gam, whose
poles are the zeros of J0 (Gam > 0), increases too: from -oo to oo between two of them, from 1/2 to
oo up to the first. The n-th clamped mode lies between j_n and j_(n+1), the n-th supported one
between j_(n-1) and j_n, j_0 = 0, for 1/2 < 1/(1 - nu) and chi eta < 1. With A0's kap instead of
Mindlin's this is tested, not proved. Above the cut-off, k2 = 0 or (1/k_s + n) kap = x^2, the other
wave propagates, and there are no modes of this kind.

A0 of step 27 gives the response of one wave to a load; its kinetic energy is that of w and psi for
c = 0. A mode has N = int_0^1 (w^2 + eta^2/3 psi^2) r dr, and

    W = (1 - c t)^2 (1 + (eta^2/3) g1^2 k^2)/(2 pi N),

so that W = 1/(pi J1^2) at J0 = 0: the axis moves by q'' + omega^2 q = r_0 W P/b^2, r_0 of A0.
Here 1 - c t is the deflection of the contact face on the axis. Without normal stress the strain
in z is n_nu z nabla^2 w, n_nu = nu/(1 - nu), so that the contact face deflects
1 + (n_nu/3) eta^2 nabla^2 times as much as the mean; nabla^2 is -k^2 for J0 and k2^2 for I0.
Likewise the mean under a flat punch, with sh y = sin(y)/y and shc y = sinh(y)/y, is

    s_n = [sh(k a) - c t shc(k2 a)]/(1 - c t).

In static loading such a plate differs from the paper's by w = A (1 - r^2), psi = 2 A r. At r = 0,
in units of P b^2/D, that is (1 - nu)/(1 + nu)/(16 pi) and -(1 + chi eta)/(1 - chi eta)/(16 pi) for
a force in the middle plane. For a force on the face the factor is 1 - 4 n_nu eta^2/3.

The limit eta -> 0 is step 29.
"""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import lower_bessel, prove
from derivation.plate.edge_modes.theory import modes as thin
from derivation.plate.edge_modes.theory.mindlin import (
    DEFLECTION,
    c,
    k_2,
    lagrange,
    left,
    rotation,
    shear,
    shear_coefficient,
    slack,
    u_1,
    u_2,
    waves,
    xi,
)
from derivation.plate.vocabulary import (
    C1,
    C3,
    Formula,
    alpha,
    eta,
    gam,
    h,
    k_n,
    kap,
    nu,
    phi,
    x_h,
    z,
)
from derivation.plate.waves.theory.dynamic_modes import in_p_and_q, p, q, wave

CHI = sp.Rational(9, 100)
"""Effective chi over n_nu^2 of Mindlin's modes, not derived but computed by static finite elements
of clamped plates. With 0.076 to 0.105 for nu = 0.2 to 0.45 and H/b = 0.06 to 0.5, these modes have
the static deflection of the law `edge.theory.clamped`. The chi of that law is the boundary layer's
own, 0.122 to 0.105 n_nu^2 for the same nu at any thickness. The law also has the level of the edge,
its shear and extension; the modes do not, and need a lower chi on thicker plates. On thin plates
both agree, because chi eta is small."""

g_1, g_2, t, beta = sp.symbols("g_1 g_2 t beta", real=True)
"""Rotations over slopes; face over mean of I0 divided by that of J0; S/Gam."""
_r, N = sp.symbols("r N", positive=True)
J0, J1 = sp.besselj(0, k_n), sp.besselj(1, k_n)
I0, I1 = sp.besseli(0, k_2), sp.besseli(1, k_2)
BULGE = nu / (1 - nu)
"""n_nu."""
CLAMP = CHI * BULGE**2
"""chi."""
PART = J0 / I0
"""c of a mode."""
TURN = g_1 * k_n * J1 / J0 + g_2 * k_2 * I1 / I0
"""S."""
BEND = g_1 * k_n**2 + g_2 * k_2**2
"""Gam."""
SUPPORTED, CLAMPED = 1 / (1 - nu), CLAMP * eta / (1 + CLAMP * eta)
"""beta."""
FACE = 1 + BULGE / 3 * eta**2 * (k_n**2 + k_2**2)
"""t."""
_SQUARES = (J0**2 + J1**2, I0**2 - I1**2)
_MIXED = (k_n * J1 * I0 + k_2 * J0 * I1) / (k_n**2 + k_2**2)
_TURNED = (
    J0**2 + J1**2 - 2 * J0 * J1 / k_n,
    I1**2 - I0**2 + 2 * I0 * I1 / k_2,
    (k_2 * J1 * I0 - k_n * J0 * I1) / (k_n**2 + k_2**2),
)
NORM = (
    _SQUARES[0] / 2 - 2 * c * _MIXED + c**2 * _SQUARES[1] / 2
    + eta**2 / 3 * (
        (g_1 * k_n) ** 2 * _TURNED[0] / 2
        + (c * g_2 * k_2) ** 2 * _TURNED[1] / 2
        + 2 * c * g_1 * k_n * g_2 * k_2 * _TURNED[2]
    )
)  # fmt: skip
"""N for any k, k2, g1, g2 and c."""
WEIGHT = (1 - c * t) ** 2 * (1 + eta**2 / 3 * (g_1 * k_n) ** 2) / (2 * sp.pi * N)
"""W."""
ON_FACE = sp.besselj(0, k_n * alpha) - c * t * sp.besseli(0, k_2 * alpha)
"""The contact face at r = alpha."""
UNDER_PUNCH = sp.sin(k_n * alpha) / (k_n * alpha) - c * t * sp.sinh(k_2 * alpha) / (k_2 * alpha)
"""Its mean under a flat punch of radius alpha."""
SUPPORTED_REST, CLAMPED_REST = (1 - nu) / (1 + nu) / (16 * sp.pi), -1 / (16 * sp.pi)


def in_k(expression: sp.Expr) -> sp.Expr:
    """Return an expression of a mode in k, kap, eta and nu alone."""
    known = {shear: slack(), xi: kap / (k_n * eta) ** 2}
    partner = k_n * sp.sqrt(left().subs(known))
    turned = {g_1: u_1().subs(known), g_2: (u_2() / left()).subs(known)}
    return expression.subs({t: FACE, c: PART}).subs(turned).subs(k_2, partner)


@cache
def edges() -> tuple[Formula, ...]:
    """Return c, and the functions that vanish at wave numbers of clamped and supported plates."""
    lagrange()
    thin.frequency_equations()
    psi = rotation(g_1, g_2).subs(c, PART)
    slope = lower_bessel(sp.diff(psi, _r)).subs(_r, 1)
    turn, bend = sp.symbols("S Gam", real=True)
    known = {g_1: u_1(), g_2: u_2() / left(), k_2: k_n * sp.sqrt(left())}
    moment, ratio = bend - (1 - nu) * turn, turn / (bend - (1 - nu) * turn)
    free = turn - CLAMP * eta * (bend - turn)
    total = k_n**2 + k_2**2
    values = tuple(map(in_k, (PART, TURN - SUPPORTED * BEND, TURN - CLAMPED * BEND)))
    stated = PART, TURN - SUPPORTED * total, TURN - CLAMPED * total
    turned, bent = J0 * TURN, J0 * (BEND - TURN)  # psi and psi' at the edge

    def in_terms(c_n: sp.Expr, F_s: sp.Expr, F_c: sp.Expr, *said: sp.Expr) -> dict[str, sp.Expr]:
        return {
            "amplitude": J0 - c_n * in_k(I0),
            "amplitude in k_2": J0 - said[0] * I0,
            "no moment": in_k(J0 * (1 - nu)) * F_s + in_k(bent + nu * turned),
            "clamp": in_k(J0 * (1 + CLAMP * eta)) * F_c - in_k(turned - CLAMP * eta * bent),
            "supported wave": in_k(said[1]) - F_s,
            "clamped wave": in_k(said[2]) - F_c,
        }

    proof = prove(
        "Edges of a shear-deformable plate",
        r"Rotation and its slope are taken at the edge. $S/\Gamma$ is expressed by "
        r"$\psi/M$, whose slope has the same sign. For a thin plate, where $k_2 = k$ and $g_1 "
        r"= g_2 = 1$, the equations become those of step 29.",
        lambda *claims: in_terms(*claims) | {
            "deflection": DEFLECTION.subs({_r: 1, c: PART}),
            "rotation": psi.subs(_r, 1) - J0 * TURN,
            "slope": slope - J0 * (BEND - TURN),
            "curvature": sp.expand((BEND - k_n**2 - k_2**2).subs(known)),
            "supported": moment / (1 - nu) + turn - SUPPORTED * bend,
            "clamped": free - (1 + CLAMP * eta) * (turn - CLAMPED * bend),
            "derivative": sp.diff(ratio / (1 + (1 - nu) * ratio) - turn / bend, turn),
            "thin support": _thin(TURN - SUPPORTED * BEND)
            - k_n * thin.frequency_equations()[2].expression,
            "thin clamp": _thin(TURN - CLAMPED * BEND)
            - k_n * thin.frequency_equations()[1].expression / (thin.J0 * thin.I0),
        },
        *values, *stated,
    )  # fmt: skip
    zero, of_c = "frequency function, zero at wave numbers of a", ("evanescent_amplitude",)
    shape = "amplitude of $I_0$ in the mode $J_0(k r/b) - c I_0(k_2 r/b)$ of a plate"
    rows = (
        (*of_c, "c", shape, ()),
        ("supported_wave", "F_s", f"{zero} supported plate", of_c),
        ("clamped_wave", "F_c", f"{zero} clamped plate", of_c),
    )
    return tuple(
        Formula(
            name, latex, meaning, value, "1", "", ("evanescent_wave_number", *sources), proof,
            stated=said,
        )
        for (name, latex, meaning, sources), value, said in zip(rows, values, stated, strict=True)
    )  # fmt: skip


def _thin(expression: sp.Expr) -> sp.Expr:
    """Return the limit eta -> 0, where kap/x^2 vanishes like x^2."""
    return expression.subs({g_1: 1, g_2: 1, t: 1, eta: 0, k_2: k_n})


@cache
def norm() -> Formula:
    """Return N in closed form."""
    at_r = {k_n: k_n * _r, k_2: k_2 * _r}
    one, other, mixed = (
        f.subs(at_r, simultaneous=True) for f in (*_SQUARES, (k_n**2 + k_2**2) * _MIXED)
    )
    first, second, both = (
        f.subs(at_r, simultaneous=True) for f in (*_TURNED[:2], (k_n**2 + k_2**2) * _TURNED[2])
    )
    total = k_n**2 + k_2**2
    # k r J1 I0 + ... over r and k^2 + k2^2: one power of r less.
    deflected = _r**2 / 2 * (one + c**2 * other) - 2 * c * _r * (mixed / _r) / total
    turned = _r**2 / 2 * ((g_1 * k_n) ** 2 * first + (c * g_2 * k_2) ** 2 * second)
    turned += 2 * c * g_1 * k_n * g_2 * k_2 * both / total
    psi = rotation(g_1, g_2)
    slopes = [lower_bessel(sp.diff(part, _r)) for part in (deflected, eta**2 / 3 * turned)]
    stated = sp.Integral((DEFLECTION**2 + eta**2 / 3 * sp.Symbol("psi") ** 2) * _r, (_r, 0, 1))
    proof = prove(
        "Norm of a plate wave",
        r"Primitives of $w^2 r$ and $\psi^2 r$ are differentiated for any $k$, $k_2$, $g_1$, $g_2$ "
        r"and $c$. For $\eta \to 0$ the norm is that of step 29.",
        lambda value, stated: {
            "in k": value - in_k(NORM),
            "stated": stated.function.subs(sp.Symbol("psi"), psi) - sum(slopes),
            "limits": stated.limits[0][1] ** 2 + (stated.limits[0][2] - 1) ** 2,
            "deflection": slopes[0] - _r * DEFLECTION**2,
            "rotation": slopes[1] - eta**2 / 3 * _r * psi**2,
            "axis": sp.expand(deflected + turned).subs(_r, 0),
            "closed form": (deflected + eta**2 / 3 * turned).subs(_r, 1) - NORM,
            "thin": _thin(NORM.subs(c, PART)) - thin.NORM,
        },
        *(in_k(NORM), stated),
    )
    return Formula(
        "wave_norm", "N", "kinetic energy of a plate mode, rotary inertia included",
        in_k(NORM), "1", "",
        ("evanescent_amplitude", "wave_rotation", "evanescent_rotation"), proof,
        stated=stated,
    )  # fmt: skip


@cache
def face_ratio() -> Formula:
    """Return the face's deflection over the mean through the thickness, for long waves."""
    general = wave(C1 * sp.cosh(p * z / h), C3 * sp.cosh(q * z / h) / phi)
    f, shear_stress = in_p_and_q(general.f), in_p_and_q(general.rz).subs(z, 1)
    part = sp.solve(shear_stress, C3)[0]
    mean = (C1 * sp.sinh(p) / p + (part / x_h) * sp.sinh(q) / q).subs(C1, 1)
    face = f.subs(z, 1).subs(C3, part).subs(C1, 1)
    s, slope = sp.symbols("s Y", positive=True)
    # kap = Y x^4, s = x^2: p^2 = s - gam Y s^2, q^2 = s - Y s^2.
    squares = {p: s - gam * slope * s**2, q: s - slope * s**2}
    order = 3

    def series_of(y: sp.Symbol, odd: int) -> sp.Expr:
        return sp.Add(*(squares[y] ** n / sp.factorial(2 * n + odd) for n in range(order + 1)))

    def long(value: sp.Expr) -> sp.Expr:
        plain = value.subs({sp.cosh(y): series_of(y, 0) for y in (p, q)})
        plain = plain.subs({sp.sinh(y): y * series_of(y, 1) for y in (p, q)})
        even = sp.cancel(sp.together(plain))
        return even.subs({p: sp.sqrt(squares[p]), q: sp.sqrt(squares[q]), x_h: sp.sqrt(s)})

    ratio = sp.cancel(long(face / mean))
    series = sp.series(ratio, s, 0, 2).removeO()
    one = BULGE.subs(nu, (1 - 2 * gam) / (2 * (1 - gam))) / 3
    proof = prove(
        "Contact-face over mean deflection",
        r"The deflection of a wave without shear on its faces is expanded to the first power of "
        r"$x^2$, with $\kappa$ proportional to $x^4$. The evanescent wave has $-k_2^2$ in place of "
        r"$k^2$. The same follows from $\sigma_{zz} = 0$: the deflection contains "
        r"$\nu/(1 - \nu) z^2/2 \nabla^2 w$, of which the face minus the mean is taken.",
        lambda value, stated: {
            "stated": in_k(stated) - value,
            "face ratio": stated.subs(nu, (1 - 2 * gam) / (2 * (1 - gam)))
            - 1 - one * eta**2 * (k_n**2 + k_2**2),
            "series": sp.cancel(series - 1 + one * s),
            "plane stress": sp.cancel(one - one * 3 * (sp.Rational(1, 2) - sp.Rational(1, 6))),
            "quotient": sp.series(
                (1 + one * s * k_2**2) / (1 - one * s * k_n**2), s, 0, 2
            ).removeO() - 1 - one * s * (k_n**2 + k_2**2),
        },
        *(in_k(FACE), FACE),
    )  # fmt: skip
    return Formula(
        "face_ratio", "t", (
            "contact-face over mean deflection of a mode's part $I_0$, divided by that of $J_0$"
        ),
        in_k(FACE), "1", "", ("wave_f", "evanescent_wave_number"), proof, stated=FACE,
    )  # fmt: skip


@cache
def weight() -> Formula:
    """Return W."""
    energy, _ = norm(), face_ratio()
    proof = prove(
        "Modal weight of a plate wave",
        "At $J_0 = 0$ the modal weight is that of the paper's edge, whose residue is that of A0. "
        r"For $\eta \to 0$ it is that of step 29. " + energy.proof.argument,
        lambda value, stated: {
            "in k": value - in_k(stated.subs(N, NORM)),
            "face in the centre": stated.subs(c, 0) * sp.limit(ON_FACE, alpha, 0) ** 2 - stated,
            "paper's edge": stated.subs(N, NORM).subs(c, 0).subs(J0, 0) - 1 / (sp.pi * J1**2),
            "thin": _thin(stated.subs(N, NORM).subs(c, PART)) - thin.WEIGHT,
        },
        *(in_k(WEIGHT.subs(N, NORM)), WEIGHT),
    )
    return Formula(
        "wave_weight", "W_n",
        "modal weight: acceleration on the axis by a unit force there, times $b^2/r_0$",
        in_k(WEIGHT.subs(N, NORM)), "1", "", ("wave_norm", "face_ratio", "bending_residue"), proof,
        stated=WEIGHT,
    )  # fmt: skip


@cache
def modal_weight() -> Formula:
    """Return s_n."""
    means = thin.modal_weight()
    value = UNDER_PUNCH / (1 - c * t)
    small = sp.limit(value, alpha, 0)
    of_face = sp.sin(k_n * alpha) / k_n - c * t * sp.sin(sp.I * k_2 * alpha) / (sp.I * k_2)
    proof = prove(
        "Mean of a plate wave under a flat punch",
        "The transforms are those of step 29, applied to $J_0(k r)$ and to $I_0(k_2 r)$ on the "
        "contact face. " + means.proof.argument,
        lambda value, stated: {
            "in k": in_k(stated) - value,
            "mean": stated * ON_FACE.subs(alpha, 0) - of_face / alpha,
            "thin": _thin(stated.subs(c, PART)) - means.expression,
            "small contact": small - 1,
        },
        *(in_k(value), value),
    )
    return Formula(
        "wave_mean", "s_n",
        "mean of the contact face under a flat punch over its deflection on the axis",
        in_k(value), "1", "", ("face_ratio", means.name), proof, stated=value,
    )  # fmt: skip


@cache
def static_changes() -> tuple[Formula, ...]:
    """Return the difference to the paper's edge under a static load, on the axis."""
    A = sp.Symbol("A", real=True)
    # In units of P b^2/D: (psi' + psi/r)' = -1/(2 pi r), and psi' + psi = 0 at the edge.
    paper = (_r / 4 - _r * sp.log(_r) / 2) / (2 * sp.pi)
    bent = sp.diff(paper, _r) + paper / _r
    psi = paper + 2 * A * _r
    at_edge, slope = psi.subs(_r, 1), sp.diff(psi, _r).subs(_r, 1)
    chi = sp.Symbol("chi", positive=True)
    supported = sp.solve(slope + nu * at_edge, A)[0]
    clamped = sp.solve(at_edge - chi * eta * slope, A)[0]
    first = sp.series(clamped, chi, 0, 2).removeO()
    nabla = thin.laplacian(1 - _r**2)
    lift = 1 + BULGE / 3 * eta**2 * nabla
    values = SUPPORTED_REST * lift**2, CLAMPED_REST * (lift**2 + 2 * CLAMP * eta)
    proof = prove(
        "Clamped and supported plates under a static load",
        r"The rotation $\psi$ is the sum of that under a force with the paper's edge and of "
        "$2 A r$, which is uniform bending without shear, with the deflection $A (1 - r^2)$. "
        r"The deflection of a face is the mean deflection, to which the operator $1 + \eta^2 "
        r"\nu/(3 (1 - \nu)) \nabla^2$ is applied. By reciprocity, the same applies to a force "
        "on the face.",
        lambda of_support, of_clamp: {
            "supported": of_support - supported * lift**2,
            "clamped": of_clamp - first.subs(chi, CLAMP) - first.subs(chi, 0) * (lift**2 - 1),
            "load": sp.expand(sp.diff(bent, _r) + 1 / (2 * sp.pi * _r)),
            "paper's edge": bent.subs(_r, 1),
            "any clamp": sp.cancel(clamped - CLAMPED_REST * (1 + chi * eta) / (1 - chi * eta)),
            "first order of chi": sp.expand(first - CLAMPED_REST * (1 + 2 * chi * eta)),
            "face minus mean": lift - 1 + 4 * BULGE * eta**2 / 3,
        },
        *values,
    )
    rows = ("supported", "a simply supported", values[0]), ("clamped", "a clamped", values[1])
    return tuple(
        Formula(
            f"{name}_static_change", r"\Delta", f"static deflection of {which} plate minus that "
            r"on the paper's edge, under a force on the axis, divided by $P b^2/D$; first order of "
            r"$\chi$", value, "1", "", ("wave_weight",), proof,
        )
        for name, which, value in rows
    )  # fmt: skip


@cache
def thick_plate_modes() -> tuple[Formula, ...]:
    """Return the formulas of the step."""
    return (
        shear_coefficient(), *waves(), *edges(), norm(), face_ratio(), weight(), modal_weight(),
        *static_changes(),
    )  # fmt: skip
