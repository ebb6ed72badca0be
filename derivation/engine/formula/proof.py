"""Proofs: residuals are reduced to zero symbolically, or contain zero in ball arithmetic."""

import random
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction

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


class ProofError(FailedError):
    """A step of the derivation fails; the message states the step and the residual."""


@dataclass(frozen=True)
class Proof:
    """A proved step: its name, argument, names of residuals, and the method."""

    step: str
    argument: str
    residuals: tuple[str, ...]
    method: str

    def _repr_markdown_(self) -> str:
        """Return the step, its argument and its residuals, for a notebook."""
        vanish, argument = (to_markdown(s) for s in (", ".join(self.residuals), self.argument))
        return f"**{self.step}.** {argument} Reduced to zero {self.method}: {vanish}."


def prove(step: str, argument: str, residuals: Mapping[str, sp.Expr]) -> Proof:
    """Prove that every residual is zero.

    Parameters
    ----------
    step
        Name of the step.
    argument
        The reasoning in a sentence.
    residuals
        Expressions that must vanish identically, by label.

    Returns
    -------
    Proof
        The step with its labels; its method is by balls if one of the residuals needed it.

    Raises
    ------
    ProofError
        If a residual does not vanish; the message states step, label and residual.
    """
    methods = set()
    for label, residual in residuals.items():
        method = decide_zero(residual)
        if method is None:
            raise ProofError(f"{step}: {label} leaves the residual {sp.sstr(residual):.300}")
        methods.add(method)
    method = BY_BALLS if BY_BALLS in methods else SYMBOLIC
    return Proof(step, argument, tuple(residuals), method)


def decide_zero(expression: sp.Expr) -> str | None:
    """Return the method by which an expression was found to be zero; None if it is not zero.

    Balls are evaluated first: if one excludes zero, the expansion, which can be slow, is avoided.
    If the expansion does not give zero, but all balls contain zero, the method is `BY_BALLS`.
    """
    if expression.is_zero:
        return SYMBOLIC
    if not balls_contain_zero(expression):
        return None
    return SYMBOLIC if reduces_to_zero(expression) else BY_BALLS


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
        for bits in _PRECISIONS_OF_INTEGRALS if integral else _PRECISIONS:
            with flint.ctx.workprec(bits):
                ball = enclose(expression, {key: to_ball(value) for key, value in values.items()})
            if ball.is_finite() and not ball.contains(0):
                return False
            inside += ball.is_finite()
    return inside >= 2 * len(_PRECISIONS)


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
