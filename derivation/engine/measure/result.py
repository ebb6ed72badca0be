"""What a measurement comes to for whoever asked for it: a table, plain data, whether it passed."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from derivation.engine.measure.suggest import MeasuredRow
from derivation.engine.outputs import sorted_json


class Kept(Protocol):
    """A row that says whether what it is about kept its promise."""

    @property
    def kept(self) -> bool:
        """Whether it did."""


@dataclass(frozen=True)
class CheckResult:
    """The result of a measurement.

    Parameters
    ----------
    title, columns, cells
        Of its table.
    data
        Makes it as plain data.
    passed
        Whether every promise is kept.
    note
        A sentence below the table, if there is something to say.
    listings
        Lines below that, under their titles.
    budgeted
        Rows from which tighter budgets may follow.
    recorded
        Makes the text of the record, if that is not the data in sorted order.
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
        """The data as a file of the committed measurements holds them."""
        return self.recorded() if self.recorded else sorted_json(self.data())


def all_kept(rows: Iterable[Kept]) -> bool:
    """Whether every row kept its promise."""
    return all(row.kept for row in rows)
