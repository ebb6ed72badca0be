"""Errors of computed numbers against reference values, in ULP of the reference value.

The allowed error is the function's budget plus half the sum of the condition numbers, which is the
effect on the value if every argument is rounded by half a unit in the last place. A budget may
allow more than half of it. If only one of
result and reference value is finite, the error is infinite. Below the smallest normal number,
errors are counted in units of the smallest subnormal number.

The check on grids, the hard cases, the check of the contact law and the search all call `judge`.
"""

import math
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import flint
import numpy as np

from derivation.engine.formula.ulp import (
    DOUBLE,
    Format,
    spacing_exponent,
    ulp_error,
    upper_float,
)
from derivation.engine.measure.kernels import Kernel
from derivation.engine.measure.point import Point
from derivation.engine.oracle.reference import Reference


@dataclass(frozen=True)
class Error:
    """Error of a computed number and its allowance.

    Parameters
    ----------
    ulp, allowed
        Error and allowance in ULP.
    needed
        The smallest budget with which the error is allowed [ULP]; 0 if conditioning explains it.
    """

    ulp: float
    allowed: float
    needed: float = math.nan

    @property
    def ratio(self) -> float:
        """Error over allowance."""
        return self.ulp / self.allowed


def judge(
    got: float, reference: Reference, budget: float, fmt: Format = DOUBLE, share: float = 0.5
) -> Error:
    """Return the error of one computed number and its allowance.

    Parameters
    ----------
    got
        The number; a float32 is passed as the double of equal value.
    reference
        The reference value.
    budget
        Allowed error in ULP without conditioning, to be multiplied by the reference's scale. It is
        counted in units of the reference's magnitude, which for a sum over modes is the sum of the
        magnitudes of all terms.
    fmt
        The floating-point format that defines the unit in the last place.
    share
        Allowed error per sum of the condition numbers.

    Returns
    -------
    Error
        Error and allowance in ULP of the reference value.
    """
    value = reference.value
    if not value.is_finite():
        same = math.isnan(got) if value.is_nan() else got == float(value)
        return Error(0.0 if same else math.inf, budget, 0.0 if same else math.inf)
    spacing = spacing_exponent(value, fmt)
    unit = math.ldexp(1.0, spacing_exponent(reference.magnitude, fmt) - spacing)
    # 2^-p times the sensitivities is also valid if the value is subnormal or zero, where the
    # condition number is not meaningful.
    with flint.ctx.workprec(128):
        effect = reference.total * flint.arb(2) ** (1 - fmt.precision - spacing)
        rounding = upper_float(share * effect)
    ulp = ulp_error(got, value, fmt)
    counted = reference.scale * unit
    needed = max(0.0, (ulp - rounding) / counted) if math.isfinite(ulp) else math.inf
    return Error(ulp, budget * counted + rounding, needed)


def largest(errors: Iterable[Error]) -> Error:
    """Return the error with the largest ratio to its allowance."""
    return max(errors, key=lambda error: error.ratio)


# --- a function at many points


@dataclass(frozen=True)
class PointReference:
    """A point, and the reference value of each result at this point."""

    point: Point
    references: tuple[Reference, ...]


@dataclass(frozen=True)
class Worst:
    """The point with the largest ratio of error to allowance.

    Parameters
    ----------
    arguments
        Names, hexadecimal floats and their decimal form.
    modes
        Number of modes of a modal sum.
    got, reference
        The computed number in hexadecimal and decimal; the reference value to 20 digits.
    ulp, allowed
        Error and allowance in ULP of the reference value.
    """

    arguments: tuple[tuple[str, str, str], ...]
    modes: int | None
    got: tuple[str, str]
    reference: str
    ulp: float
    allowed: float


