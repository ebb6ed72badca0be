"""Routines with the name and the docstring of the Python function that defines them."""

from collections.abc import Callable, Sequence
from functools import wraps
from typing import NamedTuple

import sympy as sp

from derivation.engine.emit.routine import Facts, Routine, Statement, routine


class Claims(NamedTuple):
    """The definition of a routine: the arguments of `routine` except for name and summary."""

    arguments: tuple[sp.Symbol, ...]
    statements: Sequence[Statement]
    results: tuple[sp.Expr, ...]
    claims: tuple[sp.Expr | None, ...]
    meaning: Facts
    reduce: Callable[[sp.Expr], sp.Expr] = lambda e: e


def named_routine(build: Callable[[], Claims]) -> Callable[[], Routine]:
    """Return a function that builds the routine with the name and docstring of a definition.

    Parameters
    ----------
    build
        Function without arguments that returns the definition.
    """

    @wraps(build)
    def make() -> Routine:
        arguments, statements, results, claims, meaning, reduce = build()
        name, summary = build.__name__, build.__doc__ or ""
        return routine(name, arguments, statements, results, claims, summary, meaning, reduce)

    return make
