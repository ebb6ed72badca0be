"""Parse text in SymPy syntax into an expression by a whitelist, without executing it.

The text becomes a Python syntax tree, which is only read. The size of each operation is checked
before it is performed, so that no input can produce a huge number or power.
"""

import ast
import re
from collections.abc import Callable, Mapping, Set
from fractions import Fraction

import flint
import sympy as sp

from derivation.engine.formula.ball import enclose
from derivation.engine.formula.elementary import ELEMENTARY, INSTEAD, OTHER_NAMES
from derivation.engine.formula.size import degree
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.nearest import did_you_mean, one_of

MAX_TEXT = 20_000
MAX_NESTING = 50
MAX_DEPTH = 200
MAX_NODES = 6_000
MAX_DIGITS = 60
MAX_BITS = 512
MAX_EXPONENT = 100
MAX_CONSTANT_ARGUMENT = 10_000
MAX_ORDER = 10
MAX_DEGREE = 1000
"""Largest product of nested exponents: ((x + 1)**9 + 1)**9 has 81."""


class FormulaError(ValueError):
    """A formula or point that cannot be used; the message states what is expected, and a remedy."""


CONSTANTS: Mapping[str, sp.Basic] = {"pi": sp.pi, "EulerGamma": sp.EulerGamma}

NAME_HINTS = {
    "E": "E usually is Young's modulus, which has no meaning in this formula; "
    "for the number 2.718... write exp(1)",
    "e": "for powers of the number 2.718... write exp(...)",
    "I": "formulas are real: leave out the imaginary unit",
    "oo": "formulas are finite: leave out oo",
    "inf": "formulas are finite: leave out inf",
}

_HINTS = {
    "=": "'=' is not allowed: give only the right-hand side",
    "<": "a comparison is not a formula: give one expression",
    ">": "a comparison is not a formula: give one expression",
    "[": "square brackets are not used: write ( )",
    "]": "square brackets are not used: write ( )",
    "{": "braces belong to LaTeX: give it as LaTeX, or write ( )",
    "}": "braces belong to LaTeX: give it as LaTeX, or write ( )",
    "\\": "a backslash belongs to LaTeX, which only `diagnose` with --latex reads",
    "'": "quoted text is not part of a formula",
    '"': "quoted text is not part of a formula",
    ":": "':' is not part of a formula",
    "|": "write abs(...) for an absolute value",
    "!": "write factorial(n)",
}
_STRANGE = re.compile(r"[^A-Za-z0-9_.+\-*/^(), ]")
_NUMBER = re.compile(r"(\d+\.?\d*|\.\d+)(?:[eE]([+-]?\d+))?")


