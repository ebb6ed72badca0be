"""Step 25: the stress on the back face on the axis, the largest tensile stress of a plate.

There S_zz = 0, and a mode's stress sigma_rr = sigma_tt = S_rr - mu g phi^2 = (1 + nu)/2 S_rr, with
S_rr = -A_j B(T), T = 2 phi h. Under Hertz pressure of resultant P, H = 2h and alpha = a/b,

    sigma = (1 + nu) P/(2 pi H^2) S,   S = sum 4 eta^2 g(alpha j) B(2 eta j)/J1^2,
    B = 2 T sinh T/(sinh^2 T - T^2),   g(y) = 3 (sin y - y cos y)/y^3.

In terms of T the sum is 2 eta sum F(2 eta j)/(j J1^2), F(T) = T g(A T/2) B(T), A = a/h. F is odd
and has the pole 6/T at 0. In the contour integral of the sum over the zeros of J0
(`contact.theory.split`) the imaginary axes cancel, and half circles around 0 give a logarithm:

    S = 1/2 FP int_0^oo F dT + 3 (gamma_E - log 4 eta) + residues at T_n, sinh T_n = +-T_n.

The integral depends on A = a/h alone; the residues decay like exp(-Im T_1 (2 - alpha)/(2 eta)),
Im T_1 = 4.212. A thin plate's S is therefore that of a thicker one with the same a/h plus 3 log of
the ratio of both h/b. If a is much larger than h, the power series of B gives Kirchhoff's plate,

    S = 3 (4/3 - log 2 - log alpha) + (1/2) sum_(k>=0) b_k m_k (2/A)^(2k+2),
    m_k = 3 (-1)^(k+1) (2k)!/(2k - 1),   B = 6/T^2 + sum b_k T^(2k),

an asymptotic series. The states of step 19, extension and bending, add their own sigma at z = -h.
Their part of S is X_f = sum g [12 (1 + 3 n - n Q)/(j^3 J1) + 8 n eta H/(j^2 J1)]; a simple support
adds (1 - nu)/(1 + nu) times X_f, and a clamped edge subtracts

    (3/2) [(1 + 2 chi eta) (1 - 2 alpha^2/5) - s] + 2 n eta^2

with the chi and s of the clamped edge.
"""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import Proof, prove
from derivation.plate.contact.theory.hertz import contact_radius, pressure_coefficient
from derivation.plate.contact.theory.split import imaginary_axis
from derivation.plate.contact.theory.thin_remainder import contour_with_poles
from derivation.plate.contact.theory.thin_roots import numbering
from derivation.plate.edge.theory import clamped as clamp
from derivation.plate.edge.theory.sums import indentation_kernel
from derivation.plate.edge.theory.supported import (
    RATIO,
    bending_function,
    edge_resultants,
    states,
    stretching_function,
)
from derivation.plate.modes.theory.equilibrium import hooke
from derivation.plate.modes.theory.face_conditions import loaded
from derivation.plate.modes.theory.influence import PLANE_STRAIN_MODULUS
from derivation.plate.modes.theory.mode_shapes import mode_shapes
from derivation.plate.modes.theory.stresses import modal_stresses
from derivation.plate.vocabulary import (
    J1,
    A_j,
    Formula,
    P,
    PlateRoot,
    T,
    a,
    a_ratio,
    alpha,
    b,
    eta,
    h,
    j_n,
    lam,
    mu,
    phi,
    z,
)

_n = sp.Symbol("n", integer=True, positive=True)
_s = sp.Symbol("s", positive=True)
ONE_AND_NU = (3 * lam + 2 * mu) / (2 * (lam + mu))
"""1 + nu."""
SCALE = ONE_AND_NU * P / (8 * sp.pi * h**2)
"""(1 + nu) P/(2 pi H^2); the stress is S times this factor."""
_REDUCED = {a: alpha * b, h: eta * b, phi: j_n / b}


def back_face_function() -> sp.Expr:
    """Return B(T) = 2 T sinh T/(sinh^2 T - T^2)."""
    return 2 * T * sp.sinh(T) / (sp.sinh(T) ** 2 - T**2)


