"""One method in several kinds of arithmetic: NumPy floats of any width, mpmath, and Arb balls.

Each computes zeros of J0, s(y) = sin y - y cos y with its hyperbolic counterpart, and the plate
factor to its own precision. Arrays contain its numbers.
"""

import math
from collections.abc import Callable
from contextlib import AbstractContextManager
from fractions import Fraction
from functools import cache
from typing import Any

import flint
import numpy as np
from flint import acb, arb
from mpmath import mp, mpc, mpf

from derivation.engine.formula.ball import LOG2_10
from derivation.engine.oracle.agreement import to_ball
from derivation.mathematics.bessel import oracle as certified
from derivation.mathematics.bessel.theory.zeros import slope_squared, zero_correction
from derivation.plate.contact.oracle.sums import kernel, plate_excess
from generated.bessel import bessel_j0_zeros, bessel_j1_at_j0_zeros

Array = Any
"""NumPy array of an arithmetic's numbers."""

SERIES_END = 1.6
"""|y| below which floats sum s(y) as a power series, because its closed form cancels."""

TERMS = 12, 17
"""Numbers of terms for s(y) and for the plate factor's denominator; the rest is below 1e-20."""

FAR, FAR_TERMS = 1000, 4
"""Index beyond which zeros in long doubles are computed by McMahon's expansion, and its number of
terms: the omitted ones are less than 1e-26 of the value."""

KNOWN = 1 << 16
"""Number of zeros that are computed in doubles by the generated code."""


class Arithmetic:
    """The operations that a method needs.

    Attributes
    ----------
    digits, constants
        Numbers of decimal digits of its numbers, and of constants.
    wide
        Whether numbers are objects, evaluated one by one.
    """

    name: str
    digits: int
    constants: int
    wide: bool
    exp: Callable[[Array], Array]
    log: Callable[[Array], Array]

    @property
    def bits(self) -> int:
        """Precision of constants [bits], with a margin."""
        return math.ceil(LOG2_10 * (self.constants + 10)) + 24

    def context(self) -> AbstractContextManager[Any]:
        """Return a context in which its precision is set."""
        raise NotImplementedError

    def number(self, value: Any) -> Any:
        """Convert a double, a ball or a number of this arithmetic to one of this arithmetic."""
        raise NotImplementedError

    def array(self, values: Any) -> Array:
        """Convert each number to one of this arithmetic."""
        raise NotImplementedError

    def for_doubles(self, inner: Callable[[Array], Array]) -> Callable[[Any], Array]:
        """Convert a function of numbers of this arithmetic to one of doubles, in its precision."""

        def call(values: Any) -> Array:
            with self.context():
                return inner(self.array(values))

        return call

    def pi(self) -> Any:
        """Return the number pi."""
        with flint.ctx.workprec(self.bits):
            return self.number(arb.pi())

    def zeros(self, count: int) -> tuple[Array, Array]:
        """Return the first zeros j_n of J0, and J1(j_n)."""
        with flint.ctx.workprec(self.bits):
            j = [certified.j0_zero(n, self.bits + 16) for n in range(1, count + 1)]
            slopes = [certified.j1_at_zero(n, self.bits) for n in range(1, count + 1)]
            return self.array(j), self.array(slopes)

    def shape(self, y: Array) -> Array:
        """Return s(y) = sin y - y cos y."""
        raise NotImplementedError

    def lateral_shape(self, t: Array) -> Array:
        """Return t cosh t - sinh t = s(i t) i."""
        raise NotImplementedError

    def complex_shape(self, y: Array) -> Array:
        """Return (1 - i y) e^(iy), whose imaginary part is s(y)."""
        raise NotImplementedError

    def excess(self, T: Array) -> Array:
        """Return G(T) - 1."""
        raise NotImplementedError

    def printed_factor(self, x: Array) -> Array:
        """Return the plate factor as published, x = phi h."""
        raise NotImplementedError


