"""Keys of a scene file as `table.key`: their descriptions, and scenes with other values."""

import re
from collections.abc import Mapping, Sequence
from typing import Any, get_args

from pydantic.fields import FieldInfo

from derivation.engine.nearest import did_you_mean
from derivation.engine.printable import one_line
from derivation.scene.errors import SceneError
from derivation.scene.input.bodies import Plate, Sphere
from derivation.scene.input.body_materials import constants_beside, own_materials
from derivation.scene.input.materials import find
from derivation.scene.input.messages import OWN_MATERIALS, instead, shown
from derivation.scene.input.old_names import new_key
from derivation.scene.input.table import Table, is_number
from derivation.scene.scene import TABLES, Material, Scene, read

EXAMPLE = "write for example plate.thickness=1e-3:1e-2:50 or plate.material=glass,steel"
"""Example of a sweep."""
SWITCH = {"true": True, "false": False}
"""Values of an effect other than "auto", by their names."""
MATERIAL = "material"
"""Key that takes the name of any material."""
OF_MATERIAL = (
    *("sphere.mass", "sphere.density", "sphere.yield_stress", "sphere.retardation_time"),
    *("plate.density", "plate.yield_stress", "plate.retardation_time", "plate.tensile_strength"),
    *("plate.loss_factor", "measured.restitution"),
)
"""Constants that a scene gives for the material of a body, without elastic constants. The measured
restitution belongs to the material of the plate."""


def varied_key(place: str) -> str:
    """Return a key `table.key` whose values are numbers or names.

    Raises
    ------
    SceneError
        If there is no such key; the message suggests the nearest one.
    """
    place = new_key(str(place).strip())
    table, _, key = place.rpartition(".")
    known = table_of(table)
    field = known.model_fields.get(key) if known else None
    other = instead((table, key), {table: known.model_fields}) if known else ""
    if other:
        raise SceneError(f"sweep: {place}: unknown key: {other}")
    if field is None or not (_takes_numbers(field) or _takes_names(key, field)):
        suggestion = did_you_mean(place, _varied_keys())
        raise SceneError(
            "sweep: expected TABLE.KEY with a key of the scene file that takes numbers or names, "
            f"got {place!r:.60}; {suggestion}{EXAMPLE}"
        )
    return place


def takes_names(place: str) -> bool:
    """Return whether the values of a key `table.key` are names, such as those of materials."""
    return _takes_names(place.rpartition(".")[2], field_of(place))


def _takes_numbers(field: FieldInfo) -> bool:
    return any(map(is_number, field.examples or []))


def _takes_names(key: str, field: FieldInfo) -> bool:
    return not _takes_numbers(field) and (key == MATERIAL or bool(_names_of(field)))


def _names_of(field: FieldInfo) -> tuple[str, ...]:
    """Return the names that a key takes; none if it takes any text, several names or no name."""
    kinds = get_args(field.annotation)
    if not isinstance((field.examples or [None])[0], str | bool):
        return ()
    names = [name for kind in (field.annotation, *kinds) for name in get_args(kind)]
    texts = tuple(name for name in names if isinstance(name, str))
    return (*texts, *SWITCH) if texts and bool in kinds else texts


def check_names(scene: Scene, names: Mapping[str, Sequence[str]], keys: Sequence[str]) -> None:
    """Raise the error of `simulate` for an unknown name, before anything is simulated.

    The name of an own material in a key is checked too.

    Parameters
    ----------
    names
        The names that each key `table.key` takes in turn.
    keys
        All varied keys.

    Raises
    ------
    SceneError
        If a name is unknown, if two mean the same, or if a constant that the scene gives for one
        material would be used for another one.
    """
    own = own_materials(scene.materials)
    for place in keys:
        table = place.rpartition(".")[0]
        absent = table.removeprefix(f"{OWN_MATERIALS}.")
        if absent != table and absent not in own:
            suggestion = did_you_mean(absent, own) or "define it in the scene "
            raise SceneError(
                f"{one_line(place)}: expected a material that the scene defines in a table "
                f"[{OWN_MATERIALS}.NAME], got {shown(absent)}; {suggestion.rstrip()}"
            )
    for place, given in names.items():
        table, _, key = place.rpartition(".")
        known = _names_of(field_of(place))
        first = dict[str, str]()
        for name in given:
            material = find(name, own) if key == MATERIAL else None
            if material is None and name not in known:
                read(varied(scene, {place: name}), "sweep")
            same = material.name if material else name
            if same in first:
                raise SceneError(
                    f"{place}: expected different names, got {written(first[same])} and "
                    f"{written(name)}, which mean the same; remove one"
                )
            first[same] = name
        if key == MATERIAL:
            _check_constants(scene, table, set(first), keys)


def _check_constants(scene: Scene, table: str, names: set[str], keys: Sequence[str]) -> None:
    """Raise an error if a given constant of a body would be used for other materials."""
    material = getattr(scene, table).material
    present = find(material, own_materials(scene.materials)) if material is not None else None
    if present is not None and names == {present.name}:
        return
    for constant in OF_MATERIAL:
        place, _, key = constant.partition(".")
        given = getattr(getattr(scene, place), key, None)
        of_body = table == ("sphere" if place == "sphere" else "plate")
        if of_body and given is not None and constant not in keys:
            raise SceneError(
                f"{table}.{MATERIAL}: expected a scene without {constant}, which would be used for "
                "every material; remove it, or vary it too to use it for all"
            )


def written(value: float | str) -> str:
    """Return a value of a key for a message or a table."""
    return one_line(value) if isinstance(value, str) else f"{value:.6g}"


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
    return {f"{table}.{other}" for other in _excluding_keys(known, key)}


def varied(scene: Scene, values: Mapping[str, float | str]) -> dict[str, Any]:
    """Return the tables of a scene with new values of keys `table.key`, in SI units, or names.

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
        for other in _excluding_keys(table, key):
            given.pop(other, None)
        body = getattr(scene, name, None)
        if isinstance(body, Sphere | Plate):
            for other, constant in constants_beside(key, body, materials).items():
                if not _excluding_keys(table, other) & set(given):
                    given.setdefault(other, constant)
        given[key] = _typed(field_of(place), value)
    return data


def _typed(field: FieldInfo, value: float | str) -> Any:
    """Return a value with the type that a key takes."""
    if isinstance(value, str):
        return SWITCH.get(value, value) if bool in get_args(field.annotation) else value
    [example, *_] = field.examples or [value]
    return int(value) if isinstance(example, int) and value.is_integer() else value


def table_of(name: str) -> type[Table] | None:
    """Return the class of a table by its name, which may be `materials.NAME`."""
    return Material if name.startswith(f"{OWN_MATERIALS}.") else TABLES.get(name)


def _varied_keys() -> list[str]:
    """Return every key whose values are numbers or names as `table.key`."""
    return [
        f"{table}.{key}"
        for table, model in TABLES.items()
        for key, field in model.model_fields.items()
        if _takes_numbers(field) or _takes_names(key, field)
    ]


def _excluding_keys(table: type[Table], key: str) -> set[str]:
    """Return the keys that exclude a key, such as half_thickness for thickness."""
    return {
        other
        for groups in (*table.choices, *table.options)
        if any(key in group for group in groups)
        for group in groups
        if key not in group
        for other in group
    }
