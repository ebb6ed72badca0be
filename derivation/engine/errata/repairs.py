"""Search for a correction of a formula: one edit, or two, the most likely first."""

from collections.abc import Iterator
from dataclasses import dataclass

import sympy as sp

from derivation.engine.errata.edit import single_edits
from derivation.engine.errata.inside_integral import integral_edits
from derivation.engine.errata.pairs import pair_edits
from derivation.engine.errata.position import TERMS, Position, inner_positions, required_values
from derivation.engine.errata.sample import Values
from derivation.engine.errata.variant import VariantSearch

TWO = "two misprints"
MAX_OPERATIONS = 400
MAX_OPERATIONS_FOR_PAIRS = 150


@dataclass(frozen=True)
class Repair:
    """A correction: kind of error, description, corrected expression, number of edits."""

    kind: str
    says: str
    expression: sp.Expr
    edits: int


def repairs(given: sp.Expr, reference: Values, search: VariantSearch) -> Iterator[Repair]:
    """Yield corrections with the correct values at every sample point: single edits, then pairs.

    Pairs are searched in different parts of the whole expression, then in those of each part.
    """
    size = given.count_ops()
    if size > MAX_OPERATIONS:
        return
    root = Position(given)
    edits = single_edits(root, reference, search) or integral_edits(root, reference, search)
    for edit in edits:
        yield Repair(edit.kind, edit.says, edit.place.put(edit.new), 1)
    if size > MAX_OPERATIONS_FOR_PAIRS:
        return
    yield from _pairs(root, reference, search)
    for part in inner_positions(root):
        need = required_values(part, reference, search.points)
        if part.role != TERMS and need is not None and all(w.is_finite() for w in need):
            yield from _pairs(part, need, search)
            if isinstance(part.node, sp.Pow):
                for base in inner_positions(part):
                    inside = required_values(base, need, search.points)
                    yield from _pairs(base, inside, search) if inside else ()


def _pairs(position: Position, need: Values, search: VariantSearch) -> Iterator[Repair]:
    for pair in pair_edits(position, need, search):
        yield Repair(TWO, pair.says, pair.new, 2)
