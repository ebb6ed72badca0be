"""Difficult points for every function: exact doubles, the same in every run.

The relevant quantities are dimensionless: x = phi h, y = a phi, z/h, r/b and nu. Their values come
from lists of known difficulties and from a seeded generator, and are converted to arguments in
several systems of units. Whether a double can represent the value at a point is decided by the
reference value.
"""

import math
import random
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import cache

from derivation.engine.formula.domain import violated_conditions
from derivation.engine.formula.grid import around
from derivation.engine.formula.ulp import neighbours
from derivation.engine.measure.point import Point
from derivation.engine.rewrite.form import switch_points
from derivation.plate.blocks import blocks
from derivation.plate.contact.kernels.moments import FIRST_K, finite_part_start, kappa_start
from derivation.plate.modes.kernels.forms import mode_forms
from derivation.plate.vocabulary import BY_NAME

SMALLEST = -150
"""Decimal exponent of the smallest phi h and a phi."""

SMALL = (SMALLEST, -120, -100, -77, -60, -50, -40, -30, -25, -20, -16, -14, -12, -10, -8, -7, -6)
LARGE = (36.04, 88.7, 100.0, 177.0, 300.0, 354.5, 372.0, 700.0, 708.3, 709.8, 745.1, 1e3, 1e4, 1e6)
"""Values below and above overflow or underflow of e^x, e^(2x), e^(4x) in either format."""

NU = (0.3, 0.0, 0.45, -0.2, 0.33, -0.6, 0.1, 0.499, 0.21, -0.9, 0.4999, 0.49999999, -0.999)
LENGTHS = (1.0, 1e-3, 25.4, 3e-7, 640.0)
"""Scales of length: metres, millimetres in metres, inches in millimetres, and extreme ones."""

STRESSES = (8.1e10, 1.0, 7.7e4, 2.6e-3)
"""Scales of stress: steel in Pa, unit modulus, steel in MPa, and a gel in MPa."""

HEIGHTS = (None, 1.0, None, -1.0, None, 0.0, None, "below +1", None, "above -1", None, 1e-9, None)
"""z/h; None stands for a random value, and words for the doubles next to the faces."""

RADII = (None, 0.0, None, 1e-12, None, "below +1", None, 0.5, None)
"""r/a of the pressure, whose edge r = a is singular, and r/b of the modal sums."""

MODES = (1, 3, 20, 2, 7, 60)
BESSEL_LARGE = (25.0, 100.0, 1e3, 12345.678, 1e5, 1e6, 1e8)
INDICES = (0, 1, 2, 3, 5, 9, 40, 195, 1000, 10**6)
"""Indices of kappa_n, and of M_k minus its first index; switch points are added."""

DRAWS = 200
"""Number of random values tried to find one inside a symbol's domain."""

COUNTS = (*range(1, 41), 64, 99, 100, 128, 500, 999, 1000, 4096, 10**4, 10**5)


def grid(name: str, arguments: Sequence[str], modes: bool = False) -> tuple[Point, ...]:
    """Return the points at which a function is tested.

    Parameters
    ----------
    name
        Name of the function; it seeds the random values.
    arguments
        Names of its arguments; they decide which lists apply.
    modes
        Whether it is a modal sum.

    Raises
    ------
    KeyError
        If an argument is not a symbol of the paper.
    """
    generator = random.Random(f"{name} on {','.join(arguments)}")
    if tuple(arguments) == ("count",):
        return tuple(Point({"count": float(count)}) for count in COUNTS)
    if tuple(arguments) in (("n",), ("k",)):
        return tuple(Point({arguments[0]: float(i)}) for i in _whole_numbers(arguments[0]))
    if tuple(arguments) == ("x",):
        return tuple(Point({"x": x}) for x in _bessel_arguments(generator))
    draw = _plates(generator) if modes else _single_modes(generator, arguments)
    counts = MODES if modes else (None,)
    return tuple(
        Point(
            {key: values[key] if key in values else drawn(key, generator) for key in arguments},
            counts[i % len(counts)],
        )
        for i, values in enumerate(draw)
    )


def drawn(name: str, generator: random.Random) -> float:
    """Return a value [SI] inside the domain of a symbol that has no rule of its own.

    Raises
    ------
    KeyError
        If the symbol is unknown, or no random value lies in its domain.
    """
    argument = BY_NAME[name]
    for attempt in range(DRAWS):
        size = 10 ** generator.uniform(-3.0, 3.0) * (1 if attempt % 2 == 0 else -1)
        if not violated_conditions(argument.domain, {argument.symbol: Fraction(size)}):
            return size
    raise KeyError(f"no value of {name} found that satisfies {', '.join(argument.domain)}")


@cache
def switches() -> dict[str, tuple[float, ...]]:
    """Return the switch points of the stable forms by variable: T is 2 phi h, y is a phi."""
    modes = (value for _, value in mode_forms().values())
    return switch_points((*(block.value for block in blocks().values()), *modes))


def depths(generator: random.Random) -> list[float]:
    """Return x = phi h: both sides of switch points, decades, dense middle range, large values."""
    at_switches = [T / 2 for T in switches()["T"]]
    return [
        *around(sorted(set(at_switches))),
        *(10.0**exponent for exponent in SMALL[::2]),
        *(generator.uniform(1.0, 9.0) * 10.0**exponent for exponent in SMALL),
        *(10 ** generator.uniform(-6.0, -1.0) for _ in range(12)),
        *(10 ** generator.uniform(-1.0, 1.6) for _ in range(44)),
        *LARGE,
    ]


