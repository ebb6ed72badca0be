"""Record of the comparisons in modules: their outcomes, and how close the operands were.

The code of each function is replaced by the same code with recorded comparisons. The function
objects remain the same, so that every reference to them is recorded.
"""

import ast
import gc
import math
import operator
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from itertools import pairwise
from types import CodeType, FunctionType, ModuleType
from typing import Any, NamedTuple
from unittest.mock import patch

import numpy as np

COUNTER = "_counted_comparison"
OPERATORS: Mapping[type[ast.cmpop], Any] = {
    ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge,
    ast.Eq: operator.eq, ast.NotEq: operator.ne,
}  # fmt: skip


class Position(NamedTuple):
    """A comparison: module and function, and its number there."""

    home: str
    number: int


@dataclass
class Sides:
    """Smallest relative distance of a comparison's operands by outcome; inf if there is none."""

    true: float = math.inf
    false: float = math.inf

    def count(self, left: Any, right: Any, outcome: Any) -> None:
        """Record a comparison.

        The distance is zero between consecutive integers, from zero, and for operands that are not
        floats. A comparison with NaN is not recorded.
        """
        if isinstance(left, float) and isinstance(right, float):  # the same, without arrays
            relative = _relative_distance(left, right)
            if outcome:
                self.true = min(self.true, relative)
            else:
                self.false = min(self.false, relative)
            return
        left, right, outcome = np.asarray(left), np.asarray(right), np.asarray(outcome)
        if left.dtype.kind != "f" and right.dtype.kind != "f":
            self.true = 0.0 if outcome.any() else self.true
            self.false = self.false if outcome.all() else 0.0
            return
        left, right, outcome = np.broadcast_arrays(left, right, outcome)
        with np.errstate(all="ignore"):
            distance = np.abs(np.subtract(left, right, dtype=float))
            whole = (left == np.rint(left)) & (right == np.rint(right)) & (distance <= 1)
            relative = distance / np.maximum(np.abs(left), np.abs(right))
            relative = np.where(whole | (left == 0) | (right == 0) | (left == right), 0.0, relative)
        relative[np.isnan(left) | np.isnan(right)] = np.inf
        relative[np.isnan(relative)] = 1.0  # infinities
        self.true = min(self.true, relative[outcome].min(initial=np.inf))
        self.false = min(self.false, relative[~outcome].min(initial=np.inf))


def _relative_distance(left: float, right: float) -> float:
    """Return the relative distance of the operands of a comparison; see `Sides.count`."""
    if math.isnan(left) or math.isnan(right):
        return math.inf
    distance = abs(left - right)
    if left in (0.0, right) or right == 0.0:
        return 0.0
    if distance <= 1.0 and left.is_integer() and right.is_integer():
        return 0.0
    if math.isinf(distance):
        return 1.0
    return float(distance / max(abs(left), abs(right)))


@dataclass
class Watch:
    """The recorded comparisons of modules."""

    sides: dict[Position, Sides] = field(default_factory=dict)

    def beyond(self, reach: float) -> dict[Position, Sides]:
        """Return the comparisons that did not have both outcomes within a relative distance."""
        return {
            position: sides
            for position, sides in self.sides.items()
            if not max(sides.true, sides.false) <= reach
        }


@contextmanager
def watched(texts: Mapping[ModuleType, str]) -> Iterator[Watch]:
    """Record the comparisons of numbers in functions of modules.

    `texts` has the sources of the modules. Arguments of `inside`, conditions that raise an error or
    end a loop, and operators like ``in`` are not recorded.
    """
    watch, actual = Watch(), {}
    with ExitStack() as stack:
        for module, text in texts.items():
            counting = _Counting(module.__name__.rpartition(".")[2], watch)
            tree = ast.fix_missing_locations(counting.visit(ast.parse(text)))
            file = str(module.__file__)
            for code in _codes(compile(tree, file, "exec")):
                actual[file, code.co_qualname, code.co_firstlineno] = code
            stack.enter_context(patch.object(module, COUNTER, counting.compared, create=True))
        for function in [x for x in gc.get_objects() if isinstance(x, FunctionType)]:
            old = function.__code__
            new = actual.get((old.co_filename, old.co_qualname, old.co_firstlineno))
            if new is not None:
                stack.callback(setattr, function, "__code__", old)
                function.__code__ = new
        yield watch


def _codes(code: CodeType) -> Iterator[CodeType]:
    yield code
    for part in code.co_consts:
        if isinstance(part, CodeType):
            yield from _codes(part)


class _Counting(ast.NodeTransformer):
    """Replaces each comparison of a module by a call that records it."""

    def __init__(self, module: str, watch: Watch) -> None:
        self.home, self.watch = module, watch
        self.kinds: dict[Position, Any] = {}

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.AST:
        outer, self.home = self.home, f"{self.home}.{node.name}"
        actual = self.generic_visit(node)
        self.home = outer
        return actual

    def visit_If(self, node: ast.If) -> ast.AST:
        if len(node.body) == 1 and isinstance(node.body[0], ast.Raise | ast.Break):
            return node
        return self.generic_visit(node)

    def visit_Call(self, node: ast.Call) -> ast.AST:
        if isinstance(node.func, ast.Name) and node.func.id == "inside":
            return node
        return self.generic_visit(node)

    def visit_Compare(self, node: ast.Compare) -> ast.AST:
        self.generic_visit(node)
        if not all(type(op) in OPERATORS for op in node.ops):
            return node
        number = sum(position.home == self.home for position in self.kinds)
        for index, op in enumerate(node.ops):
            self.kinds[Position(self.home, number + index)] = OPERATORS[type(op)]
            self.watch.sides[Position(self.home, number + index)] = Sides()
        at = [ast.Constant(self.home), ast.Constant(number)]
        call = ast.Call(ast.Name(COUNTER, ast.Load()), [*at, node.left, *node.comparators], [])
        return ast.copy_location(call, node)

    def compared(self, home: str, number: int, *operands: Any) -> Any:
        """Return the outcome of a comparison; pairs of a chained one are recorded separately."""
        outcome: Any = True
        for index, (left, right) in enumerate(pairwise(operands)):
            position = Position(home, number + index)
            outcome = self.kinds[position](left, right)
            self.watch.sides[position].count(left, right, outcome)
            if index + 2 < len(operands) and not outcome:
                break
        return outcome
