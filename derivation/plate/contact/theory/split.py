"""Step 12: delta = a^2/R + finite radius + finite thickness, by integrals for sums over J0 zeros.

For f entire and growing slower than e^(2|Im z|)

    sum f(j_n)/(j_n J1(j_n)^2)
        = 1/2 int_0^oo f dx - 1/(2 pi) int_0^oo [f(iy) + f(-iy)] K0(y)/I0(y) dy.

Proof: f H/J0 with H = J0 + i Y0 is integrated around the first quadrant, passing above the zeros,
and f (J0 - i Y0)/J0 around the fourth, passing below them. Both integrands decay like e^(-2|Im z|),
so the integral along the real axis equals that along the imaginary axis. Half circles around the
zeros contribute half residues of f Y0/J0; the principal values of both contours cancel in the sum.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import flint
import sympy as sp

from derivation.engine.cache import in_file
from derivation.engine.formula.proof import BY_BALLS, Proof, ProofError, prove
from derivation.plate.contact.theory.hertz import SINE_MINUS, SOURCES
from derivation.plate.contact.theory.law import contact_law
from derivation.plate.modes.theory.plate_factor import plate_factors
from derivation.plate.vocabulary import J1, Formula, R, T, a, alpha, b, eta, h, j_n, phi

_y = sp.Symbol("y", positive=True)
LATERAL = sp.besselk(0, _y) / sp.besseli(0, _y)
"""K0(y)/I0(y), the weight function of the finite radius."""


@cache
def bending_residue() -> Proof:
    """Prove that Y0/J0 has the residue -2/(pi j_n J1(j_n)^2) at j_n.

    x (J1 Y0 - J0 Y1), the Wronskian times x, is constant because J0' = -J1 and J1' = J0 - J1/x, and
    likewise for Y. Its limit for x -> 0 is 2/pi, because Y1 = -2/(pi x) + ...
    """
    x, j0, j1, y0, y1 = sp.symbols("x j0 j1 y0 y1", positive=True)
    rates = {j0: -j1, j1: j0 - j1 / x, y0: -y1, y1: y0 - y1 / x}
    wronskian = x * (j1 * y0 - j0 * y1)
    slope = sp.diff(wronskian, x)
    slope += sp.Add(*(sp.diff(wronskian, s) * rate for s, rate in rates.items()))
    # Leading terms for x -> 0; the next terms are smaller by x^2 log x.
    small = {j0: 1, j1: x / 2, y0: 2 / sp.pi * sp.log(x), y1: -2 / (sp.pi * x)}
    constant = sp.limit(wronskian.subs(small), x, 0)
    (value,) = sp.solve(wronskian.subs(j0, 0) - constant, y0)
    return prove(
        "Residue of Y0/J0",
        "The Wronskian times x is differentiated and taken to x -> 0; at j_n it gives Y0, and "
        "the residue is Y0/J0' = -Y0/J1.",
        {"Wronskian": slope, "residue": -value / j1 + 2 / (sp.pi * x * j1**2)},
    )


@cache
def imaginary_axis() -> Proof:
    """Prove J0(iy) = I0(y) and (J0 + i Y0)(iy) = -(2 i/pi) K0(y), coefficient by coefficient.

    With L = log(y/2) + gamma and harmonic numbers H_m the series are
    pi/2 Y0(z) = (log(z/2) + gamma) J0(z) - sum (-1)^m H_m (z/2)^(2m)/m!^2 and
    K0(y) = -L I0(y) + sum H_m (y/2)^(2m)/m!^2; log(iy/2) = log(y/2) + i pi/2.
    """
    order = sp.Symbol("m", integer=True, nonnegative=True)
    L, harmonic, half = sp.symbols("L H_m q", positive=True)
    size = half ** (2 * order) / sp.factorial(order) ** 2
    turned = sp.expand_power_base((sp.I * half) ** (2 * order), force=True)
    j0 = (-1) ** order * turned / sp.factorial(order) ** 2
    y0 = 2 / sp.pi * ((L + sp.I * sp.pi / 2) * j0 - harmonic * j0)
    k0 = -L * size + harmonic * size
    above = sp.simplify((j0 + sp.I * y0 + 2 * sp.I / sp.pi * k0) / size)
    return prove(
        "Bessel functions on the imaginary axis",
        "The power series of J0 and Y0 at iy equal those of I0 and K0, coefficient by coefficient.",
        {"J0": sp.simplify(j0 / size) - 1, "J0 + i Y0": sp.expand(above)},
    )


@cache
def contour() -> Proof:
    """Prove the sum identity: both contours added, with half residues and both axes."""
    bending_residue()
    imaginary_axis()
    integral, principal, total, up, down = sp.symbols("F V S U D")
    # S is the sum of f(j_n)/(j_n J1^2); U and D are int f(+-iy) K0/I0 dy; dz = +-i dy.
    residues = -2 / sp.pi * total
    upper = integral + sp.I * principal - sp.pi * sp.I * sp.I * residues
    lower = integral - sp.I * principal + sp.pi * sp.I * (-sp.I) * residues
    on_axis = sp.I * (-2 * sp.I / sp.pi) * up, -sp.I * (2 * sp.I / sp.pi) * down
    balance = upper - on_axis[0] + lower - on_axis[1]
    (solution,) = sp.solve(balance, total)
    return prove(
        "Sum over the zeros of J0",
        "Both quadrants' contours, closed by decay at infinity, are added and solved for the sum.",
        {"sum": sp.expand(solution - integral / 2 + (up + down) / (2 * sp.pi))},
    )


@dataclass(frozen=True)
class _TestFunction:
    """A function f and what the sum identity requires of it.

    `primitive` is the integral of f(iy) + f(-iy) that vanishes at y = 0. Integration by parts with
    (K0/I0)' = -1/(y I0^2) gives an integrand without a logarithm.
    """

    name: str
    f: Callable[[flint.arb], flint.arb]
    integral: int
    primitive: Callable[[flint.acb], flint.acb]


_TEST_FUNCTIONS = (
    _TestFunction("exp(-x)", lambda x: (-x).exp(), 1, lambda y: 2 * y.sin()),
    _TestFunction("x exp(-x)", lambda x: x * (-x).exp(), 1, lambda y: 2 * (y.sin() - y * y.cos())),
)


@cache
def identity_in_balls() -> Proof:
    """Check the identity for two explicit functions, with both sides as balls at two precisions."""
    for example in _TEST_FUNCTIONS:
        for bits in (80, 120):
            with flint.ctx.workprec(bits):
                left, right = _modes(example, bits), _axes(example, bits)
            if not (left.overlaps(right) and left.rad() < 1e-18 and right.rad() < 1e-18):
                raise ProofError(f"Sum identity: {example.name} gives {left} and {right}")
    names = tuple(example.name for example in _TEST_FUNCTIONS)
    return Proof("Sum identity in numbers", "The balls of both sides overlap.", names, BY_BALLS)


def _modes(example: _TestFunction, bits: int) -> flint.arb:
    """Return a ball of the sum; 1/(j J1^2) < 2, and |f(x)| <= x e^-x for x > 1 bounds the tail."""
    count = bits // 4
    total = flint.arb(0)
    for n in range(1, count + 1):
        j = zero_of_j0(n, bits)
        total += example.f(j) / (j * j.bessel_j(1) ** 2)
    last = (count + flint.arb(3) / 4) * flint.arb.pi()
    return total + flint.arb(0, (4 * last * (-last).exp()).upper())


def _axes(example: _TestFunction, bits: int) -> flint.arb:
    end = flint.arb(bits)

    def integrand(y: flint.acb, _: bool) -> flint.acb:
        return example.primitive(y) / (y * y.bessel_i(0) ** 2)

    start = flint.arb(2) ** (-bits)
    body = flint.acb.integral(integrand, flint.acb(start), flint.acb(end)).real
    # |primitive| <= 2 y and I0 >= 1 below `start`, |primitive| <= 2 (1 + y) beyond `end`.
    rest = 2 * start + 2 * (1 + 1 / end) * lateral_tail(0, end)
    return flint.arb(example.integral) / 2 - (body + flint.arb(0, rest.upper())) / (
        2 * flint.arb.pi()
    )


def lateral_tail(n: int, end: flint.arb) -> flint.arb:
    """Return a bound of int_end^oo y^n/I0(y)^2 dy for end >= n + 1, end >= 1.

    I0(y) = (1/pi) int_0^pi e^(y cos t) dt and cos t >= 1 - t^2/2 give, by integrating over
    t <= 1/sqrt(y), I0(y) >= e^(y - 1/2)/(pi sqrt(y)). The integrand is below
    pi^2 e y^(n+1) e^(-2y), whose logarithm decreases by at least 1 per unit of y.
    """
    pi = flint.arb.pi()
    return pi**2 * flint.arb.const_e() * end ** (n + 1) * (-2 * end).exp()


@cache
def zero_of_j0(n: int, bits: int) -> flint.arb:
    """Return a ball around the n-th zero of J0: Newton from McMahon's first terms, a sign change.

    The zeros are more than 3 apart, and the n-th lies within 1/20 above
    (n - 1/4) pi, so a change of sign there is the n-th.
    """
    with flint.ctx.workprec(bits + 32):
        left = (n - flint.arb(1) / 4) * flint.arb.pi()
        x = (left + 1 / (8 * left)).mid()
        for _ in range(bits.bit_length() + 2):
            x = (x + x.bessel_j(0) / x.bessel_j(1)).mid()
        radius = flint.arb(2) ** (-bits)
        low, high = x - radius, x + radius
        inside = low > left and high < left + flint.arb(1) / 20
        if not (inside and low.bessel_j(0) * high.bessel_j(0) < 0):
            raise ProofError(f"zero {n} of J0 is not in {x}")
        return low.union(high)


@cache
def half_space_integral() -> Proof:
    """Prove int_0^oo (sin y - y cos y)/y^3 dy = pi/4: Dirichlet's integral, by parts."""
    boundary = (_y * sp.cos(_y) - sp.sin(_y)) / (2 * _y**2)
    integrand = (sp.sin(_y) - _y * sp.cos(_y)) / _y**3
    rest = sp.sin(_y) / (2 * _y)
    value = sp.integrate(rest, (_y, 0, sp.oo))
    return prove(
        "Half-space integral",
        "A term that vanishes at both ends is differentiated; sin y/(2 y) remains.",
        {
            "by parts": sp.expand(integrand - sp.diff(boundary, _y) - rest),
            "at 0": sp.limit(boundary, _y, 0),
            "value": value - sp.pi / 4,
        },
    )


