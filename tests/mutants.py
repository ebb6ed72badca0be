"""Systematic mutants of a SymPy expression and of a Python module, equal in every run."""

import ast
import copy
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import sympy as sp

SWAPPED = {
    sp.sin: sp.cos, sp.cos: sp.sin, sp.sinh: sp.cosh, sp.cosh: sp.sinh, sp.tanh: sp.coth,
    sp.coth: sp.tanh, sp.exp: sp.cosh, sp.log: sp.exp,
}  # fmt: skip


class Mutant(NamedTuple):
    """A changed expression, and a description of the change."""

    name: str
    expression: sp.Expr


def of_expression(expression: sp.Expr) -> list[Mutant]:
    """Return mutants with one sign, exponent, coefficient or function changed.

    Each node of the tree is changed in turn. Mutants that SymPy finds equal to the expression, such
    as cosh(-x), and repeated mutants are omitted.
    """
    actual = {expression: ""}
    for path, node in _places(expression):
        for what, new in _changes(node):
            mutant = replaced(expression, path, new)
            actual.setdefault(mutant, f"{what}: {node}")
    return [Mutant(name, mutant) for mutant, name in actual.items() if name]


def _places(
    node: sp.Basic, path: tuple[int, ...] = ()
) -> Iterator[tuple[tuple[int, ...], sp.Expr]]:
    if isinstance(node, sp.Expr):
        yield path, node
    for index, part in enumerate(node.args):
        if not isinstance(part, sp.Tuple):  # a variable of integration
            yield from _places(part, (*path, index))


def replaced(node: sp.Basic, path: tuple[int, ...], new: sp.Expr) -> sp.Expr:
    if not path:
        return new
    parts = list(node.args)
    parts[path[0]] = replaced(parts[path[0]], path[1:], new)
    return node.func(*parts)


def _changes(node: sp.Expr) -> Iterator[tuple[str, sp.Expr]]:
    if node.is_Rational:
        return
    yield "sign", -node
    yield "doubled", 2 * node
    coefficient, rest = node.as_coeff_Mul()
    if abs(coefficient) != 1:
        yield "coefficient dropped", sp.sign(coefficient) * rest
    if node.is_Add:
        for term in node.args:
            yield f"{term} dropped from", node - term
    if node.is_Symbol:
        yield "exponent", node**2
    if node.is_Pow and node.exp.is_number:
        yield "exponent", node.base ** (node.exp + 1)
    if type(node) in SWAPPED:
        yield "function", SWAPPED[type(node)](*node.args)
    if isinstance(node, sp.besselj | sp.besseli | sp.besselk):
        yield "function", node.func(1 - node.args[0], node.args[1])


Code = ast.expr | ast.AugAssign


class CodeMutant(NamedTuple):
    """Name of the changed function or constant, the change, its lines, and the changed module."""

    home: str
    change: str
    lines: range
    tree: ast.Module


OPERATORS: dict[type[ast.operator], ast.operator] = {
    ast.Add: ast.Sub(), ast.Sub: ast.Add(), ast.Mult: ast.Div(), ast.Div: ast.Mult(),
}  # fmt: skip
CALLS = {
    "sqrt": "cbrt", "cbrt": "sqrt", "minimum": "maximum", "maximum": "minimum", "exp": "expm1",
    "expm1": "exp", "times": "times_closely",
}  # fmt: skip


def of_module(text: str, skipped: Sequence[str] = ()) -> Iterator[CodeMutant]:
    """Yield mutants with one number, sign, operator or NumPy function changed.

    Numbers are doubled, 0 becomes 1, and an exponent is raised by one; + and -, * and / are
    interchanged. Annotations, indices, axes and shapes are not changed, nor the arguments of the
    skipped functions.
    """
    tree = ast.parse(text)
    for node in ast.walk(tree):  # docstrings take time to copy
        if isinstance(node, ast.FunctionDef | ast.ClassDef | ast.Module) and ast.get_docstring(
            node
        ):
            node.body[0] = ast.Expr(ast.Constant(""))
    ast.fix_missing_locations(tree)
    for index, statement in enumerate(tree.body):
        for place in _formulas(statement, (*SKIPPED, *skipped)):
            original, constant = ast.unparse(place.node), isinstance(place.node, ast.Constant)
            inside = f" in {ast.unparse(place.parent)}" if constant else ""
            for new in _rewritten(place.node, place.exponent):
                ast.fix_missing_locations(ast.copy_location(new, place.node))
                changed = _put(statement, place.node, new)
                change = f"{original} -> {ast.unparse(new)}{inside}"
                body = [*tree.body[:index], changed, *tree.body[index + 1 :]]
                yield CodeMutant(place.home, change, place.lines, ast.Module(body, []))