@cache
def back_face_factor() -> Formula:
    """Return B(T), from the loaded mode's S_rr at z = -h."""
    raw = {formula.name: formula.expression for formula in (*mode_shapes(), *modal_stresses())}
    S_rr, S_zz, g_j = (raw[name] for name in ("S_rr", "S_zz", "g_j"))
    value = back_face_function()
    antisymmetric, symmetric = T / (sp.sinh(T) - T), T / (sp.sinh(T) + T)
    # On the axis J1(phi r)/r is phi/2.
    on_axis = (S_rr - mu * g_j * phi**2).subs(z, -h)
    radial = loaded(S_rr.subs(z, -h))
    conditions = {
        "free face": loaded(S_zz.subs(z, -h)),
        "on the axis": loaded(on_axis - ONE_AND_NU / 2 * S_rr.subs(z, -h)),
        "Hooke": g_j * phi**2 - (S_rr - RATIO * S_zz) / PLANE_STRAIN_MODULUS,
    }
    proof = prove(
        "Stress of the back face",
        "The stresses of the loaded mode are taken at $z = -h$; $S_{zz} = 0$ there, and Hooke's "
        "law gives $g$.",
        lambda value: {
            "radial stress": radial + A_j * value.subs(T, 2 * phi * h),
            "bending and extension": value - antisymmetric - symmetric,
            **conditions,
        },
        value,
    )
    return Formula(
        "back_face_factor",
        "B(T)",
        "radial stress of the back face per pressure coefficient, with reversed sign",
        value, "1", "", ("S_rr", "S_zz", "Omega_1"), proof,
    )  # fmt: skip


def _mode() -> sp.Expr:
    """Return one mode's term of S."""
    face = back_face_function().subs(T, 2 * eta * j_n)
    return 4 * eta**2 * indentation_kernel(alpha * j_n) * face / J1**2


@cache
def back_face_stress() -> tuple[Formula, ...]:
    """Return one mode's term of the stress at the back face's centre, and of S."""
    back_face_factor()
    stress = -ONE_AND_NU / 2 * A_j * back_face_function().subs(T, 2 * phi * h)
    stress = stress.subs(A_j, pressure_coefficient().expression)
    mode_term, force = _mode(), contact_radius().expression
    proof = prove(
        "Stress on the axis",
        "The coefficient $A_j$ of Hertz pressure is inserted, with $R$ expressed by the force $P$.",
        lambda value, reduced: {
            "stress": (stress - value.subs(P, force)).subs(_REDUCED),
            "sum": (stress / SCALE.subs(P, force) - reduced).subs(_REDUCED),
        },
        *(SCALE * mode_term, mode_term),
    )
    sources = ("back_face_factor", "A_j", "P")
    rows = (
        (
            "back_face_stress",
            r"\sigma_{rr}(0, -h)",
            "largest tensile stress on the back face",
            "Pa",
        ),
        ("back_face_sum", "S", r"largest tensile stress over $(1 + \nu) P/(8 \pi h^2)$", "1"),
    )
    return tuple(
        Formula(
            name, latex, meaning, factor * mode_term, unit, "", sources, proof, summed=True,
            where=("a < b",),
        )
        for (name, latex, meaning, unit), factor in zip(rows, (SCALE, 1), strict=True)
    )  # fmt: skip


# --- thin plates


