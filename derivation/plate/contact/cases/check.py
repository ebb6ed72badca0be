"""Comparison of the contact law's generated functions with reference values: errors in ULP."""

import importlib
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from derivation.engine.activity import Progress, quiet
from derivation.engine.formula.ulp import SINGLE
from derivation.engine.measure.judge import Errors
from derivation.plate.contact.cases.grid import PAPER_IMPACT, ContactShape, Point, arguments, grid
from derivation.plate.contact.cases.judge import judge, results
from derivation.plate.contact.cases.reference_values import (
    DIGITS,
    ContactReference,
    Job,
    reference_values,
    relative,
)

LIMIT = 2e-15
"""Largest relative error allowed; the budget in ULP applies as well."""

KERNELS = (
    "indentation", "contact_radius", "stiffness", "force", "force_of_radius", "radius_of_force",
    "max_pressure", "impact",
)  # fmt: skip
"""Functions that can be measured."""

FORCES = KERNELS[3:7]
"""Functions with closed forms, for which every third contact is sufficient."""

IN_TWO_WAYS = ("indentation", "contact_radius", "stiffness", "force")
"""Functions that treat plain numbers and arrays differently: the larger error counts."""

EVERY = 4
"""Single precision is tested at every fourth point."""


@dataclass(frozen=True)
class ContactCase:
    """The ratios of one measured impact, and the error of its results.

    Parameters
    ----------
    c1_A
        c_1 a/h at the largest contact radius, the plate's leading correction of Hertz's law [1].
    h_over_b, a_over_h
        Half-thickness over plate radius, largest contact radius over half-thickness [1].
    error
        Largest relative error of the four results.
    digits
        Number of digits to which the reference methods agree.
    """

    c1_A: float
    h_over_b: float
    a_over_h: float
    error: float
    digits: int


@dataclass(frozen=True)
class ContactRow:
    """The measured errors of one function.

    Parameters
    ----------
    kernel
        Its name.
    points
        Number of points.
    digits
        Smallest number of digits to which the reference methods agree.
    max_error, p99_error
        Largest error and its 99th percentile, over the reference value's `scale`.
    worst
        Arguments of the largest error, in hexadecimal.
    budget
        Stated error budget, in ULP.
    double, single
        Errors in ULP of each format; `single` is None if points were given.
    passed
        Whether no error exceeds the budget or the limit.
    cases
        The individual impacts, ordered by c_1 A; empty for other functions.
    """

    kernel: str
    points: int
    digits: int
    max_error: float
    p99_error: float
    worst: tuple[str, ...]
    budget: float
    double: Errors
    single: Errors | None
    passed: bool
    cases: tuple[ContactCase, ...]


def check(
    kernels: Mapping[str, Callable[..., Any]],
    points: Mapping[str, Sequence[Point]] | None = None,
    processes: int = 1,
    progress: Progress = quiet,
) -> tuple[ContactRow, ...]:
    """Compare functions with reference values, on which both reference methods agree.

    Parameters
    ----------
    kernels
        Functions by name, with the arguments of the manifest; impact returns contact time, largest
        indentation, force and contact radius.
    points
        Arguments by function; by default the grids, then also in single precision.
    processes
        Number of processes.
    progress
        Called after each point with the function's name, the number of finished points and the
        total.

    Raises
    ------
    OracleError
        If the reference methods contradict each other, so that there is no reference value.
    ValueError
        For an unknown name, and for a function without points.
    """
    unknown = sorted(set(kernels) - set(KERNELS))
    if unknown:
        raise ValueError(f"kernels: expected {', '.join(KERNELS)}; got {', '.join(unknown)}")
    double = [_jobs(name, points) for name in kernels]
    single = [[] if points else _single_precision_jobs(jobs) for jobs in double]
    jobs = _interleaved_jobs([*double, *single])
    known = dict(zip(jobs, reference_values(jobs, processes, progress), strict=True))
    budgets = stated_limits()
    return tuple(
        _row(name, call, budgets[name], [known[job] for job in d], [known[job] for job in s])
        for (name, call), d, s in zip(kernels.items(), double, single, strict=True)
    )


