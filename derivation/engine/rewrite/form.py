"""The stable form: named steps, branches, and the proof that it equals a derived formula."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import sympy as sp
from sympy.codegen.cfunctions import expm1

from derivation.engine.formula.proof import Proof, prove
from derivation.engine.runtime import ranges

TIMES = sp.Function("times")
"""Product of a value and powers, from value, base, exponent, base, exponent, ...; intermediate
products may leave the range of doubles."""

CLOSELY = sp.Function("times_closely")
"""The same product, with an error as if rounded once, for factors that use most of a budget."""

ROUNDING_ERROR = sp.Function("rounding_error")
"""The rounding error of a product of two numbers; it is zero in proofs."""

SUM = sp.Function("sum_closely")
"""A sum, with an error as if rounded once; its last term is small."""

ONCE = sp.Integer(ranges.ONCE)
"""Largest v for which e^(-v) is applied as one factor."""

TAIL = sp.Function("tail")
"""The factor e^(min(v, ONCE) - v), used where e^(-v) alone would underflow."""

SCALINGS = (ROUNDING_ERROR, SUM, TAIL, TIMES, CLOSELY)
"""Functions of the generated module `ranges`."""

TINY, FAR, LARGEST = sp.Float("5e-324"), sp.Integer(10**9), sp.Float("1e308")
"""Limits of a product that must neither vanish nor overflow. TINY is the smallest double; beyond
FAR, expressions in e^-x are equal to their value at infinity."""


def limited(product: sp.Expr, most: sp.Expr) -> sp.Expr:
    """Return a positive product, limited to the range from TINY to `most`."""
    return sp.Max(TINY, sp.Min(product, most))


@dataclass(frozen=True)
class Step:
    """A named intermediate value: ``symbol = expression  # comment``."""

    symbol: sp.Symbol
    expression: sp.Expr
    comment: str = ""


@dataclass(frozen=True)
class Branch:
    """One branch of a form.

    Parameters
    ----------
    steps
        Intermediates, in order.
    value
        The result.
    """

    steps: tuple[Step, ...]
    value: sp.Expr


@dataclass(frozen=True)
class Switch:
    """A switch point: `variable` below `at` selects the first branch, otherwise the second."""

    variable: sp.Symbol
    at: sp.Rational
    below: Branch
    above: Branch


def switch_points(values: Iterable[object]) -> dict[str, tuple[float, ...]]:
    """Return the switch points among the values of forms, by variable."""
    by_symbol: dict[str, set[float]] = {}
    for value in values:
        if isinstance(value, Switch):
            by_symbol.setdefault(str(value.variable), set()).add(float(value.at))
    return {variable: tuple(sorted(points)) for variable, points in by_symbol.items()}


@dataclass(frozen=True)
class Form:
    """A stable form of the formula (or building block) `name`.

    Parameters
    ----------
    name, module
        Name of the function, and of the generated module that contains it.
    steps
        Intermediates common to all branches.
    value
        The result, or the switch point between two branches.
    proof
        Proof that it equals the formula, with all steps substituted.
    blocks
        Building blocks of this form alone.
    decades
        Exponent of ten of the range of all arguments in which the form was tested; 0 if it was not.
    """

    name: str
    module: str
    steps: tuple[Step, ...]
    value: sp.Expr | Switch
    proof: Proof
    blocks: tuple["Block", ...] = ()
    decades: int = 0


@dataclass(frozen=True)
class Block:
    """A building block of stable forms: a separate function with an exact definition.

    Parameters
    ----------
    name
        Name in generated code.
    arguments
        The variables.
    total
        The sum that it represents.
    lead, constant_power
        The power of the variable by which the sum is divided, and the part of this power that is
        constant above the switch point.
    domain
        Conditions on the variables, in Python syntax.
    summary
        First line of the docstring.
    steps, value
        The computation; series are truncated, see `truncation`.
    truncation
        Bound of the relative error of a truncated series, in words; empty without a series.
    """

    name: str
    arguments: tuple[sp.Symbol, ...]
    total: sp.Expr
    lead: int
    constant_power: int
    domain: tuple[str, ...]
    summary: str
    steps: tuple[Step, ...]
    value: sp.Expr | Switch
    truncation: str = ""

    def __call__(self, argument: sp.Expr) -> sp.Expr:
        """Return the block applied to an argument, as it appears in forms."""
        return sp.Function(self.name)(argument)

    def near(self, argument: sp.Expr) -> sp.Expr:
        """Return the argument limited to the switch point; 1 without a switch point."""
        return sp.Min(argument, self.value.at) if isinstance(self.value, Switch) else sp.Integer(1)

    def definition(self, argument: sp.Expr) -> sp.Expr:
        """Return the exact definition of the block for an argument."""
        (variable,) = self.arguments
        return self.divided.subs(variable, argument) / self.near(argument) ** self.constant_power

    @property
    def divided(self) -> sp.Expr:
        """The sum divided by the part of the power that is never constant."""
        (variable,) = self.arguments
        return self.total / variable ** (self.lead - self.constant_power)


