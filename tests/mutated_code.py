"""Generated modules with one thing wrong, in memory, and what is to notice it."""

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
"""Some thousand units in the last place: what is noticed is no rounding."""

GUARDS = "kept out of sight: what it gives is not used, or another guard says the same"
START = "where an iteration starts, or how fast it converges: no slower than is said"
SIZE = "how many are worked on at a time"
FINE = "how finely something is resolved that is smooth"
BEYOND_ALL = "beyond it nothing changes in double precision"
MARGIN = "how far a bound is above what rounding takes, or a promise not used in the module"

May = Mapping[str, tuple[int, str]]
"""How many mutants of a function or constant may pass at most, and why."""
ANYWHERE: May = {
    **dict.fromkeys(("STEPS", "_STEPS"), (1, "replaced by how many steps are said to be enough")),
    **dict.fromkeys(("CLOSE", "_CLOSE"), (1, START)),
    **dict.fromkeys(("_BLOCK", "_MODE_BLOCK", "_SCENES"), (1, SIZE)),
}


class Expected(Protocol):
    """What a module is to do."""

    def holds(self, module: ModuleType) -> bool: ...


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


@dataclass(frozen=True)
class Judged:
    """How the mutants of a module are judged.

    Parameters
    ----------
    cases
        What notices them.
    may_pass
        What changes no result; every other mutant is noticed.
    steps
        How many of its iterations are said to be enough.
    """

    cases: Callable[[], Sequence[Expected]]
    may_pass: May = field(default_factory=dict)
    steps: int | None = None


def passes(tree: ast.Module | str, name: str, judged: Judged, cases: Sequence[Expected]) -> bool:
    """Whether no case notices a module; one that raises an error is noticed."""
    with np.errstate(all="ignore"):
        try:
            module = compiled(tree, name)
            if judged.steps is not None:
                limit = "_STEPS" if "_STEPS" in vars(module) else "STEPS"
                assert limit in vars(module)
                vars(module)[limit] = judged.steps
            return all(case.holds(module) for case in cases)
        except (ArithmeticError, LookupError, TypeError, ValueError, NameError, AttributeError):
            return False


def unnoticed(name: str, judged: Judged) -> dict[str, list[str]]:
    """By function or constant, the mutants that pass where more of them do than may."""
    text, cases = source(name), judged.cases()
    assert passes(text, name, judged, cases)
    found: dict[str, list[str]] = {}
    homes = set()
    for mutant in of_module(text):
        homes.add(mutant.home)
        if passes(mutant.tree, name, judged, cases):
            found.setdefault(mutant.home, []).append(mutant.change)
    assert judged.may_pass.keys() <= homes, "a name that the module does not have"
    most = {home: count for home, (count, _) in (ANYWHERE | judged.may_pass).items()}
    return {home: those for home, those in found.items() if len(those) > most.get(home, 0)}
