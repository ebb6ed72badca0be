"""Every printed formula held against the derived one, in the paper's order."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import sympy as sp

from derivation.formula.notation import to_latex, to_markdown
from derivation.formula.proof import SYMBOLIC
from derivation.formula.record import Formula
from derivation.formula.symbols import k
from derivation.paper.balance import signs_that_balance
from derivation.paper.compare import DIFFERENT, EQUAL, Diagnosis, diagnose, known_formula, resolved
from derivation.paper.dimensions import dimension_note
from derivation.paper.printed import PRINTED, Printed
from derivation.paper.printed_motion import PRINTED_MOTION, PrintedPower, PrintedSeries
from derivation.paper.variant import EXPONENT
from derivation.theory.divergence import DIVERGENT, tail


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

    def _repr_markdown_(self) -> str:
        """Print against derivation, and what mends the print, for a notebook."""
        where = (
            f"**({self.printed.equation}) {to_markdown(self.printed.name)}: {self.diagnosis.kind}**"
        )
        repair = f"\n\n{to_markdown(self.repair)}." if self.is_misprint else ""
        return f"{where}\n\n{self._repr_latex_()}{repair}"


def misprints(formulas: Mapping[str, Formula]) -> tuple[Finding, ...]:
    """Compare every printed formula with the derived one; the right ones are listed as equal.

    Parameters
    ----------
    formulas
        Every formula by name, those of the motion included.
    """
    return tuple(_finding(record, formulas) for record in (*PRINTED, *PRINTED_MOTION))


def _finding(record: Printed, formulas: Mapping[str, Formula]) -> Finding:
    judges = {PrintedSeries: diagnose_series, PrintedPower: diagnose_power}
    diagnosis = judges.get(type(record), diagnose)(record.name, record.compared, formulas)
    field = record.name in ("u", "w") and diagnosis.verdict == DIFFERENT
    return Finding(
        record, formulas[record.name], diagnosis, _balance_remark(record) if field else ""
    )


def diagnose_series(name: str, term: sp.Expr, formulas: Mapping[str, Formula]) -> Diagnosis:
    """As `diagnose`, for a sum over all modes given by its term: it may have no value at all."""
    term = resolved(term, formulas)
    found = tail(term)
    if found.kind != DIVERGENT:
        return diagnose(name, term, formulas)
    formula = known_formula(name, formulas)
    return Diagnosis(
        name=name,
        verdict=DIFFERENT,
        kind=DIVERGENT,
        repair=f"the sum diverges, {found.says}: read {formula.meaning}, {formula.expression}",
        repaired=formula.expression,
        edits=0,
        ratio=None,
        dimension=dimension_note(term, formula.unit),
        given=term,
        derived=formula.expression,
        method=SYMBOLIC,
    )


def diagnose_power(name: str, given: sp.Expr, formulas: Mapping[str, Formula]) -> Diagnosis:
    """As `diagnose`, for the power of the k-th term in a series: told by its first and its step."""
    found = diagnose(name, given, formulas)
    if found.verdict == EQUAL:
        return found
    says = (
        f"read {found.derived}: the first power is {found.derived.subs(k, 2)}, not "
        f"{given.subs(k, 2)}, and each is {_step(found.derived)} above the one before, "
        f"not {_step(given)}"
    )
    return replace(found, kind=EXPONENT, repair=says, repaired=found.derived, edits=1)


def _step(power: sp.Expr) -> sp.Expr:
    return sp.expand(power.subs(k, k + 1) - power)


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
