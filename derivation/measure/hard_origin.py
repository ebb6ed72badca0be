"""What the references of hard cases follow from, as a hash: one that changes asks for them anew."""

import ast
import hashlib
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import sympy as sp

from derivation import derived
from derivation.files import PACKAGE
from derivation.formula.record import Formula
from derivation.measure.hard_laws import LAWS
from derivation.measure.hard_truth import DIGITS
from derivation.reference import moments, zeros


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
def _formulas() -> dict[str, Formula]:
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
    return _hash("".join(_code(path) for path in sorted(found)))


def _code(path: Path) -> str:
    """A module without its comments and docstrings."""
    tree = ast.parse(path.read_text())
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            node.body = node.body[ast.get_docstring(node) is not None :]
    return ast.dump(tree)


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
