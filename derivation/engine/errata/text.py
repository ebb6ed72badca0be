"""Comparison of a formula given as text with the derived one, with values of both at a point."""

import contextlib
import itertools
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_HALF_EVEN, Context, Decimal
from fractions import Fraction

import flint
import sympy as sp

from derivation.engine.bounded import run_limited
from derivation.engine.errata import summed
from derivation.engine.errata.compare import Diagnosis, diagnose, relations_between
from derivation.engine.errata.equation import (
    arguments_by_name,
    arguments_on_the_left,
    checked_right_hand_side,
    right_hand_side,
)
from derivation.engine.errata.lookup import comparable, known_formula, resolve
from derivation.engine.errata.point import (
    GivenPoint,
    completed_point,
    exact_values,
    other_points,
    parse_point,
)
from derivation.engine.errata.relations import Point, Relations
from derivation.engine.errata.written_out import written_out
from derivation.engine.formula.ball import PrecisionError, enclose, evaluate, to_ball
from derivation.engine.formula.chain import Chain
from derivation.engine.formula.parse import FormulaError
from derivation.engine.formula.parse_latex import parse_latex
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Vocabulary, applicable, names_by_latex

MAX_DIGITS = 1000
_GUARD_DIGITS = (10, 100, 1000)
_MAX_BINARY_EXPONENT = 1 << 18
_ZERO_BITS = 8192
_MOST_POINTS = 12
"""Largest number of further points that are tried for a given formula without a real value."""
NOT_REAL, NOT_PRINTED = "no real value", "too large or too small to print"
"""What is stated instead of the given formula's value if it has none at any tried point."""


class _SizeError(FormulaError):
    """A value that is too large or too small to print."""


@dataclass(frozen=True)
class TextDiagnosis:
    """A comparison with both values at a point, as text.

    Parameters
    ----------
    diagnosis
        The comparison of the formulas.
    point
        The values at which both were evaluated.
    given_value, derived_value
        Decimal values, correctly rounded; without a chosen point, `NOT_REAL` or `NOT_PRINTED` if
        the given formula has no such value at the default point and near it.
    compared
        Note on the terms of a sum that were compared; None for other formulas.
    """

    diagnosis: Diagnosis
    point: tuple[tuple[str, str], ...]
    given_value: str
    derived_value: str
    compared: str | None = None

    @property
    def verdict(self) -> str:
        """``equal`` or ``different``."""
        return self.diagnosis.verdict

    @property
    def repair(self) -> str:
        """A sentence that states how to correct the given formula."""
        return self.diagnosis.repair

    @property
    def ratio(self) -> sp.Expr | None:
        """Given over derived formula, if that is short; else None."""
        return self.diagnosis.ratio

    def __str__(self) -> str:
        """Return name, verdict and correction on one line."""
        return str(self.diagnosis)

    def to_json(self) -> dict[str, object]:
        """Return the comparison as plain data under fixed keys."""
        more = self.diagnosis.to_json()
        return {
            "name": more["name"],
            "compared": self.compared,
            "verdict": more["verdict"],
            "kind": more["kind"],
            "repair": more["repair"],
            "repaired": more["repaired"],
            "ratio": more["ratio"],
            "dimension": more["dimension"],
            "method": more["method"],
            "point": dict(self.point),
            "given": self.given_value,
            "derived": self.derived_value,
        }

    def _repr_latex_(self) -> str:
        return self.diagnosis._repr_latex_()

    def _repr_markdown_(self) -> str:
        """Return the comparison, and both values at the point."""
        at = ", ".join(f"{name} = {value}" for name, value in self.point)
        values = f"given {self.given_value}\n\nderived {self.derived_value}"
        return f"{self.diagnosis._repr_markdown_()}\n\nAt {at}:\n\n{values}"


