"""Simulation of many scenes: columns of numbers and names in, columns of results out.

Rows with the same names, such as those of materials, are computed together: impacts on quasi-static
plates in arrays. All other rows (plate inertia, a plastic contact that is viscoelastic or has
weight), invalid rows, and rows for which rounding could change a decision are simulated one by one.
Each row is equal to the result of `simulate` for its scene: effects, status and reason are the
same, and numbers to the last bit.
"""

import math
import time
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derivation.scene.contact_law.impact_errors import ImpactErrors
from derivation.scene.effects import EFFECTS
from derivation.scene.errors import SceneError
from derivation.scene.impact import selection_tolerance, simulate
from derivation.scene.input.keys import takes_names, varied_key
from derivation.scene.input.units import unit_warnings_of_rows
from derivation.scene.quantity import ONE_DIGIT
from derivation.scene.result import UNITS
from derivation.scene.rows.columns import (
    Columns,
    Names,
    allowed,
    models_of,
    of_bodies,
    row_of,
    rows_by_names,
)
from derivation.scene.rows.row_errors import errors_of_rows
from derivation.scene.rows.selection import Group, Rejected, selected
from derivation.scene.rows.static_rows import impacts_of
from derivation.scene.rows.warnings import warnings_of_rows
from derivation.scene.scene import Scene, outputs_of, read
from derivation.scene.selection.candidates import check_enabled
from generated.arrays import Double as Array

FIRST, BLOCK = 2**9, 2**15
"""Number of rows that are first computed together, in case they take long, and the largest number,
which bounds the memory."""
ROUNDING = 1e-14
"""Distance of a bound from the tolerance at which the row is simulated singly [1]."""
SPEED, STRENGTH = "impact.speed", "plate.tensile_strength"
"""A key of each scene, and one that only warnings use."""
TRIED = 8
"""Number of rows to read until one is valid."""


@dataclass(frozen=True)
class Rows:
    """Results of many scenes, in columns.

    Attributes
    ----------
    results
        Columns by the names of `UNITS` (contact_time ... max_tensile_stress), in SI units; NaN
        without a result.
    errors
        Columns of relative errors by the same names, as of `Result.error_of` [1]; NaN without a
        result.
    bound
        Bound on the relative error of each row [1]; NaN without a result.
    model_error
        Largest relative error of the model itself [1], as in `Result`; NaN without a result.
    status
        "finished", "incomplete" or "rejected".
    reason
        Why a row is rejected or incomplete; else its warnings, joined by "; ", if there are any.
    effects
        Names of the effects included, joined by spaces; empty if the row is rejected.
    """

    results: dict[str, NDArray[np.float64]]
    errors: dict[str, NDArray[np.float64]]
    bound: NDArray[np.float64]
    model_error: NDArray[np.float64]
    status: NDArray[np.str_]
    reason: NDArray[np.object_]
    effects: NDArray[np.object_]

    def __len__(self) -> int:
        return len(self.status)

    def first(self, count: int) -> "Rows":
        """Return the first rows."""
        results, errors = (
            {name: values[:count] for name, values in columns.items()}
            for columns in (self.results, self.errors)
        )
        return Rows(
            results,
            errors,
            self.bound[:count],
            self.model_error[:count],
            self.status[:count],
            self.reason[:count],
            self.effects[:count],
        )