@cache
def pole_at_zero() -> Proof:
    """Prove the contribution of a pole c/z of f at 0 to the sum: c (gamma_E + log(rho/2))/2.

    Both contours of `contour_with_poles` pass 0 by quarter circles of radius rho, where H/J0 is 1
    +- (2 i/pi) (log(z/2) + gamma_E); the real axis begins at rho.
    """
    contour_with_poles()
    imaginary_axis()
    c, level, angle = sp.symbols("c L theta", real=True)
    integral, principal, total, re, im = sp.symbols("F V S X_r X_i")

    def arc(sign: int) -> sp.Expr:
        """Return the integral from +-i rho to rho; L = log(rho/2) + gamma_E, dz/z = i dtheta."""
        hankel = 1 + sign * 2 * sp.I / sp.pi * (level + sp.I * angle)
        return sp.integrate(sp.expand(c * sp.I * hankel), (angle, sign * sp.pi / 2, 0))

    upper = integral + sp.I * principal - 2 * total + arc(1)
    lower = integral - sp.I * principal - 2 * total + arc(-1)
    poles = 2 * sp.pi * sp.I * (re + sp.I * im), -2 * sp.pi * sp.I * (re - sp.I * im)
    (solution,) = sp.solve(sp.expand(upper + lower - sum(poles)), total)
    return prove(
        "Sum over the zeros of J0, with a pole at 0",
        "The integrals along quarter circles around 0 are added. On the imaginary axes an odd $f$ "
        "cancels.",
        {"sum": sp.expand(solution - integral / 2 - c * level / 2 - sp.pi * im)},
    )


def odd_weight() -> sp.Expr:
    """Return F(T) = T g(A T/2) B(T), which tends to 6/T at 0."""
    return T * indentation_kernel(a_ratio * T / 2) * back_face_function()


def _pole_of(weight: sp.Expr) -> sp.Expr:
    """Return the residue at T = 0 of an odd weight."""
    return sp.limit(weight * T, T, 0)


@cache
def thin_plate_stress() -> tuple[Formula, Formula]:
    """Return S of a thin plate, a function of a/h and a logarithm, and its correction by roots."""
    pole_at_zero()
    numbering()
    weight, u, sign = odd_weight(), sp.Symbol("u", positive=True), sp.Symbol("s", real=True)
    turned = {sp.sinh(T): sign * sp.sinh(u), sp.cosh(T): sign * sp.cosh(u)}
    above, below = sp.fraction(back_face_function())
    at_root = (above / sp.diff(below, T)).subs(turned).subs(T, sp.sinh(u))
    # sum f(j)/(j J1^2) with f(z) = F(2 eta z), whose pole at 0 is c/z.
    f = weight.subs(T, 2 * eta * j_n).subs(a_ratio, alpha / eta)
    pole = sp.Integer(6)
    c, start = pole / (2 * eta), sp.Symbol("rho", positive=True)
    # int_rho F(2 eta x) dx = [FP int F dT - 6 log(2 eta rho)]/(2 eta).
    finite = sp.Symbol("Phi", real=True)
    total = (finite - pole * sp.log(2 * eta * start)) / (2 * eta) / 2
    total += c * (sp.EulerGamma + sp.log(start / 2)) / 2
    expected = finite / 2 + 3 * (sp.EulerGamma - sp.log(4 * eta))
    proof = prove(
        "Back face of a thin plate",
        "$F$ is odd and behaves like $6/T$ at 0. The real axis gives the finite part, quarter "
        "circles give the logarithm, and the poles inside give their residues.",
        {
            "term of a mode": _mode() - 2 * eta * f / (j_n * J1**2),
            "F is odd": weight.subs(T, -T) + weight,
            "residue at 0": _pole_of(weight) - pole,
            "logarithm": sp.expand(sp.expand_log(2 * eta * total - expected)),
            "at roots": at_root.subs(sign**2, 1) - sign * (sp.cosh(u) + 1) / sp.sinh(u),
        },
    )
    near, far = sp.Integral(weight - pole / T, (T, 0, 1)), sp.Integral(weight, (T, 1, sp.oo))
    value = (near + far) / 2 + 3 * (sp.EulerGamma - sp.log(4 * eta))
    at = PlateRoot(_n)
    hankel = sp.hankel1(0, at / (2 * eta)) / sp.besselj(0, at / (2 * eta))
    term = (-1) ** _n * indentation_kernel(a_ratio * at / 2) * (1 + sp.sqrt(1 + at**2)) * hankel
    roots = sp.pi * sp.im(sp.Sum(term, (_n, 1, sp.oo)))
    where = ("a_ratio * eta < 1",)
    return (
        Formula(
            "back_face_sum_thin", r"S^{\mathrm{thin}}", "$S$ of a thin plate", value, "1", "",
            ("back_face_sum",), proof, where=where,
        ),
        Formula(
            "back_face_sum_roots", r"S - S^{\mathrm{thin}}", "correction of $S$ of a thin plate",
            roots, "1", "", ("back_face_sum", "back_face_sum_thin"), proof, where=where,
        ),
    )  # fmt: skip


