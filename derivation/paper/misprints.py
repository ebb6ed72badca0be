"""Every printed formula held against the derived one, in the paper's order."""

from collections.abc import Mapping
from dataclasses import dataclass

from derivation.formula.notation import to_latex
from derivation.formula.record import Formula
from derivation.paper.balance import signs_that_balance
from derivation.paper.compare import DIFFERENT, Diagnosis, diagnose
from derivation.paper.printed import PRINTED, Printed


@dataclass(frozen=True)
class Finding:
    """A printed formula, the derived one, and what comparison found."""

    printed: Printed
    formula: Formula
    diagnosis: Diagnosis
    remark: str = ""

    @property
    def is_misprint(self) -> bool:
        """Whether print and derivation differ."""
        return self.diagnosis.verdict == DIFFERENT

    @property
    def repair(self) -> str:
        """What mends the print, with the remark if there is one."""
        return f"{self.diagnosis.repair}. {self.remark}" if self.remark else self.diagnosis.repair

    def to_json(self) -> dict[str, str | None]:
        """Plain text under fixed keys."""
        diagnosis = self.diagnosis
        return {
            "equation": self.printed.equation,
            "name": self.printed.name,
            "says": self.printed.says,
            "printed": str(self.printed.expression),
            "printed_latex": f"{self.printed.symbol} = {self.printed.full or self.printed.latex}",
            "derived": str(diagnosis.derived),
            "derived_latex": f"{self.formula.latex} = {self.formula.right_hand_side}",
            "verdict": diagnosis.verdict,
            "kind": diagnosis.kind,
            "repair": self.repair,
            "repaired": None if diagnosis.repaired is None else str(diagnosis.repaired),
            "ratio": None if diagnosis.ratio is None else str(diagnosis.ratio),
            "ratio_latex": None if diagnosis.ratio is None else to_latex(diagnosis.ratio),
            "dimension": diagnosis.dimension,
            "method": diagnosis.method,
        }

    def _repr_latex_(self) -> str:
        sign = r"\neq" if self.is_misprint else "="
        printed = self.printed.full or self.printed.latex
        return f"$\\displaystyle {printed} \\;{sign}\\; {self.formula.right_hand_side}$"


def misprints(formulas: Mapping[str, Formula]) -> tuple[Finding, ...]:
    """Compare every printed formula with the derived one; the right ones are listed as equal.

    Parameters
    ----------
    formulas
        The chain's formulas by name, as `derivation.theory.chain.derive` gives them.
    """
    return tuple(_finding(record, formulas) for record in PRINTED)


def _finding(record: Printed, formulas: Mapping[str, Formula]) -> Finding:
    diagnosis = diagnose(record.name, record.compared, formulas)
    field = record.name in ("u", "w") and diagnosis.verdict == DIFFERENT
    return Finding(
        record, formulas[record.name], diagnosis, _balance_remark(record) if field else ""
    )


def _balance_remark(record: Printed) -> str:
    """What the equilibrium equations say about the signs of (1) and (2) taken together."""
    signs = signs_that_balance([record.name, *(symbol.name for symbol, _ in record.where)])
    if not signs:
        return ""
    equation = {record.name: record.equation for record in PRINTED}
    either = " or ".join(f"that of {name} in ({equation[name]})" for name in signs)
    return (
        "The printed displacements leave the equilibrium equations unbalanced; they balance "
        f"with one sign reversed, {either}"
    )
