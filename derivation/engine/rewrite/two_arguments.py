"""Differences of one function at two arguments, f(p) - f(q), by functions of p - q.

p - q is expanded first: of x + y and x it is y, which is not rounded. p_+ is max(p, 0).

c p^n - c q^n            c q^n expm1(t) or -c p^n expm1(-t), with t = n log(p/q); also p^n - p^m
log p - log q            log1p((p - q)_+/q) - log1p((q - p)_+/p)
tan p - tan q            sin(p - q)/(cos p cos q)
tanh p - tanh q          sinh(p - q)/(cosh p cosh q), for positive and for negative parts separately
coth p - coth q          sinh(q - p)/(sinh p sinh q)
atan p - atan q          atan((p - q)/(1 + p q)), likewise
asin p - asin q          atan of sin(asin p - asin q)/cos(asin p - asin q), for p, q >= 0
asinh p - asinh q        asinh((p - q)(p + q)/(p sqrt(1 + q^2) + q sqrt(1 + p^2))), for p, q > 0
acosh p - acosh q        the same with p^2 - 1 and q^2 - 1
atanh p - atanh q        as logarithms
"""

from collections.abc import Callable, Mapping

import sympy as sp
from sympy.codegen.cfunctions import expm1, log1p

Difference = Callable[[sp.Expr, sp.Expr], sp.Expr | None]
"""f(p) - f(q) as a function of p and q; None if it does not apply to them."""


def difference_of_functions(one: sp.Expr, other: sp.Expr) -> sp.Expr | None:
    """Return the sum of two terms c f(p) and -c f(q) in another form; None if there is none."""
    if one.could_extract_minus_sign():
        one, other = other, one
    for kind, of in DIFFERENCES.items():
        for c, p in _split(one, kind):
            for factor, q in _split(other, kind):
                if c == -factor and p != q and (found := of(p, q)) is not None:
                    return c * found
    return _of_powers(one, other)


def _split(term: sp.Expr, kind: type[sp.Function]) -> list[tuple[sp.Expr, sp.Expr]]:
    """Return the ways to write a term as c f(u), by c and u."""
    functions = [factor for factor in sp.Mul.make_args(term) if isinstance(factor, kind)]
    return [(term / function, function.args[0]) for function in functions]


def _gap(p: sp.Expr, q: sp.Expr) -> sp.Expr:
    return sp.factor_terms(sp.expand(p - q, power_base=False))


def _positive_part(u: sp.Expr) -> sp.Expr:
    return u if u.is_positive else sp.Integer(0) if u.is_negative else sp.Max(u, 0)


def _logarithms(p: sp.Expr, q: sp.Expr) -> sp.Expr:
    gap = _gap(p, q)
    return log1p(_positive_part(gap) / q) - log1p(_positive_part(-gap) / p)


def _hyperbolic_areas(p: sp.Expr, q: sp.Expr) -> sp.Expr:
    gap = _gap(p, q)
    rises, falls = (2 * _positive_part(u) for u in (gap, -gap))
    return (log1p(rises / ((1 - p) * (1 + q))) - log1p(falls / ((1 - q) * (1 + p)))) / 2


def _odd(of: Callable[[sp.Expr, sp.Expr], sp.Expr]) -> Difference:
    """Return the difference of an odd function for any signs, given that for p, q >= 0.

    The positive and the negative parts of p and q are treated separately.
    """

    def difference(p: sp.Expr, q: sp.Expr) -> sp.Expr:
        if p.is_nonnegative and q.is_nonnegative:
            return of(p, q)
        return of(sp.Max(p, 0), sp.Max(q, 0)) + of(sp.Max(-q, 0), sp.Max(-p, 0))

    return difference


