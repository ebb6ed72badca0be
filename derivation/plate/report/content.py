"""Values of the templates of the report from formulas, misprints and recorded measurements."""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from math import inf
from typing import Any

import sympy as sp

from derivation.engine.formula.ball import enclose, to_ball
from derivation.engine.formula.record import Record
from derivation.engine.report.equations import equation
from derivation.engine.report.latex import code, escape
from derivation.engine.report.numbers import number, rounded
from derivation.plate.contact.oracle.balls import finite_part
from derivation.plate.contact.theory.thin_remainder import coefficient_remainder_ball
from derivation.plate.contact.theory.thin_roots import root
from derivation.plate.modes.theory.equilibrium import force_balance, hooke
from derivation.plate.vocabulary import PLATE, M, eta, r, z

Data = Mapping[str, Any]

HALF = 2.0**26
"""Error at which half of the digits of a double are lost [ULP]."""
ROOT_DIGITS = 12
"""Number of certified digits of the contributions of the roots; fewer are printed."""


def navier() -> list[str]:
    """Return Navier's equations of a field u(r, z), w(r, z), from Hooke's law and the balance."""
    u, w = (sp.Function(name)(r, z) for name in "uw")
    rows = []
    for force in force_balance(hooke(u, w)):
        terms = sp.expand(force.doit())
        whole = sp.collect(terms, [*sorted(terms.atoms(sp.Derivative), key=str), u, w])
        rows.append(equation("0", whole, PLATE).replace(r"{\left(r,z \right)}", ""))
    return rows


def roots_context(formulas: Mapping[str, Record]) -> dict[str, Any]:
    """Return the first roots, and their contributions to the closed form of c_1 as balls."""
    closed, M_2 = formulas["c_1_thin"].expression, finite_part(2, ROOT_DIGITS)
    rows = []
    for ratio in ("1/20", "1/10", "1/5", "1/3", "1/2", "1"):
        value = enclose(closed, {eta: to_ball(Fraction(ratio)), M[2]: M_2})
        remainder = coefficient_remainder_ball(2, Fraction(ratio), ROOT_DIGITS)
        texts = (value.str(6, radius=False), (value + remainder).str(6, radius=False))
        rows.append(f"${ratio}$ & ${texts[0]}$ & {number(float(remainder))} & ${texts[1]}$")
    return {
        "first": [root_text(n) for n in (1, 2)],
        "height": root(1).imag.str(5, radius=False),
        "rows": rows,
    }


def root_text(n: int) -> str:
    """Return T_n with six digits."""
    T = root(n)
    return rf"{T.real.str(6, radius=False)} + {T.imag.str(6, radius=False)}\,\mathrm{{i}}"


def published_errors(rows: Sequence[Data], wrong: set[str]) -> Iterator[tuple[Data, Data]]:
    """Yield the rows of correct formulas as published, each with that of its generated function."""
    generated = {row["kernel"]: row for row in rows if row["passed"] is not None}
    for row in rows:
        if row["passed"] is None and row["kernel"] in generated.keys() - wrong:
            yield row, generated[row["kernel"]]


def loses(row: Data) -> bool:
    """Return whether a function overflows or loses half of its digits at some point."""
    return bool(row["double"]["not_finite"]) or float(row["double"]["max_ulp"]) > HALF


def cancellation_rows(rows: Sequence[Data], wrong: set[str]) -> Iterator[str]:
    """Yield the cells of correct formulas that lose digits only if evaluated as published."""
    for published, generated in published_errors(rows, wrong):
        errors = published["double"]
        worst = r"$\infty$" if errors["not_finite"] else number(errors["max_ulp"])
        cells = [code(published["kernel"]), str(errors["points"]), worst]
        yield " & ".join([*cells, number(generated["double"]["max_ulp"])])


def module_rows(rows: Sequence[Data]) -> Iterator[str]:
    """Yield the cells of each module: functions, points, largest error, fraction used."""
    modules: dict[str, list[Data]] = {}
    for row in rows:
        if row["passed"] is not None:
            modules.setdefault(row["module"], []).append(row)
    for name, mine in modules.items():
        worst = max(mine, key=lambda row: float(row["double"]["max_ulp"]))
        cells = [code(name), str(len(mine)), str(sum(row["double"]["points"] for row in mine))]
        cells += [number(worst["double"]["max_ulp"]), code(worst["kernel"])]
        yield " & ".join([*cells, number(max(row["double"]["ratio"] for row in mine))])


def rule_rows(rows: Sequence[Data]) -> Iterator[str]:
    """Yield the cells of each rule: cause, formulas, largest error without and with it."""
    rules: dict[tuple[str, str], list[list[float]]] = {}
    for row in rows:
        for applied in row["applied"]:
            errors = [float(error) for error in applied["worst"]]
            rules.setdefault((applied["rule"], applied["cause"]), []).append(errors)
    for (rule, cause), of_rule in sorted(rules.items()):
        most = (max(error) for error in zip(*of_rule, strict=True))
        shown = [r"$\infty$" if error == inf else number(error) for error in most]
        yield " & ".join([escape(rule), escape(cause), str(len(of_rule)), *shown])


def contact_row(row: Data) -> str:
    """Return the cells of a row of the contact law's errors."""
    cells = [code(row["kernel"]), str(row["points"]), str(row["digits"])]
    return " & ".join([*cells, number(row["max_error"]), number(row["p99_error"])])


def contact_impacts(rows: Sequence[Data]) -> dict[str, str]:
    """Return the ranges of c_1 A, h/b and a/h of the measured impacts."""
    cases = [case for row in rows for case in row["cases"]]
    ends = {}
    for key in ("c1_A", "h_over_b", "a_over_h"):
        values = [case[key] for case in cases]
        ends[f"{key}_low"], ends[f"{key}_high"] = rounded(min(values)), rounded(max(values))
    return ends