@dataclass(frozen=True)
class Errors:
    """The errors of one function on its points, in one format.

    Parameters
    ----------
    points
        Number of points.
    excluded
        Number of omitted points, whose reference value overflows.
    zeros
        Number of results whose reference value is exactly zero, or below 2^-1200. Their unit in the
        last place is the smallest subnormal number, which is not meaningful. Largest error,
        percentile and root mean square omit these results; the ratio includes them.
    not_finite
        Number of results that are NaN or infinite.
    max_ulp, p99_ulp, rms_ulp
        Largest error, 99th percentile and root mean square of the finite errors [ULP].
    ratio
        Largest error over its allowance; infinite if a result is not finite. None without a budget.
    needed
        The smallest sufficient budget: the largest error beyond the allowance for conditioning
        [ULP].
    worst
        Point of the largest ratio (or of the largest error, without a budget).
    dtype
        NumPy name of the results' type.
    warned
        Texts of the warnings issued.
    """

    points: int
    excluded: int
    zeros: int
    not_finite: int
    max_ulp: float
    p99_ulp: float
    rms_ulp: float
    ratio: float | None
    needed: float
    worst: Worst
    dtype: str
    warned: tuple[str, ...]

    def within_limits(self, fmt: Format = DOUBLE) -> bool:
        """Return whether all results are finite, allowed and of type `fmt`, without warnings."""
        within = self.ratio is not None and self.ratio <= 1.0
        return within and self.not_finite == 0 and self.dtype == fmt.name and not self.warned


def measured_errors(
    kernel: Kernel, references: Sequence[PointReference], excluded: int = 0, fmt: Format = DOUBLE
) -> Errors:
    """Return the errors of a function at the given points.

    Parameters
    ----------
    kernel
        The function and its budget.
    references
        Points with their references, of which none overflows the format.
    excluded
        Number of omitted points, whose reference value overflows.
    fmt
        Format of arguments and results.

    Raises
    ------
    ValueError
        If there is no point, or if the number of results differs from that of the references.
    """
    if not references:
        raise ValueError(f"no point at which {fmt.name} can hold {kernel.name}")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        results = np.atleast_2d(kernel.results([at.point for at in references], fmt))
    expected = len(references[0].references), len(references)
    if results.shape != expected:
        raise ValueError(f"{kernel.name} gave shape {results.shape}, {expected} is expected")
    budget = math.inf if kernel.budget is None else kernel.budget
    all_of = [
        (at, reference, got, judge(got, reference, budget, fmt, kernel.share))
        for at, row in zip(references, results.T.tolist(), strict=True)
        for reference, got in zip(at.references, row, strict=True)
    ]
    worst = max(all_of, key=lambda one: one[3].ulp if kernel.budget is None else one[3].ratio)
    counted = [error.ulp for _, reference, _, error in all_of if reference.value != 0]
    finite = [ulp for ulp in counted if math.isfinite(ulp)]
    return Errors(
        points=len(references),
        excluded=excluded,
        zeros=len(all_of) - len(counted),
        not_finite=sum(not math.isfinite(got) for _, _, got, _ in all_of),
        max_ulp=max(finite, default=0.0),
        p99_ulp=float(np.quantile(finite, 0.99)) if finite else 0.0,
        rms_ulp=_rms(finite),
        ratio=None if kernel.budget is None else worst[3].ratio,
        needed=max(error.needed for _, _, _, error in all_of),
        worst=_worst(*worst),
        dtype=str(results.dtype),
        warned=tuple(sorted({str(w.message) for w in caught})),
    )


def _rms(errors: Sequence[float]) -> float:
    """Return the root of the mean square, scaled so that squares do not overflow."""
    most = max(errors, default=0.0)
    if most == 0.0:
        return 0.0
    return most * math.sqrt(math.fsum((e / most) ** 2 for e in errors) / len(errors))


def _worst(at: PointReference, reference: Reference, got: float, error: Error) -> Worst:
    arguments = at.point.values.items()
    return Worst(
        tuple((key, value.hex(), repr(value)) for key, value in arguments),
        at.point.modes,
        (got.hex(), repr(got)),
        reference.value.str(20, radius=False),
        error.ulp,
        error.allowed,
    )
