"""Where methods are judged: arguments with certified results, and arrays to time them on."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import flint
import numpy as np
from flint import arb

from derivation.formula.ball import LOG2_10
from derivation.measure.accuracy.interface import Doubles, Regime, Task
from derivation.measure.accuracy.inversion import SPAN, deepest
from derivation.reference import contact_balls, contact_impact
from generated.contact_law import indentation

SEED = 7
ARRAY = 10_000
"""Points of an array that methods are timed on: its intermediates stay in the cache."""

LAW_DIGITS, QUICK_DIGITS = 120, 45
INVERSION_DIGITS, IMPACT_DIGITS = 28, 24


@dataclass(frozen=True)
class Problem:
    """A task in a regime.

    Attributes
    ----------
    points, truths, digits
        Arguments, the results there as balls, and how many digits of these are sure.
    sample
        Arguments of the same kind, to time.
    """

    task: Task
    regime: Regime
    points: Doubles
    truths: tuple[arb, ...]
    digits: int
    sample: Doubles


def problem(task: Task, regime: Regime, quick: bool) -> Problem:
    """The problem of a task in a regime."""
    makers: Mapping[Task, Callable[[Regime, bool], Problem]] = {
        "law": _law,
        "inversion": _inversion,
        "impact": _impact,
    }
    return makers[task](regime, quick)


def _spread(low: float, high: float, count: int, seed: int) -> Doubles:
    """Random numbers, their logarithms uniform, with both ends."""
    random = np.random.default_rng(seed)
    inner = np.exp(random.uniform(math.log(low), math.log(high), count))
    return np.concatenate([[low, high], inner])


def _law(regime: Regime, quick: bool) -> Problem:
    low, high = regime.low * regime.h, regime.high * regime.h
    digits = QUICK_DIGITS if quick else LAW_DIGITS
    radii = _spread(low, high, 10 if quick else 18, SEED)
    truths = tuple(
        contact_balls.indentation(float(a), regime.R, regime.h, regime.b, digits) for a in radii
    )
    return Problem(
        "law", regime, radii, truths, digits, _spread(low, high, ARRAY - 2, SEED + 1)
    )  # fmt: skip


def _inversion(regime: Regime, quick: bool) -> Problem:
    """Indentations of known radii, rounded; the exact radius is one Newton step away."""
    top = deepest(regime)
    radii = _spread(top / SPAN, 0.999 * top, 6 if quick else 14, SEED)
    R, h, b = regime.R, regime.h, regime.b
    depths = np.array([float(contact_balls.indentation(float(a), R, h, b, 20)) for a in radii])
    with flint.ctx.workprec(math.ceil(3 * INVERSION_DIGITS * LOG2_10)):
        truths = tuple(
            _force(float(a), float(d), regime) for a, d in zip(radii, depths, strict=True)
        )
    sample = indentation(_spread(top / SPAN, 0.999 * top, ARRAY - 2, SEED + 1), R, h, b)
    return Problem("inversion", regime, depths, truths, INVERSION_DIGITS, sample)


def _force(a: float, delta: float, regime: Regime) -> arb:
    """Force at an indentation whose radius is `a` but for 1e-15 of it: the step leaves 1e-30."""
    R, h, b, digits = regime.R, regime.h, regime.b, 2 * INVERSION_DIGITS
    miss = arb(delta) - contact_balls.indentation(a, R, h, b, digits)
    radius = arb(a) + miss / contact_balls.slope(a, R, h, b, INVERSION_DIGITS)
    return 4 * contact_balls.modulus(regime.lam, regime.mu) * radius**3 / (3 * arb(R))


def _impact(regime: Regime, quick: bool) -> Problem:
    shares = (1.0,) if quick else (0.7, 0.85, 1.0)
    speeds = np.array([share * regime.speed for share in shares])
    r = regime
    truths = tuple(
        contact_impact.impact(r.R, r.m, float(v), r.h, r.b, r.lam, r.mu, IMPACT_DIGITS).contact_time
        for v in speeds
    )
    sample = _spread(0.7 * r.speed, r.speed, ARRAY - 2, SEED + 1)
    return Problem("impact", regime, speeds, truths, IMPACT_DIGITS, sample)
