"""The command `platecontact materials`: named materials with the sources of their constants."""

from typing import TYPE_CHECKING, Annotated

import typer

from derivation.engine.console import OUT, Json, write_json_output
from derivation.engine.text import aligned, paragraph

if TYPE_CHECKING:
    from derivation.scene.input.materials import KnownMaterial

COLUMNS = ("name", "#E [GPa]", "#nu", "#density [kg/m^3]", "#yield stress [MPa]")


def _names() -> list[str]:
    """Return the names that the Tab key completes."""
    from derivation.scene.input.materials import MATERIALS

    return list(MATERIALS)


def materials(
    name: Annotated[
        str | None,
        typer.Argument(metavar="NAME", help="Show this material only.", autocompletion=_names),
    ] = None,
    json: Json = None,
) -> None:
    """List named materials with their sources.

    Upper and lower case, spaces and hyphens in names do not matter.

    Example: platecontact materials "bearing steel"
    """
    from derivation.scene import SceneError
    from derivation.scene.input.materials import MATERIALS, find, unknown

    if name is None:
        if write_json_output(lambda: [material.to_json() for material in MATERIALS.values()], json):
            OUT.say(aligned(COLUMNS, [_cells(each) for each in MATERIALS.values()]))
            OUT.say("\nSources:")
            for each in MATERIALS.values():
                OUT.say(paragraph(f"  {each.name}: {each.source}", 4))
            OUT.say(
                "\n"
                + paragraph(
                    "E is Young's modulus, nu Poisson's ratio. To define another material, add a "
                    "table [materials.NAME] to the scene file.",
                    0,
                )
            )
        return
    body = find(name)
    if body is None:
        raise SceneError(f"materials: {unknown(name)}")
    if write_json_output(body.to_json, json):
        heads = (*(head.lstrip("#") for head in COLUMNS), "source", "other names")
        cells = (*_cells(body), body.source, ", ".join(body.also) or "none")
        OUT.say(aligned(("quantity", "value"), list(zip(heads, cells, strict=True))))


def _cells(material: "KnownMaterial") -> tuple[str, ...]:
    """Return a row of the table; a value that the source does not give is shown as n/a."""
    stress, density = material.yield_stress, material.density
    shown = (
        f"{material.youngs_modulus / 1e9:.6g}",
        f"{material.poissons_ratio:.6g}",
        "n/a" if density is None else f"{density:.6g}",
        "n/a" if stress is None else f"{stress / 1e6:.6g}",
    )
    return material.name, *shown
