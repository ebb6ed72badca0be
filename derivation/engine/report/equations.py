"""Displayed equations: long sums are broken into lines, and deep fractions get a name."""

import itertools
import re
from collections.abc import Callable
from functools import cache

import sympy as sp

from derivation.engine.formula.notation import PaperPrinter
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.report.width import typeset_width

PAGE, COLUMN = 415.0, 208.0
"""Width of a line of the report without the equation number, and of a column of a paper [pt]."""
INDENT, SIGN = 10.0, 12.5
"""Width of the indent of further lines of an equation, and of a sign before a term [pt]."""
DEEPEST = 2
"""Largest number of nested fractions that is legible."""
SHORT = 80.0
"""Largest width of a fraction that is written with a slash inside another one [pt]."""
LEAST_PART, NAME = 40.0, 27.0
"""Smallest width of a part that gets a name, and width of a name with its equals sign [pt]."""
FURTHER = r"& \quad "
"""LaTeX at the beginning of a further line of a sum."""


class Displayed(PaperPrinter):
    """The paper's notation; powers, and short fractions inside others, are set with a slash."""

    def __init__(self, vocabulary: Vocabulary) -> None:
        super().__init__({"symbol_names": vocabulary.latex, "fold_frac_powers": True})
        self.inside = self.deepest = 0

    def _print_Mul(self, expr: sp.Expr) -> str:
        numerator, denominator = sp.fraction(expr, exact=True)
        if denominator == 1:
            return str(super()._print_Mul(expr))
        if self.inside and (short := self._with_slash(numerator, denominator)):
            return short
        self.inside += 1
        self.deepest = max(self.deepest, self.inside)
        text = str(super()._print_Mul(expr))
        self.inside -= 1
        return text

    def _with_slash(self, numerator: sp.Expr, denominator: sp.Expr) -> str:
        """Return numerator and denominator on one line; empty if that is too wide."""
        sign = "- " if numerator.could_extract_minus_sign() else ""
        numerator = -numerator if sign else numerator
        over, under = self._print(numerator), self._print(denominator)
        if r"\frac" in over + under or typeset_width(over + under) > SHORT:
            return ""
        single = denominator.is_Atom or denominator.is_Function or denominator.is_Pow
        over = rf"\left({over}\right)" if numerator.is_Add else over
        return f"{sign}{over} / " + (under if single else rf"\left({under}\right)")

    def _print_Rational(self, expr: sp.Rational) -> str:
        if self.inside and expr.q != 1:
            return f"{'- ' if expr.p < 0 else ''}{abs(expr.p)} / {expr.q}"
        return str(super()._print_Rational(expr))

    def _print_Sum(self, expr: sp.Sum) -> str:
        return self._with_limits(super()._print_Sum, expr)

    def _print_Integral(self, expr: sp.Integral) -> str:
        text = self._with_limits(super()._print_Integral, expr)
        # Space, because the upper limit is wider than the sign and would touch the integrand.
        return re.sub(r"^(\\int\\limits_\{.*?\}\^\{.*?\}) ", r"\1\\; ", text)

    def _with_limits(self, printed: Callable[[sp.Expr], str], expr: sp.Expr) -> str:
        """Return a sum or integral; inside a fraction it counts as one more nested fraction."""
        self.inside += bool(self.inside)
        self.deepest = max(self.deepest, self.inside)
        text = printed(expr)
        self.inside -= bool(self.inside)
        return text

    def _print_re(self, expr: sp.re) -> str:
        return rf"\operatorname{{Re}}\left({self._print(expr.args[0])}\right)"

    def _print_im(self, expr: sp.im) -> str:
        return rf"\operatorname{{Im}}\left({self._print(expr.args[0])}\right)"


@cache
def _displayed(expression: sp.Basic, vocabulary: Vocabulary) -> tuple[str, float, int]:
    """Return LaTeX of an expression, its width [pt] and its largest number of nested fractions."""
    printer = Displayed(vocabulary)
    text = str(printer.doprint(expression))
    return text, typeset_width(text), printer.deepest


def displayed(expression: sp.Basic, vocabulary: Vocabulary) -> str:
    """Return LaTeX of an expression in a displayed equation."""
    return _displayed(expression, vocabulary)[0]


def legible(expression: sp.Expr, vocabulary: Vocabulary, room: float = PAGE) -> bool:
    """Return whether an expression fits a line of width `room` [pt], with legible fractions."""
    _, width, deepest = _displayed(expression, vocabulary)
    return width <= room and deepest <= DEEPEST


def equation(
    left: str, expression: sp.Expr, vocabulary: Vocabulary, prefix: str = "", room: float = PAGE
) -> str:
    """Return the body of an equation in lines of limited width; long parts are named Z_1, Z_2, ...

    Parameters
    ----------
    left
        LaTeX of the left side.
    expression
        The right side.
    vocabulary
        The symbols with their notation.
    prefix
        LaTeX between the equals sign and the right side.
    room
        Width of a line [pt].
    """
    if prefix and not expression.is_Add and expression.could_extract_minus_sign():
        prefix, expression = f"- {prefix}", -expression
    begin = f"{left} = {prefix}"
    short = not (prefix and expression.is_Add)
    if short and legible(expression, vocabulary, room - typeset_width(begin)):
        return begin + displayed(expression, vocabulary)
    beside = max(INDENT + SIGN, typeset_width(FURTHER + prefix))
    value, parts = in_parts(expression, room - beside, vocabulary, whole=not short)
    rows = _rows(left, value, vocabulary, room, prefix)
    for symbol, part in parts:
        rows += _rows(str(symbol), part, vocabulary, room)
    return r"\begin{aligned}" + " \\\\\n".join(rows) + r"\end{aligned}"


