"""Sums of c x^k e^(m x) w(x): normal form, Taylor coefficients, truncation errors.

w is 1, or a function of a multiple of x, such as sin or log(1 + .). The rules apply to quotients of
such sums.
"""

import contextlib
import math
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import sympy as sp
from sympy.codegen.cfunctions import expm1, log1p

WAVES: dict[type[sp.Function], str] = {sp.sin: "sin", sp.cos: "cos", log1p: "log1p"} | {
    function: function.__name__ for function in (sp.atan, sp.atanh, sp.asin, sp.asinh)
}
ENTIRE = {"", "sin", "cos"}
"""Functions whose series converge for every argument."""
RISING = ("log1p", "asinh")
"""Functions that have no limit and no bound for large arguments."""


class UnreachableError(ValueError):
    """The rules find no stable form of an expression; the message states the reason.

    Parameters
    ----------
    message
        The message.
    worst
        The error [ULP] of the form that is not accurate; infinite if there is none.
    """

    def __init__(self, message: str, worst: float = math.inf) -> None:
        super().__init__(message)
        self.worst = worst


@contextlib.contextmanager
def collected(reasons: list[UnreachableError]) -> Iterator[None]:
    """Add an UnreachableError to a list, and continue after the block."""
    try:
        yield
    except UnreachableError as error:
        reasons.append(error)


class Key(NamedTuple):
    """The function x^power e^(rate x) wave(scale x); an empty name means no wave."""

    power: int
    rate: sp.Rational
    wave: str = ""
    scale: sp.Rational = sp.Integer(0)


Terms = Mapping[Key, sp.Expr]
"""Coefficients, free of x, by key; none is zero."""

ONE = Key(0, sp.Integer(0))


def terms_of(expression: sp.Expr, x: sp.Symbol) -> dict[Key, sp.Expr]:
    """Return the normal form of a sum.

    Raises
    ------
    UnreachableError
        If a part is not such a term; the message states the part.
    """
    if not expression.has(x):
        return {ONE: expression}
    if expression == x:
        return {Key(1, sp.Integer(0)): sp.Integer(1)}
    if isinstance(expression, sp.Add):
        return _sum(*(terms_of(part, x) for part in expression.args))
    if isinstance(expression, sp.Mul):
        terms = {ONE: sp.Integer(1)}
        for part in expression.args:
            terms = _product(terms, terms_of(part, x))
        return terms
    if isinstance(expression, sp.Pow) and expression.exp.is_Integer and expression.exp > 0:
        return terms_of(sp.Mul(*[expression.base] * int(expression.exp), evaluate=False), x)
    return _function(expression, x)


def _function(expression: sp.Expr, x: sp.Symbol) -> dict[Key, sp.Expr]:
    """Return the normal form of a function of a multiple of x."""
    scale = sp.cancel(expression.args[0] / x) if len(expression.args) == 1 else None
    if scale is None or not scale.is_Rational:
        raise UnreachableError(f"{expression} is not a function of a rational multiple of {x}")
    half, zero = sp.Rational(1, 2), sp.Integer(0)
    if isinstance(expression, sp.exp):
        return {Key(0, scale): sp.Integer(1)}
    if isinstance(expression, expm1):
        return {Key(0, scale): sp.Integer(1), ONE: sp.Integer(-1)}
    if isinstance(expression, sp.cosh):
        return {Key(0, scale): half, Key(0, -scale): half}
    if isinstance(expression, sp.sinh):
        return {Key(0, scale): half, Key(0, -scale): -half}
    if expression.func in WAVES:
        return {Key(0, zero, WAVES[expression.func], scale): sp.Integer(1)}
    raise UnreachableError(f"no rule applies to the function {expression.func.__name__}")


def _sum(*parts: Terms) -> dict[Key, sp.Expr]:
    total: dict[Key, sp.Expr] = {}
    for part in parts:
        for key, coefficient in part.items():
            total[key] = sp.expand(total[key] + coefficient) if key in total else coefficient
    return {key: coefficient for key, coefficient in total.items() if coefficient != 0}


def _product(one: Terms, other: Terms) -> dict[Key, sp.Expr]:
    return _sum(
        *(
            {product: size * coefficient * factor}
            for key, coefficient in one.items()
            for further, factor in other.items()
            for product, size in _times(key, further).items()
        )
    )


