"""How much of the arithmetic in a generated package is printed, module by module.

Counted are operators, signs, updates in place and calls of NumPy's functions of numbers, in the
syntax tree. Tables of numbers have none: `1 / 6` is a number.
"""

import ast
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from derivation.engine.emit.package import Copy, Numbers, Planned

REASON = "Arithmetic:"
"""Begins the paragraph of a docstring that says what arithmetic a module written by hand has."""


@dataclass(frozen=True)
class Share:
    """The arithmetic of a module.

    Parameters
    ----------
    module
        Its name.
    operations
        How many operations it has.
    printed
        Whether they are printed from proven expressions.
    reason
        What they are, if they are written by hand.
    """

    module: str
    operations: int
    printed: bool
    reason: str = ""


def shares(planned: Sequence[Planned], files: Mapping[str, str]) -> tuple[Share, ...]:
    """The arithmetic of every module that has some.

    Parameters
    ----------
    planned
        The modules of a package.
    files
        Their text by file name.
    """
    found = []
    for part in planned:
        text = files[f"{part.name}.py"]
        count = 0 if isinstance(part, Numbers) else operations(text)
        if count:
            by_hand = isinstance(part, Copy)
            found.append(Share(part.name, count, not by_hand, reason_of(text) if by_hand else ""))
    return tuple(found)


def printed_share(found: Sequence[Share]) -> float:
    """The part of all operations that is printed [1]."""
    printed = sum(part.operations for part in found if part.printed)
    return printed / sum(part.operations for part in found)


def operations(text: str) -> int:
    """How many operations a module has."""
    return sum(map(_counts, ast.walk(ast.parse(text))))


def _counts(node: ast.AST) -> bool:
    if isinstance(node, ast.UnaryOp):
        return isinstance(node.op, ast.USub) and not isinstance(node.operand, ast.Constant)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
        own = isinstance(node.func.value, ast.Name) and node.func.value.id == "np"
        return own and isinstance(getattr(np, node.func.attr, None), np.ufunc)
    if isinstance(node, ast.BinOp):
        return not isinstance(node.op, ast.BitOr)  # a union of types
    return isinstance(node, ast.AugAssign)


def reason_of(text: str) -> str:
    """What a module says of its arithmetic.

    Raises
    ------
    ValueError
        If it says nothing.
    """
    docstring = ast.get_docstring(ast.parse(text)) or ""
    for paragraph in docstring.split("\n\n"):
        if paragraph.startswith(REASON):
            return " ".join(paragraph.removeprefix(REASON).split())
    first = docstring.partition("\n")[0]
    raise ValueError(f"{first} expected a paragraph of the docstring that begins {REASON!r}")
