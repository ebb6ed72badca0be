"""The derivation of a paper: a chain of links, each of which derives formulas."""

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from traceback import extract_tb
from typing import TypeVar

from derivation.engine.cache import cached
from derivation.engine.formula.proof import Proof
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Vocabulary

Value = TypeVar("Value")
Found = tuple[tuple[str, tuple[Record, ...]], ...]
"""Names of the links, each with its formulas."""


_OF_CODE = (
    *(ArithmeticError, AssertionError, AttributeError, IndexError, KeyError, NameError),
    *(NotImplementedError, RecursionError, TypeError, ValueError, ZeroDivisionError),
)
"""Exceptions whose messages do not state where they occurred."""


class LinkError(ValueError):
    """The code of a derivation step fails; the message states the step and the line."""


@dataclass(frozen=True)
class Link:
    """One link of a derivation: its name, and the function that returns its proved formulas."""

    name: str
    derive: Callable[[], tuple[Record, ...]]


@dataclass(frozen=True, eq=False)
class Chain:
    """The links of a paper.

    Parameters
    ----------
    name
        Name of the paper, with which the names of its cached results begin.
    vocabulary
        The symbols of the paper.
    links
        The links, in order.
    sources
        Files and folders on which the formulas depend: parts of this package by name, others by
        path.
    kinds
        The class of the formulas, and SymPy functions that the paper defines.
    """

    name: str
    vocabulary: Vocabulary
    links: tuple[Link, ...]
    sources: tuple[str | Path, ...]
    kinds: tuple[type, ...]

    def found(self) -> Found:
        """Return the links with their formulas, cached until the sources change.

        Raises
        ------
        ProofError
            If a proof fails; the message states the step.
        LinkError
            If the derivation raises another exception; the message states step and line.
        """
        return self.kept("chain", lambda: tuple((x.name, _derived(x)) for x in self.links))

    def formulas(self) -> dict[str, Record]:
        """Return every formula by name."""
        return {formula.name: formula for _, formulas in self.found() for formula in formulas}

    def kept(
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


def _derived(link: Link) -> tuple[Record, ...]:
    """Return the formulas of a link; state the step and the line if its code fails."""
    try:
        return link.derive()
    except Exception as error:  # any exception that the code of a paper raises
        if type(error) not in _OF_CODE:
            raise
        folder = Path(inspect.getfile(inspect.unwrap(link.derive))).parent
        frames = [f for f in extract_tb(error.__traceback__) if Path(f.filename).parent == folder]
        place = f"{Path(frames[-1].filename).name}, line {frames[-1].lineno}: " if frames else ""
        what = f"{place}{type(error).__name__}: {error}"
        raise LinkError(f"derivation step {link.name!r}: {what}; correct it") from error
