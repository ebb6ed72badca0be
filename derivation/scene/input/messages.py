"""Error messages about a scene: what was expected, what was given, what to do."""

import json
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from numbers import Real
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from derivation.engine.nearest import did_you_mean, nearest
from derivation.engine.printable import one_line
from derivation.scene.input.quoted import in_unit

Fields = Mapping[str, Mapping[str, FieldInfo]]
"""The fields of each table by key."""

SMALLEST_NUMBER, LARGEST_NUMBER = 1e-30, 1e30
"""Limits of positive numbers in SI units, between which the formulas do not overflow."""
FEWEST_MODES, MOST_MODES = 2, 6000
"""Limits of the number of dynamic bending modes that a scene may give."""
BEYOND = "greater_than_equal", "less_than_equal"
"""Errors of numbers that are too small or too large."""
MOST, LONG = 20, 40
"""Largest number of problems that are listed, and of characters of a key that are shown."""
OTHER_TABLE_ALIKE = 0.8
"""Similarity, from 0 to 1, from which a key of another table is suggested."""
TABLE_ALIKE = 0.9
"""Similarity from which an unknown table counts as a misspelled table, not as a key."""
WANTED = '"auto", true or false'
EXPECTED = {
    "material": "the name of a material",
    "source": "text",
    "edge": '"paper", "simply-supported" or "clamped"',
    "outputs": "a list of contact_time, max_indentation, max_force, max_contact_radius and "
    "restitution",
    "lame_lambda": f"a number from {-LARGEST_NUMBER:g} to {LARGEST_NUMBER:g}",
    "gravity": f"a number from 0 to {LARGEST_NUMBER:g}",
    "loss_factor": "a number from 0 to below 2 (2 is critical damping)",
    "poissons_ratio": "a number above -1 and below 0.5",
    "rtol": "a number from 1e-13 to 1",
    "compare_paper_motion": 'true or false (not "auto")',
    "modes": f'"auto" or a whole number from {FEWEST_MODES} to {MOST_MODES}',
    "branches": '"auto", "A0" or "all"',
    "coupling": '"variational" or "pointwise"',
    "extent": '"finite" or "infinite"',
    "restitution": "a number above 0 and below 1",
    "solve_for": '"yield_stress" or "retardation_time"',
    "body": '"plate", "sphere" or "both"',
    "target": '"block" or "plate"',
}
"""Expected value of each key whose value is not a positive number."""

OWN_MATERIALS = "materials"
"""Name of the table that contains the tables of own materials."""
_SOLID = (
    "the sphere is solid, and the model does not include the bending of a hollow sphere; remove "
    "the key"
)
_ROUND = (
    'the plate is circular; give its radius, or set extent = "infinite" in [inertia] if the '
    "contact ends before waves return from the edge"
)
_CENTRAL = (
    "the sphere strikes the centre of the plate at a right angle and without friction; remove the "
    "key, and give the normal component of the velocity as impact.speed"
)
_MEASURED = (
    "a restitution is a result, or a measurement that determines a material constant; write "
    'restitution and solve_for = "yield_stress" or "retardation_time" in [measured]'
)
_FOUNDATION = "the plate is supported at its edge only, without a foundation; remove the key"
_DAMPING = "damping is given by the loss factor, twice the damping ratio of each mode; write "
_SYMBOLS = {
    "youngs_modulus": (
        "E", "young", "youngs", "modulus", "elastic_modulus", "young_modulus", "stiffness",
    ),
    "poissons_ratio": ("nu", "poisson", "poissons", "poisson_ratio"),
    "density": ("rho",),
}  # fmt: skip
"""Other names that users may expect of keys of a body or material."""
_EXPECTED_KEYS = {
    ("sphere", _SOLID): (
        "thickness", "wall_thickness", "shell_thickness", "wall", "hollow", "inner_radius",
        "inner_diameter",
    ),
    ("sphere", "give the radius, half of the diameter, as sphere.radius"): ("diameter",),
    ("plate", "give the radius, half of the diameter, as plate.radius"): ("diameter",),
    ("plate", _ROUND): ("length", "width", "shape", "side", "a", "b", "lx", "ly", "size"),
    ("plate", "the support of the edge is plate.edge; write for example `edge = \"clamped\"`"): (
        "support", "supports", "boundary", "boundary_condition", "bc", "edges", "mounting",
    ),
    ("plate", _FOUNDATION): ("foundation", "backing", "bedding", "winkler"),
    ("plate", _DAMPING + "plate.loss_factor"): ("damping", "damping_ratio", "zeta", "q_factor"),
    ("impact", _CENTRAL): (
        "x", "y", "offset", "position", "location", "point", "eccentricity", "angle", "direction",
        "friction", "spin", "rotation",
    ),
    ("impact", "give the impact speed, sqrt(2 g height) for a free fall, as impact.speed"): (
        "height", "drop_height", "fall_height", "h", "energy", "drop",
    ),
    ("impact", "the impact speed [m/s] is impact.speed; rename the key"): ("velocity", "v", "v0"),
    ("accuracy", "the relative tolerance is accuracy.rtol; rename the key"): (
        "tolerance", "tol", "accuracy", "error", "relative_tolerance", "eps",
    ),
}  # fmt: skip
UNKNOWN: dict[Any, str] = {
    (table, key): reason for (table, reason), keys in _EXPECTED_KEYS.items() for key in keys
} | {(table, "restitution"): _MEASURED for table in ("sphere", "plate", "impact")}
"""What to do instead of each key that users may expect but that does not exist."""