def _decaying(p: sp.Expr, q: sp.Expr) -> sp.Expr:
    """Return 4 e^(-p - q) sinh(p - q), for p, q >= 0."""
    gap = _gap(p, q)
    least = q if gap.is_positive else p if gap.is_negative else sp.Min(p, q)
    falls, rises = (expm1(-2 * _positive_part(u)) for u in (gap, -gap))
    return 2 * sp.exp(-2 * least) * (rises - falls)


def _hyperbolic_cotangents(p: sp.Expr, q: sp.Expr) -> sp.Expr | None:
    if not (p.is_positive and q.is_positive):
        return None
    return _decaying(q, p) / (expm1(-2 * p) * expm1(-2 * q))


def _inverse_sines(p: sp.Expr, q: sp.Expr) -> sp.Expr | None:
    if not (p.is_nonnegative and q.is_nonnegative):
        return None
    to_p, to_q = (sp.sqrt(1 - u) * sp.sqrt(1 + u) for u in (p, q))
    sine = _gap(p, q) * (p + q) / (p * to_q + q * to_p)
    return sp.atan(sine / (to_p * to_q + p * q))


def _with_roots(p: sp.Expr, q: sp.Expr, root: Callable[[sp.Expr], sp.Expr]) -> sp.Expr | None:
    if not (p.is_positive and q.is_positive):
        return None
    return sp.asinh(_gap(p, q) * (p + q) / (p * root(q) + q * root(p)))


DIFFERENCES: Mapping[type[sp.Function], Difference] = {
    sp.log: _logarithms,
    sp.tan: lambda p, q: sp.sin(_gap(p, q)) / (sp.cos(p) * sp.cos(q)),
    sp.tanh: _odd(lambda p, q: _decaying(p, q) / ((1 + sp.exp(-2 * p)) * (1 + sp.exp(-2 * q)))),
    sp.coth: _hyperbolic_cotangents,
    sp.atan: _odd(lambda p, q: sp.atan(_gap(p, q) / (1 + p * q))),
    sp.asin: _inverse_sines,
    sp.acos: lambda p, q: _inverse_sines(q, p),
    sp.asinh: lambda p, q: _with_roots(p, q, lambda u: sp.sqrt(1 + u**2)),
    sp.acosh: lambda p, q: _with_roots(p, q, lambda u: sp.sqrt(u - 1) * sp.sqrt(u + 1)),
    sp.atanh: _hyperbolic_areas,
}
"""f(p) - f(q) in another form."""


def _of_powers(one: sp.Expr, other: sp.Expr) -> sp.Expr | None:
    """Return c p^n - c q^n, where n is no number, by t = n log(p/q)."""
    powers = [part.as_base_exp() for term in (one, other) for part in sp.Mul.make_args(term)]
    n = next((exponent for _, exponent in powers if not exponent.is_number), None)
    if n is None or any(isinstance(part, sp.exp) for part in sp.Mul.make_args(one * other)):
        return None
    ratio = (-one / other).as_powers_dict()
    if len(ratio) == 1:  # also x^n/x^m
        (n,) = ratio.values()
    rates = {base: sp.cancel(exponent / n) for base, exponent in ratio.items()}
    if not all(rate.is_Rational for rate in rates.values()):
        return None
    p, q = (
        sp.Mul(*(base ** (sign * rate) for base, rate in rates.items() if sign * rate > 0))
        for sign in (1, -1)
    )
    gap = _gap(p, q)
    if len(sp.Add.make_args(gap)) < len(sp.Add.make_args(p)) + len(sp.Add.make_args(q)):
        t = -n * log1p(-gap) if p == 1 else n * log1p(gap / q)
        for term, value in ((-other, -other * expm1(t)), (one, -one * expm1(-t))):
            if all(exponent.is_number for exponent in term.as_powers_dict().values()):
                return value
    else:
        t = n * sp.log(p / q)
    if t.is_positive:
        return -one * expm1(-t)
    if t.is_negative:
        return -other * expm1(t)
    return -other * expm1(sp.Min(t, 0)) - one * expm1(-sp.Max(t, 0))
