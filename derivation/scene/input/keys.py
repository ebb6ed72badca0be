"""Keys of a scene file as `table.key`: their descriptions, and scenes with other values."""

import re
from collections.abc import Mapping
from typing import Any

from pydantic.fields import FieldInfo

from derivation.engine.nearest import did_you_mean
from derivation.scene.errors import SceneError
from derivation.scene.input.bodies import Plate, Sphere
from derivation.scene.input.body_materials import constants_beside, own_materials
from derivation.scene.input.messages import OWN_MATERIALS
from derivation.scene.input.old_names import new_key
from derivation.scene.input.table import Table, is_number
from derivation.scene.scene import TABLES, Material, Scene

EXAMPLE = "write for example plate.thickness=1e-3:1e-2:50"
"""Example of a sweep."""


def number_key(place: str) -> tuple[str, str]:
    """Return table and key of a numeric key `table.key`.

    Raises
    ------
    SceneError
        If no numeric key has that name; the message suggests the nearest key.
    """
    place = new_key(place.strip())
    table, _, key = place.rpartition(".")
    known = table_of(table)
    field = known.model_fields.get(key) if known else None
    if not any(map(is_number, (field.examples if field else None) or [])):
        suggestion = did_you_mean(place, _numbers())
        raise SceneError(
            f"sweep: expected TABLE.KEY with a numeric key of the scene file, got {place!r:.60}; "
            f"{suggestion}{EXAMPLE}"
        )
    return table, key


def described(key: str) -> str:
    """Return the description of a key `table.key`, with its unit in brackets."""
    return field_of(key).description or key.rpartition(".")[2]


def unit_of(key: str) -> str:
    """Return the SI unit of a key `table.key`, empty if it has none."""
    bracket = re.search(r"\[(.+?)\]", described(key))
    return bracket[1] if bracket else ""


def field_of(place: str) -> FieldInfo:
    """Return the field of a key `table.key`."""
    table, _, key = place.rpartition(".")
    known = table_of(table)
    assert known is not None
    return known.model_fields[key]


def rivals(place: str) -> set[str]:
    """Return the keys that exclude a key `table.key`, such as half_thickness for thickness."""
    table, _, key = place.rpartition(".")
    known = table_of(table)
    assert known is not None
    return {f"{table}.{other}" for other in _instead(known, key)}


def varied(scene: Scene, values: Mapping[str, float]) -> dict[str, Any]:
    """Return the tables of a scene with new values of keys `table.key`, in SI units.

    Keys that exclude a new one are removed. If an elastic constant of a body is new, the other
    constants of its material stay.
    """
    data, materials = scene.to_json(), own_materials(scene.materials)
    for place, value in values.items():
        name, _, key = place.rpartition(".")
        given, table = data, table_of(name)
        assert table is not None
        for part in name.split(".", 1):
            given = given.setdefault(part, {})
        for other in _instead(table, key):
            given.pop(other, None)
        body = getattr(scene, name, None)
        if isinstance(body, Sphere | Plate):
            for other, constant in constants_beside(key, body, materials).items():
                if not _instead(table, other) & set(given):
                    given.setdefault(other, constant)
        [example, *_] = field_of(place).examples or [value]
        given[key] = int(value) if isinstance(example, int) and value.is_integer() else value
    return data


def table_of(name: str) -> type[Table] | None:
    """Return the class of a table by its name, which may be `materials.NAME`."""
    return Material if name.startswith(f"{OWN_MATERIALS}.") else TABLES.get(name)


def _numbers() -> list[str]:
    """Return every numeric key as `table.key`."""
    return [
        f"{table}.{key}"
        for table, model in TABLES.items()
        for key, field in model.model_fields.items()
        if any(map(is_number, field.examples or []))
    ]


def _instead(table: type[Table], key: str) -> set[str]:
    """Return the keys that exclude a key: half_thickness for thickness, mass for density."""
    return {
        other
        for groups in (*table.choices, *table.options)
        if any(key in group for group in groups)
        for group in groups
        if key not in group
        for other in group
    }
