"""Step 29: bending modes of a plate whose edge is clamped or simply supported.

A thin plate, D nabla^4 w + rho H w'' = p, with b = 1. The solution that is regular on the axis,
has omega = k^2 sqrt(D/(rho H)) and vanishes at the edge is w = J0(k r) - c I0(k r) with
c = J0(k)/I0(k). Without slope at the edge, or without moment, w'' + nu w' = 0, the condition is

    clamped    J1/J0 + I1/I0 = 0,       simply supported    J1/J0 + I1/I0 = 2 k/(1 - nu)  at k;

the paper's edge has J0 = 0 and c = 0, which is nu = 1. For any k and any two functions

    r [v (nabla^2 w)' - v' nabla^2 w + w' nabla^2 v - w (nabla^2 v)']  has the slope
    r [v nabla^4 w - w nabla^4 v]

where the left bracket vanishes at the edge for two functions with the same edge conditions. Hence
modes are orthogonal. With v = dw/dk it gives for every k, N = int_0^1 w^2 r dr,

    d/dk [(J1/J0 + I1/I0)/k] = 2 N/(k J0^2) > 0,

so that it increases from -oo to oo between two zeros of J0, its poles, and from 1 to oo up to the
first. The n-th clamped mode lies between j_n and j_(n+1), the n-th supported one between j_(n-1)
and j_n (j_0 = 0), and there are no others.

A force P on the axis gives q'' + omega^2 q = W P/(rho H b^2) for the deflection q of the axis,
W = w(0)^2/(2 pi N), w(0) = 1 - c. For v the static deflection by the same force, the bracket
tends to w(0)/(2 pi) on the axis, so that v has the component w(0)/(2 pi k^4 N) on w. As Green's
function is continuous and positive, its expansion converges to it (Mercer), and

    sum W_n/k_n^4 = D/(P b^2) times the static deflection:  1/(16 pi) clamped,
    (3 + nu)/((1 + nu) 16 pi) simply supported, 1/(8 pi) on the paper's edge.

Under a flat punch of radius a the mean of w is sh(k a) - c shc(k a), sh y = sin(y)/y and
shc y = sinh(y)/y; divided by w(0) it is the mode's weight s_n in `coupling`.
"""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import lower_bessel, prove
from derivation.plate.contact.theory.spherical_profile import flat_punch
from derivation.plate.vocabulary import Formula, alpha, k_n, nu

_r = sp.Symbol("r", positive=True)
_c, _W, _A = sp.symbols("c W A", real=True)
_v, _w = (sp.Function(name)(_r) for name in ("v", "w"))
J0, J1 = sp.besselj(0, k_n), sp.besselj(1, k_n)
I0, I1 = sp.besseli(0, k_n), sp.besseli(1, k_n)

PART = J0 / I0
"""c, the amplitude of I0 in a mode."""
SHAPE = sp.besselj(0, k_n * _r) - _c * sp.besseli(0, k_n * _r)
"""w(r) for any c."""
NORM = (J0**2 + J1**2) / 2 - PART * (J0 * I1 + J1 * I0) / k_n + PART**2 * (I0**2 - I1**2) / 2
"""N = int_0^1 w^2 r dr for any k."""
WEIGHT = (1 - PART) ** 2 / (2 * sp.pi * NORM)
"""W."""
CLAMPED_COMPLIANCE, PAPER_COMPLIANCE = 1 / (16 * sp.pi), 1 / (8 * sp.pi)
SUPPORTED_COMPLIANCE = (3 + nu) / (16 * sp.pi * (1 + nu))


def laplacian(f: sp.Expr) -> sp.Expr:
    """Return f'' + f'/r."""
    return sp.diff(f, _r, 2) + sp.diff(f, _r) / _r


def _bracket(v: sp.Expr, w: sp.Expr) -> sp.Expr:
    bend_v, bend_w = laplacian(v), laplacian(w)
    return _r * (
        v * sp.diff(bend_w, _r)
        - sp.diff(v, _r) * bend_w
        + sp.diff(w, _r) * bend_v
        - w * sp.diff(bend_v, _r)
    )


def _orthogonality() -> dict[str, sp.Expr]:
    """Return residuals: slope of the bracket, and its value at an edge with equal conditions."""
    v_1, w_1, bend = sp.symbols("v' w' m", real=True)
    slope = sp.diff(_bracket(_v, _w), _r)
    # At the edge v = w = 0; nabla^2 is m times the slope, m = 1 - nu without moment.
    edge = -v_1 * (bend * w_1) + w_1 * (bend * v_1)
    w_2 = -nu * w_1
    return {
        "bracket": sp.expand(
            slope - _r * (_v * laplacian(laplacian(_w)) - _w * laplacian(laplacian(_v)))
        ),
        "bracket at the edge": sp.expand(edge),
        "supported edge": w_2 + w_1 - (1 - nu) * w_1,
    }


