"""Coefficients of the contact law's power series in a/h to any number of digits, in balls.

delta = (a^2/R) (1 + A (c_1 + c_3 A^2 + ...)), A = a/h. Each is the side wall's moment
plus the modes' one; for plates so thin that the residues at the roots of sinh T = +-T
are below the digits asked for, the closed form. What sums and nodes leave out is not
bounded: these are methods to be judged, not references.
"""

import math
from functools import cache

import flint
from flint import acb, arb

from derivation.engine.formula.ball import LOG2_10
from derivation.mathematics.bessel import oracle as certified
from derivation.plate.contact.oracle.moments import finite_part
from derivation.plate.contact.oracle.sums import plate_excess

ROOT_HEIGHT = 4.2
"""The first residue is of the order e^(-ROOT_HEIGHT b/h)."""


def series(h: float, b: float, count: int, digits: int) -> list[arb]:
    """c_1, c_3 ... of h/b to some digits."""
    if ROOT_HEIGHT * b / h > (digits + 5) * math.log(10):
        return closed_form(h, b, count, digits)
    return by_moments(h, b, count, digits)


@cache
def closed_form(h: float, b: float, count: int, digits: int) -> list[arb]:
    """The thin plate's: a logarithm and finite parts M_k."""
    bits = bits_of(digits)
    with flint.ctx.workprec(bits):
        eta, pi = arb(h) / arb(b), arb.pi()
        log = arb.const_euler() - (4 * eta).log()
        M = [finite_part(k, bits) for k in range(2, max(count, 2) + 2)]
        found = [
            1 / (4 * pi * eta**2) + 2 / (3 * pi) * (M[0] + log * 6 / 5),
            -(M[1] + 6 * log) / (60 * pi),
        ]
        for k in range(4, count + 2):
            share = (-1) ** k * 8 * (2 * k - 2) / (pi * math.factorial(2 * k - 1))
            found.append(share * M[k - 2] / arb(2) ** (2 * k - 2))
        return found[:count]


@cache
def by_moments(h: float, b: float, count: int, digits: int) -> list[arb]:
    """c_(2k+1) = eta^(2k+1) (8/pi^2) (2k+2)/(2k+3)! (pi (-1)^k sum_n w_n j_n^(2k) - kappa_2k).

    Up to h/b = 1/2 the modes outweigh the wall; in thicker plates they take more bits.
    """
    bits = bits_of(digits) + (4 * count if h > b / 2 else 0)
    with flint.ctx.workprec(bits):
        eta, pi = arb(h) / arb(b), arb.pi()
        walls, modes = wall_moments(count, bits), mode_moments(h, b, count, bits)
        return [
            eta ** (2 * k + 1) * 8 / pi**2 * (2 * k + 2) / math.factorial(2 * k + 3)
            * ((-1) ** k * pi * modes[k] - walls[k])
            for k in range(count)
        ]  # fmt: skip


@cache
def wall_moments(count: int, bits: int) -> list[arb]:
    """kappa_0, kappa_2 ...: (2k+1) kappa_2k = int_0^oo y^(2k)/I0(y)^2 dy.

    The integrand is even with poles on the imaginary axis only; y = 2 sinh t makes it analytic
    for |Im t| < pi/2, where the trapezoidal rule converges like e^(-2 pi 1.35/step).
    """
    step = arb(2 * math.pi * 1.35 / ((bits + 40) * math.log(2)))
    powers, t, k = [], arb(0), 0
    least = arb(2) ** (-bits - 8 * count)
    while True:
        y = 2 * t.sinh()
        weight = step * 2 * t.cosh() / y.bessel_i(0) ** 2 / (1 if k else 2)
        powers.append((weight, y * y))
        if k and weight * y ** (2 * count) < least:
            break
        k, t = k + 1, t + step
    found = []
    for k in range(count):
        found.append(sum((w for w, _ in powers), arb(0)) / (2 * k + 1))
        powers = [(w * square, square) for w, square in powers]
    return found


def mode_moments(h: float, b: float, count: int, bits: int) -> list[arb]:
    """sum_n w_n j_n^(2k), w_n = (G(2 eta j_n) - 1)/(j_n J1(j_n)^2)."""
    eta = arb(h) / arb(b)
    powers = []
    for n in range(1, modes_needed(h / b, count, bits) + 1):
        j = certified.j0_zero(n, bits + 16)
        slope = j.bessel_j(1)
        powers.append((plate_excess(acb(2 * eta * j)).real / (j * slope * slope), j * j))
    found = []
    for _ in range(count):
        found.append(sum((w for w, _ in powers), arb(0)))
        powers = [(w * square, square) for w, square in powers]
    return found


def modes_needed(eta: float, count: int, bits: int) -> int:
    """Until x^(2k + 2) e^(-4x), x = eta j_n, is 2^-bits of its largest value, for every k."""
    power = 2 * count + 2
    peak = power * math.log(power / 4) - power
    x = power / 4 + 1
    while power * math.log(x) - 4 * x > peak - bits * math.log(2):
        x += 0.5
    return math.ceil(x / (eta * math.pi)) + 2


def bits_of(digits: int) -> int:
    """Working precision."""
    return math.ceil(digits * LOG2_10) + 64
