"""Step 14, made exact: the remainder of the thin plate's law, by residues at T_n, sinh T = +-T.

In the contour integral behind the sum over the zeros of J0 (`split`) the modes' part
f(z) = q(z) (G(2 eta z) - 1), q even and entire, has poles at z_n = T_n/(2 eta). They contribute

    pi Im sum_n q(z_n) g_n/(2 eta) H(z_n)/J0(z_n),   g_n = (1 + sqrt(1 + T_n^2))^2/(2 T_n^2),

where g_n is G's residue at T_n and H = J0 + i Y0. The contribution of the axes is exactly the thin
plate's closed form: G is odd, so on the imaginary axis f(iy) + f(-iy) = -2 q(iy), the finite-radius
term with the opposite sign. The pole of G at 0 is treated by a factor z^w, w -> 0; the poles in 1/w
of both axes cancel (`axes`).

This is exact for every h/b, thick plates included, and for a < 2b, where |q| <= e^(alpha |Im z|)
(the law itself is defined for a < b). Closing the contour: on the lines Im T = pi n - pi/4, |sinh T
-+ T| > cosh(Re T)/4, and 2 G = (cosh T - 1)/(sinh T + T) + (cosh T + 1)/(sinh T - T), so |G| < 8.
Since |H/J0| <= 3 e^(-2 Im z), the contribution of these lines vanishes as n increases, and so does
that of a vertical line far to the right, where G - 1 decays like T^2 e^(-2T). A term of a
coefficient is of the order exp(-Im T_n/eta), one of the law exp(-Im T_n (2 - alpha)/(2 eta)).
"""

from collections.abc import Callable, Mapping
from functools import cache

import flint
import sympy as sp

from derivation.engine.formula.ball import Exact, refine, to_ball
from derivation.engine.formula.proof import Proof, prove
from derivation.plate.contact.theory.plate_series import FIRST, LAST, coefficient, sine_coefficient
from derivation.plate.contact.theory.split import LATERAL, contour, imaginary_axis, reduced_split
from derivation.plate.contact.theory.thin_law import sine_kernel, universal_part
from derivation.plate.contact.theory.thin_plate import (
    lateral_at_zero,
    plate_factor_at_zero,
    thin_modal_sum,
)
from derivation.plate.contact.theory.thin_roots import SIZE_OVER_INDEX, numbering, root
from derivation.plate.modes.theory.plate_factor import plate_factors
from derivation.plate.vocabulary import (
    J1,
    Formula,
    M,
    PlateRoot,
    T,
    a_ratio,
    alpha,
    eta,
    j_n,
    kappa,
)

_n = sp.Symbol("n", integer=True, positive=True)
_w = sp.Symbol("w", positive=True)
_LOG = sp.Symbol("L", real=True)


@cache
def residue_at_roots() -> Proof:
    """Prove G's residue (1 + sqrt(1 + T^2))^2/(2 T^2) at a simple pole T_n.

    With u = asinh T, sinh T = s sinh u and cosh T = s cosh u, s = (-1)^n.
    """
    numbering()
    u, sign = sp.symbols("u s", positive=True)
    above, below = sp.sinh(T) * sp.cosh(T) + T, sp.sinh(T) ** 2 - T**2
    split = (sp.cosh(T) - 1) / (sp.sinh(T) + T) + (sp.cosh(T) + 1) / (sp.sinh(T) - T)

    def at_root(expression: sp.Expr) -> sp.Expr:
        turned = {sp.sinh(T): sign * sp.sinh(u), sp.cosh(T): sign * sp.cosh(u)}
        return sp.expand(expression.subs(turned)).subs(sign**2, 1).subs(T, sp.sinh(u))

    slope = at_root(sp.diff(below, T))
    return prove(
        "Residue of G at a root",
        "The residue is the numerator of G over the derivative of its denominator, at T = sinh u. "
        "This derivative vanishes for cosh u = 1 only, so that the pole is simple.",
        {
            "quotient": plate_factors()[0].expression * below - above,
            "two families": split - 2 * plate_factors()[0].expression,
            "slope": slope - 2 * sp.sinh(u) * (sp.cosh(u) - 1),
            "residue": at_root(above) / slope - residue(sp.sinh(u), sp.cosh(u)),
        },
    )


