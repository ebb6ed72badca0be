"""Reference values of the contact law: two methods at every point, in several processes."""

import math
import multiprocessing
from collections.abc import Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from dataclasses import dataclass

import flint

from derivation.engine.activity import Progress, quiet
from derivation.plate.contact.cases.grid import ContactShape, Point, arguments
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.impact.oracle.agreement import agree

DIGITS = 24
"""Smallest number of digits to which both methods must agree."""

_WRITTEN = 50
"""Digits with which a ball is sent between processes."""

Job = tuple[str, ContactShape | Point]


@dataclass(frozen=True)
class ContactReference:
    """Reference values at a point.

    Parameters
    ----------
    point
        The function's arguments.
    values
        Its results as balls, in decimal.
    digits
        Number of digits to which both methods agree.
    scale
        Divisor of errors, see `tolerance`.
    bend
        For an impact c_1 A, the plate's first correction of Hertz's law; else 0.
    radius
        Contact radius, for an impact the largest.
    """

    point: Point
    values: tuple[str, ...]
    digits: float
    scale: float
    bend: float
    radius: float


def reference_value(job: Job) -> ContactReference:
    """Return the reference values of a function at its arguments, or at a contact of the grid.

    Raises
    ------
    OracleError
        If the two methods contradict each other.
    """
    name, where = job
    point = arguments(name, where, DIGITS) if isinstance(where, ContactShape) else where
    reference = agree(name, point, DIGITS)
    values = tuple(ball.str(_WRITTEN) for ball in reference.values)
    first, last = float(reference.values[0]), float(reference.values[-1])
    radius = last if name in ("impact", "contact_radius") else point[0]
    bend = bending(point, radius) if name == "impact" else 0.0
    return ContactReference(
        point, values, reference.digits, tolerance(name, point, first), bend, radius
    )


def tolerance(name: str, point: Point, true: float) -> float:
    """Return the divisor of errors: (1 + |F|)/|1 + F|, where F is the plate's correction of Hertz.

    A sum is accurate to a unit in the last place of its largest part. Where 1 + F is small compared
    with that part, the tolerance is larger; where F passes zero, the divisor is 1. For all other
    results the divisor is 1.
    """
    if name not in ("indentation", "contact_radius", "stiffness"):
        return 1.0
    if name == "stiffness":
        a, _, _, _, lam, mu = point
        sum_ = 8.0 * mu * ((lam + mu) / (lam + 2.0 * mu)) * a / true
    else:
        a, delta = (true, point[0]) if name == "contact_radius" else (point[0], true)
        sum_ = delta / a * (point[1] / a)
    return (1.0 + abs(sum_ - 1.0)) / abs(sum_)


def bending(point: Point, radius: float) -> float:
    """Return c_1 A of an impact."""
    h, b = point[3], point[4]
    return float(contact_balls.coefficient(1, h, b, 12)) * (radius / h)


def reference_values(
    jobs: Sequence[Job], processes: int = 1, progress: Progress = quiet
) -> list[ContactReference]:
    """Return the reference values of the jobs, in their order.

    Parameters
    ----------
    jobs
        Names of functions, each with arguments or a contact of the grid.
    processes
        Number of processes; 1 starts none.
    progress
        Called after each point with the function's name, the number of finished points and the
        total.
    """
    if processes == 1:
        references = []
        for done, job in enumerate(jobs, start=1):
            references.append(reference_value(job))
            progress(job[0], done, len(jobs))
        return references
    # New processes, because a copy of a process with threads may hang.
    pool = ProcessPoolExecutor(processes, multiprocessing.get_context("spawn"))
    try:
        futures: dict[Future[ContactReference], str] = {
            pool.submit(reference_value, job): job[0] for job in jobs
        }
        for done, future in enumerate(as_completed(futures), start=1):
            future.result()
            progress(futures[future], done, len(jobs))
        return [future.result() for future in futures]
    finally:
        pool.shutdown(cancel_futures=True)


def relative(value: float, true: str, scale: float) -> float:
    """Return |value - reference|/(scale |reference|); infinite for a value that is not finite."""
    if not math.isfinite(value):
        return math.inf
    with flint.ctx.workprec(256):
        ball = flint.arb(true)
        return float((abs((flint.arb(value) - ball) / ball) / scale).abs_upper())