WIDE_TERMS = 10
"""Number of terms of the series for large a/h: at a/h = 20 the next is below 1e-16 of S."""


@cache
def wide_contact_powers(count: int = WIDE_TERMS) -> tuple[sp.Rational, ...]:
    """Return b_k of B = 6/T^2 + sum b_k T^(2k): 2 (sinh T)/T over (sinh^2 T - T^2)/T^4."""
    above = [sp.Rational(2, sp.factorial(2 * i + 1)) for i in range(count + 1)]
    below = [sp.Rational(2 ** (2 * i + 3), sp.factorial(2 * i + 4)) for i in range(count + 1)]
    powers: list[sp.Rational] = []
    for i in range(count + 1):
        powers.append((above[i] - sum(powers[k] * below[i - k] for k in range(i))) / below[0])
    series = sp.series(back_face_function(), T, 0, 4).removeO()
    prove(
        "Stress factor at T = 0",
        "The first powers are compared with those of SymPy's own series.",
        {
            f"T^{2 * k - 2}": series.coeff(T, 2 * k - 2) - powers[k]
            for k in range(min(3, count + 1))
        },
    )
    return tuple(powers[1:])


def moment_of_wave(order: int) -> sp.Rational:
    """Return m_k = int_0^oo y^(2k+1) g(y) dy, continued analytically from where it converges."""
    return 3 * (-1) ** (order + 1) * sp.factorial(2 * order) / (2 * order - 1)


@cache
def wide_contact_stress() -> Formula:
    """Return S for a wide contact: Kirchhoff's plate and further terms."""
    thin_plate_stress()
    # Mellin transform of g, from int y^(s-1) sin y dy = Gamma(s) sin(pi s/2), and similarly cos.
    mellin = 3 * (
        sp.gamma(_s - 3) * sp.sin(sp.pi * (_s - 3) / 2)
        - sp.gamma(_s - 2) * sp.cos(sp.pi * (_s - 2) / 2)
    )
    regular = 3 * sp.gamma(_s + 1) * sp.cos(sp.pi * _s / 2) / ((_s - 1) * (_s - 3))
    constant, powers = sp.Rational(4, 3) - sp.log(2), wide_contact_powers()
    # The mean of (r/a)^s over the load is (3/2) B(1 + s/2, 3/2).
    mean = sp.gamma(1 + _s / 2) / sp.gamma(sp.Rational(5, 2) + _s / 2)
    # f = 6 g(alpha z)/z is Kirchhoff's plate: pole 6, FP int g(alpha x)/x dx = C - log alpha.
    finite = sp.diff(regular, _s).subs(_s, 0) - sp.log(alpha)
    kirchhoff = 3 * finite + 3 * (sp.EulerGamma - sp.log(2))
    residuals = {
        "transform": sp.gammasimp(sp.expand_trig(mellin * _s / regular)) - 1,
        "residue at s = 0": regular.subs(_s, 0) - 1,
        "Kirchhoff": sp.expand(kirchhoff - 3 * (constant - sp.log(alpha))),
        "mean logarithm": sp.expand_func(sp.diff(sp.log(mean), _s).subs(_s, 0)) + constant,
    }
    for k in range(WIDE_TERMS):
        residuals[f"moment {k}"] = (regular / _s).subs(_s, 2 * k + 2) - moment_of_wave(k)
    series = sp.Add(
        *(
            powers[k] * moment_of_wave(k) / 2 * (2 / a_ratio) ** (2 * k + 2)
            for k in range(WIDE_TERMS)
        )
    )
    proof = prove(
        "Back face under a wide contact",
        "Each power of $B$ times $g$ is integrated by analytic continuation (Watson's lemma on "
        "the imaginary axis, where $g$ decays). The term $6/T^2$ alone is exactly Kirchhoff's "
        "plate.",
        residuals,
    )
    return Formula(
        "back_face_sum_wide", r"S^{\mathrm{wide}}",
        "$S$ of a thin plate for $a$ much larger than $h$",
        3 * (constant - sp.log(alpha)) + series, "1", "", ("back_face_sum_thin",), proof,
    )  # fmt: skip


