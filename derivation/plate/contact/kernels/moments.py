"""Tables of doubles for the generated code of kappa_n and M_k.

    kappa_n = int_0^oo y^n K0(y)/I0(y) dy
    M_k     = FP int_0^oo T^(2k-4) (G - 1) dT     (Hadamard's finite part)

For low index there is a table; one set of trapezoidal nodes serves all integrals. For large index
the code uses the expansions of `theory.moments`, from the index at which their bounds are below the
tolerance.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import cache
from pathlib import Path
from sys import float_info

import flint
import numpy as np
import sympy as sp
from flint import arb as Ball

from derivation.engine.cache import in_file
from derivation.engine.emit.modules import Numbers
from derivation.engine.emit.tables import Constant
from derivation.mathematics.bessel.kernels import first_true, nearest_double
from derivation.plate.contact.theory.moments import (
    finite_part_bound,
    finite_part_limit,
    kappa_bound,
    kappa_steps,
)
from derivation.plate.contact.theory.thin_plate import plate_excess
from derivation.plate.modules import ComputedModule, RuntimeModule
from derivation.plate.vocabulary import k

SOURCES = (
    "engine/cache.py",
    "engine/formula",
    "plate/*.py",
    "plate/*/theory*",
    "mathematics",
    "engine/rewrite",
    "plate/*/kernels*",
)
"""Sources on which numbers in the code depend."""
TOLERANCE = Fraction(1, 2**60)
"""Tolerance of the expansions' truncation error, for values near 1."""
TERMS = 13
"""Number of terms of the expansion of kappa_n; the index from which it is used follows from it."""
BITS = 512
FIRST_K = 2
"""First index k of M_k."""
_KAPPAS, _FINITE_PARTS = 200, 100
"""Numbers of computed values; the last ones already exceed the range of doubles."""
_STEP = 32
_TAIL = -120
_END = 320
_MIDPOINT_BITS = 100
_TABLE_BITS = 90
"""Smallest number of correct bits of the quadrature, so that no rounding depends on further
bits."""


def _nodes() -> list[tuple[Ball, Ball]]:
    """Return nodes y and weights of int_0^oo f dy: the trapezoidal rule in v, y = exp(v - e^(-v)).

    For f analytic in a sector |arg y| < d about the axis and decaying exponentially the error is
    e^(-2 pi d/step): below 1e-40 for every integrand of this module (d > 0.58), and below 1e-34 for
    high powers of y, which grow by (cos d)^-n off the axis. The tests compare the integrals with
    another rule and another map of the axis.
    """
    step = Ball(1) / _STEP
    nodes = []
    for index in range(-5 * _STEP, 6 * _STEP + 1):
        v = step * index
        exponential = (-v).exp()
        y = (v - exponential).exp()
        if y > Ball(2) ** _TAIL and y < _END:
            nodes.append((y, step * y * (1 + exponential)))
    return nodes


def midpoint(value: Ball) -> Ball:
    """Return the middle of a ball whose radius is due to rounding and far below the tolerance.

    Raises
    ------
    ArithmeticError
        If the radius is larger.
    """
    if not value.rad() < Ball(2) ** -_MIDPOINT_BITS * (1 + abs(value)):
        raise ArithmeticError(f"the radius of {value} is too large for a table")
    return value.mid()


@cache
def kappas() -> tuple[Ball, ...]:
    """Return kappa_0, kappa_1, kappa_2, ... = int_0^oo y^n K0(y)/I0(y) dy."""
    with flint.ctx.workprec(3 * BITS):
        points = [(y, w * y.bessel_k(Ball(0)) / y.bessel_i(Ball(0))) for y, w in _nodes()]
        return _by_power(points, 1, _KAPPAS)


def _by_power(points: Sequence[tuple[Ball, Ball]], step: int, count: int) -> tuple[Ball, ...]:
    """Return the sums of weight y^(step i) over the nodes, i = 0 ... count - 1."""
    moments = []
    for _ in range(count):
        moments.append(midpoint(sum((weight for _, weight in points), Ball(0))))
        points = [(y, weight * y**step) for y, weight in points]
    return tuple(moments)


@cache
def excess_nodes() -> tuple[tuple[Ball, Ball, Ball], ...]:
    """Return T, weight and G - 1 for the integrals over T."""
    with flint.ctx.workprec(3 * BITS):  # at 2^_TAIL, 840 bits cancel in the remainder of G - 1
        return tuple((T, weight, plate_excess(T)) for T, weight in _nodes())


@cache
def finite_parts() -> tuple[Ball, ...]:
    """Return M_2, M_3, M_4, ...; from M_4 on the integral itself converges."""
    with flint.ctx.workprec(3 * BITS):
        points = [(T, weight * excess * T**4) for T, weight, excess in excess_nodes()]
        return (*_singular_parts(), *_by_power(points, 2, _FINITE_PARTS - 2))