@cache
def frequency_equations() -> tuple[Formula, Formula, Formula]:
    """Return c, and the functions that vanish at wave numbers of clamped and supported plates."""
    clamped = J1 * I0 + J0 * I1
    supported = J1 / J0 + I1 / I0 - 2 * k_n / (1 - nu)
    held = SHAPE.subs(_c, PART)
    slope = lower_bessel(sp.diff(held, _r)).subs(_r, 1)
    moment = lower_bessel(sp.diff(held, _r, 2) + nu * sp.diff(held, _r)).subs(_r, 1)
    plate = lower_bessel(laplacian(laplacian(SHAPE)) - k_n**4 * SHAPE)
    proof = prove(
        "Modes of a clamped or supported plate",
        r"$w$ is inserted into $\nabla^4 w = k^4 w$; its deflection, slope and moment are taken "
        r"at the edge. Orthogonality: the bracket is differentiated for any two functions; "
        r"$w'' = -\nu w'$ gives $\nabla^2 w = (1 - \nu) w'$ at a supported edge, and a clamped one "
        "has zero slope.",
        lambda part, clamped, supported: (
            {
                "plate": plate,
                "deflection": SHAPE.subs({_r: 1, _c: part}),
                "slope": slope + k_n / I0 * clamped,
                "moment": moment - k_n * (1 - nu) * J0 * supported,
            }
            | _orthogonality()
        ),
        *(PART, clamped, supported),
    )
    return (
        Formula(
            "thin_mode_amplitude",
            "c",
            "amplitude of $I_0$ in the mode $J_0(k r/b) - c I_0(k r/b)$ of a plate",
            PART,
            "1",
            "",
            (),
            proof,
        ),
        Formula(
            "clamped_frequency",
            "F_c(k_n)",
            "frequency function, zero at the wave numbers of a clamped thin plate",
            clamped,
            "1",
            "",
            ("thin_mode_amplitude",),
            proof,
        ),
        Formula(
            "supported_frequency",
            "F_s(k_n)",
            "frequency function, zero at the wave numbers of a simply supported thin plate",
            supported,
            "1",
            "",
            ("thin_mode_amplitude",),
            proof,
        ),
    )


@cache
def norm() -> Formula:
    """Return N in closed form, and prove the monotonic function that orders the modes."""
    frequency_equations()
    j0, j1 = sp.besselj(0, k_n * _r), sp.besselj(1, k_n * _r)
    i0, i1 = sp.besseli(0, k_n * _r), sp.besseli(1, k_n * _r)
    primitive = _r**2 / 2 * (j0**2 + j1**2 + _c**2 * (i0**2 - i1**2))
    primitive -= _c * _r / k_n * (j0 * i1 + j1 * i0)
    growth = sp.diff((J1 / J0 + I1 / I0) / k_n, k_n) * k_n * J0**2 / 2
    start = (sp.diff(J1, k_n) + sp.diff(I1, k_n)).subs(k_n, 0)
    slope = 2 * k_n / (1 - nu) - I1 / I0
    proof = prove(
        "Norm of a plate mode",
        "A primitive of $w^2 r$ gives $N$. The derivative of $(J_1/J_0 + I_1/I_0)/k$ with respect "
        "to $k$ is $2 N/(k J_0^2)$, and its value is 1 at $k = 0$. The frequency equations "
        "eliminate $J_1$ from $N$.",
        lambda norm: {
            "primitive": lower_bessel(sp.diff(primitive, _r)) - _r * SHAPE**2,
            "closed form": primitive.subs({_r: 1, _c: PART}) - norm,
            "derivative": lower_bessel(growth) - norm,
            "value at k = 0": start - 1,
            "clamped": norm.subs(J1, -J0 * I1 / I0) - J0**2,
            "supported": norm.subs(J1, J0 * slope)
            - J0**2 / 2 * (slope**2 - (I1 / I0) ** 2 + 2 - 4 / (1 - nu)),
            "paper's edge": norm.subs(J0, 0) - J1**2 / 2,
        },
        NORM,
    )
    return Formula(
        "thin_mode_norm",
        "N",
        r"integral of the mode's square over the plate, divided by $2 \pi b^2$",
        NORM,
        "1",
        "",
        ("thin_mode_amplitude",),
        proof,
    )


def static_deflection(span: sp.Expr) -> sp.Expr:
    """Return D/(P b^2) times the deflection by a force on the axis; `span`/(8 pi) at r = 0."""
    return (_r**2 * sp.log(_r) + span * (1 - _r**2)) / (8 * sp.pi)


