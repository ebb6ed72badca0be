"""Formulas as displayed equations: long sums in lines, what would be too small beside them."""

from collections.abc import Callable

import sympy as sp

from derivation.engine.formula.notation import PaperPrinter
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.report.width import typeset_width

LINE_WIDTH = 70
"""Characters, as typeset, after which a sum is broken."""
DEEPEST = 2
"""Fractions within each other, beyond which they are too small to read."""
SHORT = 15
"""Characters of a fraction that is written with a slash inside another one."""
LEAST_PART, MOST_PARTS = 8, 8
"""Characters of a part worth a name; how many parts are named at most."""
LONG_LEFT = 28
"""Characters of a left side from which the right one begins a line of its own."""


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


def displayed(expression: sp.Basic, vocabulary: Vocabulary) -> str:
    """LaTeX of an expression for a line of its own."""
    return str(Displayed(vocabulary).doprint(expression))


def legible(expression: sp.Expr, vocabulary: Vocabulary, room: float = LINE_WIDTH) -> bool:
    """Whether an expression fits a line, and its fractions can be read."""
    printer = Displayed(vocabulary)
    return typeset_width(printer.doprint(expression)) <= room and printer.deepest <= DEEPEST


def equation(left: str, expression: sp.Expr, vocabulary: Vocabulary, prefix: str = "") -> str:
    """Body of a displayed equation, in as many lines as it needs."""
    begin = f"{left} = {prefix}"
    room = LINE_WIDTH - typeset_width(begin)
    if legible(expression, vocabulary, room):
        return begin + displayed(expression, vocabulary)
    value = expression if isinstance(expression, sp.Add) else _expanded(expression)
    if isinstance(value, sp.Add) and all(legible(term, vocabulary) for term in value.args):
        return _aligned(_rows(begin, value, vocabulary))
    value, parts = in_parts(expression, room, vocabulary)
    rows = _rows(begin, value, vocabulary)
    for symbol, part in parts:
        rows += _rows(f"{symbol} = ", part, vocabulary)
    return _aligned(rows)


def right_side(formula: Record) -> sp.Expr:
    """What is shown of a formula: as it is stated, if that is not its value."""
    return formula.expression if formula.stated is None else formula.stated


def body(formula: Record, factor: Record | None = None) -> str:
    """A formula as a displayed equation, a factor in it called by its name where it is given."""
    shown = right_side(formula) if factor is None else folded(right_side(formula), factor)
    return equation(formula.latex, shown, formula.vocabulary, formula.sum_sign)


def folded(expression: sp.Expr, formula: Record) -> sp.Expr:
    """An expression with a function of one argument in it called by its name: G(2 phi h)."""
    (argument,) = formula.expression.free_symbols
    called = sp.Function(formula.name)
    inner = {at.args[0] for at in expression.atoms(sp.sinh)}
    return expression.xreplace(
        {formula.expression.xreplace({argument: at}): called(at) for at in inner}
    )


def _aligned(rows: list[str]) -> str:
    return r"\begin{aligned}" + " \\\\\n".join(rows) + r"\end{aligned}"


def _rows(begin: str, value: sp.Expr, vocabulary: Vocabulary) -> list[str]:
    """A left side and its sum in lines; any other value too wide for one is scaled down."""
    rows = [f"{begin.replace('=', '= {}&', 1)} "]
    if typeset_width(begin) > LONG_LEFT:
        rows.append(r"& \quad ")
    if not isinstance(value, sp.Add):
        rows[-1] += rf"\fit[0.8]{{{displayed(value, vocabulary)}}}"
        return rows
    for index, term in enumerate(_signed_terms(value, vocabulary)):
        if index and typeset_width(rows[-1] + term) > LINE_WIDTH:
            rows.append(r"& \quad ")
        rows[-1] += f" {term}"
    return rows


def in_parts(
    expression: sp.Expr, room: float, vocabulary: Vocabulary
) -> tuple[sp.Expr, list[tuple[sp.Symbol, sp.Expr]]]:
    """A formula with parts named, Z_1, Z_2 ..., and what these are, until it can be read."""
    value, parts = expression, list[tuple[sp.Symbol, sp.Expr]]()
    while not legible(value, vocabulary, room) and len(parts) < MOST_PARTS:
        inner = [part for part in value.atoms(sp.Add, sp.Sum, sp.Integral) if part != value]
        widths = {part: typeset_width(displayed(part, vocabulary)) for part in inner}
        fit = [part for part in inner if widths[part] >= LEAST_PART and legible(part, vocabulary)]
        long = [
            part
            for part in inner
            if part.is_Add and all(legible(term, vocabulary) for term in part.args)
        ]
        if not fit + long:
            break
        ranked = sorted(fit or long, key=lambda p: (widths[p], sp.default_sort_key(p)))
        chosen = ranked[-1 if fit else 0]
        symbol = sp.Symbol(f"Z_{len(parts) + 1}")
        value = value.xreplace({chosen: symbol})
        parts.append((symbol, chosen))
    return value, parts


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
