"""Tables for the generated code of J0, J1 and their zeros, from the theory.

Below `asymptotic_start` a Taylor polynomial about one of many centres is used. Every zero of J0 and
J1 there is a centre, stored as a sum of two doubles, so that x - centre keeps its relative accuracy
near the zero. Above it modulus and phase are used. Degrees and switch points follow from bounds of
the truncation errors.
"""

from bisect import bisect_left
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import pairwise
from math import ceil, factorial
from pathlib import Path

import flint
import sympy as sp

from derivation.engine.emit.modules import Numbers
from derivation.engine.emit.tables import Constant
from derivation.engine.formula.ball import enclose, to_ball
from derivation.mathematics.bessel.theory.functions import (
    SHIFTED,
    c,
    derivative_bound,
    hankel_constants,
    k,
    modulus_bound,
    modulus_squared,
    phase_bound,
    phase_shift,
    taylor_recurrence,
)
from derivation.mathematics.bessel.theory.zeros import (
    phase_at_zeros,
    slope_squared,
    zero_bound,
    zero_correction,
)

TOLERANCE = Fraction(1, 2**57)
"""Allowed truncation error, relative to the value (absolute for the phase)."""
TERMS = 8
"""Number of terms of each asymptotic expansion; the switch points follow from it."""
CELLS = 16
"""Switch points are multiples of 1/16, so that floor(16 x) finds the centre exactly."""
SPACING = Fraction(17, 20)
"""Largest distance of neighbouring centres; more centres allow a lower degree."""
LARGEST_PHASE = 2.0**50
"""x up to which modulus and phase are used: the integer n in n pi/4 near x is an exact double."""
RUNTIME = Path(__file__).parent / "runtime"
"""Folder of the functions that need these tables."""
_BITS = 320
_NEWTON_STEPS = 12


@dataclass(frozen=True)
class TaylorTable:
    """Taylor polynomials of J0 and J1 on neighbouring intervals.

    Parameters
    ----------
    high, low
        Centres, each the sum of two doubles.
    switches
        Ends of the intervals, 0 first; interval i is [switches[i], switches[i + 1]).
    rows
        For J0 and J1: the coefficients about each centre, constant term first.
    """

    high: tuple[float, ...]
    low: tuple[float, ...]
    switches: tuple[float, ...]
    rows: tuple[tuple[tuple[float, ...], ...], tuple[tuple[float, ...], ...]]


def nearest_double(ball: flint.arb) -> float:
    """Return the double nearest to every number in the ball.

    Raises
    ------
    ArithmeticError
        If the ball is too wide for a unique double.
    """
    ends = {float(_fraction(end)) for end in (ball.lower(), ball.upper())}
    if len(ends) != 1:
        raise ArithmeticError(f"{ball} contains numbers with different nearest doubles")
    return ends.pop()


def _fraction(point: flint.arb) -> Fraction:
    mantissa, exponent = point.man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


def bessel_zero(order: int, index: int) -> flint.arb:
    """Return a ball around the index-th positive zero of J0 or J1, at the current precision.

    Newton's iteration starts from the leading term of McMahon's expansion; a change of sign over
    the ball certifies a zero. It is the index-th: by Sturm's comparison each interval
    (n -+ 1/4) pi +- pi/8, minus for J0, contains one zero, and there are no others.

    Raises
    ------
    ArithmeticError
        If no sign change within that interval was found.
    """
    start = (4 * flint.arb(index) + phase_at_zeros(order)[0]) / 4 * flint.arb.pi()
    point = start
    for _ in range(_NEWTON_STEPS):
        value, slope = _value_and_slope(order, point)
        point = (point - value / slope).mid()
    radius = flint.arb(2) ** (24 - flint.ctx.prec) * point
    left, right = ((point + side * radius).bessel_j(flint.arb(order)) for side in (-1, 1))
    if not (left * right < 0 and abs(point - start) < flint.arb.pi() / 8):
        raise ArithmeticError(f"no zero number {index} of J{order} near {point}")
    return flint.arb(point, radius)


def _value_and_slope(order: int, x: flint.arb) -> tuple[flint.arb, flint.arb]:
    j0, j1 = x.bessel_j(flint.arb(0)), x.bessel_j(flint.arb(1))
    return (j0, -j1) if order == 0 else (j1, j0 - j1 / x)


def first_true(holds: Callable[[int], bool], limit: int = 1 << 12) -> int:
    """Return the smallest positive integer that meets a condition met by all larger ones.

    Raises
    ------
    ArithmeticError
        If no integer below `limit` meets it.
    """
    count = bisect_left(range(limit), True, lo=1, key=holds)
    if count == limit:
        raise ArithmeticError(f"the condition is not met below {limit}")
    return count


@cache
def asymptotic_start() -> Fraction:
    """Return the smallest multiple of 1/16 where both orders are within tolerance.

    The square root in J halves the relative error of the squared modulus.
    """
    hankel_constants()

    def within(cell: int) -> bool:
        start = sp.Rational(cell, CELLS)
        return all(
            modulus_bound(order, TERMS, start) <= 2 * sp.Rational(TOLERANCE)
            and phase_bound(order, TERMS, start) <= sp.Rational(TOLERANCE)
            for order in (0, 1)
        )

    return Fraction(first_true(within), CELLS)


