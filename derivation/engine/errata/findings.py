"""Published formulas, and the result of comparing them with the derived ones."""

from dataclasses import dataclass

import sympy as sp

from derivation.engine.errata.compare import DIFFERENT, Diagnosis, diagnose
from derivation.engine.errata.relations import Formulas, Relations
from derivation.engine.formula.notation import to_latex, to_markdown, to_plain
from derivation.engine.formula.record import Record

CORRECT = "correct as published"


@dataclass(frozen=True)
class Printed:
    """One formula as published.

    Parameters
    ----------
    name
        Name of the derived formula that it should equal.
    equation
        Number of the paper's equation.
    symbol
        LaTeX of the left-hand side.
    latex
        LaTeX of the right-hand side; for a sum, of one term.
    expression
        The right-hand side in SymPy.
    says
        Statement of the paper about the formula in words, if that is part of the claim.
    full
        The complete published right-hand side, if `latex` is only a part of it.
    where
        Symbols in the expression that another equation of the paper defines, with their
        expressions.
    solved
        The equation solved for the quantity `name`, if the paper states it for another quantity.
    """

    name: str
    equation: str
    symbol: str
    latex: str
    expression: sp.Expr
    says: str = ""
    full: str = ""
    where: tuple[tuple[sp.Symbol, sp.Expr], ...] = ()
    solved: sp.Expr | None = None

    @property
    def compared(self) -> sp.Expr:
        """The expression to compare: solved, and with definitions inserted."""
        expression = self.expression if self.solved is None else self.solved
        return expression.subs(dict(self.where))

    def _repr_latex_(self) -> str:
        return f"$\\displaystyle {self.symbol} = {self.full or self.latex}$"


@dataclass(frozen=True)
class Finding:
    """A published formula, the derived one, and the result of their comparison."""

    printed: Printed
    formula: Record
    diagnosis: Diagnosis
    remark: str = ""

    @property
    def is_misprint(self) -> bool:
        """Whether the published formula differs from the derived one."""
        return self.diagnosis.verdict == DIFFERENT

    @property
    def kind(self) -> str:
        """The kind of misprint; "correct as published" if there is none."""
        return self.diagnosis.kind if self.is_misprint else CORRECT

    @property
    def repair(self) -> str:
        """The correction, with the remark if there is one."""
        return f"{self.diagnosis.repair}. {self.remark}" if self.remark else self.diagnosis.repair

    def __str__(self) -> str:
        """Return equation, name and correction on one line."""
        repair = f": {to_plain(self.repair)}" if self.is_misprint else ""
        return f"({self.printed.equation}) {self.printed.name}: {self.kind}{repair}"

    def to_json(self) -> dict[str, str | None]:
        """Return the finding as plain data under fixed keys."""
        diagnosis, vocabulary = self.diagnosis, self.formula.vocabulary
        return {
            "equation": self.printed.equation,
            "name": self.printed.name,
            "says": to_plain(self.printed.says),
            "printed": str(self.printed.expression),
            "printed_latex": f"{self.printed.symbol} = {self.printed.full or self.printed.latex}",
            "derived": str(diagnosis.derived),
            "derived_latex": f"{self.formula.latex} = {self.formula.right_hand_side}",
            "verdict": diagnosis.verdict,
            "kind": self.kind,
            "repair": self.repair,
            "repaired": None if diagnosis.repaired is None else str(diagnosis.repaired),
            "ratio": None if diagnosis.ratio is None else str(diagnosis.ratio),
            "ratio_latex": None
            if diagnosis.ratio is None
            else to_latex(diagnosis.ratio, vocabulary),
            "dimension": diagnosis.dimension,
            "method": diagnosis.method,
        }

    def _repr_latex_(self) -> str:
        sign = r"\neq" if self.is_misprint else "="
        printed = self.printed.full or self.printed.latex
        return f"$\\displaystyle {printed} \\;{sign}\\; {self.formula.right_hand_side}$"

    def _repr_markdown_(self) -> str:
        """Return published and derived formula, and the correction, for a notebook."""
        where = f"**({self.printed.equation}) {to_markdown(self.printed.name)}: {self.kind}**"
        repair = f"\n\n{to_markdown(self.repair)}." if self.is_misprint else ""
        return f"{where}\n\n{self._repr_latex_()}{repair}"


def finding(record: Printed, formulas: Formulas, relations: Relations) -> Finding:
    """Compare a published formula with the derived one of its name."""
    diagnosis = diagnose(record.name, record.compared, formulas, relations)
    return Finding(record, formulas[record.name], diagnosis)
