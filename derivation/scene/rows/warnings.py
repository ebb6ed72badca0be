"""Warnings of many impacts on quasi-static plates; only rows near a limit are examined."""

from collections.abc import Callable, Iterator, Mapping
from operator import attrgetter
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derivation.scene import kernels, scales
from derivation.scene.contact_law.corrections import pressure_correction
from derivation.scene.contact_law.impact_errors import ImpactErrors
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import (
    DEFLECTION_LIMIT,
    HERTZ_LIMIT,
    PARABOLOID_LIMIT,
    QUASI_STATIC_PERIODS,
    SOLID_LIMIT,
    STRETCH_LIMIT,
    ZENER_LIMIT,
    PlateTimes,
    hollow_warnings,
    local_indentation,
    motion_warnings,
    plate_times,
    warnings_at,
)
from derivation.scene.contact_law.stress_limits import exceeds, pressure_warnings, stress_warnings
from derivation.scene.contact_law.yield_warnings import WARNED, impact_warnings, risen_restitution
from derivation.scene.contact_law.yielding import onset_radius
from generated.arrays import Double as Array

_ROUNDING = 1e-9
"""Relative distance from a limit at which a row is examined, for rounding."""
_MODEL = (
    "m", "R", "h", "b", "poissons_ratio", "density", "solid_density", "lightest_density",
    "yield_stress", "plate_yield_stress",
)  # fmt: skip
"""Numbers of the model that warnings use."""
_error_columns = attrgetter(*(f"{name}_error" for name in ImpactErrors._fields))
Mask = NDArray[np.bool_]
Texts = Callable[[SimpleNamespace], tuple[str, ...]]


def warnings_of_rows(
    law: ContactLaw,
    results: Mapping[str, Array],
    strength: Array | float | None,
    rows: NDArray[np.intp],
) -> NDArray[np.object_]:
    """Return the warnings of some rows, joined by "; ", equal to those of `simulate`.

    Parameters
    ----------
    law
        The law of all rows, with columns of numbers.
    results
        Columns of results by name, and of the relative errors `pressure_error` and `stress_error`
        of the largest pressure and tensile stress, and `NAME_error` of the `ImpactErrors` [1], of
        all rows.
    strength
        Tensile strength of the plate [Pa], if it is given.
    rows
        Indices of the rows.
    """
    known = _numbers(law.take(rows), {name: values[rows] for name, values in results.items()})
    known["strength"] = np.full(len(rows), np.inf)
    if strength is not None:
        known["strength"][:] = np.broadcast_to(strength, len(results["contact_time"]))[rows]
    by_row: dict[int, tuple[str, ...]] = {}
    for possible, texts in zip(_possible(law, known), _texts(law), strict=True):
        for row, one in _singles(known, np.flatnonzero(possible)):
            by_row[row] = by_row.get(row, ()) + texts(one)
    joined = np.full(len(rows), "", dtype=object)
    for row, of_row in by_row.items():
        joined[row] = "; ".join(of_row)
    return joined


def _numbers(law: ContactLaw, results: Mapping[str, Array]) -> dict[str, Array]:
    """Return all numbers that warnings use, by name, shape (rows,)."""
    model, count = law.model, len(results["contact_time"])
    a, delta = results["max_contact_radius"][:, None], results["max_indentation"][:, None]
    local = np.broadcast_to(local_indentation(law, a), a.shape)
    columns = {name: getattr(model, name) for name in _MODEL}
    columns |= {"deflection": delta - local, "deflection_fraction": 1.0 - local / delta}
    columns |= {name: values[:, None] for name, values in results.items()}
    times = plate_times(model) if np.any(model.density) else PlateTimes(0.0, 0.0, 0.0)
    columns |= times._asdict()
    known = {name: np.broadcast_to(x, (count, 1))[:, 0] for name, x in columns.items()}
    known["over_onset"] = np.zeros(count)
    if law.plastic:
        known["over_onset"] = (a / onset_radius(law))[:, 0]
    known["correction"] = np.full(count, np.nan)
    if len(wide := np.flatnonzero(_non_hertzian(SimpleNamespace(**known)))):
        one: Any = SimpleNamespace(**{name: values[wide] for name, values in known.items()})
        numbers = pressure_correction(one, one.max_contact_radius, one.max_indentation)
        known["correction"][wide] = numbers
    return known


def _errors(one: Any) -> ImpactErrors:
    """Return the relative errors of the results of a row, or of all rows [1]."""
    return ImpactErrors(*_error_columns(one))


