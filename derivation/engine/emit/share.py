"""How much of the arithmetic in a generated package is printed, module by module.

Counted are operators, signs, updates in place and calls of NumPy's functions of numbers, in the
syntax tree. Tables of numbers have none: `1 / 6` is a number.
"""

import ast
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

REASON = "Arithmetic:"
"""Begins the paragraph of a docstring that says what arithmetic a module written by hand has."""


@dataclass(frozen=True)
class ModuleArithmetic:
    """The arithmetic of a module.

    Parameters
    ----------
    module
        Its name.
    operations
        How many operations it has.
    reason
        What they are, if they are written by hand; empty where they are printed from proven
        expressions.
    """

    module: str
    operations: int
    reason: str = ""

    @property
    def printed(self) -> bool:
        """Whether they are printed."""
        return not self.reason


def shares(sources: Mapping[str, str]) -> tuple[ModuleArithmetic, ...]:
    """The arithmetic of every module that has some, from the text of the modules by name."""
    counted = ((name, operations(text), text) for name, text in sorted(sources.items()))
    return tuple(
        ModuleArithmetic(name, count, reason_of(text)) for name, count, text in counted if count
    )


def printed_share(found: Sequence[ModuleArithmetic]) -> float:
    """The part of all operations that is printed [1]."""
    printed = sum(part.operations for part in found if part.printed)
    return printed / sum(part.operations for part in found)


def expect_growth(found: Sequence[ModuleArithmetic], kept: float) -> None:
    """Refuse a package of which less is printed than was.

    Parameters
    ----------
    found
        The arithmetic of its modules.
    kept
        The share that was reached before [1].

    Raises
    ------
    ValueError
        If it is less.
    """
    if (share := printed_share(found)) < kept:
        raise ValueError(
            f"expected at least {100 * kept:.1f} % of the package's arithmetic to be printed from "
            f"proven expressions, as before, got {100 * share:.1f} %; print what was added by hand"
        )


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
        number = _is_number(node.left) and _is_number(node.right)
        return not number and not isinstance(node.op, ast.BitOr)  # a union of types
    return isinstance(node, ast.AugAssign)


def _is_number(node: ast.expr) -> bool:
    """A number as it is written, with or without a sign."""
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return isinstance(node.operand, ast.Constant)
    return isinstance(node, ast.Constant)


def reason_of(text: str) -> str:
    """What a module says of arithmetic written by hand; empty if it says nothing."""
    docstring = ast.get_docstring(ast.parse(text)) or ""
    for paragraph in docstring.split("\n\n"):
        if paragraph.startswith(REASON):
            return " ".join(paragraph.removeprefix(REASON).split())
    return ""


def expect_reason(name: str, text: str) -> None:
    """Refuse a module written by hand that does not say what its arithmetic is.

    Raises
    ------
    ValueError
        If it has some and says nothing.
    """
    if operations(text) and not reason_of(text):
        raise ValueError(
            f"{name}: expected a paragraph of the module's docstring that begins {REASON!r} and "
            "says what arithmetic it has and why that is not printed, got none"
        )
