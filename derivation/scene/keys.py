"""Keys of a scene file that hold numbers: their meaning, and a scene with other numbers."""

from collections.abc import Mapping
from typing import Any

from pydantic.fields import FieldInfo

from derivation.scene.messages import OWN_MATERIALS, nearest
from derivation.scene.old_names import new_key
from derivation.scene.scene import TABLES, Material, Scene, SceneError
from derivation.scene.table import Table, is_number

EXAMPLE = "write for instance plate.thickness=1e-3:1e-2:50"
"""A sweep of a key."""


def number_key(place: str) -> tuple[str, str]:
    """The table and the key of a number of the scene file, from `table.key`.

    Raises
    ------
    SceneError
        If there is no such number; the message suggests the nearest key.
    """
    place = new_key(place.strip())
    table, _, key = place.rpartition(".")
    known = table_of(table)
    field = known.model_fields.get(key) if known else None
    if not any(map(is_number, (field.examples if field else None) or [])):
        near = nearest(place, _numbers())
        meant = f"did you mean {near}? " if near else ""
        raise SceneError(
            f"sweep: expected a number of the scene file, got {place!r:.60}; {meant}{EXAMPLE}"
        )
    return table, key


def described(place: str) -> str:
    """What the scene file's schema says about a key `table.key`, with its unit in brackets."""
    return field_of(place).description or place.rpartition(".")[2]


def field_of(place: str) -> FieldInfo:
    """The field of a key `table.key`."""
    table, _, key = place.rpartition(".")
    known = table_of(table)
    assert known is not None
    return known.model_fields[key]


def rivals(place: str) -> set[str]:
    """The keys that a key `table.key` replaces: half_thickness for thickness."""
    table, _, key = place.rpartition(".")
    known = table_of(table)
    assert known is not None
    return {f"{table}.{other}" for other in _instead(known, key)}


def varied(scene: Scene, values: Mapping[str, float]) -> dict[str, Any]:
    """The tables of a scene in which keys `table.key` take other values, in SI."""
    data = scene.to_json()
    for place, value in values.items():
        name, _, key = place.rpartition(".")
        given, table = data, table_of(name)
        assert table is not None
        for part in name.split(".", 1):
            given = given.setdefault(part, {})
        for other in _instead(table, key):
            given.pop(other, None)
        [example, *_] = field_of(place).examples or [value]
        given[key] = int(value) if isinstance(example, int) and value.is_integer() else value
    return data


def table_of(name: str) -> type[Table] | None:
    """The table of a name, `materials.NAME` among them."""
    return Material if name.startswith(f"{OWN_MATERIALS}.") else TABLES.get(name)


def _numbers() -> list[str]:
    """Every key that holds a number, with its table."""
    return [
        f"{table}.{key}"
        for table, model in TABLES.items()
        for key, field in model.model_fields.items()
        if any(map(is_number, field.examples or []))
    ]


def _instead(table: type[Table], key: str) -> set[str]:
    """Keys that a key stands in for: half_thickness for thickness, mass for density."""
    return {
        other
        for groups in table.choices
        if any(key in group for group in groups)
        for group in groups
        if key not in group
        for other in group
    }
