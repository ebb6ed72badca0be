"""J0 and J1 from Bessel's equation: Taylor recurrence, modulus and phase.

With y = u/sqrt(x) Bessel's equation x^2 y'' + x y' + (x^2 - nu^2) y = 0 becomes
u'' + I u = 0, I = 1 + (1/4 - nu^2)/x^2. Its solutions are u = sqrt(p) cos(theta),
theta' = 1/p, where p'' p/2 - p'^2/4 + I p^2 = 1; p is a series in 1/x^2, and so is x times the
phase's deviation from x. All results below follow from these two series:
J_nu(x) = sqrt(2 p/(pi x)) cos(theta). Its zeros, where theta is an odd multiple of pi/2, are found
in `zeros`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import flint
import sympy as sp

from derivation.engine.formula.ball import enclose
from derivation.engine.formula.proof import BY_BALLS, Proof, ProofError, prove

x, c = sp.symbols("x c", positive=True)
nu = sp.Symbol("nu", nonnegative=True)
P, SHIFT = sp.Symbol("p", positive=True), sp.Symbol("shift", real=True)
"""Squared modulus and phase shift at x, see `modulus_squared` and `phase_shift`."""
j = sp.Symbol("j", integer=True, nonnegative=True)
k = sp.Symbol("k", integer=True, nonnegative=True)
SHIFTED = sp.symbols("a_k-2 a_k-1 a_k a_k+1 a_k+2", real=True)
"""Taylor coefficients a_(k-2) ... a_(k+2) in the recurrence."""

Coefficients = tuple[sp.Rational, ...]


@dataclass(frozen=True)
class Recurrence:
    """Linear recurrence of the Taylor coefficients of J0 about a centre c.

    Parameters
    ----------
    following
        a_(k+2) in terms of the coefficients before it, for c > 0.
    at_origin
        a_k in terms of a_(k-2), for c = 0, where Bessel's equation is singular.
    proof
        Substitution into Bessel's equation.
    """

    following: sp.Expr
    at_origin: sp.Expr
    proof: Proof


@dataclass(frozen=True)
class Expansion:
    """Sum over j of coefficients[j] variable^(first - 2 j): asymptotic, with exact rationals.

    Parameters
    ----------
    name
        What is expanded, in a few words.
    first
        Power of the variable in the first term.
    coefficients
        Rational coefficients, the first term's first.
    proof
        Substitution into the equation it solves.
    """

    name: str
    first: int
    coefficients: Coefficients
    proof: Proof

    def term(self, index: int, variable: sp.Expr) -> sp.Expr:
        """Return one term of the sum."""
        return self.coefficients[index] * variable ** (self.first - 2 * index)

    def expression(self, variable: sp.Expr, terms: int) -> sp.Expr:
        """Return the sum of the first `terms` terms."""
        return sp.Add(*(self.term(index, variable) for index in range(terms)))


def equation(y: sp.Expr, order: sp.Expr) -> sp.Expr:
    """Return the left-hand side of Bessel's equation for y(x)."""
    return x**2 * sp.diff(y, x, 2) + x * sp.diff(y, x) + (x**2 - order**2) * y


@cache
def bessel_functions() -> Proof:
    """Prove that J0 and J1 solve Bessel's equation, and J1 = -J0'."""
    j0, j1 = sp.besselj(0, x), sp.besselj(1, x)
    return prove(
        "Bessel functions",
        "J0 and J1 are substituted into Bessel's equation; J0 is differentiated.",
        {
            "equation of J0": equation(j0, sp.Integer(0)),
            "equation of J1": equation(j1, sp.Integer(1)),
            "derivative": sp.diff(j0, x) + j1,
        },
    )


@cache
def taylor_recurrence() -> Recurrence:
    """Return the recurrence of J0's Taylor coefficients, from t^k in Bessel's equation.

    x^i D^n acts on a_m t^m, t = x - c, and (c + t)^i is expanded by the binomial
    theorem: its term in t^l contributes to t^k for m = k + n - l.
    """
    balance = sp.Integer(0)
    for power, derivative in ((2, 2), (1, 1), (2, 0)):
        for lift in range(power + 1):
            shift = derivative - lift
            falling = sp.expand(sp.ff(k + shift, derivative), func=True)
            binomial = sp.binomial(power, lift) * c ** (power - lift)
            balance += binomial * falling * SHIFTED[shift + 2]
    (following,) = sp.solve(balance, SHIFTED[4])
    (at_origin,) = sp.solve(balance.subs(c, 0), SHIFTED[2])
    following, at_origin = sp.factor(following), sp.factor(at_origin)
    return Recurrence(following, at_origin, _prove_recurrence(following, at_origin))