def _singles(
    known: Mapping[str, Array], rows: NDArray[np.intp]
) -> Iterator[tuple[int, SimpleNamespace]]:
    """Yield each row with its numbers."""
    if len(rows):
        columns = (values[rows].tolist() for values in known.values())
        for row, numbers in zip(rows.tolist(), zip(*columns, strict=True), strict=True):
            yield row, SimpleNamespace(**dict(zip(known, numbers, strict=True)))


def _possible(law: ContactLaw, known: Mapping[str, Array]) -> tuple[Mask, ...]:
    """Return the rows that may have warnings, for each kind of warning."""
    one, less = SimpleNamespace(**known), 1.0 - _ROUNDING
    lightest = np.maximum(SOLID_LIMIT * one.solid_density, one.lightest_density)
    errors = _errors(one)
    largest = errors.largest_deflection(one.deflection, one.max_indentation)
    shortest = less * errors.shortest_time(one.contact_time)
    wide = _non_hertzian(one) | (largest > less * STRETCH_LIMIT * 2.0 * one.h)
    if not law.spherical:
        wide = wide | (
            errors.largest_radius(one.max_contact_radius) > less * PARABOLOID_LIMIT * one.R
        )
    fast = QUASI_STATIC_PERIODS * one.period > shortest
    affected = (one.zener > less * ZENER_LIMIT) | (
        one.deflection_fraction > less * DEFLECTION_LIMIT
    )
    moving = (fast & affected) | (one.echoes > shortest)
    limit = np.minimum(one.plate_yield_stress, one.strength)
    return (
        less * one.m < scales.volume(one.R) * lightest,
        wide,
        moving & (one.density > 0.0),
        _yielding(law, one),
        exceeds(one.max_tensile_stress, less * limit, one.stress_error),
    )


def _yielding(law: ContactLaw, one: SimpleNamespace) -> Mask:
    """Return the rows whose neglected yield, or whose pressure beyond the limit, may matter."""
    less = 1.0 - _ROUNDING
    if law.plastic:
        rise = risen_restitution(np.maximum(one.over_onset, 1.0))
        possible: Mask = rise > less * WARNED
        return possible
    if law.viscous:  # yield is not checked
        unchecked: Mask = np.isfinite(one.yield_stress)
        return unchecked
    limit = less * kernels.YIELD_LIMIT * one.yield_stress
    neglected: Mask = exceeds(one.max_pressure, limit, one.pressure_error)
    return neglected


def _non_hertzian(one: SimpleNamespace) -> Mask:
    """Return the rows whose contact may be too wide for the Hertz pressure."""
    widest = _errors(one).largest_radius(one.max_contact_radius)
    exceeded: Mask = widest > (1.0 - _ROUNDING) * HERTZ_LIMIT * 2.0 * one.h
    return exceeded


def _texts(law: ContactLaw) -> tuple[Texts, ...]:
    """Return functions from the numbers of a row to its warnings, for each kind."""
    inertia = law.model.inertia

    def wide(one: Any) -> tuple[str, ...]:
        one.edge = law.model.edge
        kind = {"solved": law.solved, "spherical": law.spherical, "stretches": False}
        of_row: Any = SimpleNamespace(model=one, **kind)
        sizes = one.max_contact_radius, one.max_indentation, one.deflection
        return warnings_at(of_row, *sizes, one.correction, _errors(one))

    def moving(one: Any) -> tuple[str, ...]:
        one.inertia = inertia
        times = PlateTimes(one.zener, one.period, one.echoes)
        fraction, errors = one.deflection_fraction, _errors(one)
        return motion_warnings(one, one.contact_time, fraction, known=times, errors=errors)

    def yielding(one: Any) -> tuple[str, ...]:
        if law.plastic:
            return impact_warnings(one.over_onset)
        weaker = "sphere" if one.yield_stress < one.plate_yield_stress else "plate"
        limit = _given(one.yield_stress)
        pressure, error = one.max_pressure, one.pressure_error
        return pressure_warnings(pressure, limit, law.viscous, weaker, error)

    def failing(one: Any) -> tuple[str, ...]:
        limits = _given(one.strength), _given(one.plate_yield_stress)
        return stress_warnings(one.max_tensile_stress, *limits, one.stress_error)

    return hollow_warnings, wide, moving, yielding, failing  # type: ignore[return-value]


def _given(stress: float) -> float | None:
    """Return a stress [Pa], None if it is unknown."""
    return stress if stress < np.inf else None
