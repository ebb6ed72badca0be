"""Arguments with certified results to judge methods, and arrays to time them."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import flint
import numpy as np
from flint import arb

from derivation.engine.formula.ball import LOG2_10
from derivation.plate.benchmark.interface import (
    PAPER,
    BenchmarkCase,
    Doubles,
    Task,
    largest_contact_radius,
)
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle.balls import ratio_of
from derivation.plate.impact.oracle import ball_law
from derivation.plate.impact.oracle import impact as contact_impact
from generated.contact_law import indentation

SEED = 7
ARRAY = 10_000
"""Number of points of an array for timings; intermediate results fit in the cache."""

LAW_DIGITS, QUICK_DIGITS = 120, 45
MANY_DIGITS = 1030
"""Digits of the law in the paper's test case, by a certified power series, not integrals."""

INVERSION_DIGITS, IMPACT_DIGITS = 40, 40

SPAN = 100.0
"""Largest contact radius of a test case's impacts over the smallest one that is used."""


@dataclass(frozen=True)
class Problem:
    """Points and reference values of a task in a test case.

    Attributes
    ----------
    points, reference_values, digits
        Arguments, the results there as balls, and the number of certified digits.
    sample
        Arguments of the same kind for timings.
    """

    task: Task
    case: BenchmarkCase
    points: Doubles
    reference_values: tuple[arb, ...]
    digits: int
    sample: Doubles


def problem(task: Task, case: BenchmarkCase, quick: bool) -> Problem:
    """Return the points and reference values of a task in a test case."""
    makers: Mapping[Task, Callable[[BenchmarkCase, bool], Problem]] = {
        "law": _law,
        "inversion": _inversion,
        "impact": _impact,
    }
    return makers[task](case, quick)


def _spread(low: float, high: float, count: int, seed: int) -> Doubles:
    """Return both ends and random numbers between them with uniform logarithms."""
    random = np.random.default_rng(seed)
    inner = np.exp(random.uniform(math.log(low), math.log(high), count))
    return np.concatenate([[low, high], inner])


def _law(case: BenchmarkCase, quick: bool) -> Problem:
    low, high = case.low * case.h, case.high * case.h
    digits = QUICK_DIGITS if quick else MANY_DIGITS if case is PAPER else LAW_DIGITS
    radii = _spread(low, high, 10 if quick else 18, SEED)
    if digits == MANY_DIGITS:
        reference_values = _many_digits(radii, case)
    else:
        reference_values = tuple(
            contact_balls.indentation(float(a), case.R, case.h, case.b, digits) for a in radii
        )
    return Problem(
        "law", case, radii, reference_values, digits, _spread(low, high, ARRAY - 2, SEED + 1)
    )  # fmt: skip


def _many_digits(radii: Doubles, case: BenchmarkCase) -> tuple[arb, ...]:
    """Return indentations with MANY_DIGITS digits."""
    r, reach = case, float(radii.max()) / case.b
    law = ball_law.law_of(ratio_of(r.h, r.b), reach * (1 + 1e-9), MANY_DIGITS)
    return tuple(
        ball_law.static_contact(float(a), r.R, r.b, r.lam, r.mu, law, MANY_DIGITS)[0] for a in radii
    )


def _inversion(case: BenchmarkCase, quick: bool) -> Problem:
    """Return rounded indentations of known radii, with certified forces."""
    top = largest_contact_radius(case)
    radii = _spread(top / SPAN, 0.999 * top, 6 if quick else 14, SEED)
    R, h, b = case.R, case.h, case.b
    depths = np.array([float(contact_balls.indentation(float(a), R, h, b, 20)) for a in radii])
    with flint.ctx.workprec(math.ceil(2 * INVERSION_DIGITS * LOG2_10)):
        reference_values = tuple(_force(float(d), case) for d in depths)
    sample = indentation(_spread(top / SPAN, 0.999 * top, ARRAY - 2, SEED + 1), R, h, b)
    return Problem("inversion", case, depths, reference_values, INVERSION_DIGITS, sample)


def _force(delta: float, case: BenchmarkCase) -> arb:
    R, h, b = case.R, case.h, case.b
    radius = contact_balls.contact_radius(delta, R, h, b, INVERSION_DIGITS + 2)
    return 4 * contact_balls.modulus(case.lam, case.mu) * radius**3 / (3 * arb(R))


def _impact(case: BenchmarkCase, quick: bool) -> Problem:
    fractions = (1.0,) if quick else (0.7, 0.85, 1.0)
    speeds = np.array([fraction * case.speed for fraction in fractions])
    r = case
    reference_values = tuple(
        contact_impact.impact(r.R, r.m, float(v), r.h, r.b, r.lam, r.mu, IMPACT_DIGITS).contact_time
        for v in speeds
    )
    sample = _spread(0.7 * r.speed, r.speed, ARRAY - 2, SEED + 1)
    return Problem("impact", case, speeds, reference_values, IMPACT_DIGITS, sample)