ELSEWHERE = {
    "material": "; `platecontact materials` lists them, and a table [materials.NAME] in the scene "
    "file defines another one",
    "edge": '; if the contact ends before waves return from the edge, set extent = "infinite" in '
    "[inertia]: then the edge has no effect",
}
"""Remedies for values beyond the range of a key."""
ENDLESS = ' and, for an infinite plate, extent = "infinite" in [inertia]'
"""Remedy for an infinite radius."""
INCOMPRESSIBLE = "`poissons_ratio = 0.49`"
"""Example for a solid that resists compression far more than shear."""
INFINITE = ("inf", "infinite", "infinity")
"""Values of an infinite radius."""


def tolerance_remedy(value: Any) -> str:
    """Return what to do about a tolerance that is not in its range, after a semicolon."""
    if not isinstance(value, Real) or isinstance(value, bool):
        return ""
    number = float(value)
    if 1.0 < number <= 100.0:
        return f"; for {number:g} % write {number / 100.0:g}"
    if 0.0 <= number < 1.0:
        return (
            "; for more digits than double precision has, run `platecontact reference SCENE.toml "
            "--digits N`"
        )
    return ""


def shown(value: Any) -> str:
    """Return a value as TOML writes it, shortened if it is long."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, str):
        return f'the string "{one_line(value, 40)}"'
    if isinstance(value, Mapping):
        return "a table"
    if isinstance(value, (list, tuple)):
        return "an array" if value else "an empty array"
    if isinstance(value, BaseModel):
        return one_line(repr(value), 40)
    try:
        return one_line(str(value), 40)
    except ValueError:  # an integer of so many digits that Python refuses to print it
        return "an integer with too many digits"


def explain(kind: str, location: tuple[int | str, ...], value: Any, fields: Fields) -> str:
    """Return the message for one problem of a key or table.

    Parameters
    ----------
    kind
        Pydantic's name of the error.
    location
        Table and key.
    value
        The given value.
    fields
        The fields of each table by key.
    """
    name = _name(location)
    if kind in {"extra_forbidden", "invalid_key"}:
        return _unknown(location, fields)
    if kind == "string_unicode" and len(location) < 2:
        where = name or "scene"
        return f"{where}: expected a name in valid Unicode, got {shown(value)}; rename it"
    if location == (OWN_MATERIALS,):
        return (
            f"{name}: expected tables [{name}.NAME], got {shown(value)}; write [{name}.NAME] and "
            "below it the constants of the material"
        )
    if len(location) == 1:
        example = _line(name, next(iter(fields[name].items())))
        if kind == "missing":
            return f"{name}: expected a table [{name}], got none; add [{name}] with {example}, ..."
        expected = f"expected a table [{name}], got {shown(value)}"
        return f"{name}: {expected}; write [{name}] and below it {example}"
    table, key = str(location[0]), str(location[1])
    field = fields[table][key]
    usual = WANTED if table == "effects" else "a positive number"
    if kind in BEYOND and value > 0:
        usual = f"a number from {SMALLEST_NUMBER:g} to {LARGEST_NUMBER:g}"
    name = f"{table}.{key}"  # without the alternative that failed
    meaning = re.split(r"[;:(]", field.description or "")[0].strip()
    expected = f"expected {EXPECTED.get(key, usual)} ({meaning})"
    example = _line(table, (key, field))
    for suggestion in (
        nearest(value, re.findall(r'"(.+?)"', expected)) if isinstance(value, str) else ()
    ):
        example = f'`{key} = "{suggestion}"`'
    if key == "poissons_ratio" and kind == "less_than":
        example = f"{INCOMPRESSIBLE} for a nearly incompressible solid"
    if kind == "missing":
        return f"{name}: {expected}, got nothing; add {example} to [{table}]"
    elsewhere = tolerance_remedy(value) if key == "rtol" else ELSEWHERE.get(key, "")
    text = field.examples and not isinstance(field.examples[0], (int, float))
    if name == "plate.radius" and str(value).lower() in INFINITE:
        elsewhere = ENDLESS
    elif isinstance(value, str) and not text:
        return f"{name}: {expected}, got {shown(value)}; {_unquoted(key, value, field)}{elsewhere}"
    return f"{name}: {expected}, got {shown(value)}; write for example {example}{elsewhere}"


def _unquoted(key: str, value: str, field: FieldInfo) -> str:
    """Return how to write a quoted number, or one with a unit."""
    found = re.search(r"\[(.+?)\]", field.description or "")
    unit = found[1] if found else ""
    numeric = field.examples and not isinstance(field.examples[0], bool)
    number = in_unit(value, unit) if numeric else None
    example = f"for example {_line('', (key, field))}" if number is None else ""
    in_that = f" in {unit}" if unit not in ("", "1") else ""
    return f"write it{in_that} without quotes, {example or f'`{key} = {number:.9g}`'}"


def choice_problem(
    table: str,
    groups: tuple[tuple[str, ...], ...],
    given: Iterable[str],
    examples: Mapping[str, str],
) -> str | None:
    """Return a message unless exactly one group of keys is given completely.

    Parameters
    ----------
    table
        Name of the table.
    groups
        The alternatives, each a key or several keys that belong together.
    given
        The given keys.
    examples
        An example value of each key.
    """
    keys = set(given)
    present = [key for group in groups for key in group if key in keys]
    complete = [group for group in groups if keys.issuperset(group)]
    if len(complete) == 1 and len(present) == len(complete[0]):
        return None
    wanted = " or ".join(_group(table, group) for group in groups)
    first = ", ".join(f"`{key} = {examples[key]}`" for key in groups[0])
    stray = [key for key in present if complete and key not in complete[0]]
    if not present:
        got, remedy = "neither", f"add for example {first} to [{table}]"
    elif len(complete) == 2 and len(present) == len(complete[0]) + len(complete[1]):
        got, remedy = "both", f"remove {_group(table, complete[0])} or {_group(table, complete[1])}"
    elif complete:
        got, remedy = _names(table, present), f"remove {_names(table, stray)}"
    else:
        begun = [group for group in groups if keys.intersection(group)]
        absent = [key for key in begun[0] if key not in keys]
        stray = [key for key in present if key not in begun[0]]
        got, remedy = f"only {_names(table, present)}", f"add {_names(table, absent)}"
        remedy += f" and remove {_names(table, stray)}" if stray else ""
    return f"[{table}]: expected either {wanted}, got {got}; {remedy}"


def instead(location: tuple[int | str, ...], fields: Fields) -> str:
    """Return what to write instead of a key that users may expect; empty for any other key."""
    for usual, others in _SYMBOLS.items():
        field = fields.get(str(location[0]), {}).get(usual)
        if field and location[-1] in others:
            return f"{field.description} is {_name(location[:-1])}.{usual}; rename the key"
    return UNKNOWN.get(location, "")


def _unknown(location: tuple[int | str, ...], fields: Fields) -> str:
    name = _name(location)
    key = str(location[-1])
    if location == ("vary",):
        return (
            "vary: expected distributions only in a scene file, for `platecontact sweep SCENE.toml "
            "--sample N`; give them to `sweep` in Python"
        )
    other = instead(location, fields)
    if other:
        return f"{name}: unknown key: {other}"
    homes = [f"[{table}]" for table, keys in fields.items() if key in keys]
    if len(location) == 1:
        known = [*(table for table in fields if "." not in table), OWN_MATERIALS]
        problem = f"{name}: unknown table, expected one of {', '.join(known)}"
    else:
        table = str(location[0])
        known = list(fields[table])
        problem = f"{name}: unknown key, expected in [{table}] one of {', '.join(known)}"
    table_meant = len(location) == 1 and nearest(key, known, TABLE_ALIKE)
    if homes and not table_meant:
        return f"{problem}; move it to {' or '.join(homes)}"
    qualified = {other: f"{table}.{other}" for table, keys in fields.items() for other in keys}
    elsewhere = nearest(key, qualified, OTHER_TABLE_ALIKE)
    suggestion = did_you_mean(key, known) or "".join(
        f"did you mean {qualified[k]}?" for k in elsewhere
    )
    return f"{problem}; {suggestion.rstrip() or 'remove it'}"


def listed(problems: Sequence[Callable[[], str]]) -> str:
    """Return the problems as a list; if there are many, only the first."""
    lines = [f"\n  - {problem()}" for problem in problems[:MOST]]
    more = f"\n  - … and {len(problems) - MOST:,} more" if len(problems) > MOST else ""
    return f"{len(problems):,} problems{''.join(lines)}{more}"


def _name(location: tuple[int | str, ...]) -> str:
    """Return a key with its table on one line, shortened if it is long."""
    return ".".join(one_line(str(part), LONG) for part in location)


def _names(table: str, keys: Iterable[str]) -> str:
    return " and ".join(f"{table}.{key}" for key in keys)


def _group(table: str, keys: tuple[str, ...]) -> str:
    pair = "the pair " if len(keys) > 1 else ""
    return pair + ", ".join(f"{table}.{key}" for key in keys)


def _line(table: str, item: tuple[str, FieldInfo]) -> str:
    key, field = item
    examples = field.examples or [f"... in [{table}]"]
    example = examples[0]
    text = shown(example) if isinstance(example, (int, float)) else json.dumps(example)
    return f"`{key} = {text}`"
