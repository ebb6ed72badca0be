"""All printed formulas of a paper, and what comparison with the derived ones finds."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from derivation.engine.errata.compare import Diagnosis
from derivation.engine.errata.findings import Finding, Printed, finding
from derivation.engine.errata.relations import Formulas, Relations
from derivation.engine.formula.chain import Chain


@dataclass(frozen=True, eq=False)
class Errata:
    """The formulas as printed, and how they are compared.

    Parameters
    ----------
    printed
        The printed formulas, in the paper's order.
    relations
        Which symbols follow from others.
    finding
        What comparison finds of a printed formula, if that is not one value against another.
    kinds
        Further classes of printed formulas.
    """

    printed: Sequence[Printed] = ()
    relations: Relations = field(default_factory=Relations)
    finding: Callable[[Printed, Formulas], Finding] | None = None
    kinds: tuple[type, ...] = ()

    def compared(self, formulas: Formulas) -> tuple[Finding, ...]:
        """Every printed formula compared with the derived one; right ones are listed as equal."""

        def one(record: Printed) -> Finding:
            if self.finding is not None:
                return self.finding(record, formulas)
            return finding(record, formulas, self.relations)

        return tuple(one(record) for record in self.printed)

    def found(self, chain: Chain) -> tuple[Finding, ...]:
        """The same, kept until the sources change."""
        kinds = (Finding, Diagnosis, Printed, *self.kinds)
        return chain.kept(
            "misprints", lambda: self.compared(chain.formulas()), *kinds, also=("engine/errata",)
        )
