"""Test of the printed code of routines against their claims, in ball arithmetic.

The proof of a routine relies on statements that it does not prove: the meanings of the results of
other functions, equalities on one side of a choice, and limits that are not reached. The code does
not rely on them.
"""

import importlib
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import Any

import flint
import numpy as np
import sympy as sp

from derivation.engine.emit.routine import Choice, Routine, Sums
from derivation.engine.formula.ball import PrecisionError, evaluate, to_ball
from derivation.engine.formula.grid import joint_points
from derivation.engine.formula.proof import ProofError
from derivation.engine.formula.vocabulary import Argument, Vocabulary

DECADES, COUNT = 1, 60
"""Exponent of ten of the largest arguments, and number of points. Code for one side of a choice may
be inaccurate elsewhere, but not yet there."""
TOLERANCE, ROUNDING = 1e-6, 1e-12
"""Largest relative error, and the largest one per condition number."""
TEMPORARY = "generated_for_a_test"


@contextmanager
def imported(files: Mapping[str, str]) -> Iterator[Callable[[str], ModuleType]]:
    """Import a package from the contents of its files; yield a function for its modules."""
    with tempfile.TemporaryDirectory() as folder:
        for name, content in files.items():
            (Path(folder) / name).write_text(content)
        spec = spec_from_file_location(
            TEMPORARY, Path(folder) / "__init__.py", submodule_search_locations=[folder]
        )
        assert spec is not None
        assert spec.loader is not None  # because the file exists
        sys.modules[TEMPORARY] = package = module_from_spec(spec)
        try:
            spec.loader.exec_module(package)
            yield lambda name: importlib.import_module(f"{TEMPORARY}.{name}")
        finally:
            for name in [name for name in sys.modules if name.split(".")[0] == TEMPORARY]:
                del sys.modules[name]


def check_routine(routine: Routine, function: Callable[..., Any], words: Vocabulary) -> None:
    """Compare the code of a routine with its claims at points of the domain.

    Parameters
    ----------
    routine
        The routine. One with a table as argument, or with a side that is not claimed, is not
        tested.
    function
        Its code.
    words
        The symbols of the paper with their domains; other symbols are positive numbers if their
        assumptions say so.

    Raises
    ------
    ProofError
        If they differ; the message states result and point.
    """
    tables = any(isinstance(s, Sums) and s.rows in routine.arguments for s in routine.statements)
    if tables or any(isinstance(s, Choice) and s.unclaimed for s in routine.statements):
        return
    arguments = [sp.sympify(routine.meaning.get(x, x)) for x in routine.arguments]
    used = {x for e in (*arguments, *routine.claims) if e is not None for x in e.free_symbols}
    symbols = sorted(used, key=str)
    domain = Vocabulary(tuple(Argument(x, "1", x.name, "", _conditions(x, words)) for x in symbols))
    names = [x.name for x in symbols]
    for point in joint_points(routine.name, names, domain, DECADES, COUNT):
        _check_at({x: point[x.name] for x in symbols}, routine, arguments, function)


def _conditions(symbol: sp.Symbol, words: Vocabulary) -> tuple[str, ...]:
    if symbol.name in words.by_name:
        return words.by_name[symbol.name].domain
    return (f"{symbol} > 0",) if symbol.is_positive else ()


def _check_at(
    at: Mapping[sp.Symbol, float],
    routine: Routine,
    arguments: list[sp.Expr],
    function: Callable[..., Any],
) -> None:
    try:
        given = [np.float64(_value(x, at)) for x in arguments]
    except (NotImplementedError, PrecisionError):
        return  # outside the domain of an argument
    with np.errstate(all="ignore"):
        try:
            results = np.atleast_1d(np.asarray(function(*given), dtype=float))
        except (ArithmeticError, ValueError):  # functions of `math` raise these
            results = np.full(len(routine.claims), np.nan)
    if len(results) != len(routine.claims):
        raise ProofError(
            f"Routine {routine.name}: expected {len(routine.claims)} results, got {len(results)}; "
            "assign the results of other functions by `Several`"
        )
    for number, (got, claim) in enumerate(zip(results, routine.claims, strict=True)):
        if claim is None:
            continue
        try:
            exact = evaluate(claim, at, 20)
        except (NotImplementedError, PrecisionError):
            continue  # outside the domain of the claim, or zero
        error = abs(to_ball(float(got)) - exact) if np.isfinite(got) else flint.arb.pos_inf()
        if error > TOLERANCE * abs(exact) + ROUNDING * _sensitivity(claim, at):
            where = ", ".join(f"{symbol} = {value:.6g}" for symbol, value in at.items())
            raise ProofError(
                f"Routine {routine.name}: result {number} is {float(got):.6g} at {where}, and its "
                f"claim is {exact.str(6, radius=False)}; correct the meanings, the equalities on "
                "one side of a choice, or the limits on which the proof relies, and give symbols "
                "that depend on others as expressions in `meaning`"
            )


def _value(expression: sp.Expr, at: Mapping[sp.Symbol, float]) -> float:
    return at[expression] if expression in at else float(evaluate(expression, at, 20))


def _sensitivity(claim: sp.Expr, at: Mapping[sp.Symbol, float]) -> flint.arb:
    """Return the change of a value per relative change of the symbols; 0 where it is unknown."""
    total = flint.arb(0)
    for symbol, value in at.items():
        with suppress(NotImplementedError, PrecisionError):
            total += abs(evaluate(sp.diff(claim, symbol), at, 3) * to_ball(value))
    return total
