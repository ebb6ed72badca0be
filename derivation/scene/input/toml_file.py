"""Reads TOML files: of scenes, and of distributions."""

import os
import tomllib
from pathlib import Path
from typing import Any

from derivation.engine.files import read_file
from derivation.engine.printable import one_line
from derivation.scene.errors import SceneError
from derivation.scene.input import toml_errors
from derivation.scene.input.messages import shown

LARGEST = 2**20
"""Largest size of a file [bytes]."""


def path_of(path: object) -> Path:
    """Return the path of a file that an argument denotes.

    Raises
    ------
    SceneError
        If the argument is neither text nor a path.
    """
    if not isinstance(path, str | os.PathLike):
        raise SceneError(f"expected the path of a file, got {shown(path)}; read tables with `read`")
    return Path(path)


def name_of(path: str | Path) -> str:
    """Return the name of a file in messages; "-" is standard input."""
    return "standard input" if str(path) == "-" else one_line(str(path), 200)


def read_toml(path: str | Path, kind: str, remedy: str, example: str) -> dict[str, Any]:
    """Return the content of a TOML file.

    Parameters
    ----------
    path
        The file; "-" for standard input.
    kind
        What the file contains, for messages, such as "the scene file".
    remedy
        What the user can do if the file cannot be read.
    example
        A line of such a file.

    Raises
    ------
    SceneError
        If the file cannot be read or is not TOML.
    """
    name, text = name_of(path), ""
    try:
        # Some editors begin a file with a byte-order mark, which TOML does not allow.
        text = read_file(Path(path), LARGEST).decode("utf-8-sig")
        return tomllib.loads(text)
    except OSError as error:
        reason = error.strerror or error
        raise SceneError(f"{name}: cannot read {kind} ({reason}); {remedy}") from None
    except UnicodeDecodeError as error:
        raise SceneError(
            f"{name}: expected UTF-8 text, got another encoding (at byte {error.start}); save the "
            "file as UTF-8"
        ) from None
    except tomllib.TOMLDecodeError as error:
        raise SceneError(f"{name}: not valid TOML: {toml_errors.in_words(error, text)}") from None
    except (ValueError, RecursionError):  # more digits or brackets than Python can read
        raise SceneError(
            f"{name}: expected TOML, got a number or nested brackets that are too long to read; "
            f"write lines such as {example}"
        ) from None
