"""The finished batches of a study as files, each written completely or not at all."""

import json
import os
import re
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from derivation.engine.files import expect_folder, explained, real
from derivation.engine.staging import locked_folder
from derivation.scene.errors import SceneError
from derivation.scene.result import UNITS
from derivation.scene.rows.rows import Rows
from derivation.sweep.plan import gaps
from derivation.sweep.study import Study

FILE = re.compile(r"(\d+)-(\d+)-([0-9a-f]+)\.parquet")
"""File name of a batch: first point, the point after the last one, and hash of the points."""
TEXTS = ("status", "reason", "effects")
ERRORS = {name: f"{name}_error" for name in UNITS}
"""Name of the relative error of each result."""
NUMBERS = (*UNITS, *ERRORS.values(), "bound", "model_error")


@dataclass(frozen=True)
class PartFile:
    """A finished batch: the points from `start` to `stop` (exclusive), and their file."""

    start: int
    stop: int
    path: Path


class Store:
    """The finished batches of one study in a folder.

    Parameters
    ----------
    study
        The study.
    folder
        Folder of the batches; it is created if it does not exist.

    Raises
    ------
    SceneError
        If the folder contains another study.
    """

    def __init__(self, study: Study, folder: Path) -> None:
        self.study, self.folder = study, folder
        expect_folder(folder)
        folder.mkdir(parents=True, exist_ok=True)
        self._claim()
        for left in folder.glob("*.temporary"):
            left.unlink()
        self.parts = sorted(self._batches(), key=lambda part: part.start)
        self._complete_journal()
        self._last: tuple[PartFile, Any] | None = None

    @property
    def done(self) -> int:
        """Number of computed points, including rejected and incomplete ones."""
        return sum(part.stop - part.start for part in self.parts)

    def missing(self) -> list[tuple[int, int]]:
        """Return the ranges of points that have not been computed."""
        ranges = [(part.start, part.stop) for part in self.parts]
        return list(gaps(ranges, self.study.plan.size))

    def failed(self) -> Iterator[tuple[PartFile, list[int]]]:
        """Yield each batch with rejected or incomplete points, and the indices of these points."""
        for part in list(self.parts):
            status = np.array(self._read(part)["status"].to_pylist())
            wrong = (np.flatnonzero(status != "finished") + part.start).tolist()
            if wrong:
                yield part, wrong

    def keep(self, start: int, stop: int, content: bytes, seconds: float) -> None:
        """Write the file of a new batch, computed in a run time [s]."""
        points = self.study.plan.points(start, stop)
        name = f"{start:010d}-{stop:010d}-{self.study.points_hash(points)}.parquet"
        self._write(name, content)
        self.parts.append(PartFile(start, stop, self.folder / name))
        self._note(start, stop, stop - start, f"{seconds:.3g} s")

    def renew(self, part: PartFile, numbers: list[int], content: bytes, seconds: float) -> None:
        """Replace points of a batch, given by their indices and computed in a run time [s]."""
        import pyarrow as pa

        old = self._read(part)
        indices = np.arange(part.stop - part.start)
        indices[np.array(numbers) - part.start] = len(old) + np.arange(len(numbers))
        both = pa.concat_tables([old, _parquet_table(content)])
        self._write(part.path.name, _parquet_content(both.take(indices)))
        self._last = None
        self._note(part.start, part.stop, len(numbers), f"{seconds:.3g} s")

    def sort_batches(self) -> None:
        """Sort the batches, after all points have been computed."""
        self.parts.sort(key=lambda part: part.start)

    def table(self, start: int, stop: int) -> Any:
        """Return the results of the points from `start` to `stop` (exclusive), a pyarrow table."""
        import pyarrow as pa

        pieces = []
        for part in self.parts:
            if part.start < stop and start < part.stop:
                first, last = max(start, part.start), min(stop, part.stop)
                pieces.append(self._read(part).slice(first - part.start, last - first))
        return pa.concat_tables(pieces)

    def tables(self, size: int) -> Iterator[tuple[int, int, Any]]:
        """Yield all results in blocks of at most `size` points: start, stop and table of each."""
        total = self.study.plan.size
        for start in range(0, total, size):
            stop = min(start + size, total)
            yield start, stop, self.table(start, stop)

    def text_lengths(self) -> dict[str, int]:
        """Return the length of the longest text of each column of texts [bytes], at least 1."""
        widths = dict.fromkeys(TEXTS, 1)
        for part in self.parts:
            table = self._read(part)
            for name in TEXTS:
                for chunk in table[name].chunks:
                    lengths = (len(text.encode()) for text in chunk.dictionary.to_pylist())
                    widths[name] = max(widths[name], *lengths)
        return widths

    def _claim(self) -> None:
        """Write the description of the study into the folder, or compare it with the one there.

        Raises
        ------
        SceneError
            If the folder contains another study.
        """
        file = self.folder / "study.json"
        if file.is_file():
            try:
                same = json.loads(file.read_text()).get("hash") == self.study.name
            except (ValueError, AttributeError):
                same = False
            if not same:
                raise SceneError(
                    f"{self.folder}: expected batches of this study, got those of another one "
                    "(different scene, points, tolerance or version); use another output, or "
                    "remove this folder"
                )
            return
        text = json.dumps({"hash": self.study.name} | self.study.to_json(), indent=1)
        self._write(file.name, text.encode())

    def _batches(self) -> Iterator[PartFile]:
        """Yield the batches in the folder that are complete and whose points have the same hash."""
        reached = 0
        for path in sorted(self.folder.glob("*.parquet")):
            if not (known := FILE.fullmatch(path.name)):
                continue
            start, stop = int(known[1]), int(known[2])
            if not reached <= start < stop <= self.study.plan.size:
                continue
            points = self.study.plan.points(start, stop)
            if self.study.points_hash(points) == known[3] and _rows_in(path) == stop - start:
                reached = stop
                yield PartFile(start, stop, path)

    def _read(self, part: PartFile) -> Any:
        """Return the table of a batch; the last one is cached."""
        if self._last is None or self._last[0] != part:
            self._last = part, _parquet_table(part.path.read_bytes())
        return self._last[1]

    def _write(self, name: str, content: bytes) -> None:
        """Write a file completely or not at all, even if the machine fails."""
        temporary = self.folder / f"{name}.temporary"
        with explained(self.folder):
            try:
                with temporary.open("wb") as stream:
                    stream.write(content)
                    stream.flush()
                    os.fsync(stream.fileno())
                temporary.replace(self.folder / name)
            except BaseException:  # also Ctrl-C
                temporary.unlink(missing_ok=True)
                raise

    def _note(self, start: int, stop: int, computed: int, duration: str) -> None:
        """Add a line to the journal of computed batches."""
        with (self.folder / "journal.txt").open("a") as stream:
            stream.write(f"{start} {stop} {computed} points {duration}\n")

    def _complete_journal(self) -> None:
        """Add the lines of batches whose run was killed between the file and its line."""
        journal = self.folder / "journal.txt"
        lines = journal.read_text().splitlines(keepends=True) if journal.is_file() else []
        whole = [line for line in lines if line.endswith("\n")]
        if whole != lines:
            self._write(journal.name, "".join(whole).encode())
        noted = {tuple(line.split()[:2]) for line in whole}
        for part in self.parts:
            if (str(part.start), str(part.stop)) not in noted:
                self._note(part.start, part.stop, part.stop - part.start, "unknown run time")


