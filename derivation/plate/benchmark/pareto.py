"""Fastest method for each number of digits, its ties, and its time over that for three digits."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from derivation.plate.benchmark.catalogue import simplicity
from derivation.plate.benchmark.interface import TIE
from derivation.plate.benchmark.rows import BenchmarkRow, Kind

DIGITS = (3, 6, 9, 12, 15, 30, 100, 1000)
CLOSE_TIMES = (1.15, 1.25)
"""Ratios of times at which another run may decide otherwise whether there is a tie."""


@dataclass(frozen=True)
class Winner:
    """Fastest method of a panel that has a number of correct digits.

    Attributes
    ----------
    task, case, digits, kind
        The panel, the number of correct digits, and whether for arrays or single calls.
    family, setting, seconds
        The simplest among the ties, and its time per point [s].
    relative
        That time over the fastest method's of the panel that has at least three digits.
    ties
        Other families within a factor of 1.2 of the fastest.
    near_ties
        Families, also the winner, for which another run may decide otherwise about a tie.
    """

    task: str
    case: str
    digits: int
    kind: Kind
    family: str
    setting: str
    seconds: float
    relative: float
    ties: tuple[str, ...]
    near_ties: tuple[str, ...]


def winners(rows: Sequence[BenchmarkRow]) -> list[Winner]:
    """Return the fastest methods of every panel, for arrays and for single calls."""
    panels = dict.fromkeys((row.task, row.case) for row in rows)
    return [
        row
        for task, case in panels
        for kind in ("vector", "single")
        for row in _panel([r for r in rows if (r.task, r.case) == (task, case)], kind)
    ]


def _panel(rows: Sequence[BenchmarkRow], kind: Kind) -> Iterator[Winner]:
    timed = [(row, row.seconds(kind)) for row in rows]
    known = [(row, seconds) for row, seconds in timed if seconds is not None]
    if not known:
        return
    cheapest = min((t for row, t in known if _reaches(row, DIGITS[0])), default=math.nan)
    for digits in DIGITS:
        fastest: dict[str, tuple[BenchmarkRow, float]] = {}
        for row, seconds in known:
            best = fastest[row.family][1] if row.family in fastest else math.inf
            if _reaches(row, digits) and seconds < best:
                fastest[row.family] = row, seconds
        if not fastest:
            continue
        least = min(seconds for _, seconds in fastest.values())
        ratios = {family: seconds / least for family, (_, seconds) in fastest.items()}
        tied = sorted((f for f, ratio in ratios.items() if ratio <= TIE), key=simplicity)
        row, seconds = fastest[tied[0]]
        yield Winner(
            row.task, row.case, digits, kind, row.family, row.setting, seconds,
            seconds / cheapest, tuple(tied[1:]),
            tuple(f for f, ratio in ratios.items() if CLOSE_TIMES[0] <= ratio <= CLOSE_TIMES[1]),
        )  # fmt: skip


def _reaches(row: BenchmarkRow, digits: float) -> bool:
    return row.errors is not None and row.errors.total >= digits
