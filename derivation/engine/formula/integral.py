"""Integrals in ball arithmetic, with proved error.

Arb integrates between points where the integrand is holomorphic. At any other end e, the range is
substituted as x = e + s w^2, or as x = e + s exp(-y) where the integrand is still singular; an
infinite range as x = a + y or x = a + 1/y. An integral over y to infinity is truncated, with a
bound of its tail from `growth`. Where no bound is found, the ball is not finite.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache

import flint
import sympy as sp
from flint import acb, arb

from derivation.engine.formula.ball import MAX_BITS_OF_INTEGRALS
from derivation.engine.formula.differences import DIFFERENCES, in_products
from derivation.engine.formula.growth import Region
from derivation.engine.formula.hyperbolic import in_exponentials
from derivation.engine.formula.operations import Operation, through_complex
from derivation.engine.formula.power_bound import Growth, Power, UnboundedError, tail
from derivation.engine.formula.tape import Tape, recorded

HINT = (
    "expected an integrand that is finite and smooth inside its range, and like a power, logarithm "
    "or exponential at its ends or at infinity; divide the range at inner singularities, or "
    "substitute, such as x = a*sin(t)"
)
"""What is expected of an integral whose value is not finite, and what to do."""

_SLOPE_BITS = 64
_AROUND_ZERO = acb(arb(0, 1), arb(0, 1)) / 64
"""A region of 1/32 of a range, around its end."""
_HALVINGS = 10
"""Number of points from which the size of an integral is estimated, denser towards its start."""
_LARGEST_RANGE = 1 << 30
_FALLING = Power(arb(1), Fraction(0), arb(-1))
_SAME = Power(arb(1), Fraction(1), arb(0))

Balls = Mapping[sp.Basic, acb]
Part = Callable[[Balls, bool], acb]
"""A function from the symbols' balls to a part of an integral; with the flag, not finite where the
part is not holomorphic in them."""


@lru_cache(maxsize=512)
def integral(node: sp.Integral) -> Operation:
    """Return the operation of an integral, whose operands are its free symbols.

    Raises
    ------
    NotImplementedError
        For an integral without limits, or a part without ball arithmetic.
    """
    function, x, low, high = _innermost_last(node)
    symbols = tuple(sorted(node.free_symbols, key=str))
    parts = _parts(function, x, low, high)

    def value(holomorphic: bool) -> Callable[..., acb]:
        def added(*operands: acb) -> acb:
            known = dict(zip(symbols, operands, strict=True))
            with flint.ctx.workprec(min(flint.ctx.prec, MAX_BITS_OF_INTEGRALS)):
                return sum((part(known, holomorphic) for part in parts), acb(0))

        return added

    @lru_cache(maxsize=1)
    def gradient() -> tuple[sp.Expr, ...]:
        return tuple(_derivative(function, x, low, high, symbol) for symbol in symbols)

    def slopes(_: arb, *operands: arb) -> tuple[arb, ...]:
        with flint.ctx.workprec(_SLOPE_BITS):
            tapes = [recorded(derivative, symbols) for derivative in gradient()]
            return tuple(tape.run(operands)[-1] for tape in tapes)

    return Operation(symbols, through_complex(value(False)), slopes, value(True))


def _innermost_last(node: sp.Integral) -> tuple[sp.Expr, sp.Symbol, sp.Expr, sp.Expr]:
    """Return integrand, variable and limits; the inner integrals are part of the integrand.

    Raises
    ------
    NotImplementedError
        For limits that are missing, or a range outside the assumptions of the variable.
    """
    *inner, outer = node.limits
    if len(outer) != 3:
        raise NotImplementedError(f"no ball arithmetic for an integral without limits in {node}")
    given, low, high = outer
    x = sp.Dummy(given.name, **given.assumptions0)
    if given.is_positive and (low.is_negative or high.is_negative):
        raise NotImplementedError(
            f"no ball arithmetic for {node}: {given} is declared positive, but its range is not"
        )
    function = sp.Integral(node.function, *inner) if inner else node.function
    return function.subs(given, x), x, low, high


def _parts(f: sp.Expr, x: sp.Symbol, low: sp.Expr, high: sp.Expr) -> list[Part]:
    if low is sp.oo or high is sp.S.NegativeInfinity:
        return [_negative(part) for part in _parts(f, x, high, low)]
    if low is sp.S.NegativeInfinity:
        mirrored = sp.Dummy(x.name, real=True)
        rest = _parts(f, x, sp.Integer(0), high) if high is sp.oo else []
        begin = sp.Integer(0) if high is sp.oo else -high
        return [*_parts(f.subs(x, -mirrored), mirrored, begin, sp.oo), *rest]
    if high is sp.oo:
        return [_Finite(f, x, low, low + 1).value, _Infinite(f, x, low).value]
    return [_Finite(f, x, low, high).value]


def _negative(part: Part) -> Part:
    return lambda known, holomorphic: -part(known, holomorphic)


def _derivative(f: sp.Expr, x: sp.Symbol, low: sp.Expr, high: sp.Expr, by: sp.Symbol) -> sp.Expr:
    """Return the derivative with respect to a symbol, as integrals with constant limits."""
    if low is sp.S.NegativeInfinity or low is sp.oo or high is sp.S.NegativeInfinity:
        whole = (x, low, high)
        return sp.Integral(sp.diff(f, by), whole)
    u = sp.Dummy("u", positive=True)
    if high is sp.oo:
        return sp.Integral(_tidy(sp.diff(f.subs(x, low + u), by), u), (u, 0, sp.oo))
    inside = f.subs(x, low + (high - low) * u) * (high - low)
    return sp.Integral(_tidy(sp.diff(_tidy(inside, u), by), u), (u, 0, 1))


@dataclass(frozen=True, eq=False)
class _Finite:
    """Integral over a finite range."""

    f: sp.Expr
    x: sp.Symbol
    low: sp.Expr
    high: sp.Expr

    @cached_property
    def _tape(self) -> tuple[Tape, tuple[sp.Symbol, ...]]:
        return _recorded(self.f, self.x)

    @cached_property
    def _ends(self) -> tuple["_End", ...]:
        """The left and the right half as integrals over v from 0 to 1, from either end."""
        half = (self.high - self.low) / 2
        v = sp.Dummy("v", positive=True)
        return tuple(
            _End(_tidy(self.f.subs(self.x, end) * half, v), v)
            for end in (self.low + half * v, self.high - half * v)
        )

    def value(self, known: Balls, holomorphic: bool) -> acb:
        """Return the integral at the current precision."""
        tape, symbols = self._tape
        own = [acb(known[symbol]) for symbol in symbols]
        low, high = (acb(_enclose(limit, known, holomorphic)) for limit in (self.low, self.high))
        width = high - low
        if not width.is_finite() or width.is_zero():
            return width
        regular = [
            tape.run([*own, end + width * _AROUND_ZERO], True)[-1].is_finite()
            for end in (low, high)
        ]

        def f(u: acb, analytic: bool) -> acb:
            return acb(tape.run([*own, low + width * u], analytic or holomorphic)[-1])

        if all(regular):
            return width * _integrated(f, arb(0), arb(1), known)
        total, half = acb(0), arb(0.5)
        for fine, end, begin in zip(regular, self._ends, (arb(0), half), strict=True):
            if fine:
                total += width * _integrated(f, begin, begin + half, known)
            else:
                total += end.value(known, holomorphic)
        return total


@dataclass(frozen=True, eq=False)
class _End:
    """Integral over v from 0 to 1, where the integrand may be singular at 0."""

    form: sp.Expr
    v: sp.Symbol

    @cached_property
    def _tape(self) -> tuple[Tape, tuple[sp.Symbol, ...]]:
        """The integrand over w, with v = w^2."""
        w = sp.Dummy("w", positive=True)
        terms = sp.Add.make_args(self.form)
        return _recorded(sp.Add(*(term.subs(self.v, w**2) * 2 * w for term in terms)), w)

    @cached_property
    def _decaying(self) -> "_Decaying":
        return _Decaying(self.form * self.v, self.v, at_end=True)

    def value(self, known: Balls, holomorphic: bool) -> acb:
        """Return the integral at the current precision."""
        tape, symbols = self._tape
        own = [acb(known[symbol]) for symbol in symbols]

        def f(w: acb, analytic: bool) -> acb:
            return acb(tape.run([*own, w], analytic or holomorphic)[-1])

        if f(_AROUND_ZERO, True).is_finite():
            return _integrated(f, arb(0), arb(1), known)
        return self._decaying.value(known, holomorphic)


@dataclass(frozen=True, eq=False)
class _Infinite:
    """Integral from low + 1 to infinity."""

    f: sp.Expr
    x: sp.Symbol
    low: sp.Expr

    @cached_property
    def _decaying(self) -> "_Decaying":
        """The integral over y = x - low."""
        return _Decaying(_tidy(self.f.subs(self.x, self.low + self._v), self._v), self._v)

    @cached_property
    def _cancelled(self) -> "_Decaying":
        """The same integral, with the integrand as a fraction."""
        return _Decaying(_fraction(self.f.subs(self.x, self.low + self._v)), self._v)

    @cached_property
    def _inverse(self) -> _Finite:
        """The integral over 1/y."""
        form = self.f.subs(self.x, self.low + 1 / self._v) / self._v**2
        return _Finite(_tidy(form, self._v), self._v, sp.Integer(0), sp.Integer(1))

    @cached_property
    def _v(self) -> sp.Symbol:
        return sp.Dummy("v", positive=True)

    def value(self, known: Balls, holomorphic: bool) -> acb:
        """Return the integral at the current precision."""
        result = self._decaying.value(known, holomorphic)
        if not result.is_finite():
            result = self._cancelled.value(known, holomorphic)
        return result if result.is_finite() else self._inverse.value(known, holomorphic)


@dataclass(frozen=True, eq=False)
class _Decaying:
    """Integral over v = y from 1 to infinity, or, at an end, over v = exp(-y) from 0 to 1."""

    form: sp.Expr
    v: sp.Symbol
    at_end: bool = False

    @cached_property
    def _tape(self) -> tuple[Tape, tuple[sp.Symbol, ...]]:
        y = sp.Dummy("y", real=True)
        return _recorded(self.form.subs(self.v, sp.exp(-y) if self.at_end else y), y)

    def value(self, known: Balls, holomorphic: bool) -> acb:
        """Return the integral at the current precision."""
        truncation = self._truncation(known, holomorphic)
        if truncation is None:
            return acb(arb.nan())
        end, rest = truncation
        tape, symbols = self._tape
        own = [acb(known[symbol]) for symbol in symbols]

        def f(y: acb, analytic: bool) -> acb:
            return acb(tape.run([*own, y], analytic or holomorphic)[-1])

        radius = arb(0, rest.upper())
        return _integrated(f, arb(0 if self.at_end else 1), end, known) + acb(radius, radius)

    def _truncation(self, known: Balls, holomorphic: bool) -> tuple[arb, arb] | None:
        """Return an end of the range, and a bound of the tail; None if none is found."""
        first: arb | None = None
        best: tuple[arb, arb] | None = None
        T = arb(2)
        while bool(T < _LARGEST_RANGE):
            try:
                rest = arb(
                    tail(self._region(known, T, holomorphic).growth(self.form).high, T).upper()
                )
            except UnboundedError:
                T = arb((T * 2).mid())
                continue
            if rest.is_finite():
                first = rest if first is None else first
                best = T, rest
                if bool(rest <= first * arb(2) ** -_bits(known)):
                    break
            T = arb((T * 1.5).mid())
        return best

    def _region(self, known: Balls, T: arb, holomorphic: bool) -> Region:
        own = _FALLING if self.at_end else _SAME
        values = {symbol: acb(ball) for symbol, ball in known.items()}
        if self.at_end:
            values[self.v] = acb(arb(0).union((-T).exp()))
        variable = Growth(own, own, real=True, right=True)
        return Region(
            self.v, variable, values, T, holomorphic, lambda e, at: _enclose(e, at, holomorphic)
        )


def _bits(known: Balls) -> int:
    """Return the relative accuracy that is possible with the symbols' balls."""
    accuracies = (int(acb(ball).rel_accuracy_bits()) + 8 for ball in known.values())
    return max(8, min(int(flint.ctx.prec), *accuracies, MAX_BITS_OF_INTEGRALS))


