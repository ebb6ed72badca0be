"""A chain of links, each of which derives formulas: what a paper begins with."""

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
"""The links' names, each with its formulas."""


@dataclass(frozen=True)
class Link:
    """One link: its name, and the function that returns its formulas, proved."""

    name: str
    derive: Callable[[], tuple[Record, ...]]


@dataclass(frozen=True, eq=False)
class Chain:
    """The links of a paper.

    Parameters
    ----------
    name
        The paper's name, which its kept results begin with.
    vocabulary
        Its symbols.
    links
        The links, in order.
    sources
        Files and folders that the formulas follow from: parts of this package by name, others by
        their path.
    kinds
        The class of the formulas, and the SymPy functions of the paper's own.
    """

    name: str
    vocabulary: Vocabulary
    links: tuple[Link, ...]
    sources: tuple[str | Path, ...]
    kinds: tuple[type, ...]

    def found(self) -> Found:
        """The links with their formulas, kept until the sources change.

        Raises
        ------
        ProofError
            Naming the step that does not hold.
        """
        return self.kept("chain", lambda: tuple((x.name, x.derive()) for x in self.links))

    def formulas(self) -> dict[str, Record]:
        """Every formula by name."""
        return {formula.name: formula for _, formulas in self.found() for formula in formulas}

    def kept(
        self,
        what: str,
        compute: Callable[[], Value],
        *kinds: type,
        also: tuple[str | Path, ...] = (),
    ) -> Value:
        """Result of `compute`, kept until the sources, or those in `also`, change."""
        every = (*self.kinds, Proof, *kinds)
        return cached(f"{self.name}-{what}", (*self.sources, *also), compute, *every)