@cache
def mcmahon_start(order: int) -> int:
    """Return the smallest index from which the expansions of J_order's zeros are within tolerance.

    The remainder of the zero is bounded (`zero_bound`). For order 0 the expansion of J1 squared at
    the zero must be within tolerance too; its remainder is estimated by the first omitted term.
    """
    quarters, slope = phase_at_zeros(order)[0], slope_squared(TERMS + 1)

    def within(index: int) -> bool:
        # With 3 instead of pi, beta is smaller and the bounds are larger.
        beta = sp.Rational(4 * index + quarters, 4) * 3
        near = order == 1 or abs(slope.term(TERMS, beta)) <= 2 * sp.Rational(TOLERANCE)
        return bool(near and zero_bound(order, TERMS, beta) <= beta * sp.Rational(TOLERANCE))

    return first_true(within)


def centres() -> tuple[flint.arb, ...]:
    """Return 0, the zeros of J0 and J1 up to the first above the start, and points between."""
    start = to_ball(asymptotic_start())
    special, index = [flint.arb(0)], 1
    while special[-1] < start:
        special += [bessel_zero(0, index), bessel_zero(1, index)]
        index += 1
    filled = special[:1]
    for left, right in pairwise(special):
        parts = ceil(float(right - left) / float(SPACING))
        for part in range(1, parts):
            between = left + (right - left) * part / parts
            filled.append(to_ball(_on_grid(between)))
        filled.append(right)
    return tuple(filled)


def _on_grid(ball: flint.arb) -> Fraction:
    """Return the multiple of 1/16, an exact double, nearest to the middle of the ball."""
    return Fraction(round(float(ball) * CELLS), CELLS)


@cache
def taylor_table() -> TaylorTable:
    """Return centres, switch points and the correctly rounded coefficients of J0 and J1."""
    with flint.ctx.workprec(_BITS):
        stop = asymptotic_start()
        points = centres()
        middles = [_on_grid((a + b) / 2) for a, b in pairwise(points)]
        switches = (Fraction(0), *(switch for switch in middles if switch < stop), stop)
        points = points[: len(switches) - 1]
        length = _terms_needed(points, switches)
        series = [_taylor_of_j0(point, length + 1) for point in points]
        slopes = [[-(n + 1) * a for n, a in enumerate(row[1:])] for row in series]
        high = tuple(float(point.mid()) for point in points)
        return TaylorTable(
            high,
            tuple(nearest_double(point - near) for point, near in zip(points, high, strict=True)),
            tuple(float(switch) for switch in switches),
            (_rounded(row[:length] for row in series), _rounded(slopes)),
        )


def _rounded(rows: Iterable[Iterable[flint.arb]]) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(nearest_double(a) for a in row) for row in rows)


def _terms_needed(points: tuple[flint.arb, ...], switches: tuple[Fraction, ...]) -> int:
    """Return the number of Taylor terms that suffices on every interval, for J0 and J1.

    The remainder t^n/n! max |J0^(n)| (J0^(n+1) for J1) is compared with the value at both ends.
    This is sufficient: from an end inwards the remainder decreases like t^n, the value at most
    like t (towards a zero at the centre).
    """
    ends = [
        (to_ball(end) - point, to_ball(end))
        for point, left, right in zip(points, switches, switches[1:], strict=False)
        for end in (left, right)
        if end > 0
    ]
    values = [(abs(t), [abs(x.bessel_j(flint.arb(order))) for order in (0, 1)]) for t, x in ends]

    def enough(terms: int) -> bool:
        bounds = [enclose(derivative_bound(terms + order), {}) for order in (0, 1)]
        scale = to_ball(TOLERANCE) * factorial(terms)
        return all(
            bool(t**terms * bounds[order] <= scale * size[order])
            for t, size in values
            for order in (0, 1)
        )

    return first_true(enough, 64)


def _taylor_of_j0(point: flint.arb, length: int) -> list[flint.arb]:
    """Return Taylor coefficients of J0 about a centre; those that vanish are exactly 0."""
    recurrence = taylor_recurrence()
    if point == 0:
        row = [flint.arb(1), flint.arb(0)]
        for index in range(2, length):
            values = {SHIFTED[0]: row[index - 2], k: flint.arb(index)}
            row.append(enclose(recurrence.at_origin, values))
        return row
    first = (point.bessel_j(flint.arb(0)), -point.bessel_j(flint.arb(1)))
    row = [flint.arb(0)] * 2 + [flint.arb(0) if a.contains(0) else a for a in first]
    for index in range(length - 2):
        values = dict(zip(SHIFTED[:4], row[index:], strict=False))
        row.append(enclose(recurrence.following, values | {c: point, k: flint.arb(index)}))
    return row[2:]


