"""Handwritten modules of a paper's package: their functions, and what they may import."""

import ast
import sys
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

from derivation.engine.emit.budgets import Budget
from derivation.engine.emit.copies import ListedFunction, listed_functions, relative

ALLOWED = sys.stdlib_module_names | {"numpy"}


def public_functions(file: Path) -> list[str]:
    """Return the names of the public functions of a module."""
    return [
        node.name
        for node in _parsed(_text(file), file).body
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_")
    ]


def expect_imports(file: Path, package: str, modules: Collection[str]) -> None:
    """Reject a module that needs more than NumPy and the other modules of its package.

    Raises
    ------
    ValueError
        If the file cannot be read, is not Python, or imports another module.
    """
    text = "\n".join(relative(line, package) for line in _text(file).splitlines())
    for name, own in _imports(_parsed(text, file)):
        if name not in (modules if own else ALLOWED):
            raise ValueError(
                f"{file.name}: expected imports from NumPy, the standard library, or "
                f"`.generated` with one of {', '.join(sorted(modules))}; got {name!r}"
            )


def _imports(tree: ast.Module) -> Iterator[tuple[str, bool]]:
    """Yield each imported module, and whether it belongs to the package."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((alias.name.split(".")[0], False) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            names = [node.module] if node.module else [alias.name for alias in node.names]
            yield from ((name.split(".")[0], node.level > 0) for name in names)


def manifest_rows(
    module: str, file: Path, budgets: Mapping[str, Budget], formulas: Collection[str]
) -> list[dict[str, Any]]:
    """Return the rows of the manifest for the marked functions of a module.

    Raises
    ------
    ValueError
        If a marked function has no budget, or has not the name of a formula, with which it could be
        compared.
    """
    rows = []
    for function in listed_functions(file):
        if function.name not in formulas or function.name not in budgets or not function.kernel:
            raise ValueError(
                f"{file.name}: expected the mark @in_manifest(..., kernel=True) on functions that "
                "compute a formula of the same name and have an error budget, got "
                f"{function.name!r}; remove the mark from other functions"
            )
        rows.append(manifest_row(module, function, budgets))
    return rows


def manifest_row(
    module: str, function: ListedFunction, budgets: Mapping[str, Budget]
) -> dict[str, Any]:
    """Return the row of a function in the manifest."""
    row = {
        "name": function.name,
        "module": module,
        "arguments": tuple(x.name for x in function.arguments),
        "unit": function.unit,
        "symbol": function.symbol,
        "equation": function.equation,
        "meaning": function.meaning,
        "domain": function.domain,
    } | budgets[function.name].row()
    if not function.kernel:
        return row
    units = [x.unit for x in function.arguments]
    return row | {"argument_units": units, "latex": function.symbol, "modes": False}


def _parsed(text: str, file: Path) -> ast.Module:
    try:
        return ast.parse(text)
    except SyntaxError as error:
        raise ValueError(f"{file.name}, line {error.lineno}: {error.msg}") from None


def _text(file: Path) -> str:
    try:
        return file.read_text()
    except (OSError, UnicodeDecodeError) as error:
        raise ValueError(f"{file.name}: expected a Python file, got {error}") from None
