"""mpmath reference to many digits: the law's power series from the plate factor's axis and poles.

Neither zeros of J0 nor moments of K0/I0 are used. Instead, the contour of the modal sum is closed
around the poles T_n of G, sinh T = +-T (step 14 of the theory): with A = a/h and eta = h/b,

    delta = (a^2/R) (1 + sum s_j/(2j+3)),   d delta/da = (2a/R) (1 + 1/2 sum s_j),
    s_j = (-1)^j 4/pi (A/2)^(2j+1)/(2j+1)! N_j,
    N_j = FP int_0^oo T^(2j) (G - 1) dT + 2 pi Im sum_n g_n T_n^(2j) H(z_n)/J0(z_n) + low_j,
    low_0 = 3/(8 eta^2) + (6/5) l,  low_1 = 6 l,  l = gamma - log(4 eta),  else 0,

g_n being G's residue at T_n and z_n = T_n/(2 eta). The finite part up to 1 is that of G's Laurent
series, term by term; from 1 on, the trapezoidal rule with T = 1 + exp(t - e^(-t)) is used. Few
products of many digits are needed, so that Python's integers are sufficient: all numbers are
fixed-point numbers. Truncation errors are not bounded; results are compared with certified ones.
"""

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import repeat
from typing import NamedTuple

from mpmath import mp, mpc, mpf

from derivation.engine.formula.ball import LOG2_10

PLATES = 256
"""Number of cached series."""

STRIP = 1.0
"""Half-width of the strip that determines the step of the trapezoidal rule, unless the contact is
deep: T = 1 + y avoids the poles T_n of G, whose smallest arg (T_n - 1) is 1.28, for n = 1."""

FIRST_ZERO = 2.4
"""Slightly below the first zero of J0. If G - 1 is negligible at T = 2 eta FIRST_ZERO, only the
finite radius contributes: N_j = (-1)^(j+1) 2/pi (2 eta)^(2j+1) kappa_(2j) of step 12."""

_SPARE = 64
"""Additional bits for sums of thousands of terms."""

Scaled = list[int]
"""Numbers times a power of two, rounded down."""


class ResidueSeries(NamedTuple):
    """The law as a power series in q = a/(reach b).

    Attributes
    ----------
    terms
        s_j (see the module) for a = reach b, times 2^bits: coefficients of q^(2j+1).
    bits
        Binary places.
    reach
        a/b [1] of q = 1.
    """

    terms: Scaled
    bits: int
    reach: mpf


@lru_cache(maxsize=PLATES)
def series(eta: mpf, reach: mpf, digits: int) -> ResidueSeries:
    """Return the law of a plate of h/b = eta for contacts up to a/b = reach <= 1.

    Parameters
    ----------
    eta, reach
        Ratios [1], accurate to more digits than requested.
    digits
        Number of digits of the sums.
    """
    bits, A = math.ceil(digits * LOG2_10) + _SPARE, float(reach / eta)
    with mp.workprec(bits + _SPARE):
        half = reach / eta / 2
        factor = 4 / mp.pi * half
        roots: list[_Node] = []
        near: Iterator[int] = repeat(0)
        if 4 * FIRST_ZERO * eta > bits * math.log(2):
            axis = list(_lateral(bits, eta))
        else:
            axis, roots = list(_axis(bits, A)), list(_roots(bits, eta, float(reach)))
            near = _near(bits, half, eta)
        real, poles = (_powers(nodes, half, bits) for nodes in (axis, roots))
        terms: Scaled = []
        while True:
            parts = next(real), next(poles), next(near)
            if parts[:2] == (None, None) and abs(parts[2]) <= 1:
                break
            total = sum(part or 0 for part in parts)
            terms.append((-1) ** len(terms) * _product(total, factor, bits))
        return ResidueSeries(terms, bits, reach)


def fixed(x: mpf, bits: int) -> int:
    """Return x 2^bits, rounded down."""
    return int(x.to_fixed(bits))


def floating(x: int, bits: int) -> mpf:
    """Return x 2^-bits."""
    return mp.ldexp(mpf(x), -bits)


def _product(x: int, factor: mpf, bits: int) -> int:
    return x * fixed(factor, bits + _SPARE) >> (bits + _SPARE)


class _Node(NamedTuple):
    """T and the weight of its even powers in the N_j."""

    T: mpf | mpc
    weight: mpf | mpc


