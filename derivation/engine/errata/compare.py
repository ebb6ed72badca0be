"""Comparison of a formula with the derived one of the same name, and search for a correction.

The comparison takes into account the relations between the paper's symbols.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import combinations

import flint
import sympy as sp

from derivation.engine.errata.decimals import decimal_corrections
from derivation.engine.errata.dimensions import dimension_note
from derivation.engine.errata.edit import factor_pool, sum_pool, term_pool
from derivation.engine.errata.elsewhere import where_nonzero
from derivation.engine.errata.lookup import comparable, known_formula, resolve
from derivation.engine.errata.relations import Relations
from derivation.engine.errata.repairs import Repair, repairs
from derivation.engine.errata.sample import BITS, INTEGRAL_BITS, Values, monomial, sample
from derivation.engine.errata.variant import EXPONENT, FACE, MISSING, STRAY, TWICE, VariantSearch
from derivation.engine.formula.integral import HINT
from derivation.engine.formula.notation import to_latex, to_markdown, to_plain
from derivation.engine.formula.parse import FormulaError
from derivation.engine.formula.proof import SYMBOLIC, reduces_to_zero
from derivation.engine.formula.record import Record
from derivation.engine.formula.size import terms_when_expanded

EQUAL, DIFFERENT = "equal", "different"
BY_BALLS = "by ball arithmetic"
OTHER, DIMENSION, UNEXPLAINED = "other formula", "dimension", "unexplained"
_MAX_TERMS = 4000
_MAX_RATIO = 60
_MAX_CANDIDATES = 6


@dataclass(frozen=True)
class Diagnosis:
    """Result of comparing a formula with the derived one.

    Parameters
    ----------
    formula
        The derived formula.
    verdict
        ``equal`` or ``different``.
    kind
        The kind of error; ``equal`` if there is none.
    repair
        A sentence that states how to correct the given formula.
    repaired
        The corrected formula, equal to the derived one; None if none was found.
    edits
        Number of changes in the correction.
    ratio
        Given over derived formula, if that is short; else None.
    dimension
        Error in the dimension of the given formula; None if there is none.
    given
        The given formula.
    method
        Method by which the given or corrected formula was found equal to the derived one, or the
        given one different.
    """

    formula: Record
    verdict: str
    kind: str
    repair: str
    repaired: sp.Expr | None
    edits: int
    ratio: sp.Expr | None
    dimension: str | None
    given: sp.Expr
    method: str

    @property
    def name(self) -> str:
        """Name of the derived formula."""
        return self.formula.name

    @property
    def derived(self) -> sp.Expr:
        """The derived formula's expression."""
        return self.formula.expression

    def __str__(self) -> str:
        """Return name, verdict and correction on one line."""
        repair = "" if self.verdict == EQUAL else f", {self.kind}: {to_plain(self.repair)}"
        return f"{self.name}: {self.verdict}{repair}"

    def _repr_latex_(self) -> str:
        sign = "=" if self.verdict == EQUAL else r"\neq"
        given, derived = (to_latex(x, self.formula.vocabulary) for x in (self.given, self.derived))
        return f"$\\displaystyle {given} {sign} {derived}$"

    def _repr_markdown_(self) -> str:
        """Return result, both formulas and the correction, for a notebook."""
        repair = "" if self.verdict == EQUAL else f"\n\n{self.kind}: {to_markdown(self.repair)}."
        name = to_markdown(self.name)
        return f"**{name}: {self.verdict}**, {self.method}\n\n{self._repr_latex_()}{repair}"

    def to_json(self) -> dict[str, str | int | None]:
        """Return the result as plain data under fixed keys."""
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
    """One comparison: the formulas, the relations that apply, and values at sample points."""

    formula: Record
    given: sp.Expr
    relations: Mapping[sp.Symbol, sp.Expr]
    search: VariantSearch
    have: Values
    reference: Values

    def method(self, expression: sp.Expr) -> str | None:
        """Return how an expression was found equal to the derived one; None if it is not."""
        if not self.search.points.same(expression, self.reference):
            return None
        difference = self.difference(expression)
        if terms_when_expanded(difference) <= _MAX_TERMS and reduces_to_zero(difference):
            return SYMBOLIC
        return None if where_nonzero(difference, self.formula) else BY_BALLS

    def difference(self, expression: sp.Expr) -> sp.Expr:
        """Return the difference from the derived expression in independent symbols."""
        return (expression - self.formula.expression).subs(dict(self.relations))


