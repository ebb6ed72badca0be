"""Proofs: residuals are reduced to zero symbolically, or contain zero in ball arithmetic.

Ball arithmetic is evidence at points: of every sign that the assumptions of a symbol allow, and of
magnitudes from 1e-90 to 1e90, because a residual may vanish, or almost vanish, in one range only.
"""

import random
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import islice

import flint
import sympy as sp

from derivation.engine.failed import FailedError
from derivation.engine.formula.ball import enclose, to_ball
from derivation.engine.formula.hyperbolic import in_exponentials
from derivation.engine.formula.notation import to_markdown

SYMBOLIC = "symbolically"
BY_BALLS = "by ball arithmetic at two precisions"
_PRECISIONS = (256, 1024)
_PRECISIONS_OF_INTEGRALS = (80, 160)
_POINTS, _MOST_POINTS = 12, 120
"""Number of points at which a residual is evaluated, and the number while most are outside its
domain."""
_FAR = (36, 30), (12, 300)
"""Numbers of further points, and the largest binary exponents of their coordinates."""
_FAR_OF_INTEGRALS = ((8, 3),)
_CHANGE = sp.Rational(1, 997)
"""Relative change of a claim, which a residual must show."""
Residuals = Mapping[str, sp.Expr]


class ProofError(FailedError):
    """A step of the derivation fails; the message states the step and the residual."""


@dataclass(frozen=True)
class Proof:
    """A proved step.

    Parameters
    ----------
    step, argument, residuals, method
        Name, reasoning, labels of the residuals, and how they were reduced to zero.
    determines
        Whether the residuals are known to determine the claims.
    claims
        The proved expressions; a formula with this proof must have one of them. A proof that is
        read from the cache does not contain them: its formulas were compared when they were made.
    """

    step: str
    argument: str
    residuals: tuple[str, ...]
    method: str
    determines: bool = False
    claims: tuple[sp.Expr, ...] = field(
        default=(), compare=False, repr=False, metadata={"cached": False}
    )

    def _repr_markdown_(self) -> str:
        """Return the step, its argument and its residuals, for a notebook."""
        vanish, argument = (to_markdown(s) for s in (", ".join(self.residuals), self.argument))
        return f"**{self.step}.** {argument} Reduced to zero {self.method}: {vanish}."


def prove(
    step: str,
    argument: str,
    residuals: Residuals | Callable[..., Residuals],
    *claims: sp.Expr,
) -> Proof:
    """Prove that every residual is zero.

    With `claims`, check that the residuals determine these expressions: a claim that is multiplied
    by a constant or by a function of one of its symbols must leave a residual, not only at a fixed
    value of this symbol. Formulas with this proof must have one of the claims as their expression.

    Parameters
    ----------
    step
        Name of the step.
    argument
        The reasoning in a sentence.
    residuals
        Expressions that must vanish identically, by label; with claims, a function of the claims
        that returns them.
    claims
        The expressions that are proved.

    Returns
    -------
    Proof
        The step with its labels; its method is by balls if one of the residuals needed it.

    Raises
    ------
    ProofError
        If a residual does not vanish; the message states step, label and residual. If the residuals
        vanish for another claim too; the message states it.
    TypeError
        If a residual is no expression.
    ValueError
        If there are no residuals.
    """
    given = residuals(*claims) if callable(residuals) else residuals
    if not given:
        raise ValueError(
            f"{step}: expected residuals, which are reduced to zero, got none; "
            'write for example {"equilibrium": left - right}'
        )
    methods = set()
    for label, one in given.items():
        residual = _as_expression(step, label, one)
        method = decide_zero(residual)
        if method is None:
            raise ProofError(
                f"{step}: {label} leaves the residual {sp.sstr(residual):.300}{_where(residual)}"
            )
        methods.add(method)
    method = BY_BALLS if BY_BALLS in methods else SYMBOLIC
    if not callable(residuals):
        return Proof(step, argument, tuple(given), method)
    for number in range(len(claims)):
        _expect_determined(step, residuals, claims, number)
    return Proof(step, argument, tuple(given), method, bool(claims), claims)


