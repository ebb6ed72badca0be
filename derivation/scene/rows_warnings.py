"""Warnings of many impacts on quasi-static plates: in words only where there may be one."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from derivation.scene import kernels
from derivation.scene.effects.effect import Array
from derivation.scene.impact import warnings_of
from derivation.scene.law import ContactLaw
from derivation.scene.limits import (
    DEFLECTION_LIMIT,
    HERTZ_LIMIT,
    PARABOLOID_LIMIT,
    QUASI_STATIC_PERIODS,
    SOLID_LIMIT,
    STRETCH_LIMIT,
    ZENER_LIMIT,
    PlateTimes,
    local_indentation,
    plate_times,
)

_ROUNDING = 1e-9
"""By how much a limit is missed where rounding might decide."""


def warnings_of_rows(
    law: ContactLaw,
    results: Mapping[str, Array],
    strength: Array | float | None,
    rows: NDArray[np.intp],
) -> NDArray[np.object_]:
    """The warnings of some rows, joined by "; ".

    Parameters
    ----------
    law
        The law of all rows, with columns of numbers.
    results
        By name, of all rows.
    strength
        Tensile strength of the plate [Pa], if it is given.
    rows
        Numbers of the rows.
    """
    found = np.full(len(rows), "", dtype=object)
    some, none = law.take(rows), np.full(len(rows), np.inf)
    limits = (
        none if strength is None else np.broadcast_to(strength, len(results["contact_time"]))[rows]
    )
    columns = {name: values[rows][:, None] for name, values in results.items()}
    times = plate_times(some.model) if np.any(some.model.density) else None
    for row in np.flatnonzero(_possible(some, columns, limits[:, None], times)).tolist():
        numbers = {name: float(column[row, 0]) for name, column in columns.items()}
        found[row] = "; ".join(
            warnings_of(
                some.take(row),
                numbers["contact_time"],
                numbers["max_indentation"],
                numbers["max_contact_radius"],
                numbers["max_pressure"],
                numbers["max_tensile_stress"],
                None if strength is None else float(limits[row]),
                known=times and PlateTimes(*(_at(x, row) for x in times)),
            )
        )
    return found


def _at(numbers: Array | float, row: int) -> float:
    """A row's number, of a column or of all rows."""
    return float(np.ravel(numbers)[row if np.size(numbers) > 1 else 0])


def _possible(
    law: ContactLaw, results: Mapping[str, Array], strength: Array, times: PlateTimes | None
) -> NDArray[np.bool_]:
    """The rows of which there may be a warning."""
    model, less = law.model, 1.0 - _ROUNDING
    a, delta = results["max_contact_radius"], results["max_indentation"]
    thickness, deflection = 2.0 * model.h, delta - local_indentation(law, a)
    stress = results["max_tensile_stress"]
    solid = 4 / 3 * np.pi * model.R * model.R * model.R * model.solid_density
    found = [
        less * model.m < SOLID_LIMIT * solid,
        a > less * HERTZ_LIMIT * thickness,
        (a > less * PARABOLOID_LIMIT * model.R) & (not law.spherical),
        deflection > less * STRETCH_LIMIT * thickness,
        results["max_pressure"] > less * kernels.YIELD_LIMIT * model.yield_stress,
        stress > less * np.minimum(model.plate_yield_stress, strength),
    ]
    if times is not None:
        fast = QUASI_STATIC_PERIODS * times.period > less * results["contact_time"]
        much = (times.zener > less * ZENER_LIMIT) | (deflection > less * DEFLECTION_LIMIT * delta)
        found += [fast & much, times.echoes > less * results["contact_time"]]
    possible = np.zeros(a.shape, dtype=bool)
    for condition in found:
        possible |= np.asarray(condition)
    return possible[:, 0]
