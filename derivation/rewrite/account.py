"""What the rules did to each of the paper's formulas: the rewrite report."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from derivation.formula.record import Formula
from derivation.rewrite.automatic import dimensionless
from derivation.rewrite.forms import AUTOMATIC
from derivation.rewrite.stabilise import Applied, stabilise

ENDS = (1e-150, 1e6)
"""Of the dimensionless variable: the domain in which the kernels keep their budgets."""


@dataclass(frozen=True)
class Account:
    """A formula's rewriting.

    Parameters
    ----------
    name
        The formula.
    variable
        The dimensionless variable it was brought to, and what that stands for.
    applied
        The rules kept, with what the form is without and with each.
    worst
        Worst error of the form in ULP beyond conditioning.
    """

    name: str
    variable: str
    applied: tuple[Applied, ...]
    worst: float


def accounts(
    formulas: Mapping[str, Formula], tell: Callable[[str, int, int], None] | None = None
) -> tuple[Account, ...]:
    """Every formula whose form the rules find, in the order they are generated."""
    found = []
    for number, name in enumerate(AUTOMATIC, start=1):
        if tell is not None:
            tell(name, number, len(AUTOMATIC))
        reduced = dimensionless(formulas[name].expression)
        stable = stabilise(reduced.expression, reduced.variable, ENDS)
        said = f"{reduced.variable} = {reduced.product}"
        said = said if reduced.length != reduced.variable else str(reduced.variable)
        found.append(Account(name, said, stable.applied, stable.worst))
    return tuple(found)