@cache
def weight() -> tuple[Formula, ...]:
    """Return W, and prove the sums of W/k^4."""
    N = norm()
    clamped, supported = sp.Rational(1, 2), (3 + nu) / (2 * (1 + nu))
    formulas = {
        name: static_deflection(span)
        for name, span in (("clamped", clamped), ("supported", supported), ("paper's edge", 1))
    }
    slopes = {name: sp.diff(w, _r).subs(_r, 1) for name, w in formulas.items()}
    bends = {name: sp.diff(w, _r, 2).subs(_r, 1) for name, w in formulas.items()}
    axis = {name: sp.limit(w, _r, 0) for name, w in formulas.items()}
    # Near the axis w is even in r.
    w_0, w_2, w_4 = sp.symbols("w_0 w_2 w_4", real=True)
    near = _bracket(w_0 + w_2 * _r**2 + w_4 * _r**4, static_deflection(_A))
    # The component of the static deflection on a mode is that of the bracket on the axis over
    # k^4 N; times w(0) it is the deflection of the axis, W/k^4.
    on_axis = SHAPE.subs({_r: 0, _c: PART})
    pull = sp.limit(sp.expand(near), _r, 0)
    axis_pull = pull.subs(w_0, on_axis) * on_axis
    proof = prove(
        "Modal weight of a plate mode",
        r"The static deflection has no load away from the axis, carries $P$ and satisfies the "
        r"edge conditions. The modal weight follows from its bracket with a mode on the axis. "
        r"The paper's edge has $\nu = 1$.",
        lambda weight, clamped, supported: {
            "weight": axis_pull / N.expression - weight,
            "load": laplacian(laplacian(static_deflection(_A))),
            "force": 2 * sp.pi * _r * sp.diff(laplacian(static_deflection(_A)), _r) - 1,
            "edge": static_deflection(_A).subs(_r, 1),
            "clamped edge": slopes["clamped"],
            "supported edge": bends["supported"] + nu * slopes["supported"],
            "paper's edge": bends["paper's edge"] + slopes["paper's edge"],
            "axis": pull - w_0 / (2 * sp.pi),
            "clamped sum": axis["clamped"] - clamped,
            "supported sum": axis["supported"] - supported,
            "paper's edge: sum": axis["paper's edge"] - PAPER_COMPLIANCE,
            "paper's edge as nu": supported.subs(nu, 1) - PAPER_COMPLIANCE,
            "paper's edge: weight": weight.subs(J0, 0) - 1 / (sp.pi * J1**2),
        },
        *(WEIGHT, CLAMPED_COMPLIANCE, SUPPORTED_COMPLIANCE),
    )
    return (
        N,
        Formula(
            "thin_mode_weight",
            "W_n",
            r"modal weight: acceleration on the axis by a unit force there, times $\rho H b^2$",
            WEIGHT,
            "1",
            "",
            ("thin_mode_norm",),
            proof,
        ),
        Formula(
            "clamped_compliance",
            r"\sum_n W_n/k_n^4",
            "static deflection of a clamped plate under a force on the axis, over $P b^2/D$",
            CLAMPED_COMPLIANCE,
            "1",
            "",
            ("thin_mode_weight",),
            proof,
        ),
        Formula(
            "supported_compliance",
            r"\sum_n W_n/k_n^4",
            "static deflection of a supported plate under a force on the axis, over $P b^2/D$",
            SUPPORTED_COMPLIANCE,
            "1",
            "",
            ("thin_mode_weight",),
            proof,
        ),
    )


@cache
def modal_weight() -> Formula:
    """Return s_n: the mean of a mode under a flat punch, divided by w(0)."""
    flat_punch()
    m = sp.Symbol("m", integer=True, nonnegative=True)
    bessel = 1 / (4**m * sp.factorial(m) ** 2)
    # int_0^1 t^(2m+1)/sqrt(1 - t^2) dt, t = r/a, of a punch of unit force.
    moment = sp.sqrt(sp.pi) / 2 * sp.gamma(m + 1) / sp.gamma(m + sp.Rational(3, 2))
    y = k_n * alpha
    value = (sp.sin(y) / y - PART * sp.sinh(y) / y) / (1 - PART)
    small = sp.limit(value.subs(alpha, _r / k_n), _r, 0)
    proof = prove(
        "Mean of a plate mode under a flat punch",
        r"The power series of $I_0$ is that of $J_0$ without signs; the same applies to the "
        r"transforms $\sinh(y)/y$ and $\sin(y)/y$, power by power.",
        lambda value: {
            "power": sp.combsimp(sp.gammasimp(bessel * moment * sp.factorial(2 * m + 1))) - 1,
            "transform": value * SHAPE.subs({_r: 0, _c: PART})
            - (sp.sin(y) / y - PART * sp.sin(sp.I * y) / (sp.I * y)),
            "small contact": small - 1,
        },
        value,
    )
    return Formula(
        "thin_mode_mean",
        "s_n",
        "mean of a plate mode under a flat punch divided by its deflection on the axis",
        value,
        "1",
        "",
        ("thin_mode_amplitude", "mode_mean"),
        proof,
    )


def thin_plate_modes() -> tuple[Formula, ...]:
    """Return the formulas of the step."""
    return (*frequency_equations(), *weight(), modal_weight())
