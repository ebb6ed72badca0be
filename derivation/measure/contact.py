"""The contact law's kernels against the truth: relative errors on plates thin and thick."""

import math
import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import flint
import numpy as np

from derivation.reference import contact_balls, contact_impact

LIMIT = 2e-15
"""Relative error that a kernel keeps."""

DIGITS = 25
THICKNESSES = (1e-4, 1e-3, 1e-2, 0.05, 0.1, 0.3, 0.5302, 0.6, 1.0, 3.0, 10.0, 100.0)
"""h/b; c_1 passes zero near 0.5302."""

RATIOS = (1e-8, 1e-4, 1e-2, 0.1, 0.5, 1.0, 2.0, 3.9, 4.1, 6.0)
"""a/h; the series in it diverges from 4 on."""

LENGTHS = (1.0, 1e-3, 25.4, 640.0)
WIDEST = 0.97
"""Largest a/b: wider contacts are drawn back to it."""

IMPACTS = 8
"""How many impacts are measured: each takes seconds."""

TRUTHS: Mapping[str, Callable[..., Any]] = {
    "indentation": contact_balls.indentation,
    "contact_radius": contact_balls.contact_radius,
    "stiffness": contact_balls.stiffness,
    "impact": contact_impact.impact,
}
"""The first oracle's function for each kernel."""

Point = tuple[float, ...]


@dataclass(frozen=True)
class Row:
    """What one kernel did.

    Parameters
    ----------
    kernel
        Its name.
    points
        How many points were judged.
    max_error, p99_error
        Largest error and its 99th percentile, in the mixed sense of `tolerated`.
    worst
        Arguments of the largest error, in hexadecimal.
    passed
        Whether all errors keep the limit.
    """

    kernel: str
    points: int
    max_error: float
    p99_error: float
    worst: tuple[str, ...]
    passed: bool


def check(
    kernels: Mapping[str, Callable[..., Any]], points: Mapping[str, Sequence[Point]] | None = None
) -> tuple[Row, ...]:
    """Hold kernels to the truth.

    Parameters
    ----------
    kernels
        Functions by name: indentation(a, R, h, b), contact_radius(delta, R, h, b),
        stiffness(a, R, h, b, lam, mu), and impact(R, m, v0, h, b, lam, mu), which
        returns contact time, largest indentation, force and contact radius.
    points
        Arguments by kernel; the default grids if left out.

    Raises
    ------
    ValueError
        For a name that is not among these, and for a kernel without points.
    """
    unknown = sorted(set(kernels) - set(TRUTHS))
    if unknown:
        raise ValueError(f"kernels are called {', '.join(TRUTHS)}; got {', '.join(unknown)}")
    return tuple(
        _row(name, call, grid(name) if points is None else points[name])
        for name, call in kernels.items()
    )


def _row(name: str, call: Callable[..., Any], points: Sequence[Point]) -> Row:
    if not points:
        raise ValueError(f"no point to measure {name} at")
    errors = [_error(name, call, point) for point in points]
    where = max(range(len(points)), key=lambda i: errors[i])
    finite = [error if math.isfinite(error) else 1e300 for error in errors]
    return Row(
        name,
        len(points),
        errors[where],
        float(np.quantile(finite, 0.99)),
        tuple(argument.hex() for argument in points[where]),
        errors[where] <= LIMIT,
    )


def _error(name: str, call: Callable[..., Any], point: Point) -> float:
    """Largest error over the results at a point; infinite if one is not finite."""
    got = call(*point)
    values = [float(value) for value in got] if name == "impact" else [float(got)]
    true = truth(name, point)
    if len(values) != len(true):
        raise ValueError(f"{name} gave {len(values)} results, {len(true)} are expected")
    return max(
        relative(value, ball, tolerated(name, point))
        for value, ball in zip(values, true, strict=True)
    )


def relative(value: float, true: flint.arb, scale: float) -> float:
    """|value - true| over |true| times a scale."""
    if not math.isfinite(value):
        return math.inf
    with flint.ctx.workprec(256):
        return float((abs((flint.arb(value) - true) / true) / scale).abs_upper())


def truth(name: str, point: Point) -> tuple[flint.arb, ...]:
    """The first oracle's answer."""
    found = TRUTHS[name](*point, digits=DIGITS)
    return tuple(found) if name == "impact" else (found,)


def tolerated(name: str, point: Point) -> float:
    """What an error is divided by: (1 + |F|)/|1 + F|, F being what the plate adds to Hertz.

    A sum is known to a unit in the last place of its largest part. Where 1 + F is
    small against that, so is what can be asked; where F itself passes zero, 1
    stays and nothing is excused. Results of an impact are held to their own size.
    """
    if name == "impact":
        return 1.0
    width = point[0]
    if name == "contact_radius":
        width = float(truth(name, point)[0])
    h, b = point[2], point[3]
    if name == "stiffness":
        share = float(contact_balls.slope(width, 2.0, h, b, DIGITS)) / width - 1.0
    else:
        share = float(contact_balls.indentation(width, 1.0, h, b, DIGITS)) / width**2 - 1.0
    return (1.0 + abs(share)) / abs(1.0 + share)


def grid(name: str) -> tuple[Point, ...]:
    """Default points of a kernel: every thickness with every width, the same in every run."""
    generator = random.Random(name)
    found: list[Point] = []
    for i, eta in enumerate(THICKNESSES):
        for k, ratio in enumerate(RATIOS):
            b = LENGTHS[(i + k) % len(LENGTHS)] * generator.uniform(0.5, 2.0)
            h = b * eta
            a = min(h * ratio * generator.uniform(0.9, 1.0), WIDEST * b)
            R = b * generator.uniform(1.5, 60.0)
            mu = 10 ** generator.uniform(0.0, 11.0)
            lam = mu * generator.uniform(-0.6, 50.0)
            found.append(_arguments(name, a, R, h, b, lam, mu))
    return tuple(found[:: max(1, len(found) // IMPACTS)]) if name == "impact" else tuple(found)


def _arguments(
    name: str, a: float, R: float, h: float, b: float, lam: float, mu: float
) -> Point:  # fmt: skip
    """Arguments that lead to a contact of about radius a."""
    if name == "indentation":
        return (a, R, h, b)
    if name == "stiffness":
        return (a, R, h, b, lam, mu)
    depth = float(contact_balls.indentation(a, R, h, b, DIGITS))
    if name == "contact_radius":
        return (depth, R, h, b)
    force = 16 * mu * (lam + mu) / (3 * (lam + 2 * mu)) * a**3 / R
    return (R, 1.0, math.sqrt(0.7 * force * depth), h, b, lam, mu)
