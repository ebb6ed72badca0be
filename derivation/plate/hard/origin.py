"""What the references of hard cases follow from, as a hash: one that changes asks for them anew."""

import ast
import hashlib
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import sympy as sp

from derivation.engine.files import PACKAGE
from derivation.engine.formula.record import Record
from derivation.mathematics.bessel import oracle as zeros
from derivation.plate import derived
from derivation.plate.cases.laws import LAWS
from derivation.plate.contact.oracle import moments
from derivation.plate.hard.truth import DIGITS


@cache
def origin(kernel: str) -> str:
    """Hash of a kernel's derived expression, or of its oracle: the modules and all they import.

    Parameters
    ----------
    kernel
        Its name.
    """
    law = LAWS.get(kernel)
    if law is not None:
        return _of_modules(law.oracle)
    formulas = _formulas()
    if kernel not in formulas:  # Bessel functions, and numbers by index
        return _of_modules((zeros.__name__, moments.__name__))
    formula = formulas[kernel]
    load = (formulas["A_j"],) if formula.summed else ()
    return _hash("".join(sp.srepr(part.expression) for part in (formula, *load)))


@cache
def _formulas() -> dict[str, Record]:
    return derived.formulas()


@cache
def _of_modules(names: tuple[str, ...]) -> str:
    found: set[Path] = set()
    waiting = [_file(name) for name in names]
    while waiting:
        path = waiting.pop()
        if path not in found:
            found.add(path)
            waiting += _imports(path)
    return _hash("".join(sorted(_code(path) for path in found)))


def _code(path: Path) -> str:
    """A module without its comments, its docstrings, and the places that it imports from."""
    tree = ast.parse(path.read_text())
    imported: list[str] = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            node.body = node.body[ast.get_docstring(node) is not None :]
        body = getattr(node, "body", None)
        if isinstance(body, list):
            imported += [name for part in body for name in _imported(part)]
            body[:] = [part for part in body if not isinstance(part, ast.ImportFrom)]
    return ast.dump(tree) + repr(sorted(imported))


def _imported(node: ast.AST) -> Iterator[str]:
    """What a statement imports: a module by the name that it has here, since it may move."""
    if isinstance(node, ast.ImportFrom):
        for alias in node.names:
            name = alias.asname or alias.name
            moves = _file(f"{node.module}.{alias.name}").is_file()
            yield name if moves else f"{alias.name} as {name}"


def _imports(path: Path) -> Iterator[Path]:
    """Modules of this package that a module imports."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(PACKAGE.name):
            names = [f"{node.module}.{alias.name}" for alias in node.names]
            files = [_file(name) for name in (*names, str(node.module))]
            yield from (file for file in files if file.is_file())


def _file(name: str) -> Path:
    return PACKAGE.parent.joinpath(*name.split(".")).with_suffix(".py")


def _hash(text: str) -> str:
    return hashlib.sha256(f"{DIGITS} {text}".encode()).hexdigest()[:16]
