"""Tables as HTML, for a notebook."""

from collections.abc import Iterable, Sequence
from html import escape


def html_table(heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table with a line of heads; a `#` before a head, which marks numbers, is not shown."""
    top = "".join(f"<th>{escape(head.removeprefix('#'))}</th>" for head in heads)
    lines = ("".join(f"<td>{escape(str(cell))}</td>" for cell in row) for row in rows)
    return f"<table>{''.join(f'<tr>{line}</tr>' for line in (top, *lines))}</table>"
