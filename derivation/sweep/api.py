"""Runs a study from Python and returns its results as a Dataset with units."""

import os
from collections.abc import Iterable, Mapping
from numbers import Integral
from pathlib import Path
from typing import TYPE_CHECKING, Any

from derivation.engine.activity import Progress
from derivation.engine.console import transient_bar
from derivation.scene.errors import SceneError
from derivation.scene.input.keys import check_names, written
from derivation.scene.input.messages import shown
from derivation.scene.scene import Scene, check_scene
from derivation.scene.selection.method_selection import check_rtol
from derivation.sweep.dataset import check_memory, column, data_set, fits_in_memory
from derivation.sweep.distributions import read_distributions
from derivation.sweep.plan import Plan, grid, saltelli, sample
from derivation.sweep.run import compute
from derivation.sweep.sensitivity import Sensitivities, sensitivities
from derivation.sweep.store import Store, open_store
from derivation.sweep.study import Study
from derivation.sweep.write import check_output_file, write

if TYPE_CHECKING:
    import xarray as xr

READ_AS_NEEDED = (".nc", ".zarr")
"""Suffixes of files from which a Dataset reads blocks as needed."""


def sweep(
    scene: Scene,
    vary: Mapping[str, Any],
    *,
    sample: int | None = None,
    seed: int = 1,
    method: str = "random",
    sensitivity: bool = False,
    rtol: float | None = None,
    out: str | Path | None = None,
    workers: int = 1,
    scheduler: str | None = None,
    retry: bool = False,
) -> "xr.Dataset":
    """Simulate a scene at every point of a grid or a sample; a terminal shows the progress.

    Parameters
    ----------
    scene
        The scene; the varied keys take other values.
    vary
        For each key, such as "plate.thickness", the values in SI units: for a grid a list, an array
        or a text such as "first:last:count", "first:last:count:log" or "0.5,1,3"; for a sample a
        distribution, for example ``{"distribution": "uniform", "low": 4e-3, "high": 12e-3}``. A key
        such as "plate.material" or "plate.edge" takes names: ``["glass", "steel"]``, the text
        "glass,steel" or ``{"distribution": "choice", "values": ["glass", "steel"]}``.
    sample
        Number of points of a sample; by default a grid is computed. It must be a power of two with
        the method "sobol" and with `sensitivity`. With `sensitivity` it is the number of base
        points; each base point takes two simulations and one for each key.
    seed
        Random seed of the sample.
    method
        Method of the sample: "random", "latin-hypercube" or "sobol". Do not give it with
        `sensitivity`.
    sensitivity
        Whether to compute variance-based sensitivity indices of a sample.
    rtol
        Relative tolerance of the results [1], as for `simulate`.
    out
        File for the results at all points, without sensitivity indices: .nc, .zarr, .parquet or
        .csv. An interrupted study continues from the finished batches in the folder
        ``OUT.parts``.
    workers
        Number of processes, used if the study takes long. Each process imports the main module, so
        that a script must guard its main part with ``if __name__ == "__main__"``.
    scheduler
        Address of a Dask scheduler, whose workers are used instead of processes.
    retry
        Whether to compute rejected and incomplete points of a continued study again.

    Returns
    -------
    xarray.Dataset
        Results over the dimensions of the grid, named as its keys, or over `sample`; with the
        relative error of each, such as `max_force_error`, and with `status` and `reason` of each
        point, `bound`, `model_error` and `effects`. With `sensitivity`, also the indices over
        `result` and `key`. More than two million points are not held in memory: the Dataset then
        reads blocks of the file `out` as Dask arrays.

    Raises
    ------
    SceneError
        If a key, value or option is not valid, all points are rejected, or, with `sensitivity`, a
        point has no result; for more than two million points with `sensitivity`, or without `out`
        as .nc or .zarr.

    Examples
    --------
    >>> import platecontact as pc
    >>> scene = pc.Scene(
    ...     sphere=pc.Sphere(radius=0.01, material="steel"),
    ...     plate=pc.Plate(radius=0.3, thickness=0.05, material="glass"),
    ...     impact=pc.Impact(speed=1.0),
    ... )
    >>> data = pc.sweep(scene, {"impact.speed": [0.5, 1.0]})
    >>> data["max_force"].dims, data["max_force"].units, data["impact.speed"].units
    (('impact.speed',), 'N', 'm/s')
    """
    check_scene(scene)
    workers = _whole("workers", workers, 1)
    rtol = None if rtol is None else check_rtol(rtol)
    study = Study(scene, make_plan(vary, sample, seed, method, sensitivity), rtol)
    path = None if out is None else _path(out)
    check(study, path)
    if sensitivity or path is None or path.suffix not in READ_AS_NEEDED:
        check_memory(study, "sweep")
    with open_store(study, path) as store:
        with transient_bar("sweep", alike=True) as progress:
            compute(store, workers, scheduler, retry, progress)
            indices = write_results(store, path, sensitivity, progress)
        data = data_set(store) if path is None or fits_in_memory(study) else _of_file(path)
    return data if indices is None else indices.add_to(data)