class Floats(Arithmetic):
    """NumPy floats: Taylor series where closed forms cancel, computed for each width."""

    wide, constants, exp, log = False, 60, np.exp, np.log

    def __init__(self, name: str, dtype: type[np.floating[Any]]) -> None:
        self.name, self.dtype = name, np.dtype(dtype)
        self.digits = int(np.finfo(dtype).precision) + 1
        odd, even = map(range, TERMS)
        with flint.ctx.workprec(self.bits):
            self._sinh = self.array([arb(2 * k + 2) / math.factorial(2 * k + 3) for k in odd])
            self._even = self.array(
                [arb(2) ** (2 * k + 3) / math.factorial(2 * k + 4) for k in even]
            )
        self._sine = self._sinh * self.array((-1.0) ** np.arange(len(odd)))

    def context(self) -> AbstractContextManager[Any]:
        """Return a context in which overflow is a result, not an error."""
        return np.errstate(all="ignore")

    def number(self, value: Any) -> Any:
        """Return balls rounded by way of 25 decimals."""
        given = value.str(25, radius=False) if isinstance(value, arb) else value
        return self.dtype.type(given)

    def array(self, values: Any) -> Array:
        """Return each number as a float."""
        if isinstance(values, list):
            values = [self.number(value) for value in values]
        return np.asarray(values, self.dtype)

    def for_doubles(self, inner: Callable[[Array], Array]) -> Callable[[Any], Array]:
        """Return the function of doubles unchanged."""
        return inner if self is DOUBLE else lambda values: inner(values.astype(self.dtype))

    def zeros(self, count: int, begin: int = 0) -> tuple[Array, Array]:
        """Return zeros with begin < n <= count: known ones, and others by McMahon's expansion."""
        known = min(count, KNOWN if self.digits <= 16 else FAR)
        if self.digits <= 16:
            near = self.array(bessel_j0_zeros(known)), self.array(bessel_j1_at_j0_zeros(known))
        else:
            near = super().zeros(known)
        if count == known:
            return near[0][begin:], near[1][begin:]
        far = self._far(max(begin, known), count)
        j, slope = (np.concatenate([x[begin:], y]) for x, y in zip(near, far, strict=True))
        return j, slope

    def _far(self, begin: int, end: int) -> tuple[Array, Array]:
        """Return j = beta (1 + s) and J1(j)^2 = 2 q/(pi beta), beta = (n - 1/4) pi.

        s and q are in powers of 1/beta^2 (McMahon 1894; DLMF 10.21.19 and 10.21.20).
        """
        n, pi = np.arange(begin + 1, end + 1).astype(self.dtype), self.pi()
        beta = (n - self.number(0.25)) * pi
        w = 1 / (beta * beta)
        stretch, slope = (horner(self.array(row), w) for row in mcmahon())
        return beta * (1 + w * stretch), np.sqrt(2 * slope / (pi * beta)) * np.where(n % 2, 1, -1)

    def shape(self, y: Array) -> Array:
        """Return the power series, for y below SERIES_END."""
        near = np.minimum(y, self.number(SERIES_END))
        series = horner(self._sine, near * near) * (y * y * y)
        return np.where(y < SERIES_END, series, np.sin(y) - y * np.cos(y))

    def lateral_shape(self, t: Array) -> Array:
        """Return the series of `shape` without alternating signs."""
        near = np.minimum(t, self.number(SERIES_END))
        series = horner(self._sinh, near * near) * (t * t * t)
        return np.where(t < SERIES_END, series, t * np.cosh(t) - np.sinh(t))

    def complex_shape(self, y: Array) -> Array:
        """Return the closed form."""
        return (1 - 1j * y) * np.exp(1j * y)

    def excess(self, T: Array) -> Array:
        """Return 4 e^(-2T) n/((1 - e^(-2T))^2 - 4 T^2 e^(-2T)), by series for T < 2."""
        decay = np.exp(-2 * T)
        numerator = -np.expm1(-2 * T) / 2 + T + T * T
        near = np.minimum(T, self.number(2.0))
        square = near * near
        apart = np.where(T > 2, (1 - decay) ** 2 - 4 * T * T * decay, self.number(1.0))
        small = numerator / (square * square * horner(self._even, square))
        return np.where(T > 2, 4 * decay * numerator / apart, small)

    def printed_factor(self, x: Array) -> Array:
        """Return the published form, which overflows in doubles from x = 88.7 on."""
        return _printed_factor(x, np.exp(2 * x))


class Wide(Arithmetic):
    """Numbers of any precision, as objects in arrays; a function evaluates them one by one."""

    wide = True

    def array(self, values: Any) -> Array:
        """Return every number converted; an array without axes stays one number."""
        if isinstance(values, list | np.ndarray):
            flat = [self.number(value) for value in np.ravel(np.array(values, dtype=object))]
            return np.array(flat, dtype=object)
        return self.number(values)


class BallArithmetic(Wide):
    """Arb: every result encloses the exact one."""

    def __init__(self, digits: int) -> None:
        self.name, self.digits, self.constants = f"Arb, {digits} digits", digits, digits + 10

    def context(self) -> AbstractContextManager[Any]:
        """Return a context with some additional bits of precision."""
        manager: AbstractContextManager[Any] = flint.ctx.workprec(
            math.ceil(self.digits * LOG2_10) + 24
        )
        return manager

    def number(self, value: Any) -> Any:
        """Return the exact number."""
        return value if isinstance(value, arb) else arb(float(value))

    def shape(self, y: Array) -> Array:
        """Return the function of the Arb reference, which uses a power series."""
        return np.frompyfunc(lambda x: kernel("hertz", acb(x)).real * x**3 / 3, 1, 1)(y)

    def lateral_shape(self, t: Array) -> Array:
        """Return the function of `shape` on the imaginary axis."""
        return np.frompyfunc(lambda x: kernel("hertz", acb(0, x)).real * x**3 / 3, 1, 1)(t)

    def excess(self, T: Array) -> Array:
        """Return the Arb reference's function."""
        return np.frompyfunc(lambda x: plate_excess(acb(x)).real, 1, 1)(T)


