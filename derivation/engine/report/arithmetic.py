"""How much of the generated package's arithmetic is printed, as a table of its modules."""

from collections.abc import Mapping
from typing import Any

from derivation.engine.emit.share import ModuleArithmetic, printed_share, shares
from derivation.engine.report.latex import escape, prose


def arithmetic_context(sources: Mapping[str, str]) -> dict[str, Any]:
    """What the section on generated code says of it, from the text of the modules by name."""
    found = shares(sources)
    return {
        "operations": sum(part.operations for part in found),
        "printed": f"{100 * printed_share(found):.0f}",
        "rows": [_row(part) for part in found],
    }


def _row(part: ModuleArithmetic) -> str:
    printed, by_hand = (part.operations, 0) if part.printed else (0, part.operations)
    cells = rf"\texttt{{{escape(part.module)}}}", str(printed), str(by_hand), prose(part.reason)
    return " & ".join(cells)
