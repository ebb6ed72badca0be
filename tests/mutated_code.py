"""Generated modules with one thing wrong, in memory, and what is to notice it."""

import ast
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cache
from types import CodeType, ModuleType
from typing import Any, Protocol
from unittest.mock import patch

import numpy as np
from mutants import CodeMutant, of_module

import generated
from derivation.engine.files import ROOT

TOLERANCE = 1e-12
"""Some thousand units in the last place: what is noticed is no rounding."""

GUARDS = "kept out of sight: what it gives is not used, or another guard says the same"
START = "where the iteration starts, or whether it does from an end that is safe"
ORDER = "how fast the iteration converges, not to what"
SIZE = "how many are worked on at a time"
FINE = "how finely something is resolved that is smooth"
BEYOND_ALL = "beyond it nothing changes in double precision"
PROMISES = "a promise about the module, not used in it"
MARGIN = "how far a bound is above what rounding takes"
SAME = "the same number"


class Expected(Protocol):
    """What a module is to do."""

    def holds(self, module: ModuleType) -> bool: ...


class Case:
    """A function at some points, and what an oracle gives there."""

    def __init__(self, function: str, points: Sequence[tuple[float, ...]], true: Any) -> None:
        self.function = function
        self.arguments = tuple(np.array(column) for column in zip(*points, strict=True))
        self.true = np.array(true, dtype=float).T

    def holds(self, module: ModuleType) -> bool:
        """All points at once, the first two, and the first as scalars, which are treated apart."""
        function = getattr(module, self.function)
        for count in (None, 2):
            found = np.asarray(function(*(column[:count] for column in self.arguments)))
            if not close(found, self.true[..., :count]):
                return False
        first = np.asarray(function(*(float(column[0]) for column in self.arguments)))
        return close(first, self.true[..., 0])


@dataclass(frozen=True)
class Answer:
    """What a module says when asked, and what is true."""

    ask: Callable[[ModuleType], Any]
    true: Any
    tolerance: float = TOLERANCE
    least: float = 0.0

    def holds(self, module: ModuleType) -> bool:
        found = np.asarray(self.ask(module), dtype=float)
        return close(found, np.asarray(self.true, dtype=float), self.tolerance, self.least)


def close(
    found: np.ndarray, true: np.ndarray, tolerance: float = TOLERANCE, least: float = 0.0
) -> bool:
    """Whether errors are within the tolerance of what is true, or of `least` if that is larger."""
    if found.shape != true.shape:
        return False
    with np.errstate(invalid="ignore"):
        allowed = tolerance * np.maximum(np.abs(true), least)
        near = np.isfinite(true) & (np.abs(found - true) <= allowed)
    return bool((near | (found == true) | (np.isnan(found) & np.isnan(true))).all())


def compiled(tree: ast.Module | str, name: str, users: Sequence[str] = ()) -> ModuleType:
    """A module of the package from changed text, beside the others as they are.

    With users of it, the last of these, each made anew upon those before, whose functions it has
    too.
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


def survivors(
    name: str, cases: Sequence[Expected], users: Sequence[str] = ()
) -> Iterator[CodeMutant]:
    """The mutants of a module that no case notices."""
    text = source(name)
    assert all(case.holds(compiled(text, name, users)) for case in cases)
    for mutant in of_module(text):
        if survives(mutant, name, cases, users):
            yield mutant


def survives(
    mutant: CodeMutant, name: str, cases: Sequence[Expected], users: Sequence[str] = ()
) -> bool:
    """Whether it passes; one that raises an error does not."""
    with np.errstate(all="ignore"):
        try:
            module = compiled(mutant.tree, name, users)
            return all(case.holds(module) for case in cases)
        except (ArithmeticError, LookupError, TypeError, ValueError, NameError, AttributeError):
            return False


def named(equivalent: Mapping[str, Sequence[str]]) -> list[str]:
    """The names of mutants that change nothing, whatever the reason."""
    return sorted(mutant for those in equivalent.values() for mutant in those)