class Mpmath(Wide):
    """mpmath at a number of digits; where closed forms cancel it uses more."""

    exp, log = np.frompyfunc(mp.exp, 1, 1), np.frompyfunc(mp.log, 1, 1)

    def __init__(self, digits: int, constants: int | None = None) -> None:
        self.name, self.digits = f"mpmath, {digits} digits", digits
        self.constants = constants or digits + 10

    def context(self) -> AbstractContextManager[Any]:
        """Return a context with some additional digits of precision."""
        manager: AbstractContextManager[Any] = mp.workdps(self.digits + 3)
        return manager

    def number(self, value: Any) -> Any:
        """Return balls rounded by way of decimals."""
        if isinstance(value, arb):
            return mpf(value.str(self.digits + 8, radius=False))
        return value if isinstance(value, mpf) else mpf(float(value))

    def shape(self, y: Array) -> Array:
        """Return the closed form."""
        return self._each(lambda x, c, s: s - x * c, 3, y)

    def lateral_shape(self, t: Array) -> Array:
        """Return the closed form."""
        return self._each(lambda x, *_: x * mp.cosh(x) - mp.sinh(x), 3, t)

    def complex_shape(self, y: Array) -> Array:
        """Return the value from its parts."""
        return self._each(lambda x, c, s: mpc(c + x * s, s - x * c), 0, y)

    def excess(self, T: Array) -> Array:
        """Return the value in decaying exponentials."""

        def function(x: mpf, *_: mpf) -> mpf:
            decay = mp.exp(-2 * x)
            numerator = (1 - decay) / 2 + x + x * x
            return 4 * decay * numerator / ((1 - decay) ** 2 - 4 * x * x * decay)

        return self._each(function, 4, T)

    def printed_factor(self, x: Array) -> Array:
        """Return the published form."""
        return self._each(lambda x, *_: _printed_factor(x, mp.exp(2 * x)), 3, x)

    def _each(self, function: Callable[..., Any], power: int, values: Array) -> Array:
        """Return a function of a number, its cosine and sine that cancels like its power."""

        def one(x: mpf) -> Any:
            with mp.extradps(5 + max(0, math.ceil(-power * math.log10(float(x))))):
                return function(x, *mp.cos_sin(x))

        return np.frompyfunc(one, 1, 1)(values)


def horner(coefficients: Any, x: Array) -> Array:
    """Return a polynomial, its constant first."""
    value = coefficients[-1] + 0 * x
    for coefficient in coefficients[-2::-1]:
        value *= x
        value += coefficient
    return value


def _printed_factor(x: Any, e2: Any) -> Any:
    e4 = e2 * e2
    return (1 - e4 * e4 - 8 * x * e4) / ((-1 + e4 + 4 * x * e2) * (1 - e4 + 4 * x * e2))


@cache
def mcmahon() -> list[list[arb]]:
    """Return the coefficients of s/w and q of `Floats._far`, w = 1/beta^2."""
    rows = zero_correction(0, FAR_TERMS).coefficients, slope_squared(FAR_TERMS).coefficients
    with flint.ctx.workprec(96):
        return [[arb(int(c.p)) / int(c.q) for c in row] for row in rows]


SINGLE = Floats("float32", np.float32)
DOUBLE = Floats("float64", np.float64)
LONG_DOUBLE = Floats("long double", np.longdouble)
HAS_LONG_DOUBLE = LONG_DOUBLE.digits > DOUBLE.digits
"""Whether a long double of this platform has more digits than a double."""

WIDE = 60
"""Smallest number of digits of the arithmetic that is used as exact."""


def exact_for(ar: Arithmetic) -> Arithmetic:
    """Return an arithmetic with enough digits to show the rounding errors of another one.

    Both use the same digits for constants, so that these are computed once.
    """
    digits = max(WIDE, ar.digits + 10)
    return Mpmath(digits, digits)


def as_ball(value: Any) -> arb:
    """Return any arithmetic's number, exactly."""
    if isinstance(value, arb):
        return value
    if isinstance(value, mpf):
        return to_ball(value)
    if isinstance(value, np.longdouble):
        high = float(value)
        return arb(high) + arb(float(value - np.longdouble(high)))
    return arb(float(value))


def as_fraction(value: mpf) -> Fraction:
    """Return an mpmath number, exactly."""
    mantissa, exponent = value.man_exp
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
