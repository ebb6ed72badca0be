"""Table of the arithmetic in each module of the generated package, printed or by hand."""

from collections.abc import Mapping
from typing import Any

from derivation.engine.emit.printed_fraction import (
    ModuleArithmetic,
    arithmetic_of_modules,
    printed_fraction,
)
from derivation.engine.report.latex import escape, prose


def arithmetic_context(sources: Mapping[str, str]) -> dict[str, Any]:
    """Return the context of the section on generated code, from the source texts by module."""
    sources_by_module = arithmetic_of_modules(sources)
    return {
        "operations": sum(part.operations for part in sources_by_module),
        "printed": f"{100 * printed_fraction(sources_by_module):.0f}",
        "rows": [_row(part) for part in sources_by_module],
    }


def _row(part: ModuleArithmetic) -> str:
    printed, by_hand = (part.operations, 0) if part.printed else (0, part.operations)
    cells = rf"\texttt{{{escape(part.module)}}}", str(printed), str(by_hand), prose(part.reason)
    return " & ".join(cells)