def solve(
    scene: Scene,
    columns: Mapping[str, NDArray[Any]],
    rtol: float | None = None,
    seconds: float = math.inf,
) -> Rows:
    """Simulate the scenes of many rows.

    Parameters
    ----------
    scene
        The scene with all other keys.
    columns
        Numbers in SI units by key, `table.key` or `materials.NAME.key`, or names by a key such as
        `plate.material`: arrays of the same length, with a row for each scene. A key replaces the
        keys of the scene that it excludes: for example, half_thickness replaces thickness.
    rtol
        Relative tolerance of the results [1], as for `simulate`.
    seconds
        Run time after which no more rows are simulated [s].

    Returns
    -------
    Rows
        The results of `simulate` for the scene of each row; an invalid row is rejected. After
        `seconds` these are only the rows before the first one that is left, at least one.

    Raises
    ------
    SceneError
        If a key of a scene file takes neither numbers nor names, or the columns differ in length.
    """
    given = {
        key: np.asarray(values, dtype=np.str_ if takes_names(varied_key(key)) else np.float64)
        for key, values in columns.items()
    }
    lengths = {values.shape for values in given.values()}
    if len(lengths) != 1 or any(len(shape) != 1 for shape in lengths):
        raise SceneError(
            "columns: expected one or more arrays of the same length, got shapes "
            f"{sorted(lengths)}; give each key one number for each row"
        )
    [(count,)] = lengths
    rows, until = _empty(count), time.perf_counter() + seconds
    start, size = 0, min(FIRST, BLOCK)
    while start < count:
        begun = time.perf_counter()
        if start and begun > until:
            return rows.first(start)
        part = {key: values[start : start + size] for key, values in given.items()}
        groups = _groups(scene, part, rtol, rows, start)
        left = {row: group for group in groups for row in group.run().tolist()}
        for row in sorted(left):
            if row and time.perf_counter() > until:
                return rows.first(row)
            left[row].one(row)
        start, now = start + size, time.perf_counter()
        within = int(min((until - now) / max(now - begun, 1e-9), 4.0) * size)
        size = max(1, min(within, BLOCK))
    return rows


def _groups(
    scene: Scene, columns: Mapping[str, NDArray[Any]], rtol: float | None, rows: Rows, start: int
) -> Iterator["_Block"]:
    """Yield the rows with the same names, of which the first one has the index `start`."""
    count = len(next(iter(columns.values())))
    names = {key: values for key, values in columns.items() if takes_names(key)}
    numbers = {key: values for key, values in columns.items() if key not in names}
    numbers = numbers or {SPEED: np.full(count, scene.impact.speed)}
    if not names:
        yield _Block(scene, {}, numbers, rtol, rows, start + np.arange(count))
        return
    for equal, same in rows_by_names(names):
        part = {key: values[equal] for key, values in numbers.items()}
        yield _Block(scene, same, part, rtol, rows, start + equal)


def _empty(count: int) -> Rows:
    """Return rows without results."""
    results, errors = ({name: np.full(count, np.nan) for name in UNITS} for _ in range(2))
    bound, model_error = np.full(count, np.nan), np.full(count, np.nan)
    status = np.full(count, "rejected", dtype="<U10")
    reason, effects = np.full(count, "", dtype=object), np.full(count, "", dtype=object)
    return Rows(results, errors, bound, model_error, status, reason, effects)


