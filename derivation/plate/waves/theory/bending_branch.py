"""Step 27: the lowest branch of free waves, A0, which carries most of a static load.

For kap < x^2 B_a of step 26 is finite, positive at kap = 0, negative at kap = x^2 (q = 0), and
decreases: A0 is its only zero kap_0 there. The quotient of the two positive terms of B_a is

    quotient = 8 x^2 q^2 (1 - gam) F p/(kap sinh p cosh q) = 1,
    steep = -w kap d log(quotient)/dkap = 1 - w [kap F'/F + gam (p coth(p) - 1) xi/(2 P^2)
                                                + kap tanh(q)/(2 q)],

xi = kap/x^2, w = 1 - xi, P = p/x, Q = q/x. B_a = 2 kap tanh(p)/p (quotient - 1), so that
rho h r = -1/B_a' = p w/(2 tanh(p) steep): r is the residue of A0, whose part q of w(+h) obeys
q'' + omega_0^2 q = r A_j. In static loading this part is rho h r/kap_0 of mu C/h,

    s_0 = F_0 cosh p cosh q/(F cosh^2 x steep (1 + B_a/B_s)),    F_0 and B_a/B_s at kap = 0.

At the zero, where (1 + w)^2 tanh(p)/P = 4 Q tanh q, p is eliminated except for terms like e^(-2q),

    steep = 1/2 + w [1 - 2/(1 + w)^2] + fading/xi,    rho h r = (1 + w)^2 q/(8 tanh(q) steep),
    F/(cosh p cosh q) = E/(2 p q (p + q)),    E = (sinh S - S shc d)/(cosh S + cosh d) -> 1.

Thin plates: kap_0 = x^4 (y_0 + y_1 x^2 + ...), polynomials in gam, to any order from
tanh(y)/y = sum t_k y^(2k); y_0 = 4 (1 - gam)/3 is Kirchhoff's plate, and rho h r -> 1/2 its mass.
Short waves: xi -> Rayleigh's, xi^3 - 8 xi^2 + 8 (3 - 2 gam) xi - 16 (1 - gam) = 0.
"""

from functools import cache

import sympy as sp
from sympy.polys.rings import PolyElement, ring

from derivation.engine.formula.proof import Proof, prove
from derivation.plate.modes.theory.influence import PLANE_STRAIN_MODULUS
from derivation.plate.modes.theory.plate_factor import plate_factors
from derivation.plate.vocabulary import Formula, T, gam, h, kap, lam, mu, phi, rho, x_h, xi_R
from derivation.plate.waves.theory.dynamic_modes import (
    in_p_and_q,
    in_sines,
    kinetic_slope,
    p,
    q,
    shc,
    slow_stiffness,
    static_limit,
    stiffness,
    with_roots,
)

ORDER = 3
"""Number of terms of the series for thin plates that are written out."""


# --- the zero of B_a, and the slope there


def differences() -> sp.Expr:
    """Return F."""
    return (shc(p + q) - shc(p - q)) / (4 * p * q)


def quotient() -> sp.Expr:
    """Return the quotient of the two terms of B_a, in x, kap, gam, p and q."""
    above = 8 * x_h**2 * q**2 * (1 - gam) * differences() * p
    return above / (kap * sp.sinh(p) * sp.cosh(q))


def steepness(tanh_p: sp.Expr, tanh_q: sp.Expr) -> sp.Expr:
    """Return the slope of the quotient at a zero of B_a, times w, in x, kap, gam, p and q."""
    xi, w, P = kap / x_h**2, q**2 / x_h**2, p / x_h
    faded_p, faded_q = (y * (1 - t**2) / t for y, t in ((p, tanh_p), (q, tanh_q)))
    plus, less = (1 + w) ** 2, 1 - tanh_q**2 / tanh_p**2
    fading = plus / 2 * (faded_q - faded_p * gam * w / P**2) - 8 * w**2 * less / (plus * xi)
    return sp.Rational(1, 2) + w * (1 - 2 / plus) + fading / xi


def bending_residue(tanh_p: sp.Expr, tanh_q: sp.Expr) -> sp.Expr:
    """Return rho h r of a zero of B_a, in x, kap, gam, p and q."""
    plus = (1 + q**2 / x_h**2) ** 2
    return plus * q / (8 * tanh_q * steepness(tanh_p, tanh_q))


