"""A formula given as text: judged against the derived one, both evaluated at a point."""

from collections.abc import Mapping
from dataclasses import dataclass
from decimal import ROUND_HALF_EVEN, Context, Decimal
from fractions import Fraction

import flint
import sympy as sp

from derivation.formula.ball import PrecisionError, enclose, evaluate, to_ball
from derivation.formula.parse import NAMES, FormulaError, number, parse
from derivation.formula.parse_latex import parse_latex
from derivation.formula.record import Formula
from derivation.formula.symbols import BY_NAME
from derivation.paper.compare import (
    Diagnosis,
    comparable,
    diagnose,
    known_formula,
    relations_between,
)

MAX_DIGITS = 1000
_GUARD_DIGITS = (10, 100, 1000)
_MAX_BINARY_EXPONENT = 1 << 18
_ZERO_BITS = 8192

DEFAULT_POINT: Mapping[str, str] = {
    "r": "0.002",
    "z": "0.004",
    "phi": "24.048",
    "h": "0.01",
    "T": "0.48096",
    "b": "0.1",
    "R": "0.13",
    "a": "0.004",
    "lam": "0.36e9",
    "mu": "0.43e9",
    "P": "1000",
    "A_j": "-1e6",
    "J1": "0.5191",
    "C1": "-1e-4",
    "C2": "-2e-5",
    "C3": "3e-4",
    "C4": "2e-3",
    "eta": "0.1",
    "alpha": "0.04",
    "a_ratio": "0.4",
    "j_n": "2.4048",
    "eps": "0.4",
    "m": "72",
    "v0": "1",
    "t": "1e-3",
    "delta": "1e-4",
    "delta_0": "1e-4",
    "N": "100",
    "k": "2",
    "u_t": "0.5",
    **{f"kappa_{n}": "2" for n in range(0, 10, 2)},
    **{f"M_{k}": "1" for k in range(2, 7)},
    **{f"c_{n}": "0.1" for n in range(1, 10, 2)},
    **{f"D_{n}": "0.1" for n in range(3, 12, 2)},
    **{f"gamma_{k}": "1e-7" for k in range(2, 7)},
    **{f"xi_{k}": "1e7" for k in range(2, 7)},
}
"""Values for symbols that the caller leaves open: the paper's plate, its first mode."""