def _singular_parts() -> tuple[Ball, Ball]:
    """Return M_2 and M_3, the finite parts of int (G - 1) dT and int T^2 (G - 1) dT.

    The poles, G = 6/T^3 + 6/(5T) + ..., are subtracted with a factor e^(-T^2); their finite parts
    are FP int T^-3 e^(-T^2) = (gE - 1)/2 and FP int T^-1 e^(-T^2) = -gE/2.
    """
    second, third = Ball(0), Ball(0)
    for T, weight, excess in excess_nodes():
        exponential = (-T * T).exp()
        second += weight * (excess - exponential * (6 / T**3 + Ball(36) / 5 / T))
        third += weight * (T * T * excess - 6 * exponential / T)
    euler = Ball.const_euler()
    poles_second = 3 * (euler - 1) - Ball(18) / 5 * euler
    return midpoint(second + poles_second), midpoint(third - 3 * euler)


def kappa_ratios() -> tuple[Ball, ...]:
    """Return kappa_n 2^(n+1)/(pi n!), n = 0, 1, 2, ..."""
    with flint.ctx.workprec(BITS):
        return tuple(
            value * Ball(2) ** (n + 1) / (Ball.pi() * Ball(n + 1).gamma())
            for n, value in enumerate(kappas())
        )


def finite_part_ratios() -> tuple[Ball, ...]:
    """Return M_k 2^(2k-3)/(2k-2)!, k = 2, 3, 4, ..."""
    with flint.ctx.workprec(BITS):
        return tuple(
            value * Ball(2) ** (2 * index - 3) / Ball(2 * index - 1).gamma()
            for index, value in enumerate(finite_parts(), start=FIRST_K)
        )


@in_file(SOURCES)
def kappa_start() -> int:
    """Return the smallest n from which the expansion of kappa_n is within the tolerance."""
    return first_true(lambda n: bool(kappa_bound(n, TERMS) <= TOLERANCE))


@in_file(SOURCES)
def finite_part_start() -> int:
    """Return the smallest k from which M_k's ratio is within TOLERANCE of its limit."""
    finite_part_limit()
    return first_true(lambda index: bool(finite_part_bound(index) <= TOLERANCE))


def _doubles(values: Sequence[Ball]) -> tuple[float, ...]:
    """Return correctly rounded values, up to the last one in the range of doubles.

    Raises
    ------
    ArithmeticError
        If a rounding cannot be decided, or if no value exceeds the range of doubles.
    """
    limited = [value for value in values if abs(value) < Ball(float_info.max)]
    if len(limited) == len(values):
        raise ArithmeticError(f"a table of {len(values)} values does not reach the largest double")
    return _round(limited)


def _round(values: Sequence[Ball]) -> tuple[float, ...]:
    with flint.ctx.workprec(BITS):
        blur = Ball(0, Ball(2) ** -_TABLE_BITS)
        return tuple(nearest_double(value * (1 + blur)) for value in values)


@cache
def tables() -> dict[str, tuple[float, ...]]:
    """Return every table by name; those of the ratios end where their expansion begins."""
    return {
        "kappa": _doubles(kappas()),
        "kappa_ratio": _round(kappa_ratios()[: kappa_start()]),
        "finite_part": _doubles(finite_parts()),
        "finite_part_ratio": _round(finite_part_ratios()[: finite_part_start() - FIRST_K]),
    }


def _limit_parts() -> tuple[sp.Rational, sp.Rational]:
    """Return pole and residue of the ratio's limit 1 + residue/(k - pole)."""
    above = sp.cancel(finite_part_limit() - 1)
    (pole,) = sp.roots(sp.denom(above), k)
    return pole, sp.cancel(above * (k - pole))


def moment_numbers() -> Numbers:
    """Return the tables, the first indices of the expansions, and their coefficients."""
    numbers = {name: np.array(table) for name, table in tables().items()}
    pole, residue = _limit_parts()
    constants = (
        Constant("FIRST_K", FIRST_K, "First index k of M_k."),
        Constant("KAPPA_START", kappa_start(), "First n with the expansion of kappa_n."),
        Constant(
            "FINITE_PART_START", finite_part_start(), "First k with the limit of M_k's ratio."
        ),
        Constant(
            "KAPPA_STEPS",
            kappa_steps(TERMS),
            "Coefficients of 1, 1/n, 1/(n (n-1)), ... in kappa_n's ratio.",
        ),
        Constant(
            "LIMIT_POLE", float(pole), "M_k's ratio tends to 1 + LIMIT_RESIDUE/(k - LIMIT_POLE)."
        ),
        Constant("LIMIT_RESIDUE", float(residue), "See LIMIT_POLE."),
        Constant("KAPPA", numbers["kappa"], "kappa_n, from n = 0."),
        Constant("KAPPA_RATIO", numbers["kappa_ratio"], "kappa_n 2^(n+1)/(pi n!), from n = 0."),
        Constant("FINITE_PART", numbers["finite_part"], "M_k, from k = FIRST_K."),
        Constant(
            "FINITE_PART_RATIO",
            numbers["finite_part_ratio"],
            "M_k 2^(2k-3)/(2k-2)!, from k = FIRST_K.",
        ),
    )
    title = "Constants of the contact law for integer indices: tables and expansions."
    return Numbers("series_numbers", title, constants)


RUNTIME = Path(__file__).parents[1] / "runtime"
MODULES = (
    ComputedModule("series_numbers", moment_numbers),
    RuntimeModule("series_constants", RUNTIME / "series_constants.py"),
)