@cache
def rise_anywhere() -> Proof:
    """Prove the logarithmic slope of the quotient, for F as a function of S^2 and d^2."""

    def change(value: sp.Expr) -> sp.Expr:
        return in_p_and_q(kap * sp.diff(with_roots(value), kap))

    total, apart, w = p + q, p - q, q**2 / x_h**2
    over_q, over_p = sp.tanh(q) / q, p * sp.coth(p) - 1
    other = change(differences()) / differences() + kap / 2 * (gam * over_p / p**2 + over_q)
    steep = in_p_and_q(1 - w * other)
    return prove(
        "Slope of the quotient",
        "The quotient, and the squares of S and d, are differentiated with respect to log kap.",
        {
            "S^2": in_sines(change(total**2) + in_p_and_q(kap * total * (gam / p + 1 / q))),
            "d^2": in_sines(change(apart**2) - in_p_and_q(kap * apart * (1 / q - gam / p))),
            "slope": in_sines(steep + w * change(quotient()) / in_p_and_q(quotient())),
        },
    )


@cache
def bending_zero() -> tuple[Formula, ...]:
    """Return the quotient that is 1 on A0, its slope and the residue there."""
    kinetic_slope()
    rise_anywhere()
    B_a = stiffness(sp.tanh(p), sp.tanh(q))
    slope = in_p_and_q(sp.diff(with_roots(B_a), kap))
    tanh_p, tanh_q = sp.symbols("t_p t_q", positive=True)
    at_zero = 4 * x_h**2 * p * q * tanh_q / (x_h**2 + q**2) ** 2
    bare = slope.subs({sp.tanh(p): tanh_p, sp.tanh(q): tanh_q}).subs(tanh_p, at_zero)
    residue = in_p_and_q(bending_residue(tanh_p, tanh_q)).subs(tanh_p, at_zero)
    anywhere = p * q**2 / (2 * x_h**2 * at_zero * in_p_and_q(steepness(at_zero, tanh_q)))
    x_i, w, s = sp.symbols("xi w s", positive=True)
    plus, tanh = (1 + w) ** 2, (sp.tanh(p), sp.tanh(q))
    faded_p, faded_q = (2 * y / sp.sinh(2 * y) for y in (p, q))
    fading = plus / 2 * (faded_q - faded_p * gam * w * x_h**2 / p**2)
    fading -= 8 * w**2 / (plus * x_i) * (1 - tanh[1] ** 2 / tanh[0] ** 2)
    steep = sp.Rational(1, 2) + w * (1 - 2 / plus) + fading / x_i
    reduced = {w: q**2 / x_h**2, x_i: kap / x_h**2}
    exact = quotient(), steepness(*tanh), bending_residue(*tanh)
    stated = quotient(), steep, plus * q / (8 * tanh[1] * s)
    residuals = {
        "quotient": in_sines(in_p_and_q(B_a - 2 * kap * sp.tanh(p) / p * (quotient() - 1))),
        "zero": sp.cancel(in_p_and_q(stiffness(at_zero, tanh_q))),
        "residue": sp.cancel(1 / bare + residue),
        "residue from the quotient": sp.cancel(1 / bare + anywhere),
        "steepness": in_sines(in_p_and_q(steep.subs(reduced) - steepness(*tanh))),
    }
    rows = (
        (
            "bending_quotient", r"q_0(\kappa)", ("quotient of the two terms of $B_a$, equal to 1 "
            "on the branch A0"), "B_a_slow",
        ),
        (
            "steepness", "s", (
                r"derivative with respect to $\log \kappa$ of the quotient of both terms of $B_a$ "
                r"on the branch A0, with reversed sign, times $w$"
            ), "bending_quotient",
        ),
        ("bending_residue", r"\rho h\,r_0", "residue of A0", "steepness"),
    )  # fmt: skip

    def of_claims(*claims: sp.Expr) -> dict[str, sp.Expr]:
        said = [text.subs(s, exact[1]).subs(reduced) for text in claims[3:]]
        in_x = {f"{rows[i][0]} in x": claims[i] - with_roots(exact[i]) for i in range(3)}
        return in_x | {f"{rows[i][0]} as stated": said[i] - exact[i] for i in range(3)}

    proof = prove(
        "The lowest bending branch",
        r"$B_a$ is written in terms of the quotient and differentiated. At its zero, $\tanh p$ is "
        r"expressed by $\tanh q$.",
        lambda *claims: residuals | of_claims(*claims),
        *map(with_roots, exact),
        *stated,
    )
    each = zip(rows, map(with_roots, exact), stated, strict=True)
    return tuple(
        Formula(name, latex, meaning, value, "1", "", (source,), proof, stated=text)
        for (name, latex, meaning, source), value, text in each
    )


