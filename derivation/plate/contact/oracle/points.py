"""Arb reference to any number of digits: the modal sum at finitely many points, as a power series.

For an even entire k with |k(w)| <= e^|Im w| and 0 < alpha < 1 the sum identity
(`contact.theory.split`) gives the functional L of `sums` as a part of the finite radius and one of
the finite thickness,

    L = -1/pi int_0^oo k(i alpha y) K0(y)/I0(y) dy + sum k(alpha j) (G(2 eta j) - 1)/(j J1(j)^2).

By parts, (K0/I0)' = -1/(y I0^2), the first integral is int k^(alpha y)/I0^2 dy with
k^(w) = int_0^1 k(i w s) ds, which `lateral` replaces by a finite sum; the second part is truncated
after N modes. With k(w) = sum (-1)^m C_m w^(2m) the result is a power series in alpha,

    L = sum (-1)^m C_m L_m alpha^(2m),
    L_m = (-1)^(m+1)/(pi (2m+1)) sum p y^(2m) + sum q j^(2m),

with the same L_m for all weight functions k. All truncation errors are bounded and added to the
radii of the balls.
"""

import math
from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import lru_cache
from typing import NamedTuple

import flint
from flint import acb, arb, arb_poly

from derivation.engine.formula.ball import PrecisionError, to_ball
from derivation.mathematics.bessel.oracle import j0_zero
from derivation.plate.contact.oracle.lateral import Points, lateral_points
from derivation.plate.contact.oracle.sums import COEFFICIENTS, FACTORS, plate_excess

PLATES = 64
"""Number of cached plates, limited by memory."""
DEEPEST = 1.5
"""Largest a/(4h). Above 1 the modes' powers cancel, and the bits needed grow as a/(4h)."""

_SPARE = 64


class PointSeries(NamedTuple):
    """L as a power series up to a largest contact.

    Attributes
    ----------
    powers
        By weight function of `sums`, (-1)^m C_m L_m (see the module) as coefficients of x^m [1],
        x = alpha^2.
    reach
        Largest alpha = a/b [1] for which `rest` is a bound.
    rest
        Upper bound of the truncation error of L [1], for each of the weight functions.
    working
        Working precision [bits] of the sums of powers, which cancel for a > 4h.
    """

    powers: Mapping[str, arb_poly]
    reach: arb
    rest: arb
    working: int

    def excess(self, name: str, alpha: arb) -> arb:
        """Return the plate's correction of Hertz, see `sums.excess`.

        Raises
        ------
        PrecisionError
            If alpha = a/b exceeds the reach.
        """
        if not (alpha > 0 and alpha <= self.reach):
            raise PrecisionError(f"the series is valid for a/b up to {self.reach}, got {alpha}")
        with flint.ctx.workprec(max(flint.ctx.prec, self.working)):
            value = self.powers[name](alpha * alpha) + arb(0, self.rest)
        return FACTORS[name] * alpha / arb.pi() * value

    def slope(self, alpha: arb) -> tuple[arb_poly, arb]:
        """Return p of `BallLaw.slope`: exact coefficients, and a bound of p's error on [0, 1]."""
        factor, square = FACTORS["sinc"] * alpha / arb.pi(), alpha * alpha
        error, exact, power = factor * self.rest, [], factor
        for term in self.powers["sinc"].coeffs():
            value = term * power
            exact.append(value.mid())
            error += value.rad()
            power *= square
        return arb_poly(exact), error.abs_upper()


def mode_count(eta: float, bits: int) -> int:
    """Return the approximate number of modes for a precision, with T >= 3 at the last one."""
    least = math.ceil(1 / eta)
    return max(
        least, math.ceil((bits + 2 * math.log2(bits / eta) + 8) * math.log(2) / (4 * math.pi * eta))
    )


def prepare(eta: Fraction, reach: float, bits: int, progress: Callable[[int, int], None]) -> None:
    """Compute the zeros that `series` uses; `progress` is called with each index and the total."""
    precision = working_bits(eta, reach, bits) + _SPARE
    count = mode_count(float(eta), bits)
    for index in range(1, count + 1):
        progress(index, count)
        j0_zero(index, precision)


def working_bits(eta: Fraction, reach: float, bits: int) -> int:
    """Return the precision of the sums of `series`: for a > 4h their terms cancel.

    The weight of the last mode is e^(-4 eta j) = 2^-bits, and its powers add up to e^(alpha j)
    times that.
    """
    return math.ceil(bits * max(1.0, reach / (4 * float(eta)))) + _SPARE


