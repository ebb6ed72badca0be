"""Mutation tests of the paper's motion: independent definitions detect each error."""

import math
from collections.abc import Sequence
from functools import cache, partial
from types import ModuleType

import numpy as np
import pytest
from mpmath import mp, mpf
from mutated_code import FINE, START, Expected, ExpectedResult, ModuleTests, undetected
from printed_sums import truncated_gamma

from derivation.plate.impact.oracle import printed_motion as motion_balls
from generated.perturbation import PrintedMotion

Point = tuple[float, ...]
LAME = 0.36e9, 0.43e9

# --- the paper's motion

PAPER: Point = (0.13, 72.2, 1.0, 0.1, 1.0, *LAME)
OTHERS: Sequence[Point] = [
    (1.3, 0.5, 3.0, 0.02, 0.3, -0.5, 0.8), (1.3, 0.5, 3.0, 0.02, 0.3, -0.5e9, 0.8e9)
]  # fmt: skip
NO_MOTION: Sequence[Point] = [
    (*PAPER[:5], 0.36e9, -1.0), (*PAPER[:5], -0.7e9, 1e9), (*PAPER[:5], -0.7, 1.0),
    (PAPER[0], 0.0, *PAPER[2:]),
]  # fmt: skip
MOTIONS: Sequence[Point] = [(72.2, 1.0, 3e7, 4e8), (0.5, 3.0, 2e5, 8e3), (2.0, 0.01, 30.0, 5e5)]
"""Values of m, v0, xi_2 and xi_3, for corrections from small to above the linear term."""


@cache
def motion_cases() -> list[Expected]:
    known = [(scene, kind) for scene in (PAPER, *OTHERS) for kind in (False, True)]
    actual = [ExpectedResult(partial(coefficients, motion=x), by_sums(*x)) for x in known]
    nothing = [math.nan] * 4
    actual += [ExpectedResult(partial(coefficients, motion=(x, True)), nothing) for x in NO_MOTION]
    return [*actual, *map(by_motion, MOTIONS), *map(at_the_end, MOTIONS)]


def coefficients(module: ModuleType, motion: tuple[Point, bool]) -> Point:
    scene, corrected = motion
    actual = module.printed_motion(*scene, 12, corrected=corrected)
    return actual.m, actual.v0, actual.xi_2, actual.xi_3


def by_sums(scene: Point, corrected: bool) -> list[float]:
    with mp.workdps(30):
        gamma_2, gamma_3 = (truncated_gamma(k, 12, scene) for k in (2, 3))
        power = mpf(8) / 3 if corrected else 3
        return [scene[1], scene[2], float(1 / gamma_2), float(-gamma_3 / gamma_2**power)]


def by_motion(numbers: Point) -> ExpectedResult:
    """Return the case of a motion: end values, (15), and (16) within and outside its range."""
    m, v0, xi_2, xi_3 = map(mpf, numbers)
    fractions = (0.01, 0.11, 0.5, 0.93)
    with mp.workdps(30):
        rate, excess = mp.sqrt(xi_2 / m), 3 * xi_3 / 4 * (v0 * mp.sqrt(m / xi_2)) ** (mpf(8) / 3)
        excess /= m * v0**2
        last = mp.findroot(
            lambda s: s**2 + excess * s ** (mpf(8) / 3) - 1, (1e-9, 1), solver="anderson"
        )
        breaks = float(mp.asin(last) / rate)
        times = [fraction * breaks for fraction in fractions]
        linear = [float(v0 / rate * mp.sin(rate * t)) for t in times]
        ends = [mp.pi / rate, v0 / rate, excess, last, breaks, 2 * mp.asin(last) / mp.pi]
    whole = [float(motion_balls.corrected(t, *numbers, digits=16)) for t in times]
    outside = [-1e-3 * breaks, 1.001 * breaks]

    def results(module: ModuleType) -> list[float]:
        motion = module.PrintedMotion(*numbers)
        names = "contact_time", "max_indentation", "excess", "last", "valid_until", "valid_fraction"
        return [
            *(getattr(motion, name) for name in names),
            *motion.linear(np.array(times)),
            float(motion.linear(times[1])),
            *motion.corrected(np.array([*times, *outside])),
            float(motion.corrected(times[1])),
        ]

    exact = [*ends, *linear, linear[1], *whole, math.nan, math.nan, whole[1]]
    return ExpectedResult(results, [float(x) for x in exact])


def at_the_end(motion: Point) -> ExpectedResult:
    """Return the case of (16) at the zero of the radicand, approached like a square root."""
    end = PrintedMotion(*motion).valid_until  # tested by `by_motion`
    exact = float(motion_balls.corrected(end * (1 - 1e-10), *motion, digits=12))

    def results(module: ModuleType) -> float:
        actual = module.PrintedMotion(*motion)
        return float(actual.corrected(actual.valid_until))

    return ExpectedResult(results, exact, 1e-4)


TESTS = {
    "perturbation": ModuleTests(
        motion_cases,
        {**dict.fromkeys(("_NODES", "_PARTS"), (1, FINE)), "last": (3, START), "_eta": (2, FINE)},
        steps=10,
    ),
}


@pytest.mark.parametrize("name", TESTS)
def test_mutants_are_detected_up_to_the_listed_number(name: str) -> None:
    assert undetected(name, TESTS[name]) == {}
