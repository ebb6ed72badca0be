"""Run time and memory as functions of the number of points, b/h, digits and number of scenes."""

import math
import tracemalloc
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from derivation.engine.measure.clock import CPU
from derivation.plate.benchmark import polynomials, ready_methods, speed, sums
from derivation.plate.benchmark.arithmetic import BallArithmetic, Mpmath
from derivation.plate.benchmark.interface import PAPER, Method
from derivation.plate.benchmark.problems import ARRAY
from generated.contact_law import indentation
from generated.impact import impact
from generated.simple_impact import hertz, leading

REPEATS = 7
"""Number of measurements of each time."""

LONG_CALL = 0.5
"""Time above which a call is measured only once [s]."""

FIT_DEVIATION = 1.5
"""Factor by which a time may differ from the fitted power law."""

DIGITS_PER_TERM = 2.2
"""Digits gained with each term of the small-a series at a/h = 0.3: 2 log10(4/0.3)."""

SPLIT_POINTS = 64
"""Number of points for the split sum, which is slower than the generated law."""


@dataclass(frozen=True)
class Growth:
    """Run time as a function of a size, and the power law fitted to it.

    Attributes
    ----------
    what, method
        Name of the varied size, and of the method.
    x, seconds
        The sizes, and the time for each [s].
    slope
        Exponent of the power law through the last three sizes.
    leaves
        Largest size at which the time differs from the power law by more than `OFF`, or None.
    why
        The reason for that difference, or for the exponent.
    peak_bytes
        Peak memory of the last call, including its result; None if not measured.
    """

    what: str
    method: str
    x: tuple[float, ...]
    seconds: tuple[float, ...]
    slope: float
    leaves: float | None
    why: str
    peak_bytes: int | None


def growth(
    what: str, method: str, x: Sequence[float], calls: Sequence[Callable[[], object]], why: str
) -> Growth:
    """Measure the time of each call, and the memory of the last."""
    seconds = tuple(_lower_quartile(call) for call in calls)
    slope, leaves = line(x, seconds)
    return Growth(what, method, tuple(x), seconds, slope, leaves, why, peak(calls[-1]))


def line(x: Sequence[float], seconds: Sequence[float]) -> tuple[float, float | None]:
    """Fit a power law to the last three points; return its exponent and `Growth.leaves`."""
    logs, times = np.log(x), np.log(seconds)
    slope, start = np.polyfit(logs[-3:], times[-3:], 1)
    off = np.flatnonzero(np.abs(times - (start + slope * logs)) > math.log(FIT_DEVIATION))
    return float(slope), float(x[off[-1]]) if off.size else None


def peak(call: Callable[[], object]) -> int:
    """Return the peak memory of a call [bytes]."""
    tracemalloc.start()
    call()
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return most


def _lower_quartile(call: Callable[[], object]) -> float:
    """Return the lower quartile of the times of `REPEATS` calls [s]."""
    call()
    times = []
    for _ in range(REPEATS):
        begin = CPU()
        call()
        times.append(CPU() - begin)
        if times[-1] > LONG_CALL:
            break
    return float(np.quantile(times, 0.25))


def points() -> list[Growth]:
    """Measure the contact law by number of points, including and excluding per-plate set-up."""
    sizes = [10**k for k in range(8)]
    radii = np.random.default_rng(1).uniform(1e-3, 0.03, sizes[-1])
    ready = ready_methods.prepared_law().prepared(PAPER)
    whole = "set-up of a call (domain, plate) outweighs the points below"
    return [
        growth(
            "points", "production, as called", sizes,
            [partial(indentation, radii[:n], PAPER.R, PAPER.h, PAPER.b) for n in sizes], whole,
        ),
        growth(
            "points", "production, prepared", sizes, [partial(ready, radii[:n]) for n in sizes],
            "the interpreter's share of a call outweighs the points below",
        ),
    ]  # fmt: skip