def _expect_determined(
    step: str, residuals: Callable[..., Residuals], claims: tuple[sp.Expr, ...], number: int
) -> None:
    """Raise ProofError if the residuals vanish even if one claim is multiplied by a function.

    The function is constant or linear in a symbol. In the second case a residual at a fixed value
    of this symbol, whose response is that to a constant, does not count. Of an integral, the
    integrand is multiplied.
    """
    claim = claims[number]
    inner = claim.function if isinstance(claim, sp.Integral) else claim

    def changed(factor: sp.Expr) -> list[sp.Expr]:
        other = claim * factor if inner is claim else claim.func(inner * factor, *claim.limits)
        given = residuals(*claims[:number], other, *claims[number + 1 :])
        return [sp.sympify(residual) for residual in given.values()]

    scaled = changed(1 + _CHANGE)
    for symbol in (None, *sorted(inner.free_symbols, key=str)):
        if symbol is None:
            noticed, at = any(map(_is_not_zero, scaled)), ""
        else:
            pairs = zip(changed(1 + _CHANGE * symbol), scaled, strict=True)
            noticed = any(_depends(one, symbol, other) for one, other in pairs)
            at = f" at every {symbol}"
        if not noticed:
            raise ProofError(
                f"{step}: expected residuals that determine {sp.sstr(claim):.100}{at}, but they "
                f"vanish too if it is multiplied by {1 + _CHANGE * (symbol or 1)}; add a residual "
                "that contains it, such as its difference to what it must equal"
            )


def _is_not_zero(residual: sp.Expr) -> bool:
    """Return whether a residual is different from zero at a point; without balls, if expanded."""
    if residual == 0:
        return False
    try:
        return any(_excludes_zero(residual, values) for values in _few_points(residual))
    except NotImplementedError:
        return not reduces_to_zero(residual)


def _depends(residual: sp.Expr, symbol: sp.Symbol, scaled: sp.Expr) -> bool:
    """Return whether a residual is no constant times `scaled`, the response to a constant."""
    if not _is_not_zero(residual):
        return False
    if symbol in residual.free_symbols or not _is_not_zero(scaled):
        return True
    first = None
    for values in _few_points(residual, scaled):
        ratio = next(_balls(residual, values)) / next(_balls(scaled, values))
        first = ratio if first is None and ratio.is_finite() else first
        if first is not None and not ratio.overlaps(first):
            return True
    return False


