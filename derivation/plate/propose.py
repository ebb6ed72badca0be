"""Measured errors -> tighter budgets, as lines ready to paste; nothing is written.

Tightening is a deliberate edit of `budgets.toml`, since a budget never grows again.
"""

import math
from collections.abc import Iterable

from derivation.engine.measure.check import Row
from derivation.plate.contact.cases.check import ContactRow

MARGIN = 1.25
"""A proposal leaves a quarter more than the worst that was measured."""

QUARTER = 0.25
"""Proposals are multiples of this many ULP."""

LEAST = 0.5
"""What rounding the result alone may cost: nothing below is proposed."""


def tighter(budget: float, needed: float) -> float | None:
    """A tighter budget with its margin, or None if the one there is cannot be improved."""
    if not math.isfinite(needed):
        return None
    proposed = max(LEAST, math.ceil(needed * MARGIN / QUARTER) * QUARTER)
    return proposed if proposed < budget else None


def proposals(rows: Iterable[Row | ContactRow]) -> list[str]:
    """Lines for the table [ulp] of `budgets.toml`, of kernels whose budget could be tighter."""
    lines = []
    for row in rows:
        if row.budget is None or not row.passed:
            continue
        single = 0.0 if row.single is None else row.single.needed
        needed = max(row.double.needed, single)
        proposed = tighter(row.budget, needed)
        if proposed is not None:
            lines.append(f"{row.kernel} = {proposed}  # {row.budget:g}, {needed:.3g} measured")
    return ["[ulp]", *lines] if lines else []