@lru_cache(maxsize=PLATES)
def mode_points(eta: Fraction, bits: int, working: int) -> Points:
    """Return zeros j and q = (G(2 eta j) - 1)/(j J1(j)^2) of the first modes.

    Bound of the omitted modes: x (J0^2 + Y0^2) rises to 2/pi (Watson, 13.74), and is
    4/(pi^2 j J1^2) at j, so that 1/(j J1^2) < pi/2 < 2. For T = 2 eta j >= 3, where T^2 e^(-T)
    decreases, G - 1 < 7 T^2 e^(-2T) (`sums`). As j_(N+1) > (N + 3/4) pi and zeros are more than 3
    apart (`bessel.oracle`), with T' = 2 eta (N + 3/4) pi all following terms add up to less than
    14 T'^2 e^(-2T')/(1 - e^(-6 eta)), if |k| <= 1 on the real axis.

    Parameters
    ----------
    eta
        h/b [1].
    bits
        The truncation error is below about 2^-bits.
    working
        Precision of zeros and weights.

    Raises
    ------
    PrecisionError
        If the modes end before the bound is valid.
    """
    with flint.ctx.workprec(working + _SPARE):
        scale, places, weights = 2 * to_ball(eta), [], []
        count = mode_count(float(eta), bits)
        for index in range(1, count + 1):
            j = j0_zero(index, working + _SPARE)
            places.append(j)
            weights.append(plate_excess(acb(scale * j)).real / (j * j.bessel_j(1) ** 2))
        last = scale * arb.pi() * (count + arb(3) / 4)
        if not last >= 3:
            raise PrecisionError(f"the modes end at T = {last}, too early for their bound")
        rest = 14 * last**2 * (-2 * last).exp() / (1 - (-3 * scale).exp())
        return Points(tuple(places), tuple(weights), rest.abs_upper())


@lru_cache(maxsize=PLATES)
def series(eta: Fraction, reach: float, bits: int) -> PointSeries:
    """Return L for a/b up to `reach`, with truncation errors below about 2^-bits.

    Because C_m is at most 1/(2m+1)!, the remainder of the weight functions' series at the points
    after M terms is below 2 alpha^(2M)/(2M+1)! (sum p y^(2M) + sum q j^(2M)). This requires that
    the largest w = alpha y or alpha j has w^2 <= (2M + 2) (2M + 3)/2, so that terms halve.

    Parameters
    ----------
    eta
        h/b [1].
    reach
        Largest a/b [1], below 1.
    bits
        Precision; for a > 4h the working precision is higher, because terms cancel.

    Raises
    ------
    ValueError
        Unless 0 < reach < 1.
    PrecisionError
        If the contact radius exceeds 4 h DEEPEST.
    """
    if not 0 < reach < 1:
        raise ValueError(f"the law is defined for 0 < a/b < 1, got {reach}")
    depth = reach / (4 * float(eta))
    if depth > DEEPEST:
        raise PrecisionError(f"the series is valid up to a/(4h) = {DEEPEST}, got {depth:.4g}")
    working = working_bits(eta, reach, bits)
    lateral, modes = lateral_points(working), mode_points(eta, bits, working)
    with flint.ctx.workprec(working):
        alpha, small = arb(reach), arb(2) ** -bits
        farthest = (alpha * lateral.places[-1].max(modes.places[-1])) ** 2
        first, second = list(lateral.weights), list(modes.weights)
        squares = [y * y for y in lateral.places], [j * j for j in modes.places]
        moments: list[arb] = []
        bound = arb(2)
        while True:
            m = len(moments)
            sides = sum(first, arb(0)), sum(second, arb(0))
            rest = bound * (sides[0] + sides[1])
            if rest < small and farthest <= (m + 1) * (2 * m + 3):
                break
            moments.append((-1) ** (m + 1) * sides[0] / (arb.pi() * (2 * m + 1)) + sides[1])
            first = [p * y for p, y in zip(first, squares[0], strict=True)]
            second = [q * j for q, j in zip(second, squares[1], strict=True)]
            bound *= alpha * alpha / ((2 * m + 2) * (2 * m + 3))
        rest += lateral.rest / arb.pi() + modes.rest
        powers = {
            name: arb_poly([(-1) ** m * arb(size(m)) * term for m, term in enumerate(moments)])
            for name, size in COEFFICIENTS.items()
        }
        return PointSeries(powers, alpha, rest.abs_upper(), working)
