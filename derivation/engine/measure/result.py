"""The result of a measurement: a table, plain data, and whether it passed."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from derivation.engine.measure.suggest import MeasuredRow
from derivation.engine.outputs import sorted_json


class RowWithLimits(Protocol):
    """A row that states whether its limits are met."""

    @property
    def passed(self) -> bool:
        """Whether the limits are met."""


@dataclass(frozen=True)
class CheckResult:
    """The result of a measurement.

    Parameters
    ----------
    title, columns, cells
        Title, columns and cells of the table; without columns there is no table.
    data
        Function that returns the result as plain data.
    passed
        Whether every limit is met.
    note
        Text below the table; may be empty.
    listings
        Titles, each with the lines below it; they follow the note.
    budgeted
        Rows from which tighter budgets may be suggested.
    recorded
        Function that returns the text of the record; by default the data as sorted JSON.
    """

    title: str
    columns: Sequence[str]
    cells: Sequence[Sequence[object]]
    data: Callable[[], Any]
    passed: bool
    note: str = ""
    listings: Sequence[tuple[str, Sequence[str]]] = ()
    budgeted: Sequence[MeasuredRow] = ()
    recorded: Callable[[], str] | None = None

    def record(self) -> str:
        """Return the data as the text of a file of committed measurements."""
        return self.recorded() if self.recorded else sorted_json(self.data())


def all_passed(rows: Iterable[RowWithLimits]) -> bool:
    """Return whether every row meets its limits."""
    return all(row.passed for row in rows)
