"""Tighter error budgets from measured errors, as lines of `budgets.toml`; no file is changed.

A budget must be tightened by hand, because budgets are never increased again.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

MARGIN = 1.5
"""A suggested budget over the largest measured error: other points have errors up to 1.35 times as
large, measured for kernels of elastic layers."""

QUARTER = 0.25
"""Suggestions are multiples of this many ULP."""

LEAST = 0.5
"""Smallest suggested budget: the rounding of the result alone."""


class MeasuredErrors(Protocol):
    """Measured errors in one format."""

    @property
    def needed(self) -> float:
        """Smallest budget that is met [ULP]."""


class MeasuredRow(Protocol):
    """The parts of a row on which a suggestion depends."""

    @property
    def kernel(self) -> str:
        """Name of the function."""

    @property
    def budget(self) -> float | None:
        """Error budget [ULP]; None without one."""

    @property
    def passed(self) -> bool | None:
        """Whether the budget is met."""

    @property
    def double(self) -> MeasuredErrors:
        """Errors with arguments in double precision."""

    @property
    def single(self) -> MeasuredErrors | None:
        """Errors with arguments in single precision, if there are any."""


@dataclass(frozen=True)
class Suggestion:
    """A tighter budget.

    Parameters
    ----------
    name
        Name of the function.
    ulp, budget, needed
        The suggested budget, the present one, and the measured error, in ULP.
    """

    name: str
    ulp: float
    budget: float
    needed: float

    def __str__(self) -> str:
        """Return a line for the table [ulp] of `budgets.toml`."""
        return f"{self.name} = {self.ulp}  # {self.budget:g}, {self.needed:.3g} measured"


def tighter(budget: float, needed: float) -> float | None:
    """Return a tighter budget with its margin, or None if the present one cannot be improved."""
    if not math.isfinite(needed):
        return None
    suggested = max(LEAST, math.ceil(needed * MARGIN / QUARTER) * QUARTER)
    return suggested if suggested < budget else None


def suggestions(rows: Iterable[MeasuredRow]) -> list[Suggestion]:
    """Return a suggestion for each function whose budget could be tighter."""
    proposed = []
    for row in rows:
        if row.budget is None or not row.passed:
            continue
        needed = max(errors.needed for errors in (row.double, row.single) if errors is not None)
        ulp = tighter(row.budget, needed)
        if ulp is not None:
            proposed.append(Suggestion(row.kernel, ulp, row.budget, needed))
    return proposed