def stated_limits() -> dict[str, float]:
    """Return the budgets in ULP by function, from the manifest."""
    manifest = importlib.import_module("generated.manifest")
    return {row["name"]: float(row["budget"]) for row in manifest.CONTACT}


def _single_precision_jobs(jobs: Sequence[Job]) -> list[Job]:
    """Return some of the jobs, with arguments rounded to single precision."""
    all_jobs: list[Job] = []
    for name, where in jobs[::EVERY]:
        point = arguments(name, where, DIGITS) if isinstance(where, ContactShape) else where
        all_jobs.append((name, tuple(float(np.float32(x)) for x in point)))
    return all_jobs


def _jobs(name: str, points: Mapping[str, Sequence[Point]] | None) -> list[Job]:
    """Return a function's points, or its grid; impacts include the one of the paper."""
    if points is None:
        shapes: list[Job] = [(name, s) for s in grid(name)[:: 3 if name in FORCES else 1]]
        return [*shapes, (name, PAPER_IMPACT)] if name == "impact" else shapes
    if not points[name]:
        raise ValueError(f"no point to measure {name} at")
    return [(name, tuple(point)) for point in points[name]]


def _interleaved_jobs(parts: Sequence[Sequence[Job]]) -> list[Job]:
    """Return all jobs, interleaved: an impact takes seconds, the others far less."""
    placed = [
        ((i + 0.5) / len(jobs), k, i) for k, jobs in enumerate(parts) for i in range(len(jobs))
    ]
    return [parts[k][i] for _, k, i in sorted(placed)]


def _row(
    name: str,
    call: Callable[..., Any],
    budget: float,
    references: Sequence[ContactReference],
    rounded: Sequence[ContactReference],
) -> ContactRow:
    ways = (call, _of_arrays(call)) if name in IN_TWO_WAYS else (call,)
    errors = [max(_error(name, way, true) for way in ways) for true in references]
    where = max(range(len(references)), key=lambda i: errors[i])
    finite = [error if math.isfinite(error) else 1e300 for error in errors]
    double = max((judge(way, references, budget) for way in ways), key=_used)
    single = judge(call, rounded, budget, SINGLE) if rounded else None
    kept = (
        errors[where] <= LIMIT
        and double.within_limits()
        and (single is None or single.within_limits(SINGLE))
    )
    cases = (
        [_case(t, e) for t, e in zip(references, errors, strict=True)] if name == "impact" else []
    )
    return ContactRow(
        name,
        len(references),
        math.floor(min(true.digits for true in references)),
        errors[where],
        float(np.quantile(finite, 0.99)),
        tuple(argument.hex() for argument in references[where].point),
        budget,
        double,
        single,
        kept,
        tuple(sorted(cases, key=lambda case: case.c1_A)),
    )


def _used(errors: Errors) -> float:
    """Return the largest ratio of error to allowed error; infinite if there is none."""
    return math.inf if errors.ratio is None else errors.ratio


def _of_arrays(call: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that passes each argument as an array of one element."""
    return lambda *point: call(*(np.atleast_1d(x) for x in point))


def _error(name: str, call: Callable[..., Any], true: ContactReference) -> float:
    """Return the largest error over the results at a point; infinite if one is not finite."""
    values = [float(value) for value in results(call, true.point)]
    if len(values) != len(true.values):
        raise ValueError(f"{name} gave {len(values)} results, {len(true.values)} are expected")
    pairs = zip(values, true.values, strict=True)
    return max(relative(value, ball, true.scale) for value, ball in pairs)


def _case(true: ContactReference, error: float) -> ContactCase:
    h, b = true.point[3], true.point[4]
    return ContactCase(true.bend, h / b, true.radius / h, error, math.floor(true.digits))
