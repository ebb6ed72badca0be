"""Effect of the rewriting rules on each formula of a paper: the rewrite report."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from derivation.engine.activity import Progress, quiet
from derivation.engine.formula.record import Record
from derivation.engine.rewrite.automatic import dimensionless
from derivation.engine.rewrite.scales import Scales
from derivation.engine.rewrite.stabilise import Applied, stabilise

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
    rows = []
    for number, name in enumerate(names, start=1):
        progress(name, number, len(names))
        reduced = dimensionless(formulas[name].expression, scales)
        scale = reduced.scale
        stable = stabilise(reduced.expression, scale.variable, ENDS)
        said = f"{scale.variable} = {scale.product}"
        said = said if scale.length != scale.variable else str(scale.variable)
        rows.append(Account(name, said, stable.applied, stable.worst))
    return tuple(rows)
