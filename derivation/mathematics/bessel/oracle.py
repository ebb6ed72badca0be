"""Zeros of J0 and J1 as Arb balls (intervals), each with a proof that it is the n-th.

y = sqrt(x) J0(x) satisfies y'' + (1 + 1/(4 x^2)) y = 0. The coefficient decreases towards 1, so by
Sturm's comparison consecutive zeros are less than pi apart and their spacing increases;
j_n - (n - 1/4) pi therefore decreases with n, and tends to 0 by the asymptotic expansion. Hence
0 < j_n - (n - 1/4) pi <= j_1 - 3 pi/4 for all n: the intervals (n - 1/4) pi + (0, 1/20) are
disjoint and contain one zero each, the n-th, if j_1 is known to lie in the first
(`first_zero_is_first`).

For J1 the coefficient is 1 - 3/(4 x^2) and increases, the spacing decreases towards pi, and the
argument applies with reversed sign: the n-th zero lies in (n + 1/4) pi - (0, 1/8).
"""

from functools import cache

import flint

WIDTH = flint.arb(flint.fmpq(1, 20))
WIDTH_J1 = flint.arb(flint.fmpq(1, 8))
_GUARD_BITS = 48
_START_BITS, _STEP_BITS = 16, 4
"""Correct bits after Newton's first step from McMahon's terms, and bits that each step loses."""


class ZeroError(ArithmeticError):
    """A zero of J0 or J1 could not be certified."""


@cache
def j0_zero(index: int, bits: int) -> flint.arb:
    """Return a ball around the index-th positive zero of J0, its relative radius below 2^-bits.

    Raises
    ------
    ValueError
        If the index is not positive.
    ZeroError
        If the sign of J0 does not change across the ball, or the ball leaves the interval of the
        index.
    """
    if index < 1:
        raise ValueError(f"expected an index of at least 1, got {index}")
    if not first_zero_is_first():
        raise ZeroError("J0 could not be proved to have no zero below 3 pi/4")
    working = bits + _GUARD_BITS
    with flint.ctx.workprec(working):
        left = (index - flint.arb(1) / 4) * flint.arb.pi()
        guess = _newton(left + 1 / (8 * left), working)
        radius = flint.arb(2) ** (-bits - 2)
        low, high = guess - radius, guess + radius
        if not (low > left and high < left + WIDTH):
            raise ZeroError(f"the ball {guess} is outside the interval of zero {index}")
        if not low.bessel_j(0) * high.bessel_j(0) < 0:
            raise ZeroError(f"J0 does not change its sign across {guess}")
        return low.union(high)


@cache
def j1_zero(index: int, bits: int) -> flint.arb:
    """Return a ball around the index-th positive zero of J1, see `j0_zero`."""
    if index < 1:
        raise ValueError(f"expected an index of at least 1, got {index}")
    if not first_zero_of_j1_is_first():
        raise ZeroError("J1 could not be proved to have no zero up to 5 pi/4 - 1/8")
    with flint.ctx.workprec(bits + _GUARD_BITS):
        right = (index + flint.arb(1) / 4) * flint.arb.pi()
        x = (right - 3 / (8 * right)).mid()
        for _ in range(bits.bit_length() + 4):
            j1 = x.bessel_j(1)
            x = (x - j1 / (x.bessel_j(0) - j1 / x)).mid()
        radius = flint.arb(2) ** (-bits - 2)
        low, high = x - radius, x + radius
        if not (high < right and low > right - WIDTH_J1):
            raise ZeroError(f"the ball {x} is outside the interval of zero {index} of J1")
        if not low.bessel_j(1) * high.bessel_j(1) < 0:
            raise ZeroError(f"J1 does not change its sign across {x}")
        return low.union(high)


@cache
def j1_at_zero(index: int, bits: int) -> flint.arb:
    """Return J1 at the index-th positive zero of J0, its relative radius below 2^-bits.

    J1 multiplies a ball's relative radius by the argument, about pi times the index: the zero is
    computed with as many additional bits.

    Raises
    ------
    ZeroError
        If the ball is wider nevertheless.
    """
    working = bits + index.bit_length() + _GUARD_BITS
    with flint.ctx.workprec(working):
        value = j0_zero(index, working).bessel_j(1)
    if value.rel_accuracy_bits() < bits:
        raise ZeroError(f"J1 at zero {index} is only known as {value}")
    return value


def _newton(start: flint.arb, bits: int) -> flint.arb:
    """Apply Newton's iteration to midpoints, which gives a guess for the caller to certify.

    An error e becomes e^2/(2 x) or less, so that half of the precision is sufficient in the step
    before: all steps together take little more time than the last one.
    """
    precisions = [bits]
    while precisions[-1] > _START_BITS:
        precisions.append(precisions[-1] // 2 + _STEP_BITS)
    x = start.mid()
    for precision in reversed(precisions):
        with flint.ctx.workprec(precision + _GUARD_BITS):
            x = (x + x.bessel_j(0) / x.bessel_j(1)).mid()
    return x


@cache
def first_zero_is_first() -> bool:
    """Prove that J0 is positive on [0, 2.36], beyond 3 pi/4, by balls that cover it.

    Zeros there are more than 3 apart (the coefficient is below 1.05), so the
    one found in the first interval is the only one in it, and is j_1.
    """
    with flint.ctx.workprec(64):
        half = flint.arb(flint.fmpq(1, 200))
        pieces = (flint.arb((2 * k + 1) * half, half) for k in range(236))
        covered = all(piece.bessel_j(0) > 0 for piece in pieces)
        return covered and bool(236 * 2 * half > flint.arb.pi() * 3 / 4)


@cache
def first_zero_of_j1_is_first() -> bool:
    """Prove that J1 is positive on (0, 3.805], beyond 5 pi/4 - 1/8, by balls from 2 on.

    Below 2 the terms of J1 = (x/2) (1 - x^2/8 + ...) alternate and decrease, and the first two are
    at least x/2 (1 - 1/2).
    """
    with flint.ctx.workprec(64):
        half = flint.arb(flint.fmpq(1, 2000))
        pieces = (2 + flint.arb((2 * k + 1) * half, half) for k in range(1805))
        covered = all(piece.bessel_j(1) > 0 for piece in pieces)
        return covered and bool(2 + 1805 * 2 * half > flint.arb.pi() * 5 / 4 - WIDTH_J1)
