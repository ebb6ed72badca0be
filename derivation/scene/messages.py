"""Words for what is wrong with a scene: expected, got, and how to mend it."""

import difflib
import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from pydantic.fields import FieldInfo

from derivation.engine.printable import one_line

Fields = Mapping[str, Mapping[str, FieldInfo]]
"""Per table its keys."""

MOST, LONG = 20, 40
"""Problems that are listed, and letters of a key that are shown."""
ELSEWHERE_LIKE = 0.8
"""How alike, of 1, a key of another table has to be in order to be meant."""
TABLE_LIKE = 0.9
"""How alike a name has to be to a table's in order to be no key of another table."""
WANTED = '"auto", true or false'
EXPECTED = {
    "material": "the name of a material (`platecontact materials` lists them)",
    "source": "a text",
    "edge": '"paper", "simply-supported" or "clamped"',
    "outputs": "a list of contact_time, max_indentation, max_force, max_contact_radius and "
    "restitution",
    "lame_lambda": "a finite number",
    "loss_factor": "a number from 0 to below 2, where damping is critical",
    "poissons_ratio": "a number above -1 and below 0.5",
    "rtol": "a number from 1e-13 to 1",
    "compare_paper_motion": 'true or false (it is never "auto")',
    "modes": '"auto" or a whole number from 2 to 6000',
    "branches": '"A0" or "all"',
    "coupling": '"variational" or "pointwise"',
    "extent": '"finite" or "infinite"',
    "restitution": "a number above 0 and below 1",
    "solve_for": '"yield_stress" or "retardation_time"',
    "target": '"block" or "plate"',
}
"""What a key is to hold, if not a positive number."""

OWN_MATERIALS = "materials"
"""The table of tables that define materials."""
_SOLID = (
    "the sphere is solid: a hollow one bends like a shell, which this model does not include; "
    "remove it"
)
UNKNOWN = {
    ("sphere", key): _SOLID
    for key in ("thickness", "wall_thickness", "shell_thickness", "wall", "hollow", "inner_radius")
}
"""Why a table has no such key."""

ELSEWHERE = {
    "rtol": "; for more digits than doubles hold run "
    "`platecontact reference SCENE.toml --digits N`",
}
"""Where to go with what a key does not take."""


