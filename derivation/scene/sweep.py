"""Sweeps one key of a scene: a simulation and a row for each value."""

import csv
import io
import math
import signal
import time
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from multiprocessing import get_context

import numpy as np

from derivation.engine.activity import Progress, quiet
from derivation.engine.text import aligned, paragraph
from derivation.scene.errors import SceneError
from derivation.scene.impact import simulate
from derivation.scene.input.keys import (
    EXAMPLE,
    check_names,
    takes_names,
    varied,
    varied_key,
    written,
)
from derivation.scene.input.messages import OWN_MATERIALS
from derivation.scene.quantity import common_prefix
from derivation.scene.result import UNITS
from derivation.scene.scene import Scene, read

MOST = 100_000
"""Largest number of values of a sweep."""
LONG = 3.0
"""Run time [s] from which other processes are started."""
MOST_DIGITS = 4
"""Largest number of significant digits in the table."""
SYMBOLS = {
    "contact_time": "t_c",
    "max_indentation": "δ",
    "max_force": "P",
    "max_contact_radius": "a",
    "restitution": "e",
    "max_pressure": "p",
    "max_tensile_stress": "σ",
}
"""Symbols of the results in the table."""


Values = tuple[float, ...] | tuple[str, ...]
"""Numbers in SI units, or names."""


@dataclass(frozen=True)
class Sweep:
    """A key and its values.

    Attributes
    ----------
    key
        Key `table.key` of the scene file.
    values
        Numbers in SI units, or names.
    """

    key: str
    values: Values


@dataclass(frozen=True)
class SweepRow:
    """The results for one value.

    Attributes
    ----------
    value
        Value of the key.
    results
        Results by name, in SI units; empty if the scene was rejected.
    effects
        Names of the included effects.
    remark
        Warnings, or why the scene was rejected.
    digits
        Number of significant digits of each result; empty without results.
    """

    value: float | str
    results: dict[str, float]
    effects: tuple[str, ...]
    remark: str
    digits: Mapping[str, int] = field(default_factory=dict)


def parse(text: str) -> Sweep:
    """Read a sweep: `table.key=first:last:count`, or `table.key=value,value,...`.

    The former has evenly spaced values, both ends included; with `:log` after the count, they are
    evenly spaced on a logarithmic scale. The latter are numbers or, for a key such as
    plate.material, names. A key of a material defined in the scene is `materials.NAME.key`.

    Raises
    ------
    SceneError
        If the text does not have this form, or the key takes neither numbers nor names.
    """
    own = text.lstrip().startswith(f"{OWN_MATERIALS}.")  # its name may contain an equals sign
    place, _, span = text.rpartition("=") if own else text.partition("=")
    key = varied_key(place)
    return Sweep(key, values_in(key, span))


def values_in(key: str, span: str) -> Values:
    """Return the values of a key in a text after `table.key=`."""
    if takes_names(key):
        return _names(key, span)
    return _spaced(span) if ":" in span else _listed(span)


def _names(key: str, span: str) -> tuple[str, ...]:
    """Return the names in a list `name,name,...`; those with a comma are in double quotes."""
    try:
        [names] = csv.reader([span], skipinitialspace=True)
    except (csv.Error, ValueError):
        names = []
    given = tuple(name.strip() for name in names)
    if not 1 <= len(given) <= MOST or not all(given):
        raise SceneError(
            f"sweep: {key}: expected names separated by commas, got {span!r:.60}; write for "
            "example plate.material=glass,steel, and double quotes around a name with a comma"
        )
    return given


def _listed(span: str) -> tuple[float, ...]:
    """Return the numbers in a list `value,value,...`."""
    try:
        values = tuple(map(float, span.split(",")))
    except ValueError:
        values = ()
    if not 1 <= len(values) <= MOST or not np.isfinite(values).all():
        raise SceneError(
            f"sweep: expected first:last:count or 1 to {MOST} finite values, got {span!r:.60}; "
            "write for example impact.speed=0.5:3:6 or impact.speed=0.5,1,3"
        )
    return values


def _spaced(span: str) -> tuple[float, ...]:
    """Return the values of a range `first:last:count` or `first:last:count:log`."""
    parts, logarithmic = span.removesuffix(":log").split(":"), span.endswith(":log")
    try:
        first, last, count = float(parts[0]), float(parts[1]), int(parts[2])
    except (ValueError, IndexError):
        raise SceneError(
            f"sweep: expected first:last:count or value,value,..., got {span!r:.60}; {EXAMPLE}"
        ) from None
    if len(parts) != 3 or not 1 <= count <= MOST or not np.isfinite([first, last]).all():
        raise SceneError(
            f"sweep: expected finite ends and 1 to {MOST} values of a key, got {span!r:.60}; "
            f"{EXAMPLE}; for more points, `platecontact sweep` takes several keys, or --sample N"
        )
    if logarithmic and min(first, last) <= 0:
        raise SceneError(
            f"sweep: expected positive ends for logarithmic spacing, got {span!r:.60}; remove "
            ":log, or use positive ends"
        )
    spaced = np.geomspace if logarithmic else np.linspace
    return tuple(spaced(first, last, count).tolist())


