"""Impacts by Hertz's law and by its first correction: `generated.simple_impact` in arrays.

The formulas are the printed ones for single numbers. In arrays they use the functions of NumPy
instead of those of `math`.
"""

import math
from collections.abc import Callable
from types import FunctionType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from derivation.scene import kernels
from derivation.scene.contact_law.law_errors import law_errors
from generated import simple_impact, simple_impact_kernels
from generated.simple_impact import CLOSE, DEEP, ORDINARY, PLATES, STEPS, TOP
from generated.simple_impact_numbers import MODES, QUADRATURE, THIN

Array = NDArray[np.float64]

_formulas: Any = simple_impact_kernels
"""Printed formulas for single numbers; those without functions of `math` accept arrays."""


def _in_arrays(formula: Callable[..., Any]) -> Callable[..., Any]:
    """Return a printed formula for single numbers as one for arrays."""
    of_numpy = {name: getattr(np, name) for name in ("exp", "log", "sqrt")}
    return FunctionType(formula.__code__, formula.__globals__ | of_numpy, formula.__name__)


_thick_plate = _in_arrays(simple_impact_kernels.thick_plate)
_thin_plate = _in_arrays(simple_impact_kernels.thin_plate)
_leading_time = _in_arrays(simple_impact_kernels.leading_time)


class Estimates(NamedTuple):
    """Columns of `kernels.Estimate`; `law` is infinite where no bound is proved."""

    contact_time: Array
    max_indentation: Array
    max_force: Array
    max_contact_radius: Array
    law: Array
    quadrature: float
    rounding: float


def plates_of(eta: Array) -> kernels.Plate:
    """Return c_1, its error bound and K_3 of many plates, 1e-50 <= h/b <= 1e50."""
    values = np.empty((3, *eta.shape))
    thin = 1.0 / eta > THIN
    values[:, thin] = simple_impact.with_margins_of_thin(*_thin_plate(1.0 / eta[thin]))
    values[:, ~thin] = simple_impact.with_margins_of_thick(*_thick_plate(eta[~thin], MODES))
    return kernels.Plate(*values)


def hertz(R: Array, m: Array, v0: Array, h: Array, b: Array, lam: Array, mu: Array) -> Estimates:
    """Compute impacts by Hertz's law, like `simple_impact.hertz`, for arrays of the same length."""
    modulus, radius, known = _spheres(R, m, v0, h, b, lam, mu)
    plate, top = plates_of(np.where(known, h / b, 1.0)), TOP * radius / h
    low, up = _formulas.hertz_bounds(*plate, top)
    none = np.zeros_like(top)
    law = _law_error(np.maximum(0.0, low), np.maximum(0.0, up), none, none)
    peaks = _formulas.hertz_peaks(radius, R, v0, modulus)
    return _estimates(known, radius, np.minimum(b, R), peaks, law, 0.0)


def leading(R: Array, m: Array, v0: Array, h: Array, b: Array, lam: Array, mu: Array) -> Estimates:
    """Compute impacts by delta = (a^2/R) (1 + c_1 a/h), like `simple_impact.leading`."""
    modulus, radius, known = _spheres(R, m, v0, h, b, lam, mu)
    plate = plates_of(np.where(known, h / b, 1.0))
    A, a, peaks = _with_bending(R, v0, h, modulus, radius, np.asarray(plate.bend))
    top = TOP * A
    steep = _formulas.steepness(plate.bend, top)
    known &= steep > -DEEP
    steep = np.where(known, steep, 0.0)
    wrong, low, rise = _formulas.leading_bounds(*plate[1:], steep, top)
    fall, rise = np.maximum(0.0, -rise), np.maximum(0.0, rise)
    law = _law_error(low + wrong, np.broadcast_to(wrong, low.shape), fall, rise)
    return _estimates(known, a, np.minimum(b, R), peaks, law, QUADRATURE)


def bent(
    R: Array, m: Array, v0: Array, h: Array, b: Array, lam: Array, mu: Array, bend: Array
) -> Estimates:
    """Compute impacts by delta = (a^2/R) (1 + bend a/h), the law of a plate that only bends."""
    modulus, radius, known = _spheres(R, m, v0, h, b, lam, mu)
    _, a, peaks = _with_bending(R, v0, h, modulus, radius, bend)
    return _estimates(known, a, np.minimum(b, R), peaks, np.zeros_like(a), QUADRATURE)


def _with_bending(
    R: Array, v0: Array, h: Array, modulus: Array, radius: Array, bend: Array
) -> tuple[Array, Array, tuple[Array, Array, Array]]:
    """Return a/h, a, and time, indentation and force, for Hertz's largest radii."""
    over_h = radius / h
    radius_ratio = _radius_ratio(_formulas.beside_hertz(bend, over_h))
    A, a = radius_ratio * over_h, radius_ratio * radius
    depth, force = _formulas.peaks(a, R, modulus, bend * A)
    time = _leading_time(a, R, v0, _formulas.steepness(bend, A))
    return A, a, (time, depth, force)


def single(run: Callable[..., Estimates], *numbers: float) -> kernels.Estimate | None:
    """Return the estimate of one impact, the same to the last bit as among others.

    None where no bound is proved.
    """
    with np.errstate(all="ignore"):
        estimates = run(*(np.array([number]) for number in numbers))
    estimate = kernels.Estimate(*(np.asarray(column).item() for column in estimates))
    return estimate if math.isfinite(estimate.law) else None


def _law_error(low: Array, up: Array, fall: Array, rise: Array) -> Array:
    """Return the largest error of `law_errors`."""
    largest: Array = np.maximum.reduce(law_errors(low, up, fall, rise))
    return largest


def _spheres(
    R: Array, m: Array, v0: Array, h: Array, b: Array, lam: Array, mu: Array
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Return E*, Hertz's largest radius, and which rows have numbers in the ordinary range."""
    modulus, energy, work = _formulas.sphere(R, m, v0, lam, mu)
    known = (PLATES[0] < h / b) & (h / b < PLATES[1])
    for x in (R, m, v0, h, b, modulus, energy, energy / modulus, work):
        known = known & (x > ORDINARY[0]) & (x < ORDINARY[1])
    return modulus, work**0.2, known


def _radius_ratio(y: Array) -> Array:
    """Return the root s > 0 of s^5 (1 + y s) = 1; NaN if there is none."""
    s = np.where(y > 0.0, np.minimum(1.0, np.abs(y) ** (-1.0 / 6.0)), 1.0)
    moving = np.ones(y.shape, dtype=bool)
    for _ in range(STEPS):
        excess, slope = _formulas.work_step(s, y)
        moving &= ~(np.abs(excess) <= CLOSE)
        if not moving.any():
            return s
        s = np.where(moving, s - excess / slope, s)
        lost = moving & ~((s > 0.0) & (3.0 * y * s > -2.0))
        s[lost], moving[lost] = np.nan, False
    return np.where(moving, np.nan, s)


def _estimates(
    known: NDArray[np.bool_],
    a: Array,
    widest: Array,
    peaks: tuple[Array, Array, Array],
    law: Array,
    quadrature: float,
) -> Estimates:
    """Return the results, without a bound where the contact may exceed the plate or the sphere."""
    shown = known & (TOP * a < widest)
    law = np.where(shown, law, np.inf)
    return Estimates(*peaks, a, law, quadrature, simple_impact.ROUNDING)
