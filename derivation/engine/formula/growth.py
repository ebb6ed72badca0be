"""Bounds of an expression for large values of a variable, which bound the tail of an integral.

For all y >= T, with T >= 1, the modulus is at most C y^k e^(c y), and often at least such a
product. Parameters are complex balls, so that the bounds also hold for nested integrals.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

import sympy as sp
from flint import acb, arb

from derivation.engine.formula.power_bound import (
    Growth,
    Power,
    UnboundedError,
    constant,
    small_argument,
)

Enclose = Callable[[sp.Expr, Mapping[sp.Basic, acb]], acb]


@dataclass(frozen=True)
class Region:
    """The range y >= T of a variable v, which is y, e^y or e^-y, and the other symbols' balls.

    Parameters
    ----------
    variable
        The variable v.
    own
        Bounds of v.
    values
        Balls of the other symbols; for v = e^-y, also that of v.
    T
        The start of the range.
    holomorphic
        Whether roots and logarithms must be holomorphic in the parameters.
    enclose
        Function that encloses an expression.
    """

    variable: sp.Symbol
    own: Growth
    values: Mapping[sp.Basic, acb]
    T: arb
    holomorphic: bool
    enclose: Enclose

    def growth(self, node: sp.Expr) -> Growth:
        """Return bounds of an expression, whose numbers are exact.

        Raises
        ------
        UnboundedError
            If no rule applies.
        """
        if node == self.variable:
            return self.own
        varies = node.has(self.variable)
        known = not varies or self.variable in self.values
        ball = self.enclose(node, self.values) if known else acb(arb.nan())
        if ball.is_finite() and not (varies and ball.contains(0)):
            return constant(ball)
        rule = next((rule for kind, rule in _RULES.items() if isinstance(node, kind)), None)
        try:
            if rule is None or not varies:
                raise UnboundedError
            result = rule(self, node)
        except UnboundedError:
            if not ball.is_finite():
                raise
            result = constant(ball)
        low = result.low
        return replace(result, high=result.high.up(), low=None if low is None else low.down())

    def cut(self, base: Growth) -> None:
        """Reject a base that may reach the cut of roots and logarithms."""
        if self.holomorphic and not base.right:
            raise UnboundedError


def _product(region: Region, node: sp.Expr) -> Growth:
    parts = [region.growth(factor) for factor in node.args]
    result = parts[0]
    for part in parts[1:]:
        low = None if result.low is None or part.low is None else result.low.times(part.low)
        right = (result.positive and part.right) or (result.right and part.positive)
        result = Growth(result.high.times(part.high), low, result.real and part.real, right)
    return result


def _sum(region: Region, node: sp.Expr) -> Growth:
    T, parts = region.T, [region.growth(term) for term in node.args]
    k = max(part.high.k for part in parts)
    c = parts[0].high.c
    for part in parts:
        c = part.high.c.max(c)
    total = arb(0)
    for part in parts:
        # both y^(k_i - k) and e^((c_i - c) y) decrease
        total += Power(part.high.C, part.high.k - k, part.high.c - c).at(T)
    result = Growth(
        Power(arb(total.upper()), k, c),
        None,
        all(part.real for part in parts),
        all(part.right for part in parts),
    )
    steepest = sorted(range(len(parts)), key=lambda i: (-float(parts[i].high.c), -parts[i].high.k))
    return next(filter(None, (_dominated(T, parts, i, result) for i in steepest)), result)


def _dominated(T: arb, parts: list[Growth], index: int, total: Growth) -> Growth | None:
    """Return the bounds of a sum of which one term exceeds the rest; None if it does not."""
    own = parts[index].low
    if own is None:
        return None
    rest, others = arb(0), [p for i, p in enumerate(parts) if i != index]
    if not (total.positive and all(part.positive for part in others)):
        for part in others:
            ratio = Power(part.high.C, part.high.k - own.k, part.high.c - own.c)
            if not bool(ratio.c * T + float(ratio.k) <= 0) or not bool(ratio.c <= 0):
                return None
            rest += ratio.at(T)
    elif any(not bool(p.high.c <= own.c) for p in others):
        return None
    left = own.C - rest
    if not bool(left > 0):
        return None
    right = total.right or parts[index].positive
    return replace(total, low=replace(own, C=arb(left.lower())), right=right)


def _power(region: Region, node: sp.Pow) -> Growth:
    if not isinstance(node.exp, sp.Rational):
        if node.base.has(region.variable):
            raise UnboundedError
        return _exponential(region, sp.exp(node.exp * sp.log(node.base), evaluate=False))
    base, n = region.growth(node.base), Fraction(int(node.exp.p), int(node.exp.q))
    if n.denominator != 1:
        region.cut(base)
    if n < 0 and base.low is None:
        raise UnboundedError
    high, low = (base.high, base.low) if n > 0 else (base.low, base.high)
    assert high is not None
    right = base.positive or (base.right and abs(n) <= 1)
    real = base.real and (n.denominator == 1 or base.positive)
    even = real and n.denominator == 1 and n.numerator % 2 == 0 and base.low is not None
    return Growth(high.to(n), None if low is None else low.to(n), real, right or even)


def _linear(region: Region, node: sp.Expr, part: Callable[[acb], arb]) -> tuple[arb, arb]:
    """Return alpha and beta: a part of an expression is at most alpha + beta y.

    Raises
    ------
    UnboundedError
        If it may grow faster.
    """
    alpha, beta, T = arb(0), arb(0), region.T
    for term in sp.Add.make_args(sp.expand_mul(node)):
        outer, inner = term.as_independent(region.variable, as_Add=False)
        size = part(region.enclose(outer, region.values))
        growth = region.growth(inner)
        if not growth.positive:
            size, growth = abs(acb(region.enclose(outer, region.values))), growth
        high, low = growth.high, growth.low
        if bool(size <= 0):
            # y^(k - 1) e^(c y) rises from T on
            if low is not None and bool(low.c >= 0) and bool(low.c * T + float(low.k) >= 1):
                beta += size * low.at(T) / T
        elif bool(high.c <= 0) and high.k <= 0:
            alpha += size * high.at(T)
        elif bool(high.c <= 0) and high.k <= 1:
            beta += size * high.at(T) / T
        else:
            raise UnboundedError
    return alpha, beta


def _exponential(region: Region, node: sp.Expr) -> Growth:
    exponent = node.args[0]
    alpha, beta = _linear(region, exponent, lambda z: z.real)
    high = Power(arb(alpha.exp().upper()), Fraction(0), arb(beta.upper()))
    try:
        alpha, beta = _linear(region, -exponent, lambda z: z.real)
        low = Power(arb((-alpha).exp().lower()), Fraction(0), arb((-beta).lower()))
    except UnboundedError:
        low = None
    real = region.growth(exponent).real
    return Growth(high, low, real, real)


def _logarithm(region: Region, node: sp.Expr) -> Growth:
    base = region.growth(node.args[0])
    region.cut(base)
    if base.low is None:
        raise UnboundedError
    slope = sum(
        (abs(p.C.log()) / region.T + abs(p.c) + abs(float(p.k)) for p in (base.high, base.low)),
        arb.pi() / region.T,
    )
    return Growth(Power(arb(slope.upper()), Fraction(1), arb(0)), None, base.positive, False)


def _oscillating(region: Region, node: sp.Expr) -> Growth:
    """Return the bounds of sin, cos or J_n: at most e^|Im z|."""
    order, argument = (node.args[0], node.args[1]) if len(node.args) == 2 else (None, node.args[0])
    inner = region.growth(argument)
    small = None
    if isinstance(node, sp.sin):
        small = small_argument(1, arb(1), lambda z: _over(z.sinh(), z))(inner, region.T)
    elif isinstance(node, sp.besselj) and order is not None:
        if not (order.is_Integer and order >= 0):
            raise UnboundedError
        n = int(order)
        factor = arb(1) / (arb(2) ** n * arb(n + 1).gamma())
        small = small_argument(n, factor, lambda z: (z**2 / 4).exp())(inner, region.T)
    if small is not None:
        return small
    alpha = beta = arb(0)
    if not inner.real:
        alpha, beta = _linear(region, argument, lambda z: abs(z.imag))
    return Growth(Power(alpha.exp(), Fraction(0), beta), None, inner.real, False)


def _over(a: arb, b: arb) -> arb:
    return a / b if bool(b > 0) else arb(1)


def _hyperbolic(region: Region, node: sp.Expr) -> Growth:
    """Return the bounds of sinh or cosh, which near 0 is like its argument or 1."""
    inner = region.growth(node.args[0])
    if isinstance(node, sp.sinh):
        small = small_argument(1, arb(1), lambda z: _over(z.sinh(), z))(inner, region.T)
    else:
        small = small_argument(0, arb(1), lambda z: z.cosh())(inner, region.T)
    return small if small is not None else region.growth(node.rewrite(sp.exp))


def _bessel_i(region: Region, node: sp.Expr) -> Growth:
    """Return the bounds of I_n: at most e^|Re z|.

    For x >= 1, I_0(x) is at least e^x/(4 sqrt x), and I_n(x)/I_(n-1)(x) at least 1/(2 n + 1).
    """
    order, argument = node.args
    if not (order.is_Integer and order >= 0):
        raise UnboundedError
    inner, n = region.growth(argument), int(order)
    factor = arb(1) / (arb(2) ** n * arb(n + 1).gamma())
    small = small_argument(n, factor, lambda z: (z**2 / 4).exp())(inner, region.T)
    if small is not None:
        return small
    alpha, beta = _linear(region, argument, lambda z: abs(z.real))
    low = None
    if inner.positive and inner.low is not None and _at_least_one(inner.low, region.T):
        least = sp.exp(argument) / (4 * sp.sqrt(argument) * sp.factorial2(2 * n + 1))
        low = region.growth(least).low
    return Growth(Power(alpha.exp(), Fraction(0), beta), low, inner.real, inner.positive)


def _at_least_one(low: Power, T: arb) -> bool:
    return bool(low.c >= 0) and low.k >= 0 and bool(low.at(T) >= 1)


def _bessel_k(region: Region, node: sp.Expr) -> Growth:
    """Return the bounds of K_n at positive numbers.

    K_n(x) is at most sqrt(pi/(2 x)) e^(-x + n^2/(2 x)), and for n > 0 at most 2^(n-1) (n-1)! x^-n.
    """
    order, x = node.args
    if not (order.is_Integer and order >= 0 and region.growth(x).positive):
        raise UnboundedError
    high = region.growth(x).high
    if order > 0 and high.k <= 0 and bool(high.c <= 0):
        return replace(
            region.growth(sp.factorial(order - 1) * 2 ** (order - 1) / x**order), low=None
        )
    return replace(
        region.growth(sp.sqrt(sp.pi / (2 * x)) * sp.exp(order**2 / (2 * x) - x)), low=None
    )


def _error_function(region: Region, node: sp.Expr) -> Growth:
    """Return the bounds of erf or erfc at real numbers; erfc x is at most e^(-x^2) for x > 0."""
    inner = region.growth(node.args[0])
    if not inner.real:
        raise UnboundedError
    if isinstance(node, sp.erfc):
        if not inner.positive:
            return Growth(Power(arb(2), Fraction(0), arb(0)), None, True, True)
        return replace(region.growth(sp.exp(-(node.args[0] ** 2))), low=None)
    series = small_argument(1, 2 / arb.pi().sqrt(), lambda z: (z**2).exp())
    one = Growth(Power(arb(1), Fraction(0), arb(0)), None, True, inner.positive)
    return series(inner, region.T) or one


def _quotient(region: Region, node: sp.Expr) -> Growth:
    """Return the bounds of tan, tanh or coth."""
    x = node.args[0]
    above, below = {
        sp.tan: (sp.sin(x), sp.cos(x)),
        sp.tanh: (sp.sinh(x), sp.cosh(x)),
        sp.coth: (sp.cosh(x), sp.sinh(x)),
    }[node.func]
    return region.growth(sp.Mul(above, 1 / below, evaluate=False))


_RULES: dict[type[sp.Basic], Callable[[Region, sp.Expr], Growth]] = {
    sp.Add: _sum,
    sp.Mul: _product,
    sp.exp: _exponential,
    sp.Pow: _power,
    sp.log: _logarithm,
    sp.sin: _oscillating,
    sp.cos: _oscillating,
    sp.besselj: _oscillating,
    sp.besseli: _bessel_i,
    sp.besselk: _bessel_k,
    sp.sinh: _hyperbolic,
    sp.cosh: _hyperbolic,
    sp.tan: _quotient,
    sp.tanh: _quotient,
    sp.coth: _quotient,
    sp.erf: _error_function,
    sp.erfc: _error_function,
}
