"""Assembles the code of a scene: docstring, constants, copies of printed functions and modules."""

import ast
import inspect
from collections.abc import Iterator, Mapping, Sequence
from importlib import import_module
from itertools import pairwise
from pathlib import Path

import numpy as np

RUNTIME = Path(__file__).parent / "runtime"
PACKAGES = "derivation.scene.code.runtime.", "generated."
"""Packages whose code is copied."""
DOUBLE = "Double = NDArray[np.float64]"
"""Definition of the type of arrays in printed functions."""
WIDTH = 94
"""Width of the text in columns."""
KEPT = {"LIMIT"}
"""Constants for users of the code that none of its functions needs."""


def composed(
    head: Sequence[str], remark: str, parts: Sequence[str], numbers: Mapping[str, object]
) -> str:
    """Return the source of a standalone module.

    Parameters
    ----------
    head
        Lines of the docstring.
    remark
        Comment lines below the docstring.
    parts
        Modules of `runtime`, in order. They are copied line for line, without the imports from one
        another. The printed functions that they import are copied before them.
    numbers
        The constants of `runtime.data` for this scene; unused ones are omitted.
    """
    printed = list(dict.fromkeys(text for part in parts for text in _printed(part)))
    trees = [ast.parse(text) for text in (*map(_source, parts), *printed)]
    used = {node.id for tree in trees for node in ast.walk(tree) if isinstance(node, ast.Name)}
    docstring = "\n".join(('"""' + head[0], *head[1:], '"""'))
    imports = "\n".join(sorted({text for part in parts for text in _imports(part)}))
    if any("Double" in text for text in printed):
        imports += f"\nfrom numpy.typing import NDArray\n\n{DOUBLE}"
    given = "\n".join(("# fmt: off", *_numbers(used, numbers), "# fmt: on"))
    bodies = "\n\n\n".join((*printed, *map(_body, parts)))
    return f"{docstring}\n{remark}\n\n{imports}\n\n{given}\n\n\n{bodies}\n"


def summary(part: str) -> str:
    """Return the first line of the docstring of a module of `runtime`."""
    return (ast.get_docstring(ast.parse(_source(part))) or "").partition("\n")[0].rstrip(".")


def _source(part: str) -> str:
    return (RUNTIME / f"{part}.py").read_text()


def _imports(part: str) -> Iterator[str]:
    """Yield the imports from other packages."""
    for node in ast.parse(_source(part)).body:
        own = isinstance(node, ast.ImportFrom) and (node.module or "").startswith(PACKAGES)
        if isinstance(node, ast.Import | ast.ImportFrom) and not own:
            yield ast.unparse(node)


def _printed(part: str) -> Iterator[str]:
    """Yield the source of the functions that a module of `runtime` imports from `generated`."""
    for node in ast.parse(_source(part)).body:
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("generated."):
            source = inspect.getsource(import_module(node.module or ""))
            functions = [f for f in ast.parse(source).body if isinstance(f, ast.FunctionDef)]
            for name in (alias.name for alias in node.names):
                (found,) = (f for f in functions if f.name == name)
                yield ast.get_source_segment(source, found) or ""


def _body(part: str) -> str:
    """Return the lines below the imports."""
    source = _source(part)
    above = [
        node.end_lineno or 0
        for node in ast.parse(source).body
        if isinstance(node, ast.Import | ast.ImportFrom)
    ]
    return "\n".join(source.splitlines()[max(above) :]).strip("\n")


def _numbers(used: set[str], numbers: Mapping[str, object]) -> Iterator[str]:
    """Yield the constants in the order of `runtime.data`, with their docstrings."""
    body = ast.parse(_source("data")).body
    for node, text in pairwise(body):
        if isinstance(node, ast.Assign) and isinstance(text, ast.Expr):
            name, meaning = ast.unparse(node.targets[0]), ast.literal_eval(text.value)
            if name in used | KEPT:
                yield f'{name} = {_literal(numbers[name])}\n"""{meaning}"""'


def _literal(value: object) -> str:
    """Return a number or an array as source, with all digits."""
    if not isinstance(value, np.ndarray):
        return repr(value)
    rows = np.array2string(
        value,
        separator=", ",
        threshold=value.size,
        max_line_width=WIDTH,
        formatter={"float_kind": lambda x: repr(float(x))},
    )
    return f"np.array(\n{rows}\n)"
