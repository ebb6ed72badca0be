"""Sweeps one key of a scene: a simulation per value, a row for each."""

import csv
import io
import signal
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context

import numpy as np

from derivation.engine.activity import Tell, quiet
from derivation.engine.text import aligned, paragraph
from derivation.scene.impact import simulate
from derivation.scene.keys import EXAMPLE, number_key, varied
from derivation.scene.quantity import common_prefix
from derivation.scene.result import UNITS
from derivation.scene.scene import Scene, SceneError, read

MOST = 100_000
"""Largest number of values of a sweep."""
LONG = 3.0
"""Seconds of work from which other processes are worth their start."""
MOST_DIGITS = 4
"""Largest number of significant digits of a table on a screen."""
SYMBOLS = {
    "contact_time": "t_c",
    "max_indentation": "δ",
    "max_force": "P",
    "max_contact_radius": "a",
    "restitution": "e",
    "max_pressure": "p",
    "max_tensile_stress": "σ",
}
"""Symbols of the results, for a table on a screen."""


@dataclass(frozen=True)
class Sweep:
    """One key and the values it is to take.

    Attributes
    ----------
    table, key
        Where it stands in the scene file.
    values
        What it takes, in SI.
    """

    table: str
    key: str
    values: tuple[float, ...]


@dataclass(frozen=True)
class SweepRow:
    """A value and what came of it.

    Attributes
    ----------
    value
        What the key took.
    results
        By name, in SI; empty if the scene was refused.
    effects
        Names of the effects included.
    remark
        Warnings, or why the scene was refused.
    digits
        Number of significant digits of the results that hold; 0 without results.
    """

    value: float
    results: dict[str, float]
    effects: tuple[str, ...]
    remark: str
    digits: int = 0


def parse(text: str) -> Sweep:
    """A sweep from `table.key=first:last:count`, values evenly spaced, both ends included.

    With `:log` behind the count their logarithms are evenly spaced. A key of a scene's own
    material is `materials.NAME.key`.

    Raises
    ------
    SceneError
        If the text is not of this form, or names no number of a scene file.
    """
    place, _, span = text.partition("=")
    table, key = number_key(place)
    parts, logarithmic = span.removesuffix(":log").split(":"), span.endswith(":log")
    try:
        first, last, count = float(parts[0]), float(parts[1]), int(parts[2])
    except (ValueError, IndexError):
        raise SceneError(f"sweep: expected first:last:count, got {span!r:.60}; {EXAMPLE}") from None
    if len(parts) != 3 or not 1 <= count <= MOST or not np.isfinite([first, last]).all():
        raise SceneError(
            f"sweep: expected finite ends and 1 to {MOST} values, got {span!r:.60}; {EXAMPLE}"
        )
    if logarithmic and min(first, last) <= 0:
        raise SceneError(
            f"sweep: expected positive ends of a logarithmic spacing, got {span!r:.60}; leave out "
            ":log, or give positive ends"
        )
    spaced = np.geomspace if logarithmic else np.linspace
    return Sweep(table, key, tuple(spaced(first, last, count).tolist()))


def run(
    scene: Scene,
    sweep: Sweep,
    rtol: float | None = None,
    tell: Tell = quiet,
    workers: int = 1,
) -> tuple[SweepRow, ...]:
    """Simulate the scene once per value; a scene that is refused is a row that says why.

    Parameters
    ----------
    rtol
        As `simulate` takes it.
    tell
        Called before each, with what is done, its number and how many there are.
    workers
        Processes that share the work if it takes long. Each of several begins by importing the
        main module: a script that asks for them has to guard what it runs.
    """
    found, rows = _rows(scene, sweep, rtol, workers), list[SweepRow]()
    for number in range(1, len(sweep.values) + 1):
        tell(f"{sweep.table}.{sweep.key}", number, len(sweep.values))
        rows.append(next(found))
    return tuple(rows)


def _rows(scene: Scene, sweep: Sweep, rtol: float | None, workers: int) -> Iterator[SweepRow]:
    """The rows in the order of the values; by the first it is judged how long they take."""
    one, start = partial(_row, scene, sweep, rtol), time.perf_counter()
    yield one(sweep.values[0])
    if workers == 1 or (time.perf_counter() - start) * len(sweep.values) < LONG:
        yield from map(one, sweep.values[1:])
        return
    pool = ProcessPoolExecutor(workers, get_context("spawn"), initializer=_leave_interrupts)
    try:
        with unheard_interrupts():
            found = pool.map(one, sweep.values[1:])
        yield from found
    except BrokenProcessPool:
        raise SceneError(
            "sweep: expected every process to finish its share, but one was ended from outside, "
            "for want of memory perhaps; run it again with fewer values"
        ) from None
    finally:
        # Not waited for, it would be forgotten, and what was to be cancelled computed to the end.
        pool.shutdown(wait=True, cancel_futures=True)


@contextmanager
def unheard_interrupts() -> Iterator[None]:
    """Let processes that are begun meanwhile never hear of Ctrl-C."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _leave_interrupts() -> None:
    """Ctrl-C is the main process's, which ends the others."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _row(scene: Scene, sweep: Sweep, rtol: float | None, value: float) -> SweepRow:
    data = varied(scene, {f"{sweep.table}.{sweep.key}": value})
    try:
        found = simulate(read(data), rtol=rtol)
    except SceneError as error:
        return SweepRow(value, {}, (), f"refused: {error}")
    results = {name: getattr(found, name) for name in UNITS}
    included = found.effects.included
    if not found.complete:  # there is no restitution: an empty row with the reason
        return SweepRow(value, {}, included, found.incomplete_note)
    return SweepRow(value, results, included, "; ".join(found.warnings), found.digits)


def to_csv(sweep: Sweep, rows: Sequence[SweepRow]) -> str:
    """The rows as CSV, numbers to the last bit; results that there are not are empty."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([f"{sweep.table}.{sweep.key}", *UNITS, "effects", "remark"])
    for row in rows:
        numbers = (repr(row.results[name]) if row.results else "" for name in UNITS)
        writer.writerow([repr(row.value), *numbers, " ".join(row.effects), row.remark])
    return text.getvalue()


def to_text(sweep: Sweep, rows: Sequence[SweepRow]) -> str:
    """The rows as a table for a screen: each result in one multiple of its unit."""
    known = [row for row in rows if row.results]
    fewest = min((row.digits for row in known), default=MOST_DIGITS)
    heads, columns = [f"#{sweep.key}"], [[f"{row.value:.6g}" for row in rows]]
    for name, unit in UNITS.items():
        values, multiple = np.array([row.results[name] for row in known]), unit
        if unit != "1":
            values, multiple = common_prefix(values, unit, fewest)
        heads.append(f"#{SYMBOLS[name]} [{multiple}]")
        cells = (
            f"{value:#.{min(row.digits, MOST_DIGITS)}g}".removesuffix(".")
            for row, value in zip(known, values, strict=True)
        )
        columns.append([next(cells) if row.results else "n/a" for row in rows])
    legend = ", ".join(f"{SYMBOLS[name]} {name.replace('_', ' ')}" for name in UNITS)
    return f"{aligned(heads, list(zip(*columns, strict=True)))}\n\n{paragraph(legend, 0)}"