def parse(text: str, vocabulary: Vocabulary, also: Mapping[str, sp.Basic] | None = None) -> sp.Expr:
    """Return the expression for a text in SymPy syntax.

    Parameters
    ----------
    text
        The formula, such as ``-sinh(x)/(2*mu*(sinh(2*x) + 2*x))``. Decimal numbers are exact:
        ``0.1`` is 1/10. Powers may also be written with ``^``.
    vocabulary
        The symbols that may occur.
    also
        Further names that may occur, with their expressions.

    Raises
    ------
    FormulaError
        If the text contains anything but arithmetic in the allowed names and the functions of
        `FUNCTIONS`, or a number or power beyond the limits above.
    """
    plain = _checked(text)
    try:
        tree = ast.parse(plain, mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise FormulaError(
            f"expected one formula, got {_short(plain)}: {_syntax_hint(error)}"
        ) from None
    if sum(1 for _ in ast.walk(tree)) > MAX_NODES:
        raise FormulaError(f"the formula has more than {MAX_NODES} parts: split it")
    return _Reader(plain, vocabulary, also or {}).read(tree.body, 0)


def _syntax_hint(error: BaseException) -> str:
    if isinstance(error, SyntaxError) and error.offset is not None:
        if not error.offset:  # Python has read to the end
            return "it ends too early, for example with an operator; complete it"
        return f"it breaks off near character {error.offset}; check brackets and write every *"
    return "it is nested too deeply; write it with fewer brackets"


def _short(text: str) -> str:
    return repr(text if len(text) <= 60 else text[:57] + "...")


def _checked(text: str) -> str:
    """Return the text on one line, after checks of characters, length, nesting and numbers."""
    if not isinstance(text, str):
        raise FormulaError(f"expected a formula as text, got {type(text).__name__}")
    if len(text) > MAX_TEXT:
        raise FormulaError(f"expected at most {MAX_TEXT} characters, got {len(text)}: split it")
    plain = " ".join(text.split())
    if not plain:
        raise FormulaError("expected a formula, got empty text: write for instance sinh(x)")
    strange = _STRANGE.search(plain)
    if strange:
        mark = strange.group()
        hint = _HINTS.get(mark, f"the character {mark!r} is not part of a formula")
        raise FormulaError(f"expected a formula, got {_short(plain)}: {hint}")
    check_nesting(plain, "(", ")")
    if re.search(rf"\d{{{MAX_DIGITS + 1},}}", plain):
        raise FormulaError(f"expected numbers of at most {MAX_DIGITS} digits: shorten them")
    return re.sub(r"\blambda\b", "lam", plain.replace("^", "**"))


def check_nesting(text: str, opening: str, closing: str) -> None:
    """Reject brackets that are nested too deeply, or not in pairs.

    Raises
    ------
    FormulaError
        If there are such brackets.
    """
    depth = 0
    for mark in text:
        depth += (mark in opening) - (mark in closing)
        if depth > MAX_NESTING:
            raise FormulaError(f"expected at most {MAX_NESTING} nested brackets: leave some out")
        if depth < 0:
            break
    if depth:
        missing = opening[0] if depth < 0 else closing[0]
        raise FormulaError(f"expected brackets in pairs: add the missing {missing!r}")


class _Reader:
    """Builds the expression from a syntax tree, and rejects every unknown node."""

    def __init__(self, text: str, vocabulary: Vocabulary, also: Mapping[str, sp.Basic]) -> None:
        self.text = text
        self.vocabulary = vocabulary
        self.names = {**CONSTANTS, **also, **vocabulary.names}
        self.degrees: dict[sp.Basic, float] = {}

    def read(self, node: ast.expr, depth: int) -> sp.Expr:
        if depth > MAX_DEPTH:
            raise FormulaError(f"the formula is nested deeper than {MAX_DEPTH} levels: split it")
        expression = checked_expression(self._expression(node, depth + 1), self._source(node))
        if degree(expression, self.degrees) > MAX_DEGREE:
            raise FormulaError(
                f"expected nested powers of total degree up to {MAX_DEGREE}, "
                f"got {_short(self._source(node))}: lower the exponents"
            )
        return expression

    def _expression(self, node: ast.expr, depth: int) -> sp.Expr:
        if isinstance(node, ast.Constant):
            return number(self._source(node))
        if isinstance(node, ast.Name):
            return self._named(node.id)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.UAdd):
            value = self.read(node.operand, depth)
            return -value if isinstance(node.op, ast.USub) else value
        if isinstance(node, ast.BinOp):
            left, right = self.read(node.left, depth), self.read(node.right, depth)
            return self._arithmetic(node, left, right)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            return self._call(node.func.id, node, depth)
        raise FormulaError(
            f"expected numbers, names, + - * / ** and functions, got {_short(self._source(node))} "
            f"({type(node).__name__}): leave it out"
        )

    def _arithmetic(self, node: ast.BinOp, left: sp.Expr, right: sp.Expr) -> sp.Expr:
        if isinstance(node.op, ast.Add):
            return left + right
        if isinstance(node.op, ast.Sub):
            return left - right
        if isinstance(node.op, ast.Mult):
            return left * right
        if isinstance(node.op, ast.Div):
            if right == 0:
                raise FormulaError(f"division by zero in {_short(self._source(node))}: correct it")
            return left / right
        if isinstance(node.op, ast.Pow):
            return power(left, right, self.vocabulary.numbers)
        raise FormulaError(
            f"expected + - * / **, got the operator in {_short(self._source(node))}: leave it out"
        )

    def _named(self, name: str) -> sp.Expr:
        if name in self.names:
            return self.names[name]
        if OTHER_NAMES.get(name, name) in FUNCTIONS:
            raise FormulaError(f"expected an argument after {name}: write {name}(x)")
        hint = f"{NAME_HINTS[name]}; " if name in NAME_HINTS else did_you_mean(name, self.names)
        raise FormulaError(
            f"unknown name {_short(name)}: {hint}expected one of {one_of(sorted(self.names))}"
        )

    def _integral(self, node: ast.Call, depth: int) -> sp.Expr:
        """Return an integral over one variable, which may be a name that is not a symbol."""
        limits = node.args[1] if len(node.args) == 2 and not node.keywords else None
        if not (
            isinstance(limits, ast.Tuple)
            and len(limits.elts) == 3
            and isinstance(limits.elts[0], ast.Name)
        ):
            raise FormulaError(
                f"expected an integral with its variable and two limits, got "
                f"{_short(self._source(node))}: write Integral(f, (x, a, b))"
            )
        x, low, high = limits.elts[0].id, *(self._limit(end, depth) for end in limits.elts[1:])
        outer = self.names.get(x)
        variable = outer if isinstance(outer, sp.Symbol) else sp.Symbol(x, real=True)
        self.names[x] = variable
        function = self.read(node.args[0], depth)
        if outer is None:
            del self.names[x]
        else:
            self.names[x] = outer
        return sp.Integral(function, (variable, low, high))

    def _limit(self, node: ast.expr, depth: int) -> sp.Expr:
        infinite = {"oo": sp.oo, "+oo": sp.oo, "-oo": -sp.oo}.get(self._source(node))
        return self.read(node, depth) if infinite is None else infinite

    def _call(self, name: str, node: ast.Call, depth: int) -> sp.Expr:
        if name == "Integral":
            return self._integral(node, depth)
        name = OTHER_NAMES.get(name, name)
        if name not in FUNCTIONS:
            suggestion = did_you_mean(name, FUNCTIONS)
            allowed = f"{suggestion}expected one of {', '.join(sorted(FUNCTIONS))}"
            hint = f"write {name}*(...)" if name in self.names else INSTEAD.get(name, allowed)
            raise FormulaError(f"unknown function {_short(name)}: {hint}")
        count = 2 if name in _OF_TWO else 1
        if node.keywords or len(node.args) != count:
            instead = {"log": "; write log(x)/log(b)", "sqrt": "; write x**(1/n)"}.get(name, "")
            raise FormulaError(
                f"expected {name} with {count} plain argument{'s' * (count > 1)}, "
                f"got {_short(self._source(node))}{instead}"
            )
        arguments = [self.read(argument, depth) for argument in node.args]
        _check_constant(arguments[-1], name)
        result = FUNCTIONS[name](*arguments)
        return self.vocabulary.short.get(result, result)

    def _source(self, node: ast.expr) -> str:
        return self.text[node.col_offset : node.end_col_offset]


