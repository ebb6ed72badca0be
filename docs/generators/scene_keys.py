"""The keys of a scene file, table by table, from the JSON schema of the scene."""

from collections.abc import Iterator, Mapping
from typing import Any

import platecontact as pc

from derivation.scene.input.messages import LARGEST_NUMBER, SMALLEST_NUMBER
from derivation.scene.scene import TABLES, Material
from docs.generators.markdown import anchored, code, table

HEADS = ("key", "meaning", "unit", "allowed", "default", "example")
Schema = Mapping[str, Any]


def text() -> str:
    """Return a section for each table of a scene file."""
    schema = pc.schema()
    parts = []
    for name, entry in schema["properties"].items():
        own = "additionalProperties" in entry
        title = f"{name}.NAME" if own else name
        shape = _definition(schema, entry["additionalProperties"] if own else entry)
        needed = "required" if name in schema["required"] else "optional"
        about = _sentence(entry.get("description") or shape["description"])
        parts += [
            f"(table-{name})=\n## `[{title}]`",
            f"{about} This table is {needed}. {groups(name)}".rstrip(),
            table(HEADS, (_row(name, key, shape) for key in shape["properties"])),
        ]
    return "\n\n".join(parts)


def groups(name: str) -> str:
    """Return which keys of a table exclude one another, and of which one is required."""
    shape = TABLES.get(name, Material)
    required = "Exactly one of these is required"
    if shape.stand_in is not None:
        required += f" without `{shape.stand_in}`, and at most one with it"
    rules = [(required, choice) for choice in shape.choices]
    rules += [("At most one of these may be given", choice) for choice in shape.options]
    return " ".join(f"{said}: {', or '.join(map(_together, keys))}." for said, keys in rules)


def _together(names: tuple[str, ...]) -> str:
    return " with ".join(map(code, names))


def meanings() -> Iterator[tuple[str, str]]:
    """Yield every key as `table.key`, with its meaning."""
    schema = pc.schema()
    for name, entry in schema["properties"].items():
        shape = _definition(schema, entry.get("additionalProperties", entry))
        for key, said in shape["properties"].items():
            yield f"{name}.{key}", said["description"]


def _definition(schema: Schema, entry: Schema) -> Schema:
    """Return the definition that an entry refers to."""
    options = [entry, *entry.get("anyOf", ()), *entry.get("allOf", ())]
    name = next(option["$ref"] for option in options if "$ref" in option)
    definition: Schema = schema["$defs"][name.rpartition("/")[2]]
    return definition


def _row(name: str, key: str, shape: Schema) -> tuple[str, ...]:
    entry = shape["properties"][key]
    meaning, _, unit = entry["description"].partition(" [")
    unit, _, rest = unit.partition("]")
    default = entry.get("default")
    examples = entry.get("examples", ())
    return (
        anchored(key, f"key-{name}-{key}".replace("_", "-")),
        meaning + rest,
        unit and (code(unit) if unit != "1" else "1"),
        allowed(entry),
        "**required**" if key in shape.get("required", ()) else _default(default),
        code(_toml(examples[0])) if examples else "",
    )


def _default(value: Any) -> str:
    return "none" if value is None else code(_toml(value))


def allowed(entry: Schema) -> str:
    """Return in words which values an entry of the schema allows."""
    if "anyOf" in entry:
        return " or ".join(allowed(option) for option in entry["anyOf"])
    if "enum" in entry:
        return ", ".join(code(_toml(value)) for value in entry["enum"])
    if "const" in entry:
        return code(_toml(entry["const"]))
    if entry.get("type") == "array":
        return f"list of {allowed(entry['items'])}"
    kind = {"number": "number", "integer": "whole number", "boolean": "`true`, `false`"}.get(
        entry.get("type", ""), "text"
    )
    return " ".join([kind, ", ".join(_limits(entry))]).strip()


def _limits(entry: Schema) -> list[str]:
    signs = {"exclusiveMinimum": ">", "minimum": ">=", "exclusiveMaximum": "<", "maximum": "<="}
    of_all_numbers = {SMALLEST_NUMBER, LARGEST_NUMBER, -LARGEST_NUMBER}  # the page states them
    stated = [key for key in signs if key in entry and entry[key] not in of_all_numbers]
    return [f"{signs[key]} {entry[key]:g}" for key in stated]


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_toml, value))}]"
    return f"{value:g}"


def _sentence(said: str) -> str:
    first = said.partition("\n")[0].rstrip(".")
    return f"{first[0].upper()}{first[1:]}."