@cache
def bending_fraction() -> Formula:
    """Return the fraction of A0 in the deflection under a static load."""
    static_limit()
    residue = bending_zero()[2]
    T_x, steep = 2 * x_h, sp.Symbol("steep", positive=True)
    static = (shc(T_x) - 1) / T_x**2
    bent = 16 * x_h**4 * (1 - gam) * static / sp.cosh(x_h) ** 2
    unlike = sp.tanh(x_h) ** 2 * (sp.sinh(T_x) - T_x) / (sp.sinh(T_x) + T_x)
    both = [
        form.subs(kap, 0).subs(shc(p - q), 1).subs({p: x_h, q: x_h}) for form in slow_stiffness()
    ]
    load = 8 * x_h**2 * q**2 * (1 - gam) * differences() * p / (sp.sinh(p) * sp.cosh(q))
    answer = p * q**2 / (2 * x_h**2 * sp.tanh(p) * steep)
    plain = static * sp.cosh(p) * sp.cosh(q) / (differences() * sp.cosh(x_h) ** 2 * steep)
    E = (sp.sinh(p + q) - (p + q) * shc(p - q)) / (sp.cosh(p + q) + sp.cosh(p - q))
    B = (sp.sinh(T_x) - T_x) / (sp.cosh(T_x) + 1)
    value = p * q * (p + q) * B / (2 * x_h**3 * E * steep)
    steep_value = steepness(sp.tanh(p), sp.tanh(q))
    beta, stated_steep = sp.Symbol("beta", positive=True), sp.Symbol("s", positive=True)
    whole = with_roots(value.subs(steep, steep_value) / (1 + unlike))
    stated = (value / (1 + beta)).subs(steep, stated_steep)
    residuals = {
        "static B_a": in_sines(both[0] - bent),
        "B_a over B_s": in_sines(both[0] / both[1] - unlike),
        "static fraction": in_sines(answer / load * bent - plain),
        "without cancellation": in_sines(plain - value),
    }  # fmt: skip
    proof = prove(
        "Static fraction of the lowest branch",
        r"The residue is divided by $\kappa$, with $\kappa$ from the quotient, and multiplied by "
        r"the static $B_a$.",
        lambda whole, stated: (
            residuals
            | {
                "as stated": stated * (1 + beta) - plain.subs(steep, stated_steep),
                "in x": whole - with_roots(stated.subs({stated_steep: steep_value, beta: unlike})),
            }
        ),
        *(whole, stated),
    )
    return Formula(
        "bending_fraction", "s_0", (
            r"fraction of the static deflection that belongs to the branch A0; $\beta$ is the "
            r"static $B_a/B_s$"
        ),
        whole, "1", "", (residue.name, "C_top"), proof, stated=stated,
    )  # fmt: skip


# --- short waves