def run(
    scene: Scene,
    sweep: Sweep,
    rtol: float | None = None,
    progress: Progress = quiet,
    workers: int = 1,
) -> tuple[SweepRow, ...]:
    """Simulate the scene for each value; the row of a rejected scene states the reason.

    Parameters
    ----------
    scene
        The scene.
    sweep
        The key and its values.
    rtol
        Relative tolerance of the results [1], as in `simulate`.
    progress
        Called before each simulation with the key, the index of the value and their number.
    workers
        Number of processes, used if the sweep takes long. Each process imports the main module,
        so that a script must guard its main part with `if __name__ == "__main__"`.

    Raises
    ------
    SceneError
        If a name is unknown.
    """
    names = {sweep.key: [str(name) for name in sweep.values]} if takes_names(sweep.key) else {}
    check_names(scene, names, [sweep.key])
    results, rows = _rows(scene, sweep, rtol, workers), list[SweepRow]()
    for number in range(1, len(sweep.values) + 1):
        progress(sweep.key, number, len(sweep.values))
        rows.append(next(results))
    return tuple(rows)


def _rows(scene: Scene, sweep: Sweep, rtol: float | None, workers: int) -> Iterator[SweepRow]:
    """Yield the rows in the order of the values; the first one gives an estimate of the time."""
    one, start = partial(_row, scene, sweep, rtol), time.perf_counter()
    yield one(sweep.values[0])
    if workers == 1 or (time.perf_counter() - start) * len(sweep.values) < LONG:
        yield from map(one, sweep.values[1:])
        return
    pool = ProcessPoolExecutor(workers, get_context("spawn"), initializer=_leave_interrupts)
    try:
        with unheard_interrupts():
            rows = pool.map(one, sweep.values[1:])
        yield from rows
    except BrokenProcessPool:
        raise SceneError(
            "sweep: a process was terminated by the operating system, possibly for lack of memory; "
            "run the sweep again with fewer values"
        ) from None
    finally:
        # Without waiting, pending simulations would not be cancelled.
        pool.shutdown(wait=True, cancel_futures=True)


@contextmanager
def unheard_interrupts() -> Iterator[None]:
    """Let processes that start within this context ignore Ctrl-C."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _leave_interrupts() -> None:
    """Ignore Ctrl-C: the main process handles it and ends the others."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _row(scene: Scene, sweep: Sweep, rtol: float | None, value: float | str) -> SweepRow:
    data = varied(scene, {sweep.key: value})
    try:
        result = simulate(read(data), rtol=rtol)
    except SceneError as error:
        return SweepRow(value, {}, (), f"rejected: {error}")
    results = {name: getattr(result, name) for name in UNITS}
    included = result.effects.included
    if not result.complete:  # without restitution: a row without results, with the reason
        return SweepRow(value, {}, included, result.incomplete_note)
    digits = {name: result.digits_of_result(name) for name in UNITS}
    return SweepRow(value, results, included, "; ".join(result.warnings), digits)


def to_csv(sweep: Sweep, rows: Sequence[SweepRow]) -> str:
    """Return the rows as CSV in SI units, with all digits; missing results are empty."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([sweep.key, *UNITS, "effects", "remark"])
    for row in rows:
        numbers = (repr(row.results[name]) if row.results else "" for name in UNITS)
        value = row.value if isinstance(row.value, str) else repr(row.value)
        writer.writerow([value, *numbers, " ".join(row.effects), row.remark])
    return text.getvalue()


def to_text(sweep: Sweep, rows: Sequence[SweepRow]) -> str:
    """Return the rows as a table, each result with one SI prefix."""
    known = [row for row in rows if row.results]
    head = sweep.key.rpartition(".")[2]
    heads = [head if takes_names(sweep.key) else f"#{head}"]
    columns = [[written(row.value) for row in rows]]
    for name, unit in UNITS.items():
        symbol, cells = _column(known, name, unit)
        heads.append(symbol)
        texts = iter(cells)
        columns.append([next(texts) if row.results else "n/a" for row in rows])
    legend = ", ".join(f"{SYMBOLS[name]}: {name.replace('_', ' ')}" for name in UNITS)
    return f"{aligned(heads, list(zip(*columns, strict=True)))}\n\n{paragraph(legend, 0)}"


def _column(known: Sequence[SweepRow], name: str, unit: str) -> tuple[str, list[str]]:
    """Return the head and the cells of a result; `n/a` where it is unknown."""
    values, multiple = np.array([row.results[name] for row in known]), unit
    if unit != "1":
        fewest = min((max(1, row.digits[name]) for row in known), default=MOST_DIGITS)
        finite, multiple = common_prefix(values[np.isfinite(values)], unit, fewest)
        values[np.isfinite(values)] = finite
    shown = (min(row.digits[name], MOST_DIGITS) for row in known)
    cells = [
        f"{value:#.{digits}g}".removesuffix(".") if digits and math.isfinite(value) else "n/a"
        for value, digits in zip(values.tolist(), shown, strict=True)
    ]
    return f"#{SYMBOLS[name]} [{multiple}]", cells
