"""Writes the results of a study block by block: .nc, .zarr, .parquet or .csv."""

import csv
import io
import shutil
import warnings
from collections.abc import Callable, Iterable, Iterator
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from derivation.engine.activity import Progress
from derivation.engine.files import expect_folder, expect_writable, explained, real
from derivation.engine.nearest import did_you_mean
from derivation.engine.printable import one_line
from derivation.scene.errors import SceneError
from derivation.sweep.dataset import attributes, column, labels
from derivation.sweep.plan import GridPlan
from derivation.sweep.store import NUMBERS, TEXTS, Store

SUFFIXES = (".nc", ".zarr", ".parquet", ".csv")
LONGEST_KEY = 200
"""Longest name of an array in netCDF and Zarr files [bytes]."""
Dims = tuple[str, ...]
Labels = dict[str, str]
Slices = tuple[slice, ...]
Fill = Callable[[Slices, Any], None]
"""Writes values into a part of an array."""
BLOCK = 2**16
"""Largest number of points that are in memory while a file is written."""


def check_output_file(out: Path, keys: Iterable[str]) -> None:
    """Raise an error if an output has no known suffix or cannot be written.

    Raises
    ------
    SceneError
        If its suffix is not one of `SUFFIXES`, or its format does not allow the name of a key.
    OSError
        If it cannot be written.
    """
    if out.suffix not in SUFFIXES:
        meant = did_you_mean(out.suffix, SUFFIXES).rstrip() or "change the file name"
        raise SceneError(
            f"out: expected a file name with one of the suffixes {', '.join(SUFFIXES)}, got {out}; "
            f"{meant}"
        )
    for key in keys if out.suffix in (".nc", ".zarr") else ():
        if set("/\\") & set(key) or len(key.encode()) > LONGEST_KEY:
            raise SceneError(
                f"out: expected keys without / and \\ and with at most {LONGEST_KEY} letters for "
                f"a {out.suffix} file, got {one_line(key)}; rename the material, or write a "
                ".parquet or .csv file"
            )
    (expect_folder if out.suffix == ".zarr" else expect_writable)(out)


def write(store: Store, out: Path, progress: Progress) -> None:
    """Write all results of a finished study into a file, completely or not at all.

    Parameters
    ----------
    store
        The finished batches.
    out
        The file; for Zarr the folder.
    progress
        Called after each block with the index of the next point and the number of all.
    """
    temporary = store.folder / f"{out.stem}.writing{out.suffix}"
    _remove(temporary)
    writers: dict[str, Callable[[Store, Path, Progress], None]] = {
        ".nc": _netcdf,
        ".zarr": _zarr,
        ".parquet": _parquet,
        ".csv": _csv,
    }
    try:
        with explained(out):
            writers[out.suffix](store, temporary, progress)
            target = real(out)  # a link is kept; its target is replaced
            if temporary.is_dir():
                _remove(target)
            temporary.replace(target)
    except BaseException:  # also Ctrl-C
        _remove(temporary)
        raise


def _remove(path: Path) -> None:
    if path.is_dir():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


def _csv(store: Store, path: Path, progress: Progress) -> None:
    import pyarrow as pa
    from pyarrow.csv import CSVWriter

    head = io.StringIO()
    csv.writer(head, lineterminator="\n").writerow([*store.study.plan.keys, *NUMBERS, *TEXTS])
    with pa.OSFile(str(path), "wb") as stream:
        stream.write(head.getvalue().encode())
        writer = None
        for table in _with_points(store, progress):
            if writer is None:
                writer = CSVWriter(stream, table.schema, write_options=_csv_options())
            writer.write_table(table)
        if writer is not None:
            writer.close()


def _csv_options() -> Any:
    """Return CSV options: no head, which pyarrow would quote; quotes only where needed."""
    from pyarrow.csv import WriteOptions

    return WriteOptions(include_header=False, quoting_style="needed")


def _parquet(store: Store, path: Path, progress: Progress) -> None:
    import pyarrow.parquet as pq

    writer, plan = None, store.study.plan
    for table in _with_points(store, progress):
        if writer is None:
            # Results hardly repeat: looking for repeated ones would take most of the time.
            known = (*TEXTS, *(plan.keys if isinstance(plan, GridPlan) else ()))
            writer = pq.ParquetWriter(
                path, table.schema, compression="zstd", use_dictionary=list(known)
            )
        writer.write_table(table)
    if writer is not None:
        writer.close()


def _with_points(store: Store, progress: Progress) -> Iterator[Any]:
    """Yield tables of points and results with units; missing numbers are null."""
    import pyarrow as pa

    study = store.study
    for start, stop, table in store.tables(BLOCK):
        columns = {
            name: pa.array(values, pa.string() if name in study.plan.names else pa.float64())
            for name, values in study.plan.points(start, stop).items()
        }
        columns |= {name: pa.array(column(table, name), from_pandas=True) for name in NUMBERS}
        columns |= {name: table[name].cast(pa.string()) for name in TEXTS}
        fields = [pa.field(name, v.type, metadata=labels(name)) for name, v in columns.items()]
        metadata = {name: str(value) for name, value in attributes(study).items()}
        yield pa.table(list(columns.values()), schema=pa.schema(fields, metadata=metadata))
        progress("write", stop + 1, study.plan.size)


