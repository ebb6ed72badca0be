"""Oracle 1: the theory's original expressions in ball arithmetic, at doubles taken as they are."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cache

import flint
import sympy as sp

from derivation.formula import symbols
from derivation.formula.ball import LOG2_10, MAX_BITS, SPARE_BITS, PrecisionError
from derivation.formula.record import Formula
from derivation.reference import moments
from derivation.reference.tape import Tape, record
from derivation.reference.zeros import j0_zero, j1_at_zero, j1_zero
from derivation.theory.chain import derive
from derivation.theory.equilibrium import BESSEL_J1
from derivation.theory.face_conditions import loaded

FLOOR = flint.arb(2) ** -1200
"""A ball inside +-2^-1200 is returned as zero.

The smallest double is 2^-1074: to whatever a computed double is compared, a
value below the floor and zero are the same. No ball around an exact zero can be
relatively small, so this is also how exact zeros are recognised, without a guess.
"""

SLOPE_BITS = 20
"""Accuracy asked of the sensitivities, which only set allowances."""

_x = sp.Symbol("x", real=True)
_BESSEL = {"bessel_j0": sp.besselj(0, _x), "bessel_j1": sp.besselj(1, _x)}
_BY_INDEX: dict[str, tuple[str, Callable[[int, int], flint.arb]]] = {
    "bessel_j0_zeros": ("count", j0_zero),
    "bessel_j1_zeros": ("count", j1_zero),
    "bessel_j1_at_j0_zeros": ("count", j1_at_zero),
    "kappa": ("n", moments.kappa),
    "kappa_ratio": ("n", moments.kappa_ratio),
    "finite_part": ("k", moments.finite_part),
    "finite_part_ratio": ("k", moments.finite_part_ratio),
}
"""Numbers by index: the argument's name and the ball at so many bits.

Of a table the number is the entry that `count` of them end with.
"""

_OF_MODE = (symbols.phi, symbols.J1)


@dataclass(frozen=True)
class Reference:
    """A formula's true value at a point, and what its arguments' rounding does to it.

    Parameters
    ----------
    value
        Ball around the value.
    sensitivity
        |x_i df/dx_i| by argument. For a modal sum these are added over the
        modes; b acts through phi = j_n/b too, and phi and J1 stand among the
        arguments for j_n and J1(j_n), which a kernel reads from a table.
    magnitude
        |value|, or for a modal sum the sum of its modes' magnitudes.
    """

    value: flint.arb
    sensitivity: Mapping[str, flint.arb]
    magnitude: flint.arb

    @property
    def total(self) -> flint.arb:
        """Sum of the sensitivities."""
        return sum(self.sensitivity.values(), flint.arb(0))

    @property
    def condition(self) -> dict[str, float]:
        """Condition number by argument; infinite (or NaN for 0/0) where the value is zero."""
        if self.value == 0:
            return {n: float("inf") if s > 0 else float("nan") for n, s in self.sensitivity.items()}
        return {n: float((s / abs(self.value)).mid()) for n, s in self.sensitivity.items()}


@dataclass(frozen=True)
class _Program:
    """A formula's tape, the one for r = 0 if it differs, and whether it is summed."""

    tape: Tape
    on_axis: Tape | None
    summed: bool


def names() -> tuple[str, ...]:
    """Every name `reference` knows: closed formulas of the chain, Bessel functions, numbers."""
    chain = _chain().items()
    closed = (n for n, f in chain if not f.expression.atoms(sp.Derivative))
    return (*closed, *_BESSEL, *_BY_INDEX)


def arguments(name: str) -> tuple[str, ...]:
    """Arguments of a formula, without the phi and J1 that a modal sum supplies itself."""
    if name in _BY_INDEX:
        return (_BY_INDEX[name][0],)
    program = _program(name)
    own = _OF_MODE if program.summed else ()
    return tuple(str(symbol) for symbol in program.tape.inputs if symbol not in own)


def is_summed(name: str) -> bool:
    """Whether a formula is a sum over the modes."""
    return name not in _BY_INDEX and _program(name).summed


def truth(
    name: str, values: Mapping[str, float], digits: int = 50, modes: int | None = None
) -> flint.arb:
    """Ball around a formula's value, its relative radius below 10^-digits.

    Parameters
    ----------
    name
        Formula of the chain, a Bessel function or a number by index; of a
        table of zeros the truth is the entry of index `count`.
    values
        Its arguments by name, doubles taken as the binary fractions they are.
        Arguments of the notation that the formula does not depend on are allowed.
    digits
        Decimal digits the radius must warrant.
    modes
        For a modal sum, and only then: how many modes.

    Raises
    ------
    PrecisionError
        At a singular point; the contact's edge r = a is one for the pressure,
        whose root a ball cannot take there.
    ValueError
        If `modes` is missing or out of place.
    KeyError
        For an unknown formula, and for missing or unknown arguments.
    """
    return _refined(name, values, digits, modes, slopes=False).value


def reference(
    name: str, values: Mapping[str, float], digits: int = 50, modes: int | None = None
) -> Reference:
    """Value and sensitivities together, see `truth`; every slope must be finite too."""
    return _refined(name, values, digits, modes, slopes=True)


