"""Hash of the sources of references; if it changes, the references must be computed again.

The engine is not part of the hash. Its balls enclose the exact value however they are computed, so
that a change of the engine can change only their radii; the engine has its own tests.
"""

import ast
import hashlib
import sys
from collections.abc import Iterator
from functools import cache
from importlib.util import find_spec, resolve_name
from pathlib import Path
from typing import Any

import sympy as sp

from derivation.engine.oracle.reference import DIGITS

_HERE = __package__.partition(".")[0]
_ENGINE = f"{_HERE}.engine"
_WITH_EMPTY_LISTS: dict[str, Any] = {"show_empty": True} if sys.version_info >= (3, 13) else {}


def of_expression(expression: sp.Expr) -> str:
    """Return the hash of an expression from which balls are computed."""
    return _hash(sp.srepr(expression))


@cache
def of_modules(names: tuple[str, ...]) -> str:
    """Return the hash of modules and of all modules that they import, directly or indirectly.

    Imports from other packages than theirs and this one are ignored.

    Parameters
    ----------
    names
        Names of the modules.
    """
    packages = {_HERE, *(name.partition(".")[0] for name in names)}
    hashes: dict[str, str] = {}
    waiting = list(names)
    while waiting:
        name = waiting.pop()
        if name not in hashes:
            tree = ast.parse(_file(name).read_text())
            waiting += [part for part in _modules(tree, name) if part.partition(".")[0] in packages]
            hashes[name] = _code(tree, name)
    return _hash("".join(sorted(hashes.values())))


def _code(tree: ast.Module, name: str) -> str:
    """Return a module's code without comments, docstrings, sentences and sources of imports."""
    imported: list[str] = []
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list):
            imported += [word for part in body for word in _imported(part, name)]
            body[:] = [part for part in body if not isinstance(part, ast.ImportFrom)]
            body[:] = [part for part in body if not _is_text(part)]
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value:
            node.value = " "
    return dump(tree) + repr(sorted(imported))


def _is_text(node: ast.AST) -> bool:
    """Return whether a statement is a docstring of a module, class, function or attribute."""
    return isinstance(node, ast.Expr) and isinstance(getattr(node.value, "value", None), str)


def dump(tree: ast.AST) -> str:
    """Return the text of a syntax tree, the same in every version of Python.

    Python 3.12 added a field for type parameters, and 3.13 omits empty lists.

    Parameters
    ----------
    tree
        The tree; empty fields for type parameters are deleted from its nodes.
    """
    for node in ast.walk(tree):
        if getattr(node, "type_params", None) == []:
            del node.type_params  # type: ignore[attr-defined]
    return ast.dump(tree, **_WITH_EMPTY_LISTS)


def _imported(node: ast.AST, where: str) -> Iterator[str]:
    """Yield the imported names; a module is named as it is used, because its file may be moved."""
    if isinstance(node, ast.ImportFrom):
        for alias in node.names:
            name = alias.asname or alias.name
            moves = _is_module(f"{_source(node, where)}.{alias.name}")
            yield name if moves else f"{alias.name} as {name}"


def _modules(tree: ast.Module, where: str) -> Iterator[str]:
    """Yield the modules that a module imports, without those of the engine."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            source = _source(node, where)
            names = [source, *(f"{source}.{alias.name}" for alias in node.names)]
            yield from (n for n in names if not f"{n}.".startswith(f"{_ENGINE}.") and _is_module(n))


def _source(node: ast.ImportFrom, where: str) -> str:
    """Return the full name of the module from which a statement imports."""
    return resolve_name("." * node.level + (node.module or ""), where.rpartition(".")[0])


@cache
def _is_module(name: str) -> bool:
    """Return whether a name denotes a module, not a package or an object in a module."""
    try:
        spec = find_spec(name)
    except ModuleNotFoundError:
        return False
    return spec is not None and spec.submodule_search_locations is None and spec.has_location


def _file(name: str) -> Path:
    spec = find_spec(name)
    if spec is None or spec.origin is None:
        raise ModuleNotFoundError(f"no module {name}")
    return Path(spec.origin)


def _hash(text: str) -> str:
    return hashlib.sha256(f"{DIGITS} {text}".encode()).hexdigest()[:16]
