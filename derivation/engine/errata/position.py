"""A position in an expression: its subexpression, and the value that would be correct there.

With the required value of a position, the whole expression is correct. It is computed from the root
downwards by inverting sums, products, powers and functions.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import combinations

import flint
import sympy as sp

from derivation.engine.errata.sample import Sample, Values

MAX_TERMS = 7
WHOLE, TERM, TERMS, FACTOR, BASE, ARGUMENT = "whole", "term", "terms", "factor", "base", "argument"

_INVERSE: dict[type[sp.Basic], Callable[[flint.acb], flint.acb]] = {
    sp.exp: lambda w: w.log(),
    sp.log: lambda w: w.exp(),
    sp.sinh: lambda w: w.asinh(),
    sp.cosh: lambda w: w.acosh(),
    sp.tanh: lambda w: w.atanh(),
    sp.coth: lambda w: (1 / w).atanh(),
    sp.asin: lambda w: w.sin(),
    sp.acos: lambda w: w.cos(),
    sp.atan: lambda w: w.tan(),
    sp.asinh: lambda w: w.sinh(),
    sp.acosh: lambda w: w.cosh(),
    sp.atanh: lambda w: w.tanh(),
}


@dataclass(frozen=True, eq=False)
class Position:
    """A node of an expression, or some terms of a sum, with the path to the root.

    Parameters
    ----------
    node
        The subexpression.
    role
        Role in its parent: a term, a factor, ...
    parent
        The position around it; None at the root.
    taken
        Indices of the parent's arguments that the position covers.
    """

    node: sp.Expr
    role: str = WHOLE
    parent: "Position | None" = None
    taken: tuple[int, ...] = ()

    @property
    def depth(self) -> int:
        """Number of parents up to the root."""
        return 0 if self.parent is None else self.parent.depth + 1

    def put(self, new: sp.Expr, top: "Position | None" = None) -> sp.Expr:
        """Return the whole expression, or that of the position `top`, with `new` inserted here."""
        if self.parent is None or self is top:
            return new
        node = self.parent.node
        if isinstance(node, sp.Pow) and self.role == FACTOR:
            sign = sp.sign(node.exp)
            return self.parent.put(node / self.node**sign * new**sign, top)
        rest = list(node.args)
        for index in reversed(self.taken):
            del rest[index]
        rest.insert(self.taken[0], new)
        return self.parent.put(node.func(*rest), top)


def inner_positions(position: Position) -> Iterator[Position]:
    """Yield the positions directly inside a position, groups of terms included."""
    node, args = position.node, position.node.args
    if isinstance(node, sp.Add):
        for index, term in enumerate(args):
            yield Position(term, TERM, position, (index,))
        if len(args) <= MAX_TERMS:
            for size in range(2, len(args)):
                for group in combinations(range(len(args)), size):
                    yield Position(sp.Add(*(args[i] for i in group)), TERMS, position, group)
    elif isinstance(node, sp.Mul):
        for index, factor in enumerate(args):
            yield Position(factor, FACTOR, position, (index,))
    elif isinstance(node, sp.Pow) and isinstance(node.exp, sp.Rational) and not node.base.is_Atom:
        yield Position(node.base, BASE, position, (0,))
        if isinstance(node.exp, sp.Integer) and abs(node.exp) > 1:
            # SymPy writes equal factors as a power; the misprint may be in one of them
            yield Position(node.base, FACTOR, position, (0,))
    elif isinstance(node, sp.Function) and len(args) == 1:
        yield Position(args[0], ARGUMENT, position, (0,))


def all_positions(position: Position) -> Iterator[Position]:
    """Yield the position and all positions inside it; groups of terms are not divided further."""
    yield position
    if position.role != TERMS:
        for part in inner_positions(position):
            yield from all_positions(part)


def required_values(part: Position, need: Values, points: Sample) -> list[flint.acb] | None:
    """Return the required values of a part from those of its parent; None if not determined."""
    assert part.parent is not None  # the root requires the reference values themselves
    node = part.parent.node
    have = points.values(part.node)
    whole = points.values(node)
    if isinstance(node, sp.Add):
        others = sp.Add(*(t for i, t in enumerate(node.args) if i not in part.taken))
        return [w - rest for w, rest in zip(need, points.values(others), strict=True)]
    if isinstance(node, sp.Mul):
        if not all(v.is_finite() for v in whole):  # an integral that has no value
            rest = points.values(sp.Mul(*(f for f in node.args if f is not part.node)))
            return [w / r for w, r in zip(need, rest, strict=True)]
        return [w / (v / x) for w, v, x in zip(need, whole, have, strict=True)]
    if isinstance(node, sp.Pow) and part.role == FACTOR:
        sign = int(sp.sign(node.exp))
        return [x * (w / v) ** sign for w, v, x in zip(need, whole, have, strict=True)]
    if isinstance(node, sp.Pow):
        return [_root(w, node.exp, x) for w, x in zip(need, have, strict=True)]
    if node.func in _INVERSE:
        return [_INVERSE[node.func](w) for w in need]
    return None


def _root(value: flint.acb, exponent: sp.Rational, near: flint.acb) -> flint.acb:
    """Return the base of a power with this value, with the sign of the given base."""
    root = value ** flint.arb(flint.fmpq(int(exponent.q), int(exponent.p)))
    if exponent.p % 2:
        if value.real < 0 and exponent.q == 1:
            root = -((-value) ** flint.arb(flint.fmpq(1, int(exponent.p))))
        return root
    return -root if near.real < 0 else root


def with_required_values(
    root: Position, reference: Values, points: Sample
) -> Iterator[tuple[Position, list[flint.acb]]]:
    """Yield every position with its required values, where these are determined and finite."""
    yield root, list(reference)
    if root.role == TERMS:
        return
    for part in inner_positions(root):
        need = required_values(part, reference, points)
        if need is not None and all(w.is_finite() for w in need):
            yield from with_required_values(part, need, points)