def switches() -> tuple[float, ...]:
    """Return arguments where J0 and J1 change their method or centre, ascending."""
    return (*taylor_table().switches, LARGEST_PHASE)


@cache
def low_zeros(order: int) -> tuple[float, ...]:
    """Return zeros of J_order below McMahon's start, correctly rounded."""
    with flint.ctx.workprec(_BITS):
        zeros = (bessel_zero(order, index) for index in range(1, mcmahon_start(order)))
        return tuple(nearest_double(zero) for zero in zeros)


@cache
def low_slopes() -> tuple[float, ...]:
    """Return J1 at the zeros of J0 below McMahon's start, correctly rounded."""
    with flint.ctx.workprec(_BITS):
        zeros = (bessel_zero(0, index) for index in range(1, mcmahon_start(0)))
        return tuple(nearest_double(zero.bessel_j(flint.arb(1))) for zero in zeros)


def _multiples_of_pi() -> tuple[Constant, ...]:
    """Return the multiples and powers of pi for the code, two of them with a second double."""
    with flint.ctx.workprec(_BITS):
        pi = flint.arb.pi()
        head, square = nearest_double(pi / 4), nearest_double(8 / pi**2)
        return (
            Constant("QUARTER_PI", head, "pi/4."),
            Constant(
                "QUARTER_PI_TAIL", nearest_double(pi / 4 - head), "pi/4 - QUARTER_PI, rounded."
            ),
            Constant("EIGHT_OVER_PI2", square, "8/pi^2."),
            Constant(
                "EIGHT_OVER_PI2_TAIL",
                nearest_double(8 / pi**2 - square),
                "8/pi^2 - EIGHT_OVER_PI2.",
            ),
            Constant("HALF_PI", nearest_double(pi / 2), "pi/2."),
            Constant("INVERSE_PI", nearest_double(1 / pi), "1/pi."),
            Constant("INVERSE_ROOT_PI", nearest_double(1 / pi.sqrt()), "1/sqrt(pi)."),
        )


def wrapped(texts: Iterable[str], width: int = 90) -> tuple[str, ...]:
    """Join items by commas into lines no longer than `width`, including the last comma."""
    lines = [""]
    for text in texts:
        if lines[-1] and len(lines[-1]) + len(text) + 2 > width:
            lines.append("")
        lines[-1] += f"{' ' if lines[-1] else ''}{text},"
    return tuple(lines)


def bessel_numbers() -> Numbers:
    """Return the tables of J0, J1 and their zeros; pairs of tables are those of J0 and J1."""
    table = taylor_table()
    both = (0, 1)
    constants = (
        *_multiples_of_pi(),
        Constant(
            "ASYMPTOTIC_START", table.switches[-1], "x above which modulus and phase are used."
        ),
        Constant("LARGEST_PHASE", LARGEST_PHASE, "x up to which modulus and phase are used."),
        Constant(
            "MODULUS",
            tuple(modulus_squared(n, TERMS).coefficients for n in both),
            "(pi x/2) (J_nu^2 + Y_nu^2) = p(x) in powers of 1/x^2.",
        ),
        Constant(
            "SHIFT",
            tuple(phase_shift(n, TERMS).coefficients for n in both),
            "x s(x) in powers of 1/x^2.",
        ),
        Constant(
            "ZERO_CORRECTION",
            tuple(zero_correction(n, TERMS).coefficients for n in both),
            "beta (j - beta) in powers of 1/beta^2; beta is (n - 1/4) pi, for J1 (n + 1/4) pi.",
        ),
        Constant(
            "SLOPE_EXCESS",
            slope_squared(TERMS).coefficients[1:],
            "(pi beta/2) J1(j_n)^2 - 1 at the zeros of J0, the first power being 1/beta^2.",
        ),
        Constant(
            "QUARTERS",
            tuple(float(phase_at_zeros(n)[0]) for n in both),
            "beta = (4 n + QUARTERS) pi/4.",
        ),
        Constant(
            "FIRST_MCMAHON",
            tuple(mcmahon_start(n) for n in both),
            "Indices of the zeros from which McMahon's expansion is used.",
        ),
        Constant("LOW_ZEROS", tuple(low_zeros(n) for n in both), "The zeros before FIRST_MCMAHON."),
        Constant("LOW_SLOPES", low_slopes(), "J1 at the zeros of J0 in LOW_ZEROS."),
        Constant("CELLS", CELLS, "Every interval ends at a multiple of 1/CELLS."),
        Constant(
            "SWITCHES", table.switches[:-1], "Starts of the intervals of the Taylor polynomials."
        ),
        Constant("CENTRE_HIGH", table.high, "Centres of the Taylor polynomials, rounded."),
        Constant("CENTRE_LOW", table.low, "The exact centres minus CENTRE_HIGH, rounded."),
        Constant("TAYLOR", table.rows, "Coefficients about each centre, constant term first."),
    )
    title = "Constants of the Bessel functions: expansions, zeros, Taylor polynomials."
    return Numbers("bessel_numbers", title, constants)
