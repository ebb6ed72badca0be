"""Text from files and command lines, made safe to show: nothing in it steers a terminal."""

import re

_STEERING = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]"
)
"""Control characters but tab and new line, marks of direction, and halves of characters."""


def printable(text: str) -> str:
    r"""Text with what steers a terminal written as Python writes it, as in ``\x1b``."""
    return _STEERING.sub(lambda found: _escaped(found[0]), text)


def one_line(text: str, most: int = 60) -> str:
    """The same on one line, cut short if longer than `most`."""
    cut = text if len(text) <= most else text[: most - 3] + "..."
    return printable(cut).replace("\n", "\\n").replace("\t", "\\t")


def in_json(text: str) -> str:
    """The same of JSON, whose own escapes are read back as what they stand for."""
    return _STEERING.sub(lambda found: f"\\u{ord(found[0]):04x}", text)


def _escaped(character: str) -> str:
    return character.encode("unicode_escape").decode("ascii")
