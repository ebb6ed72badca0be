"""kappa_n and M_k for large index: rational expansions with bounds of the truncation error.

Both numbers grow like a factorial; divided by their leading terms they tend to 1:

    kappa_n = int_0^oo y^n K0(y)/I0(y) dy             r_n   = kappa_n 2^(n+1)/(pi n!)
    M_k     = FP int_0^oo T^(2k-4) (G - 1) dT         rho_k = M_k 2^(2k-3)/(2k-2)!

K0/I0 = pi e^(-2y) D(y), and the quotient of Hankel's expansions gives D = sum q_j y^-j, hence
r_n = sum q_j 2^j/(n (n-1) ... (n-j+1)). G - 1 begins with 4 e^(-2T) (T^2 + T + 1/2), whose integral
gives rho_k = (2k-1)/(2k-3). The rest decays like e^(-4T), so its contribution is smaller by the
factor 2^(-2k) and powers of k.
"""

from collections.abc import Mapping
from functools import cache

import flint
import sympy as sp

from derivation.engine.formula.proof import BY_BALLS, Proof, ProofError, prove
from derivation.mathematics.bessel.theory.functions import Coefficients, multiply
from derivation.plate.modes.theory.plate_factor import plate_factors
from derivation.plate.vocabulary import T, k

Laurent = Mapping[int, sp.Rational]
"""Coefficients by power, positive or negative, of a sum of powers."""

_y, _c = sp.symbols("y c", positive=True)
_m = sp.Symbol("m", integer=True, nonnegative=True)


@cache
def gamma_moment() -> Proof:
    """Prove int_0^oo y^m e^(-cy) dy = m!/c^(m+1): m/c times the previous one, and 1/c for m = 0."""
    step = -(_y ** (_m + 1)) * sp.exp(-_c * _y) / _c
    integrand = (_y ** (_m + 1) - (_m + 1) / _c * _y**_m) * sp.exp(-_c * _y)
    first = -sp.exp(-_c * _y) / _c
    return prove(
        "Moments of an exponential",
        "Terms that vanish at infinity, and for m > 0 at 0, are differentiated.",
        {
            "recurrence in m": sp.expand(sp.powsimp(sp.diff(step, _y) - integrand)),
            "m = 0": sp.diff(first, _y) - sp.exp(-_c * _y),
            "value at 0": first.subs(_y, 0) + 1 / _c,
        },
    )


def moment(power: int, rate: int) -> sp.Rational:
    """Return int_0^oo y^power e^(-rate y) dy, where the exponents are integers."""
    return sp.Rational(sp.factorial(power), rate ** (power + 1))


# --- kappa_n


@cache
def hankel(terms: int) -> Coefficients:
    """Return a_j > 0 of Hankel's expansions of I0 and K0.

    I0 ~ e^y/sqrt(2 pi y) sum a_j y^-j and K0 ~ sqrt(pi/(2y)) e^-y sum (-1)^j a_j y^-j.
    e^(sy)/sqrt(y) y^-j, s = +-1, is inserted into the modified Bessel equation; the balance of each
    power gives the ratio of neighbouring coefficients.
    """
    image = _bessel_operator(_y**-_m, 1)
    low, high = (sp.expand(image * _y**_m).coeff(_y, power) for power in (1, 0))
    ratio = sp.factor(-high / low.subs(_m, _m + 1))
    a = [sp.Integer(1)]
    for index in range(terms - 1):
        a.append(a[-1] * ratio.subs(_m, index))
    series = {
        name: _bessel_operator(
            sp.Add(*(value * (sign / _y) ** i for i, value in enumerate(a))), sign
        )
        for name, sign in (("I0", 1), ("K0", -1))
    }
    prove(
        "Hankel's expansions of I0 and K0",
        "The truncated series are substituted into the modified equation: every power that they "
        "determine vanishes.",
        {
            f"{name}, y^{-power}": left.coeff(_y, -power)
            for name, left in series.items()
            for power in range(-1, terms - 1)
        },
    )
    return tuple(a)


def _bessel_operator(v: sp.Expr, sign: int) -> sp.Expr:
    """Return y^2 w'' + y w' - y^2 w for w = v e^(sign y)/sqrt(y), over e^(sign y)/sqrt(y)."""
    carrier = sp.exp(sign * _y) / sp.sqrt(_y)
    w = v * carrier
    left = _y**2 * sp.diff(w, _y, 2) + _y * sp.diff(w, _y) - _y**2 * w
    return sp.expand(sp.powsimp(sp.expand(left / carrier)))


