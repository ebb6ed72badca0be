"""I0 and I1 for generated code: their ratio at infinity, and Bessel's integral as a sum.

The ratio s = I1/I0 solves s' = 1 - s/k - s^2. Its truncated series S at infinity has the residual
rho(k), a polynomial in 1/k that begins with the first omitted power N. The difference e = s - S has
|e|' <= -(1/k + s + S) |e| + |rho|, and s >= k/(2 + k), so that

    |e(k)| <= B (K/k)^N for k >= K   if |e(K)| <= B and |rho(k)| <= B (K/k)^N (s + S - N/k),

and the error of log(I0 sqrt(2 pi k) e^(-k)) = -int_k^oo (s - 1 + 1/(2x)) dx is at most B K/(N - 1).

The generating function e^(k cos t) = I0 + 2 sum I_n cos(n t) makes the mean of e^(k cos t) over M
equal steps of a turn I0 + 2 I_M + ..., and that of k sin^2(t) e^(k cos t) is I1 minus k I_(M-2)/2
and so on. Because I_n <= (k/2)^n/n! I0, few steps are sufficient for moderate k; all terms are
positive.

J0 I0 and (J0 I1 + J1 I0)/k are power series in k^4.
"""

from fractions import Fraction
from functools import cache
from math import factorial

import flint
import sympy as sp

from derivation.engine.formula.ball import to_ball
from derivation.engine.formula.proof import Proof, ProofError, lower_bessel, prove

Coefficients = tuple[sp.Rational, ...]
_k, _x = sp.symbols("k x", positive=True)
_n = sp.Symbol("n", integer=True, positive=True)


@cache
def ratio_series(terms: int) -> Coefficients:
    """Return coefficients of I1/I0 in powers of 1/k, the constant first."""
    s = [sp.Integer(1)]
    for m in range(1, terms):
        s.append(((m - 2) * s[-1] - sum(s[i] * s[m - i] for i in range(1, m))) / 2)
    ratio = sp.besseli(1, _k) / sp.besseli(0, _k)
    equation = sp.diff(ratio, _k) - (1 - ratio / _k - ratio**2)
    left, least = _residual(tuple(s)), _k / (2 + _k)
    prove(
        "Ratio of modified Bessel functions",
        "I1/I0 and its truncated series are substituted into s' = 1 - s/k - s^2. k/(2 + k), which "
        "has the same first term at k = 0 as I1/I0, has a smaller derivative than this equation "
        "requires.",
        {
            "equation": equation,
            "below": 1 - least / _k - least**2 - sp.diff(least, _k) - 3 * _k / (2 + _k) ** 2,
            **{f"k^-{m}": left[m] for m in range(terms)},
        },
    )
    return tuple(s)


def _residual(s: Coefficients) -> Coefficients:
    """Return the residual of a truncated series in s' - 1 + s/k + s^2, by powers of 1/k."""
    square = sp.Poly(s[::-1], _x) ** 2
    linear = sp.Poly([(1 - m) * c for m, c in reversed(list(enumerate(s)))] + [0], _x)
    return tuple(reversed((square + linear - 1).all_coeffs()))


def ratio_bound(terms: int, start: Fraction) -> flint.arb:
    """Return a bound, for k >= start, of the truncation error of the series of I1/I0.

    Raises
    ------
    ProofError
        If the condition of the bound is not met.
    """
    K, s = to_ball(start), ratio_series(terms)
    size = flint.arb(0)
    for power, coefficient in enumerate(_residual(s)[terms:], start=terms):
        size += abs(to_ball(Fraction(int(coefficient.p), int(coefficient.q)))) / K**power
    value = sum(
        (to_ball(Fraction(int(c.p), int(c.q))) / K**m for m, c in enumerate(s)), flint.arb(0)
    )
    true = K.bessel_i(1) / K.bessel_i(0)
    # Increases with k, because every term of the series but the first is negative.
    damping = K / (2 + K) + value - terms / K
    if not (damping > 0 and all(c < 0 for c in s[1:])):
        raise ProofError(f"I1/I0 with {terms} terms from {start} on: the bound is not valid")
    return max(abs(true - value).upper(), (size / damping).upper())


