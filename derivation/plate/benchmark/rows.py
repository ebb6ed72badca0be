"""Row of the comparison: digits and times of a method in a test case, or why it fails."""

from dataclasses import dataclass
from typing import Literal

from derivation.engine.measure.clock import Timing
from derivation.plate.benchmark.errors import BenchmarkErrors
from derivation.plate.benchmark.interface import Task

Kind = Literal["vector", "single"]


@dataclass(frozen=True)
class BenchmarkRow:
    """Results of a method in a test case.

    Attributes
    ----------
    task, case, family, setting, arithmetic
        Method, arithmetic and test case.
    fails
        Reason why it fails, or None.
    errors
        Its correct digits, or None if it was not evaluated.
    vector, single
        Its times in an array and in single calls, or None.
    setup
        Time of preparation [s]; constants cached by an earlier method do not count.
    """

    task: Task
    case: str
    family: str
    setting: str
    arithmetic: str
    fails: str | None
    errors: BenchmarkErrors | None = None
    vector: Timing | None = None
    single: Timing | None = None
    setup: float | None = None

    def seconds(self, kind: Kind) -> float | None:
        """Return the time per point [s], or None if the method fails or was not timed."""
        timing = self.vector if kind == "vector" else self.single
        return None if timing is None or self.fails is not None else timing.seconds
