"""Physical dimensions of units and of SymPy expressions."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from operator import add

import sympy as sp


class DimensionError(ValueError):
    """An error in dimensions; the message states the part of the expression."""


@dataclass(frozen=True)
class Dimension:
    """Exponents of length, mass, time, temperature, electric current and amount of substance."""

    length: Fraction = Fraction(0)
    mass: Fraction = Fraction(0)
    time: Fraction = Fraction(0)
    temperature: Fraction = Fraction(0)
    current: Fraction = Fraction(0)
    amount: Fraction = Fraction(0)

    @property
    def exponents(self) -> tuple[Fraction, ...]:
        """All exponents, in the order of the fields."""
        # `dataclasses.astuple` would copy each number, which takes ten times as long.
        return self.length, self.mass, self.time, self.temperature, self.current, self.amount

    def __mul__(self, other: "Dimension") -> "Dimension":
        return Dimension(*map(add, self.exponents, other.exponents))

    def __pow__(self, exponent: Fraction | int) -> "Dimension":
        return Dimension(*(power * exponent for power in self.exponents))

    def __truediv__(self, other: "Dimension") -> "Dimension":
        return self * other**-1

    def __str__(self) -> str:
        exponents = zip(("m", "kg", "s", "K", "A", "mol"), self.exponents, strict=True)
        return " ".join(f"{u}^{e}" if e != 1 else u for u, e in exponents if e) or "1"


ONE = Dimension()
LENGTH = Dimension(length=Fraction(1))
MASS = Dimension(mass=Fraction(1))
TIME = Dimension(time=Fraction(1))
TEMPERATURE = Dimension(temperature=Fraction(1))
CURRENT = Dimension(current=Fraction(1))
AMOUNT = Dimension(amount=Fraction(1))
FORCE = MASS * LENGTH / TIME**2
STRESS = FORCE / LENGTH**2
POWER = FORCE * LENGTH / TIME

BASE = {
    "1": ONE,
    "rad": ONE,
    "m": LENGTH,
    "kg": MASS,
    "s": TIME,
    "N": FORCE,
    "J": FORCE * LENGTH,
    "W": POWER,
    "Pa": STRESS,
    "Hz": TIME**-1,
    "K": TEMPERATURE,
    "A": CURRENT,
    "V": POWER / CURRENT,
    "C": CURRENT * TIME,
    "F": (CURRENT * TIME) ** 2 / (FORCE * LENGTH),
    "mol": AMOUNT,
}
"""Dimensions of the units from which others are composed."""

_FACTOR = re.compile(r"(1|[A-Za-z]+)(?:\^(?:(\d+)|\((\d+/\d+)\)))?")
_SLASH = re.compile(r"/(?!\d+\))")


@cache
def unit(text: str) -> Dimension:
    """Return the dimension of a unit: factors with powers, and at most one slash before a divisor.

    A divisor of several factors needs brackets: ``m/N^(5/3)``, ``kg m/s^2``, ``J/(kg m)``.

    Raises
    ------
    ValueError
        If the text is not such a unit.
    """
    above, *below = _SLASH.split(text)
    sides = [_product(above), *(_below(side) for side in below)]
    if None in sides or len(sides) > 2:
        raise ValueError(
            f"expected a unit like m/N^(5/3) or J/(kg m), got {text!r:.40}; "
            f"use the units {', '.join(BASE)}"
        )
    first, *others = (side for side in sides if side is not None)
    return first / others[0] if others else first


def _below(text: str) -> Dimension | None:
    """Return the dimension of a factor, or of several in brackets; None if one is not a unit."""
    held = text.startswith("(") and text.endswith(")")
    return _product(text[1:-1]) if held else _factor(text)


def _product(text: str) -> Dimension | None:
    """Return the dimension of factors separated by spaces; None if one is not a unit."""
    product = ONE
    for part in text.split(" "):
        factor = _factor(part)
        if factor is None:
            return None
        product = product * factor
    return product


def _factor(text: str) -> Dimension | None:
    """Return the dimension of a unit with its power; None if it is not a unit."""
    match = _FACTOR.fullmatch(text)
    if match is None or match[1] not in BASE:
        return None
    return BASE[match[1]] ** Fraction(match[2] or match[3] or 1)


def thirds(base: str, count: int) -> str:
    """Return a unit or symbol to the power count/3, as text: ``m``, ``m^(5/3)``, ``m^3``."""
    power = Fraction(count, 3)
    if power == 1:
        return base
    return f"{base}^{power}" if power.denominator == 1 else f"{base}^({power})"


def dimension(expression: sp.Basic, known: Mapping[sp.Basic, Dimension]) -> Dimension:
    """Return the dimension of an expression of symbols (and undefined functions) in `known`.

    Raises
    ------
    DimensionError
        If terms of different dimensions are added, an exponent or a function's argument is not
        dimensionless, or the dimension of a symbol is unknown. The message states the part.
    """
    if expression in known:
        return known[expression]
    if expression.is_number:
        return ONE
    if isinstance(expression, sp.Add | sp.Min | sp.Max):
        return _of_sum(expression, known)
    if isinstance(expression, sp.Abs):
        return dimension(expression.args[0], known)
    if isinstance(expression, sp.Mul):
        result = ONE
        for factor in expression.args:
            result = result * dimension(factor, known)
        return result
    if isinstance(expression, sp.Pow) and isinstance(expression.exp, sp.Rational):
        return dimension(expression.base, known) ** Fraction(expression.exp.p, expression.exp.q)
    if isinstance(expression, sp.Derivative):
        result = dimension(expression.expr, known)
        for variable, count in expression.variable_count:
            result = result / dimension(variable, known) ** int(count)
        return result
    if isinstance(expression, sp.Sum):
        indices = dict.fromkeys(expression.variables, ONE)
        return dimension(expression.function, {**known, **indices})
    if isinstance(expression, sp.Integral):
        return _of_integral(expression, known)
    if isinstance(expression, sp.Function | sp.Pow) and expression.args:
        for argument in expression.args:
            term_dimension = dimension(argument, known)
            if term_dimension != ONE:
                remedy = "; write log(a) - log(b) as log(a/b)" if expression.func == sp.log else ""
                raise DimensionError(
                    f"{argument} in {expression} has dimension [{term_dimension}], "
                    f"expected a pure number{remedy}"
                )
        return ONE
    raise DimensionError(f"the dimension of {expression} is not known")


def _of_integral(expression: sp.Integral, known: Mapping[sp.Basic, Dimension]) -> Dimension:
    """Return the dimension of an integral; a new variable has the dimension of its limits."""
    variables: dict[sp.Basic, Dimension] = {}
    for variable, *limits in reversed(expression.limits):  # limits contain outer variables
        own = known.get(variable)
        for limit in limits:
            if limit.is_number and (limit == 0 or limit.is_infinite):
                continue
            expected = dimension(limit, {**known, **variables})
            if own not in (None, expected):
                raise DimensionError(
                    f"the limit {limit} [{expected}] of {expression} is not like {variable} [{own}]"
                )
            own = expected
        variables[variable] = own or ONE
    try:
        result = dimension(expression.function, {**known, **variables})
    except DimensionError as error:
        names = ", ".join(str(v) for v in variables if v not in known and variables[v] == ONE)
        hint = f"; {names} counts as a pure number: give it a unit, as a symbol of the paper"
        raise DimensionError(f"{error}{hint if names else ''}") from None
    for own in variables.values():
        result = result * own
    return result


def _of_sum(expression: sp.Expr, known: Mapping[sp.Basic, Dimension]) -> Dimension:
    """Return the dimension that all terms of a sum, a minimum or a maximum have in common."""
    first, *rest = expression.args
    expected = dimension(first, known)
    for term in rest:
        term_dimension = dimension(term, known)
        if term_dimension != expected:
            raise DimensionError(
                f"in {expression} the terms {first} [{expected}] and {term} [{term_dimension}] "
                f"are {'added' if expression.is_Add else 'compared'}"
            )
    return expected
