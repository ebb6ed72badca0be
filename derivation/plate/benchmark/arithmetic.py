"""Arithmetics for one and the same sum: NumPy floats of any width, mpmath, and Arb balls.

Each knows zeros of J0, s(y) = sin y - y cos y and its hyperbolic counterpart, and the
plate factor, to its own precision; arrays hold its numbers.
"""

import math
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any, Protocol

import flint
import numpy as np
from flint import acb, arb
from mpmath import mp, mpf

from derivation.engine.formula.ball import LOG2_10
from derivation.engine.oracle.agreement import to_ball
from derivation.mathematics.bessel import oracle as certified
from derivation.plate.benchmark.far_zeros import FIRST, far_zeros
from derivation.plate.contact.oracle.sums import kernel, plate_excess
from generated.bessel import bessel_j0_zeros, bessel_j1_at_j0_zeros

Array = Any
"""NumPy array of an arithmetic's numbers."""

SERIES_END = 1.6
"""Below this s(y) is summed as a power series: its closed form cancels."""


class Arithmetic(Protocol):
    """What a sum asks of its numbers."""

    name: str
    digits: int
    """Decimal digits its numbers hold."""
    wide: bool
    """Whether numbers are objects, taken one by one."""

    def context(self) -> AbstractContextManager[Any]:
        """Where its precision holds."""

    def array(self, values: Any) -> Array:
        """Doubles, balls or a single one of them as an array of its numbers."""

    def zeros(self, count: int) -> tuple[Array, Array]:
        """The first zeros j_n of J0, and J1(j_n)."""

    def shape(self, y: Array) -> Array:
        """s(y) = sin y - y cos y."""

    def wall_shape(self, t: Array) -> Array:
        """t cosh t - sinh t = s(i t) i."""

    def excess(self, T: Array) -> Array:
        """G(T) - 1."""

    def printed_factor(self, x: Array) -> Array:
        """Plate factor as the paper prints it, x = phi h."""


class Floats:
    """NumPy floats: Taylor series where closed forms cancel, found anew for each width."""

    wide = False

    def __init__(self, name: str, dtype: type[np.floating[Any]]) -> None:
        self.name, self.dtype = name, np.dtype(dtype)
        accuracy = np.finfo(dtype)
        self.digits = int(accuracy.precision) + 1
        least = float(accuracy.eps) / 64
        self._odd = self._series(
            lambda k: mpf(2 * k + 2) / mp.factorial(2 * k + 3), SERIES_END, least
        )
        self._even = self._series(
            lambda k: mpf(2) ** (2 * k + 3) / mp.factorial(2 * k + 4), 2.0, least
        )

    def _series(self, term: Callable[[int], mpf], end: float, least: float) -> Array:
        """Coefficients of a power series in x^2 up to those too small to count at x = end."""
        with mp.workdps(self.digits + 10):
            terms = [term(0)]
            while terms[-1] * end ** (2 * len(terms)) > least * terms[0]:
                terms.append(term(len(terms)))
            return np.array([self.dtype.type(mp.nstr(x, self.digits + 5)) for x in terms])

    def context(self) -> AbstractContextManager[Any]:
        """Overflow is a result here, not an error."""
        return np.errstate(all="ignore")

    def array(self, values: Any) -> Array:
        """Balls are rounded by way of 25 decimals."""
        if isinstance(values, arb):
            return self.dtype.type(values.str(25, radius=False))
        if isinstance(values, list) and values and isinstance(values[0], arb):
            return np.array([self.array(value) for value in values])
        return np.asarray(values, self.dtype)

    def zeros(self, count: int) -> tuple[Array, Array]:
        """From the generated code up to double precision; beyond it certified ones, then far."""
        if self.dtype.itemsize <= 8:
            return self.array(bessel_j0_zeros(count)), self.array(bessel_j1_at_j0_zeros(count))
        near = range(1, min(count, FIRST) + 1)
        j = [certified.j0_zero(n, 80) for n in near]
        slopes = [certified.j1_at_zero(n, 80) for n in near]
        with flint.ctx.workprec(96):
            found, pi = (self.array(j), self.array(slopes)), self.array(arb.pi())
        if count <= FIRST:
            return found
        far = far_zeros(FIRST, count, pi)
        return np.concatenate([found[0], far[0]]), np.concatenate([found[1], far[1]])

    def _taylor(self, y: Array, sign: int) -> Array:
        t = np.minimum(y, self.array(SERIES_END)) ** 2
        value = np.full_like(t, self._odd[-1])
        for coefficient in self._odd[-2::-1]:
            value = value * (sign * t) + coefficient
        return value

    def shape(self, y: Array) -> Array:
        """Power series below SERIES_END."""
        return np.where(
            y < SERIES_END, self._taylor(y, -1) * (y * y * y), np.sin(y) - y * np.cos(y)
        )

    def wall_shape(self, t: Array) -> Array:
        """The same series without the alternating sign."""
        return np.where(
            t < SERIES_END, self._taylor(t, 1) * (t * t * t), t * np.cosh(t) - np.sinh(t)
        )

    def excess(self, T: Array) -> Array:
        """4 e^(-2T) n/((1 - e^(-2T))^2 - 4 T^2 e^(-2T)), the denominator by its series below 2."""
        decay = np.exp(-2 * T)
        numerator = -np.expm1(-2 * T) / 2 + T + T * T
        near = np.minimum(T, self.array(2.0))
        square = near * near
        series = np.full_like(square, self._even[-1])
        for coefficient in self._even[-2::-1]:
            series = series * square + coefficient
        apart = np.where(T > 2, (1 - decay) ** 2 - 4 * T * T * decay, self.array(1.0))
        return np.where(T > 2, 4 * decay * numerator / apart, numerator / (square**2 * series))

    def printed_factor(self, x: Array) -> Array:
        """Overflows from x = 88.7 on in doubles."""
        return _printed_factor(x, np.exp(2 * x))


