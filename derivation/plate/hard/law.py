"""What a hard case of a kernel without a closed formula of the chain is held to."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from flint import arb

Given = Sequence[Any]
Values = Callable[[Given, int], tuple[arb, ...]]
"""Arguments and digits -> balls, one for each result."""


@dataclass(frozen=True)
class HardLaw:
    """A kernel's truth.

    Parameters
    ----------
    values
        Its results.
    sizes
        From arguments and results, what the budget counts in units of; the results' own
        magnitudes if there is nothing else to say.
    conditioned
        Whether what rounding the arguments does is allowed on top; not where a kernel
        promises a relative error.
    slopes
        From arguments and results, the sum of |x df/dx| over the arguments, of each result;
        found by differences if there is no quicker way.
    results
        How many results the kernel has.
    oracle
        Modules that the results follow from.
    """

    values: Values
    sizes: Callable[[Given, Sequence[arb]], tuple[arb, ...]] | None = None
    conditioned: bool = True
    slopes: Callable[[Given, Sequence[arb]], Sequence[arb]] | None = None
    results: int = field(default=1, kw_only=True)
    oracle: tuple[str, ...] = field(kw_only=True)
