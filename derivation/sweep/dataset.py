"""The results of a study as an xarray Dataset with units, labels, scene and version."""

import json
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from derivation.scene.errors import SceneError
from derivation.scene.input.keys import described, takes_names, unit_of
from derivation.scene.result import UNITS
from derivation.scene.scene import outputs_of
from derivation.sweep.plan import GridPlan
from derivation.sweep.store import ERRORS, NUMBERS, TEXTS, Store
from derivation.sweep.study import Study

if TYPE_CHECKING:
    import xarray as xr

MOST_IN_MEMORY = 2_000_000
"""Largest number of points of a Dataset, plot or sensitivity study, which must fit in memory."""
LABELS = {name: (name.replace("_", " "), unit) for name, unit in UNITS.items()} | {
    "bound": ("bound of the relative error", "1"),
    "model_error": ("largest relative error of the model", "1"),
}
LABELS |= {
    error: (f"relative error of {name.replace('_', ' ')}, by bound and model", "1")
    for name, error in ERRORS.items()
}
"""Long name and unit of each number."""
TEXT_LABELS = {
    "status": "finished, incomplete or rejected",
    "reason": "why there is no result, or warnings",
    "effects": "included effects",
}
"""Long name of each text."""


def labels(name: str) -> dict[str, str]:
    """Return the attributes `long_name` and, for a number with a unit, `units` of a name."""
    if name in TEXT_LABELS:
        return {"long_name": TEXT_LABELS[name]}
    if name in LABELS:
        long_name, unit = LABELS[name]
        return {"long_name": long_name, "units": unit}
    text, unit = described(name), unit_of(name)
    if takes_names(name):
        return {"long_name": re.split("[;:]", text)[0].removeprefix("name of the ")}
    if not unit:
        return {"long_name": text}
    return {"long_name": text.replace(f" [{unit}]", ""), "units": unit}


def attributes(study: Study) -> dict[str, Any]:
    """Return scene, version and results with `bound` of a study, and seed and tolerance if any."""
    accuracy = study.scene.accuracy
    rtol = accuracy.rtol if study.rtol is None and accuracy is not None else study.rtol
    given = {"seed": study.plan.seed, "rtol": rtol, "outputs": " ".join(outputs_of(study.scene))}
    metadata = {"scene": json.dumps(study.base["scene"]), "version": study.base["version"]}
    return metadata | {name: value for name, value in given.items() if value is not None}


def check_memory(study: Study, what: str) -> None:
    """Raise an error if the points of a study may not fit in memory.

    Parameters
    ----------
    what
        Purpose of the points, for the message.

    Raises
    ------
    SceneError
        If there are more than `MOST_IN_MEMORY` points.
    """
    if not fits_in_memory(study):
        raise SceneError(
            f"{what}: expected at most {MOST_IN_MEMORY:,} points in memory, got "
            f"{study.plan.size:,}; use fewer points, or write them to a .nc or .zarr file, which "
            "is read as needed"
        )


def fits_in_memory(study: Study) -> bool:
    """Return whether all points of a study may be held in memory."""
    return study.plan.size <= MOST_IN_MEMORY


def data_set(store: Store) -> "xr.Dataset":
    """Return all results of a study as a Dataset.

    Raises
    ------
    SceneError
        If there are more than `MOST_IN_MEMORY` points.
    """
    import xarray as xr

    study = store.study
    check_memory(study, "sweep")
    plan, table = study.plan, store.table(0, study.plan.size)
    dims, shape = tuple(plan.dims), tuple(plan.dims.values())
    values: dict[str, Any] = {
        name: (dims, column(table, name).reshape(shape), labels(name))
        for name in (*NUMBERS, *TEXTS)
    }
    return xr.Dataset(values, coords=coordinates(study), attrs=attributes(study))


def coordinates(study: Study) -> dict[str, Any]:
    """Return the values of the keys, each along its dimension of a grid or along the sample."""
    plan = study.plan
    if isinstance(plan, GridPlan):
        return {key: (key, np.array(axis), labels(key)) for key, axis in plan.axes.items()}
    points = plan.points(0, plan.size)
    return {key: ("sample", points[key], labels(key)) for key in plan.keys}


def column(table: Any, name: str) -> Any:
    """Return a column of a table as a writable array of doubles, or of objects for texts."""
    if name in TEXTS:
        return np.concatenate([_texts(chunk) for chunk in table[name].chunks])
    return np.require(table[name].to_numpy(), requirements="W")  # pyarrow's memory is read-only


def _texts(chunk: Any) -> Any:
    """Return texts that are stored once each as an array of objects."""
    return np.array(chunk.dictionary.to_pylist(), dtype=object)[chunk.indices.to_numpy()]
