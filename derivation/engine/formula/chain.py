"""The derivation of a paper: a chain of steps, each of which derives formulas."""

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TypeVar

from derivation.engine.cache import cached
from derivation.engine.failed import location
from derivation.engine.formula.operations import DecimalError
from derivation.engine.formula.proof import Proof
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.formula.vocabulary_check import check_vocabulary
from derivation.engine.interruption import interruptions

Value = TypeVar("Value")
Found = tuple[tuple[str, tuple[Record, ...]], ...]
"""Names of the steps, each with its formulas."""


_OF_CODE = (
    *(ArithmeticError, AssertionError, AttributeError, IndexError, KeyError, NameError),
    *(DecimalError, NotImplementedError, RecursionError, TypeError, ValueError, ZeroDivisionError),
)
"""Exceptions whose messages do not state where they occurred."""


class DerivationStepError(ValueError):
    """The code of a derivation step fails; the message states the step and the line."""


@dataclass(frozen=True)
class DerivationStep:
    """One step of a derivation: its name, and the function that returns its proved formulas."""

    name: str
    derive: Callable[[], tuple[Record, ...]]


@dataclass(frozen=True, eq=False)
class Chain:
    """The steps of a paper.

    Parameters
    ----------
    name
        Name of the paper, with which the names of its cached results begin.
    vocabulary
        The symbols of the paper.
    steps
        The steps, in order.
    sources
        Files and folders on which the formulas depend: parts of this package by name, others by
        path.
    kinds
        The class of the formulas, and SymPy functions that the paper defines.
    """

    name: str
    vocabulary: Vocabulary
    steps: tuple[DerivationStep, ...]
    sources: tuple[str | Path, ...]
    kinds: tuple[type, ...]

    def __post_init__(self) -> None:
        check_vocabulary(self.vocabulary)
        for step in self.steps:
            if not callable(step.derive):
                raise ValueError(
                    f"derivation step {step.name!r}: expected a function that returns formulas, "
                    f"got a {type(step.derive).__name__}; name the function without brackets"
                )

    def derived_steps(self) -> Found:
        """Return the steps with their formulas, cached until the sources change.

        A process reads the cache once, because reading it takes half a second.

        Raises
        ------
        ProofError
            If a proof fails; the message states the step.
        DerivationStepError
            If the derivation raises another exception; the message states step and line.
        """
        return self._found

    @cached_property
    def _found(self) -> Found:
        return self.cached_result("chain", lambda: _checked(self.steps))

    def formulas(self) -> dict[str, Record]:
        """Return every formula by name."""
        return {
            formula.name: formula for _, formulas in self.derived_steps() for formula in formulas
        }

    def cached_result(
        self,
        what: str,
        compute: Callable[[], Value],
        *kinds: type,
        also: tuple[str | Path, ...] = (),
    ) -> Value:
        """Return the result of a function, cached until the sources, or those in `also`, change.

        Parameters
        ----------
        what
            Name of the result.
        compute
            Function that computes it; see `derivation.engine.cache.cached`.
        kinds
            Further dataclasses that the result contains.
        also
            Further sources on which it depends.
        """
        every = (*self.kinds, Proof, *kinds)
        return cached(f"{self.name}-{what}", (*self.sources, *also), compute, *every)


def _checked(steps: tuple[DerivationStep, ...]) -> Found:
    """Return the steps with their formulas, each of which has a name of its own.

    Raises
    ------
    DerivationStepError
        If two formulas have the same name, so that one would replace the other.
    """
    found = tuple((step.name, _derive_step(step)) for step in steps)
    first: dict[str, str] = {}
    for step, formula in ((name, formula) for name, formulas in found for formula in formulas):
        if formula.name in first:
            raise DerivationStepError(
                f"derivation step {step!r}: expected another name than {formula.name}, which a "
                f"formula of step {first[formula.name]!r} has; rename one of them"
            )
        first[formula.name] = step
    return found


def _derive_step(step: DerivationStep) -> tuple[Record, ...]:
    """Return the formulas of a step; state the step and the line if its code fails."""
    formulas = _run_step(step)
    if not isinstance(formulas, tuple) or not all(isinstance(f, Record) for f in formulas):
        raise DerivationStepError(
            f"derivation step {step.name!r}: expected a tuple of formulas, got a "
            f"{type(formulas).__name__}; end the function with `return (one, another)`, or with "
            "`return (one,)` for one formula"
        )
    return formulas


def _run_step(step: DerivationStep) -> object:
    """Return what the function of a step returns; state the step and the line if it fails."""
    try:
        with interruptions():
            return step.derive()
    except Exception as error:  # any exception that the code of a paper raises
        if type(error) not in _OF_CODE:
            raise
        folder = Path(inspect.getfile(inspect.unwrap(step.derive))).parent
        what = f"{location(error, folder)}{type(error).__name__}: {error}"
        raise DerivationStepError(f"derivation step {step.name!r}: {what}; correct it") from error