def diagnose(
    name: str, given: sp.Expr, formulas: Mapping[str, Record], relations: Relations
) -> Diagnosis:
    """Compare a formula with the derived one of that name, and search for a correction.

    Parameters
    ----------
    name
        Name of a derived formula, such as ``Omega_3``.
    given
        The formula to be compared; it may contain the paper's symbols and names of other formulas.
    formulas
        The derived formulas by name.
    relations
        The dependent symbols.

    Returns
    -------
    Diagnosis
        The verdict, and the correction if one was found.

    Raises
    ------
    FormulaError
        If the name is unknown, or the formula cannot be evaluated.
    """
    formula = known_formula(name, formulas)
    given = resolve(given, formulas, formula.vocabulary)
    integral = given.has(sp.Integral) or formula.expression.has(sp.Integral)
    with flint.ctx.workprec(INTEGRAL_BITS if integral else BITS):
        case = _case(formula, given, formulas, relations, integral)
        note = dimension_note(given, formula.unit, formula.vocabulary)
        method = case.method(given)
        if method is None and not integral:
            inside = _case(formula, given, formulas, relations, True)
            if inside.search.points.inside:
                case, method = inside, inside.method(given)
        if method is not None:
            return _diagnosis(case, EQUAL, None, None, note, method)
        for repair, ratio in _repairs(case, formulas):
            method = case.method(repair.expression)
            if method is not None:
                short = _ratio(case) if ratio is None else ratio
                repair = _as_power(case, repair)
                return _diagnosis(case, DIFFERENT, repair, short, note, method)
        _check_finite(given, case.have)
        return _diagnosis(case, DIFFERENT, None, _ratio(case), note, BY_BALLS)


def relations_between(
    name: str,
    given: sp.Expr,
    derived: sp.Expr,
    formulas: Mapping[str, Record],
    relations: Relations,
) -> dict[sp.Symbol, sp.Expr]:
    """Return the dependent symbols, with their expressions, if both sides differ in symbols."""
    if given.free_symbols == derived.free_symbols:
        return {}
    return relations.between(name, given.free_symbols, derived.free_symbols, formulas)


def _case(
    formula: Record,
    given: sp.Expr,
    formulas: Mapping[str, Record],
    relations: Relations,
    inside: bool,
) -> _Case:
    """Return a comparison at any points, or at points inside the domain of the formula if possible.

    Any points show that two formulas are equal. Formulas that differ at some may be equal inside,
    such as two with other branches of a root or logarithm, and integrals need not exist elsewhere.
    """
    derived = formula.expression
    meanings = relations_between(formula.name, given, derived, formulas, relations)
    vocabulary = formula.vocabulary
    domain = [*formula.where, *(c for a in vocabulary.arguments for c in a.domain)]
    for number in given.atoms(sp.Float):
        text = repr(float(number))
        raise FormulaError(f'expected exact numbers, got {text}; write sp.Rational("{text}")')
    points = sample([given, derived], meanings, vocabulary.within, domain if inside else ())
    try:
        for expression in (derived, given):
            points.learn(expression)
    except NotImplementedError as error:
        raise FormulaError(f"{error}: write it with other functions") from None
    have, reference = points.values(given), points.values(derived)
    for expression, values in ((given, have), (derived, reference)):
        if not expression.has(sp.Integral) or expression is derived:
            _check_finite(expression, values)
    factors = points.evaluable(factor_pool((given, derived), meanings))
    for factor in factors:
        points.learn(factor)
    return _Case(
        formula,
        given,
        meanings,
        VariantSearch(
            points,
            factors,
            points.evaluable(term_pool(derived)),
            points.evaluable(sum_pool(derived)),
        ),
        have,
        reference,
    )


def _check_finite(expression: sp.Expr, values: Values) -> None:
    if not all(value.is_finite() for value in values):
        hint = HINT if expression.has(sp.Integral) else "check for a division by zero"
        raise FormulaError(f"{expression!s:.80} has no value at random points: {hint}")


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
        kind, says, ratio = EQUAL, "no correction needed", sp.Integer(1)
    else:
        kind = DIMENSION if note else UNEXPLAINED
        where = where_nonzero(case.difference(case.given), case.formula) if ratio == 1 else ""
        says = f"equal at usual points, not at {where}" if where else "no small change corrects it"
        says += f"; its dimension is wrong: {note}" if note else ""
        ratio = None if where else ratio
    return Diagnosis(
        formula=case.formula,
        verdict=verdict,
        kind=kind,
        repair=says,
        repaired=repair.expression if repair else case.given if verdict == EQUAL else None,
        edits=repair.edits if repair else 0,
        ratio=ratio,
        dimension=note,
        given=case.given,
        method=method,
    )