# --- the edge


@cache
def back_face_edge() -> Formula:
    """Return X_f, by the edge's mean motion: one mode's stress of each state at z = -h."""
    stretching, bending = states()
    mean, turn = (formula.expression for formula in edge_resultants()[:2])
    uniform = [hooke(state.u, state.w).rr.subs(z, -h) for state in (stretching, bending)]
    stress = (mean * uniform[0] + turn * uniform[1]).subs(A_j, pressure_coefficient().expression)
    Q, H = (f.subs(T, 2 * eta * j_n) for f in (bending_function(), stretching_function()))
    bent = 12 * (1 + 3 * RATIO - RATIO * Q) / (j_n**3 * J1)
    value = indentation_kernel(alpha * j_n) * (bent + 8 * RATIO * eta * H / (j_n**2 * J1))
    scale = SCALE.subs(P, contact_radius().expression)
    hoop = [hooke(state.u, state.w).tt.subs(z, -h) for state in (stretching, bending)]
    proof = prove(
        "Edge term of the stress on the back face",
        "Hooke's law gives the stresses of both states at $z = -h$, which are multiplied by the "
        "mean motion of the edge in the modes.",
        lambda value: {
            "stress": (stress - scale * value).subs(_REDUCED),
            **{f"hoop {i}": hoop[i] - uniform[i] for i in range(2)},
        },
        value,
    )
    return Formula(
        "back_face_edge", r"S_e^{\mathrm{far}}",
        "reduction of $S$ without mean motion of the edge", value, "1", "",
        ("edge_extension", "edge_rotation", "back_face_sum"), proof, summed=True,
    )  # fmt: skip


@cache
def back_face_clamp() -> Formula:
    """Return the reduction of S by a clamped edge: the stress of the states of step 19."""
    clamp.amplitudes()
    stretching, bending = states()
    E, force = PLANE_STRAIN_MODULUS, contact_radius().expression
    wide, lost = 1 - clamp.HERTZ_MEAN * alpha**2, clamp.indentation_loss()
    # Rotation and extension from reciprocity, by the work of the load on the states.
    rotation = force * b**2 / 2 * ((1 + 2 * clamp.turn() * eta) * wide - lost)
    rotation /= 2 * sp.pi * b**2 * 2 * E * 2 * h**3 / 3
    strain = force * -stretching.w.subs(z, h) / (2 * sp.pi * b**2 * 2 * E * 2 * h)
    below = [hooke(state.u, state.w).rr.subs(z, -h) for state in (stretching, bending)]
    value = sp.Rational(3, 2) * ((1 + 2 * clamp.turn() * eta) * wide - lost) + 2 * RATIO * eta**2
    stress = strain * below[0] - rotation * below[1]
    proof = prove(
        "Reduction of the stress on the back face by a clamped edge",
        "Hooke's law gives the stresses of both states at $z = -h$, which are multiplied by the "
        "suppressed rotation and extension.",
        lambda value: {"stress": (stress - SCALE.subs(P, force) * value).subs(_REDUCED)},
        value,
    )
    return Formula(
        "back_face_clamp", r"S_c^{\mathrm{back}}", "reduction of $S$ by a clamped edge", value,
        "1", "", ("F_clamp", "back_face_sum"), proof,
    )  # fmt: skip


def back_face_formulas() -> tuple[Formula, ...]:
    """Return the formulas of the step."""
    return (
        back_face_factor(),
        *back_face_stress(),
        *thin_plate_stress(),
        wide_contact_stress(),
        back_face_edge(),
        back_face_clamp(),
    )
