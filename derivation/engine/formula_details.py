"""One formula with its position in the derivation: step, sources, and formulas that use it."""

from collections.abc import Mapping
from dataclasses import dataclass

from derivation.engine.formula.notation import to_plain
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Argument
from derivation.engine.paper import Paper


@dataclass(frozen=True)
class FormulaDetails:
    """A formula with its position in the derivation.

    Parameters
    ----------
    formula
        The formula.
    step
        Name of the derivation step that derives it.
    used_by
        Names of the formulas that are derived from it.
    references
        The literature that the step uses; a text for each source.
    """

    formula: Record
    step: str
    used_by: tuple[str, ...]
    references: tuple[str, ...]

    @property
    def argument(self) -> str:
        """The argument of the proof as plain text."""
        return to_plain(self.formula.proof.argument)

    @property
    def arguments(self) -> tuple[tuple[Argument, str], ...]:
        """The symbols that the formula depends on, each with its meaning as plain text."""
        return tuple((symbol, to_plain(symbol.meaning)) for symbol in self.formula.arguments)

    def to_json(self) -> dict[str, object]:
        """Return the formula as plain data, with its position in the derivation."""
        place = {"step": self.step, "used_by": self.used_by, "references": self.references}
        return self.formula.to_json() | place


def formula_details(paper: Paper, name: str) -> FormulaDetails:
    """Return a formula of a paper with its position in the derivation.

    Raises
    ------
    KeyError
        If the paper has no formula of that name.
    """
    derived = paper.chain.derived_steps()
    steps = {formula.name: step for step, formulas in derived for formula in formulas}
    used_by = [f.name for _, formulas in derived for f in formulas if name in f.sources]
    references = paper.report().prose.references
    sources = [references.entries[key] for key in references.cited(steps[name])]
    return FormulaDetails(
        paper.chain.formulas()[name],
        steps[name],
        tuple(used_by),
        tuple(_source(entry) for entry in sources),
    )


def _source(entry: Mapping[str, str]) -> str:
    """Return a source as text: authors, title and year; missing entries are omitted."""
    authors = entry.get("author", "").strip("{}").replace(" and ", "; ")
    return ", ".join(text for text in (authors, entry["title"], entry.get("year", "")) if text)