def _repairs(
    case: _Case, formulas: Mapping[str, Record]
) -> Iterator[tuple[Repair, sp.Expr | None]]:
    """Yield candidates: another derived formula, a double factor, decimals, one or two edits."""
    yield from _confused_formulas(case, formulas)
    yield from _counted_twice(case, formulas)
    yield from (
        (repair, None) for repair in decimal_corrections(case.given, case.formula.expression)
    )
    for count, repair in enumerate(repairs(case.given, case.reference, case.search)):
        if count == _MAX_CANDIDATES:
            return
        yield repair, None


def _confused_formulas(
    case: _Case, formulas: Mapping[str, Record]
) -> Iterator[tuple[Repair, sp.Expr | None]]:
    """Yield other derived formulas that equal the given one, such as that of the other face."""
    derived = case.formula
    like = {name: other for name, other in formulas.items() if other.unit == derived.unit}
    for other in _formulas_with_values(case, like, case.have):
        faces = all("face" in record.meaning.split() for record in (other, derived))
        says = (
            f"this is {other.name} ({to_plain(other.meaning)}); {derived.name} "
            f"({to_plain(derived.meaning)}) is {derived.expression}"
        )
        repair = Repair(FACE if faces else OTHER, says, derived.expression, 1)
        yield repair, other.expression / derived.expression


def _formulas_with_values(
    case: _Case, formulas: Mapping[str, Record], values: Values
) -> Iterator[Record]:
    """Yield other derived formulas that have these values at the sample points."""
    points = case.search.points
    for name in comparable(formulas):
        expression = formulas[name].expression
        if expression.has(sp.Integral) and not case.given.has(sp.Integral):
            continue  # an integral takes longer than all closed forms together
        evaluable = name != case.formula.name and points.evaluable((expression,))
        if evaluable and points.same(expression, values):
            yield formulas[name]


def _counted_twice(
    case: _Case, formulas: Mapping[str, Record]
) -> Iterator[tuple[Repair, sp.Expr | None]]:
    """Yield corrections for a factor that another factor of the product already contains."""
    points = case.search.points
    for factor in sp.Mul.make_args(case.given):
        if factor not in case.relations or factor.name not in formulas:
            continue
        rest = case.given / factor
        need = [w / v for w, v in zip(case.reference, points.values(rest), strict=True)]
        for other in _formulas_with_values(case, formulas, points.values(rest)):
            if factor.name not in ancestors(other.name, formulas):
                continue
            for left in _partial_products(case.relations[factor]):
                if points.same(left, need):
                    double = case.relations[factor] / left
                    says = (
                        f"{other.name} already contains the factor {double} of {factor.name}: "
                        f"read {left} instead of {factor.name}"
                    )
                    yield Repair(TWICE, says, rest * left, 1), double


def ancestors(name: str, formulas: Mapping[str, Record]) -> set[str]:
    """Return all formulas that a formula was derived from, directly or indirectly."""
    names: set[str] = set()
    todo = list(formulas[name].sources)
    while todo:
        source = todo.pop()
        if source not in names and source in formulas:
            names.add(source)
            todo += formulas[source].sources
    return names


def _partial_products(expression: sp.Expr) -> Iterator[sp.Expr]:
    """Yield products of some factors, the smallest first."""
    factors = sp.Mul.make_args(expression)
    for size in range(1, len(factors)):
        for subset in combinations(factors, size):
            yield sp.Mul(*subset)


def _as_power(case: _Case, repair: Repair) -> Repair:
    """Return a correction as a wrong power, if a root of a factor is superfluous or missing."""
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
    """Return given over derived formula, if that is a monomial or short; else None."""
    ratio = [v / w for v, w in zip(case.have, case.reference, strict=True)]
    simple = monomial(ratio, case.search.points)
    if simple is not None:
        return simple
    quotient = case.given / case.formula.expression
    return quotient if quotient.count_ops() <= _MAX_RATIO else None
