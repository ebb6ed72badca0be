"""Markdown that is written by the program itself when the site is built.

A page holds a line `<!-- generated: NAME -->`; `PARTS` says which function writes it.
"""

import re
from importlib import import_module

PARTS = {
    "api": "functions.api",
    "functions": "functions.generated",
    "exceptions": "functions.exceptions",
    "commands": "commands.text",
    "exit_status": "commands.exit_status",
    "names": "names.text",
    "scene_keys": "scene_keys.text",
    "effects_table": "effects.all_effects",
    "effects": "effects.entries",
    "effect_choice": "effects.choice",
    "effect_example": "effects.example",
    "materials": "materials.text",
    "gallery": "gallery.text",
    "costs": "costs.law",
    "dynamic_costs": "costs.inertia",
    "misprints": "misprints.text",
}
"""Module and function that write each part."""

_MARK = re.compile(r"^<!-- generated: (\w+) -->$", re.MULTILINE)


def filled(page: str) -> str:
    """Return a page with every generated part in its place.

    Raises
    ------
    KeyError
        If a page asks for a part that does not exist.
    """
    return _MARK.sub(lambda found: part(found[1]), page)


def part(name: str) -> str:
    """Return the Markdown of one part; its module is imported when it is needed."""
    module, _, function = PARTS[name].rpartition(".")
    text: str = getattr(import_module(f"{__name__}.{module}"), function)()
    return text


def used(page: str) -> list[str]:
    """Return the names of the parts that a page asks for."""
    return _MARK.findall(page)
