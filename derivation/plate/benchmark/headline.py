"""The generated law against the best direct summation, at the paper's own largest contact."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import flint
import numpy as np
from flint import arb

from derivation.engine.measure import clock
from derivation.engine.measure.clock import CPU
from derivation.plate.benchmark import law_generated
from derivation.plate.benchmark.arithmetic import DOUBLE, HAS_LONG, LONG, SERIES_END, Array, as_ball
from derivation.plate.benchmark.errors import digits
from derivation.plate.benchmark.far_zeros import far_zeros
from derivation.plate.benchmark.interface import Doubles, Regime, deepest
from derivation.plate.contact.oracle import balls as contact_balls
from generated.contact_law import indentation

MOST_MODES, QUICK_MODES = 20_971_520, 1_048_576
CHUNK, BLOCK = 1 << 19, 1 << 13
"""Modes prepared, and modes summed, at a time."""

KNOWN_ZEROS = 1 << 16
"""So many zeros come from the generated code; beyond, two terms of McMahon's expansion are
exact to the last place."""

FADED = 100
"""Exponent 4 h phi from which G - 1 < e^-FADED (1 + 4 h phi)^2 is nothing beside 1."""

DIGITS = (6, 9, 10, 11, 12)
TRUE_DIGITS = 30
"""Of the indentation that the sums are held to."""

POINTS = 1_000_000


@dataclass(frozen=True)
class Reached:
    """Digits reached by a direct sum: modes, and time per point [s] without set-up.

    `truncation` and `rounding` are the digits that so many modes have in long doubles, and those
    of the sum in doubles against them; None where there is no long double.
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
        Where the sum is taken [m].
    reached
        What the direct sum takes for each number of digits, as far as it got.
    modes, setup, per_mode
        Modes summed in all; time of their zeros and weights [s]; time of a mode [s].
    digits, called, prepared
        Of the generated law: digits, and time per point of a large array [s].
    """

    contact_radius: float
    reached: tuple[Reached, ...]
    modes: int
    setup: float
    per_mode: float
    digits: float
    called: float
    prepared: float


def headline(regime: Regime, quick: bool) -> Headline:
    """Measure it."""
    a = deepest(regime)
    ball = contact_balls.indentation(a, regime.R, regime.h, regime.b, TRUE_DIGITS)
    true = float(ball)
    own = float(indentation(a, regime.R, regime.h, regime.b))
    miss = abs(own / true - 1) or float(np.finfo(np.float64).eps) / 2
    partial, times, setup = direct(regime, a, QUICK_MODES if quick else MOST_MODES)
    reached = tuple(_reached(np.abs(partial / true - 1), times))
    if HAS_LONG:
        reached = told_apart(regime, a, ball, reached, partial)
    radii = np.random.default_rng(clock.SEED).uniform(0.1 * a, a, POINTS)
    # As called, the whole array at once: that is how it is meant to be used.
    large = clock.Candidate(
        lambda x: indentation(x, regime.R, regime.h, regime.b), radii, 1
    )  # fmt: skip
    ready = clock.Candidate(law_generated.prepared().prepare(regime), radii, 1)
    called, prepared = clock.session((large, ready), clock.QUICK if quick else clock.FULL).timings
    return Headline(
        a, reached, BLOCK * partial.size, setup, float(times[-1]) / (BLOCK * partial.size),
        -math.log10(miss), called.seconds, prepared.seconds,
    )  # fmt: skip


def direct(regime: Regime, a: float, most: int) -> tuple[Doubles, Doubles, float]:
    """The sum and the time so far after each block of modes, and time of the set-up."""
    partial, times, setup, total, spent = [], [], 0.0, 0.0, 0.0
    for begin in range(0, most, CHUNK):
        start = CPU()
        j, slope = zeros(begin, begin + CHUNK)
        square = j * j
        factor = 8 * regime.b**2 / (math.pi * regime.R)
        with DOUBLE.context():
            excess = DOUBLE.excess(2 * regime.eta * j)
        weights = factor * (1 + excess) / (square * square * slope)
        setup += CPU() - start
        for k in range(0, CHUNK, BLOCK):
            start = CPU()
            y = (a / regime.b) * j[k : k + BLOCK]
            total += float((weights[k : k + BLOCK] * (np.sin(y) - y * np.cos(y))).sum())
            spent += CPU() - start
            partial.append(total)
            times.append(spent)
    return np.array(partial), np.array(times), setup


def told_apart(
    regime: Regime, a: float, true: arb, reached: tuple[Reached, ...], partial: Doubles
) -> tuple[Reached, ...]:
    """The same with truncation and rounding."""
    if not reached:
        return reached
    longer = long_sums(regime, a, max(found.modes for found in reached))

    def parts(found: Reached) -> Reached:
        block = found.modes // BLOCK - 1
        same = as_ball(longer[block])
        truncation = digits(same, true, TRUE_DIGITS)
        rounding = digits(partial[block], same, TRUE_DIGITS)
        return replace(found, truncation=truncation, rounding=rounding)

    with flint.ctx.workprec(128):
        return tuple(parts(found) for found in reached)


def long_sums(regime: Regime, a: float, most: int) -> Array:
    """The sum of `direct` after each block, in long doubles: it has next to no rounding.

    What is not rounded to doubles either: zeros, weights, and a/b.
    """
    R, h, b, radius = (LONG.array(x) for x in (regime.R, regime.h, regime.b, a))
    with flint.ctx.workprec(96):
        pi = LONG.array(arb.pi())
    near, blocks = LONG.zeros(CHUNK), []
    for begin in range(0, most, CHUNK):
        j, slope = far_zeros(begin, begin + CHUNK, pi) if begin else near
        square, factor = j * j * slope, 8 * b * b / (pi * R)
        weights = factor / (square * square)
        if 4 * regime.eta * float(j[0]) < FADED:
            with LONG.context():
                weights = weights * (1 + LONG.excess(2 * h / b * j))
        y = radius / b * j
        shape = LONG.shape(y) if y[0] < SERIES_END else np.sin(y) - y * np.cos(y)
        terms = weights * shape
        blocks.append(terms.reshape(-1, BLOCK).sum(axis=1))
    return np.cumsum(np.concatenate(blocks))


def zeros(begin: int, end: int) -> tuple[Doubles, Doubles]:
    """Zeros j_n of J0 and J1(j_n)^2, begin < n <= end."""
    if end <= KNOWN_ZEROS:
        j, slope = DOUBLE.zeros(end)
        return j[begin:], slope[begin:] ** 2
    beta = (np.arange(begin + 1, end + 1) - 0.25) * math.pi
    j, square = beta + 1 / (8 * beta), 2 / (math.pi * beta)
    if begin < KNOWN_ZEROS:
        known, slope = DOUBLE.zeros(KNOWN_ZEROS)
        j[: KNOWN_ZEROS - begin] = known[begin:]
        square[: KNOWN_ZEROS - begin] = slope[begin:] ** 2
    return j, square


def _reached(errors: Doubles, times: Doubles) -> Iterator[Reached]:
    """From which block on the error stays below each power of ten."""
    for wanted in DIGITS:
        late = np.flatnonzero(errors > 10.0**-wanted)
        first = int(late[-1]) + 1 if late.size else 0
        if first < errors.size:
            yield Reached(wanted, (first + 1) * BLOCK, float(times[first]))