def lateral_bracket(ratio: sp.Expr) -> sp.Expr:
    """Return (u cosh u - sinh u)/y^3, u = ratio y: the value of s(u)/y^3 on the imaginary axis."""
    return (ratio * _y * sp.cosh(ratio * _y) - sp.sinh(ratio * _y)) / _y**3


def _side_density() -> sp.Expr:
    """Return the weight of K0/I0 in the finite-radius part of the indentation."""
    return -8 * b**2 / (sp.pi**2 * R) * lateral_bracket(a / b)


@in_file(SOURCES, Formula, Proof)  # modules of kernels need it when they are imported
def contact_split() -> tuple[Formula, ...]:
    """Return the three parts of the indentation: half-space, finite radius, finite thickness."""
    contour()
    half_space_integral()
    identity_in_balls()
    excess = plate_factors()[2].expression.subs(T, 2 * phi * h)
    flat = 8 / (sp.pi * R * b**2 * phi**4 * J1**2)
    x = sp.Symbol("x", positive=True)
    # f(x) of the identity with G = 1: one mode's term is f(j_n)/(j_n J1^2), j_n = b phi.
    f = 8 * b**2 / (sp.pi * R) * (sp.sin(alpha * x) - alpha * x * sp.cos(alpha * x)) / x**3
    f = f.subs(alpha, a / b)
    both = sp.expand(f.subs(x, sp.I * _y)) + sp.expand(f.subs(x, -sp.I * _y))
    # int f dx/2 with x = b y/a, by the integral above.
    half = 8 * b**2 / (sp.pi * R) * (a / b) ** 2 * sp.pi / 4 / 2
    side = sp.Integral(_side_density() * LATERAL, (_y, 0, sp.oo))
    thickness = flat * SINE_MINUS * excess
    proof = prove(
        "Split of the indentation",
        r"$K_j = 8 G/(\pi R b^2 \phi^4 J_1^2)$, $G = 1 + (G - 1)$; the sum with $G = 1$ is given "
        "by the two integrals of the sum identity, the first of which is Hertz's $a^2/R$.",
        lambda hertz, side, thickness: {
            "K_j": contact_law()[2].expression - flat * SINE_MINUS - thickness,
            "mode term": flat * SINE_MINUS - f.subs(x, b * phi) / (b * phi * J1**2),
            "Hertz": half - hertz,
            "finite radius": -both / (2 * sp.pi) * LATERAL - side.function,
        },
        *(a**2 / R, side, thickness),
    )

    def part(name: str, symbol: str, what: str, value: sp.Expr, summed: bool = False) -> Formula:
        sources = ("K_j", "A_j")
        return Formula(
            name,
            symbol,
            what,
            value,
            "m",
            "6",
            sources,
            proof,
            summed=summed,
            where=("a < b",),
        )

    return (
        part("delta_half", r"\delta_\infty", "indentation of the half-space", a**2 / R),
        part("delta_lateral", r"\delta_b", "change of the indentation by the finite radius", side),
        part(
            "delta_thickness",
            r"\delta_h",
            "change of the indentation by the finite thickness",
            thickness,
            True,
        ),
    )


