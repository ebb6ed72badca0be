"""The dimensionless variables of a paper, on which the functions in its formulas depend."""

from dataclasses import dataclass

import sympy as sp

from derivation.engine.rewrite.form import Step


@dataclass(frozen=True)
class Scale:
    """A product on which functions depend, and that is replaced by a variable.

    Parameters
    ----------
    product
        The product, such as 2 k H.
    variable
        The dimensionless symbol for it.
    length
        The symbol that is eliminated from the formula.
    rate
        The variable divided by the length, without a numerical factor; None if the product is a
        single symbol.
    joined
        Whether powers of the variable over the rate are written as powers of the length.
    """

    product: sp.Expr
    variable: sp.Symbol
    length: sp.Symbol
    rate: sp.Symbol | None = None
    joined: bool = False


@dataclass(frozen=True)
class Ratio:
    """A quotient of two sums of constants that is computed first: whole = step.symbol * part."""

    step: Step
    whole: sp.Expr
    part: sp.Expr


@dataclass(frozen=True)
class Scales:
    """All scales of a paper, and its ratio if there is one."""

    rows: tuple[Scale, ...] = ()
    ratio: Ratio | None = None

    def of(self, product: sp.Expr) -> Scale | None:
        """Return the scale of a product; None if there is none."""
        return next((scale for scale in self.rows if scale.product == product), None)