def _lateral(bits: int, eta: mpf) -> Iterator[_Node]:
    """Yield the nodes T = 2 i eta y and weights of a sum for -2/pi int_0^oo K0/I0 dy."""
    need = bits * math.log(2)
    for y, w in _nodes(2 * math.pi * STRIP / need, need, need + 2 * math.log(need)):
        with mp.workprec(bits + math.ceil(y / math.log(2)) + _SPARE):
            yield _Node(mpc(0, 2 * eta * y), -4 * eta / mp.pi * w * _bessel_quotient(y).real)


def _axis(bits: int, A: float) -> Iterator[_Node]:
    """Yield nodes and weights of int_1^oo (G - 1) dT; in its strip e^(A Im T/2) < e^(2 Re T)."""
    need = bits * math.log(2)
    step = 2 * math.pi * min(STRIP, 0.9 * math.atan(4 / A)) / need
    deep = max(0, math.ceil((A / 2 - 2) * need / 2 / math.log(2)))
    with mp.workprec(bits + deep + _SPARE):
        for y, w in _nodes(step, need, need / 2 + 2 * math.log(need)):
            yield _Node(1 + y, w * _excess(1 + y))


def _nodes(step: float, need: float, end: float) -> Iterator[tuple[mpf, mpf]]:
    """Yield y = exp(t - e^(-t)) and its weight at equal steps of t, from about y = e^-need on."""
    ratio, rising = mp.exp(-mpf(step)), mp.exp(mpf(step))
    start = math.floor(-math.log(need) / step)
    up = mp.exp(start * mpf(step))
    down = 1 / up
    for _ in range(start, math.ceil(math.log(end) / step) + 1):
        y = up * mp.exp(-down)
        yield y, step * y * (1 + down)
        up, down = up * rising, down * ratio


def _excess(T: mpf) -> mpf:
    """Return G - 1 for T >= 1."""
    decay = mp.exp(-2 * T)
    above = 2 * decay * (1 - decay + 2 * T + 2 * T * T)
    return above / ((1 - decay) ** 2 - 4 * T * T * decay)


def _roots(bits: int, eta: mpf, reach: float) -> Iterator[_Node]:
    """Yield T_n and 2 pi g_n H/J0, while e^(-Im T (2 - reach)/(2 eta)) is above 2^-bits."""
    highest = bits * math.log(2) * 2 * float(eta) / (2 - reach)
    for n in range(1, math.floor(highest / math.pi) + 1):
        swell = math.ceil(reach / float(eta) * (n + 1) * math.pi / 2 / math.log(2))
        with mp.workprec(bits + swell + _SPARE):
            T = _root(n, mp.prec)
            residue = (1 + mp.sqrt(1 + T * T)) ** 2 / (2 * T * T)
            # H/J0 at z is 2/(pi i) K0/I0 at -iz.
            yield _Node(T, 4 * residue * mpc(0, -1) * _bessel_quotient(mpc(0, -1) * T / (2 * eta)))


