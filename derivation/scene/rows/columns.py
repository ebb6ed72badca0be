"""Scenes as columns of numbers or names, with one scene in each row."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from derivation.scene.input.keys import field_of, varied
from derivation.scene.input.messages import OWN_MATERIALS
from derivation.scene.model import NUMBERS, Model, numbers_of
from derivation.scene.scene import Scene
from generated.arrays import Double as Array

Columns = Mapping[str, Array]
"""Numbers in SI units by key, `table.key` or `materials.NAME.key`: arrays of equal lengths."""
Names = Mapping[str, str]
"""The same name in each row, such as that of a material, by key `table.key`."""
unchecked_copy = BaseModel.model_copy
"""Return a table with columns in place of numbers, which its own method would reject."""
_BODIES = ("sphere", "plate", "impact", OWN_MATERIALS)
"""Tables whose keys are numbers of the model."""


def rows_by_names(columns: Mapping[str, NDArray[Any]]) -> Iterator[tuple[NDArray[np.intp], Names]]:
    """Yield the rows that have the same names, with these names; `columns` are those of names."""
    rows: dict[tuple[str, ...], list[int]] = {}
    for row, names in enumerate(
        zip(*(values.tolist() for values in columns.values()), strict=True)
    ):
        rows.setdefault(names, []).append(row)
    for names, equal in rows.items():
        yield np.array(equal), dict(zip(columns, names, strict=True))


def row_of(scene: Scene, columns: Columns, row: int, names: Names | None = None) -> dict[str, Any]:
    """Return the tables of the scene of a row, like those of a scene file."""
    numbers = {key: float(values[row]) for key, values in columns.items()}
    return varied(scene, {**(names or {}), **numbers})


def of_bodies(columns: Columns) -> bool:
    """Return whether all columns are numbers of the bodies and of the impact."""
    return all(key.split(".", 1)[0] in _BODIES for key in columns)


def allowed(columns: Columns) -> NDArray[np.bool_]:
    """Return the rows in which each number is allowed for its key."""
    allowed_rows = np.ones(len(next(iter(columns.values()))), dtype=bool)
    for key, values in columns.items():
        field = field_of(key)
        allowed_rows &= np.isfinite(values)
        for limit in _limits(field):
            allowed_rows &= _within(values, limit)
    return allowed_rows


def _limits(field: FieldInfo) -> Iterable[Any]:
    """Return the limits that pydantic applies to a key."""
    yield from field.metadata
    for kind in get_args(field.annotation):
        for known in getattr(kind, "__metadata__", ()):
            yield from known.metadata if isinstance(known, FieldInfo) else ()


def _within(values: Array, limit: Any) -> NDArray[np.bool_]:
    """Return which values are within a limit."""
    compared = {"gt": np.greater, "ge": np.greater_equal, "lt": np.less, "le": np.less_equal}
    inside = np.ones(values.shape, dtype=bool)
    for name, holds in compared.items():
        if hasattr(limit, name):
            inside &= holds(values, getattr(limit, name))
    return inside


def models_of(scene: Scene, columns: Columns) -> tuple[Model, NDArray[np.bool_]]:
    """Return the numbers of all rows as columns, and which rows are certainly valid.

    Parameters
    ----------
    scene
        The scene of one of the rows; all rows give the same keys.
    columns
        Columns of numbers of bodies and impact, all within the limits of their keys.
    """
    given: dict[str, dict[str, Any]] = {}
    for place, values in columns.items():
        name, _, key = place.rpartition(".")
        given.setdefault(name, {})[key] = values[:, None]
    materials = dict(scene.materials)
    tables: dict[str, Any] = {}
    for name, keys in given.items():
        first, _, material = name.partition(".")
        if material:
            materials[material] = unchecked_copy(materials[material], update=keys)
        else:
            tables[first] = unchecked_copy(getattr(scene, first), update=keys)
    with np.errstate(all="ignore"):
        model = numbers_of(unchecked_copy(scene, update=tables | {OWN_MATERIALS: materials}))
        sound = 3.0 * np.asarray(model.lam) > -2.0 * np.asarray(model.mu)
        for name, number in zip(NUMBERS, model.numbers, strict=True):
            sound = sound & np.isfinite(number) & ((np.asarray(number) > 0.0) | (name == "lam"))
    rows = next(iter(columns.values())).shape[0]
    return _spread(model, rows), np.broadcast_to(sound, (rows, 1))[:, 0]


def _spread(model: Model, rows: int) -> Model:
    """Return the model with columns for the numbers of bodies and impact."""
    R, m, v0 = (np.array(np.broadcast_to(x, (rows, 1))) for x in (model.R, model.m, model.v0))
    return replace(model, R=R, m=m, v0=v0)  # type: ignore[arg-type]
