"""Impact by Hertz's law or its first correction, with bounds of the errors of both.

With A = a/h, eta = h/b and S = (R/2a) d delta/da the contact law satisfies, for every a < b::

    1 + 3/2 c_1 A - K_3 A^3 <= S <= 1 + 3/2 c_1 A

Hence `hertz` (S = 1) and `leading` (S = 1 + 3/2 c_1 A) return bounds of their own errors. These are
proved; rounding errors are counted. One impact takes microseconds, without NumPy.

Arithmetic: margins for rounding; sums of intervals of logarithms; Newton's iteration and its
starting value; ratios and products that show overflow and underflow.
"""

from bisect import bisect_right
from math import expm1, inf, log, log1p
from typing import NamedTuple

from generated.simple_impact_kernels import (
    beside_hertz,
    elasticities,
    hertz_bounds,
    hertz_peaks,
    leading_bounds,
    leading_time,
    peaks,
    sphere,
    steepness,
    thick_plate,
    thin_plate,
    work_step,
)
from generated.simple_impact_numbers import (
    FADED,
    MODES,
    QUADRATURE,
    ROOTS_CUBIC,
    ROOTS_LINEAR,
    THIN,
)

_ZEROS = tuple(zero for zero, _ in MODES)
ORDINARY = 1e-100, 1e100  # range of numbers whose products and roots are rounded as counted
PLATES = 1e-50, 1e50
TOP = 1.02  # bounds apply to radii up to this times the largest radius found
DEEP = 0.5  # c_1 A > -1/3: a negative first correction reduces the slope at most by half
SLACK = 1.0 + 1e-9  # allows for rounding of the bounds themselves
CLOSE = 4e-15  # residual of the equation of the largest radius
STEPS = 40

ROUNDING = 4e-14
"""Bound of the rounding errors, counted: the worst result has fewer than 200 roundings of 2^-53.

The largest radius has 40 of them, 23 because 1/5 is not a double. The force has three times as
many; the contact time has twice as many, plus those of its sum. Powers, roots and logarithms of
the C library are assumed to be accurate to two units in the last place."""


class Plate(NamedTuple):
    """c_1, a bound of its error, and a bound of K_3."""

    bend: float
    bend_error: float
    rest: float


class Estimate(NamedTuple):
    """Contact time [s], peak indentation [m], force [N] and radius [m], with error bounds [1].

    `law` bounds the relative error by the simplified law, `quadrature` that by the integral over
    time and `rounding` that by rounding; each applies to all four results.
    """

    contact_time: float
    max_indentation: float
    max_force: float
    max_contact_radius: float
    law: float
    quadrature: float
    rounding: float


class _Scene(NamedTuple):
    """Hertz's largest contact radius, E*, and the parameters of the impact."""

    radius: float
    modulus: float
    R: float
    v0: float
    h: float
    b: float


def plate_of(eta: float) -> Plate:
    """Return c_1 with its error bound, and a bound of K_3, for eta = h/b from 1e-50 to 1e50."""
    v = 1.0 / eta
    if v > THIN:
        return with_margins_of_thin(*thin_plate(v))
    counted = MODES[: bisect_right(_ZEROS, 0.5 * FADED * v)]  # T = 2 eta j_n <= FADED
    return with_margins_of_thick(*thick_plate(eta, counted))


def with_margins_of_thin(bend: float, rest: float, roots: float) -> Plate:
    """Return a thin plate with margins for rounding and for the omitted roots."""
    return Plate(bend, ROOTS_LINEAR * roots + 1e-14 * bend, rest * SLACK + ROOTS_CUBIC * roots)


def with_margins_of_thick(
    bend: float, size: float, rest: float, more_bend: float, more_rest: float
) -> Plate:
    """Return a thick plate with margins for rounding and for the omitted modes."""
    return Plate(bend, more_bend + 1e-13 * size, rest * SLACK + more_rest)


def hertz(
    R: float, m: float, v0: float, h: float, b: float, lam: float, mu: float
) -> Estimate | None:
    """Compute an impact by Hertz's law, as on a half-space, and a bound of its error.

    Parameters
    ----------
    R, h, b : float
        sphere radius, half the plate's thickness and its radius [m]; above 0
    m : float
        sphere mass [kg]; m > 0
    v0 : float
        impact speed of the sphere [m/s]; v0 > 0
    lam, mu : float
        Lame constants [Pa]; mu > 0, 3 lam > -2 mu

    Returns
    -------
    Estimate or None
        None where no bound is proved: unless 1.02 a < b and 1.02 a < R, for numbers outside the
        ordinary range, and if the slope of the law may vanish.

    Examples
    --------
    >>> from generated.simple_impact import hertz
    >>> result = hertz(0.01, 0.0327, 0.01, 0.4, 4.0, 22.5e9, 28.7e9)
    >>> print(f"{result.max_force:.6g} N, relative error at most {result.law:.1e}")
    5.80118 N, relative error at most 2.9e-03
    """
    scene = _scene(R, m, v0, h, b, lam, mu)
    if scene is None:
        return None
    plate, top = plate_of(h / b), TOP * scene.radius / h
    # The loss of the lower bound is convex: its maximum is at one of the ends.
    low, up = hertz_bounds(plate.bend, plate.bend_error, plate.rest, top)
    law = law_error(max(0.0, low), max(0.0, up), 0.0, 0.0)
    peaks = hertz_peaks(scene.radius, R, v0, scene.modulus)
    return _estimate(scene, scene.radius, peaks, law, 0.0)