@cache
def rayleigh() -> tuple[Formula, Formula]:
    """Return the limit x -> oo: tanh p = tanh q = 1."""
    proof_of_residue = bending_zero()[2].proof
    w, P = 1 - xi_R, sp.sqrt(1 - gam * xi_R)
    cubic = xi_R**3 - 8 * xi_R**2 + 8 * (3 - 2 * gam) * xi_R - 16 * (1 - gam)
    ratio = bending_residue(sp.Integer(1), sp.Integer(1)) / x_h
    ratio = ratio.subs({q: x_h * sp.sqrt(w), p: x_h * P, kap: x_h**2 * xi_R})
    plus = (2 - xi_R) ** 2
    limit = plus * sp.sqrt(w) / (8 * (sp.Rational(1, 2) + w * (1 - 2 / plus)))
    proof = prove(
        "Rayleigh's wave",
        r"$(2 - \xi)^2 = 4 P Q$ with $P = p/x$ and $Q = q/x$ is squared and divided by $\xi$, "
        "because 0 is a root. The residue is that of A0 without the decaying terms. "
        + proof_of_residue.argument,
        lambda cubic, limit: {
            "cubic": sp.expand((2 - xi_R) ** 4 - 16 * w * P**2 - xi_R * cubic),
            "residue": sp.cancel(ratio - limit),
        },
        *(cubic, limit),
    )
    return (
        Formula(
            "rayleigh_cubic", "0", (
                r"polynomial in the squared speed $\xi = (c_R/c_T)^2$ of short waves, zero at "
                r"that of Rayleigh's wave"
            ), cubic, "1", "",
            ("B_a",), proof,
        ),
        Formula(
            "rayleigh_residue", r"\lim_{x\to\infty}\rho h\,r_0/x", "residue of the branch A0 "
            "for short waves",
            limit, "1", "", ("bending_residue",), proof,
        ),
    )  # fmt: skip


# --- thin plates

_RING, _s, _e, _g = ring("s e g", sp.QQ)
"""x^2, a step of kap/x^4, and gam."""


def _cut(value: PolyElement, order: int) -> PolyElement:
    """Drop s^order and higher powers, and e^2 and higher powers."""
    terms = {k: c for k, c in value.items() if k[0] < order and k[1] < 2}
    return _RING.from_dict(terms)


def _tanh_powers(count: int) -> list[sp.Rational]:
    """Return t_0, t_1, ...: sinh(y)/y = cosh(y) tanh(y)/y."""
    powers: list[sp.Rational] = []
    for n in range(count):
        rest = sum(powers[k] / sp.factorial(2 * (n - k)) for k in range(n))
        powers.append(sp.Rational(1, sp.factorial(2 * n + 1)) - rest)
    return powers


def _stiffness_of(slope: PolyElement, order: int) -> PolyElement:
    """Return B_a/(2 x^4) at kap = slope x^4, to order s^order.

    4 (1 - s slope) (1 - gam) sum (-t_k) h_(k-1)(p^2, q^2) - slope tanh(p)/p, h_n the sum of all
    products of n factors, from F/(cosh p cosh q), the divided difference of tanh(y)/y.
    """
    powers = _tanh_powers(order + 2)
    u, v = (_cut(_s - part * _s**2 * slope, order) for part in (_g, _RING(1)))
    shared, power, over_p, apart = _RING(1), _RING(1), _RING(0), _RING(0)
    for k, t in enumerate(powers):
        over_p += power * sp.QQ(t.p, t.q)
        if k + 1 < len(powers):
            t_next = powers[k + 1]
            apart -= shared * sp.QQ(t_next.p, t_next.q)
        power = _cut(power * u, order)
        shared = _cut(shared * v + power, order)
    return _cut(4 * (1 - _s * slope) * (1 - _g) * apart - slope * over_p, order)


@cache
def thin_powers(order: int) -> tuple[tuple[sp.Expr, ...], tuple[sp.Expr, ...]]:
    """Return kap_0/x^4 and rho h r of A0 in powers of x^2, with polynomials in gam."""
    slope = _RING(0)
    for n in range(1, order + 1):
        # B_a/(2 x^4) has the slope -1 by `slope`, to lowest order.
        slope = _cut(slope + _stiffness_of(slope, n), n)
    step = _stiffness_of(slope + _e, order)
    fall = -_RING.from_dict({(k[0], 0, k[2]): c for k, c in step.items() if k[1] == 1})
    inverse = _RING(1)
    for _ in range(order):
        inverse = _cut(inverse * (2 - fall * inverse), order)
    return _coefficients(slope, order), _coefficients(inverse / 2, order)


def _coefficients(value: PolyElement, order: int) -> tuple[sp.Expr, ...]:
    """Return the coefficients of s^0, s^1, ... as polynomials in gam."""
    rows = [sp.Integer(0)] * order
    for (n, _, k), c in value.items():
        rows[n] += sp.Rational(int(c.numerator), int(c.denominator)) * gam**k
    return tuple(sp.factor(row) for row in rows)


