"""What the rules did to each formula of a paper: the rewrite report."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from derivation.engine.activity import Tell, quiet
from derivation.engine.formula.record import Record
from derivation.engine.rewrite.automatic import dimensionless
from derivation.engine.rewrite.scales import Scales
from derivation.engine.rewrite.stabilise import Applied, stabilise

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
    formulas: Mapping[str, Record],
    names: Sequence[str],
    scales: Scales,
    tell: Tell = quiet,
) -> tuple[Account, ...]:
    """Every formula of the names, whose forms the rules find.

    Parameters
    ----------
    formulas
        Every formula by name.
    names
        Those to rewrite, in order.
    scales
        The dimensionless variables.
    tell
        Told about each formula before it is rewritten.
    """
    found = []
    for number, name in enumerate(names, start=1):
        tell(name, number, len(names))
        reduced = dimensionless(formulas[name].expression, scales)
        scale = reduced.scale
        stable = stabilise(reduced.expression, scale.variable, ENDS)
        said = f"{scale.variable} = {scale.product}"
        said = said if scale.length != scale.variable else str(scale.variable)
        found.append(Account(name, said, stable.applied, stable.worst))
    return tuple(found)
