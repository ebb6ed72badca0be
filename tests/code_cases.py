"""What generated code with one thing wrong is held to: functions at points, and what is true."""

import ast
import math
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from types import CodeType, ModuleType
from typing import Any

import numpy as np
import pytest
from mutants import CodeMutant, of_module

import generated
from derivation.engine.files import ROOT

Point = tuple[float, ...]
TOLERANCE = 1e-12
"""Some thousand units in the last place: what is noticed is no rounding."""
LAME = 0.36e9, 0.43e9


class Case:
    """A function at some points, and what an oracle gives there."""

    def __init__(
        self,
        function: str | Callable[[ModuleType], Callable[..., Any]],
        points: Sequence[Sequence[float]],
        true: Any,
        least: float = 0.0,
        tolerance: float = TOLERANCE,
    ) -> None:
        """Errors are relative to the larger of what is true and `least`."""
        self.function, self.least, self.tolerance = function, least, tolerance
        self.arguments = tuple(np.array(column) for column in zip(*points, strict=True))
        self.true = np.array(true, dtype=float).T

    def holds(self, module: ModuleType) -> bool:
        """All points at once, the first two, and the first as scalars, which are treated apart."""
        named = isinstance(self.function, str)
        function = getattr(module, self.function) if named else self.function(module)
        for count in (None, 2):
            found = np.asarray(function(*(column[:count] for column in self.arguments)))
            if not self._close(found, self.true[..., :count]):
                return False
        first = np.asarray(function(*(float(column[0]) for column in self.arguments)))
        return self._close(first, self.true[..., 0])

    def _close(self, found: np.ndarray, true: np.ndarray) -> bool:
        if found.shape != true.shape:
            return False
        with np.errstate(invalid="ignore"):
            allowed = self.tolerance * np.maximum(np.abs(true), self.least)
            close = np.isfinite(true) & (np.abs(found - true) <= allowed)
        return bool((close | (found == true) | (np.isnan(found) & np.isnan(true))).all())


USERS: Mapping[str, Sequence[str]] = {
    "contact_cells": ("contact_series", "contact_law", "contact_thickness", "sensitivity"),
    "contact_points": ("contact_law",),
    "contact_series": ("contact_law", "contact_thickness", "sensitivity"),
    "contact_thickness": ("sensitivity",),
}
"""Modules by whose functions another one is judged, in the order of their imports."""


def compiled(tree: ast.Module | str, name: str) -> ModuleType:
    """A module of the package from changed text, beside the others as they are.

    It has the functions of its users too, which import it.
    """
    whole = ModuleType(name)
    with pytest.MonkeyPatch.context() as patch:
        for part in (name, *USERS.get(name, ())):
            module = ModuleType(f"generated.{part}")
            module.__package__ = generated.__name__
            exec(code_of(part) if part != name else _code(tree, name), module.__dict__)
            patch.setitem(sys.modules, module.__name__, module)
            vars(whole).update(vars(module))
    return whole


@cache
def code_of(name: str) -> CodeType:
    return _code((ROOT / "generated" / f"{name}.py").read_text(), name)


def _code(tree: ast.Module | str, name: str) -> CodeType:
    return compile(tree, f"<mutant of {name}>", "exec")


def survivors(name: str, cases: Sequence[Case]) -> Iterator[str]:
    text = (ROOT / "generated" / f"{name}.py").read_text()
    assert all(case.holds(compiled(text, name)) for case in cases)
    for mutant in of_module(text):
        if survives(mutant, name, cases):
            yield mutant.name


def survives(mutant: CodeMutant, name: str, cases: Sequence[Case]) -> bool:
    """Whether it passes; one that raises an error does not."""
    with np.errstate(all="ignore"):
        try:
            module = compiled(mutant.tree, name)
            return all(case.holds(module) for case in cases)
        except (ArithmeticError, LookupError, TypeError, ValueError, NameError, AttributeError):
            return False


def by_balls(
    name: str,
    points: Sequence[Point],
    oracle: Callable[..., Any],
    outside: Sequence[Point] = (),
    tolerance: float = TOLERANCE,
) -> Case:
    true = [*(float(oracle(*p, digits=18)) for p in points), *(math.nan for _ in outside)]
    return Case(name, [*points, *outside], true, tolerance=tolerance)


GUARDS = "kept out of sight: what it gives is not used, or another guard says the same"
START = "where the iteration starts, or whether it does from an end that is safe"
ORDER = "how fast the iteration converges, not to what"
SIZE = "how many are worked on at a time"
BEYOND_ALL = "beyond it nothing changes in double precision"
PROMISES = "a promise about the module, not used in it"
SAME = "the same number"
STEPS = ["_STEPS: 60 -> 120 in _STEPS = 60", "_CLOSE: 1e-09 -> 2e-09 in _CLOSE = 1e-09"]


def assert_noticed(
    name: str, cases: Sequence[Case], equivalent: Mapping[str, Sequence[str]]
) -> None:
    """Assert that the survivors among a module's mutants are those that are named with a reason."""
    named = [mutant for those in equivalent.values() for mutant in those]
    assert sorted(survivors(name, cases)) == sorted(named)
