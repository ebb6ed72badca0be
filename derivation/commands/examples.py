"""The command `platecontact examples`, which lists the example scenes and copies them."""

from pathlib import Path
from typing import Annotated

import typer

from derivation.engine.console import NOTES, OUT, Json, write_json_output
from derivation.engine.text import aligned


def _names() -> list[str]:
    """Return the names that the Tab key completes."""
    from derivation.scene.input.example_scenes import examples as known

    return list(known())


def examples(
    name: Annotated[
        list[str] | None,
        typer.Argument(metavar="NAME", help="Copy these examples.", autocompletion=_names),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="DIR", help="Copy into this folder instead of the current one."
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace files that exist.")] = False,
    json: Json = None,
) -> None:
    """List the example scenes, or copy them.

    Example: platecontact examples glass_pane paper --out scenes
    """
    from derivation.scene import SceneError
    from derivation.scene.input.example_scenes import copy
    from derivation.scene.input.example_scenes import examples as known

    if not name:
        if out is not None or force:
            raise SceneError(
                "--out and --force apply only if examples are copied; add the NAME of an example, "
                "or remove these options"
            )
        available = tuple(known().values())
    else:
        available = copy(name, out or Path(), force)
    if not write_json_output(lambda: [example.to_json() for example in available], json):
        return
    if name:
        NOTES.say("\n".join(str(example.file) for example in available))
        return
    OUT.say(aligned(("example", "shows"), [(each.name, each.description) for each in available]))
    OUT.say("\nTo copy examples: platecontact examples NAME... [--out DIR]")
