"""The zeros of J0 and J1 from their phases, and J1 at the zeros of J0.

J_nu = sqrt(2 p/(pi x)) cos(theta) vanishes where theta = x - nu pi/2 - pi/4 + shift(x) is an
odd multiple of pi/2: the n-th positive zero solves x + shift(x) = beta with
beta = (n + nu/2 - 1/4) pi, and J1 = -J0' is known where J0 vanishes.
"""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import Proof, prove
from derivation.mathematics.bessel.theory.functions import (
    Coefficients,
    Expansion,
    modulus_squared,
    multiply,
    phase_bound,
    phase_shift,
    power,
)

ASIDE = sp.Rational(2, 5)
"""Bound of the distance of a zero of J0 or J1 from beta: pi/8 < 2/5, by Sturm's comparison."""


@cache
def phase_at_zeros(order: int) -> tuple[int, Proof]:
    """Return the integer q of beta = (4 n + q) pi/4, where cos(theta) = 0, with the proof."""
    q = 2 * order - 1
    n = sp.Symbol("n", integer=True, positive=True)
    theta = (4 * n + q) * sp.pi / 4 - order * sp.pi / 2 - sp.pi / 4
    proof = prove(
        f"Phase at the zeros of J{order}",
        "theta = beta - nu pi/2 - pi/4 is an odd multiple of pi/2, and n + 1 gives the next odd "
        "multiple.",
        {"odd multiple": theta - (2 * n - 1) * sp.pi / 2},
    )
    return q, proof


@cache
def zero_correction(order: int, terms: int) -> Expansion:
    """Return the n-th zero of J_nu minus beta (McMahon), in odd powers of 1/beta, nu = 0 or 1.

    With x = beta (1 + s) the equation x + shift(x) = beta is
    s = -sum d_i w^i (1 + s)^(1-2i), w = 1/beta^2, and each evaluation of it gives one more
    coefficient of s.
    """
    phase_at_zeros(order)
    d = phase_shift(order, terms).coefficients
    stretch: Coefficients = (sp.Integer(1),)
    for _ in range(terms):
        stretch = tuple(
            (1 if index == 0 else 0) - shift
            for index, shift in enumerate(_compose(d, 1, stretch, terms + 1))
        )
    residual = _reversion(order, stretch)
    proof = prove(
        f"McMahon's expansion for J{order}",
        "The expansion is substituted into x + shift(x) = beta, multiplied by its denominators.",
        {f"w^{index}": residual[index] for index in range(terms + 1)},
    )
    return Expansion(f"zero of J{order} minus beta", -1, stretch[1:], proof)


@cache
def _reversion(order: int, stretch: Coefficients) -> Coefficients:
    """Return (x + shift(x) - beta) x^(2N-1) beta^(-2N) in powers of w; x = beta stretch."""
    w = sp.Symbol("w", positive=True)
    terms = len(stretch) - 1
    one_plus_s = sp.Poly(sp.Add(*(s * w**index for index, s in enumerate(stretch))), w)
    highest = 2 * terms - 1
    total = (one_plus_s - 1) * one_plus_s**highest
    for index, coefficient in enumerate(phase_shift(order, terms).coefficients, start=1):
        total += coefficient * sp.Poly(w**index, w) * one_plus_s ** (highest + 1 - 2 * index)
    return tuple(reversed(total.all_coeffs()))


def zero_bound(order: int, terms: int, beta: sp.Rational) -> sp.Expr:
    """Return a bound, for this beta and larger ones, of the error of the truncated expansion.

    At t, the truncated expansion, |theta(t) - beta| is at most the residual of the truncated phase,
    a polynomial in 1/beta whose terms are taken in absolute value, plus the phase's own remainder
    (`phase_bound`). Divided by the smallest theta' = 1/p (`amplitude_and_phase`) between t and the
    zero it bounds their distance. Each of these decreases as beta increases.
    """
    stretch = (sp.Integer(1), *zero_correction(order, terms).coefficients)
    w = beta**-2
    least = 1 - sum(abs(s) * w**index for index, s in enumerate(stretch) if index > 0)
    start = min(beta * least, beta - ASIDE)
    if start <= 0:
        return sp.oo
    left_over = beta * sum(
        abs(value) * w**index
        for index, value in enumerate(_reversion(order, stretch))
        if index > terms
    )
    amplitude = sum(
        abs(value) * start ** (-2 * index)
        for index, value in enumerate(modulus_squared(order, terms + 1).coefficients)
    )
    at_t = left_over / least ** (2 * terms - 1) + phase_bound(order, terms, start)
    return amplitude * at_t


def slope_at_zero(beta: sp.Expr, square: sp.Expr) -> sp.Expr:
    """Return |J1| at a zero of J0 from the value of `slope_squared`."""
    return sp.sqrt(2 * square / (sp.pi * beta))


@cache
def slope_squared(terms: int) -> Expansion:
    """Return (pi beta/2) J1(j_n)^2 in powers of 1/beta^2, beta = (n - 1/4) pi.

    Where cos(theta) = 0, J0' = -sqrt(2 p/(pi x)) theta' sin(theta), hence
    J1(j_n)^2 = 2/(pi x p(x)) at x = j_n = beta (1 + s).
    """
    m = modulus_squared(0, terms).coefficients
    stretch = (sp.Integer(1), *zero_correction(0, terms).coefficients)[:terms]
    product = multiply(stretch, _compose(m, 0, stretch, terms), terms)
    coefficients = power(product, sp.Integer(-1), terms)
    w = sp.Symbol("w", positive=True)
    one_plus_s, slope = (
        sp.Poly(sp.Add(*(a * w**index for index, a in enumerate(series))), w)
        for series in (stretch, coefficients)
    )
    highest = 2 * terms
    left = sp.Poly(0, w)
    for index, coefficient in enumerate(m):
        left += coefficient * sp.Poly(w**index, w) * one_plus_s ** (highest + 1 - 2 * index)
    residual = left * slope - one_plus_s**highest
    proof = prove(
        "J1 at the zeros of J0",
        "The series is substituted into J1^2 (pi x/2) p(x) = 1 at the zero, multiplied by "
        "denominators.",
        {f"w^{index}": residual.coeff_monomial(w**index) for index in range(terms)},
    )
    return Expansion("J1^2 times pi beta/2", 0, coefficients, proof)


def _compose(
    coefficients: Coefficients, first: int, stretch: Coefficients, terms: int
) -> Coefficients:
    """Return sum_i coefficients[i] w^e stretch^(first - 2 e), e = i + first, as a series in w."""
    total = [sp.Integer(0)] * terms
    for index, coefficient in enumerate(coefficients, start=first):
        for n, factor in enumerate(power(stretch, sp.Integer(first - 2 * index), terms - index)):
            total[index + n] += coefficient * factor
    return tuple(total)