@dataclass(frozen=True)
class _Block:
    """Some rows that have the same names, with the indices of their results."""

    scene: Scene
    names: Names
    columns: Columns
    rtol: float | None
    table: Rows
    indices: NDArray[np.intp]

    def run(self) -> NDArray[np.intp]:
        """Simulate rows in arrays where possible; return the indices of the others."""
        left = np.ones(len(self.indices), dtype=bool)
        for rows in self._in_arrays():
            left[rows] = False
        self._add_unit_warnings(np.flatnonzero(~left))
        return self.indices[left]

    def one(self, index: int) -> None:
        """Simulate the row whose results have this index."""
        table, row = self.table, int(np.searchsorted(self.indices, index))
        try:
            result = simulate(read(self._tables(row)), rtol=self.rtol)
            included = " ".join(result.effects.included)
            numbers = {name: float(getattr(result, name)) for name in UNITS}
            errors = {name: result.error_of(name) for name in UNITS if result.complete}
        except SceneError as error:
            table.reason[index] = str(error)
            return
        table.effects[index] = included
        if not result.complete:
            table.status[index] = "incomplete"
            table.reason[index] = result.incomplete_note
            return
        table.status[index] = "finished"
        table.reason[index] = "; ".join(result.warnings)
        table.bound[index], table.model_error[index] = result.accuracy.bound, result.model_error
        for name, number in numbers.items():
            table.results[name][index], table.errors[name][index] = number, errors[name]

    def _add_unit_warnings(self, rows: NDArray[np.intp]) -> None:
        """Put the warnings about units in front of the reasons of rows."""
        scene = self._readable(rows[:1].tolist())
        if scene is None:
            return
        columns = {key: values[rows] for key, values in self.columns.items()}
        for row, texts in unit_warnings_of_rows(scene, columns).items():
            index = self.indices[rows[row]]
            rest = self.table.reason[index]
            self.table.reason[index] = "; ".join((*texts, rest) if rest else texts)

    def _in_arrays(self) -> Iterable[NDArray[np.intp]]:
        """Simulate rows in arrays, and yield their indices."""
        if not of_bodies(self.columns):
            return
        rows = np.flatnonzero(allowed(self.columns))
        scene = self._readable(rows[:TRIED].tolist())
        if scene is None or scene.measured is not None:
            return
        columns = {key: values[rows] for key, values in self.columns.items()}
        model, sound = models_of(scene, columns)
        accuracy, rtol = scene.accuracy, self.rtol
        if rtol is None and accuracy is not None:
            rtol = accuracy.rtol
        try:
            tolerance = selection_tolerance(rtol)
        except SceneError:
            return
        rows, model = rows[sound], model.take(sound)
        if not len(rows) or (model.inertia.infinite_plate and np.any(model.density)):
            return
        try:
            check_enabled(scene, model.take(0))
        except SceneError:
            return
        wanted = scene.effects.model_dump()
        for group in selected(model, wanted, np.full(len(rows), tolerance), outputs_of(scene)):
            if isinstance(group, Rejected):
                self.table.reason[self.indices[rows[group.rows]]] = group.reason
                yield rows[group.rows]
            else:
                yield rows[self._static(group, rows[group.rows], scene, rtol)]

    def _tables(self, row: int) -> dict[str, Any]:
        """Return the tables of the scene of a row."""
        return row_of(self.scene, self.columns, row, self.names)

    def _readable(self, rows: list[int]) -> Scene | None:
        """Return the scene of the first valid row; all rows have the same keys."""
        for row in rows:
            try:
                return read(self._tables(row))
            except SceneError:
                continue
        return None

    def _static(
        self, group: Group, rows: NDArray[np.intp], scene: Scene, rtol: float | None
    ) -> NDArray[np.intp]:
        """Compute the impacts of a group; return the rows that have results."""
        law, error, outputs = group.law, group.error, outputs_of(scene)
        with np.errstate(invalid="ignore"):  # without a bound on the omitted effects
            rest = None if rtol is None else (rtol - error) / (1.0 + error)
        impacts = impacts_of(law, len(rows), rest)
        a, P = impacts.max_contact_radius[:, None], impacts.max_force[:, None]
        with np.errstate(all="ignore"):
            numbers = {
                "contact_time": impacts.contact_time,
                "max_indentation": impacts.max_indentation,
                "max_force": impacts.max_force,
                "max_contact_radius": impacts.max_contact_radius,
                "restitution": impacts.restitution,
                "max_pressure": np.minimum(law.centre_pressure(a), law.pressure_limit)[:, 0],
                "max_tensile_stress": law.tensile_stresses(a, P, group.held)[:, 0],
            }
            known = np.all([np.isfinite(x) & (x > 0.0) for x in list(numbers.values())[:4]], axis=0)
            known &= np.broadcast_to(a < law.limit, a.shape)[:, 0]
        errors = errors_of_rows(group, impacts, numbers, outputs)
        # Rows with a larger bound have bounds for single results.
        known &= np.isfinite(errors.model) & (errors.bound < ONE_DIGIT)
        if rtol is not None:  # other rows do not meet the tolerance, or too narrowly
            known &= errors.bound <= rtol - ROUNDING
        which = np.flatnonzero(known)
        strength: Array | float | None = scene.plate.tensile_strength
        if STRENGTH in self.columns:
            strength = self.columns[STRENGTH][rows]
        limited = {f"{name}_error": errors.bounds[name] for name in ImpactErrors._fields}
        limited |= {"pressure_error": errors.pressure, "stress_error": errors.stress}
        reasons = warnings_of_rows(law, numbers | limited, strength, which)
        indices = self.indices[rows[which]]
        for name, values in numbers.items():
            self.table.results[name][indices] = values[which]
            self.table.errors[name][indices] = errors.of_results[name][which]
        self.table.bound[indices] = errors.bound[which]
        self.table.model_error[indices] = errors.model[which]
        self.table.status[indices], self.table.reason[indices] = "finished", reasons
        included = " ".join(effect.name for effect in EFFECTS if effect.name in law.effects)
        self.table.effects[indices] = included
        return group.rows[which]
