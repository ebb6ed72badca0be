"""Time histories of an impact and pressure of a contact: arrays, CSV, tables for notebooks."""

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from derivation.scene.errors import SceneError
from derivation.scene.output.html import html_table

Array = NDArray[np.float64]

POINTS = 201
"""Default number of times of a history."""
SHOWN = 12
"""Number of rows of a history that a notebook shows."""
HISTORY_UNITS = {
    "time": "s",
    "indentation": "m",
    "velocity": "m/s",
    "contact_radius": "m",
    "force": "N",
    "deflection": "m",
    "plate_energy": "J",
}


class History(NamedTuple):
    """Time history of an impact on a quasi-static plate.

    Attributes
    ----------
    time
        Time since first contact [s].
    indentation, velocity
        Indentation [m] and its rate [m/s].
    contact_radius
        Contact radius [m].
    force
        Contact force [N].
    """

    time: Array
    indentation: Array
    velocity: Array
    contact_radius: Array
    force: Array

    def to_csv(self) -> str:
        """Return the history as CSV in SI units, one line per time, with all digits."""
        return _csv(self._asdict())

    def _repr_html_(self) -> str:
        """Return a table of some of the times for a notebook."""
        return _some_rows(self._asdict())


class DynamicHistory(NamedTuple):
    """Time history of an impact on a plate with inertia.

    Attributes
    ----------
    time
        Time since first contact [s].
    indentation, velocity
        Displacement of the sphere [m] and its rate [m/s].
    contact_radius
        Contact radius [m].
    force
        Contact force [N].
    deflection
        Deflection of the plate at the axis [m], sum of the modes.
    plate_energy
        Kinetic and elastic energy of the modes [J]. After a viscoelastic contact it includes the
        deflection that recovers with the face; in the energy balance that part is elastic energy of
        the contact that is not recovered, and only the free vibration is energy of the plate.
    """

    time: Array
    indentation: Array
    velocity: Array
    contact_radius: Array
    force: Array
    deflection: Array
    plate_energy: Array

    def to_csv(self) -> str:
        """Return the history as CSV in SI units, one line per time, with all digits."""
        return _csv(self._asdict())

    def _repr_html_(self) -> str:
        """Return a table of some of the times for a notebook."""
        return _some_rows(self._asdict())


def _some_rows(columns: Mapping[str, Array]) -> str:
    """Return a table of at most 12 evenly spaced rows, with first and last."""
    count = len(columns["time"])
    chosen = np.unique(np.linspace(0, count - 1, min(count, SHOWN)).round().astype(int))
    heads = [f"{name.replace('_', ' ')} [{HISTORY_UNITS[name]}]" for name in columns]
    rows = ([f"{column[k]:.6g}" for column in columns.values()] for k in chosen)
    return f"{html_table(heads, rows)}<p>{len(chosen)} of {count} times</p>"


def _csv(columns: Mapping[str, Array]) -> str:
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    lines = [",".join(columns), *(",".join(map(repr, row)) for row in rows)]
    return "\n".join(lines) + "\n"


class Pressures(NamedTuple):
    """Pressure over the distance from the axis of a contact.

    Attributes
    ----------
    distance
        Distance from the axis [m].
    pressure, hertz
        Contact pressure, and Hertz's pressure of the same force [Pa]; 0 outside the contact.
    """

    distance: Array
    pressure: Array
    hertz: Array


def times_of(times: Any) -> tuple[float, ...]:
    """Return times [s] as a tuple of numbers.

    Raises
    ------
    SceneError
        If they are not a number or a sequence of numbers.
    """
    try:
        iterated = isinstance(times, Iterable) and not isinstance(times, np.ndarray)
        given = list(times) if iterated else times
        numbers = np.atleast_1d(np.asarray(given, dtype=np.float64))
    except (TypeError, ValueError):
        numbers = np.empty((0, 0))
    if numbers.ndim != 1:
        raise SceneError(
            f"times: expected a number or a sequence of numbers [s], got {times!r:.100}; use a list"
        )
    return tuple(numbers.tolist())
