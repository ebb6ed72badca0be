"""Small pieces of Markdown: tables, code, anchors."""

from collections.abc import Iterable, Sequence


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table; cells may hold Markdown, a bar in them is escaped."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(map(_cell, line)) + " |" for line in lines)


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def code(text: object) -> str:
    """Return text set as code."""
    return f"`{text}`"


def anchored(text: str, anchor: str) -> str:
    """Return code that a link can point at."""
    return f"[`{text}`]{{#{anchor}}}"


def block(text: str, language: str = "text") -> str:
    """Return a block of code."""
    return f"```{language}\n{text.rstrip()}\n```"


def rst(text: str) -> str:
    """Return reStructuredText as a part of a Markdown page."""
    return f"```{{eval-rst}}\n{text.rstrip()}\n```"