@cache
def reduced_split() -> tuple[Formula, Formula]:
    """Return W of the finite radius and one mode's term of F - W, where delta R/a^2 = 1 + F."""
    _, side, thickness = (formula.expression for formula in contact_split())
    y = alpha * j_n
    g = 3 * (sp.sin(y) - y * sp.cos(y)) / y**3
    excess = plate_factors()[2].expression.subs(T, 2 * eta * j_n)
    mode = 8 * alpha / (3 * sp.pi) * g * excess / (j_n * J1**2)
    lateral = -8 / (sp.pi**2 * alpha**2) * lateral_bracket(alpha) * LATERAL
    reduced = {a: alpha * b, h: eta * b, phi: j_n / b}
    scale = R / (alpha * b) ** 2
    proof = prove(
        "Reduced indentation",
        r"With $\alpha = a/b$, $\eta = h/b$, $\phi = j_n/b$ both parts over $a^2/R$ depend on "
        r"$\alpha$ and $\eta$.",
        lambda lateral, mode: {
            "finite radius": side.function.subs(reduced) * scale - lateral.function,
            "thickness": thickness.subs(reduced) * scale - mode,
        },
        *(sp.Integral(lateral, (_y, 0, sp.oo)), mode),
    )
    return (
        Formula(
            "F_lateral",
            r"W(\alpha)",
            r"contribution of the finite radius to $\delta R/a^2$",
            sp.Integral(lateral, (_y, 0, sp.oo)),
            "1",
            "6",
            ("delta_lateral",),
            proof,
        ),
        Formula(
            "F_modes",
            r"F(\alpha, \eta) - W(\alpha)",
            r"contribution of the thickness to $\delta R/a^2$",
            mode,
            "1",
            "6",
            ("delta_thickness",),
            proof,
            summed=True,
        ),
    )
