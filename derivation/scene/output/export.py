"""Exports results to pandas (time history) and xarray (results and time history)."""

import json
from typing import TYPE_CHECKING, Any

from derivation.scene.output.history import HISTORY_UNITS
from derivation.scene.result import UNITS, Result

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


def data_frame(result: Result, n: int | None = None) -> "pd.DataFrame":
    """Return the history as a DataFrame over time [s], with the units in `attrs["units"]`.

    Parameters
    ----------
    result
        The result of a simulation.
    n
        Number of times, as `Result.history` takes it.
    """
    import pandas as pd

    columns = result.history(n)._asdict()
    index = pd.Index(columns.pop("time"), name="time")
    frame = pd.DataFrame(columns, index=index)
    frame.attrs["units"] = {name: HISTORY_UNITS[name] for name in ("time", *columns)}
    return frame


def data_set(result: Result, n: int | None = None) -> "xr.Dataset":
    """Return results as scalars and the history over time as a Dataset, each with its unit.

    The attributes of the Dataset are the error bound, the model error, the warnings as one text,
    and the scene as JSON.

    Parameters
    ----------
    result
        The result of a simulation.
    n
        Number of times, as `Result.history` takes it.

    Examples
    --------
    >>> import platecontact as pc
    >>> scene = pc.Scene(
    ...     sphere=pc.Sphere(radius=0.01, material="steel"),
    ...     plate=pc.Plate(radius=0.3, thickness=0.05, material="glass"),
    ...     impact=pc.Impact(speed=1.0),
    ... )
    >>> data = pc.simulate(scene).to_xarray()
    >>> data["force"].dims, data["force"].units, data["contact_time"].units
    (('time',), 'N', 's')
    """
    import xarray as xr

    columns = result.history(n)._asdict()
    time = ("time", columns.pop("time"), _labels("time", HISTORY_UNITS["time"]))
    values: dict[str, Any] = {
        name: ((), getattr(result, name), _labels(name, unit)) for name, unit in UNITS.items()
    }
    values["total_time"] = ((), result.total_time, _labels("total_time", "s"))
    if result.effects.law.plastic:
        values["dent"] = ((), result.dent, _labels("dent", "m"))
    values |= {
        name: ("time", column, _labels(name, HISTORY_UNITS[name]))
        for name, column in columns.items()
    }
    about = {
        "relative_error_bound": result.accuracy.bound,
        "model_error": result.model_error,
        "warnings": "; ".join(result.warnings),
        "scene": json.dumps(result.scene.to_json()),
    }
    return xr.Dataset(values, coords={"time": time}, attrs=about)


def _labels(name: str, unit: str) -> dict[str, str]:
    """Return the attributes that xarray uses as axis labels."""
    return {"long_name": name.replace("_", " "), "units": unit}
