"""Text from files and command lines with control characters escaped for the terminal."""

import re

_CONTROL_CHARACTERS = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]"
)
"""Control characters except tab and newline, marks of direction, and surrogates."""


def printable(text: str) -> str:
    r"""Return text with control characters escaped as in Python, like ``\x1b``."""
    return _CONTROL_CHARACTERS.sub(lambda match: _escaped(match[0]), text)


def one_line(text: str, most: int = 60) -> str:
    """Return the first `most` characters of a text on one line, with control characters escaped."""
    cut = text if len(text) <= most else text[: most - 3] + "..."
    return printable(cut).replace("\n", "\\n").replace("\t", "\\t")


def in_json(text: str) -> str:
    r"""Return JSON text with control characters escaped as in JSON, like ``\u001b``."""
    return _CONTROL_CHARACTERS.sub(lambda match: f"\\u{ord(match[0]):04x}", text)


def _escaped(character: str) -> str:
    return character.encode("unicode_escape").decode("ascii")
