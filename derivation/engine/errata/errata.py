"""All published formulas of a paper, and their comparison with the derived ones."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from derivation.engine.errata.compare import Diagnosis
from derivation.engine.errata.findings import Finding, Printed, finding
from derivation.engine.errata.relations import Formulas, Relations
from derivation.engine.formula.chain import Chain


@dataclass(frozen=True, eq=False)
class Errata:
    """The published formulas, and the way they are compared.

    Parameters
    ----------
    printed
        The published formulas, in the paper's order.
    relations
        The dependent symbols.
    finding
        Function that compares a published formula in a way of its own, if necessary.
    kinds
        Further classes of published formulas.
    """

    printed: Sequence[Printed] = ()
    relations: Relations = field(default_factory=Relations)
    finding: Callable[[Printed, Formulas], Finding] | None = None
    kinds: tuple[type, ...] = ()

    def compared(self, formulas: Formulas) -> tuple[Finding, ...]:
        """Return every published formula compared with the derived one, correct ones included."""

        def one(record: Printed) -> Finding:
            if self.finding is not None:
                return self.finding(record, formulas)
            return finding(record, formulas, self.relations)

        return tuple(one(record) for record in self.printed)

    def found(self, chain: Chain) -> tuple[Finding, ...]:
        """Return the same, cached until the sources change."""
        kinds = (Finding, Diagnosis, Printed, *self.kinds)
        return chain.kept(
            "misprints", lambda: self.compared(chain.formulas()), *kinds, also=("engine/errata",)
        )
