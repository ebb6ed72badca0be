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
"""Digits gained with each term of the series in a/h at a/h = 0.3: 2 log10(4/0.3)."""

SPLIT_POINTS = 64
"""Number of points for the split sum, which is slower than the generated law."""


@dataclass(frozen=True)
class Scaling:
    """Run time as a function of a size, and the power law fitted to it.

    Attributes
    ----------
    quantity, method
        Name of the varied size, and of the method.
    x, seconds
        The sizes, and the time for each [s].
    slope
        Exponent of the power law through the last three sizes.
    deviates_at
        Largest size at which the time differs from the power law by more than a
        factor of `FIT_DEVIATION`, or None.
    reason
        The reason for that difference, or for the exponent.
    peak_bytes
        Peak memory of the last call, including its result; None if not measured.
    """

    quantity: str
    method: str
    x: tuple[float, ...]
    seconds: tuple[float, ...]
    slope: float
    deviates_at: float | None
    reason: str
    peak_bytes: int | None


def growth(
    quantity: str,
    method: str,
    x: Sequence[float],
    calls: Sequence[Callable[[], object]],
    reason: str,
) -> Scaling:
    """Measure the time of each call, and the memory of the last."""
    seconds = tuple(_lower_quartile(call) for call in calls)
    slope, deviates_at = line(x, seconds)
    return Scaling(quantity, method, tuple(x), seconds, slope, deviates_at, reason, peak(calls[-1]))


def line(x: Sequence[float], seconds: Sequence[float]) -> tuple[float, float | None]:
    """Fit a power law to the last three points; return its exponent and `Scaling.deviates_at`."""
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


def points() -> list[Scaling]:
    """Measure the contact law by number of points, including and excluding per-plate set-up."""
    sizes = [10**k for k in range(8)]
    radii = np.random.default_rng(1).uniform(1e-3, 0.03, sizes[-1])
    ready = ready_methods.prepared_law().prepared(PAPER)
    whole = "below this size the set-up of a call (checks, plate) dominates"
    return [
        growth(
            "points", "generated code, set-up included", sizes,
            [partial(indentation, radii[:n], PAPER.R, PAPER.h, PAPER.b) for n in sizes], whole,
        ),
        growth(
            "points", "generated code, set-up excluded", sizes,
            [partial(ready, radii[:n]) for n in sizes],
            "below this size the overhead of the interpreter dominates",
        ),
    ]  # fmt: skip


def thickness_ratios() -> list[Scaling]:
    """Measure the contact law by b/h: the public function, and the split sum with its set-up."""
    ratios = [10.0**k for k in range(5)]
    fractions = np.random.default_rng(1).uniform(0.01, 0.9, ARRAY)
    plates = [replace(PAPER, R=100.0, h=1 / ratio) for ratio in ratios]

    def calls(method: Method, count: int) -> list[Callable[[], object]]:
        prepared = [(method.prepared(plate), fractions[:count] * plate.h) for plate in plates]
        return [partial(call, a) for call, a in prepared]

    flat = "constant: the coefficients come from tables in h/b, and each point is a polynomial"
    modes = (
        "proportional to the number of modes, 4 b/h; for thick plates the 48 nodes of the integral "
        "dominate"
    )
    return [
        growth(
            "b/h", f"generated code, set-up included, {ARRAY} points", ratios,
            calls(ready_methods.generated_law(), ARRAY), flat,
        ),
        growth(
            "b/h", f"split sum, 48 nodes, {SPLIT_POINTS} points", ratios,
            calls(sums.split(48, 4), SPLIT_POINTS), modes,
        ),
    ]  # fmt: skip


def digits(quick: bool) -> list[Scaling]:
    """Measure the series in a/h by digits: set-up, and one point in Arb and in mpmath."""
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
        Scaling(
            "digits", "series in a/h, Arb, set-up", tuple(counts), tuple(setups), *setup_slope,
            "more zeros of J0 are needed, each to more digits", None,
        ),
        growth(
            "digits", "series in a/h, Arb, one point", counts,
            [partial(call, a) for call in balls],
            "more terms are needed; the overhead of the interpreter dominates each term",
        ),
        growth(
            "digits", "series in a/h, mpmath, one point", counts,
            [partial(call, a) for call in numbers],
            "more terms are needed; long products dominate from fewer digits on",
        ),
    ]  # fmt: skip


def scenes(quick: bool) -> list[Scaling]:
    """Measure impacts by number of scenes, with each method of `simulate`."""
    sizes = [10**k for k in range(5 if quick else 6)]
    batches = [speed.scenes(0.01, 2.9, n) for n in sizes]
    rows = [list(zip(*(x.tolist() for x in s.values()), strict=True)) for s in batches]
    batch = "below this size the set-up of a call and the overhead of NumPy dominate"
    growths = [
        growth(
            "scenes", name, sizes, [partial(_each, method, some) for some in rows],
            "one scene after another in Python",
        )
        for name, method in (("hertz", hertz), ("leading", leading))
    ]  # fmt: skip
    return growths + [
        growth(
            "scenes", name, sizes, [partial(impact, **s, coarse=coarse) for s in batches], batch
        )
        for name, coarse in (("coarse", True), ("full", False))
    ]  # fmt: skip


def _each(method: Callable[..., object], scenes: Sequence[Sequence[float]]) -> list[object]:
    """Call a method that computes single scenes for each scene."""
    return [method(*scene) for scene in scenes]


def studies(quick: bool) -> tuple[tuple[str, Callable[[], list[Scaling]]], ...]:
    """Return each study with its name; quick studies have fewer sizes."""
    return (
        ("points", points),
        ("b/h", thickness_ratios),
        ("digits", partial(digits, quick)),
        ("scenes", partial(scenes, quick)),
    )
