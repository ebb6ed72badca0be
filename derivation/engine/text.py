"""Plain text for a screen of 80 columns: paragraphs, and tables whose cells are not broken."""

import re
from collections.abc import Sequence
from textwrap import wrap

from derivation.engine.printable import printable

WIDTH = 80
"""Columns of a screen."""


def paragraph(text: str, indent: int = 2) -> str:
    """Break a text between words; lines after the first one are indented."""
    lines = wrap(printable(text), WIDTH, subsequent_indent=" " * indent, break_on_hyphens=False)
    return "\n".join(lines)


def with_items(head: str, items: Sequence[str]) -> str:
    """Return a heading and items on as few lines as possible; no line is broken within an item.

    Examples
    --------
    >>> print(with_items("f:", ["x=1 (0x1)"] * 9))
    f: x=1 (0x1) x=1 (0x1) x=1 (0x1) x=1 (0x1) x=1 (0x1) x=1 (0x1) x=1 (0x1)
      x=1 (0x1) x=1 (0x1)
    """
    lines = [head]
    for item in map(printable, items):
        fits = len(lines[-1]) + 1 + len(item) <= WIDTH
        lines[-1:] = [f"{lines[-1]} {item}"] if fits else [lines[-1], f"  {item}"]
    return "\n".join(lines)


def wording(text: str) -> str:
    """Return a text with # in place of each number: similar texts have the same wording.

    Examples
    --------
    >>> wording("the contact radius is 8.63 times that at 1.2e-05 m")
    'the contact radius is # times that at # m'
    """
    return re.sub(r"(?<![A-Za-z_])[-+]?\d+(\.\d+)?(e[-+]?\d+)?", "#", text)


def aligned(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table; columns whose head starts with `#` are numbers, aligned right.

    Parameters
    ----------
    heads
        A head for each column.
    rows
        The cells, as many in each row as there are heads.
    """
    numbers = [head.startswith("#") for head in heads]
    lines = [[head.lstrip("#") for head in heads], *([*map(printable, row)] for row in rows)]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    lines.insert(1, ["-" * width for width in widths])
    return "\n".join(
        "  ".join(
            cell.rjust(width) if number else cell.ljust(width)
            for cell, width, number in zip(line, widths, numbers, strict=True)
        ).rstrip()
        for line in lines
    )
