"""Time histories of an impact and pressures of a contact: arrays, CSV and notebook tables."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from derivation.scene.html import html_table

Array = NDArray[np.float64]

POINTS = 201
"""Times of a history, if not said otherwise."""
SHOWN = 12
"""Rows of a history that a notebook shows."""
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
        """The history as CSV, one line per time, numbers to the last bit."""
        return _csv(self._asdict())

    def _repr_html_(self) -> str:
        """Some of its times as a table for a notebook."""
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
        Of the plate's modes at the axis [m].
    plate_energy
        Energy of the plate's modes [J].
    """

    time: Array
    indentation: Array
    velocity: Array
    contact_radius: Array
    force: Array
    deflection: Array
    plate_energy: Array

    def to_csv(self) -> str:
        """The history as CSV, one line per time, numbers to the last bit."""
        return _csv(self._asdict())

    def _repr_html_(self) -> str:
        """Some of its times as a table for a notebook."""
        return _some_rows(self._asdict())


def _some_rows(columns: Mapping[str, Array]) -> str:
    """At most a dozen rows, evenly chosen, first and last among them, and how many there are."""
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
    """Pressure of a contact.

    Attributes
    ----------
    distance
        Distance from the axis [m].
    pressure, hertz
        Contact pressure and Hertz's of the same force [Pa], 0 outside the contact.
    """

    distance: Array
    pressure: Array
    hertz: Array