def number(literal: str) -> sp.Rational:
    """Return the exact value of a decimal literal."""
    match = _NUMBER.fullmatch(literal)
    if match is None:
        raise FormulaError(f"expected a decimal number, got {_short(literal)}: write it like 0.25")
    exponent = int(match.group(2) or 0)
    if abs(exponent) > MAX_EXPONENT:
        raise FormulaError(
            f"expected a power of ten within +-{MAX_EXPONENT}, got {_short(literal)}: rescale it"
        )
    value = Fraction(match.group(1)) * Fraction(10) ** exponent
    return sp.Rational(value.numerator, value.denominator)


def power(base: sp.Expr, exponent: sp.Expr, numbers: Set[sp.Symbol]) -> sp.Expr:
    """Return base**exponent, for a moderate rational exponent or one in dimensionless symbols.

    Raises
    ------
    FormulaError
        If the exponent is of another kind, or a number or an exponent is too large.
    """
    if base == sp.E:
        _check_constant(exponent, "exp")
        return sp.exp(exponent)
    if not exponent.is_number and exponent.free_symbols <= numbers:
        return base**exponent
    if isinstance(base, sp.Rational) and base > 0 and not exponent.is_number:
        return sp.exp(exponent * sp.log(base))
    if not isinstance(exponent, sp.Rational):
        raise FormulaError(
            f"expected a number as exponent, got {_short(str(exponent))}: "
            "write powers of 2.718... as exp(...)"
        )
    if base == 0 and exponent <= 0:
        raise FormulaError(f"0**({exponent}) has no value: correct the base or the exponent")
    for factor in sp.Mul.make_args(base):
        bits = _bits(factor) * abs(exponent) if isinstance(factor, sp.Rational) else 0
        _, inner = factor.as_base_exp()
        steep = abs(inner * exponent) if isinstance(inner, sp.Rational) else abs(exponent)
        if max(steep, exponent.q) > MAX_EXPONENT or bits > MAX_BITS:
            raise FormulaError(
                f"expected exponents up to {MAX_EXPONENT} and numbers below 2^{MAX_BITS}, "
                f"got {_short(str(base))} to the power {_short(str(exponent))}: lower it"
            )
    return base**exponent


