"""The example scenes of the package: their names, what each one shows, and copies of them."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from derivation.engine.files import write_files
from derivation.scene.errors import SceneError
from derivation.scene.messages import nearest, shown

FOLDER = Path(__file__).parent / "examples"


@dataclass(frozen=True)
class Example:
    """An example scene.

    Parameters
    ----------
    name
        Name of the scene file without its ending.
    description
        What the scene shows: the first comment line of the file.
    file
        The scene file.
    """

    name: str
    description: str
    file: Path

    def to_json(self) -> dict[str, str]:
        """Return name, description and path as text."""
        return {key: str(value) for key, value in asdict(self).items()}


def examples() -> dict[str, Example]:
    """Return all example scenes by name, in alphabetical order."""
    return {path.stem: _example(path) for path in sorted(FOLDER.glob("*.toml"))}


def copy(names: Sequence[str], folder: Path, replace: bool = False) -> tuple[Example, ...]:
    """Copy example scenes into a folder, all or none, and return the copies.

    Parameters
    ----------
    names
        Names of examples, with or without the ending ``.toml``.
    folder
        Where the copies are written; it is made if it does not exist.
    replace
        Whether files that exist are replaced.

    Raises
    ------
    SceneError
        If there is no example of a name, or a file exists that may not be replaced.
    OSError
        If the folder cannot be written to.
    """
    found = [_named(name) for name in dict.fromkeys(names)]
    targets = {folder / example.file.name: example.file for example in found}
    there = [str(path) for path in targets if path.exists()]
    if there and not replace:
        raise SceneError(
            f"examples: expected no file of that name yet, got {', '.join(there)}; "
            "add --out DIR to write into another folder, or --force to replace the file"
        )
    write_files({path: source.read_bytes() for path, source in targets.items()})
    return tuple(_example(path) for path in targets)


def _named(name: str) -> Example:
    """Return the example of a name."""
    known = examples()
    found = known.get(name.removesuffix(".toml"))
    if found is None:
        near = nearest(name.removesuffix(".toml"), known)
        meant = f"did you mean {near}? " if near else ""
        raise SceneError(
            f"examples: expected the name of an example, got {shown(name)}; {meant}"
            "`platecontact examples` lists them"
        )
    return found


def _example(path: Path) -> Example:
    """Return the example of a scene file."""
    first = path.read_text(encoding="utf-8").partition("\n")[0]
    return Example(path.stem, first.removeprefix("#").strip(), path)