def _refined(
    name: str, values: Mapping[str, float], digits: int, modes: int | None, slopes: bool
) -> Reference:
    _check(name, values, modes)
    if name in _BY_INDEX:
        return _by_index(name, values, digits)
    program = _program(name)
    tape = program.on_axis if program.on_axis and values["r"] == 0 else program.tape

    def compute(bits: int) -> Reference:
        known = {key: flint.arb(value) for key, value in values.items()}
        if modes is None:
            return _at(tape, known, slopes)
        zeros = range(1, modes + 1)
        return _added(_at(tape, known | _mode(j, known["b"], bits), slopes, True) for j in zeros)

    return _refine(compute, digits, f"{name} at {dict(values)}")


def _refine(compute: Callable[[int], Reference], digits: int, what: str) -> Reference:
    """Repeat at doubled precision until value and sensitivities are narrow; NaN never is."""
    target = int(digits * LOG2_10) + 1
    bits = target + SPARE_BITS
    while bits <= MAX_BITS:
        with flint.ctx.workprec(bits):
            found = compute(bits)
            unit = abs(found.value) * flint.arb(2) ** -SLOPE_BITS
            shares = found.sensitivity.values()
            if _is_narrow(found.value, target) and all(
                _is_narrow(share, SLOPE_BITS) or bool(share < unit) for share in shares
            ):
                value = flint.arb(0) if abs(found.value) < FLOOR else found.value
                return Reference(value, found.sensitivity, found.magnitude)
        bits *= 2
    raise PrecisionError(f"no {digits} digits of {what:.300} within {MAX_BITS} bits")


def _is_narrow(ball: flint.arb, bits: int) -> bool:
    """Whether a ball is finite, and relatively narrow or below the floor."""
    return ball.is_finite() and (ball.rel_accuracy_bits() >= bits or bool(abs(ball) < FLOOR))


def _at(
    tape: Tape, known: Mapping[str, flint.arb], slopes: bool, of_plate: bool = False
) -> Reference:
    """Value and sensitivities of one term at the precision now set.

    For a mode of a plate, phi = j_n/b makes b act through phi as well.
    """
    keys = [str(symbol) for symbol in tape.inputs]
    inputs = [known[key] for key in keys]
    slots = tape.run(inputs)
    gradient = tape.gradient(slots) if slopes else []
    shares = {k: x * g for k, x, g in zip(keys, inputs, gradient, strict=False)}
    if of_plate and slopes:
        shares["b"] -= shares["phi"]
    sizes = {key: abs(share) for key, share in shares.items()}
    return Reference(slots[-1], sizes, abs(slots[-1]))


def _added(terms: Iterable[Reference]) -> Reference:
    """The sum: values add with their signs, sensitivities without."""
    value, magnitude, shares = flint.arb(0), flint.arb(0), dict[str, flint.arb]()
    for term in terms:
        value += term.value
        magnitude += term.magnitude
        for key, share in term.sensitivity.items():
            shares[key] = shares.get(key, flint.arb(0)) + share
    return Reference(value, shares, magnitude)


def _by_index(name: str, values: Mapping[str, float], digits: int) -> Reference:
    """The number of an index, which is exact: certified to more bits than are asked."""
    argument, number = _BY_INDEX[name]
    if values[argument] != int(values[argument]):
        raise ValueError(f"{name} is counted in whole numbers, got {values[argument]}")
    ball = number(int(values[argument]), int(digits * LOG2_10) + SPARE_BITS)
    return Reference(ball, {}, abs(ball))


def _mode(j: int, b: flint.arb, bits: int) -> dict[str, flint.arb]:
    return {"phi": j0_zero(j, bits) / b, "J1": j1_at_zero(j, bits)}


def _check(name: str, values: Mapping[str, float], modes: int | None) -> None:
    summed = is_summed(name)
    if summed and (modes is None or modes < 1):
        raise ValueError(f"{name} is a modal sum: say over how many modes, got {modes}")
    if not summed and modes is not None:
        raise ValueError(f"{name} is no modal sum, got modes={modes}")
    missing = set(arguments(name)) - set(values)
    unknown = set(values) - set(arguments(name)) - set(symbols.BY_NAME)
    if missing or unknown:
        raise KeyError(
            f"{name} takes {', '.join(arguments(name))}; "
            f"missing: {sorted(missing)}, unknown: {sorted(unknown)}"
        )


@cache
def _chain() -> dict[str, Formula]:
    return derive()


@cache
def _program(name: str) -> _Program:
    """The formula's expression on tape, with the constants that the load gives to a mode."""
    if name in _BESSEL:
        return _Program(record(_BESSEL[name], (_x,)), None, summed=False)
    chain = _chain()
    if name not in chain:
        raise KeyError(f"no formula {name!r}; there are {', '.join(names())}")
    formula = chain[name]
    expression = formula.expression
    if formula.summed:
        expression = loaded(expression).subs(symbols.A_j, chain["A_j"].expression)
    inputs = tuple(argument.symbol for argument in symbols.arguments_of(expression))
    on_axis = record(_limit_on_axis(expression), inputs) if _over_radius(expression) else None
    return _Program(record(expression, inputs), on_axis, formula.summed)


def _over_radius(expression: sp.Expr) -> bool:
    return any(power.base == symbols.r and power.exp < 0 for power in expression.atoms(sp.Pow))


def _limit_on_axis(expression: sp.Expr) -> sp.Expr:
    """Value at r = 0 of an expression that holds J1(phi r)/r, whose limit is phi/2.

    J1(y) = y/2 + O(y^3), and r stands in denominators as 1/r only: putting the
    first term alone changes nothing in the limit. What is not finite then,
    ball arithmetic refuses.
    """
    return expression.xreplace({BESSEL_J1: symbols.phi * symbols.r / 2}).subs(symbols.r, 0)