def _prove_recurrence(following: sp.Expr, at_origin: sp.Expr, degree: int = 8) -> Proof:
    """Prove that polynomials with these coefficients solve the equation up to a power of t."""
    series = [sp.Integer(0), sp.Integer(0), *sp.symbols("a_0 a_1", real=True)]
    origin = [sp.Integer(0), sp.Integer(1)]
    for index in range(degree - 1):
        values = dict(zip(SHIFTED[:4], series[index:], strict=False))
        series.append(sp.together(following.subs(values).subs(k, index)))
    for index in range(1, degree + 1):
        origin.append(at_origin.subs(SHIFTED[0], origin[index - 1]).subs(k, index))
    t = x - c
    about_c = sp.Add(*(a * t**power for power, a in enumerate(series[2:])))
    about_0 = sp.Add(*(a * x**power for power, a in enumerate(origin[1:])))
    residual = sp.Poly(equation(about_c, sp.Integer(0)).subs(x, c + sp.Symbol("t")), sp.Symbol("t"))
    residual_0 = sp.Poly(equation(about_0, sp.Integer(0)), x)
    return prove(
        "Taylor recurrence",
        f"Polynomials of degree {degree} with coefficients from the recurrence are substituted "
        "into Bessel's equation: every power that they determine vanishes.",
        {
            f"t^{power}": residual.coeff_monomial(sp.Symbol("t") ** power)
            for power in range(degree - 1)
        }
        | {f"x^{power}": residual_0.coeff_monomial(x**power) for power in range(degree + 1)},
    )


@cache
def wallis_reduction() -> Proof:
    """Prove (1/pi) int_0^pi sin^n = (n - 1)/n (1/pi) int_0^pi sin^(n-2), for derivatives.

    Bessel's integral J0(x) = (1/pi) int_0^pi cos(x sin t) dt, differentiated n times, gives
    |J0^(n)| <= (1/pi) int_0^pi sin^n.
    """
    t = sp.Symbol("t", positive=True)
    n = k + 2
    antiderivative = -sp.cos(t) * sp.sin(t) ** (n - 1) / n
    integrand = sp.sin(t) ** n - (n - 1) / n * sp.sin(t) ** (n - 2)
    residual = sp.expand((sp.diff(antiderivative, t) - integrand) / sp.sin(t) ** k)
    return prove(
        "Wallis's reduction",
        "-cos t sin^(n-1) t/n, which vanishes at 0 and pi, differentiates to the difference "
        "of the integrands.",
        {"integrand": sp.expand(sp.powsimp(residual).subs(sp.cos(t) ** 2, 1 - sp.sin(t) ** 2))},
    )


@cache
def derivative_bound(n: int) -> sp.Expr:
    """Return a bound of |J0^(n)(x)| for every real x: (1/pi) int_0^pi sin^n, by Wallis."""
    wallis_reduction()
    if n < 2:
        return sp.Integer(1) if n == 0 else 2 / sp.pi
    return sp.Rational(n - 1, n) * derivative_bound(n - 2)


def amplitude_equation(p: sp.Expr, order: sp.Expr) -> sp.Expr:
    """Return p''' + 4 I p' + 2 I' p, which vanishes for the squared amplitude p(x)."""
    stiffness = 1 + (sp.Rational(1, 4) - order**2) / x**2
    return sp.diff(p, x, 3) + 4 * stiffness * sp.diff(p, x) + 2 * sp.diff(stiffness, x) * p


