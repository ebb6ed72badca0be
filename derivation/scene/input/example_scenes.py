"""The example scenes of the package: names, descriptions, copies."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path

from derivation.engine.files import write_files
from derivation.engine.nearest import did_you_mean, nearest
from derivation.scene.errors import SceneError
from derivation.scene.input.messages import shown

FOLDER = Path(__file__).parents[1] / "examples"


@dataclass(frozen=True)
class Example:
    """An example scene.

    Parameters
    ----------
    name
        Name of the scene file without its suffix.
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
        Names of examples, with or without the suffix ``.toml``.
    folder
        Folder of the copies; it is created if it does not exist.
    replace
        Whether existing files are replaced.

    Raises
    ------
    SceneError
        If a name is unknown, or a file exists and `replace` is false.
    OSError
        If the folder cannot be written to.
    """
    chosen = [_named(name) for name in dict.fromkeys(names)]
    targets = {folder / example.file.name: example.file for example in chosen}
    existing = [str(path) for path in targets if path.exists()]
    if existing and not replace:
        raise SceneError(
            f"examples: {', '.join(existing)} exists already; add --out DIR to write into another "
            "folder, or --force to replace it"
        )
    write_files({path: source.read_bytes() for path, source in targets.items()})
    return tuple(_example(path) for path in targets)


def _named(name: str) -> Example:
    """Return the example of a name."""
    known = examples()
    example = known.get(name.removesuffix(".toml"))
    if example is None:
        suggestion = did_you_mean(name.removesuffix(".toml"), known)
        raise SceneError(
            f"examples: expected the name of an example, got {shown(name)}; {suggestion}"
            "`platecontact examples` lists them"
        )
    return example


def _example(path: Path) -> Example:
    """Return the example of a scene file."""
    first = path.read_text(encoding="utf-8").partition("\n")[0]
    return Example(path.stem, first.removeprefix("#").strip(), path)


def remedy(path: Path) -> str:
    """Return what to do about a scene file that cannot be read: the nearest file or example."""
    with suppress(OSError):  # the name may be too long for the file system
        if path.exists():
            return "check that it is a file and that you may read it"
    folder = Path()
    with suppress(OSError):
        folder = path.parent if path.parent.is_dir() else folder
    for suggestion in nearest(path.stem, sorted(file.stem for file in folder.glob("*.toml"))):
        return f"did you mean {folder / suggestion}.toml?"
    for suggestion in nearest(path.stem, examples()):
        return f"check its name, or run `platecontact examples {suggestion}` to copy the example"
    return "check its name"