def to_parquet(rows: Rows) -> bytes:
    """Return results as the content of a Parquet file."""
    import pyarrow as pa

    numbers = rows.results | {ERRORS[name]: error for name, error in rows.errors.items()}
    numbers |= {"bound": rows.bound, "model_error": rows.model_error}
    columns = {name: pa.array(numbers[name], pa.float64()) for name in NUMBERS}
    columns |= {name: pa.array(getattr(rows, name).tolist(), pa.string()) for name in TEXTS}
    return _parquet_content(pa.table(columns))


def _parquet_content(table: Any) -> bytes:
    import pyarrow as pa
    import pyarrow.parquet as pq

    stream = pa.BufferOutputStream()
    # Numbers hardly repeat: looking for repeated ones would take most of the time.
    pq.write_table(table, stream, compression="zstd", use_dictionary=list(TEXTS))
    return stream.getvalue().to_pybytes()  # type: ignore[no-any-return]


def _parquet_table(content: bytes) -> Any:
    """Return the table in the content of a Parquet file, with each different text once.

    No threads are used: a pyarrow thread that still reads a Python stream when Python exits would
    abort the process.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    file = pq.ParquetFile(pa.BufferReader(content), read_dictionary=list(TEXTS))
    return file.read(use_threads=False)


def _rows_in(path: Path) -> int:
    """Return the number of rows of a Parquet file; 0 if it is damaged or lacks a column."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        known = pq.read_metadata(path)
        return int(known.num_rows) if {*NUMBERS, *TEXTS} <= {*known.schema.names} else 0
    except pa.ArrowInvalid:
        return 0


@contextmanager
def open_store(study: Study, out: Path | None) -> Iterator[Store]:
    """Yield the store in the folder of an output, or without an output a temporary store.

    Raises
    ------
    SceneError
        If the output exists without its folder, the folder contains another study, or another
        process is using it.
    """
    if out is not None:
        if out.exists() and not (parts_folder(out) / "study.json").is_file():
            raise SceneError(
                f"{out}: expected a new output or one of this study, got a file without its folder "
                f"{parts_folder(out).name}; use another output, or remove the file"
            )
        folder = parts_folder(out)
        expect_folder(folder)
        folder.mkdir(parents=True, exist_ok=True)
        with ExitStack() as stack:
            try:
                stack.enter_context(locked_folder(folder))
            except BlockingIOError:
                raise SceneError(
                    f"{out}: expected an output that no other run is writing, got one in use; wait "
                    "until the other run has ended, or use another output"
                ) from None
            yield Store(study, folder)
        return
    with TemporaryDirectory(prefix="platecontact-") as temporary:
        yield Store(study, Path(temporary))


def parts_folder(out: Path) -> Path:
    """Return the folder of the batches of an output: its name with `.parts` added.

    For a link it is next to the target of the link.
    """
    target = real(out) if out.is_symlink() else out
    return target.with_name(f"{target.name}.parts")