def residue(at: sp.Expr, root_of_square: sp.Expr) -> sp.Expr:
    """Return G's residue at T, given sqrt(1 + T^2)."""
    return (1 + root_of_square) ** 2 / (2 * at**2)


@cache
def contour_with_poles() -> Proof:
    """Prove the sum identity with poles of f inside the contours: pi Im X is added to the sum.

    X sums f's residues times H/J0 in the first quadrant, Y is its conjugate in the fourth, where
    the contour runs clockwise.
    """
    contour()
    integral, principal, total, up, down, re, im = sp.symbols("F V S U D X_r X_i")
    halves = -2 * total  # half residues of each quadrant, see `contour`
    on_axes = 2 / sp.pi * (up + down)
    poles = 2 * sp.pi * sp.I * (re + sp.I * im), -2 * sp.pi * sp.I * (re - sp.I * im)
    upper = integral + sp.I * principal + halves
    lower = integral - sp.I * principal + halves
    (solution,) = sp.solve(sp.expand(upper + lower - on_axes - sum(poles)), total)
    expected = integral / 2 - (up + down) / (2 * sp.pi) + sp.pi * im
    return prove(
        "Sum over the zeros of J0, with poles",
        "Each quadrant's contour equals 2 pi i times the residues inside; both are added and "
        "solved.",
        {"sum": sp.expand(solution - expected)},
    )


@cache
def imaginary_part() -> Proof:
    """Prove f(iy) + f(-iy) = [-2 cos(pi w/2) - 2 sin(pi w/2) G(iy)/i] y^w q, f = z^w q (G - 1)."""
    turn, g = sp.symbols("E g", positive=True)
    G = plate_factors()[0].expression
    # turn = e^(i pi w/2), G(iy) = i g.
    both = turn * (sp.I * g - 1) + (-sp.I * g - 1) / turn
    cosine, sine = (turn + 1 / turn) / 2, (turn - 1 / turn) / (2 * sp.I)
    return prove(
        "Plate factor on the imaginary axis",
        "G is odd, so its two values cancel for w = 0.",
        {"G is odd": G.subs(T, -T) + G, "sum": sp.expand(both + 2 * cosine + 2 * g * sine)},
    )