def diagnose_text(
    name: str,
    text: str,
    formulas: Mapping[str, Record],
    relations: Relations,
    *,
    latex: bool = False,
    at: Mapping[str, str] | None = None,
    digits: int = 50,
) -> TextDiagnosis:
    """Compare a formula given as text with the derived one; the text is not executed.

    Parameters
    ----------
    name
        Name of the derived formula that it should equal.
    text
        The formula in SymPy syntax, or in LaTeX if `latex`; it may contain names of other formulas,
        and begin with the formula's own name or symbol and an equals sign. For a sum over modes one
        term is expected, or ``Sum(..., (j, 1, oo))``. Of a sum over another number, such as
        ``Sum(xi_k*delta**((2*k - 1)/3), (k, 2, oo))``, the terms of the derived formula are
        compared.
    formulas
        The derived formulas by name.
    relations
        The dependent symbols.
    at
        Exact decimal values of symbols [SI]; other symbols have default values.
    digits
        Significant digits of both values.

    Raises
    ------
    FormulaError
        If a name, formula, point or number of digits is not valid.
    """
    if not 1 <= digits <= MAX_DIGITS:
        raise FormulaError(f"expected 1 to {MAX_DIGITS} digits, got {digits}")
    formula = known_formula(name, formulas)
    vocabulary = formula.vocabulary
    chosen = exact_values(at or {}, vocabulary, relations)
    references = {n: sp.Symbol(n, real=True) for n in comparable(formulas)}
    also = {**references, **vocabulary.guest_names}
    applied = arguments_on_the_left(text, formula) | arguments_by_name(formulas)
    text = checked_right_hand_side(text, formula)
    text, terms = written_out(text, vocabulary, latex=latex, formula=formula, formulas=formulas)
    summed.check_sum(formula, text, latex)
    given = read(text, vocabulary, also, latex, _letters(formula), applied)
    summed.check_references(formula, given, formulas)
    summed.check_contribution(formula, resolve(given, formulas, vocabulary))
    diagnosis = diagnose(name, given, formulas, relations)
    derived = formula.expression
    meanings = relations_between(name, diagnosis.given, derived, formulas, relations)
    sides = [side.subs(meanings) for side in (diagnosis.given, derived)]
    names = sorted({s.name for side in sides for s in side.free_symbols})
    domain = [condition for n in names for condition in vocabulary.by_name[n].domain]
    conditions = dict.fromkeys(applicable([*domain, *formula.where], set(names)))
    point = completed_point(chosen, names, meanings, conditions, vocabulary)
    points = itertools.chain([point], other_points(point, chosen, conditions, vocabulary))
    point, derived_value = _first(sides[1], points, vocabulary, digits)
    if chosen:
        given_value = _at(sides[0], point, vocabulary, digits)
    else:
        further = itertools.islice(
            other_points(point, chosen, conditions, vocabulary), _MOST_POINTS
        )
        point, given_value, derived_value = _of_both(
            sides, itertools.chain([point], further), vocabulary, digits, derived_value
        )
    shown = tuple((n, literal) for n, (literal, _) in point.items())
    notes = filter(None, (summed.note(formula), terms))
    return TextDiagnosis(diagnosis, shown, given_value, derived_value, "; ".join(notes) or None)


def diagnose_limited(
    chain: Chain,
    relations: Relations,
    name: str,
    text: str,
    *,
    latex: bool = False,
    at: GivenPoint = "",
    digits: int = 50,
) -> TextDiagnosis:
    """Compare as `diagnose_text` does, with limits of time and memory.

    Parameters
    ----------
    chain
        The derived formulas.
    at
        Values of symbols in SI units, such as ``phi=2.5,h=0.1``, or a mapping.
    relations, name, text, latex, digits
        As for `diagnose_text`.

    Raises
    ------
    FormulaError
        If a name, formula, point or number of digits is not valid.
    derivation.engine.bounded.LimitError
        If a limit of time or memory is reached.
    """
    point = parse_point(at)
    # A text that cannot be parsed, whatever its names mean, is rejected before the derivation.
    vocabulary = chain.vocabulary
    right, _ = written_out(right_hand_side(text), vocabulary, latex=latex)
    words = re.findall(r"[A-Za-z]\w*" if latex else r"[A-Za-z]\w*+(?! *\()", right)
    anything = {word: sp.Symbol(word) for word in words}
    run_limited(lambda: read(right, vocabulary, anything, latex) and None, "reading the formula")
    known = chain.formulas()
    return run_limited(
        lambda: diagnose_text(name, text, known, relations, latex=latex, at=point, digits=digits),
        "comparing the formulas",
    )


