"""What the command line shows: stages with their times, tables, JSON to a file or the screen."""

import json
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.markup import escape
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    SpinnerColumn,
    TextColumn,
    TimeElapsedColumn,
)
from rich.table import Table

from derivation.files import expect_writable, write_file

OUT = Console()
NOTES = Console(stderr=True)
"""Progress and remarks, kept apart from results so that these can be piped."""


def _checked(where: str | None) -> str | None:
    """Refuse a file that cannot be written, before anything is computed."""
    if where and where != "-":
        expect_writable(Path(where))
    return where


Json = Annotated[
    str | None,
    typer.Option("--json", metavar="FILE|-", help="Write the result as JSON.", callback=_checked),
]
"""The option of every command that has a result."""

INTERRUPTED = 130
"""What typer returns after Ctrl-C."""


@contextmanager
def stage(name: str) -> Iterator[None]:
    """Show that a stage is running, then how long it took."""
    start = time.perf_counter()
    with NOTES.status(f"{name} ..."):
        yield
    NOTES.print(f"[green]✓[/] {name} [dim]{time.perf_counter() - start:.1f} s[/]")


@contextmanager
def counted(name: str) -> Iterator[Callable[[str, int, int], None]]:
    """Show a bar and a clock for work in parts; yields what wants to be told each part."""
    start = time.perf_counter()
    part = TextColumn("{task.description}")
    columns = (TextColumn(name), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), part)
    with Progress(*columns, console=NOTES, transient=True) as bar:
        task = bar.add_task("", total=None)
        yield lambda part, number, total: bar.update(
            task, description=part, completed=number - 1, total=total
        )
    NOTES.print(f"[green]✓[/] {name} [dim]{time.perf_counter() - start:.1f} s[/]")


@contextmanager
def clocked(name: str) -> Iterator[Callable[[str, int, float], None]]:
    """Show a clock for work without end; yields what wants to be told part, count and worst."""
    columns = (TextColumn(name), SpinnerColumn(), TimeElapsedColumn())
    with Progress(*columns, TextColumn("{task.description}"), console=NOTES, transient=True) as bar:
        task = bar.add_task("", total=None)
        yield lambda part, count, worst: bar.update(
            task, description=f"{count} points, worst ratio {worst:.3g}, now {part}"
        )


def table(title: str, columns: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
    """Print a table; columns whose name starts with `#` are numbers, set flush right.

    Names, one word each, in the first column are not broken.
    """
    made = Table(title=title, title_justify="left")
    names = not any(" " in str(row[0]) for row in rows)
    for index, column in enumerate(columns):
        number = column.startswith("#")
        made.add_column(
            escape(column.lstrip("#")),  # "[m]" is a unit, no markup
            justify="right" if number else "left",
            overflow="fold",
            no_wrap=names and index == 0 and not number,
        )
    for row in rows:
        made.add_row(*(escape(str(cell)) for cell in row))
    OUT.print(made)


def listing(title: str, lines: Sequence[str]) -> None:
    """Print lines as they are, unbroken, so that they can be copied."""
    OUT.print(title, style="italic")
    for line in lines:
        OUT.print(line, markup=False, highlight=False, soft_wrap=True)


def json_text(result: Any) -> str:
    """A result as JSON to be read by people too."""
    return json.dumps(result, indent=2, ensure_ascii=False) + "\n"


def put_json(result: Any, where: str) -> None:
    """Write a result as JSON to a file, or to standard output for `-`."""
    if where == "-":
        print(json_text(result), end="")
    else:
        write_file(Path(where), json_text(result))