def right_side(formula: Record) -> sp.Expr:
    """Return the shown right side of a formula: as stated by other formulas, or its expression."""
    return formula.shown


def body(formula: Record, factor: Record | None = None, room: float = PAGE) -> str:
    """Return a formula as the body of a displayed equation; `factor` is shown by its name."""
    shown = right_side(formula) if factor is None else function_by_name(right_side(formula), factor)
    return equation(formula.latex, shown, formula.vocabulary, formula.sum_sign, room)


def function_by_name(expression: sp.Expr, formula: Record) -> sp.Expr:
    """Replace a function of one argument in an expression by its name, as in G(2 phi h)."""
    (argument,) = formula.expression.free_symbols
    called = sp.Function(formula.name)
    inner = {at.args[0] for at in expression.atoms(sp.sinh)}
    return expression.xreplace(
        {formula.expression.xreplace({argument: at}): called(at) for at in inner}
    )


def _rows(
    left: str, value: sp.Expr, vocabulary: Vocabulary, room: float, prefix: str = ""
) -> list[str]:
    """Return a left side and its sum in lines; all lines but the first are indented."""
    begin = f"& {left} = "
    rows = [begin]
    for index, term in enumerate(_signed_terms(value, vocabulary)):
        text = term if index else prefix + term
        if typeset_width(rows[-1] + text) > room and rows[-1] != FURTHER:
            rows.append(FURTHER)
        rows[-1] += f" {text}"
    return rows


def in_parts(
    expression: sp.Expr, room: float, vocabulary: Vocabulary, whole: bool = False
) -> tuple[sp.Expr, list[tuple[sp.Symbol, sp.Expr]]]:
    """Return a sum whose terms fit a line each, and the expressions of the parts named in it.

    With `whole`, the whole expression is the first part.
    """
    value = _expanded(expression)
    if not all(legible(term, vocabulary, room) for term in sp.Add.make_args(value)):
        value = expression
    symbols = (sp.Symbol(f"Z_{count}") for count in itertools.count(1))
    parts = list[tuple[sp.Symbol, sp.Expr]]()
    if whole:
        parts, value = [(next(symbols), value)], sp.Symbol("Z_1")
    values, index = [value, *(part for _, part in parts)], 0
    names: list[sp.Symbol] = [symbol for symbol, _ in parts]
    while index < len(values):
        chosen = _part(values[index], room, vocabulary)
        if chosen is None:
            index += 1
            continue
        names.append(next(symbols))
        for k, text in enumerate(values):
            values[k] = _replaced(text, chosen, names[-1])
        values.append(chosen)
    return values[0], list(zip(names, values[1:], strict=True))


def _replaced(value: sp.Expr, part: sp.Expr, symbol: sp.Symbol) -> sp.Expr:
    """Replace a part of a value, or some factors of one of its terms, by a symbol."""
    replaced = value.xreplace({part: symbol})
    if replaced != value or not part.is_Mul:
        return replaced
    factors = set(part.args)
    terms = [
        sp.Mul(symbol, *(f for f in term.args if f not in factors))
        if term.is_Mul and factors <= set(term.args)
        else term
        for term in sp.Add.make_args(value)
    ]
    return sp.Add(*terms)


def _part(value: sp.Expr, room: float, vocabulary: Vocabulary) -> sp.Expr | None:
    """Return the part of a value to be named next; None if each of its terms fits a line."""
    wide = [t for t in sp.Add.make_args(value) if not legible(t, vocabulary, room)]
    if not wide:
        return None
    inner = [
        part
        for part in wide[0].atoms(sp.Add, sp.Mul, sp.Pow, sp.Function, sp.Sum, sp.Integral)
        if part != wide[0] and _displayed(part, vocabulary)[1] >= LEAST_PART
    ]
    widths = {part: _displayed(part, vocabulary)[1] for part in inner}
    line = room - INDENT - NAME
    sums = [part for part in inner if isinstance(part, (sp.Add, sp.Sum, sp.Integral))]
    fit = [part for part in sums if legible(part, vocabulary, line)]
    long = [
        part
        for part in sums
        if part.is_Add and all(legible(term, vocabulary, line) for term in part.args)
    ]
    others = [part for part in inner if legible(part, vocabulary, line)]
    for group, best in ((fit, max), (long, min), (others, max), (inner, min)):
        if group:
            return best(group, key=lambda p: (widths[p], sp.default_sort_key(p)))
    factors = [f for f in sp.Mul.make_args(wide[0]) if not f.is_number]
    return sp.Mul(*factors[: len(factors) // 2]) if len(factors) > 2 else None


def _expanded(expression: sp.Expr) -> sp.Expr:
    """Expand an expression, unless it contains functions, or sums in roots or denominators."""
    nested = any(not p.exp.is_Integer and p.base.is_Add for p in expression.atoms(sp.Pow))
    divided = any(p.exp.is_negative and p.base.is_Add for p in expression.atoms(sp.Pow))
    worse = nested or divided or expression.has(sp.Function, sp.Integral)
    return expression if worse else sp.expand(expression)


def _signed_terms(expression: sp.Add, vocabulary: Vocabulary) -> list[str]:
    """Return LaTeX of a sum's terms in printed order, each with its sign (no plus at first)."""
    text: list[str] = []
    for term in expression.as_ordered_terms():
        negative = term.could_extract_minus_sign()
        sign = "-" if negative else "+" if text else ""
        text.append(f"{sign} {displayed(-term if negative else term, vocabulary)}")
    return text
