"""HTML tables for notebooks."""

from collections.abc import Iterable, Sequence


def html_table(heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a table; a `#` at the start of a column head, which marks numbers, is removed."""
    from html import escape  # simulations need no tables

    top = "".join(f"<th>{escape(head.removeprefix('#'))}</th>" for head in heads)
    lines = ("".join(f"<td>{escape(str(cell))}</td>" for cell in row) for row in rows)
    return f"<table>{''.join(f'<tr>{line}</tr>' for line in (top, *lines))}</table>"
