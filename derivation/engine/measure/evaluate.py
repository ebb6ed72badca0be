"""One kernel against the truth: errors in ULP, what conditioning allows, the worst point."""

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import flint
import numpy as np

from derivation.engine.formula.ulp import (
    DOUBLE,
    Format,
    overflows,
    spacing_exponent,
    ulp_error,
    upper_float,
)
from derivation.engine.measure.kernels import Kernel
from derivation.engine.measure.point import Point
from derivation.engine.oracle.oracle import Balls, Reference

Results = np.ndarray[Any, np.dtype[Any]]


@dataclass(frozen=True)
class Worst:
    """A point where the error is largest in proportion to what is allowed.

    Parameters
    ----------
    arguments
        Names, hexadecimal floats and their decimal form.
    modes
        Number of modes of a modal sum.
    got, truth
        The computed number in hexadecimal and decimal; the true one to 20 digits.
    ulp, allowed
        Error and allowance in ULP of the truth.
    """

    arguments: tuple[tuple[str, str, str], ...]
    modes: int | None
    got: tuple[str, str]
    truth: str
    ulp: float
    allowed: float


@dataclass(frozen=True)
class Errors:
    """What one kernel did on its points, in one format.

    Parameters
    ----------
    points
        How many were judged.
    excluded
        How many were left out: their truth overflows.
    zeros
        How many have a true value of exactly zero (or below 2^-1200). There a
        unit in the last place is the smallest subnormal and says nothing, so
        the ULP columns leave them out; the ratio judges them.
    not_finite
        How many results were NaN or infinite.
    max_ulp, p99_ulp, rms_ulp
        Of the finite results.
    ratio
        The largest error over what is allowed; infinite if any was not finite.
        None if nothing is promised.
    needed
        The budget that would just do: the largest error beyond what conditioning allows.
    worst
        Where that was (or the largest error, if nothing is promised).
    dtype
        NumPy name of the results' type.
    warned
        Warnings raised.
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
    worst: Worst | None
    dtype: str
    warned: tuple[str, ...]


@dataclass(frozen=True)
class Truth:
    """A point with its reference."""

    point: Point
    reference: Reference


def truths(
    balls: Balls, name: str, points: Sequence[Point], digits: int, fmt: Format = DOUBLE
) -> list[Truth]:
    """References at the points whose value the format can hold."""
    found = (Truth(p, balls.reference(name, p.values, digits, p.modes)) for p in points)
    return [truth for truth in found if not overflows(truth.reference.value, fmt)]


def to_single(point: Point) -> Point | None:
    """The point in numbers of single precision, or None if that is another kind of point.

    So it is where one of them leaves the range, or where two that differ
    become equal: then a point next to an edge comes to lie on it.
    """
    with np.errstate(over="ignore"):
        values = {key: float(np.float32(value)) for key, value in point.values.items()}
    in_range = all(
        math.isfinite(single) and (single == 0.0) == (point.values[key] == 0.0)
        for key, single in values.items()
    )
    distinct = len(set(values.values())) == len(set(point.values.values()))
    return Point(values, point.modes) if in_range and distinct else None


def allowed_ulp(reference: Reference, budget: float, fmt: Format = DOUBLE) -> float:
    """Allowed error in ULP: the budget plus half the sum of the condition numbers.

    That half is what rounding every argument by half a unit, 2^-p of itself,
    does to the value: 2^-p times the sum of the sensitivities. Written so, it
    also holds where the value is subnormal or zero, and a condition number says
    nothing. A modal sum's budget counts in units of the sum of the modes'
    magnitudes.
    """
    unit, rounding = _allowances(reference, fmt)
    return budget * unit + rounding


def needed_ulp(reference: Reference, ulp: float, fmt: Format = DOUBLE) -> float:
    """The budget that an error of so many ULP would just keep; not below zero."""
    unit, rounding = _allowances(reference, fmt)
    return max(0.0, (ulp - rounding) / unit) if math.isfinite(ulp) else math.inf


def _allowances(reference: Reference, fmt: Format) -> tuple[float, float]:
    """In ULP: the unit that the budget counts in, and what conditioning allows."""
    unit = spacing_exponent(reference.value, fmt)
    budget_unit = spacing_exponent(reference.magnitude, fmt)
    with flint.ctx.workprec(128):
        rounding = reference.total * flint.arb(2) ** (-fmt.precision - unit)
    return math.ldexp(1.0, budget_unit - unit), upper_float(rounding)


def call(kernel: Kernel, points: Sequence[Point], fmt: Format = DOUBLE) -> Results:
    """The kernel's results at the points, in its own type, one call per number of modes."""
    if kernel.by_count:
        last = [int(point.values["count"]) for point in points]
        table: Results = np.asarray(kernel.call(max(last)))
        entries: Results = table[np.array(last) - 1]
        return entries
    columns = [
        np.array([point.values[key] for point in points], dtype=fmt.name)
        for key in kernel.arguments
    ]
    if not kernel.modes:
        return np.asarray(kernel.call(*columns))
    counts = np.array([point.modes for point in points])
    parts = {
        count: kernel.call(*(column[counts == count] for column in columns), modes=count)
        for count in sorted({point.modes or 0 for point in points})
    }
    results = np.empty(len(points), dtype=np.result_type(*parts.values()))
    for count, part in parts.items():
        results[counts == count] = part
    return results


