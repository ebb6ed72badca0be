"""Comparison of every published formula with the derived one, in the paper's order."""

from collections.abc import Mapping
from dataclasses import replace

import sympy as sp

from derivation.engine.errata.compare import (
    DIFFERENT,
    EQUAL,
    Diagnosis,
)
from derivation.engine.errata.dimensions import dimension_note
from derivation.engine.errata.errata import Errata
from derivation.engine.errata.findings import Finding, Printed
from derivation.engine.errata.lookup import known_formula, resolve
from derivation.engine.errata.variant import EXPONENT
from derivation.engine.formula.notation import to_plain
from derivation.engine.formula.proof import SYMBOLIC
from derivation.engine.formula.record import Record
from derivation.plate.contact.theory.divergence import DIVERGENT, tail
from derivation.plate.elastic import RELATIONS, diagnose
from derivation.plate.modes.balance import signs_that_balance
from derivation.plate.printed.contact import PRINTED
from derivation.plate.printed.motion import PRINTED_MOTION, PrintedPower, PrintedSeries
from derivation.plate.vocabulary import PLATE, k


def plate_finding(record: Printed, formulas: Mapping[str, Record]) -> Finding:
    """Compare a published formula with the derived one; series and powers have their own rules."""
    judges = {PrintedSeries: diagnose_series, PrintedPower: diagnose_power}
    diagnosis = judges.get(type(record), diagnose)(record.name, record.compared, formulas)
    field = record.name in ("u", "w") and diagnosis.verdict == DIFFERENT
    return Finding(
        record, formulas[record.name], diagnosis, _balance_remark(record) if field else ""
    )


def diagnose_series(name: str, term: sp.Expr, formulas: Mapping[str, Record]) -> Diagnosis:
    """Compare a sum over all modes, given by its term, which may diverge."""
    term = resolve(term, formulas, PLATE)
    growth = tail(term)
    if growth.kind != DIVERGENT:
        return diagnose(name, term, formulas)
    formula = known_formula(name, formulas)
    return Diagnosis(
        formula=formula,
        verdict=DIFFERENT,
        kind=DIVERGENT,
        repair=f"the sum diverges because {growth.finding}: read the {to_plain(formula.meaning)}, "
        f"{formula.expression}",
        repaired=formula.expression,
        edits=0,
        ratio=None,
        dimension=dimension_note(term, formula.unit, PLATE),
        given=term,
        method=SYMBOLIC,
    )


def diagnose_power(name: str, given: sp.Expr, formulas: Mapping[str, Record]) -> Diagnosis:
    """Compare the power of the k-th term of a series by its first value and its step."""
    diagnosis = diagnose(name, given, formulas)
    if diagnosis.verdict == EQUAL:
        return diagnosis
    repair = (
        f"read {diagnosis.derived}: the first power is {diagnosis.derived.subs(k, 2)}, not "
        f"{given.subs(k, 2)}, and each is {_step(diagnosis.derived)} above the one before, "
        f"not {_step(given)}"
    )
    return replace(diagnosis, kind=EXPONENT, repair=repair, repaired=diagnosis.derived, edits=1)


def _step(power: sp.Expr) -> sp.Expr:
    return sp.expand(power.subs(k, k + 1) - power)


def _balance_remark(record: Printed) -> str:
    """State what the equilibrium equations say about the signs of (1) and (2) together."""
    signs = signs_that_balance([record.name, *(symbol.name for symbol, _ in record.where)])
    if not signs:
        return ""
    equation = {record.name: record.equation for record in PRINTED}
    either = " or ".join(f"that of {name} in ({equation[name]})" for name in signs)
    return (
        "The published displacements do not satisfy the equilibrium equations; they do "
        f"if one sign is reversed: {either}"
    )


ERRATA = Errata(
    (*PRINTED, *PRINTED_MOTION), RELATIONS, plate_finding, (PrintedPower, PrintedSeries)
)
misprints = ERRATA.compared
