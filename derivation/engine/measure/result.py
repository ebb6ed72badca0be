"""What a measurement comes to for whoever asked for it: a table, plain data, whether it passed."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from derivation.engine.measure.suggest import MeasuredRow
from derivation.engine.outputs import sorted_json


class Kept(Protocol):
    """A row that states whether its budget is met."""

    @property
    def kept(self) -> bool:
        """Return whether the budget is met."""


@dataclass(frozen=True)
class CheckResult:
    """The result of a measurement.

    Parameters
    ----------
    title, columns, cells
        Title, columns and cells of the table.
    data
        Function that returns the result as plain data.
    passed
        Whether every budget is met.
    note
        A sentence below the table; may be empty.
    listings
        Lines below the note, under their titles.
    budgeted
        Rows from which tighter budgets may be suggested.
    recorded
        Function that returns the text of the record, if it is not the data in sorted order.
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


def all_kept(rows: Iterable[Kept]) -> bool:
    """Return whether every row meets its budget."""
    return all(row.kept for row in rows)
