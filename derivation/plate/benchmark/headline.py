"""The generated law against the best direct summation, at the paper's own largest contact."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import flint
import numpy as np
from flint import arb

from derivation.engine.measure import clock
from derivation.engine.measure.clock import CPU
from derivation.plate.benchmark import ready_methods
from derivation.plate.benchmark.arithmetic import (
    DOUBLE,
    HAS_LONG_DOUBLE,
    LONG_DOUBLE,
    SERIES_END,
    Array,
    Floats,
    as_ball,
)
from derivation.plate.benchmark.errors import digits
from derivation.plate.benchmark.interface import BenchmarkCase, largest_contact_radius
from derivation.plate.contact.oracle import balls as contact_balls
from generated.contact_law import indentation

MOST_MODES, QUICK_MODES = 20_971_520, 1_048_576
CHUNK, BLOCK = 1 << 19, 1 << 13
"""Numbers of modes prepared, and summed, at a time."""

FADED = 100
"""Exponent 4 h phi from which G - 1 < e^-FADED (1 + 4 h phi)^2 is negligible compared with 1."""

DIGITS = (6, 9, 10, 11, 12)
TRUE_DIGITS = 30
"""Number of digits of the reference indentation."""

POINTS = 1_000_000


@dataclass(frozen=True)
class DirectSum:
    """Digits reached by a direct sum: number of modes, and time per point [s] without set-up.

    `truncation` and `rounding` are the digits of this many modes in long doubles, and those of the
    sum in doubles compared with them; None where there is no long double.
    """

    digits: int
    modes: int
    seconds: float
    truncation: float | None = None
    rounding: float | None = None


@dataclass(frozen=True)
class Headline:
    """The comparison.

    Attributes
    ----------
    contact_radius
        Contact radius of the comparison [m].
    direct_sum
        Modes and time of the direct sum for each number of digits that it reached.
    modes, setup, seconds_per_mode
        Total number of modes; time of their zeros and weights [s]; time of a mode [s].
    digits, seconds_with_setup, seconds_without_setup
        Of the generated law: digits, and time per point of a large array [s].
    """

    contact_radius: float
    direct_sum: tuple[DirectSum, ...]
    modes: int
    setup: float
    seconds_per_mode: float
    digits: float
    seconds_with_setup: float
    seconds_without_setup: float


def headline(case: BenchmarkCase, quick: bool) -> Headline:
    """Measure the comparison."""
    a, r = largest_contact_radius(case), case
    true = contact_balls.indentation(a, r.R, r.h, r.b, TRUE_DIGITS)
    own = float(indentation(a, r.R, r.h, r.b))
    miss = abs(own / float(true) - 1) or float(np.finfo(np.float64).eps) / 2
    partial, times, setup = direct_sums(r, a, QUICK_MODES if quick else MOST_MODES)
    reached = tuple(_reached(case, a, true, partial, times))
    radii = np.random.default_rng(clock.SEED).uniform(0.1 * a, a, POINTS)
    # As called, with the whole array at once, which is the intended use.
    calls = [
        ready_methods.generated_law().prepared(case),
        ready_methods.prepared_law().prepared(case),
    ]
    candidates = [clock.Candidate(call, radii, 1) for call in calls]
    called, prepared = clock.session(candidates, clock.QUICK if quick else clock.FULL).timings
    modes = BLOCK * partial.size
    return Headline(
        a, reached, modes, setup, float(times[-1]) / modes, -math.log10(miss), called.seconds,
        prepared.seconds,
    )  # fmt: skip


def direct_sums(
    case: BenchmarkCase, a: float, most: int, ar: Floats = DOUBLE
) -> tuple[Array, Array, float]:
    """Return the sum and the time after each block of modes, and the time of the set-up."""
    partial, times, setup, total, spent = [], [], 0.0, ar.number(0.0), 0.0
    R, h, b, radius = (ar.number(x) for x in (case.R, case.h, case.b, a))
    factor, eta, alpha = 8 * b * b / (ar.pi() * R), h / b, radius / b
    for begin in range(0, most, CHUNK):
        start = CPU()
        j, slope = ar.zeros(begin + CHUNK, begin)
        square = j * j * slope
        weights = factor / (square * square)
        if 4 * eta * j[0] < FADED:
            with ar.context():
                weights = weights * (1 + ar.excess(2 * eta * j))
        setup += CPU() - start
        for k in range(0, CHUNK, BLOCK):
            start = CPU()
            y = alpha * j[k : k + BLOCK]
            shape = ar.shape(y) if y[0] < SERIES_END else np.sin(y) - y * np.cos(y)
            total += (weights[k : k + BLOCK] * shape).sum()
            spent += CPU() - start
            partial.append(total)
            times.append(spent)
    return np.array(partial), np.array(times), setup


def _reached(
    case: BenchmarkCase, a: float, true: arb, partial: Array, times: Array
) -> Iterator[DirectSum]:
    """Return the first block with errors below each power of ten; truncation in long doubles."""
    errors, blocks = np.abs(partial / float(true) - 1), {}
    for wanted in DIGITS:
        late = np.flatnonzero(errors > 10.0**-wanted)
        first = int(late[-1]) + 1 if late.size else 0
        if first < errors.size:
            blocks[wanted] = first
    most = BLOCK * (max(blocks.values(), default=-1) + 1)
    longer = direct_sums(case, a, most, LONG_DOUBLE)[0] if HAS_LONG_DOUBLE else None
    with flint.ctx.workprec(128):
        for wanted, first in blocks.items():
            parts: list[float | None] = [None, None]
            if longer is not None:
                same = as_ball(longer[first])
                parts = [digits(same, true, TRUE_DIGITS), digits(partial[first], same, TRUE_DIGITS)]
            yield DirectSum(wanted, (first + 1) * BLOCK, float(times[first]), *parts)