def _of_file(path: Path) -> "xr.Dataset":
    """Return the Dataset in a file, whose blocks are read as needed."""
    import xarray as xr

    return xr.open_dataset(path, chunks={})


def make_plan(
    vary: Mapping[str, Any] | Iterable[str],
    size: int | None,
    seed: int,
    method: str,
    sensitivity: bool,
) -> Plan:
    """Return the points of a study from arguments of `sweep`.

    Raises
    ------
    SceneError
        If an argument is not valid.
    """
    texts = isinstance(vary, Iterable) and not isinstance(vary, str) and size is None
    if not isinstance(vary, Mapping) and not texts:
        raise SceneError(
            f"vary: expected a mapping from key to values, got {shown(vary)}; write for example "
            '{"impact.speed": [0.5, 1.0]}'
        )
    seed = _whole("seed", seed, 0)
    if size is None:
        if sensitivity:
            raise SceneError("sensitivity: expected a sample, got a grid; give its size too")
        if method != "random":
            raise SceneError(
                f"method: expected none for a grid, got {shown(method)}; remove it, or give the "
                "size of a sample"
            )
        return grid(vary if isinstance(vary, Mapping) else list(vary))
    size = _whole("sample", size, 1)
    assert isinstance(vary, Mapping)
    distributions = read_distributions(vary)
    if sensitivity:
        if method != "random":
            raise SceneError(
                f"method: expected none with sensitivity indices, which use their own points, got "
                f"{method}; remove it"
            )
        return saltelli(distributions, size, seed)
    return sample(distributions, size, seed, method)


def _whole(name: str, value: object, least: int) -> int:
    """Return an argument that must be a whole number from `least`.

    Raises
    ------
    SceneError
        If it is not.
    """
    whole = isinstance(value, Integral) or (isinstance(value, float) and value.is_integer())
    if isinstance(value, bool) or not whole or int(value) < least:  # type: ignore[call-overload]
        raise SceneError(
            f"{name}: expected a whole number from {least}, got {shown(value)}; change it"
        )
    return int(value)  # type: ignore[call-overload,no-any-return]


def _path(out: object) -> Path:
    """Return the path of the output.

    Raises
    ------
    SceneError
        If it is not a path.
    """
    if not isinstance(out, str | os.PathLike):
        raise SceneError(f"out: expected a file name, got {shown(out)}; write for example rows.nc")
    return Path(out)


def check(study: Study, out: Path | None) -> None:
    """Raise an error for an invalid name, tolerance or output, before anything is computed.

    Raises
    ------
    SceneError
        If a name is unknown, the tolerance is out of range or the output has an unknown suffix.
    OSError
        If the output cannot be written.
    """
    check_names(study.scene, study.plan.names, study.plan.keys)
    if study.rtol is not None:
        check_rtol(study.rtol)
    if out is not None:
        check_output_file(out, study.plan.keys)


def write_results(
    store: Store, out: Path | None, sensitivity: bool, progress: Progress
) -> Sensitivities | None:
    """Write the file of a study whose points are all computed, and compute its sensitivities.

    Raises
    ------
    SceneError
        If all points are rejected or, for sensitivities, a point has no result.
    """
    _check_some(store)
    if out is not None:
        write(store, out, progress)
    return sensitivities(store) if sensitivity else None


def _check_some(store: Store) -> None:
    """Raise an error if every point is rejected."""
    for start, _, table in store.tables(2**16):
        status = column(table, "status")
        if (status != "rejected").any():
            return
        if start == 0:
            first = column(table, "reason")[0]
    points = store.study.plan.points(0, 1)
    values = ", ".join(f"{key} = {written(one[0])}" for key, one in points.items())
    raise SceneError(
        "sweep: expected a point that can be simulated, but all "
        f"{store.study.plan.size:,} are rejected; at {values}: {first}"
    )