@cache
def lateral_quotient(terms: int) -> Coefficients:
    """Return q_j of D = e^(2y) K0/(pi I0) ~ sum q_j y^-j: the quotient of Hankel's expansions."""
    a = hankel(terms)
    q: list[sp.Rational] = []
    for index in range(terms):
        known = sp.Add(*(q[i] * a[index - i] for i in range(index)))
        q.append((-1) ** index * a[index] - known)
    prove(
        "Expansion of K0/I0",
        "The quotient times the expansion of I0 is that of K0.",
        {f"y^{-i}": b - (-1) ** i * a[i] for i, b in enumerate(multiply(q, a, terms))},
    )
    return tuple(q)


@cache
def quotient_bound(terms: int) -> tuple[Laurent, Laurent]:
    """Return a bound of |D - sum_(j<N) q_j y^-j|, y > 0: powers of y, and powers times e^-y.

    Write the scaled functions as i = sqrt(2 pi y) e^-y I0 and k = sqrt(2y/pi) e^y K0, so that
    D = k/i, and their truncated expansions as i_N, k_N, q_N. Then

        |D - q_N| <= (|q_N i_N - k_N| + |k - k_N| + |q_N| |i - i_N|)/i.

    - k = sqrt(y/pi) int_0^oo e^(-yu) u^(-1/2) (1 + u/2)^(-1/2) du, and the binomial series
      alternates: |k - k_N| <= a_N y^-N.
    - i is the same integral over (0, 2) with 1 - u/2. Its series sum c_j (u/2)^j has decreasing
      positive c_j: the remainder is below 2 c_N (u/2)^N for u <= 1, below (1 - u/2)^(-1/2) beyond,
      where the integral of u^(-1/2) (1 - u/2)^(-1/2) is below 2 sqrt(2). In the omitted part of the
      terms' integrals, u > 2, e^(-yu) <= e^-y e^(-yu/2). Together
      |i - i_N| <= 2 a_N y^-N + e^-y [(4/5)(1 + y) + (3/2) sum_(j<N) a_j 2^j y^-j], with
      sqrt(y) <= (1 + y)/2, 2 sqrt(2/pi) < 8/5 and sqrt(2) < 3/2.
    - i >= erf(sqrt(2y)) >= sqrt(1 - e^(-2y)), hence 1/i <= 1 + 1/(2y).
    """
    a, q = hankel(terms + 1), lateral_quotient(terms)
    size = {-j: abs(value) for j, value in enumerate(q)}
    product = multiply(q, a[:terms], 2 * terms - 1)
    over = {-j: abs(value) for j, value in enumerate(product) if j >= terms}
    plain = _sum(over, {-terms: a[terms]}, _product(size, {-terms: 2 * a[terms]}))
    edge = {0: sp.Rational(4, 5), 1: sp.Rational(4, 5)}
    cut = {-j: sp.Rational(3, 2) * a[j] * 2**j for j in range(terms)}
    inverse = {0: sp.Integer(1), -1: sp.Rational(1, 2)}
    return _product(inverse, plain), _product(inverse, size, _sum(edge, cut))


def _sum(*series: Laurent) -> Laurent:
    powers = sorted({power for one in series for power in one})
    return {p: sp.Add(*(one.get(p, sp.Integer(0)) for one in series)) for p in powers}


def _product(first: Laurent, *others: Laurent) -> Laurent:
    for other in others:
        first = _sum(*({p + r: a * b for r, b in other.items()} for p, a in first.items()))
    return first


@cache
def lateral_constant(terms: int = 12) -> Proof:
    """Prove D -> 1: the factor pi of K0/I0 = pi e^(-2y) D, not determined by Bessel's equation.

    The truncated expansion, widened by the bound, must contain D.
    """
    plain, fading = quotient_bound(terms)
    for point in (20, 37, 1000):
        for bits in (256, 1024):
            with flint.ctx.workprec(bits):
                y = flint.arb(point)
                ratio = y.bessel_k(flint.arb(0)) / y.bessel_i(flint.arb(0))
                left = (2 * y).exp() * ratio / flint.arb.pi()
                middle = _at({-j: value for j, value in enumerate(lateral_quotient(terms))}, y)
                width = _at(plain, y) + (-y).exp() * _at(fading, y)
                if not (middle + flint.arb(0, width.upper())).contains(left):
                    raise ProofError(f"Expansion of K0/I0: {left} at {point} is not {middle}")
    return Proof("Factor of K0/I0", "The series within its bound contains D.", ("D",), BY_BALLS)


def _at(series: Laurent, y: flint.arb) -> flint.arb:
    return sum((flint.arb(flint.fmpq(int(a.p), int(a.q))) * y**p for p, a in series.items()), y * 0)


@cache
def kappa_steps(terms: int) -> Coefficients:
    """Return 2^j q_j, numerators of the first terms of r_n = sum 2^j q_j/(n (n-1) ... (n-j+1))."""
    gamma_moment()
    lateral_constant()
    n = terms + 3
    steps = tuple(2**j * value for j, value in enumerate(lateral_quotient(terms)))
    scale = sp.Rational(2 ** (n + 1), sp.factorial(n))
    prove(
        "Expansion of kappa_n",
        f"The terms of y^n e^(-2y) D are integrated, n = {n}.",
        {
            f"q_{j}": scale * q * moment(n - j, 2) - steps[j] / sp.ff(n, j)
            for j, q in enumerate(lateral_quotient(terms))
        },
    )
    return steps


