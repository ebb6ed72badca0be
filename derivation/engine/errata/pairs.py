"""Two misprints in different parts of a product or a sum, found by matching pairs of edits.

Every edit of one part changes the whole by a known ratio (in a sum, by a difference). The search
finds an edit of another part with which the total change is the required one.
"""

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import log2

import flint
import sympy as sp

from derivation.engine.errata.edit import Edit, edit_of, ratio_edit
from derivation.engine.errata.position import FACTOR, TERM, Position, all_positions
from derivation.engine.errata.sample import Values, monomial, rational, real
from derivation.engine.errata.variant import (
    Variant,
    VariantSearch,
    all_variants,
    multipliers,
    superfluous_parentheses,
)

_CLOSE = 1e-12
_MAX_MATCHES = 300
_OVERALL = -1


@dataclass(frozen=True, eq=False)
class Pair:
    """Two edits that together give the correct values, and the resulting expression."""

    first: Edit
    second: Edit
    new: sp.Expr

    @property
    def says(self) -> str:
        """Both changes in a sentence."""
        return f"{self.first.says}; and {self.second.says}"

    def order(self) -> tuple[float, str]:
        """Return the sort key: cost, then text."""
        return round(self.first.cost + self.second.cost, 6), self.says


@dataclass(frozen=True, eq=False)
class _Change:
    """A variant inside one part (or of the whole), and its effect on the whole.

    The effect is a ratio in a product and a difference in a sum.
    """

    part: int
    place: Position
    variant: Variant
    effect: float

    def applied(self, whole: sp.Expr, root: Position) -> sp.Expr:
        """Return `whole`, a rewritten root, with this change as well."""
        if self.part == _OVERALL:
            return self.variant.build() / root.node * whole
        old, new = root.node.args[self.part], self.part_after(root)
        return whole / old * new if isinstance(root.node, sp.Mul) else whole - old + new

    def part_after(self, root: Position) -> sp.Expr:
        """Return the changed part of the root."""
        part = self.place
        while part.parent is not root and part.parent is not None:
            part = part.parent
        return self.place.put(self.variant.build(), part)


def pair_edits(root: Position, reference: Values, search: VariantSearch) -> list[Pair]:
    """Return pairs of edits in different parts of a product or sum, the most likely first."""
    if not isinstance(root.node, sp.Add | sp.Mul):
        return []
    have = search.points.value(root.node, 0)
    product = isinstance(root.node, sp.Mul)
    goal = real(reference[0] / have if product else reference[0] - have)
    if goal is None:
        return []
    changes = sorted(_changes(root, search), key=lambda change: change.effect)
    pairs = list(_matching_changes(root, changes, goal, reference, search))
    if product:
        pairs += _with_overall_ratio(root, changes, reference, search)
    return sorted(pairs, key=Pair.order)


def _changes(root: Position, search: VariantSearch) -> Iterator[_Change]:
    """Yield every variant inside every part of the root, and of the whole, with their effects."""
    product = isinstance(root.node, sp.Mul)
    for index, node in enumerate(root.node.args):
        part = Position(node, FACTOR if product else TERM, root, (index,))
        own = search.points.value(node, 0)
        for position in all_positions(part):
            for variant in all_variants(position, search):
                value = outer_value(position, variant.value, part, search)
                effect = real(value / own if product else value - own)
                if effect is not None:
                    yield _Change(index, position, variant, effect)
    if product:
        have = search.points.value(root.node, 0)
        for variant in _of_the_whole(root.node, search):
            effect = real(variant.value / have)
            if effect is not None:
                yield _Change(_OVERALL, root, variant, effect)


def _of_the_whole(node: sp.Expr, search: VariantSearch) -> Iterator[Variant]:
    """Yield variants of a product that do not belong to a single factor."""
    yield from superfluous_parentheses(node, search)
    have = search.points.value(node, 0)
    for kind, factor, extra in multipliers(search):
        times = have * search.points.value(factor, 0)
        yield Variant(kind, times, lambda f=factor: f * node, extra)  # type: ignore[misc]


def outer_value(
    position: Position, value: flint.acb, top: Position, search: VariantSearch
) -> flint.acb:
    """Return the value of the position `top` if a position inside it has another value."""
    while position is not top and position.parent is not None:
        node = position.parent.node
        whole = search.points.value(node, 0)
        if isinstance(node, sp.Add):
            value = whole - search.points.value(position.node, 0) + value
        elif isinstance(node, sp.Mul):
            value = whole / search.points.value(position.node, 0) * value
        elif isinstance(node, sp.Pow) and position.role == FACTOR:
            value = whole * (value / search.points.value(position.node, 0)) ** int(
                sp.sign(node.exp)
            )
        elif isinstance(node, sp.Pow):
            value = value ** flint.arb(flint.fmpq(int(node.exp.p), int(node.exp.q)))
        else:
            value = search.points.applied(node.func, value)
        position = position.parent
    return value


def _matching_changes(
    root: Position,
    changes: Sequence[_Change],
    goal: float,
    reference: Values,
    search: VariantSearch,
) -> Iterator[Pair]:
    """Yield pairs of changes in different parts whose effects add up to the required one."""
    product = isinstance(root.node, sp.Mul)
    effects = [change.effect for change in changes]
    seen = 0
    for change in changes:
        lack = goal / change.effect if product else goal - change.effect
        margin = _CLOSE * max(abs(lack), 0.0 if product else abs(goal))
        for index in range(bisect_left(effects, lack - margin), len(changes)):
            other = changes[index]
            if other.effect > lack + margin:
                break
            if change.part < other.part and seen < _MAX_MATCHES:
                seen += 1
                new = other.applied(change.applied(root.node, root), root)
                if search.points.same(new, reference):
                    yield Pair(
                        edit_of(change.variant, change.place),
                        edit_of(other.variant, other.place),
                        root.put(new),
                    )


def _with_overall_ratio(
    root: Position, changes: Sequence[_Change], reference: Values, search: VariantSearch
) -> Iterator[Pair]:
    """Yield changes after which only a monomial is missing."""
    points = search.points
    last_effect = None
    for change in changes:
        if change.part == _OVERALL or change.effect == last_effect:
            continue
        last_effect = change.effect
        if not _could_be_monomial(root, change, reference, search):
            continue
        new = change.applied(root.node, root)
        ratio = [w / v for w, v in zip(reference, points.values(new), strict=True)]
        simple = monomial(ratio, points)
        if simple is not None and simple != 1:
            yield Pair(
                edit_of(change.variant, change.place),
                ratio_edit(root, simple),
                root.put(simple * new),
            )


def _could_be_monomial(
    root: Position, change: _Change, reference: Values, search: VariantSearch
) -> bool:
    """Return whether the missing factor after a change is a power of each symbol."""
    points = search.points
    old = root.node.args[change.part]
    new = change.part_after(root)
    first = None
    for point in _distinguishing_points(root, search):
        value = reference[point] / points.value(root.node, point) * points.value(old, point)
        lack = real(value / points.value(new, point))
        if lack is None:
            return False
        if first is None:
            first = lack
        elif lack / first <= 0 or rational(log2(lack / first), 3) is None:
            return False
    return True


def _distinguishing_points(root: Position, search: VariantSearch) -> list[int]:
    """Return the first sample point, and those that double a symbol in a function's argument."""
    inside: set[sp.Symbol] = set().union(*(f.free_symbols for f in root.node.atoms(sp.Function)))
    symbols = enumerate(search.points.symbols, start=1)
    return [0, *(index for index, symbol in symbols if symbol in inside)]
