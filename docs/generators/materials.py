"""The catalogue of materials, as `platecontact materials` lists it."""

from derivation.commands.materials import COLUMNS, _cells
from derivation.scene.input.materials import MATERIALS
from docs.generators.markdown import table


def text() -> str:
    """Return the table of all named materials with their other names."""
    heads = (*(head.lstrip("#") for head in COLUMNS), "other names")
    rows = ((*_cells(each), ", ".join(each.also)) for each in MATERIALS.values())
    return table(heads, ((f"`{name}`", *rest) for name, *rest in rows))
