"""Effect of the rewriting rules on each formula of a paper: the rewrite report."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from derivation.engine.activity import Progress, quiet
from derivation.engine.formula.record import Record
from derivation.engine.rewrite.automatic import dimensionless
from derivation.engine.rewrite.every_variable import accurate
from derivation.engine.rewrite.products import ProductForm, of_products
from derivation.engine.rewrite.scales import Scales
from derivation.engine.rewrite.several_products import several_products
from derivation.engine.rewrite.stabilise import Applied, Stable, stabilise
from derivation.engine.rewrite.terms import UnreachableError

ENDS = (1e-150, 1e6)
"""Range of the dimensionless variable for which the functions have error budgets."""


@dataclass(frozen=True)
class Account:
    """Result of the rules for one formula.

    Parameters
    ----------
    name
        Name of the formula.
    variable
        The dimensionless variable, and its definition.
    applied
        The rules that were kept, with number of operations and error without and with each.
    worst
        Largest error of the form in ULP, in addition to conditioning.
    """

    name: str
    variable: str
    applied: tuple[Applied, ...]
    worst: float


def accounts(
    formulas: Mapping[str, Record],
    names: Sequence[str],
    scales: Scales,
    progress: Progress = quiet,
) -> tuple[Account, ...]:
    """Return the result of the rules for each named formula.

    A formula of several dimensionless products has no row: the rules apply to parts of it only.

    Parameters
    ----------
    formulas
        All formulas by name.
    names
        Names of the formulas to be rewritten, in order.
    scales
        The dimensionless variables.
    progress
        Called for each formula before it is rewritten.

    Raises
    ------
    UnreachableError
        If the rules do not find a form of a formula.
    """
    rows: list[Account] = []
    for number, name in enumerate(names, start=1):
        progress(name, number, len(names))
        rows += _accounts(formulas[name], scales)
    return tuple(rows)


def _accounts(formula: Record, scales: Scales) -> Iterator[Account]:
    """Yield the result for a formula, or for each of its factors that depends on a product."""
    try:
        reduced = dimensionless(formula.expression, scales)
    except UnreachableError:
        try:
            form = of_products(formula, lambda made: _accurate(formula, made))
        except UnreachableError as error:
            if next(several_products(formula), None) is None:
                raise UnreachableError(f"{formula.name}: {error}") from None
            return
        for product, stable in form.factors:
            whole = sp.Mul(*(symbol**power for symbol, power in product))
            yield _account(formula.name, stable, whole)
        return
    scale = reduced.scale
    stable = stabilise(reduced.expression, scale.variable, ENDS)
    yield _account(formula.name, stable, scale.product)


def _accurate(formula: Record, made: ProductForm) -> tuple[ProductForm, float]:
    """Return a form that is accurate in every variable of its formula, with its error [ULP]."""
    blocks = {block.name: block for block in made.blocks}
    return made, accurate(formula, made.steps, made.value, blocks)


def _account(name: str, stable: Stable, product: sp.Expr) -> Account:
    """Return the result of the rules for a function of a product."""
    x = stable.variable
    variable = str(x) if product.has(x) else f"{x} = {product}"
    return Account(name, variable, stable.applied, stable.worst)
