"""Operations of expressions: the value of each SymPy function in balls, and its derivatives.

Balls of an expression, its gradient and its values in doubles use these operations.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import cast

import flint
import sympy as sp
from flint import acb, arb
from sympy.codegen.cfunctions import expm1, log1p

Unary = tuple[Callable[[arb], arb], Callable[[arb, arb], arb]]
"""A function, and its derivative as a function of argument and value."""


def through_complex(function: Callable[..., acb]) -> Callable[..., arb]:
    """Return a function of complex balls for real ones too; NaN where it is not real there."""

    def value(*operands: arb) -> arb:
        result = function(*map(acb, operands))
        if any(isinstance(operand, acb) for operand in operands):
            return result
        return result.real if result.imag.contains(0) else arb.nan()

    return value


_elliptic_k = through_complex(lambda m: m.elliptic_k())
_elliptic_e = through_complex(lambda m: m.elliptic_e())

FUNCTIONS: dict[type[sp.Basic], Unary] = {
    sp.sin: (lambda x: x.sin(), lambda x, _: x.cos()),
    sp.cos: (lambda x: x.cos(), lambda x, _: -x.sin()),
    sp.tan: (lambda x: x.tan(), lambda x, _: x.sec() ** 2),
    sp.sinh: (lambda x: x.sinh(), lambda x, _: x.cosh()),
    sp.cosh: (lambda x: x.cosh(), lambda x, _: x.sinh()),
    sp.tanh: (lambda x: x.tanh(), lambda x, _: x.sech() ** 2),
    sp.coth: (lambda x: x.coth(), lambda x, _: -(x.csch() ** 2)),
    sp.log: (lambda x: x.log(), lambda x, _: 1 / x),
    log1p: (lambda x: x.log1p(), lambda x, _: 1 / (1 + x)),
    expm1: (lambda x: x.expm1(), lambda x, _: x.exp()),
    sp.exp: (lambda x: x.exp(), lambda _, value: value),
    sp.asin: (lambda x: x.asin(), lambda x, _: 1 / (1 - x**2).sqrt()),
    sp.acos: (lambda x: x.acos(), lambda x, _: -1 / (1 - x**2).sqrt()),
    sp.atan: (lambda x: x.atan(), lambda x, _: 1 / (1 + x**2)),
    sp.asinh: (lambda x: x.asinh(), lambda x, _: 1 / (1 + x**2).sqrt()),
    sp.acosh: (lambda x: x.acosh(), lambda x, _: 1 / (x**2 - 1).sqrt()),
    sp.atanh: (lambda x: x.atanh(), lambda x, _: 1 / (1 - x**2)),
    sp.erf: (lambda x: x.erf(), lambda x, _: 2 * (-(x**2)).exp() / arb.pi().sqrt()),
    sp.erfc: (lambda x: x.erfc(), lambda x, _: -2 * (-(x**2)).exp() / arb.pi().sqrt()),
    sp.elliptic_k: (
        _elliptic_k,
        lambda m, K: (_elliptic_e(m) / (1 - m) - K) / (2 * m),
    ),
    sp.elliptic_e: (_elliptic_e, lambda m, E: (E - _elliptic_k(m)) / (2 * m)),
    sp.Abs: (abs, lambda x, _: x.sgn()),
    sp.gamma: (lambda x: x.gamma(), lambda x, value: value * x.digamma()),
}


@dataclass(frozen=True)
class Operation:
    """Operation at a node of an expression.

    Parameters
    ----------
    operands
        The operands.
    value
        Function from the operands' balls to the node's ball, at the current precision.
    slopes
        Function from the node's and the operands' balls to the derivatives by each operand.
    holomorphic
        Like `value`, for complex operands, but not finite where the node is not holomorphic in
        them; None for `value` itself.
    """

    operands: tuple[sp.Basic, ...]
    value: Callable[..., arb]
    slopes: Callable[..., tuple[arb, ...]]
    holomorphic: Callable[..., acb] | None = None


class DecimalError(NotImplementedError, ValueError):
    """An expression contains a rounded number; the message states how to write it exactly."""


def exact_number(number: sp.Float) -> str:
    """Return how to write a rounded number exactly, as part of a message."""
    return f"write sp.Rational({repr(float(number))!r})"


def operation(node: sp.Basic) -> Operation:
    """Return the operation at a node of an expression.

    Raises
    ------
    NotImplementedError
        For a function or constant that is not implemented in ball arithmetic.
    DecimalError
        For a floating-point number, which is not exact.
    """
    if isinstance(node, sp.Rational):
        number = flint.fmpq(int(node.p), int(node.q))
        return _constant(lambda: arb(number))
    if isinstance(node, sp.Float):
        raise DecimalError(f"expected exact numbers, got {float(node)!r}; {exact_number(node)}")
    if node in _CONSTANTS:
        return _constant(_CONSTANTS[node])
    if isinstance(node, sp.Add):
        return Operation(node.args, _sum, lambda _, *terms: (arb(1),) * len(terms))
    if isinstance(node, sp.Mul):
        return Operation(node.args, _product, _product_slopes)
    if isinstance(node, sp.Pow):
        return _power(node)
    if type(node) in _OF_TWO:
        value, slopes = _OF_TWO[type(node)]
        cut = _CUTS.get(type(node))
        return Operation(node.args, value, slopes, cut and _guarded(value, cut))
    if node.func in FUNCTIONS:
        function, slope = FUNCTIONS[node.func]
        cut, apart = _CUTS.get(node.func), node.func is sp.Abs
        return Operation(
            node.args,
            function,
            lambda value, x: (slope(x, value),),
            _real_abs if apart else cut and _guarded(function, cut),
        )
    if isinstance(node, sp.Integral):
        from derivation.engine.formula.integral import integral  # integrands are expressions too

        return integral(node)
    raise NotImplementedError(f"no ball arithmetic for {node.func.__name__} in {node}")


_CONSTANTS: dict[sp.Basic, Callable[[], arb]] = {
    sp.pi: arb.pi,
    sp.E: arb.const_e,
    sp.EulerGamma: arb.const_euler,
}


_CUTS: dict[type[sp.Basic], Callable[..., arb]] = {
    sp.log: lambda x: x,
    log1p: lambda x: 1 + x,
    sp.asin: lambda x: 1 - x**2,
    sp.acos: lambda x: 1 - x**2,
    sp.atan: lambda x: 1 + x**2,
    sp.asinh: lambda x: 1 + x**2,
    sp.acosh: lambda x: x - 1,
    sp.atanh: lambda x: 1 - x**2,
    sp.elliptic_k: lambda m: 1 - m,
    sp.elliptic_e: lambda m: 1 - m,
    sp.besselj: lambda n, x: _cut_of_order(n, x),
    sp.besseli: lambda n, x: _cut_of_order(n, x),
    sp.bessely: lambda _, x: x,
    sp.besselk: lambda _, x: x,
}
"""For functions with branch cuts, a function that is negative or zero on each cut only."""


def _cut_of_order(n: arb, x: arb) -> arb:
    """Return x, or 1 for an integer order, for which the Bessel functions have no cut."""
    return arb(1) if n.is_exact() and n.contains_integer() else x


def _guarded(value: Callable[..., arb], cut: Callable[..., arb]) -> Callable[..., acb]:
    """Return a function that is not finite where a complex ball may meet a cut."""

    def guarded(*operands: acb) -> acb:
        away = acb(cut(*operands)).log(analytic=True).is_finite()
        return acb(value(*operands)) if away else acb(arb.nan())

    return guarded


def _real_abs(x: acb) -> acb:
    """Return the holomorphic function that is |x| for real x."""
    return cast("acb", acb(x).real_abs(analytic=True))


def _constant(value: Callable[[], arb]) -> Operation:
    return Operation((), value, lambda _: ())


def _sum(first: arb, *terms: arb) -> arb:
    return sum(terms, first)


def _product(first: arb, *factors: arb) -> arb:
    return math.prod(factors, start=first)


def _square_root(x: arb) -> arb:
    return x.sqrt()


PARTIAL = frozenset(
    (
        _square_root,
        *(FUNCTIONS[each][0] for each in (sp.log, log1p, sp.asin, sp.acos, sp.acosh, sp.atanh)),
    )
)
"""Functions whose ball is NaN for an exact number, at any precision, if they have no real value."""


def _product_slopes(_: arb, *factors: arb) -> tuple[arb, ...]:
    # Products of the others, not value/factor: a factor may be zero.
    return tuple(_product(*factors[:i], *factors[i + 1 :]) for i in range(len(factors)))


def _power(node: sp.Pow) -> Operation:
    base, exponent = node.args
    if isinstance(exponent, sp.Integer):
        n = int(exponent)
        return Operation((base,), lambda x: x**n, lambda _, x: (n * x ** (n - 1),))
    if exponent == sp.Rational(1, 2):
        return Operation(
            (base,),
            _square_root,
            lambda value, _: (1 / (2 * value),),
            lambda x: acb(x).sqrt(analytic=True),
        )
    return Operation(
        (base, exponent),
        lambda x, y: x**y,
        lambda value, x, y: (y * x ** (y - 1), value * x.log()),
        lambda x, y: acb(x).pow(y, analytic=True),
    )


def _bessel_slopes(
    sign: int, function: Callable[[arb, arb], arb]
) -> Callable[..., tuple[arb, ...]]:
    """Return the derivative by the argument; that by the order is unknown and is NaN."""
    return lambda _, n, x: (arb.nan(), (function(x, n - 1) + sign * function(x, n + 1)) / 2)


def _beta_slopes(value: arb, x: arb, y: arb) -> tuple[arb, arb]:
    common = (x + y).digamma()
    return value * (x.digamma() - common), value * (y.digamma() - common)


def _bessel(
    sign: int, function: Callable[[arb, arb], arb], turned: int = 1
) -> tuple[Callable[[arb, arb], arb], Callable[..., tuple[arb, ...]]]:
    """Return a Bessel function of order and argument, and its derivatives.

    A wide argument is evaluated with no more bits than it allows: at 100 bits, Arb needs half a
    second for I_1 of one, and integration evaluates thousands of them. Where the derivative is
    zero, the error of the value is the square of that of the argument.
    """

    def value(n: arb, x: arb) -> arb:
        bits = 2 * int(x.rel_accuracy_bits()) + _SPARE_BITS
        if bits >= flint.ctx.prec or not abs(x) > 1:
            return function(x, n)
        with flint.ctx.workprec(max(bits, _LEAST_BITS)):
            return function(x, n)

    return value, _bessel_slopes(sign, lambda x, n: turned * function(x, n))


_SPARE_BITS, _LEAST_BITS = 32, 53

_OF_TWO: dict[type[sp.Basic], tuple[Callable[..., arb], Callable[..., tuple[arb, ...]]]] = {
    sp.besselj: _bessel(-1, lambda x, n: x.bessel_j(n)),
    sp.besseli: _bessel(1, lambda x, n: x.bessel_i(n)),
    sp.bessely: _bessel(-1, lambda x, n: x.bessel_y(n)),
    sp.besselk: _bessel(1, lambda x, n: x.bessel_k(n), -1),
    sp.beta: (lambda x, y: x.gamma() * y.gamma() / (x + y).gamma(), _beta_slopes),
}
