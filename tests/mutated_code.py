"""Generated modules with one error, in memory, and the tests that must detect it."""

import ast
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import cache
from types import CodeType, ModuleType
from typing import Any, Protocol
from unittest.mock import patch

import numpy as np
from mutants import of_module

import generated
from derivation.engine.files import ROOT

TOLERANCE = 1e-12
"""Relative tolerance, some thousand ULP, so that rounding errors are not detected."""

GUARDS = "a limit whose result is not used, or is the same as that of another limit"
START = "start or convergence of an iteration, which does not exceed its stated number of steps"
SIZE = "number of items that are processed at once"
FINE = "resolution of a smooth function"
BEYOND_ALL = "a limit above which the result does not change in double precision"
MARGIN = "margin of a bound above rounding errors, or a statement that the module does not use"

Allowed = Mapping[str, tuple[int, str]]
"""Largest number of mutants of a function or constant that may pass, and the reason."""
ANYWHERE: Allowed = {
    **dict.fromkeys(
        ("STEPS", "_STEPS"), (1, "replaced by the number of steps that is stated to be sufficient")
    ),
    **dict.fromkeys(("CLOSE", "_CLOSE"), (1, START)),
    **dict.fromkeys(("_BLOCK", "_MODE_BLOCK", "_SCENES"), (1, SIZE)),
}


class Expected(Protocol):
    """A test of a module."""

    def accepts(self, module: ModuleType) -> bool: ...


@dataclass(frozen=True)
class ExpectedResult:
    """A call of a module, and the expected result."""

    call: Callable[[ModuleType], Any]
    expected: Any
    tolerance: float = TOLERANCE
    least: float = 0.0

    def accepts(self, module: ModuleType) -> bool:
        actual = np.asarray(self.call(module), dtype=float)
        return close(actual, np.asarray(self.expected, dtype=float), self.tolerance, self.least)


def close(
    values: np.ndarray, expected: np.ndarray, tolerance: float = TOLERANCE, least: float = 0.0
) -> bool:
    """Return whether errors are within the tolerance times the expected value, or times `least`."""
    if values.shape != expected.shape:
        return False
    with np.errstate(invalid="ignore"):
        allowed = tolerance * np.maximum(np.abs(expected), least)
        near = np.isfinite(expected) & (np.abs(values - expected) <= allowed)
    return bool((near | (values == expected) | (np.isnan(values) & np.isnan(expected))).all())


def compiled(tree: ast.Module | str, name: str, users: Sequence[str] = ()) -> ModuleType:
    """Return a module of the package from changed text; other modules are not changed.

    With `users`, modules that use it are loaded again, each with the ones before. The last one is
    returned, with the functions of all others.
    """
    module = ModuleType(f"generated.{name}")
    module.__package__ = generated.__name__
    exec(compile(tree, f"<mutant of {name}>", "exec"), module.__dict__)
    with ExitStack() as stack:
        for user in users:
            stack.enter_context(patch.dict(sys.modules, {module.__name__: module}))
            short = module.__name__.removeprefix("generated.")
            stack.enter_context(patch.object(generated, short, module, create=True))
            before, module = module, ModuleType(f"generated.{user}")
            module.__package__ = generated.__name__
            exec(code(user), module.__dict__)
            for key, value in vars(before).items():
                vars(module).setdefault(key, value)
    return module


@cache
def code(name: str) -> CodeType:
    return compile(source(name), name, "exec")


def source(name: str) -> str:
    return (ROOT / "generated" / f"{name}.py").read_text()


@dataclass(frozen=True)
class ModuleTests:
    """The tests of a module's mutants.

    Parameters
    ----------
    cases
        Function that returns the tests.
    may_pass
        Numbers of mutants that change no result; all others must be detected.
    steps
        Number of iterations that is stated to be sufficient.
    """

    cases: Callable[[], Sequence[Expected]]
    may_pass: Allowed = field(default_factory=dict)
    steps: int | None = None


def passes(
    tree: ast.Module | str, name: str, tests: ModuleTests, cases: Sequence[Expected]
) -> bool:
    """Return whether a module passes all tests, without raising an error."""
    with np.errstate(all="ignore"):
        try:
            module = compiled(tree, name)
            if tests.steps is not None:
                limit = "_STEPS" if "_STEPS" in vars(module) else "STEPS"
                assert limit in vars(module)
                vars(module)[limit] = tests.steps
            return all(case.accepts(module) for case in cases)
        except (ArithmeticError, LookupError, TypeError, ValueError, NameError, AttributeError):
            return False


def undetected(name: str, tests: ModuleTests) -> dict[str, list[str]]:
    """Return the mutants of each function or constant of which more pass than allowed."""
    text, cases = source(name), tests.cases()
    assert passes(text, name, tests, cases)
    actual: dict[str, list[str]] = {}
    homes = set()
    for mutant in of_module(text):
        homes.add(mutant.home)
        if passes(mutant.tree, name, tests, cases):
            actual.setdefault(mutant.home, []).append(mutant.change)
    assert tests.may_pass.keys() <= homes, "the module does not contain these names"
    most = {home: count for home, (count, _) in (ANYWHERE | tests.may_pass).items()}
    return {home: changes for home, changes in actual.items() if len(changes) > most.get(home, 0)}
