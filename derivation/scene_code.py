"""The code of one scene as text: its law's numbers filled in, measured, formatted."""

import math
from importlib.metadata import version
from pathlib import Path
from typing import Any

from derivation.engine.emit.source import filled, format_files
from derivation.engine.files import PACKAGE, write_file
from derivation.scene.code import errors, recipe
from derivation.scene.scene import Scene, SceneError

TEMPLATES = PACKAGE / "scene" / "templates"


def scene_code(scene: Scene) -> str:
    """Source of a standalone NumPy module with the contact law and the impact of a scene.

    Parameters
    ----------
    scene
        The scene, as `load` returns it; effects are those that `simulate` computes.

    Raises
    ------
    SceneError
        As `simulate` does; for a plate that moves; for a viscous contact on a held plate that
        bends; and where the code would not repeat the law.
    """
    made = recipe(scene)
    context = made.context | {"version": version("platecontact")}
    found = {name: _above(error) for name, error in errors(made, _run(context)).items()}
    return format_files({"scene.py": filled("scene", context | {"errors": found}, TEMPLATES)})[
        "scene.py"
    ]


def write_scene_code(scene: Scene, out: Path) -> None:
    """Write it to a file, whole or not at all.

    Raises
    ------
    SceneError
        If the file's name is not that of a Python module.
    OSError
        If it cannot be written.
    """
    if out.suffix != ".py":
        raise SceneError(f"--out: expected a file ending in .py, got {out}; add .py")
    write_file(out, scene_code(scene))


def _run(context: dict[str, Any]) -> dict[str, Any]:
    """The names that the code defines, its errors not known yet."""
    unknown = dict.fromkeys(("force", "stiffness", "contact_radius", "impact"), "")
    names: dict[str, Any] = {"__name__": "scene"}
    exec(
        compile(filled("scene", context | {"errors": unknown}, TEMPLATES), "scene.py", "exec"),
        names,
    )
    return names


def _above(error: float) -> str:
    """One digit of an error, rounded up."""
    least = max(error, 1e-15)
    return f"{least + 0.5 * 10.0 ** math.floor(math.log10(least)):.0e}"