class Wide:
    """Numbers of any precision, as objects in arrays; each function takes them one by one."""

    wide = True
    name: str
    digits: int

    def array(self, values: Any) -> Array:
        """Every number converted; an array without axes stays one number."""
        if isinstance(values, list | np.ndarray):
            flat = [self._number(value) for value in np.ravel(np.array(values, dtype=object))]
            return np.array(flat, dtype=object)
        return self._number(values)

    def _number(self, value: Any) -> Any:
        raise NotImplementedError

    def _shape(self, y: Any) -> Any:
        raise NotImplementedError

    def _wall_shape(self, t: Any) -> Any:
        raise NotImplementedError

    def _excess(self, T: Any) -> Any:
        raise NotImplementedError

    def _printed(self, x: Any) -> Any:
        raise NotImplementedError

    def shape(self, y: Array) -> Array:
        """Each by itself."""
        return np.frompyfunc(self._shape, 1, 1)(y)

    def wall_shape(self, t: Array) -> Array:
        """Each by itself."""
        return np.frompyfunc(self._wall_shape, 1, 1)(t)

    def excess(self, T: Array) -> Array:
        """Each by itself."""
        return np.frompyfunc(self._excess, 1, 1)(T)

    def printed_factor(self, x: Array) -> Array:
        """Each by itself."""
        return np.frompyfunc(self._printed, 1, 1)(x)


class BallArithmetic(Wide):
    """Arb: every result encloses the exact one."""

    def __init__(self, digits: int) -> None:
        self.name, self.digits = f"Arb, {digits} digits", digits
        self.bits = math.ceil(digits * LOG2_10) + 24

    def context(self) -> AbstractContextManager[Any]:
        """Its precision and some bits to spare."""
        manager: AbstractContextManager[Any] = flint.ctx.workprec(self.bits)
        return manager

    def _number(self, value: Any) -> arb:
        return value if isinstance(value, arb) else arb(float(value))

    def zeros(self, count: int) -> tuple[Array, Array]:
        """Certified ones."""
        j = [certified.j0_zero(n, self.bits + 16) for n in range(1, count + 1)]
        slopes = [certified.j1_at_zero(n, self.bits) for n in range(1, count + 1)]
        return np.array(j, dtype=object), np.array(slopes, dtype=object)

    def _shape(self, y: arb) -> arb:
        return kernel("hertz", acb(y)).real * y**3 / 3

    def _wall_shape(self, t: arb) -> arb:
        return kernel("hertz", acb(0, t)).real * t**3 / 3

    def _excess(self, T: arb) -> arb:
        return plate_excess(acb(T)).real

    def _printed(self, x: arb) -> arb:
        # 1 - e^(8x) against 8 x e^(4x) costs up to 3 log2(1/x) bits.
        with flint.ctx.workprec(self.bits + 64):
            return _printed_factor(x, (2 * x).exp())


class Mpmath(Wide):
    """mpmath at a number of digits; where closed forms cancel it takes more."""

    def __init__(self, digits: int) -> None:
        self.name, self.digits = f"mpmath, {digits} digits", digits

    def context(self) -> AbstractContextManager[Any]:
        """Its precision and some digits to spare."""
        manager: AbstractContextManager[Any] = mp.workdps(self.digits + 3)
        return manager

    def _number(self, value: Any) -> mpf:
        if isinstance(value, arb):
            return mpf(value.str(self.digits + 8, radius=False))
        return mpf(float(value))

    def zeros(self, count: int) -> tuple[Array, Array]:
        """Arb's, since finding them is not what is compared."""
        with flint.ctx.workprec(math.ceil((self.digits + 10) * LOG2_10) + 24):
            j, slopes = BallArithmetic(self.digits + 10).zeros(count)
            return self.array(j), self.array(slopes)

    def _shape(self, y: mpf) -> mpf:
        with mp.extradps(_lost(y, 3)):
            cosine, sine = mp.cos_sin(y)
            return sine - y * cosine

    def _wall_shape(self, t: mpf) -> mpf:
        with mp.extradps(_lost(t, 3)):
            return t * mp.cosh(t) - mp.sinh(t)

    def _excess(self, T: mpf) -> mpf:
        with mp.extradps(_lost(T, 4)):
            decay = mp.exp(-2 * T)
            numerator = (1 - decay) / 2 + T + T * T
            return 4 * decay * numerator / ((1 - decay) ** 2 - 4 * T * T * decay)

    def _printed(self, x: mpf) -> mpf:
        return _printed_factor(x, mp.exp(2 * x))


def _lost(x: mpf, power: int) -> int:
    """Digits that a difference of the order x^power loses."""
    return 5 + max(0, int(-power * mp.log10(x)) + 1)


def _printed_factor(x: Any, e2: Any) -> Any:
    e4 = e2 * e2
    return (1 - e4 * e4 - 8 * x * e4) / ((-1 + e4 + 4 * x * e2) * (1 - e4 + 4 * x * e2))


SINGLE = Floats("float32", np.float32)
DOUBLE = Floats("float64", np.float64)
LONG = Floats("long double", np.longdouble)
HAS_LONG = LONG.digits > DOUBLE.digits
"""Whether the platform's long double is any longer than double."""


def as_ball(value: Any) -> arb:
    """Any arithmetic's number, exactly."""
    if isinstance(value, arb):
        return value
    if isinstance(value, mpf):
        return to_ball(value)
    if isinstance(value, np.longdouble):
        high = float(value)
        return arb(high) + arb(float(value - np.longdouble(high)))
    return arb(float(value))
