"""The class of proved formulas: symbol, expression, unit, sources and proof."""

from dataclasses import dataclass
from keyword import iskeyword
from typing import ClassVar

import sympy as sp

from derivation.engine.formula.dimension import DimensionError, dimension, unit
from derivation.engine.formula.domain import comparison
from derivation.engine.formula.notation import to_latex, to_markdown, to_plain
from derivation.engine.formula.operations import exact_number
from derivation.engine.formula.proof import Proof
from derivation.engine.formula.vocabulary import (
    Argument,
    Vocabulary,
    applicable,
    symbols_of,
)


@dataclass(frozen=True)
class Record:
    """A proved formula. A subclass for each paper sets the vocabulary.

    Parameters
    ----------
    name
        Name in code and on the command line, such as ``Omega_1``.
    latex
        LaTeX of the left-hand side.
    meaning
        Meaning of the quantity, in a few words.
    expression
        Exact right-hand side, or one term of it if `summed`.
    unit
        SI unit; the expression's dimension is checked against it.
    equation
        Number of the corresponding equation of the paper; empty if there is none.
    sources
        Names of the formulas from which it was derived.
    proof
        The proof. If it has claims, `expression` and `stated` must be among them.
    summed
        Whether the quantity is the sum of `expression` over all terms.
    where
        Conditions on the arguments in addition to their own.
    stated
        The expression in terms of other formulas, if it is shown that way.

    Raises
    ------
    DimensionError
        If the dimension of the expression differs from that of `unit`.
    KeyError
        If it contains a symbol that the paper does not define.
    ValueError
        If the name is no Python name, a number is rounded, a symbol has other assumptions than that
        of the vocabulary, a condition of `where` contains symbols without a meaning, or the proof
        is about other expressions.
    """

    vocabulary: ClassVar[Vocabulary]

    name: str
    latex: str
    meaning: str
    expression: sp.Expr
    unit: str
    equation: str
    sources: tuple[str, ...]
    proof: Proof
    summed: bool = False
    where: tuple[str, ...] = ()
    stated: sp.Expr | None = None

    def __post_init__(self) -> None:
        if not self.name.isidentifier() or iskeyword(self.name):
            raise ValueError(f"expected a Python name for a formula, got {self.name!r}; rename it")
        self._expect_symbols()
        for what, own in (("expression", self.expression), ("stated", self.stated)):
            if own is not None and self.proof.claims and own not in self.proof.claims:
                raise ValueError(
                    f"{self.name}: expected an expression that the proof {self.proof.step!r} "
                    f"determines, got {what}={sp.sstr(own):.100}; give it to `prove` as a claim"
                )
        if rounded := sorted(self.expression.atoms(sp.Float)):
            raise ValueError(
                f"{self.name}: expected exact numbers, got {float(rounded[0])!r}; "
                f"{exact_number(rounded[0])}"
            )
        try:
            dimensions = dimension(self.expression, self.vocabulary.dimensions)
        except DimensionError as error:
            raise DimensionError(f"{self.name}: {error}") from None
        if dimensions != unit(self.unit):
            raise DimensionError(
                f"{self.name} has dimension [{dimensions}], expected [{self.unit}]"
            )

    def _expect_symbols(self) -> None:
        known = {argument.symbol for argument in self.vocabulary.arguments_of(self.expression)}
        if others := sorted(map(str, self.expression.free_symbols - known)):
            raise ValueError(
                f"{self.name}: expected the symbol {others[0]} of the vocabulary, got another one "
                f"of this name with other assumptions; import it from the vocabulary"
            )
        for condition in self.where:
            if unknown := sorted(symbols_of(condition) - self.vocabulary.by_name.keys()):
                raise ValueError(
                    f"{self.name}: the condition {condition!r} contains the unknown symbol "
                    f"{unknown[0]}, expected some of {', '.join(self.vocabulary.by_name)}"
                )
            comparison(condition)

    @property
    def arguments(self) -> tuple[Argument, ...]:
        """The symbols on which the expression depends, in the order of the vocabulary."""
        return self.vocabulary.arguments_of(self.expression)

    @property
    def domain(self) -> tuple[str, ...]:
        """Every condition on the arguments, in Python syntax."""
        names = {argument.name for argument in self.arguments}
        conditions = [c for argument in self.arguments for c in argument.domain]
        return applicable((*conditions, *self.where), names)

    @property
    def sum_sign(self) -> str:
        """LaTeX of the summation sign; empty if the formula is not a sum."""
        index = self.vocabulary.index(self.expression)
        return rf"\sum_{{{index}=1}}^{{\infty}} " if self.summed else ""

    @property
    def right_hand_side(self) -> str:
        """LaTeX of the right-hand side, with the sum over the terms if the formula is a sum."""
        return self.sum_sign + to_latex(self.shown, self.vocabulary)

    @property
    def shown(self) -> sp.Expr:
        """Right side as shown: in terms of other formulas if stated so, functions in full."""
        shown = self.expression if self.stated is None else self.stated
        return self.vocabulary.in_full(shown)

    def to_json(self) -> dict[str, object]:
        """Return the formula as plain data under fixed keys."""
        return {
            "name": self.name,
            "meaning": to_plain(self.meaning),
            "latex": f"{self.latex} = {self.right_hand_side}",
            "expression": str(self.expression),
            "summed": self.summed,
            "unit": self.unit,
            "domain": list(self.domain),
            "equation": self.equation,
            "sources": list(self.sources),
            "proof": {
                "step": self.proof.step,
                "argument": to_plain(self.proof.argument),
                "residuals": list(self.proof.residuals),
                "method": self.proof.method,
            },
        }

    def _repr_markdown_(self) -> str:
        """Return the formula with meaning and proof, for a notebook."""
        what = f"{to_markdown(self.meaning)} [{self.unit}]"
        if self.equation:
            what += f", equation ({self.equation})"
        return f"{self._repr_latex_()}\n\n{what}\n\n{self.proof._repr_markdown_()}"

    def _repr_latex_(self) -> str:
        return f"$\\displaystyle {self.latex} = {self.right_hand_side}$"