@cache
def _root(n: int, bits: int) -> mpc:
    """Return the root of T - asinh T = i pi n with a positive real part, by Newton's iteration."""
    T = complex(math.log(2 * math.pi * (n + 0.5)), math.pi * (n + 0.5))
    for _ in range(4):
        T -= (T - cmath.asinh(T) - 1j * math.pi * n) / (1 - 1 / cmath.sqrt(1 + T * T))
    steps = [bits]
    while steps[-1] > 90:
        steps.append(steps[-1] // 2 + 8)
    root = mpc(T)
    for prec in reversed(steps):
        with mp.workprec(prec):
            slope = 1 - 1 / mp.sqrt(1 + root * root)
            root -= (root - mp.asinh(root) - mpc(0, n) * mp.pi) / slope
    return root


def _bessel_quotient(w: mpc) -> mpc:
    """Return K0/I0 from their power series, with an absolute error of the working precision.

    With t_m = (w/2)^(2m)/m!^2 and harmonic numbers H_m, I0 = sum t_m and
    K0 = -(log(w/2) + gamma) I0 + sum H_m t_m, where sum H_m t_m = sum_m (I0 - t_0 ... - t_(m-1))/m.
    """
    bits, square = mp.prec + 2 * _SPARE, w * w / 4
    re, im = fixed(square.real, bits), fixed(square.imag, bits)
    x, y, m = 1 << bits, 0, 0
    partial = [(0, 0)]
    far = float(abs(square))
    while m * m < far or abs(x) + abs(y) > 4:
        partial.append((partial[-1][0] + x, partial[-1][1] + y))
        m += 1
        x, y = (x * re - y * im >> bits) // (m * m), (x * im + y * re >> bits) // (m * m)
    whole = partial[-1]
    above = [sum((whole[i] - partial[m][i]) // m for m in range(1, len(partial))) for i in (0, 1)]
    with mp.workprec(bits):
        return mpc(*above) / mpc(*whole) - mp.log(w / 2) - mp.euler


@dataclass
class _Term:
    """Product weight (half T)^(2j)/(2j+1)! of a node, real if `im` is None, times 2^(bits + swell).

    It has `swell` additional binary places for the growth of its power series, e^(half |T|).
    """

    swell: int
    far: float
    square: tuple[int, int]
    re: int
    im: int | None

    def advance(self, step: int, bits: int) -> None:
        """Multiply by (half T)^2 and divide by `step`, the next factors of the factorial."""
        (x, y), more = self.square, bits + self.swell
        if self.im is None:
            self.re = (self.re * x >> more) // step
            return
        re, im = self.re, self.im
        self.re, self.im = (re * x - im * y >> more) // step, (re * y + im * x >> more) // step

    def is_nonzero(self, step: int) -> bool:
        """Return whether a term is nonzero, or a later one may be."""
        return self.far > step or abs(self.re) > 1 or abs(self.im or 0) > 1


def _powers(nodes: list[_Node], half: mpf, bits: int) -> Iterator[int | None]:
    """Yield sums over the nodes (imaginary parts for poles), j = 0, 1, ...; None after the last."""
    running = []
    for T, weight in nodes:
        swell = math.ceil(float(half * abs(T)) / math.log(2))
        with mp.workprec(bits + swell + _SPARE):
            square, more = (half * T) ** 2, bits + swell
            parts = fixed(mp.re(square), more), fixed(mp.im(square), more)
            im = fixed(weight.imag, more) if isinstance(weight, mpc) else None
            running.append(_Term(swell, float(abs(square)), parts, fixed(weight.real, more), im))
    j = 0
    while running:
        yield sum((x.re if x.im is None else x.im) >> x.swell for x in running)
        j += 1
        step = 2 * j * (2 * j + 1)
        for term in running:
            term.advance(step, bits)
        running = [term for term in running if term.is_nonzero(step)]
    while True:
        yield None


@cache
def _laurent(bits: int) -> Scaled:
    """Return g_n of G = sum g_n T^(2n-3), |T| < 4.7, up to negligible terms at T = 1."""
    below: Scaled = []
    coefficients: Scaled = []
    while len(coefficients) < 4 or abs(coefficients[-1]) > 8:
        i = len(coefficients)
        above = (4**i << bits) // math.factorial(2 * i + 1) + (0 if i else 1 << bits)
        below.append((2 ** (2 * i + 3) << bits) // math.factorial(2 * i + 4))
        # T^3 G (sinh^2 T - T^2)/T^4 = 1 + sinh(2T)/(2T), and the divisor begins with 1/3.
        rest = sum(g * below[i - k] for k, g in enumerate(coefficients)) >> bits
        coefficients.append(3 * (above - rest))
    return coefficients


def _near(bits: int, half: mpf, eta: mpf) -> Iterator[int]:
    """Yield (finite part up to T = 1 + low_j) half^(2j)/(2j+1)! for j = 0, 1, ..."""
    more = bits + _SPARE
    laurent, scale, square = _laurent(more), 1 << more, fixed(half * half, more)
    log = mp.euler - mp.log(4 * eta)
    low = [fixed(3 / (8 * eta**2) + log * 6 / 5, more), fixed(6 * log, more)]
    j = 0
    while True:
        powers = ((2 * (n + j - 1), g) for n, g in enumerate(laurent))
        total = sum(g // power for power, g in powers if power) - (1 << more) // (2 * j + 1)
        total += low[j] if j < len(low) else 0
        yield total * scale >> more + _SPARE
        j += 1
        scale = (scale * square >> more) // (2 * j * (2 * j + 1))
