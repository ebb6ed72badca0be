"""The stable form: named steps, branches and the proof that it equals a derived formula."""

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp
from sympy.codegen.cfunctions import expm1

from derivation.formula.proof import Proof, prove


@dataclass(frozen=True)
class Step:
    """A named intermediate: ``symbol = expression  # comment``."""

    symbol: sp.Symbol
    expression: sp.Expr
    comment: str = ""


@dataclass(frozen=True)
class Branch:
    """One way to evaluate a form, with values that keep it harmless where it is not used.

    Parameters
    ----------
    steps
        Intermediates, in order.
    value
        The result.
    guards
        Stand-ins for the variables outside the branch's own region.
    """

    steps: tuple[Step, ...]
    value: sp.Expr
    guards: Mapping[sp.Symbol, sp.Rational]


@dataclass(frozen=True)
class Seam:
    """Below `at`, `variable` selects the first branch; from there on the second."""

    variable: sp.Symbol
    at: sp.Rational
    below: Branch
    above: Branch


@dataclass(frozen=True)
class Form:
    """A stable form of the formula (or building block) `name`.

    Parameters
    ----------
    name, module
        What it is called and in which generated module it stands.
    steps
        Intermediates common to all branches.
    value
        The result, or the seam between two ways to compute it.
    proof
        That it equals the formula, step by step undone.
    """

    name: str
    module: str
    steps: tuple[Step, ...]
    value: sp.Expr | Seam
    proof: Proof


@dataclass(frozen=True)
class Block:
    """A building block of stable forms: a function of its own with an exact definition.

    Parameters
    ----------
    name
        Its name in generated code.
    arguments
        Its variables.
    definition
        What it is exactly.
    domain
        Conditions on the variables, in Python's notation.
    summary
        First line of its docstring.
    steps, value
        How it is computed; series are truncated, see `truncation`.
    truncation
        The bound on the relative error of a truncated series, or nothing.
    """

    name: str
    arguments: tuple[sp.Symbol, ...]
    definition: sp.Expr
    domain: tuple[str, ...]
    summary: str
    steps: tuple[Step, ...]
    value: sp.Expr | Seam
    truncation: str = ""

    def __call__(self, *arguments: sp.Expr) -> sp.Expr:
        """The block applied to arguments, as it appears in forms."""
        return sp.Function(self.name)(*arguments)


def undo(expression: sp.Expr, steps: tuple[Step, ...], blocks: Mapping[str, Block]) -> sp.Expr:
    """The expression with every step put back and every block replaced by its definition."""
    for step in reversed(steps):
        expression = expression.subs(step.symbol, step.expression)
    for block in blocks.values():
        expression = expression.replace(
            sp.Function(block.name),
            lambda *values, block=block: block.definition.subs(
                dict(zip(block.arguments, values, strict=True)), simultaneous=True
            ),
        )
    return expression.replace(expm1, lambda x: sp.exp(x) - 1)


def form(
    name: str,
    module: str,
    formula: sp.Expr,
    steps: tuple[Step, ...],
    value: sp.Expr | Seam,
    blocks: Mapping[str, Block],
) -> Form:
    """Build a stable form, proving each of its branches equal to `formula`.

    Raises
    ------
    ProofError
        Naming the branch that is not the formula, with the residual.
    """
    proof = prove(
        f"Stable form of {name}",
        "Every branch, its steps and blocks put back, equals the derived formula.",
        {
            label: undo(branch.value, (*steps, *branch.steps), blocks) - formula
            for label, branch in branches(value)
        },
    )
    return Form(name, module, steps, value, proof)


def branches(value: sp.Expr | Seam) -> list[tuple[str, Branch]]:
    """The branches of a result, labelled by their side of the seam."""
    if isinstance(value, Seam):
        return [
            (f"{value.variable} < {value.at}", value.below),
            (f"{value.variable} >= {value.at}", value.above),
        ]
    return [("everywhere", Branch((), value, {}))]