def _letters(formula: Record) -> dict[str, str]:
    """Return the meaning of letters in a formula's LaTeX: its own symbols come first."""
    letters = names_by_latex(formula.arguments)
    return {"gamma": "EulerGamma", **letters} if formula.expression.has(sp.EulerGamma) else letters


def read(
    text: str,
    vocabulary: Vocabulary,
    also: Mapping[str, sp.Basic],
    latex: bool,
    letters: Mapping[str, str] | None = None,
    applied: Mapping[str, tuple[str, ...]] | None = None,
) -> sp.Expr:
    """Return the expression of a text in SymPy syntax or LaTeX; for a sum, of one term.

    `letters` and `applied` are used for LaTeX, as `preferred` and `applied` of `parse_latex`.
    """
    if latex:
        term = summed.without_latex_sum(text, vocabulary)
        return parse_latex(term, vocabulary, also, letters, applied)
    return summed.parse_contribution(text, vocabulary, also)


def _first(
    expression: sp.Expr, points: Iterable[Point], vocabulary: Vocabulary, digits: int
) -> tuple[Point, str]:
    """Return the first point at which the expression has a real value, and that value."""
    errors = []
    for point in points:
        try:
            return point, _at(expression, point, vocabulary, digits)
        except FormulaError as error:
            errors.append(error)
    more = len(errors) - 1
    raise FormulaError(f"{errors[0]}" + (f"; {more} points near it have none" if more else ""))


def _of_both(
    sides: Sequence[sp.Expr],
    points: Iterable[Point],
    vocabulary: Vocabulary,
    digits: int,
    derived_value: str,
) -> tuple[Point, str, str]:
    """Return the first point at which both formulas have a value, with the values.

    If there is none, return the first point, with the value of the derived formula and a note.
    """
    first: tuple[Point, str, str] | None = None
    for point in points:
        try:
            given = _at(sides[0], point, vocabulary, digits)
        except FormulaError as error:
            note = NOT_PRINTED if isinstance(error, _SizeError) else NOT_REAL
            first = first or (point, note, derived_value)
            continue
        with contextlib.suppress(FormulaError):
            return point, given, _at(sides[1], point, vocabulary, digits)
    assert first is not None  # at the first point the derived formula has a value
    return first


def _at(expression: sp.Expr, point: Point, vocabulary: Vocabulary, digits: int) -> str:
    """Return the value of an expression at a point, correctly rounded."""
    values = {vocabulary.by_name[n].symbol: value for n, (_, value) in point.items()}
    where = ", ".join(f"{n} = {literal}" for n, (literal, _) in point.items())
    return _decimal(expression, values, digits, where)


def _decimal(
    expression: sp.Expr, values: Mapping[sp.Symbol, Fraction], digits: int, where: str
) -> str:
    """Return the value of an expression, correctly rounded to so many significant digits."""
    try:
        for guard in _GUARD_DIGITS:
            ball = evaluate(expression, values, digits + guard)
            middle, radius = _fraction(ball.mid()), _fraction(ball.rad())
            ends = {_round(end, digits) for end in (middle - radius, middle + radius)}
            if len(ends) == 1:
                return ends.pop()
    except PrecisionError:
        return _zero_or_singular(expression, values, where)
    # A tie: to a thousand further digits, the value is exactly half-way between two numbers.
    return _round(middle, digits)


def _round(value: Fraction, digits: int) -> str:
    context = Context(prec=digits, rounding=ROUND_HALF_EVEN, Emax=10**9, Emin=-(10**9))
    return str(context.divide(Decimal(value.numerator), Decimal(value.denominator)))


def _fraction(point: flint.arb) -> Fraction:
    mantissa, exponent = point.man_exp()
    if abs(int(exponent)) > _MAX_BINARY_EXPONENT:
        raise _SizeError(f"the value is {NOT_PRINTED}: choose another point")
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


def _zero_or_singular(expression: sp.Expr, values: Mapping[sp.Symbol, Fraction], where: str) -> str:
    """Return ``0`` for a value that 8192 bits cannot distinguish from zero, else raise an error."""
    with flint.ctx.workprec(_ZERO_BITS):
        ball = enclose(expression, {symbol: to_ball(value) for symbol, value in values.items()})
    if ball.is_finite() and ball.contains(0):
        return "0"
    raise FormulaError(f"{expression!s:.80} has no real value at {where}: choose another point")
