"""The published formulas of a paper, and their comparison with the derived ones."""

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
        Function that compares a published formula instead of `findings.finding`, if necessary.
    kinds
        Further dataclasses that the findings contain, such as subclasses of `Printed`.
    """

    printed: Sequence[Printed] = ()
    relations: Relations = field(default_factory=Relations)
    finding: Callable[[Printed, Formulas], Finding] | None = None
    kinds: tuple[type, ...] = ()

    def compared(self, formulas: Formulas) -> tuple[Finding, ...]:
        """Compare each published formula with the derived one; return all results."""

        def one(record: Printed) -> Finding:
            if self.finding is not None:
                return self.finding(record, formulas)
            return finding(record, formulas, self.relations)

        return tuple(one(record) for record in self.printed)

    def findings(self, chain: Chain) -> tuple[Finding, ...]:
        """Return the results of `compared`, cached until the sources change."""
        kinds = (Finding, Diagnosis, Printed, *self.kinds)
        return chain.cached_result(
            "misprints", lambda: self.compared(chain.formulas()), *kinds, also=("engine/errata",)
        )