@cache
def amplitude_and_phase() -> Proof:
    """Prove that sqrt(p/x) cos(theta) with theta' = 1/p solves Bessel's equation.

    This requires p'' p/2 - p'^2/4 + I p^2 = 1. The left side's derivative is p/2 times the linear
    equation of third order, so it is constant, and p -> 1 at infinity gives the value 1.
    """
    p0, p1, p2, p3, theta = sp.symbols("p0:4 theta", positive=True)
    chain = {p0: p1, p1: p2, p2: p3, theta: 1 / p0}

    def derive(expression: sp.Expr) -> sp.Expr:
        inner = (sp.diff(expression, symbol) * rate for symbol, rate in chain.items())
        return sp.diff(expression, x) + sp.Add(*inner)

    stiffness = 1 + (sp.Rational(1, 4) - nu**2) / x**2
    invariant = p2 * p0 / 2 - p1**2 / 4 + stiffness * p0**2
    (second,) = sp.solve(invariant - 1, p2)
    y = sp.sqrt(p0 / x) * sp.cos(theta)
    slope = derive(y)
    left = x**2 * derive(slope) + x * slope + (x**2 - nu**2) * y
    linear = p3 + 4 * stiffness * p1 + 2 * sp.diff(stiffness, x) * p0
    return prove(
        "Amplitude and phase",
        "sqrt(p/x) cos(theta) is substituted into Bessel's equation, and the invariant of p "
        "is differentiated.",
        {
            "Bessel's equation": left.subs(p2, second),
            "invariant": derive(invariant) - p0 / 2 * linear,
        },
    )


@cache
def modulus_squared(order: int, terms: int) -> Expansion:
    """Return p(x) = (pi x/2) (J_nu^2 + Y_nu^2) = 1 + ..., in powers of 1/x^2.

    A term x^(-2j) is inserted into the linear equation; the balance of each power gives the ratio
    of neighbouring coefficients.
    """
    amplitude_and_phase()
    image = sp.expand(sp.powsimp(sp.expand(amplitude_equation(x ** (-2 * j), nu)) * x ** (2 * j)))
    low, high = image.coeff(x, -1), image.coeff(x, -3)
    ratio = sp.factor(-high / low.subs(j, j + 1)).subs(nu, order)
    coefficients = [sp.Integer(1)]
    for index in range(terms - 1):
        coefficients.append(coefficients[-1] * ratio.subs(j, index))
    p = sp.Add(*(m * x ** (-2 * index) for index, m in enumerate(coefficients)))
    residual = sp.expand(amplitude_equation(p, sp.Integer(order)))
    proof = prove(
        f"Squared modulus of order {order}",
        "The truncated series is substituted into p''' + 4 I p' + 2 I' p = 0: every power that "
        "it determines vanishes.",
        {f"x^{-power}": residual.coeff(x, -power) for power in range(1, 2 * terms, 2)},
    )
    return Expansion("squared modulus times pi x/2", 0, tuple(coefficients), proof)


@cache
def phase_shift(order: int, terms: int) -> Expansion:
    """Return theta(x) - (x - nu pi/2 - pi/4), in odd powers of 1/x, from theta' = 1/p."""
    p = modulus_squared(order, terms + 1).coefficients
    rate = power(p, sp.Integer(-1), terms + 1)
    coefficients = tuple(rate[index] / (1 - 2 * index) for index in range(1, terms + 1))
    theta = x + sp.Add(*(d * x ** (-1 - 2 * index) for index, d in enumerate(coefficients)))
    squared = sp.Add(*(m * x ** (-2 * index) for index, m in enumerate(p)))
    residual = sp.expand(sp.diff(theta, x) * squared - 1)
    proof = prove(
        f"Phase shift of order {order}",
        "The truncated series is substituted into theta' p = 1.",
        {f"x^{-2 * index}": residual.coeff(x, -2 * index) for index in range(terms + 1)},
    )
    return Expansion("phase shift", -1, coefficients, proof)


def modulus_bound(order: int, terms: int, start: sp.Rational) -> sp.Rational:
    """Return a bound, for x >= start, of the error of p(x) truncated after `terms` terms.

    The remainder has the sign of the first omitted term and is smaller
    (Digital Library of Mathematical Functions, 10.18(iii), for terms > nu - 1/2).
    """
    return abs(modulus_squared(order, terms + 1).term(terms, start))