def _integrated(f: Callable[[acb, bool], acb], low: arb, high: arb, known: Balls) -> acb:
    """Return Arb's integral of a function, as accurate as the symbols' balls allow."""
    bits, size, width = _bits(known), arb(0), high - low
    real = all(bool(acb(ball).imag == 0) for ball in known.values())
    for _ in range(_HALVINGS):
        width /= 2
        value = f(acb(low + width), False)
        if real and not value.imag.contains(0):
            return acb(arb.nan())  # it is quicker to find this here than to integrate
        size += width * value.abs_upper()
    tolerance = arb(2) ** -bits
    return acb.integral(
        f,
        acb(low),
        acb(high),
        rel_tol=tolerance,
        abs_tol=(size * tolerance).mid() if size.is_finite() else arb(0),
        eval_limit=200 * bits + 400,
    )


def _recorded(expression: sp.Expr, x: sp.Symbol) -> tuple[Tape, tuple[sp.Symbol, ...]]:
    """Return the tape of an expression, and its symbols other than x, which is the last input."""
    others = tuple(sorted(expression.free_symbols - {x}, key=str))
    return recorded(expression, (*others, x)), others


def _enclose(expression: sp.Expr, values: Balls, holomorphic: bool) -> acb:
    symbols = tuple(sorted(expression.free_symbols, key=str))
    tape = recorded(expression, symbols)
    return acb(tape.run([acb(values[symbol]) for symbol in symbols], holomorphic)[-1])


def _tidy(expression: sp.Expr, v: sp.Symbol) -> sp.Expr:
    """Return an expression with powers of v > 0 factored out of roots and logarithms.

    Then no root of it has a branch point at v = 0, and v cancels between factors. 1 - cos u and
    similar differences become products.
    """
    expression = expression.replace(
        lambda node: node.is_Add, lambda node: in_products(node, DIFFERENCES)
    )
    expression = expression.replace(
        lambda node: (
            node.is_Pow and node.base.has(v) and not (node.exp.is_Integer and node.exp > 0)
        ),
        lambda node: _factored(node.base) ** node.exp,
    )
    return expression.replace(sp.log, lambda base: sp.expand_log(sp.log(_factored(base))))


def _fraction(expression: sp.Expr) -> sp.Expr:
    """Return a sum as one fraction in exponentials, so that terms that do not decay cancel."""
    above, below = sp.fraction(sp.together(in_exponentials(expression)))
    return sp.expand(above) / sp.expand(below)


def _factored(base: sp.Expr) -> sp.Expr:
    return base if base.is_Symbol else sp.factor(sp.expand(base))