def _few_points(*expressions: sp.Expr) -> list[dict[sp.Symbol, Fraction]]:
    """Return points for expressions of which some may be outside their domain at a point."""
    symbols = set[sp.Symbol]().union(*(one.free_symbols for one in expressions))
    integral = any(one.has(sp.Integral) for one in expressions)
    return sample_points(symbols, _POINTS // 2 if integral else 4 * _POINTS)


def _as_expression(step: str, label: str, residual: object) -> sp.Expr:
    """Return a residual; an integer is an expression too, but a truth value is not."""
    if isinstance(residual, int) and not isinstance(residual, bool):
        return sp.Integer(residual)
    if isinstance(residual, sp.Expr):
        return residual
    raise TypeError(
        f"{step}: expected an expression that vanishes as {label}, got a "
        f"{type(residual).__name__}; write the difference of both sides of an equation"
    )


def decide_zero(expression: sp.Expr, positive: Iterable[sp.Expr] = ()) -> str | None:
    """Return the method by which an expression was found to be zero; None if it is not zero.

    Far points at which one of the expressions `positive` is not positive are left out.

    Balls are evaluated first: if one excludes zero, the expansion, which can be slow, is avoided.
    If the expansion does not give zero, but all balls contain zero, at `far_points` too, the method
    is `BY_BALLS`.
    """
    if expression.is_zero:
        return SYMBOLIC
    if not balls_contain_zero(expression):
        return None
    if reduces_to_zero(expression):
        return SYMBOLIC
    conditions = tuple(positive)
    for values in _far_points_of(expression, conditions):
        if all(_is_positive(one, values) for one in conditions) and _excludes_zero(
            expression, values
        ):
            return None
    return BY_BALLS


def reduces_to_zero(expression: sp.Expr) -> bool:
    """Return whether expansion over a common denominator, with exponentials, gives zero."""
    rewritten = in_exponentials(lower_bessel(expression))
    numerator = sp.numer(sp.together(rewritten))
    return bool(sp.expand(sp.powsimp(sp.expand(numerator))) == 0)


def lower_bessel(expression: sp.Expr) -> sp.Expr:
    """Return the expression with J_n and I_n, n >= 2 or n < 0, in terms of orders 0 and 1."""
    for kind, sign in ((sp.besselj, -1), (sp.besseli, 1)):
        expression = expression.replace(kind, _lowered(kind, sign))
    return expression


def _lowered(kind: type[sp.Function], sign: int) -> Callable[[sp.Expr, sp.Expr], sp.Expr]:
    """Return the function that lowers the order by Z_n = sign (Z_(n-2) - 2 (n - 1)/x Z_(n-1))."""

    def step(order: sp.Expr, x: sp.Expr) -> sp.Expr:
        if order.is_Integer and order < 0:
            return sign**order * kind(-order, x)
        if order.is_Integer and order >= 2:
            return sign * (step(order - 2, x) - 2 * (order - 1) / x * step(order - 1, x))
        return kind(order, x)

    return step


def balls_contain_zero(expression: sp.Expr) -> bool:
    """Return whether every finite ball, at random points and both precisions, contains zero.

    Points outside the expression's domain give no finite ball and are ignored; there must be finite
    balls at two points or more.
    """
    inside, integral = 0, expression.has(sp.Integral)
    most = _POINTS // 2 if integral else _MOST_POINTS
    for number, values in enumerate(sample_points(expression.free_symbols, most)):
        if number >= _POINTS and inside >= 2 * len(_PRECISIONS):
            break
        for ball in _balls(expression, values):
            if ball.is_finite() and not ball.contains(0):
                return False
            inside += ball.is_finite()
    return inside >= 2 * len(_PRECISIONS)


def _balls(expression: sp.Expr, values: Mapping[sp.Symbol, Fraction]) -> Iterator[flint.arb]:
    """Yield the balls of an expression at both precisions, the smaller one first."""
    for bits in _PRECISIONS_OF_INTEGRALS if expression.has(sp.Integral) else _PRECISIONS:
        with flint.ctx.workprec(bits):
            yield enclose(expression, {key: to_ball(value) for key, value in values.items()})


def _far_points_of(
    expression: sp.Expr, others: Iterable[sp.Expr] = ()
) -> list[dict[sp.Symbol, Fraction]]:
    ranges = _FAR_OF_INTEGRALS if expression.has(sp.Integral) else _FAR
    symbols = expression.free_symbols.union(*(other.free_symbols for other in others))
    return [point for given in ranges for point in far_points(symbols, *given)]


def _is_positive(expression: sp.Expr, values: Mapping[sp.Symbol, Fraction]) -> bool:
    with flint.ctx.workprec(_PRECISIONS[0]):
        return bool(enclose(expression, {k: to_ball(v) for k, v in values.items()}) > 0)


def _excludes_zero(expression: sp.Expr, values: Mapping[sp.Symbol, Fraction]) -> bool:
    """Return whether an expression is different from zero at a point; False outside its domain.

    The smaller precision is used except for integrals: at the larger one, K_1(182) takes 18 s.
    """
    balls = islice(_balls(expression, values), 2 if expression.has(sp.Integral) else 1)
    return any(ball.is_finite() and not ball.contains(0) for ball in balls)


def _where(residual: sp.Expr) -> str:
    """Return at which point a residual is different from zero, as part of a message."""
    near = sample_points(residual.free_symbols, _POINTS // 2)
    for values in (*near, *_far_points_of(residual)):
        if values and _excludes_zero(residual, values):
            at = ", ".join(f"{symbol} = {float(value):.4g}" for symbol, value in values.items())
            return f", which is not 0 at {at}"
    return ""


def far_points(
    symbols: Iterable[sp.Symbol], count: int, bits: int, seed: int = 3
) -> list[dict[sp.Symbol, Fraction]]:
    """Return random rationals of magnitudes from 2^-bits to 2^bits, the same in every run.

    They have the sign that a symbol's assumptions prescribe, or either sign. All coordinates of
    every other point, up to those signs, are of a similar size.
    """
    symbols = sorted(symbols, key=str)
    generator = random.Random(seed)
    points = []
    for number in range(count):
        shared = generator.uniform(-bits, bits)
        values = {}
        for symbol in symbols:
            exponent = shared if number % 2 else generator.uniform(-bits, bits)
            size = Fraction(generator.randrange(1001, 1999), 1499) * Fraction(2) ** round(exponent)
            either = generator.choice((-1, 1))
            sign = 1 if symbol.is_nonnegative else -1 if symbol.is_nonpositive else either
            values[symbol] = sign * size
        points.append(values)
    return points


def sample_points(
    symbols: Iterable[sp.Symbol], count: int, seed: int = 2
) -> list[dict[sp.Symbol, Fraction]]:
    """Return random rationals in (1/4, 9/4) for the symbols, the same in every run."""
    symbols = sorted(symbols, key=str)
    generator = random.Random(seed)
    return [
        {symbol: Fraction(generator.randrange(1001, 8999), 4001) for symbol in symbols}
        for _ in range(count)
    ]