@dataclass(frozen=True)
class TextDiagnosis:
    """A diagnosis with both values at a point, as text.

    Parameters
    ----------
    diagnosis
        The comparison of the formulas themselves.
    point
        The values at which both were evaluated.
    given_value, derived_value
        Decimal values, every digit right.
    """

    diagnosis: Diagnosis
    point: tuple[tuple[str, str], ...]
    given_value: str
    derived_value: str

    @property
    def verdict(self) -> str:
        """``equal`` or ``different``."""
        return self.diagnosis.verdict

    @property
    def repair(self) -> str:
        """What mends the given formula, in a sentence."""
        return self.diagnosis.repair

    @property
    def ratio(self) -> sp.Expr | None:
        """Given over derived, where that is short."""
        return self.diagnosis.ratio

    def to_json(self) -> dict[str, object]:
        """Plain text under fixed keys."""
        more = self.diagnosis.to_json()
        return {
            "name": more["name"],
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
        """The comparison, and both values at the point."""
        at = ", ".join(f"{name} = {value}" for name, value in self.point)
        values = f"given {self.given_value}\n\nderived {self.derived_value}"
        return f"{self.diagnosis._repr_markdown_()}\n\nAt {at}:\n\n{values}"


def diagnose_text(
    name: str,
    text: str,
    formulas: Mapping[str, Formula],
    *,
    latex: bool = False,
    at: Mapping[str, str] | None = None,
    digits: int = 50,
) -> TextDiagnosis:
    """Judge a formula given as text; nothing in it is executed.

    Parameters
    ----------
    name
        Name of the derived formula it should equal.
    text
        The formula in SymPy syntax, or in LaTeX if `latex`. Names of other
        formulas of the chain (``K_j``, ``Omega_1``) stand for these.
    formulas
        The chain's formulas by name.
    at
        Exact decimal values of symbols; `DEFAULT_POINT` supplies the others.
    digits
        Significant digits of both values.

    Raises
    ------
    FormulaError
        For a name, formula, point or number of digits that cannot be used.
    """
    if not 1 <= digits <= MAX_DIGITS:
        raise FormulaError(f"expected 1 to {MAX_DIGITS} digits, got {digits}")
    formula = known_formula(name, formulas)
    chosen = _numbers(at or {})
    references = {n: sp.Symbol(n, real=True) for n in comparable(formulas) if n not in NAMES}
    given = (parse_latex if latex else parse)(text, {**NAMES, **references})
    diagnosis = diagnose(name, given, formulas)
    derived = formula.expression
    relations = relations_between(name, diagnosis.given, derived, formulas)
    _check_free(chosen, relations)
    sides = [side.subs(relations) for side in (diagnosis.given, derived)]
    names = sorted({s.name for side in sides for s in side.free_symbols})
    defaults = _numbers({n: DEFAULT_POINT[n] for n in names if n not in chosen})
    point = {n: (chosen | defaults)[n] for n in names}
    values = {BY_NAME[n].symbol: value for n, (_, value) in point.items()}
    shown = tuple((n, literal) for n, (literal, _) in point.items())
    where = ", ".join(f"{n} = {literal}" for n, literal in shown)
    given_value, derived_value = (_decimal(side, values, digits, where) for side in sides)
    return TextDiagnosis(diagnosis, shown, given_value, derived_value)


def _numbers(at: Mapping[str, str]) -> dict[str, tuple[str, Fraction]]:
    """The point's literals and exact values by symbol name."""
    result = {}
    for name, literal in at.items():
        symbol = NAMES.get("lam" if name == "lambda" else name)
        if symbol is None:
            raise FormulaError(f"unknown symbol {name!r:.40}: expected one of {', '.join(BY_NAME)}")
        bare = str(literal).strip()
        value = number(bare.lstrip("+-") if bare[:1] in ("+", "-") else bare)
        sign = -1 if bare.startswith("-") else 1
        result[symbol.name] = bare, sign * Fraction(int(value.p), int(value.q))
    return result


def _check_free(
    chosen: Mapping[str, tuple[str, Fraction]], relations: Mapping[sp.Symbol, sp.Expr]
) -> None:
    for symbol, meaning in relations.items():
        if symbol.name in chosen:
            raise FormulaError(
                f"{symbol} follows from {', '.join(sorted(map(str, meaning.free_symbols)))} here: "
                f"leave it out of the point"
            )


def _decimal(
    expression: sp.Expr, values: Mapping[sp.Symbol, Fraction], digits: int, where: str
) -> str:
    """Value of an expression, correctly rounded to so many significant digits."""
    try:
        for guard in _GUARD_DIGITS:
            ball = evaluate(expression, values, digits + guard)
            middle, radius = _fraction(ball.mid()), _fraction(ball.rad())
            ends = {_round(end, digits) for end in (middle - radius, middle + radius)}
            if len(ends) == 1:
                return ends.pop()
    except PrecisionError:
        return _zero_or_singular(expression, values, where)
    # A tie as far as a thousand further digits tell: the value itself is half-way.
    return _round(middle, digits)


def _round(value: Fraction, digits: int) -> str:
    context = Context(prec=digits, rounding=ROUND_HALF_EVEN, Emax=10**9, Emin=-(10**9))
    return str(context.divide(Decimal(value.numerator), Decimal(value.denominator)))


def _fraction(point: flint.arb) -> Fraction:
    mantissa, exponent = point.man_exp()
    if abs(int(exponent)) > _MAX_BINARY_EXPONENT:
        raise FormulaError("the value is out of all proportion: choose another point")
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


def _zero_or_singular(expression: sp.Expr, values: Mapping[sp.Symbol, Fraction], where: str) -> str:
    """``0`` for a value that 8192 bits cannot tell from zero; otherwise there is none."""
    with flint.ctx.workprec(_ZERO_BITS):
        ball = enclose(expression, {symbol: to_ball(value) for symbol, value in values.items()})
    if ball.is_finite() and ball.contains(0):
        return "0"
    raise FormulaError(f"{expression!s:.80} has no real value at {where}: choose another point")
