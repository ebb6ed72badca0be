"""The dimensionless variables of a paper: what its formulas' functions depend on."""

from dataclasses import dataclass

import sympy as sp

from derivation.engine.rewrite.form import Step


@dataclass(frozen=True)
class Scale:
    """A product that functions may depend on, which becomes a variable.

    Parameters
    ----------
    product
        The product, for instance 2 k H.
    variable
        The dimensionless symbol that stands for it.
    length
        The symbol that the variable replaces.
    rate
        What the variable over the length is, but for a number; None if they are the same.
    joined
        Whether powers of the variable over the rate become powers of the length again.
    """

    product: sp.Expr
    variable: sp.Symbol
    length: sp.Symbol
    rate: sp.Symbol | None = None
    joined: bool = False


@dataclass(frozen=True)
class Ratio:
    """A quotient of two sums of constants, which is computed first: whole = step.symbol * part."""

    step: Step
    whole: sp.Expr
    part: sp.Expr


@dataclass(frozen=True)
class Scales:
    """Every scale, and the ratio if there is one."""

    rows: tuple[Scale, ...] = ()
    ratio: Ratio | None = None

    def of(self, product: sp.Expr) -> Scale | None:
        """The scale of a product, if there is one."""
        return next((scale for scale in self.rows if scale.product == product), None)
