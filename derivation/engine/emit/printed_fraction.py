"""Fraction of the arithmetic in a generated package that is printed from proved expressions.

Operators, signs, in-place updates and calls of NumPy's numerical functions are counted in the
syntax tree. Tables of numbers are not counted: `1 / 6` is a number.
"""

import ast
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

REASON = "Arithmetic:"
"""Start of the docstring paragraph that states the arithmetic of a handwritten module."""


@dataclass(frozen=True)
class ModuleArithmetic:
    """The arithmetic of a module.

    Parameters
    ----------
    module
        Name of the module.
    operations
        Number of operations.
    reason
        Description of operations that are written by hand; empty if they are printed from proved
        expressions.
    """

    module: str
    operations: int
    reason: str = ""

    @property
    def printed(self) -> bool:
        """Whether the operations are printed."""
        return not self.reason


def arithmetic_of_modules(sources: Mapping[str, str]) -> tuple[ModuleArithmetic, ...]:
    """Return the arithmetic of the modules that contain any, from the source texts by name."""
    counted = ((name, operations(text), text) for name, text in sorted(sources.items()))
    return tuple(
        ModuleArithmetic(name, count, reason_of(text)) for name, count, text in counted if count
    )


def printed_fraction(modules: Sequence[ModuleArithmetic]) -> float:
    """Return the printed fraction of all operations [1]."""
    printed = sum(part.operations for part in modules if part.printed)
    return printed / sum(part.operations for part in modules)


def expect_printed_fraction(modules: Sequence[ModuleArithmetic], kept: float) -> None:
    """Reject a package whose printed fraction is smaller than the committed one.

    Parameters
    ----------
    modules
        The arithmetic of the modules.
    kept
        The committed fraction [1].

    Raises
    ------
    ValueError
        If the fraction is smaller.
    """
    if (fraction := printed_fraction(modules)) < kept:
        raise ValueError(
            f"expected at least {100 * kept:.1f} % of the package's arithmetic to be printed from "
            f"proved expressions, as committed, got {100 * fraction:.1f} %; derive what was added"
        )


def operations(text: str) -> int:
    """Return the number of operations of a module."""
    return sum(map(_counts, ast.walk(ast.parse(text))))


def _counts(node: ast.AST) -> bool:
    if isinstance(node, ast.UnaryOp):
        return isinstance(node.op, ast.USub) and not isinstance(node.operand, ast.Constant)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
        is_numpy = isinstance(node.func.value, ast.Name) and node.func.value.id == "np"
        return is_numpy and isinstance(getattr(np, node.func.attr, None), np.ufunc)
    if isinstance(node, ast.BinOp):
        number = _is_number(node.left) and _is_number(node.right)
        return not number and not isinstance(node.op, ast.BitOr)  # a union of types
    return isinstance(node, ast.AugAssign)


def _is_number(node: ast.expr) -> bool:
    """Return whether a node is a number as written, with or without a sign."""
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return isinstance(node.operand, ast.Constant)
    return isinstance(node, ast.Constant)


def reason_of(text: str) -> str:
    """Return a module's statement about handwritten arithmetic; empty if there is none."""
    docstring = ast.get_docstring(ast.parse(text)) or ""
    for paragraph in docstring.split("\n\n"):
        if paragraph.startswith(REASON):
            return " ".join(paragraph.removeprefix(REASON).split())
    return ""


def expect_reason(name: str, text: str) -> None:
    """Reject a handwritten module that does not state its arithmetic.

    Raises
    ------
    ValueError
        If it has arithmetic and no statement.
    """
    if operations(text) and not reason_of(text):
        raise ValueError(
            f"{name}: expected a docstring paragraph that begins with {REASON!r} and states "
            "the module's arithmetic and why it is not printed, got none"
        )