def widths(generator: random.Random) -> list[float]:
    """Return y = a phi: switch points, decades, middle range, neighbours of roots of tan y = y."""
    zeros = [near for k in (1, 2, 3, 7, 30) for near in neighbours(_zero_of_sine_minus(k), 1)]
    return [
        *around(switches().get("y", ())),
        *zeros,
        *(10.0**exponent for exponent in SMALL[::2]),
        *(generator.uniform(1.0, 9.0) * 10.0**exponent for exponent in SMALL),
        *(10 ** generator.uniform(-6.0, -0.5) for _ in range(16)),
        *(10 ** generator.uniform(-0.5, 2.0) for _ in range(40)),
        *(1e3, 12345.678, 1e5, 1e6),
    ]


def _zero_of_sine_minus(k: int) -> float:
    """Return a double next to the k-th positive zero of sin y - y cos y, from y = k pi + atan y."""
    y = (k + 0.5) * math.pi
    for _ in range(60):
        y = k * math.pi + math.atan(y)
    return y


def _whole_numbers(argument: str) -> list[int]:
    """Return indices of kappa_n or M_k, ascending, on both sides of the switch to the expansion."""
    first, start = (0, kappa_start()) if argument == "n" else (FIRST_K, finite_part_start())
    return sorted({start - 1, start, *(first + index for index in INDICES)})


def _bessel_arguments(generator: random.Random) -> list[float]:
    """Return zero, decades, dense values in the tables' range, neighbours of zeros, large x."""
    zeros = (2.404825557695773, 5.520078110286311, 3.8317059702075125, 7.015586669815619)
    return [
        0.0,
        *(10.0**exponent for exponent in SMALL),
        *(near for zero in zeros for near in neighbours(zero, 1)),
        *(generator.uniform(0.0, 4.0) for _ in range(24)),
        *(generator.uniform(4.0, 60.0) for _ in range(60)),
        *BESSEL_LARGE,
        *(10 ** generator.uniform(1.5, 6.0) for _ in range(16)),
    ]


def _lame(index: int, generator: random.Random) -> tuple[float, float]:
    """Return Lame constants for the next of the listed Poisson's ratios, in the next unit."""
    nu = NU[index % len(NU)]
    mu = STRESSES[index % len(STRESSES)] * generator.uniform(0.7, 1.4)
    return 2 * mu * nu / (1 - 2 * nu), mu


def _within(end: float, place: float | str | None, generator: random.Random, low: float) -> float:
    """Return a coordinate in [low end, end]: a fraction of the end, its neighbour, or random."""
    if place is None:
        return end * generator.uniform(low, 1.0)
    if isinstance(place, str):
        return math.copysign(math.nextafter(end, 0.0), 1.0 if place == "below +1" else -1.0)
    return end * place


def _single_modes(generator: random.Random, arguments: Sequence[str]) -> Iterator[dict[str, float]]:
    """Yield arguments of the closed formulas, one set for each x or y."""
    by_width = "a" in arguments and "phi" in arguments
    values = widths(generator) if by_width else depths(generator)
    for i, hard in enumerate(values):
        length = 1.0 if i < len(values) // 5 else LENGTHS[i % len(LENGTHS)]
        # The first fifth, at the switch points, keeps the unit length: phi h is then exact.
        size = length if length == 1.0 else length * generator.uniform(0.5, 2.0)
        lam, mu = _lame(i, generator)
        yield {
            "T": 2 * hard,
            "phi": hard / size,
            "h": size,
            "a": size,
            "r": _within(
                size, RADII[i % len(RADII)] if i % len(RADII) != 3 else None, generator, 0
            ),
            "z": _within(size, HEIGHTS[i % len(HEIGHTS)], generator, -1.0),
            "b": size * generator.uniform(1.5, 60.0),
            "R": size * generator.uniform(1.5, 60.0),
            "lam": lam,
            "mu": mu,
            "P": 10 ** generator.uniform(-3.0, 6.0),
            "A_j": generator.choice((-1, 1)) * mu * 10 ** generator.uniform(-6.0, -1.0),
            "J1": generator.choice((-1, 1)) * generator.uniform(0.01, 0.55),
            **{
                f"C{k}": generator.uniform(-1.0, 1.0) * (size if k < 3 else 1.0)
                for k in range(1, 5)
            },
        }


def _plates(generator: random.Random) -> Iterator[dict[str, float]]:
    """Yield arguments of the modal sums: thin to thick plates, small to wide contacts."""
    for i in range(72):
        b = LENGTHS[i % len(LENGTHS)] * generator.uniform(0.5, 2.0)
        h = b * 10 ** generator.uniform(-2.5, 0.5)
        a = b * 10 ** generator.uniform(-3.0, -0.05)
        lam, mu = _lame(i, generator)
        yield {
            "r": _within(b, (*RADII, 1.0)[i % (len(RADII) + 1)], generator, 0.0),
            "z": _within(h, HEIGHTS[i % len(HEIGHTS)], generator, -1.0),
            "h": h,
            "b": b,
            "R": a * generator.uniform(1.5, 100.0),
            "a": a,
            "lam": lam,
            "mu": mu,
        }