def logarithm_bound(terms: int, start: Fraction) -> flint.arb:
    """Return a bound, for k >= start, of the series' error in log(I0 sqrt(2 pi k) e^(-k))."""
    return ratio_bound(terms, start) * to_ball(start) / (terms - 1)


@cache
def bessel_integral() -> Proof:
    """Prove I1 as a mean of sin^2, and the bound of I_n."""
    m = sp.Symbol("m", integer=True, nonnegative=True)
    # (2 m + n)-th powers: (k/2)^n/n! I0 divided by that of I_n.
    ratio = sp.factorial(m + _n) / (sp.factorial(m) * sp.factorial(_n))
    I0, I1, I2 = (sp.besseli(order, _k) for order in range(3))
    return prove(
        "Bessel's integral as a sum",
        "sin^2 t = (1 - cos 2t)/2 is inserted into the generating function; the quotient of the "
        "coefficients of I_n and of (k/2)^n I0/n! is a binomial coefficient.",
        {
            "I1": _k * (I0 - I2) / 2 - I1,
            "half angle": sp.expand_trig(sp.sin(_x) ** 2 - (1 - sp.cos(2 * _x)) / 2)
            .expand()
            .subs(sp.cos(_x) ** 2, 1 - sp.sin(_x) ** 2)
            .expand(),
            "coefficients": sp.combsimp(ratio / sp.binomial(m + _n, _n)) - 1,
        },
    )


def sum_bound(steps: int, largest: Fraction) -> Fraction:
    """Return a bound of the relative error of I0 and I1 by a sum of `steps` terms, k <= largest.

    For I0 it is 2 (I_M + I_2M + ...)/I0, for I1 (I_(M-2) - 2 I_M + I_(M+2) + ...) k/(2 I1) with
    I1 >= k/(2 + k) I0.

    Raises
    ------
    ProofError
        If the steps are too few for the bound.
    """
    bessel_integral()
    half = largest / 2
    least = steps - 2
    first = half**least / factorial(least)
    # Each further term is at most half/least times the one before it, and this is below 1/2.
    if not 2 * half < least:
        raise ProofError(f"{steps} steps for k = {largest}: too few for the bound")
    return 4 * first * (1 + half)


def fourth_bound(steps: int, largest: Fraction) -> Fraction:
    """Return a bound of the relative error of I2 by a sum of `steps` terms, 0 < k <= largest.

    The error of the mean of sin^4 = (3 - 4 cos 2t + cos 4t)/8 is at most
    2 (I_(M-4) + I_(2M-4) + ...), and I_n <= 2 (k/2)^(n-2)/n! I2.

    Raises
    ------
    ProofError
        If the steps are too few for the bound.
    """
    fourth_power()
    least = steps - 4
    # Each further term is at most largest/(2 least) times the one before it: less than 1/2.
    if not largest < least:
        raise ProofError(f"{steps} steps of I2 for k = {largest}: too few for the bound")
    return Fraction(32, 3) * (largest / 2) ** least / factorial(least)


@cache
def fourth_power() -> Proof:
    """Prove I2 as a mean of sin^4, and the bound of I_n."""
    m = sp.Symbol("m", integer=True, nonnegative=True)
    I0, I2, I4 = (sp.besseli(order, _k) for order in (0, 2, 4))
    # (2 m + n)-th powers: 2 (k/2)^(n-2)/n! I2 divided by that of I_n, n = _n + 2.
    ratio = 2 * sp.factorial(m + _n + 2) / (sp.factorial(m + 2) * sp.factorial(_n + 2))
    x = sp.Symbol("x", real=True)
    return prove(
        "Bessel's integral of I2 as a sum",
        "sin^4 t is expanded in cosines in the generating function; the quotient of the "
        "coefficients is a binomial coefficient over the one for m = 0.",
        {
            "I2": lower_bessel(_k**2 / 3 * (3 * I0 - 4 * I2 + I4) / 8 - I2),
            "fourth power": sp.expand(
                sp.expand_trig((3 - 4 * sp.cos(2 * x) + sp.cos(4 * x)) / 8 - sp.sin(x) ** 4).subs(
                    sp.cos(x), sp.sqrt(1 - sp.sin(x) ** 2)
                )
            ),
            "coefficients": sp.combsimp(
                ratio * sp.binomial(_n + 2, 2) / sp.binomial(m + _n + 2, _n)
            ) - 1,
        },
    )  # fmt: skip