class _Position(NamedTuple):
    home: str
    node: Code
    parent: ast.AST
    exponent: bool
    lines: range
    """Lines of the innermost statement; those before its body if it is compound."""


SKIPPED = ("shape", "axis", "dtype", "reshape", "broadcast_to", "arange")


def _formulas(statement: ast.stmt, skipped: Sequence[str]) -> Iterator[_Position]:
    """Yield the arithmetic nodes of a function, a class or a constant of a module."""

    def walk(
        node: ast.AST, home: str, parent: ast.AST, exponent: bool, lines: range
    ) -> Iterator[_Position]:
        if isinstance(node, ast.stmt):
            lines = _own_lines(node)
        if isinstance(node, ast.Subscript | ast.arguments):
            return
        if isinstance(node, ast.AnnAssign):
            if node.value is not None:
                yield from walk(node.value, home, node, False, lines)
            return
        if isinstance(node, ast.ClassDef):
            for method in node.body:
                if isinstance(method, ast.FunctionDef):
                    yield from walk(method, home, node, False, lines)
            return
        if isinstance(node, ast.Call) and ast.unparse(node.func).split(".")[-1] in skipped:
            return
        if isinstance(node, ast.keyword) and node.arg in skipped:
            return
        if isinstance(node, ast.FunctionDef):
            home = node.name
        if isinstance(node, ast.Assign) and not home:
            home = ast.unparse(node.targets[0])
        if isinstance(node, ast.BinOp | ast.UnaryOp | ast.Constant | ast.Call | ast.AugAssign):
            yield _Position(home, node, parent, exponent, lines)
        power = isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow)
        for name, child in ast.iter_fields(node):
            for part in child if isinstance(child, list) else [child]:
                if isinstance(part, ast.AST):
                    yield from walk(part, home, node, power and name == "right", lines)

    yield from walk(statement, "", statement, False, range(0))


def _own_lines(statement: ast.stmt) -> range:
    """Return the lines of a statement; those before its body if it is compound."""
    body = getattr(statement, "body", [])
    end = statement.end_lineno or statement.lineno
    return range(statement.lineno, max(statement.lineno, body[0].lineno - 1 if body else end) + 1)


def _rewritten(node: Code, exponent: bool) -> Iterator[Code]:
    match node:
        case ast.AugAssign(op=op) if type(op) in OPERATORS:
            yield ast.AugAssign(node.target, OPERATORS[type(op)], node.value)
        case ast.BinOp(op=op) if type(op) in OPERATORS:
            yield ast.BinOp(node.left, OPERATORS[type(op)], node.right)
        case ast.UnaryOp(op=ast.USub()):
            yield node.operand
        case ast.Constant(value=bool()):
            return
        case ast.Constant(value=int() | float() as value):
            yield ast.Constant(value + 1 if exponent else 2 * value or 1)
        case ast.Call(func=ast.Attribute(attr=name) as of) if name in CALLS:
            yield ast.Call(ast.Attribute(of.value, CALLS[name], of.ctx), node.args, node.keywords)


def _put(statement: ast.stmt, old: ast.AST, new: ast.AST) -> ast.stmt:
    """Return a copy of a statement with one node replaced; unchanged branches are shared."""

    class Replace(ast.NodeTransformer):
        def visit(self, node: ast.AST) -> ast.AST:
            if node is old:
                return new
            for name, child in ast.iter_fields(node):
                if isinstance(child, list):
                    parts = [self.visit(x) if isinstance(x, ast.AST) else x for x in child]
                    if any(a is not b for a, b in zip(parts, child, strict=True)):
                        node = copy.copy(node)
                        setattr(node, name, parts)
                elif isinstance(child, ast.AST):
                    part = self.visit(child)
                    if part is not child:
                        node = copy.copy(node)
                        setattr(node, name, part)
            return node

    changed = Replace().visit(statement)
    assert isinstance(changed, ast.stmt)
    return changed