def _bits(value: sp.Rational) -> int:
    return max(int(value.p).bit_length(), int(value.q).bit_length())


def checked_expression(expression: sp.Expr, source: str) -> sp.Expr:
    """Return the expression, if it is finite and real and its numbers are moderate.

    Raises
    ------
    FormulaError
        If it is not; the message contains the text `source`.
    """
    integrals = {node: sp.Dummy() for node in expression.atoms(sp.Integral)}
    expression = expression.xreplace(integrals)  # integrals may have infinite limits
    if expression.has(sp.zoo, sp.nan, sp.oo, -sp.oo):
        raise FormulaError(f"{_short(source)} divides by zero or has no value: correct it")
    if expression.has(sp.I):
        raise FormulaError(f"{_short(source)} is not real: check the sign under the root or log")
    for factor in sp.Mul.make_args(expression):
        _, exponent = factor.as_base_exp()
        steep = isinstance(exponent, sp.Rational) and abs(exponent) > MAX_EXPONENT
        if steep or (isinstance(factor, sp.Rational) and _bits(factor) > MAX_BITS):
            raise FormulaError(
                f"a number or power in {_short(source)} is out of range: "
                f"keep exponents up to {MAX_EXPONENT} and numbers below 2^{MAX_BITS}"
            )
    return expression.xreplace({mark: node for node, mark in integrals.items()})


def _check_constant(argument: sp.Expr, name: str) -> None:
    """Reject a function of a constant whose argument is too large to be evaluated quickly."""
    if not argument.is_number:
        return
    with flint.ctx.workprec(128):
        size = abs(enclose(argument, {}))
    if not size < MAX_CONSTANT_ARGUMENT:
        raise FormulaError(
            f"expected |argument| of {name} below {MAX_CONSTANT_ARGUMENT}, "
            f"got {_short(str(argument))}: lower it"
        )


def bessel(order: sp.Expr, argument: sp.Expr) -> sp.Expr:
    """Return J_n(argument) for a small integer order."""
    return sp.besselj(_order(order), argument)


def _order(order: sp.Expr) -> sp.Integer:
    """Return the order of a Bessel function, if it is a small integer."""
    if not isinstance(order, sp.Integer) or abs(order) > MAX_ORDER:
        raise FormulaError(
            f"expected a whole order of a Bessel function within +-{MAX_ORDER}, "
            f"got {_short(str(order))}"
        )
    return order


_OF_TWO = ("besselj", "besseli", "beta")
FUNCTIONS: Mapping[str, Callable[..., sp.Expr]] = {
    **ELEMENTARY,
    "Abs": sp.Abs,
    "abs": sp.Abs,
    "gamma": sp.gamma,
    "factorial": lambda number: sp.gamma(number + 1),
    "beta": sp.beta,
    "besselj": bessel,
    "besseli": lambda order, argument: sp.besseli(_order(order), argument),
    "I0": lambda argument: sp.besseli(0, argument),
    "I1": lambda argument: sp.besseli(1, argument),
    "J0": lambda argument: bessel(sp.Integer(0), argument),
    "J1": lambda argument: bessel(sp.Integer(1), argument),
}
"""Functions that a formula may call, by name."""