def phase_bound(order: int, terms: int, start: sp.Rational) -> sp.Expr:
    """Return a bound, for x >= start, of the error of the truncated phase shift.

    With q the derivative of the truncated phase and P the truncated p,
    |1/p - q| <= (|q P - 1| + |q| |p - P|)/p. Every power of 1/x in it is taken in absolute value
    and integrated from x to infinity; near the origin, where p has no positive lower bound in these
    terms, the bound is infinite.
    """
    m = modulus_squared(order, terms + 2).coefficients
    d = phase_shift(order, terms).coefficients
    rate = (sp.Integer(1), *((-1 - 2 * i) * value for i, value in enumerate(d)))
    product = multiply(rate, m[:-1], 2 * terms + 2)
    excess = {i: abs(value) for i, value in enumerate(product) if i > 0 and value != 0}
    for i, value in enumerate(rate):
        excess[terms + 1 + i] = excess.get(terms + 1 + i, 0) + abs(value * m[-1])
    lowest = 2 - sum(abs(value) * start ** (-2 * i) for i, value in enumerate(m))
    if lowest <= 0:
        return sp.oo
    return sum(e * start ** (1 - 2 * i) / (2 * i - 1) for i, e in excess.items()) / lowest


def multiply(a: Sequence[sp.Rational], b: Sequence[sp.Rational], terms: int) -> Coefficients:
    """Return the product of two power series, truncated."""
    return tuple(
        sp.Add(*(a[i] * b[n - i] for i in range(n + 1) if i < len(a) and n - i < len(b)))
        for n in range(terms)
    )


def power(a: Sequence[sp.Rational], exponent: sp.Rational, terms: int) -> Coefficients:
    """Return a power of a series with constant term 1, truncated: b' a = exponent a' b.

    Examples
    --------
    >>> power((sp.Integer(1), sp.Integer(-1)), sp.Integer(-1), 3)
    (1, 1, 1)
    """
    b = [sp.Integer(1)]
    for n in range(1, terms):
        total = sum(
            ((exponent + 1) * i - n) * a[i] * b[n - i] for i in range(1, min(n, len(a) - 1) + 1)
        )
        b.append(sp.Rational(total) / n)
    return tuple(b)


def hankel(order: sp.Expr) -> sp.Expr:
    """Return J_nu by its modulus and phase, with Hankel's constants."""
    return sp.sqrt(2 * P / (sp.pi * x)) * sp.cos(x - order * sp.pi / 2 - sp.pi / 4 + SHIFT)


@cache
def hankel_constants(terms: int = 12) -> Proof:
    """Prove J_nu(x) = sqrt(2 p/(pi x)) cos(x - nu pi/2 - pi/4 + shift): Hankel's constants.

    The equation does not determine a factor and a phase. At several points the ball of the formula,
    widened by the bounds of the remainders, must overlap the ball of J_nu; the balls are small
    enough to exclude any other simple constant.
    """
    bessel_functions()
    for order in (0, 1):
        for point in (20, 37, 1000):
            for bits in (256, 1024):
                with flint.ctx.workprec(bits):
                    _contains(order, sp.Integer(point), terms)
    return Proof(
        "Hankel's constants",
        "The modulus and phase series, widened by the bounds of their remainders, contain J0 and "
        "J1.",
        ("J0", "J1"),
        BY_BALLS,
    )


def _contains(order: int, point: sp.Integer, terms: int) -> None:
    """Raise ProofError unless the ball of the formula, with remainders, overlaps that of J_nu."""
    square = _widened(modulus_squared(order, terms), point, modulus_bound(order, terms, point))
    moved = _widened(phase_shift(order, terms), point, phase_bound(order, terms, point))
    argument = enclose(point, {})
    value = enclose(hankel(sp.Integer(order)), {x: argument, P: square, SHIFT: moved})
    if not value.overlaps(argument.bessel_j(flint.arb(order))):
        raise ProofError(f"Hankel's constants: J{order}({point}) is not {value}")


def _widened(series: Expansion, point: sp.Integer, bound: sp.Rational) -> flint.arb:
    """Return a ball of the whole series, widened by the bound of the remainder."""
    ball = enclose(series.expression(point, len(series.coefficients)), {})
    return ball + flint.arb(0, enclose(bound, {}).upper())
