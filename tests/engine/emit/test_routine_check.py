"""Routines whose proof relies on a false statement are rejected, because their code is wrong."""

from typing import Any

import pytest
import sympy as sp

from derivation.engine.emit.modules import Routines, module_files
from derivation.engine.emit.package import common_modules
from derivation.engine.emit.routine import (
    GUARDED,
    SCALARS,
    Choice,
    Let,
    Routine,
    Several,
    Statement,
    routine,
)
from derivation.engine.emit.routine_check import check_routine, imported
from derivation.engine.formula.proof import ProofError
from derivation.engine.formula.vocabulary import Argument, Vocabulary

T, s, c, u, v, w = sp.symbols("T s c u v w", positive=True)
WORDS = Vocabulary((Argument(T, "1", "T", "", ("T > 0",)), Argument(s, "1", "s", "", ("s < 1",))))
POWERS = routine("powers", (T,), (), (T, T**2), (T, T**2), "T and T^2.", {})


def check(
    results: tuple[sp.Expr, ...],
    claims: tuple[sp.Expr | None, ...],
    *statements: Statement,
    scalars: bool = False,
    **given: Any,
) -> None:
    """Build a routine of T, print it, and test it."""
    built: Routine = routine(
        "one", given.pop("arguments", (T,)), statements, results, claims, "One.",
        given.pop("meaning", {}), **given,
    )  # fmt: skip
    dialect = (SCALARS,) if scalars else ()
    files = module_files(
        (*common_modules({}), Routines("both", "B.", (POWERS, built), {}, *dialect))
    )
    with imported(files | {"__init__.py": ""}) as module:
        check_routine(built, module("both").one, WORDS)


def test_true_statements_are_accepted() -> None:
    check((u + 2 * v,), (T + 2 * T**2,), Several((u, v), "powers", (T,), (T, T**2)))
    limited = Let(u, GUARDED(T, 3))
    check((v,), (T,), limited, Choice(v, T < 3, u, T, if_yes={}, if_no={}))
    check((sp.exp(T) * w, T), (sp.exp(T) * w, None), arguments=(T, w))
    check((sp.log(T),), (sp.log(T),), scalars=True)


@pytest.mark.parametrize(
    ("results", "claims", "statements", "more"),
    [
        ((u + 2 * v,), (T**2 + 2 * T,), (Several((u, v), "powers", (T,), (T**2, T)),), {}),
        ((u,), (3 * T,), (Choice(u, T > 3, T, 3 * T, if_yes={T: 0}),), {}),
        ((GUARDED(T, 3),), (T,), (), {}),
        ((T,), (T + T**2,), (), {"reduce": lambda _: sp.Integer(0)}),
        ((u**2,), (T - 3,), (Let(u, sp.sqrt(T - 3)),), {"scalars": True}),
        ((sp.Function("powers")(T),), (T,), (), {"meaning": {sp.Function("powers")(T): T}}),
    ],
    ids=["meanings", "equality on a side", "limit", "reduce", "no value", "number of results"],
)
def test_false_statements_are_rejected(
    results: tuple[sp.Expr, ...], claims: tuple[sp.Expr, ...], statements: tuple[Statement, ...],
    more: dict[str, Any],
) -> None:  # fmt: skip
    with pytest.raises(ProofError, match=r"Routine one: (result 0 is|expected 1 results, got 2)"):
        check(results, claims, *statements, **more)


def test_symbols_that_depend_on_others_are_given_in_their_meaning() -> None:
    whole = (c**2 + s**2,)
    dependent: dict[str, Any] = {"arguments": (s, c), "reduce": lambda _: sp.Integer(0)}
    with pytest.raises(ProofError, match=r"give symbols that depend on others .* `meaning`"):
        check(whole, (sp.Integer(1),), **dependent)
    check(whole, (sp.Integer(1),), arguments=(s, c), meaning={c: sp.sqrt(1 - s**2)})