def kappa_bound(n: int, terms: int) -> sp.Expr:
    """Return a bound of |r_n - its first terms| for all indices >= n; infinite for n < 2 `terms`.

    2^(n+1)/n! times the integral of y^n e^(-2y) `quotient_bound`, computed exactly; every term of
    it decreases with n.
    """
    if n < 2 * terms:
        return sp.oo
    scale = sp.Rational(2 ** (n + 1), sp.factorial(n))
    plain, fading = quotient_bound(terms)
    by_rate = ((2, plain), (3, fading))
    return scale * sum(a * moment(n + p, rate) for rate, one in by_rate for p, a in one.items())


# --- M_k


@cache
def excess_beyond_first() -> Proof:
    """Prove the rest of G - 1 = 4 E (T^2 + T + 1/2) + rest, E = e^(-2T), and its bound.

    rest = 4 E^2 (N - 1/2 - E (T^2 + T + 1/2))/d with N = (T^2 + T + 1/2) (4 T^2 + 2) and
    d = (1 - E)^2 - 4 T^2 E = 4 E (sinh^2 T - T^2). For T >= 1, d increases from d(1) > 1/5; for
    T < 1, sinh^2 T - T^2 >= T^4/3 and E > 2/15. So 1/d <= 5 + 6/T^4 and 0 <= rest <= 4 E^2 N/d.
    """
    E = sp.exp(-2 * T)
    first = T**2 + T + sp.Rational(1, 2)
    d = (1 - E) ** 2 - 4 * T**2 * E
    rest = 4 * E**2 * (_next_power(T) - sp.Rational(1, 2) - E * first) / d
    series = sp.series(sp.sinh(T) ** 2 - T**2, T, 0, 5).removeO()
    for bits in (64, 256):
        with flint.ctx.workprec(bits):
            small = flint.arb(-2).exp()
            if not (small > flint.arb(2) / 15 and (1 - small) ** 2 - 4 * small > flint.arb(1) / 5):
                raise ProofError("Rest of the plate factor: d(1) or E(1) is below its bound")
    return prove(
        "Rest of the plate factor",
        "Both sides have a common denominator. Each factor of d' is positive for T >= 1; the "
        "series of sinh^2 T has no negative coefficient.",
        {
            "decomposition": plate_factors()[2].expression - 4 * E * first - rest,
            "d": d - 4 * E * (sp.sinh(T) ** 2 - T**2),
            "derivative of d": sp.diff(d, T) - 4 * E * ((1 - E) + 2 * T * (T - 1)),
            "leading term": series - T**4 / 3,
        },
    )


def _next_power(t: sp.Expr) -> sp.Expr:
    """Return N(T) of the rest's leading term 4 e^(-4T) N."""
    return (t**2 + t + sp.Rational(1, 2)) * (4 * t**2 + 2)


@cache
def finite_part_limit() -> sp.Expr:
    """Return (2k-1)/(2k-3), which is rho_k for the part 4 e^(-2T) (T^2 + T + 1/2) of G - 1."""
    gamma_moment()
    excess_beyond_first()
    limit = (2 * k - 1) / (2 * k - 3)
    m = 2 * k - 4
    # int T^(m+p) e^(-2T) dT over m!/2^(m+1), and the scale 2^(2k-3)/(2k-2)! over 2^(m+1)/m!.
    moments = {p: sp.expand_func(sp.rf(m + 1, p)) / 2**p for p in range(3)}
    total = 4 * (moments[2] + moments[1] + moments[0] / 2) / ((m + 1) * (m + 2))
    prove(
        "Finite part for large k",
        "The three moments of the first exponential are added.",
        {"sum": total - limit},
    )
    return limit


def finite_part_bound(index: int) -> sp.Expr:
    """Return a bound of rho_k minus its limit, for k = index or larger; infinite for k < 4.

    2^(2k-3)/(2k-2)! times the integral of T^m e^(-4T) 4 N (5 + 6/T^4), m = 2k - 4, exactly. From k
    to k + 1 it decreases at least by the factor (m+5) (m+6)/(4 (m+3) (m+4)) < 1.
    """
    excess_beyond_first()
    if index < 4:
        return sp.oo
    power = 2 * index - 4
    scale = sp.Rational(2 ** (power + 1), sp.factorial(power + 2))
    n = sp.Poly(_next_power(T), T).as_dict()
    inverse = {0: sp.Integer(5), -4: sp.Integer(6)}
    rest = _product({p: 4 * a for (p,), a in n.items()}, inverse)
    return scale * sum(a * moment(power + p, 4) for p, a in rest.items())
