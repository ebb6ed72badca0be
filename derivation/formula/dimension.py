"""Physical dimensions: units, and the dimension of a SymPy expression found term by term."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

import sympy as sp


class DimensionError(ValueError):
    """An expression adds, exponentiates or feeds to a function what it must not."""


@dataclass(frozen=True)
class Dimension:
    """Exponents of length, mass and time."""

    length: Fraction = Fraction(0)
    mass: Fraction = Fraction(0)
    time: Fraction = Fraction(0)

    def __mul__(self, other: "Dimension") -> "Dimension":
        return Dimension(self.length + other.length, self.mass + other.mass, self.time + other.time)

    def __pow__(self, exponent: Fraction | int) -> "Dimension":
        return Dimension(self.length * exponent, self.mass * exponent, self.time * exponent)

    def __truediv__(self, other: "Dimension") -> "Dimension":
        return self * other**-1

    def __str__(self) -> str:
        exponents = (("m", self.length), ("kg", self.mass), ("s", self.time))
        return " ".join(f"{u}^{e}" if e != 1 else u for u, e in exponents if e) or "1"


ONE = Dimension()
LENGTH = Dimension(length=Fraction(1))
MASS = Dimension(mass=Fraction(1))
TIME = Dimension(time=Fraction(1))
FORCE = MASS * LENGTH / TIME**2
STRESS = FORCE / LENGTH**2

UNITS = {
    "1": ONE,
    "m": LENGTH,
    "m^2": LENGTH**2,
    "m^3": LENGTH**3,
    "1/m": LENGTH**-1,
    "N": FORCE,
    "J": FORCE * LENGTH,
    "W": FORCE * LENGTH / TIME,
    "Pa": STRESS,
    "Pa/m": STRESS / LENGTH,
    "m/Pa": LENGTH / STRESS,
    "1/Pa": STRESS**-1,
    "1/m^2": LENGTH**-2,
    "kg": MASS,
    "kg/m^3": MASS / LENGTH**3,
    "s": TIME,
    "1/s": TIME**-1,
    "m/s": LENGTH / TIME,
    "m/s^2": LENGTH / TIME**2,
    "m^2/s^2": LENGTH**2 / TIME**2,
}


def thirds(base: str, count: int) -> str:
    """A unit or symbol to the power count/3, as text: ``m``, ``m^(5/3)``, ``m^3``."""
    power = Fraction(count, 3)
    if power == 1:
        return base
    return f"{base}^{power}" if power.denominator == 1 else f"{base}^({power})"


UNITS |= {f"m/{thirds('N', n)}": LENGTH / FORCE ** Fraction(n, 3) for n in range(3, 12, 2)}
UNITS |= {f"N/{thirds('m', n)}": FORCE / LENGTH ** Fraction(n, 3) for n in range(3, 12, 2)}


def dimension(expression: sp.Basic, known: Mapping[sp.Basic, Dimension]) -> Dimension:
    """Dimension of an expression whose symbols (and undefined functions) are in `known`.

    Raises
    ------
    DimensionError
        Where unlike dimensions are added, or an exponent or a function's
        argument is not a pure number. The message names the offending part.
    """
    if expression in known:
        return known[expression]
    if expression.is_number:
        return ONE
    if isinstance(expression, sp.Add):
        return _of_sum(expression, known)
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
        # A variable of integration that is no symbol of the paper is a pure number.
        variables = {v: known.get(v, ONE) for v in expression.variables}
        result = dimension(expression.function, {**known, **variables})
        for variable in expression.variables:
            result = result * variables[variable]
        return result
    if isinstance(expression, sp.Function | sp.Pow) and expression.args:
        for argument in expression.args:
            found = dimension(argument, known)
            if found != ONE:
                raise DimensionError(
                    f"{argument} in {expression} has dimension [{found}], expected a pure number"
                )
        return ONE
    raise DimensionError(f"the dimension of {expression} is not known")


def _of_sum(expression: sp.Add, known: Mapping[sp.Basic, Dimension]) -> Dimension:
    first, *rest = expression.args
    expected = dimension(first, known)
    for term in rest:
        found = dimension(term, known)
        if found != expected:
            raise DimensionError(
                f"in {expression} the terms {first} [{expected}] and {term} [{found}] are added"
            )
    return expected