def leading(
    R: float, m: float, v0: float, h: float, b: float, lam: float, mu: float
) -> Estimate | None:
    """Compute an impact by delta = (a^2/R) (1 + c_1 a/h), and a bound of its error.

    Parameters and result are those of `hertz`.

    Examples
    --------
    >>> from generated.simple_impact import leading
    >>> result = leading(0.01, 0.0327, 0.01, 0.4, 4.0, 22.5e9, 28.7e9)
    >>> print(f"{result.max_force:.6g} N, relative error at most {result.law:.1e}")
    5.7938 N, relative error at most 2.4e-12
    """
    scene = _scene(R, m, v0, h, b, lam, mu)
    if scene is None:
        return None
    plate, over_h = plate_of(h / b), scene.radius / h
    radius_ratio = _radius_ratio(beside_hertz(plate.bend, over_h))
    A = radius_ratio * over_h
    top = TOP * A
    steep = steepness(plate.bend, top)
    if not steep > -DEEP:
        return None
    # Error of S relative to S_1, which grows with A.
    wrong, low, elasticity = leading_bounds(plate.bend_error, plate.rest, steep, top)
    law = law_error(low + wrong, wrong, max(0.0, -elasticity), max(0.0, elasticity))
    a = radius_ratio * scene.radius
    depth, force = peaks(a, R, scene.modulus, plate.bend * A)
    time = leading_time(a, R, v0, steepness(plate.bend, A))
    return _estimate(scene, a, (time, depth, force), law, QUADRATURE)


def law_error(low: float, up: float, fall: float, rise: float) -> float:
    """Return the largest of `law_errors`."""
    return max(law_errors(low, up, fall, rise))


def law_errors(
    low: float, up: float, fall: float, rise: float, energy: float = 0.0
) -> tuple[float, float, float, float]:
    """Return relative errors of the results if S lies within 1 - low and 1 + up times S_1.

    Parameters
    ----------
    low, up
        not negative [1]; valid up to 1.02 times the largest radius by S_1
    fall, rise
        d log S_1/d log a is between -fall and rise [1]
    energy
        logarithm of the ratio of the largest energy of the contact, work of the weight
        included, to the kinetic energy of the sphere; not negative [1]

    Returns
    -------
    tuple of float
        For contact time, peak indentation, force and contact radius; inf if the radius may
        exceed the range of validity.
    """
    if not (low < 1.0 and up < inf and fall < 2.0):
        return inf, inf, inf, inf
    # Logarithms of the ratios of the true values to those by S_1 lie within these intervals.
    loss, gain = -log1p(-low), log1p(up)
    elasticity, depth, shorter, longer = elasticities(fall, rise)
    wider, narrower = (loss + energy) / elasticity, gain / elasticity
    if not wider < log(TOP):
        return inf, inf, inf, inf
    longer = max(0.0, longer)
    time = max(
        gain + 0.5 * loss + 0.5 * energy + max(longer * wider, shorter * narrower),
        loss + 0.5 * gain + max(shorter * wider, longer * narrower),
    )
    deeper = max(gain + depth * wider, loss + depth * narrower)
    radius = max(wider, narrower)
    return _relative(time), _relative(deeper), _relative(3.0 * radius), _relative(radius)


def _relative(logarithm: float) -> float:
    """Return the relative error for the logarithm of a factor."""
    return expm1(logarithm) * SLACK if logarithm < 700.0 else inf


def _scene(
    R: float, m: float, v0: float, h: float, b: float, lam: float, mu: float
) -> _Scene | None:
    """Return the impact with Hertz's largest radius and E*; None for extreme numbers."""
    modulus, energy, work = sphere(R, m, v0, lam, mu)
    low, high = ORDINARY
    numbers = (R, m, v0, h, b, modulus, energy, energy / modulus, work)
    if not all(low < x < high for x in numbers) or not PLATES[0] < h / b < PLATES[1]:
        return None
    return _Scene(work**0.2, modulus, R, v0, h, b)


def _radius_ratio(y: float) -> float:
    """Return the root s > 0 of s^5 (1 + y s) = 1, the largest radius divided by Hertz's.

    Newton's iteration starts above the root for y > 0, where the left side is convex. For y < 0
    the search ends at s = 2/(-3 y), where convexity ends. NaN if there is no root.
    """
    s = min(1.0, y ** (-1.0 / 6.0)) if y > 0.0 else 1.0
    for _ in range(STEPS):
        excess, slope = work_step(s, y)
        if abs(excess) <= CLOSE:
            return s
        s -= excess / slope
        if not (s > 0.0 and 3.0 * y * s > -2.0):
            break
    return float("nan")


def _estimate(
    scene: _Scene, a: float, peaks: tuple[float, float, float], law: float, quadrature: float
) -> Estimate | None:
    """Return the results if the contact provably stays within the plate and the sphere."""
    if not (law < inf and TOP * a < min(scene.b, scene.R)):
        return None
    return Estimate(*peaks, a, law, quadrature, ROUNDING)
