"""The derivation of a paper: a chain of links, each of which derives formulas."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from derivation.engine.cache import cached
from derivation.engine.formula.proof import Proof
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Vocabulary

Value = TypeVar("Value")
Found = tuple[tuple[str, tuple[Record, ...]], ...]
"""Names of the links, each with its formulas."""


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
        """
        return self.kept("chain", lambda: tuple((x.name, x.derive()) for x in self.links))

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
