"""Formulas of positive dimensionless numbers for tests of `diagnose`."""

from collections.abc import Mapping

import sympy as sp

from derivation.engine.formula.proof import prove
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Argument, Vocabulary


def formulas_of(
    derived: Mapping[str, sp.Expr], domains: Mapping[sp.Symbol, tuple[str, ...]]
) -> dict[str, Record]:
    """Return formulas by name; `domains` has the domains of symbols that are not just positive."""
    symbols = sorted(set().union(*(one.free_symbols for one in derived.values())), key=str)
    words = Vocabulary(
        tuple(Argument(s, "1", s.name, "a number", domains.get(s, (f"{s} > 0",))) for s in symbols)
    )
    kind = type("Formula", (Record,), {"vocabulary": words})
    proof = prove("given", "typed", {"identity": sp.Integer(0)})
    return {
        name: kind(name, name[0], name, one, "1", "", (), proof) for name, one in derived.items()
    }
