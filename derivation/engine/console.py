"""Output of the command line: stages with times, tables, JSON to a file or the screen."""

import json
import os
import sys
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from datetime import timedelta
from pathlib import Path
from typing import Annotated, Any, TextIO

import typer
from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    SpinnerColumn,
    Task,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.progress import (
    Progress as Display,
)
from rich.table import Table
from rich.text import Text

from derivation.engine.activity import Progress
from derivation.engine.files import expect_writable, write_file
from derivation.engine.printable import in_json, one_line, printable
from derivation.engine.text import paragraph


class UnreadError(Exception):
    """The reader of the output has closed the pipe, as `head` does."""


def silence(stream: TextIO) -> None:
    """Discard further output to a stream, and its buffer."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


class Screen(Console):
    """A console that escapes control characters in text of the user."""

    def say(self, text: str) -> None:
        """Print a text without additional line breaks, so that it can be copied."""
        known = printable(text).encode(self.encoding, "backslashreplace").decode(self.encoding)
        self.print(Text(known), markup=False, highlight=False, soft_wrap=True)

    def on_broken_pipe(self) -> None:
        """Raise UnreadError if the reader of the results has closed the pipe; discard remarks."""
        if not self.stderr:
            raise UnreadError
        silence(sys.stderr)


class TimeLeft(TimeRemainingColumn):
    """The estimated time that is left; empty while there is no estimate."""

    def render(self, task: Task) -> Text:
        """Return the time that is left, in words."""
        left = super().render(task)
        return Text("") if "-" in left.plain else Text.assemble(left, " left")


OUT = Screen(emoji=False)
NOTES = Screen(stderr=True, emoji=False)
"""Console for progress and remarks: standard error, so that results can be piped."""


def _check_writable(where: str | None) -> str | None:
    """Reject a file that cannot be written, before anything is computed."""
    if where and where != "-":
        expect_writable(Path(where))
    return where


Json = Annotated[
    str | None,
    typer.Option(
        "--json", metavar="FILE|-", help="Write the result as JSON.", callback=_check_writable
    ),
]
"""The option of every command that has a result."""

INTERRUPTED_STATUS = 130
"""Exit status of typer after Ctrl-C."""
UNREAD_STATUS = 141
"""Exit status of a program that writes to a closed pipe: 128 + SIGPIPE."""
LOG_INTERVAL = 60.0
"""Time between lines about progress where the output is no terminal [s]."""
MOST_WARNINGS = 20
"""Largest number of warnings shown."""


def _say_duration(name: str, start: float) -> None:
    """Print the duration of a stage, with a tick if the encoding of the output has one."""
    tick = "[green]✓[/] " if "✓".encode(NOTES.encoding, "ignore") else ""
    NOTES.print(f"{tick}{name} [dim]{time.perf_counter() - start:.1f} s[/]")


@contextmanager
def stage(name: str) -> Iterator[None]:
    """Show that a stage is running, and then its duration."""
    start = time.perf_counter()
    with NOTES.status(f"{name} ..."):
        yield
    _say_duration(name, start)


@contextmanager
def progress_bar(name: str, *, alike: bool = False) -> Iterator[Progress]:
    """Show a bar for work in parts, and then its duration; arguments as for `transient_bar`."""
    start = time.perf_counter()
    with transient_bar(name, alike=alike) as progress:
        yield progress
    _say_duration(name, start)


@contextmanager
def transient_bar(name: str, *, alike: bool = False) -> Iterator[Progress]:
    """Show a bar and a clock on a terminal; yield the function that reports a part of the work.

    Where the output is no terminal, such as a log file, a line is written about every minute.

    Parameters
    ----------
    name
        Name of the work.
    alike
        Whether all parts take about the same time: the time that is left is then estimated.
    """
    part = TextColumn("{task.description}", markup=False)
    left = (TimeLeft(),) if alike else ()
    columns = (
        TextColumn(name),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        *left,
        part,
    )
    with Display(*columns, console=NOTES, transient=True, disable=not NOTES.is_terminal) as bar:
        task, said = bar.add_task("", total=None), time.monotonic()

        def report(part: str, number: int, total: int) -> None:
            nonlocal said
            bar.update(task, description=part, completed=number - 1, total=total)
            if not NOTES.is_terminal and time.monotonic() - said >= LOG_INTERVAL:
                said, left = time.monotonic(), bar.tasks[0].time_remaining if alike else None
                estimate = f", {timedelta(seconds=round(left))} left" if left else ""
                NOTES.say(f"{name}: {number - 1} of {total}{estimate}")

        yield report


@contextmanager
def search_clock(name: str) -> Iterator[Callable[[str, int, float], None]]:
    """Show a clock for a search; yield the function that reports name, count and worst ratio."""
    now = TextColumn("{task.description}", markup=False)
    columns = (TextColumn(name), SpinnerColumn(), TimeElapsedColumn(), now)
    with Display(*columns, console=NOTES, transient=True, disable=not NOTES.is_terminal) as bar:
        task = bar.add_task("", total=None)
        yield lambda name, count, worst: bar.update(
            task, description=f"{count} points, worst ratio {worst:.3g}, now {name}"
        )


@contextmanager
def progress_status(name: str) -> Iterator[None]:
    """Show the announced progress of a computation of unknown length, on a terminal only."""
    from derivation.engine.activity import listening

    if not NOTES.is_terminal:
        yield
        return
    with Display(
        SpinnerColumn(),
        TextColumn(name),
        TimeElapsedColumn(),
        TextColumn("{task.description}"),
        console=NOTES,
        transient=True,
    ) as shown:
        task = shown.add_task("", total=None)
        with listening(lambda text: shown.update(task, description=text)):
            yield


def table(title: str, columns: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
    """Print a table; columns whose name starts with `#` are numbers, aligned right.

    The first column is not wrapped if it contains single words.
    """
    heading = Text(one_line(title, 200), style="table.title")
    made = Table(title=heading, title_justify="left")
    names = not any(" " in str(row[0]) for row in rows)
    for index, column in enumerate(columns):
        number = column.startswith("#")
        made.add_column(
            Text(printable(column.lstrip("#"))),  # "[m]" is a unit, not markup
            justify="right" if number else "left",
            overflow="fold",
            no_wrap=names and index == 0 and not number,
        )
    for row in rows:
        made.add_row(*(Text(printable(str(cell))) for cell in row))
    OUT.print(made)


def listing(title: str, lines: Sequence[str]) -> None:
    """Print a title and lines without additional line breaks, so that they can be copied."""
    OUT.print(Text(one_line(title, 200), style="italic"))
    for line in lines:
        OUT.say(line)


def warn(warnings: Sequence[str]) -> None:
    """Show each warning once, on standard error; of many, the first `MOST_WARNINGS`."""
    unique = list(dict.fromkeys(warnings))
    for text in unique[:MOST_WARNINGS]:
        NOTES.say(paragraph(f"warning: {text}"))
    if len(unique) > MOST_WARNINGS:
        NOTES.say(f"warning: ... and {len(unique) - MOST_WARNINGS:,} more")


@contextmanager
def warnings_as_notes(shown: type[Warning]) -> Iterator[None]:
    """Show each warning of a category once, as a remark; show others as Python does."""
    seen, usual = set[str](), warnings.showwarning

    def show(
        message: Warning | str,
        category: type[Warning],
        filename: str,
        lineno: int,
        file: TextIO | None = None,
        line: str | None = None,
    ) -> None:
        text = str(message)
        if not issubclass(category, shown):
            usual(message, category, filename, lineno, file, line)
        elif text not in seen:
            seen.add(text)
            NOTES.say(f"note: {text}")

    with warnings.catch_warnings():
        warnings.simplefilter("always", shown)
        warnings.showwarning = show
        yield


def json_text(result: Any) -> str:
    """Return a result as indented JSON.

    Raises
    ------
    ValueError
        If a number is NaN or infinite, which JSON does not allow.
    """
    try:
        text = json.dumps(result, indent=2, ensure_ascii=False, allow_nan=False)
    except ValueError:
        raise ValueError(
            "--json: expected finite numbers, got NaN or infinity; run it without --json"
        ) from None
    return in_json(text) + "\n"


def write_output(text: str) -> None:
    """Write text to standard output without changes."""
    try:
        print(text, end="", flush=True)
    except BrokenPipeError:
        raise UnreadError from None


def write_json_output(make: Callable[[], Any], where: str | None) -> bool:
    """Write a result as JSON to a file, or to standard output for `-`.

    Call it before anything is shown, because the reader of the output may close the pipe.

    Parameters
    ----------
    make
        Function that returns the result; called if JSON is requested.
    where
        The file, `-`, or an empty text for no JSON.

    Returns
    -------
    bool
        Whether tables may be printed.
    """
    if where == "-":
        write_output(json_text(make()))
    elif where:
        write_file(Path(where), json_text(make()))
    return where != "-"