def judge(
    kernel: Kernel, found: Sequence[Truth], excluded: int = 0, fmt: Format = DOUBLE
) -> Errors:
    """Hold a kernel to the truth at the given points.

    Parameters
    ----------
    kernel
        The function and its budget.
    found
        Points with their references, none of them overflowing.
    excluded
        How many overflowing points were left out, for the record.
    fmt
        Format of arguments and results.

    Raises
    ------
    ValueError
        If there is no point, or not one result per point.
    """
    if not found:
        raise ValueError(f"no point at which {fmt.name} can hold {kernel.name}")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        results = call(kernel, [truth.point for truth in found], fmt)
    if results.shape != (len(found),):
        raise ValueError(f"{kernel.name} gave shape {results.shape} for {len(found)} points")
    got = [float(result) for result in results]
    ulps = [ulp_error(g, t.reference.value, fmt) for g, t in zip(got, found, strict=True)]
    allowed, ratios = _ratios(kernel, found, ulps, fmt)
    where = max(range(len(found)), key=lambda i: ratios[i])
    counted = [u for u, t in zip(ulps, found, strict=True) if t.reference.value != 0]
    finite = [u for u in counted if math.isfinite(u)]
    return Errors(
        points=len(found),
        excluded=excluded,
        zeros=len(found) - len(counted),
        not_finite=sum(not math.isfinite(g) for g in got),
        max_ulp=max(finite, default=0.0),
        p99_ulp=float(np.quantile(finite, 0.99)) if finite else 0.0,
        rms_ulp=_rms(finite),
        ratio=None if kernel.budget is None else ratios[where],
        needed=max(needed_ulp(t.reference, u, fmt) for t, u in zip(found, ulps, strict=True)),
        worst=_worst(found[where], got[where], ulps[where], allowed[where]),
        dtype=str(results.dtype),
        warned=tuple(sorted({str(w.message) for w in caught})),
    )


def _ratios(
    kernel: Kernel,
    found: Sequence[Truth],
    ulps: Sequence[float],
    fmt: Format,
) -> tuple[list[float], list[float]]:
    """Allowances, and errors over them; without a promise the errors themselves."""
    if kernel.budget is None:
        return [math.inf] * len(found), list(ulps)
    allowed = [allowed_ulp(truth.reference, kernel.budget, fmt) for truth in found]
    return allowed, [error / allowance for error, allowance in zip(ulps, allowed, strict=True)]


def _rms(errors: Sequence[float]) -> float:
    """Root of the mean square, scaled so that squares do not overflow."""
    largest = max(errors, default=0.0)
    if largest == 0.0:
        return 0.0
    return largest * math.sqrt(math.fsum((e / largest) ** 2 for e in errors) / len(errors))


def _worst(truth: Truth, got: float, ulp: float, allowed: float) -> Worst:
    arguments = truth.point.values.items()
    return Worst(
        tuple((key, value.hex(), repr(value)) for key, value in arguments),
        truth.point.modes,
        (got.hex(), repr(got)),
        truth.reference.value.str(20, radius=False),
        ulp,
        allowed,
    )
