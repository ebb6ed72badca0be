"""One row of the comparison: a method in a regime, its digits and its times, or why it fails."""

from dataclasses import dataclass
from typing import Literal

from derivation.engine.measure.clock import Timing
from derivation.plate.benchmark.errors import BenchmarkErrors
from derivation.plate.benchmark.interface import Task

Kind = Literal["vector", "single"]


@dataclass(frozen=True)
class BenchmarkRow:
    """A method in a regime.

    Attributes
    ----------
    task, regime, family, setting, arithmetic
        Which method, and where.
    fails
        Why it gives nothing there, or None.
    errors
        Its digits.
    vector, single
        Its times in an array and by a call of its own.
    setup
        Time to prepare it [s]; constants that an earlier method has found are not found anew.
    """

    task: Task
    regime: str
    family: str
    setting: str
    arithmetic: str
    fails: str | None
    errors: BenchmarkErrors | None = None
    vector: Timing | None = None
    single: Timing | None = None
    setup: float | None = None

    def seconds(self, kind: Kind) -> float | None:
        """Time per point [s], if the method does not fail."""
        timing = self.vector if kind == "vector" else self.single
        return None if timing is None or self.fails is not None else timing.seconds
