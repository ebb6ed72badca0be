"""A formula held against the derived one of the same name: equal, or what mends it.

Comparison is modulo the relations that tie the paper's symbols together: P by
(7), A_j by (8), T = 2 phi h.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import combinations

import flint
import sympy as sp

from derivation.formula.notation import to_latex, to_markdown
from derivation.formula.parse import FormulaError
from derivation.formula.proof import SYMBOLIC, reduces_to_zero
from derivation.formula.record import Formula
from derivation.formula.symbols import BY_NAME, A_j, P, T, h, phi
from derivation.paper.dimensions import dimension_note
from derivation.paper.edit import factor_pool, term_pool
from derivation.paper.repairs import Repair, repairs
from derivation.paper.sample import BITS, Values, monomial, sample
from derivation.paper.variant import EXPONENT, FACE, MISSING, STRAY, TWICE, Search

EQUAL, DIFFERENT = "equal", "different"
BY_BALLS = "by ball arithmetic"
OTHER, DIMENSION, UNEXPLAINED = "other formula", "dimension", "unexplained"
_MAX_TERMS = 4000
_MAX_RATIO = 60
_MAX_CANDIDATES = 6


@dataclass(frozen=True)
class Diagnosis:
    """What comparison of a formula with the derived one found.

    Parameters
    ----------
    name
        Name of the derived formula.
    verdict
        ``equal`` or ``different``.
    kind
        The kind of slip; ``equal`` where there is none.
    repair
        A sentence that says what mends the given formula.
    repaired
        The mended formula, equal to the derived one; None if none was found.
    edits
        Number of changes the repair makes.
    ratio
        Given over derived, where that is short.
    dimension
        What is wrong with the given formula's dimension, if anything.
    given, derived
        What was compared.
    method
        How equality was decided, of the given or of the repaired formula.
    """

    name: str
    verdict: str
    kind: str
    repair: str
    repaired: sp.Expr | None
    edits: int
    ratio: sp.Expr | None
    dimension: str | None
    given: sp.Expr
    derived: sp.Expr
    method: str

    def _repr_latex_(self) -> str:
        sign = "=" if self.verdict == EQUAL else r"\neq"
        return f"$\\displaystyle {to_latex(self.given)} {sign} {to_latex(self.derived)}$"

    def _repr_markdown_(self) -> str:
        """Verdict, both formulas and what mends the given one, for a notebook."""
        repair = "" if self.verdict == EQUAL else f"\n\n{self.kind}: {to_markdown(self.repair)}."
        name = to_markdown(self.name)
        return f"**{name}: {self.verdict}**, {self.method}\n\n{self._repr_latex_()}{repair}"

    def to_json(self) -> dict[str, str | int | None]:
        """Plain text under fixed keys."""
        return {
            "name": self.name,
            "verdict": self.verdict,
            "kind": self.kind,
            "repair": self.repair,
            "repaired": None if self.repaired is None else str(self.repaired),
            "edits": self.edits,
            "ratio": None if self.ratio is None else str(self.ratio),
            "dimension": self.dimension,
            "given": str(self.given),
            "derived": str(self.derived),
            "method": self.method,
        }


@dataclass(frozen=True)
class _Case:
    """One comparison: the formulas, the relations in force, and values at sample points."""

    formula: Formula
    given: sp.Expr
    relations: Mapping[sp.Symbol, sp.Expr]
    search: Search
    have: Values
    truth: Values

    def method(self, expression: sp.Expr) -> str | None:
        """How an expression was found equal to the derived one; None if it is not."""
        if not self.search.points.same(expression, self.truth):
            return None
        difference = (expression - self.formula.expression).subs(dict(self.relations))
        if terms_when_expanded(difference) <= _MAX_TERMS and reduces_to_zero(difference):
            return SYMBOLIC
        return BY_BALLS


def diagnose(name: str, given: sp.Expr, formulas: Mapping[str, Formula]) -> Diagnosis:
    """Compare a formula with the derived one of that name, and look for what mends it.

    Parameters
    ----------
    name
        Name of a formula of the chain, for instance ``Omega_3``.
    given
        The formula to judge, in the paper's symbols; names of other formulas
        stand for these.
    formulas
        The chain's formulas by name.

    Raises
    ------
    FormulaError
        If the name is not known, or the formula has no value anywhere.
    """
    formula = known_formula(name, formulas)
    given = resolved(given, formulas)
    with flint.ctx.workprec(BITS):
        case = _case(formula, given, formulas)
        note = dimension_note(given, formula.unit)
        method = case.method(given)
        if method is not None:
            return _diagnosis(case, EQUAL, None, None, note, method)
        for repair, ratio in _repairs(case, formulas):
            method = case.method(repair.expression)
            if method is not None:
                short = _ratio(case) if ratio is None else ratio
                repair = _as_power(case, repair)
                return _diagnosis(case, DIFFERENT, repair, short, note, method)
        return _diagnosis(case, DIFFERENT, None, _ratio(case), note, BY_BALLS)


def comparable(formulas: Mapping[str, Formula]) -> list[str]:
    """Names of the formulas that can be compared: without unknown functions or integrals."""
    open_ended = (sp.Derivative, sp.Integral)
    return [name for name, f in formulas.items() if not f.expression.atoms(*open_ended)]


def known_formula(name: str, formulas: Mapping[str, Formula]) -> Formula:
    """The derived formula of a name.

    Raises
    ------
    FormulaError
        Listing the names there are.
    """
    names = comparable(formulas)
    if name not in names:
        raise FormulaError(f"no formula {name!r:.60}: expected one of {', '.join(names)}")
    return formulas[name]


def resolved(given: sp.Expr, formulas: Mapping[str, Formula]) -> sp.Expr:
    """An expression in which names of formulas that are no symbols are replaced by these.

    Raises
    ------
    FormulaError
        If a symbol is neither one of the paper's nor the name of a formula.
    """
    names = {s: s.name for s in given.free_symbols if BY_NAME.get(s.name) is None}
    unknown = sorted(name for name in names.values() if name not in comparable(formulas))
    if unknown:
        raise FormulaError(
            f"unknown symbols {', '.join(unknown)}: expected some of {', '.join(BY_NAME)}"
        )
    return given.subs({symbol: formulas[name].expression for symbol, name in names.items()})


def relations_between(
    name: str, given: sp.Expr, derived: sp.Expr, formulas: Mapping[str, Formula]
) -> dict[sp.Symbol, sp.Expr]:
    """The symbols to be read as formulas in others: where both sides are not in the same ones."""
    if given.free_symbols == derived.free_symbols:
        return {}
    meaning = {P: formulas["P"].expression, A_j: formulas["A_j"].expression, T: 2 * phi * h}
    used = given.free_symbols | derived.free_symbols
    return {s: meaning[s] for s in meaning if s in used and s.name != name}


def _case(formula: Formula, given: sp.Expr, formulas: Mapping[str, Formula]) -> _Case:
    derived = formula.expression
    relations = relations_between(formula.name, given, derived, formulas)
    points = sample([given, derived], relations)
    try:
        for expression in (derived, given):
            points.learn(expression)
    except NotImplementedError as error:
        raise FormulaError(f"{error}: write it with other functions") from None
    have = points.values(given)
    if not all(value.is_finite() for value in have):
        raise FormulaError(f"{given!s:.80} has no value at random points: look for a zero divisor")
    factors = factor_pool((given, derived))
    for factor in factors:
        points.learn(factor)
    return _Case(
        formula,
        given,
        relations,
        Search(points, factors, term_pool(derived)),
        have,
        points.values(derived),
    )


def _diagnosis(
    case: _Case,
    verdict: str,
    repair: Repair | None,
    ratio: sp.Expr | None,
    note: str | None,
    method: str,
) -> Diagnosis:
    if repair is not None:
        kind, says = repair.kind, repair.says
    elif verdict == EQUAL:
        kind, says, ratio = EQUAL, "nothing to mend", sp.Integer(1)
    else:
        kind = DIMENSION if note else UNEXPLAINED
        says = "no small change mends it" + (f"; its dimension is wrong: {note}" if note else "")
    return Diagnosis(
        name=case.formula.name,
        verdict=verdict,
        kind=kind,
        repair=says,
        repaired=repair.expression if repair else case.given if verdict == EQUAL else None,
        edits=repair.edits if repair else 0,
        ratio=ratio,
        dimension=note,
        given=case.given,
        derived=case.formula.expression,
        method=method,
    )


def _repairs(
    case: _Case, formulas: Mapping[str, Formula]
) -> Iterator[tuple[Repair, sp.Expr | None]]:
    """Candidates in order: a mistaken identity, a name used twice, then edits of the text."""
    yield from _mistaken(case, formulas)
    yield from _counted_twice(case, formulas)
    for count, repair in enumerate(repairs(case.given, case.truth, case.search)):
        if count == _MAX_CANDIDATES:
            return
        yield repair, None


def _mistaken(
    case: _Case, formulas: Mapping[str, Formula]
) -> Iterator[tuple[Repair, sp.Expr | None]]:
    """The given formula is another one of the chain, for instance that of the other face."""
    derived = case.formula
    for other in _formulas_with_values(case, formulas, case.have):
        if other.unit == derived.unit:
            faces = "face" in other.meaning and "face" in derived.meaning
            says = (
                f"it is {other.name}, {other.meaning}; {derived.name}, {derived.meaning}, "
                f"is {derived.expression}"
            )
            repair = Repair(FACE if faces else OTHER, says, derived.expression, 1)
            yield repair, other.expression / derived.expression


def _formulas_with_values(
    case: _Case, formulas: Mapping[str, Formula], values: Values
) -> Iterator[Formula]:
    """Other formulas of the chain that have these values at the sample points."""
    points = case.search.points
    for name in comparable(formulas):
        expression = formulas[name].expression
        evaluable = expression.free_symbols <= set(points.known[0])
        if evaluable and name != case.formula.name and points.same(expression, values):
            yield formulas[name]


def _counted_twice(
    case: _Case, formulas: Mapping[str, Formula]
) -> Iterator[tuple[Repair, sp.Expr | None]]:
    """A factor named in a product is already part of what another factor was derived from."""
    points = case.search.points
    for factor in sp.Mul.make_args(case.given):
        if factor not in case.relations or factor.name not in formulas:
            continue
        rest = case.given / factor
        need = [w / v for w, v in zip(case.truth, points.values(rest), strict=True)]
        for other in _formulas_with_values(case, formulas, points.values(rest)):
            if factor.name not in ancestors(other.name, formulas):
                continue
            for left in _partial_products(case.relations[factor]):
                if points.same(left, need):
                    double = case.relations[factor] / left
                    says = (
                        f"{other.name} already holds the factor {double} of {factor.name}: "
                        f"read {left} instead of {factor.name}"
                    )
                    yield Repair(TWICE, says, rest * left, 1), double


def ancestors(name: str, formulas: Mapping[str, Formula]) -> set[str]:
    """All formulas that a formula was derived from, directly or not."""
    found: set[str] = set()
    todo = list(formulas[name].sources)
    while todo:
        source = todo.pop()
        if source not in found and source in formulas:
            found.add(source)
            todo += formulas[source].sources
    return found


def _partial_products(expression: sp.Expr) -> Iterator[sp.Expr]:
    """Products of some factors, the smallest first."""
    factors = sp.Mul.make_args(expression)
    for size in range(1, len(factors)):
        for some in combinations(factors, size):
            yield sp.Mul(*some)


def _as_power(case: _Case, repair: Repair) -> Repair:
    """A stray or missing root of a factor that stands in the given formula is a wrong power."""
    excess = _ratio(case)
    if repair.kind not in (STRAY, MISSING) or excess is None or not excess.is_Pow:
        return repair
    base, power = excess.as_base_exp()
    printed = case.given.as_powers_dict().get(base, 0)
    if power.is_Integer or printed == 0:
        return repair
    says = f"read the power {base}**({printed - power}) instead of {base}**({printed})"
    return replace(repair, kind=EXPONENT, says=says)


def _ratio(case: _Case) -> sp.Expr | None:
    """Given over derived where that is a monomial, or short after cancelling equal factors."""
    ratio = [v / w for v, w in zip(case.have, case.truth, strict=True)]
    simple = monomial(ratio, case.search.points)
    if simple is not None:
        return simple
    quotient = case.given / case.formula.expression
    return quotient if quotient.count_ops() <= _MAX_RATIO else None


def terms_when_expanded(expression: sp.Expr) -> int:
    """Upper estimate of the terms that expansion over a common denominator yields."""
    if isinstance(expression, sp.Add):
        return _estimate_sum(expression)
    if isinstance(expression, sp.Mul):
        product = 1
        for factor in expression.args:
            product = min(product * terms_when_expanded(factor), _MAX_TERMS**2)
        return product
    if isinstance(expression, sp.Pow) and isinstance(expression.exp, sp.Integer):
        base = terms_when_expanded(expression.base)
        return int(min(base ** min(abs(int(expression.exp)), 30), _MAX_TERMS**2))
    return 2 if isinstance(expression, sp.sinh | sp.cosh | sp.tanh | sp.coth) else 1


def _estimate_sum(expression: sp.Add) -> int:
    """Every numerator meets the other denominators; equal denominators meet once."""
    total = 0
    below: set[sp.Expr] = set()
    for term in expression.args:
        above, under = sp.fraction(term)
        total += terms_when_expanded(above)
        below.update(f for f in sp.Mul.make_args(under) if not f.is_number)
    product = 1
    for factor in below:
        product = min(product * terms_when_expanded(factor), _MAX_TERMS**2)
    return min(total * product, _MAX_TERMS**2)
