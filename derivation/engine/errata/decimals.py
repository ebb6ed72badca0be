"""Decimal numbers in a formula: which are rounded correctly, which are wrong, and by how much.

Each decimal number becomes an unknown. Both formulas are sums of products of symbols; equal
products have equal coefficients, which are linear equations for the unknowns.
"""

from collections import defaultdict
from collections.abc import Iterator

import sympy as sp

from derivation.engine.errata.repairs import Repair
from derivation.engine.formula.ball import PrecisionError, evaluate

ROUNDED, NUMBER = "rounded number", "wrong number"
PRECISION = 25
"""Digits to which exact numbers are evaluated."""
DIGITS = 6
"""Significant digits of a correct number in a message, at least."""
MOST_OPERATIONS = 400
"""Size of a formula up to which its products are expanded."""


def decimal_corrections(given: sp.Expr, derived: sp.Expr) -> Iterator[Repair]:
    """Yield the formula with exact numbers in place of decimal ones, if they follow uniquely."""
    numbers = sorted(number for number in given.atoms(sp.Rational) if _is_decimal(number))
    if not numbers or given.count_ops() + derived.count_ops() > MOST_OPERATIONS:
        return
    unknown = {number: sp.Dummy(f"n{i}", real=True) for i, number in enumerate(numbers)}
    with_unknowns = given.xreplace(unknown)
    there, wanted = (_coefficients(x, given.free_symbols) for x in (with_unknowns, derived))
    equations = [there[key] - wanted[key] for key in dict.fromkeys((*there, *wanted))]
    try:
        solutions = sp.linsolve(equations, *unknown.values())
    except ValueError:  # not linear
        return
    if not solutions or sp.Tuple(*solutions).free_symbols:
        return
    exact = dict(zip(numbers, next(iter(solutions)), strict=True))
    changed = {number: value for number, value in exact.items() if value != number}
    try:
        values = [(number, _value(value)) for number, value in changed.items()]
    except (PrecisionError, NotImplementedError):
        return
    says = [_comparison(number, value) for number, value in values]
    kind = ROUNDED if all(_is_rounded(number, value) for number, value in values) else NUMBER
    corrected = given.xreplace(changed)
    yield Repair(kind, "; ".join(says), corrected, len(changed))


def _coefficients(expression: sp.Expr, symbols: set[sp.Basic]) -> dict[sp.Expr, sp.Expr]:
    """Return the coefficients of an expanded expression, by products of the symbols."""
    total: dict[sp.Expr, sp.Expr] = defaultdict(lambda: sp.Integer(0))
    for term in sp.Add.make_args(sp.expand(expression)):
        number, product = term.as_independent(*symbols, as_Add=False)
        total[sp.powdenest(product, force=True)] += number
    return total


def _is_decimal(number: sp.Rational) -> bool:
    """Return whether a number has finitely many decimals and is no simple fraction."""
    return bool(number.q % 5 == 0 and set(sp.primefactors(number.q)) <= {2, 5})


def _unit(number: sp.Rational) -> sp.Rational:
    """Return the unit of the last decimal of a number."""
    places = max(sp.multiplicity(5, number.q), sp.multiplicity(2, number.q))
    return sp.Rational(1, 10**places)


def _value(exact: sp.Expr) -> sp.Rational:
    """Return a number to `PRECISION` digits."""
    if exact == 0:
        return exact
    return sp.Rational(evaluate(exact, {}, PRECISION).mid().str(PRECISION, radius=False))


def _is_rounded(number: sp.Rational, exact: sp.Rational) -> bool:
    return bool(abs(exact - number) <= _unit(number) / 2)


def _comparison(number: sp.Rational, exact: sp.Rational) -> str:
    """Return a decimal number, the exact one, and whether it is rounded or how far it is off."""
    text, value = repr(float(number)), sp.N(exact, max(len(str(number.p)) + 2, DIGITS))
    if _is_rounded(number, exact):
        return f"{text} is the correctly rounded {value}"
    off = number / exact - 1 if exact != 0 else sp.oo
    return f"read {value} instead of {text}, which is off by {float(100 * off):+.2g} %"
