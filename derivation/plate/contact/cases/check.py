"""The contact law's kernels against what both oracles agree on: errors in ULP, row by row."""

import importlib
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from derivation.engine.activity import Tell, quiet
from derivation.engine.formula.ulp import SINGLE
from derivation.engine.measure.judge import Errors
from derivation.plate.contact.cases.grid import PAPERS_IMPACT, ContactShape, Point, arguments, grid
from derivation.plate.contact.cases.judge import judge, results
from derivation.plate.contact.cases.truth import DIGITS, ContactTruth, Job, relative, truths

LIMIT = 2e-15
"""Relative error that a kernel keeps besides its budget."""

KERNELS = (
    "indentation", "contact_radius", "stiffness", "force", "force_of_radius", "radius_of_force",
    "max_pressure", "impact",
)  # fmt: skip
"""What can be measured."""

FORCES = KERNELS[3:7]
"""Kernels on whose closed forms every third contact tells enough."""

IN_TWO_WAYS = ("indentation", "contact_radius", "stiffness", "force")
"""Kernels that compute a plain number in another way than an array: the larger error counts."""

EVERY = 4
"""Single precision is judged at every fourth point."""


@dataclass(frozen=True)
class ContactCase:
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
class ContactRow:
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
    budget
        What is promised, in ULP.
    double, single
        Errors in ULP of either format; no single ones at points given.
    passed
        Whether all errors keep the budget and the limit.
    cases
        The impacts one by one, by c_1 A; empty for other kernels.
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
    tell: Tell = quiet,
) -> tuple[ContactRow, ...]:
    """Hold kernels to the truth, which is what both oracles agree on, asked point by point.

    Parameters
    ----------
    kernels
        Functions by name, with the arguments the manifest names; impact returns contact
        time, largest indentation, force and contact radius.
    points
        Arguments by kernel; the default grids if left out, then in single precision too.
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
    double = [_jobs(name, points) for name in kernels]
    single = [[] if points else _rounded(jobs) for jobs in double]
    jobs = _mixed([*double, *single])
    known = dict(zip(jobs, truths(jobs, processes, tell), strict=True))
    budgets = promised()
    return tuple(
        _row(name, call, budgets[name], [known[job] for job in d], [known[job] for job in s])
        for (name, call), d, s in zip(kernels.items(), double, single, strict=True)
    )


def promised() -> dict[str, float]:
    """Budgets in ULP by kernel, from the manifest."""
    manifest = importlib.import_module("generated.manifest")
    return {row["name"]: float(row["budget"]) for row in manifest.CONTACT}


def _rounded(jobs: Sequence[Job]) -> list[Job]:
    """Some of the jobs, their arguments rounded to single precision."""
    found: list[Job] = []
    for name, where in jobs[::EVERY]:
        point = arguments(name, where, DIGITS) if isinstance(where, ContactShape) else where
        found.append((name, tuple(float(np.float32(x)) for x in point)))
    return found


def _jobs(name: str, points: Mapping[str, Sequence[Point]] | None) -> list[Job]:
    """A kernel's points, or its grid; to the impacts' the paper's own is added."""
    if points is None:
        shapes: list[Job] = [(name, s) for s in grid(name)[:: 3 if name in FORCES else 1]]
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


def _row(
    name: str,
    call: Callable[..., Any],
    budget: float,
    found: Sequence[ContactTruth],
    rounded: Sequence[ContactTruth],
) -> ContactRow:
    ways = (call, _of_arrays(call)) if name in IN_TWO_WAYS else (call,)
    errors = [max(_error(name, way, true) for way in ways) for true in found]
    where = max(range(len(found)), key=lambda i: errors[i])
    finite = [error if math.isfinite(error) else 1e300 for error in errors]
    double = max((judge(way, found, budget) for way in ways), key=_used)
    single = judge(call, rounded, budget, SINGLE) if rounded else None
    kept = errors[where] <= LIMIT and double.kept() and (single is None or single.kept(SINGLE))
    cases = [_case(t, e) for t, e in zip(found, errors, strict=True)] if name == "impact" else []
    return ContactRow(
        name,
        len(found),
        math.floor(min(true.digits for true in found)),
        errors[where],
        float(np.quantile(finite, 0.99)),
        tuple(argument.hex() for argument in found[where].point),
        budget,
        double,
        single,
        kept,
        tuple(sorted(cases, key=lambda case: case.c1_A)),
    )


def _used(errors: Errors) -> float:
    """How much of what is allowed an error takes at most."""
    return math.inf if errors.ratio is None else errors.ratio


def _of_arrays(call: Callable[..., Any]) -> Callable[..., Any]:
    """The kernel of arrays of one point."""
    return lambda *point: call(*(np.atleast_1d(x) for x in point))


def _error(name: str, call: Callable[..., Any], true: ContactTruth) -> float:
    """Largest error over the results at a point; infinite if one is not finite."""
    values = [float(value) for value in results(call, true.point)]
    if len(values) != len(true.values):
        raise ValueError(f"{name} gave {len(values)} results, {len(true.values)} are expected")
    pairs = zip(values, true.values, strict=True)
    return max(relative(value, ball, true.scale) for value, ball in pairs)


def _case(true: ContactTruth, error: float) -> ContactCase:
    h, b = true.point[3], true.point[4]
    return ContactCase(true.bend, h / b, true.radius / h, error, math.floor(true.digits))
