"""Routines that take their name and summary from the Python function that describes them."""

from collections.abc import Callable, Sequence
from functools import wraps
from typing import NamedTuple

import sympy as sp

from derivation.engine.emit.routine import Facts, Routine, Statement, routine


class Claims(NamedTuple):
    """A function to print with its claimed results, the arguments of `routine`."""

    arguments: tuple[sp.Symbol, ...]
    statements: Sequence[Statement]
    results: tuple[sp.Expr, ...]
    claims: tuple[sp.Expr | None, ...]
    meaning: Facts
    reduce: Callable[[sp.Expr], sp.Expr] = lambda e: e


def named(build: Callable[[], Claims]) -> Callable[[], Routine]:
    """Turn a function that returns claims into one that builds the routine of its own name."""

    @wraps(build)
    def make() -> Routine:
        arguments, statements, results, claims, meaning, reduce = build()
        name, summary = build.__name__, build.__doc__ or ""
        return routine(name, arguments, statements, results, claims, summary, meaning, reduce)

    return make
