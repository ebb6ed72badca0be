"""Formulas as displayed equations: long sums in lines, what would be too small beside them."""

import itertools
from collections.abc import Callable
from functools import cache

import sympy as sp

from derivation.engine.formula.notation import PaperPrinter
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.report.width import typeset_width

PAGE, COLUMN = 415.0, 208.0
"""Width of a line of the report beside its equation's number, and of a column of a paper [pt]."""
INDENT, SIGN = 10.0, 12.5
"""Of the further lines of an equation, and a sign before their first term [pt]."""
DEEPEST = 2
"""Fractions within each other, beyond which they are too small to read."""
SHORT = 80.0
"""Width of a fraction that is written with a slash inside another one [pt]."""
LEAST_PART, NAME = 40.0, 27.0
"""Width of a part worth a name, and of a name with its equals sign [pt]."""
FURTHER = r"& \quad "
"""Begins a further line of a sum."""


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
        """Numerator and denominator on one line, or nothing where that is long."""
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
        return self._with_limits(super()._print_Integral, expr)

    def _with_limits(self, printed: Callable[[sp.Expr], str], expr: sp.Expr) -> str:
        """What is too small in a fraction already where a plain term is not."""
        self.inside += bool(self.inside)
        self.deepest = max(self.deepest, self.inside)
        text = printed(expr)
        self.inside -= bool(self.inside)
        return text

    def _print_im(self, expr: sp.im) -> str:
        return rf"\operatorname{{Im}}\left({self._print(expr.args[0])}\right)"


@cache
def displayed(expression: sp.Basic, vocabulary: Vocabulary) -> str:
    """LaTeX of an expression for a line of its own."""
    return str(Displayed(vocabulary).doprint(expression))


@cache
def legible(expression: sp.Expr, vocabulary: Vocabulary, room: float = PAGE) -> bool:
    """Whether an expression fits a line, and its fractions can be read."""
    printer = Displayed(vocabulary)
    return typeset_width(printer.doprint(expression)) <= room and printer.deepest <= DEEPEST


def equation(
    left: str, expression: sp.Expr, vocabulary: Vocabulary, prefix: str = "", room: float = PAGE
) -> str:
    """Body of a displayed equation in lines that fit a width, its long parts named Z_1, Z_2 ...

    Parameters
    ----------
    left
        LaTeX of the left side.
    expression
        The right side.
    vocabulary
        How its symbols are typeset.
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
    beside = max(SIGN, typeset_width(prefix))
    value, parts = in_parts(expression, room - INDENT - beside, vocabulary, whole=not short)
    rows = _rows(left, value, vocabulary, room, prefix)
    for symbol, part in parts:
        rows += _rows(str(symbol), part, vocabulary, room)
    return r"\begin{aligned}" + " \\\\\n".join(rows) + r"\end{aligned}"


def right_side(formula: Record) -> sp.Expr:
    """What is shown of a formula: as it is stated, if that is not its value."""
    return formula.expression if formula.stated is None else formula.stated


def body(formula: Record, factor: Record | None = None, room: float = PAGE) -> str:
    """A formula as a displayed equation, a factor in it called by its name where it is given."""
    shown = right_side(formula) if factor is None else folded(right_side(formula), factor)
    return equation(formula.latex, shown, formula.vocabulary, formula.sum_sign, room)


def folded(expression: sp.Expr, formula: Record) -> sp.Expr:
    """An expression with a function of one argument in it called by its name: G(2 phi h)."""
    (argument,) = formula.expression.free_symbols
    called = sp.Function(formula.name)
    inner = {at.args[0] for at in expression.atoms(sp.sinh)}
    return expression.xreplace(
        {formula.expression.xreplace({argument: at}): called(at) for at in inner}
    )


def _rows(
    left: str, value: sp.Expr, vocabulary: Vocabulary, room: float, prefix: str = ""
) -> list[str]:
    """A left side and its sum in lines, which all but the first are indented."""
    begin = f"& {left} = "
    rows = [begin]
    for place, term in enumerate(_signed_terms(value, vocabulary)):
        text = term if place else prefix + term
        if typeset_width(rows[-1] + text) > room and rows[-1] != FURTHER:
            rows.append(FURTHER)
        rows[-1] += f" {text}"
    return rows


def in_parts(
    expression: sp.Expr, room: float, vocabulary: Vocabulary, whole: bool = False
) -> tuple[sp.Expr, list[tuple[sp.Symbol, sp.Expr]]]:
    """A formula whose terms can be read on a line each, and what the parts named in it are.

    With `whole` all of it is a part.
    """
    value = _expanded(expression)
    if not all(legible(term, vocabulary, room) for term in sp.Add.make_args(value)):
        value = expression
    symbols = (sp.Symbol(f"Z_{count}") for count in itertools.count(1))
    parts = list[tuple[sp.Symbol, sp.Expr]]()
    if whole:
        parts, value = [(next(symbols), value)], sp.Symbol("Z_1")
    values, place = [value, *(part for _, part in parts)], 0
    names: list[sp.Symbol] = [symbol for symbol, _ in parts]
    while place < len(values):
        chosen = _part(values[place], room, vocabulary)
        if chosen is None:
            place += 1
            continue
        names.append(next(symbols))
        for k, text in enumerate(values):
            values[k] = _replaced(text, chosen, names[-1])
        values.append(chosen)
    return values[0], list(zip(names, values[1:], strict=True))


def _replaced(value: sp.Expr, part: sp.Expr, symbol: sp.Symbol) -> sp.Expr:
    """A value with a part of it, or some factors of one of its terms, called by a name."""
    found = value.xreplace({part: symbol})
    if found != value or not part.is_Mul:
        return found
    factors = set(part.args)
    terms = [
        sp.Mul(symbol, *(f for f in term.args if f not in factors))
        if term.is_Mul and factors <= set(term.args)
        else term
        for term in sp.Add.make_args(value)
    ]
    return sp.Add(*terms)


def _part(value: sp.Expr, room: float, vocabulary: Vocabulary) -> sp.Expr | None:
    """What to name next in a value; nothing if all of its terms can be read on a line each."""
    wide = [t for t in sp.Add.make_args(value) if not legible(t, vocabulary, room)]
    if not wide:
        return None
    inner = [
        part
        for part in wide[0].atoms(sp.Add, sp.Mul, sp.Pow, sp.Function, sp.Sum, sp.Integral)
        if part != wide[0] and typeset_width(displayed(part, vocabulary)) >= LEAST_PART
    ]
    widths = {part: typeset_width(displayed(part, vocabulary)) for part in inner}
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
    """A product of powers multiplied out, which sums in roots and quotients do not gain by."""
    nested = any(not p.exp.is_Integer and p.base.is_Add for p in expression.atoms(sp.Pow))
    divided = any(p.exp.is_negative and p.base.is_Add for p in expression.atoms(sp.Pow))
    worse = nested or divided or expression.has(sp.Function, sp.Integral)
    return expression if worse else sp.expand(expression)


def _signed_terms(expression: sp.Add, vocabulary: Vocabulary) -> list[str]:
    """LaTeX of a sum's terms in printed order, each with its sign but the first's plus."""
    text: list[str] = []
    for term in expression.as_ordered_terms():
        negative = term.could_extract_minus_sign()
        sign = "-" if negative else "+" if text else ""
        text.append(f"{sign} {displayed(-term if negative else term, vocabulary)}")
    return text