def _zarr(store: Store, path: Path, progress: Progress) -> None:
    import zarr

    group = zarr.open_group(path, mode="w")
    group.attrs.update(attributes(store.study))
    texts = {*TEXTS, *store.study.plan.names}

    def create(name: str, dims: Dims, blocks: tuple[int, ...], about: Labels) -> Fill:
        made: Any = group.create_array(
            name,
            shape=tuple(store.study.plan.dims[dim] for dim in dims),
            chunks=blocks,
            dtype=str if name in texts else "float64",
            fill_value="" if name in texts else float("nan"),
            dimension_names=dims,
            attributes=about,
        )
        fill: Fill = made.__setitem__
        return fill

    _arrays(store, create, progress)
    with warnings.catch_warnings():  # of metadata that are not standard, but optional
        warnings.simplefilter("ignore")
        zarr.consolidate_metadata(path)


def _netcdf(store: Store, path: Path, progress: Progress) -> None:
    import h5netcdf

    names = store.study.plan.names.items()
    lengths = store.text_lengths() | {
        key: max(len(name.encode()) for name in given) for key, given in names
    }
    with h5netcdf.File(path, "w") as file:
        file.attrs.update(attributes(store.study))
        file.dimensions = store.study.plan.dims

        def create(name: str, dims: Dims, blocks: tuple[int, ...], about: Labels) -> Fill:
            if name in lengths:
                return _characters(file, name, lengths[name], dims, blocks, about)
            made: Any = file.create_variable(name, dims, "f8", chunks=blocks)
            made.attrs.update(about)
            fill: Fill = made.__setitem__
            return fill

        _arrays(store, create, progress)


def _characters(
    file: Any, name: str, length: int, dims: Dims, blocks: tuple[int, ...], about: Labels
) -> Fill:
    """Create an array of compressed characters, which xarray reads as texts.

    HDF5 does not compress strings of variable length, which would take several times the space.
    """
    import pandas as pd

    last = f"{name}_length"
    file.dimensions[last] = length
    made = file.create_variable(
        name, (*dims, last), "S1", chunks=(*blocks, length), compression="gzip", compression_opts=1
    )
    made.attrs.update(about | {"_Encoding": "utf-8"})

    def fill(slices: Slices, texts: Any) -> None:
        which, different = pd.factorize(texts.ravel())
        coded = np.array([text.encode() for text in different], dtype=f"S{length}")
        made[slices] = coded[which].view("S1").reshape(*texts.shape, length)

    return fill


def _arrays(store: Store, create: Callable[..., Fill], progress: Progress) -> None:
    """Fill an array for each result, over the dimensions of the study, and one for each key."""
    study, plan = store.study, store.study.plan
    dims, shape = tuple(plan.dims), tuple(plan.dims.values())
    chunks = _chunks(shape)
    points: dict[str, Fill] = {}
    if isinstance(plan, GridPlan):
        for key, values in plan.axes.items():
            create(key, (key,), (len(values),), labels(key))((slice(None),), np.array(values))
    else:
        points = {key: create(key, dims, chunks, labels(key)) for key in plan.keys}
    beside = {"coordinates": " ".join(points)} if points else {}  # by the CF conventions
    made = {name: create(name, dims, chunks, labels(name) | beside) for name in (*NUMBERS, *TEXTS)}
    for slices, start, stop in blocks(shape):
        table = store.table(start, stop)
        for name, fill in made.items():
            fill(slices, column(table, name).reshape(_extent(shape, slices)))
        if points:
            coordinates = study.plan.points(start, stop)
            for key, fill in points.items():
                fill(slices, coordinates[key])
        progress("write", stop + 1, plan.size)


def blocks(shape: tuple[int, ...]) -> Iterator[tuple[Slices, int, int]]:
    """Yield contiguous pieces of an array of at most `BLOCK` elements.

    Each piece has its slices, the index of its first element, and the index after its last.
    """
    chunks = _chunks(shape)
    counts = tuple(-(-length // part) for length, part in zip(shape, chunks, strict=True))
    start = 0
    for number in range(prod(counts)):
        where, slices = number, []
        for length, part, count in list(zip(shape, chunks, counts, strict=True))[::-1]:
            where, index = divmod(where, count)
            slices.append(slice(index * part, min((index + 1) * part, length)))
        piece = tuple(slices[::-1])
        stop = start + prod(_extent(shape, piece))
        yield piece, start, stop
        start = stop


def _extent(shape: tuple[int, ...], slices: Slices) -> tuple[int, ...]:
    """Return the lengths of a piece."""
    pairs = zip(shape, slices, strict=True)
    return tuple(len(range(*part.indices(length))) for length, part in pairs)


def _chunks(shape: tuple[int, ...]) -> tuple[int, ...]:
    """Return the lengths of pieces: whole last dimensions, a part of one, 1 in the first ones."""
    lengths, room = list[int](), BLOCK
    for length in shape[::-1]:
        lengths.append(max(1, min(length, room)))
        room = room // length
    return tuple(lengths[::-1])