def substitute_steps(
    expression: sp.Expr, steps: tuple[Step, ...], blocks: Mapping[str, Block]
) -> sp.Expr:
    """Return the expression with steps substituted and blocks replaced by their definitions."""
    for step in reversed(steps):
        expression = expression.subs(step.symbol, step.expression)
    expression = expression.replace(TIMES, _product).replace(CLOSELY, _product)
    expression = expression.replace(ROUNDING_ERROR, lambda *_: sp.Integer(0)).replace(SUM, sp.Add)
    expression = expression.replace(TAIL, lambda v: sp.exp(sp.Min(v, ONCE) - v))
    for block in blocks.values():
        expression = expression.replace(sp.Function(block.name), block.definition)
    expression = expression.replace(
        sp.Heaviside, lambda *_: _CHOICE
    )  # a symbol stands for both values
    expression = expression.replace(expm1, lambda x: sp.exp(x) - 1)
    expression = expression.replace(
        lambda e: isinstance(e, sp.Max) and TINY in e.args, _without_limits
    )
    return expression.replace(sp.Min, _least)


_CHOICE = sp.Symbol("choice", real=True)


def _without_limits(product: sp.Max) -> sp.Expr:
    """Return a limited product without the limits TINY, FAR and LARGEST; others remain."""
    above = sp.Max(*(bound for bound in product.args if bound != TINY))
    if not isinstance(above, sp.Min):
        return above
    return sp.Min(*(bound for bound in above.args if bound not in (FAR, LARGEST)))


def _product(value: sp.Expr, *powers: sp.Expr) -> sp.Expr:
    return value * sp.Mul(*(b**p for b, p in zip(powers[::2], powers[1::2], strict=True)))


def _least(*bounds: sp.Expr) -> sp.Expr:
    """Write Min(a, 1/phi) as Min(a phi, 1)/phi, with a symbol for Min that may have any value."""
    unit = sp.Mul(*(sp.denom(bound) for bound in bounds))
    name = sorted(str(sp.expand(bound * unit)) for bound in bounds)
    return sp.Symbol(f"Min({', '.join(name)})", positive=True) / unit


def form(
    name: str,
    module: str,
    formula: sp.Expr,
    steps: tuple[Step, ...],
    value: sp.Expr | Switch,
    blocks: Mapping[str, Block],
    own: tuple[Block, ...] = (),
) -> Form:
    """Build a stable form, with a proof that each of its branches equals a formula.

    Parameters
    ----------
    name, module
        Name of the function, and of the generated module that contains it.
    formula
        The derived expression.
    steps, value
        Intermediate values, and the result or the switch point between two branches.
    blocks
        Building blocks by name.
    own
        Building blocks of this form alone.

    Raises
    ------
    ProofError
        If a branch differs from the formula; the message states the branch and the residual.
    """
    every = {**blocks, **{block.name: block for block in own}}
    proof = prove(
        f"Stable form of {name}",
        "Every branch, with steps and blocks substituted, equals the derived formula.",
        {
            f"{label}{sign}": exact
            for label, branch in branches(value)
            for sign, exact in _of_both_signs(
                substitute_steps(branch.value, (*steps, *branch.steps), every) - formula
            )
        },
    )
    return Form(name, module, steps, value, proof, own)


def _of_both_signs(expression: sp.Expr, said: str = "") -> Iterator[tuple[str, sp.Expr]]:
    """Yield an expression without |u|, for u > 0 and u < 0 if u may have either sign."""
    sizes = sorted(expression.atoms(sp.Abs), key=str)
    if not sizes:
        yield said, expression
        return
    inner = next(size for size in sizes if not size.args[0].has(sp.Abs))
    (u,) = inner.args
    for comparison, plain in ((">", u), ("<", -u)):
        yield from _of_both_signs(
            expression.xreplace({inner: plain}), f"{said}, {u} {comparison} 0"
        )


def branches(value: sp.Expr | Switch) -> list[tuple[str, Branch]]:
    """Return the branches of a result, labelled by their side of the switch point."""
    if isinstance(value, Switch):
        return [
            (f"{value.variable} < {value.at}", value.below),
            (f"{value.variable} >= {value.at}", value.above),
        ]
    return [("everywhere", Branch((), value))]