@cache
def axes(k: int) -> Mapping[int, sp.Expr]:
    """Return the contribution of both axes for z^(w + 2k - 4) (G - 1), w -> 0: powers 1/w and w^0.

    Near 0 a power y^(w+m) has the integral 1/(w + m + 1) from 0 to 1, and with the factor -log y
    its square. All else is regular and vanishes with sin(pi w/2) on the imaginary axis.
    """
    contour_with_poles()
    imaginary_part()
    imaginary_axis()
    g, lateral = plate_factor_at_zero().coefficients, lateral_at_zero()
    own = 2 * k - 3
    scale = (2 * eta) ** -own * (1 - _w * _LOG)
    real = scale / 2 * (g.get(-own, sp.Integer(0)) / _w + M[k])
    near = {-1: 1 / _w**2 + lateral.at(0) / _w, -3: lateral.at(2) / _w}
    turned = sp.Add(
        *(
            (-1) ** ((p - 1) // 2) * value * (2 * eta) ** p * near.get(2 * k - 4 + p, sp.Integer(0))
            for p, value in g.items()
        )
    )
    side = (-1) ** k * (sp.pi / 2 * _w * turned + kappa[2 * k - 4]) / sp.pi
    total = sp.expand(real + side)
    return {power: total.coeff(_w, power) for power in (-1, 0)}


def _sum_of_roots(weight: Callable[[sp.Expr], sp.Expr]) -> sp.Expr:
    """Return Im sum weight(T_n) (1 + sqrt(1 + T_n^2))^2 H/J0 at T_n/(2 eta)."""
    at = PlateRoot(_n)
    wave = sp.hankel1(0, at / (2 * eta)) / sp.besselj(0, at / (2 * eta))
    return sp.im(sp.Sum(weight(at) * (1 + sp.sqrt(1 + at**2)) ** 2 * wave, (_n, 1, sp.oo)))


def _residue_factor(weight: sp.Expr) -> sp.Expr:
    """Return pi times a root's residue f/(2 eta) without H/J0, q = weight(z), z = T/(2 eta)."""
    return sp.pi * weight * residue(T, sp.sqrt(1 + T**2)) / (2 * eta)


@cache
def coefficient_remainder(k: int) -> Formula:
    """Return c_(2k-3) minus its closed form: a sum over the roots, exact for every h/b."""
    residue_at_roots()
    order, size, remainder = 2 * k - 3, sine_coefficient(k), axes(k)
    factor = size * sp.Integer(2) ** (5 - 2 * k)
    mode = eta**order * size * 8 / sp.pi
    one = mode * _residue_factor((T / (2 * eta)) ** (2 * k - 4))
    modes = coefficient(k).mode - mode * _mode_factor(2 * k - 4)
    proof = prove(
        f"Contribution of the roots to c_{order}",
        r"The contour integral is taken over $z^{2k-4} (G - 1)$: the axes give the closed form, "
        r"the poles inside give $\pi$ times the imaginary part of their residues.",
        {
            "term of a mode": modes,
            "1/w cancels": remainder[-1],
            "closed form on the axes": sp.expand(remainder[0] - thin_modal_sum(k)),
            "residue at a root": one - factor * T ** (2 * k - 6) * (1 + sp.sqrt(1 + T**2)) ** 2,
        },
    )
    return Formula(
        f"c_{order}_roots",
        rf"c_{{{order}}} - c_{{{order}}}^{{\mathrm{{thin}}}}",
        f"correction of the thin-plate form of $c_{order}$, for every $h/b$",
        factor * _sum_of_roots(lambda at: at ** (2 * k - 6)),
        "1",
        "10",
        (f"c_{order}_modes", f"c_{order}_lateral", f"c_{order}_thin"),
        proof,
    )


def _mode_factor(power: int) -> sp.Expr:
    """Return f(j_n)/(j_n J1^2) of the sum identity for f = z^power (G(2 eta z) - 1)."""
    return j_n ** (power - 1) * plate_factors()[2].expression.subs(T, 2 * eta * j_n) / J1**2


def _law_weight(at: sp.Expr) -> sp.Expr:
    """Return s(A T/2)/T^5."""
    y = a_ratio * at / 2
    return (sp.sin(y) - y * sp.cos(y)) / at**5


@cache
def law_remainder() -> Formula:
    """Return F(A, eta) - c_1 A - c_3 A^3 - Phi(A): a sum over the roots, exact for a < b."""
    residue_at_roots()
    universal_part()
    for k in range(FIRST, LAST + 1):
        axes(k)
    lateral, modes = (formula.expression for formula in reduced_split())
    (height,) = lateral.variables
    mode = 8 * alpha / sp.pi  # factor of q(z) = s(alpha z)/(alpha z)^3
    on_axis = mode / sp.pi * sine_kernel(sp.I * alpha * height)
    x = T / (2 * eta)
    real = mode / 2 * sine_kernel(alpha * x) / (2 * eta)
    y = a_ratio * T / 2
    proof = prove(
        "Contribution of the roots to the law",
        r"The contour integral is taken over $q(z) (G - 1)$ with $q(z) = s(\alpha z)/(\alpha "
        r"z)^3$. Of $q$, only the terms 1 and $z^2$ times $G$ have a pole at 0; they give $c_1$ "
        r"and $c_3$. The real axis gives $\Phi$, the imaginary one cancels the finite radius, "
        r"and the poles inside give the sum.",
        {
            "term of a mode": modes - mode * sine_kernel(alpha * j_n) * _mode_factor(0),
            "imaginary axis cancels the finite radius": sp.expand(
                (on_axis + lateral.function / LATERAL).rewrite(sp.exp)
            ),
            "real axis gives Phi": real.subs(alpha, eta * a_ratio)
            - 2 * a_ratio / sp.pi * sine_kernel(y),
            "residue at a root": mode.subs(alpha, eta * a_ratio) * _residue_factor(sine_kernel(y))
            - 16 / a_ratio**2 * _law_weight(T) * (1 + sp.sqrt(1 + T**2)) ** 2,
        },
    )
    return Formula(
        "F_roots",
        r"\frac{\delta R}{a^2} - 1 - c_1^{\mathrm{thin}} A - c_3^{\mathrm{thin}} A^3 - \Phi(A)",
        "correction of the thin-plate law, for every $h/b$",
        16 / a_ratio**2 * _sum_of_roots(_law_weight),
        "1",
        "10",
        ("F_lateral", "F_modes", "Phi", "c_1_thin", "c_3_thin"),
        proof,
        where=("a_ratio * eta < 1",),
    )


def thin_remainder() -> tuple[Formula, ...]:
    """Return Phi and the recorded exact remainders of coefficients and law."""
    coefficients = (coefficient_remainder(k) for k in range(FIRST, LAST + 1))
    return (universal_part(), *coefficients, law_remainder())


def root_term(at: flint.acb, ratio: flint.arb) -> flint.acb:
    """Return (1 + sqrt(1 + T^2))^2 H(z)/J0(z) at z = T/(2 eta), H/J0 = (2/(pi i)) K0/I0 at -iz."""
    z = at / (2 * ratio)
    turned = flint.acb(z.imag, -z.real)
    wave = turned.bessel_k(0) / turned.bessel_i(0) * flint.acb(0, -2) / flint.arb.pi()
    return (1 + (1 + at * at).sqrt()) ** 2 * wave


def _sum_over_roots(
    weight: Callable[[flint.acb], flint.acb],
    first: Callable[[int], flint.arb],
    quotient: Callable[[int], flint.arb],
    ratio: flint.arb,
) -> flint.arb:
    """Return sum Im[weight(T_n) root_term(T_n)] with a ball for the terms after the last one.

    `first(n)` bounds term n, and `quotient(n)` bounds the ratio of successive terms from there on.
    Used are |1 + sqrt(1 + T^2)|^2/|T|^2 = |coth(u/2)|^2 <= (pi + 1)/(pi - 1) < 2, since
    cosh Re u >= |sinh u| = |T| > pi, and |H/J0| <= 3 e^(-2 Im z) for |z| >= 4, Im z >= 1: there
    |H| <= sqrt(2/(pi |z|)) e^(-Im z), and the other Hankel function is at least 0.89
    sqrt(2/(pi |z|)) e^(Im z) (DLMF 10.17.14 with l = 1, variation pi/2).
    """
    bits, total, n = flint.ctx.prec, flint.arb(0), 0
    largest = flint.arb(0)
    while True:
        n += 1
        at = root(n, bits)
        term = weight(at) * root_term(at, ratio)
        total += term.imag
        largest = largest.max(abs(term))
        if not (n + 1) * flint.arb.pi() > 8 * ratio or not quotient(n + 1) < 1:
            continue
        rest = first(n + 1) / (1 - quotient(n + 1))
        if not rest > largest * flint.arb(2) ** -bits:
            return total + flint.arb(0, rest.upper())


def coefficient_remainder_ball(k: int, ratio: Exact, digits: int = 30) -> flint.arb:
    """Return a ball around c_(2k-3) minus its closed form at h/b = ratio > 0.

    Its relative radius is below 10^-digits. Terms are below 6 (8 n)^(2k-4) e^(-pi n/eta).
    """
    size = sine_coefficient(k) * sp.Integer(2) ** (5 - 2 * k)

    def compute() -> flint.arb:
        eta_ball = to_ball(ratio)
        decay = (-flint.arb.pi() / eta_ball).exp()
        power = 2 * k - 4
        total = _sum_over_roots(
            lambda at: at ** (power - 2),
            lambda n: 6 * flint.arb(SIZE_OVER_INDEX * n) ** power * decay**n,
            lambda n: (1 + flint.arb(1) / n) ** power * decay,
            eta_ball,
        )
        return total * flint.arb(flint.fmpq(int(size.p), int(size.q)))

    return refine(compute, digits, f"the roots' contribution to c_{2 * k - 3} at {ratio}")