@cache
def thin_plates() -> tuple[Formula, ...]:
    """Return kap_0, rho h r and the static fraction of A0, for x -> 0."""
    bending_zero()
    s, slope = sp.symbols("s Y", positive=True)
    rows = thin_powers(ORDER)
    slope_series, residue = (sp.Add(*(c * s**n for n, c in enumerate(row))) for row in rows)
    # B_a with the power series of tanh: the residual is of higher order.
    t = _tanh_powers(ORDER + 3)
    u, v = s - gam * s**2 * slope, s - s**2 * slope
    bracket = (2 * s - s**2 * slope) ** 2 * sp.Add(*(c * u**k for k, c in enumerate(t)))
    bracket -= 4 * s * v * sp.Add(*(c * v**k for k, c in enumerate(t)))
    stiff = sp.expand(-2 * sp.cancel(bracket / (s**4 * slope)))
    change = sp.diff(stiff, slope)
    omega_square = phi**4 * PLANE_STRAIN_MODULUS * (2 * h) ** 2 / (12 * rho)
    kirchhoff = (rho * h**2 / mu * omega_square).subs(lam, mu * (1 / gam - 2)).subs(phi, x_h / h)
    fraction = _static_fraction(rows[1], rows[0])
    proof = prove(
        "Bending of thin plates",
        "The power series are inserted into $B_a$ and its slope. Their first terms are those of "
        "Kirchhoff's plate.",
        {
            "frequency": _below(stiff.subs(slope, slope_series), s),
            "residue": _below(1 + residue * change.subs(slope, slope_series), s),
            "Kirchhoff": sp.cancel(kirchhoff - x_h**4 * rows[0][0]),
            "mass": residue.subs(s, 0) - sp.Rational(1, 2),
            "total deflection": fraction[0] - 1,
        },
    )
    lines = (
        ("bending_kap_thin", r"\kappa_0", r"$(\omega h/c_T)^2$ of A0, thin plates", 4, rows[0]),
        ("residue_thin", r"\rho h\,r_0", "residue of the branch A0, thin plates", 0, rows[1]),
        (
            "bending_fraction_thin",
            "s_0",
            "fraction of the static deflection that belongs to the branch A0, thin plates",
            0,
            fraction,
        ),
    )
    return tuple(
        Formula(
            name, latex, meaning, sp.Add(*(c * x_h ** (power + 2 * n) for n, c in enumerate(row))),
            "1", "", ("B_a", "C_top"), proof,
        )
        for name, latex, meaning, power, row in lines
    )  # fmt: skip


def _below(value: sp.Expr, s: sp.Symbol) -> sp.Expr:
    """Return the terms of a series below s^ORDER."""
    terms = sp.Poly(sp.expand(value), s).terms()
    return sp.expand(sp.Add(*(c * s**n for (n,), c in terms if n < ORDER)))


def _static_fraction(residue: tuple[sp.Expr, ...], slope: tuple[sp.Expr, ...]) -> list[sp.Expr]:
    """Return (rho h r/kap)/(mu C/h) in powers of x^2; C = 2 G/(E* phi) for a static load.

    With T = 2 x and G = above/below, x^3 G = (above/T)/(below/T^4)/8.
    """
    s = sp.Symbol("s", positive=True)
    above, below = sp.fraction(plate_factors()[0].expression)
    T_square = 4 * s
    top, bottom = (
        (part.series(T, 0, power + 2 * ORDER).removeO() / T**power).expand()
        for part, power in ((above, 1), (below, 4))
    )
    compliance, rest = (part.subs(T, sp.sqrt(T_square)) for part in (top, bottom))
    first = sp.Add(*(c * s**n for n, c in enumerate(residue))) * rest * 16
    second = sp.Add(*(sp.cancel(c / (1 - gam)) * s**n for n, c in enumerate(slope))) * compliance
    rows = [[sp.expand(part).coeff(s, n) for n in range(ORDER)] for part in (first, second)]
    coefficients: list[sp.Expr] = []
    for n in range(ORDER):
        known = sum(coefficients[k] * rows[1][n - k] for k in range(n))
        coefficients.append(sp.factor((rows[0][n] - known) / rows[1][0]))
    return coefficients


def bending_branch() -> tuple[Formula, ...]:
    """Return the formulas of the step."""
    return (*bending_zero(), bending_fraction(), *thin_plates(), *rayleigh())
