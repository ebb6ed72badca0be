"""Constants for the generated code of the edge: limits, and tables of sums.

P = sum k/(j^3 J1) is a polynomial in alpha^2, E = sum k/(j^2 J1) a function of it. Both are
tabulated without the first mode.
"""

from collections.abc import Callable

import flint
import sympy as sp
from flint import arb as Ball

from derivation.engine.emit.modules import Numbers
from derivation.engine.emit.tables import Constant
from derivation.engine.formula.ball import enclose
from derivation.mathematics.bessel.kernels import nearest_double
from derivation.plate.contact.kernels.moments import BITS
from derivation.plate.contact.kernels.tables import chebyshev_nodes, in_powers
from derivation.plate.contact.theory.split import zero_of_j0
from derivation.plate.edge.theory.sums import (
    Kernel,
    closed_sums,
    indentation_kernel,
    slope_kernel,
)
from derivation.plate.vocabulary import alpha

WIDEST = sp.Rational(9, 10)
"""Largest a/b: closer to the edge the states are not valid, and the tables grow without limit."""
TERMS = 34
"""Number of coefficients of the tables in alpha^2."""
CUT_OFF = 2**-58
"""Truncation error of the tables, for sums near 1/8."""
SWITCH = 2
"""T below which Q - 3 is a power series."""
FADED = 46
"""T beyond which modes are omitted: T^2 e^(-T) is below 1e-16 times the first modes."""
THIN = sp.Rational(29, 2)
"""(1 - alpha)/eta above which the closed form is sufficient.

The contribution of the bending roots is then below e^(-3.7 THIN) = 3e-24, that of the others
below e^(-2.1 THIN) = 6e-14, times (8/3) n^2 eta^3 z^(-3/2), below 1e-4 of the bending sum.
"""
_STEP = 48
_LAST = -120
_END = 1000
KERNELS = {"INDENTATION": indentation_kernel, "SLOPE": slope_kernel}


def numbers() -> Numbers:
    """Return the limits of the methods, the first mode's weights, and the tables."""
    with flint.ctx.workprec(BITS):
        first = zero_of_j0(1, BITS // 2)
        weights = [1 / (first**power * first.bessel_j(1)) for power in (3, 2)]
        tables = [
            Constant(f"{name}_{table}", values, f"{of} of the {name.lower()} {FROM}")
            for name, kernel in KERNELS.items()
            for (table, of), values in zip(
                TABLES.items(), _tables(kernel, first, weights), strict=True
            )
        ]
        third, square = (nearest_double(weight) for weight in weights)
    return Numbers(
        "edge_numbers",
        "Constants of the edge: limits, and sums over the modes as tables.",
        (
            Constant("WIDEST", float(WIDEST), "Largest a/b of the corrections."),
            Constant("MIDDLE", float(WIDEST**2 / 2), "alpha^2 at the centre of the tables."),
            Constant("THIN", float(THIN), "(1 - alpha)/eta above which the closed form suffices."),
            Constant("FADED", float(FADED), "T beyond which modes are omitted."),
            Constant("FIRST_THIRD", third, "1/(j^3 J1) of the first mode."),
            Constant("FIRST_SQUARE", square, "1/(j^2 J1) of the first mode."),
            *tables,
        ),
    )


TABLES = {"THIRD": "sum k/(j^3 J1)", "SQUARE": "sum k/(j^2 J1)"}
FROM = "without the first mode, in powers of alpha^2/MIDDLE - 1."


def _tables(kernel: Kernel, first: Ball, weights: list[Ball]) -> tuple[tuple[float, ...], ...]:
    """Return P and E without their first mode, in powers of alpha^2/middle - 1.

    Raises
    ------
    ArithmeticError
        If the last coefficients of a table are not negligible.
    """
    middle = enclose(WIDEST**2 / 2, {})
    points = [(middle * (1 + t)).sqrt() for t in chebyshev_nodes(TERMS)]
    plain = closed_sums(kernel).plain
    kernel_values = [value_of(kernel, at * first) for at in points]
    cubes = [
        enclose(plain, {alpha: at}) - weights[0] * value
        for at, value in zip(points, kernel_values, strict=True)
    ]
    squares = [
        alternating_sum(kernel, at) - weights[1] * value
        for at, value in zip(points, kernel_values, strict=True)
    ]
    rows = []
    for name, values in zip(TABLES, (cubes, squares), strict=True):
        # Chebyshev's coefficients decrease by 0.39 each: the last shows the truncation error.
        waves = [((TERMS - 1) * angle).cos() for angle in _angles()]
        last = 2 * sum((f * t for f, t in zip(values, waves, strict=True)), Ball(0)) / TERMS
        if not abs(last) < CUT_OFF:
            raise ArithmeticError(f"truncation error of {name} with {TERMS} coefficients: {last}")
        rows.append(tuple(nearest_double(c) for c in _significant(in_powers(values))))
    return tuple(rows)


def _significant(coefficients: list[Ball]) -> list[Ball]:
    """Return the midpoints of the coefficients, up to the last one above 1e-22."""
    points = [c.mid() for c in coefficients]
    last = max(i for i, c in enumerate(points) if abs(c) > 1e-22)
    return points[: last + 1]


def _angles() -> list[Ball]:
    """Return Chebyshev's nodes as angles."""
    return [(2 * i + 1) * Ball.pi() / (2 * TERMS) for i in range(TERMS)]


def value_of(kernel: Kernel, at: Ball) -> Ball:
    """Return a weight function at a number."""
    y = sp.Symbol("y", positive=True)
    return enclose(kernel(y), {y: at})


def _turned(kernel: Kernel) -> Callable[[Ball], Ball]:
    """Return k(iy)/k(0)."""
    if kernel is indentation_kernel:
        return lambda y: 3 * (y * y.cosh() - y.sinh()) / y**3
    return lambda y: y.sinh() / y


def alternating_sum(kernel: Kernel, at: Ball) -> Ball:
    """Return E = sum k/(j^2 J1) = (1/pi) int_0^oo (k(0) - k(iy)/I0(y))/y^2 dy.

    With e^(-y^2) instead of 1, and int (1 - e^(-y^2))/y^2 dy = sqrt(pi): the trapezoidal rule in
    v, y = exp(v - e^(-v)), has the error e^(-2 pi d _STEP), d = pi/4 being the sector's half angle.
    """
    turned, size = _turned(kernel), sp.limit(kernel(alpha), alpha, 0)
    total = Ball(0)
    with flint.ctx.workprec(3 * BITS):  # powers of y cancel near 0
        for y, weight, bessel, bell in _nodes():
            total += weight * (bell - turned(at * y) / bessel)
        value = total / Ball.pi() + 1 / Ball.pi().sqrt()
        return enclose(size, {}) * value


_cached: list[tuple[Ball, Ball, Ball, Ball]] = []


def _nodes() -> list[tuple[Ball, Ball, Ball, Ball]]:
    """Return y, the weight divided by y^2, I0(y) and e^(-y^2)."""
    if not _cached:
        step = Ball(1) / _STEP
        for index in range(-5 * _STEP, 8 * _STEP):
            v = step * index
            exponential = (-v).exp()
            y = (v - exponential).exp()
            if y > Ball(2) ** _LAST and y < _END:
                bell = (-y * y).exp()
                _cached.append((y, step * (1 + exponential) / y, y.bessel_i(0), bell))
    return _cached
