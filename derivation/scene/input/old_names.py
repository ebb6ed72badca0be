"""Old names of scene keys and values, accepted with a notice until they are removed in 0.3."""

import warnings
from collections.abc import Mapping
from typing import Any, NamedTuple

KEYS = {
    "plate.strength": "plate.tensile_strength",
    "plate.viscous_time": "plate.retardation_time",
    "effects.curvature": "effects.spherical_profile",
    "effects.perturbation": "effects.compare_paper_motion",
    "effects.pressure": "effects.non_hertzian_pressure",
    "effects.side_wall": "effects.finite_radius",
    "inertia.closure": "inertia.coupling",
    "inertia.plate": "inertia.extent",
}
"""Old key -> new key, in the same table."""
VALUES = {
    ("plate.edge", "soft-hinge"): "paper",
    ("inertia.extent", "modes"): "finite",
}
"""New key and old value -> new value."""
REMOVED = "the old name will be removed in 0.3"


class OldNameWarning(FutureWarning):
    """A scene uses a name that has been replaced."""


class Renewed(NamedTuple):
    """Tables of a scene under new names, notices of renamed keys, and keys given twice."""

    tables: dict[str, Any]
    notices: list[str]
    problems: list[str]


def renewed(data: Mapping[str, Any]) -> Renewed:
    """Return the tables of a scene with every old name replaced."""
    result = Renewed(dict(data), [], [])
    for table, keys in data.items():
        if isinstance(keys, dict):
            result.tables[table] = _renewed(f"{table}", keys, result)
    return result


def _renewed(table: str, keys: Mapping[str, Any], result: Renewed) -> dict[str, Any]:
    """Return the keys of a table under new names."""
    made = dict[str, Any]()
    for key, value in keys.items():
        old = f"{table}.{key}"
        new = KEYS.get(old, old)
        name = new.removeprefix(f"{table}.") if new != old else key
        if new != old and name in keys:
            result.problems.append(
                f"{new}: expected one value, got another one under the old name {old}; remove {old}"
            )
            continue
        if isinstance(value, str) and (new, value) in VALUES:
            known = VALUES[new, value]
            result.notices.append(f'{old} = "{value}" is now {new} = "{known}"; {REMOVED}')
            value = known
        elif new != old:
            result.notices.append(f"{old} is now called {new}; {REMOVED}")
        made[name] = value
    return made


def new_key(key: str) -> str:
    """Return a key `table.name` under its new name, with a notice if it has one."""
    if key in KEYS:
        notify(f"{key} is now called {KEYS[key]}; {REMOVED}")
    return KEYS.get(key, key)


def notify(notice: str) -> None:
    """Issue a warning that points at the caller of the function that calls this one."""
    warnings.warn(notice, OldNameWarning, stacklevel=4)
