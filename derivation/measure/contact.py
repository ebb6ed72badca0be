"""The contact law's kernels against what both oracles agree on: relative errors, row by row."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from derivation.measure.contact_grid import PAPERS_IMPACT, Point, grid
from derivation.measure.contact_truth import Job, Tell, Truth, relative, truths

LIMIT = 2e-15
"""Relative error that a kernel keeps."""

KERNELS = ("indentation", "contact_radius", "stiffness", "impact")
"""What can be measured."""


@dataclass(frozen=True)
class Case:
    """One impact.

    Parameters
    ----------
    c1_A
        The first term that the plate adds to Hertz's, at the largest contact.
    h_over_b, a_over_h
        Half-thickness over plate radius, largest contact radius over half-thickness.
    error
        Largest relative error of the four results.
    digits
        To how many the oracles agree.
    """

    c1_A: float
    h_over_b: float
    a_over_h: float
    error: float
    digits: int


@dataclass(frozen=True)
class Row:
    """What one kernel did.

    Parameters
    ----------
    kernel
        Its name.
    points
        How many points were judged.
    digits
        To how many the oracles agree, the fewest over the points.
    max_error, p99_error
        Largest error and its 99th percentile, over the truth's `scale`.
    worst
        Arguments of the largest error, in hexadecimal.
    passed
        Whether all errors keep the limit.
    cases
        The impacts one by one, by c_1 A; empty for other kernels.
    """

    kernel: str
    points: int
    digits: int
    max_error: float
    p99_error: float
    worst: tuple[str, ...]
    passed: bool
    cases: tuple[Case, ...]


def check(
    kernels: Mapping[str, Callable[..., Any]],
    points: Mapping[str, Sequence[Point]] | None = None,
    processes: int = 1,
    tell: Tell | None = None,
) -> tuple[Row, ...]:
    """Hold kernels to the truth, which is what both oracles agree on, asked point by point.

    Parameters
    ----------
    kernels
        Functions by name: indentation(a, R, h, b), contact_radius(delta, R, h, b),
        stiffness(a, R, h, b, lam, mu), and impact(R, m, v0, h, b, lam, mu), which
        returns contact time, largest indentation, force and contact radius.
    points
        Arguments by kernel; the default grids if left out.
    processes
        How many points are worked on at a time.
    tell
        Told about every point that is done: kernel, how many, of how many.

    Raises
    ------
    OracleError
        If the oracles contradict each other: then there is no truth to measure against.
    ValueError
        For a name that is not among these, and for a kernel without points.
    """
    unknown = sorted(set(kernels) - set(KERNELS))
    if unknown:
        raise ValueError(f"kernels are called {', '.join(KERNELS)}; got {', '.join(unknown)}")
    jobs = _mixed([_jobs(name, points) for name in kernels])
    found = truths(jobs, processes, tell)
    return tuple(
        _row(name, call, [true for job, true in zip(jobs, found, strict=True) if job[0] == name])
        for name, call in kernels.items()
    )


def _jobs(name: str, points: Mapping[str, Sequence[Point]] | None) -> list[Job]:
    """A kernel's points, or its grid; to the impacts' the paper's own is added."""
    if points is None:
        shapes: list[Job] = [(name, shape) for shape in grid(name)]
        return [*shapes, (name, PAPERS_IMPACT)] if name == "impact" else shapes
    if not points[name]:
        raise ValueError(f"no point to measure {name} at")
    return [(name, tuple(point)) for point in points[name]]


def _mixed(parts: Sequence[Sequence[Job]]) -> list[Job]:
    """All jobs, each kernel's spread evenly: an impact takes seconds, the others far less."""
    placed = [
        ((i + 0.5) / len(jobs), k, i) for k, jobs in enumerate(parts) for i in range(len(jobs))
    ]
    return [parts[k][i] for _, k, i in sorted(placed)]


def _row(name: str, call: Callable[..., Any], found: Sequence[Truth]) -> Row:
    errors = [_error(name, call, true) for true in found]
    where = max(range(len(found)), key=lambda i: errors[i])
    finite = [error if math.isfinite(error) else 1e300 for error in errors]
    cases = [_case(t, e) for t, e in zip(found, errors, strict=True)] if name == "impact" else []
    return Row(
        name,
        len(found),
        math.floor(min(true.digits for true in found)),
        errors[where],
        float(np.quantile(finite, 0.99)),
        tuple(argument.hex() for argument in found[where].point),
        errors[where] <= LIMIT,
        tuple(sorted(cases, key=lambda case: case.c1_A)),
    )


def _error(name: str, call: Callable[..., Any], true: Truth) -> float:
    """Largest error over the results at a point; infinite if one is not finite."""
    got = call(*true.point)
    values = [float(value) for value in got] if name == "impact" else [float(got)]
    if len(values) != len(true.values):
        raise ValueError(f"{name} gave {len(values)} results, {len(true.values)} are expected")
    pairs = zip(values, true.values, strict=True)
    return max(relative(value, ball, true.scale) for value, ball in pairs)


def _case(true: Truth, error: float) -> Case:
    h, b = true.point[3], true.point[4]
    return Case(true.bend, h / b, true.radius / h, error, math.floor(true.digits))