def _times(one: Key, other: Key) -> dict[Key, sp.Expr]:
    """Return the product of two terms; products of sines and cosines are sums of these."""
    power, rate = one.power + other.power, one.rate + other.rate
    if not (one.wave and other.wave):
        wave = one if one.wave else other
        return {Key(power, rate, wave.wave, wave.scale): sp.Integer(1)}
    if not {one.wave, other.wave} <= {"sin", "cos"}:
        raise UnreachableError(f"no rule applies to the product of {one.wave} and {other.wave}")
    if (one.wave, other.wave) == ("sin", "cos"):
        one, other = other, one
    half, odd = sp.Rational(1, 2), one.wave != other.wave
    factors: list[Terms] = []
    for scale, size in (
        (other.scale + one.scale, -half if other.wave == one.wave == "sin" else half),
        (other.scale - one.scale, half),
    ):
        if scale != 0:
            sign = -1 if odd and scale < 0 else 1
            factors.append({Key(power, rate, "sin" if odd else "cos", abs(scale)): sign * size})
        elif not odd:
            factors.append({Key(power, rate): size})
    return _sum(*factors)


def expression_of(terms: Terms, x: sp.Symbol) -> sp.Expr:
    """Return the sum of the terms."""
    return sp.Add(*(coefficient * monomial(key, x) for key, coefficient in terms.items()))


def monomial(key: Key, x: sp.Symbol) -> sp.Expr:
    """Return one term without its coefficient."""
    functions = {name: function for function, name in WAVES.items()}
    wave = functions[key.wave](key.scale * x) if key.wave else sp.Integer(1)
    return x**key.power * sp.exp(key.rate * x) * wave


def coefficient(key: Key, n: int) -> sp.Rational:
    """Return the Taylor coefficient of x^n of one term, the product of exponential and wave."""
    order = n - key.power
    if order < 0:
        return sp.Integer(0)
    if not key.wave:
        return key.rate**order / sp.factorial(order)
    if key.rate == 0:
        return _wave_coefficient(key, order)
    return sp.Add(
        *(
            key.rate ** (order - i) / sp.factorial(order - i) * _wave_coefficient(key, i)
            for i in range(order + 1)
        )
    )


def _wave_coefficient(key: Key, order: int) -> sp.Rational:
    unit = key.scale**order
    if key.wave == "log1p":
        return (-1) ** (order + 1) * unit / order if order else sp.Integer(0)
    if order % 2 != (key.wave != "cos"):
        return sp.Integer(0)
    half = order // 2
    sign = 1 if key.wave in ("atanh", "asin") else (-1) ** half
    if key.wave in ("sin", "cos"):
        return sign * unit / sp.factorial(order)
    if key.wave in ("asin", "asinh"):
        sign *= sp.binomial(2 * half, half) / sp.Integer(4) ** half
    return sign * unit / order


def taylor(terms: Terms) -> Iterator[sp.Expr]:
    """Yield the Taylor coefficients of the sum about 0, from x^0 on, without end."""
    n = 0
    while True:
        yield sp.Add(*(c * coefficient(key, n) for key, c in terms.items()))
        n += 1


def truncation_bound(terms: Terms, n: int, end: sp.Rational) -> sp.Rational:
    """Return a bound of the sum of all powers from x^n on, for 0 <= x <= end.

    Taylor's theorem: the error of e^(m x) times a sine of p x after its first J terms is at most
    ((|m| + |p|) x)^J/J! e^(|m| x). Coefficients of log(1 + p x) and of the inverse functions are at
    most p^J/J, so that their error is at most that of a geometric series.
    """
    total = sp.Integer(0)
    for key, size in terms.items():
        order, growth = max(n - key.power, 0), abs(key.rate) * end
        reach = growth + abs(key.scale) * end
        if key.wave not in ENTIRE:
            if reach >= 1 or key.rate != 0:
                raise UnreachableError(f"the series of {key.wave}({key.scale} x) ends before {end}")
            remainder = reach ** max(order, 1) / (max(order, 1) * (1 - reach))
        else:
            remainder = reach**order / sp.factorial(order) * sp.Integer(3) ** sp.ceiling(growth)
        total += abs(size) * end**key.power * remainder
    return total