def thickness_ratios() -> list[Growth]:
    """Measure the contact law by b/h: the public function, and the split sum with its set-up."""
    ratios = [10.0**k for k in range(5)]
    fractions = np.random.default_rng(1).uniform(0.01, 0.9, ARRAY)
    plates = [replace(PAPER, R=100.0, h=1 / ratio) for ratio in ratios]

    def calls(method: Method, count: int) -> list[Callable[[], object]]:
        prepared = [(method.prepared(plate), fractions[:count] * plate.h) for plate in plates]
        return [partial(call, a) for call, a in prepared]

    flat = "flat: coefficients come from tables in h/b, the points see polynomials only"
    modes = "grows with the modes, 4 b/h of them; for thick plates the wall's 48 nodes count"
    return [
        growth(
            "b/h", f"production, as called, {ARRAY} points", ratios,
            calls(ready_methods.generated_law(), ARRAY), flat,
        ),
        growth(
            "b/h", f"split, 48 nodes, {SPLIT_POINTS} points", ratios,
            calls(sums.split(48, 4), SPLIT_POINTS), modes,
        ),
    ]  # fmt: skip


def digits(quick: bool) -> list[Growth]:
    """Measure the small-a series by digits: set-up, and one point in Arb and in mpmath."""
    counts = [30, 50, 100] if quick else [30, 50, 100, 200, 300, 500, 1000]
    setups, balls, numbers = [], [], []
    for count in counts:
        terms = math.ceil(count / DIGITS_PER_TERM) + 3
        begin = CPU()
        balls.append(polynomials.small_contacts(terms, BallArithmetic(count)).prepared(PAPER))
        setups.append(CPU() - begin)
        # This uses the cached coefficients of the line above.
        numbers.append(polynomials.small_contacts(terms, Mpmath(count)).prepared(PAPER))
    a, setup_slope = np.array([0.3 * PAPER.h]), line(counts, setups)
    return [
        Growth(
            "digits", "small-a series in balls, set-up", tuple(counts), tuple(setups), *setup_slope,
            "zeros of J0 to that precision: more of them, each with a longer run time", None,
        ),
        growth(
            "digits", "small-a series in balls, one point", counts,
            [partial(call, a) for call in balls],
            "the terms grow with the digits; the interpreter takes most of the time of each",
        ),
        growth(
            "digits", "small-a series in mpmath, one point", counts,
            [partial(call, a) for call in numbers],
            "the same terms; products of so many bits count earlier",
        ),
    ]  # fmt: skip


def scenes(quick: bool) -> list[Growth]:
    """Measure impacts by number of scenes, with each method of `simulate`."""
    sizes = [10**k for k in range(5 if quick else 6)]
    batches = [speed.scenes(0.01, 2.9, n) for n in sizes]
    rows = [list(zip(*(x.tolist() for x in s.values()), strict=True)) for s in batches]
    batch = "set-up of a call and NumPy's share of each operation outweigh the scenes below"
    found = [
        growth(
            "scenes", name, sizes, [partial(_each, method, some) for some in rows],
            "one scene after another in plain Python",
        )
        for name, method in (("hertz", hertz), ("leading", leading))
    ]  # fmt: skip
    return found + [
        growth(
            "scenes", name, sizes, [partial(impact, **s, coarse=coarse) for s in batches], batch
        )
        for name, coarse in (("coarse", True), ("full", False))
    ]  # fmt: skip


def _each(method: Callable[..., object], scenes: Sequence[Sequence[float]]) -> list[object]:
    """Call a method that computes single scenes for each scene."""
    return [method(*scene) for scene in scenes]


def studies(quick: bool) -> tuple[tuple[str, Callable[[], list[Growth]]], ...]:
    """Return each study with its name; quick studies have fewer sizes."""
    return (
        ("points", points),
        ("b/h", thickness_ratios),
        ("digits", partial(digits, quick)),
        ("scenes", partial(scenes, quick)),
    )