def shown(value: Any) -> str:
    """A value as TOML writes it, cut short if long."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, str):
        return f'the string "{one_line(value, 40)}"'
    if isinstance(value, Mapping):
        return "a table"
    if isinstance(value, (list, tuple)):
        return "an array"
    try:
        return one_line(str(value), 40)
    except ValueError:  # an integer of so many digits that Python refuses to print it
        return "an integer too large for a number"


def explain(kind: str, place: tuple[int | str, ...], value: Any, fields: Fields) -> str:
    """One problem of one key or table.

    Parameters
    ----------
    kind
        Pydantic's name of the error.
    place
        Table and key.
    value
        What the scene holds there.
    fields
        The keys each table knows.
    """
    name = _named(place)
    if kind in {"extra_forbidden", "invalid_key"}:
        return _unknown(place, fields)
    if kind == "string_unicode" and len(place) < 2:
        where = name or "scene"
        return f"{where}: expected a name of whole characters, got {shown(value)}; rename it"
    if place == (OWN_MATERIALS,):
        return (
            f"{name}: expected tables [{name}.NAME], got {shown(value)}; write [{name}.NAME], "
            "below it the material's constants"
        )
    if len(place) == 1:
        example = _line(name, next(iter(fields[name].items())))
        if kind == "missing":
            return f"{name}: expected a table [{name}], got none; add [{name}] with {example}, ..."
        expected = f"expected a table [{name}], got {shown(value)}"
        return f"{name}: {expected}; write [{name}], below it {example}"
    table, key = str(place[0]), str(place[1])
    field = fields[table][key]
    usual = WANTED if table == "effects" else "a positive number"
    name = f"{table}.{key}"  # not which alternative of it failed
    said = field.description or ""
    told = said if said.startswith(("the ", "how ")) else f"the {said}"
    expected = f"expected {EXPECTED.get(key, usual)}, {told}"
    example = _line(table, (key, field))
    if kind == "missing":
        return f"{name}: {expected}, got nothing; add {example} to [{table}]"
    elsewhere = ELSEWHERE.get(key, "")
    words = field.examples and not isinstance(field.examples[0], (int, float))
    quotes = " without quotes" if isinstance(value, str) and not words else ""
    return f"{name}: {expected}, got {shown(value)}; write it{quotes} like {example}{elsewhere}"


def choice_problem(
    table: str,
    groups: tuple[tuple[str, ...], ...],
    given: Iterable[str],
    examples: Mapping[str, str],
) -> str | None:
    """What is wrong if not exactly one group of keys is given, and given whole.

    Parameters
    ----------
    table
        Name of the table.
    groups
        The alternatives, each one key or several that go together.
    given
        Keys present.
    examples
        A value for each key.
    """
    keys = set(given)
    present = [key for group in groups for key in group if key in keys]
    whole = [group for group in groups if keys.issuperset(group)]
    if len(whole) == 1 and len(present) == len(whole[0]):
        return None
    wanted = " or ".join(_group(table, group) for group in groups)
    first = ", ".join(f"`{key} = {examples[key]}`" for key in groups[0])
    stray = [key for key in present if whole and key not in whole[0]]
    if not present:
        got, mend = "neither", f"add for instance {first} to [{table}]"
    elif len(whole) == 2 and len(present) == len(whole[0]) + len(whole[1]):
        got, mend = "both", f"remove {_group(table, whole[0])} or {_group(table, whole[1])}"
    elif whole:
        got, mend = _names(table, present), f"remove {_names(table, stray)}"
    else:
        begun = [group for group in groups if keys.intersection(group)]
        absent = [key for key in begun[0] if key not in keys]
        stray = [key for key in present if key not in begun[0]]
        got, mend = f"only {_names(table, present)}", f"add {_names(table, absent)}"
        mend += f" and remove {_names(table, stray)}" if stray else ""
    return f"[{table}]: expected either {wanted}, got {got}; {mend}"


def _unknown(place: tuple[int | str, ...], fields: Fields) -> str:
    name = _named(place)
    key = str(place[-1])
    if place in UNKNOWN:
        return f"{name}: unknown key: {UNKNOWN[place]}"
    homes = [f"[{table}]" for table, keys in fields.items() if key in keys]
    if len(place) == 1:
        known = [*(table for table in fields if "." not in table), OWN_MATERIALS]
        said = f"{name}: unknown table, expected {', '.join(known)}"
    else:
        table = str(place[0])
        known = list(fields[table])
        said = f"{name}: unknown key, expected in [{table}] one of {', '.join(known)}"
    table_meant = len(place) == 1 and nearest(key, known, TABLE_LIKE)
    if homes and not table_meant:
        return f"{said}; move it to {' or '.join(homes)}"
    near = nearest(key, known)
    if near:
        return f"{said}; did you mean {near}?"
    others = ((table, nearest(key, keys, ELSEWHERE_LIKE)) for table, keys in fields.items())
    elsewhere = [f"{table}.{other}" for table, other in others if other]
    found = nearest(name, elsewhere)
    return f"{said}; did you mean {found}?" if found else f"{said}; remove it"


def nearest(name: str, known: Iterable[str], alike: float = 0.5) -> str | None:
    """The known name that one mistyped is nearest to, if any is near."""
    lowered = name[:LONG].lower().replace("-", "_")
    close = difflib.get_close_matches(lowered, list(known), n=1, cutoff=alike)
    return close[0] if close else None


def listed(problems: Sequence[Callable[[], str]]) -> str:
    """Problems below each other; of very many the first, which alone are put into words."""
    lines = [f"\n  - {problem()}" for problem in problems[:MOST]]
    more = f"\n  - … and {len(problems) - MOST:,} more" if len(problems) > MOST else ""
    return f"{len(problems):,} problems{''.join(lines)}{more}"


def _named(place: tuple[int | str, ...]) -> str:
    """A key with its table, on a line however long or odd it is."""
    return ".".join(one_line(str(part), LONG) for part in place)


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
