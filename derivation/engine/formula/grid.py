"""Difficult points of any function, from the domains of its arguments; the same in every run.

Each argument in turn takes powers of ten of both signs from 1e-150 to 1e9, values next to the ends
of its domain, and values on both sides of the switch points of its forms. The other arguments have
random values inside their domains.
"""

import math
import random
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache, partial

import sympy as sp

from derivation.engine.formula.domain import excess, violated_conditions
from derivation.engine.formula.ulp import neighbours
from derivation.engine.formula.vocabulary import Argument, Vocabulary, symbols_of

EXPONENTS = (-150, -100, -50, -20, -12, -8, -5, -3, -2, -1, 0, 1, 2, 3, 6, 9)
"""Exponents of the powers of ten that every argument takes, inside its domain."""
FRACTIONS = (0.5, 1e-3, 1e-8, 1e-15)
"""Distances from the end of a domain, relative to the end."""
DRAWN = 24
"""Number of points at which all arguments are random."""
ZEROS, STEPS_TO_ZERO = 24, 14
"""Numbers of pairs of points with opposite signs, and of points that are tested between each."""
NEXT_TO_ENDS = (0.25, 0.25, 0.75)
"""Fractions of arguments that are next to an end of their domains, for each kind of point."""
MAGNITUDES = 10.0
"""Ratio of the ends of a domain above which all magnitudes in it are equally likely."""
DECADES_DRAWN = 3.0, 12.0, 100.0
"""Exponents of ten of the ranges in which points are drawn if numbers of moderate size are outside
the domain."""
ATTEMPTS = 400
"""Number of random points that are tried to find one in the domain."""


def inside(vocabulary: Vocabulary, values: Mapping[str, float]) -> bool:
    """Return whether a point lies in the domain of its symbols."""
    arguments = vocabulary.by_name
    domain = [condition for key in values for condition in arguments[key].domain]
    return not violated_conditions(
        domain, {arguments[key].symbol: Fraction(value) for key, value in values.items()}
    )


@lru_cache(maxsize=16)
def plain_grid(
    name: str, arguments: tuple[str, ...], vocabulary: Vocabulary
) -> tuple[dict[str, float], ...]:
    """Return the points of `domain_grid` without switch points, computed once."""
    return domain_grid(name, arguments, vocabulary, {})


def domain_grid(
    name: str,
    arguments: Sequence[str],
    vocabulary: Vocabulary,
    switches: Mapping[str, Sequence[float]],
    seed: str = "",
) -> tuple[dict[str, float], ...]:
    """Return difficult points of a function, as arguments by name.

    Parameters
    ----------
    name
        Name of the function.
    arguments
        Names of its arguments.
    vocabulary
        The symbols with their domains.
    switches
        Switch points of its forms, by argument.
    seed
        Seed of the random values; by default the name.

    Raises
    ------
    ValueError
        If no random point lies in the domain.
    """
    generator = random.Random(f"{seed or name} on {','.join(arguments)}")

    def usual() -> dict[str, float]:
        return {key: _usual(generator, vocabulary.by_name[key]) for key in arguments}

    sources = [usual]
    sources += [partial(joint_point, generator, arguments, vocabulary, d) for d in DECADES_DRAWN]

    def drawn() -> dict[str, float]:
        while sources:
            for _ in range(ATTEMPTS):
                values = sources[0]()
                if inside(vocabulary, values):
                    return values
            del sources[
                0
            ]  # the next attempt uses a larger range, or the conditions on other arguments
        conditions = dict.fromkeys(c for key in arguments for c in vocabulary.by_name[key].domain)
        raise ValueError(
            f"{name} cannot be tested: none of {ATTEMPTS * (1 + len(DECADES_DRAWN))} random points "
            f"satisfies {', '.join(conditions)}; these conditions exclude each other, or allow a "
            "narrow range only: correct the domains of its arguments"
        )

    points = [drawn() for _ in range(DRAWN)]
    for key in arguments:
        own = (*_candidates(vocabulary.by_name[key].domain), *around(switches.get(key, ())))
        points += [drawn() | {key: value} for value in own]
    return tuple(values for values in points if inside(vocabulary, values))


def joint_points(
    name: str, arguments: Sequence[str], vocabulary: Vocabulary, decades: int, count: int
) -> tuple[dict[str, float], ...]:
    """Return points at which several arguments are extreme, next to ends, or nearly equal.

    Parameters
    ----------
    name
        Name of the function; it seeds the values.
    arguments
        Names of its arguments.
    vocabulary
        The symbols with their domains.
    decades
        Exponent of ten of the largest magnitude, and its negative is that of the smallest.
    count
        Number of points that are drawn; those outside the domain are left out.
    """
    generator = random.Random(f"{name} jointly on {','.join(arguments)} to 1e{decades}")
    points = (joint_point(generator, arguments, vocabulary, float(decades)) for _ in range(count))
    return tuple(point for point in points if inside(vocabulary, point))


def towards_zeros(
    signs: Iterable[tuple[dict[str, float], int]], sign: Callable[[dict[str, float]], int]
) -> Iterator[dict[str, float]]:
    """Yield points between those of opposite signs, successively closer to a zero.

    Parameters
    ----------
    signs
        Points, each with the sign of the function.
    sign
        Function that returns the sign at a further point, 0 if it is unknown.
    """
    sides: dict[int, list[dict[str, float]]] = {1: [], -1: []}
    for point, side in signs:
        if side:
            sides[side].append(point)
    usual = {side: sorted(points, key=_size) for side, points in sides.items()}
    for above, below in zip(usual[1][:ZEROS], usual[-1][:ZEROS], strict=False):
        ends = {1: above, -1: below}
        for _ in range(STEPS_TO_ZERO):
            middle = {key: _middle(above[key], below[key]) for key in above}
            ends[sign(middle) or 1] = middle
            above, below = ends[1], ends[-1]
            yield middle


def _middle(one: float, other: float) -> float:
    """Return the mean of two numbers, the geometric one if they differ in magnitude."""
    low, high = sorted((abs(one), abs(other)))
    if one * other > 0 and high > MAGNITUDES * low:
        return math.copysign(math.sqrt(low) * math.sqrt(high), one)
    return one / 2 + other / 2


def _size(point: Mapping[str, float]) -> float:
    """Return how far a point's magnitudes are from 1, in decades."""
    return sum(abs(math.log10(abs(value))) for value in point.values() if value)


def joint_point(
    generator: random.Random, arguments: Sequence[str], vocabulary: Vocabulary, decades: float
) -> dict[str, float]:
    """Return random arguments, each in the interval that the conditions on the former ones leave.

    Magnitudes reach from 10^-decades to 10^decades. Conditions that are not linear in an argument
    do not narrow its interval.
    """
    size = min(decades, generator.choice((1.0, 3.0, decades)))
    share = generator.choice(NEXT_TO_ENDS)
    values: dict[str, float] = {}
    for key in sorted(arguments, key=lambda _: generator.random()):
        low, high = _interval(key, values, arguments, vocabulary)
        kind = generator.random()
        ends = [end for end in (low, high) if math.isfinite(end) and end]
        if kind < share and ends:
            value = _near(generator, generator.choice(ends))
        elif kind < share + 0.15 and values:
            value = _near(generator, generator.choice(list(values.values())))
        else:
            value = math.copysign(10 ** generator.uniform(-size, size), generator.random() - 0.3)
            value = abs(value) if low >= 0 else value
        if not low <= value <= high and math.isfinite(low) and math.isfinite(high):
            value = _between(generator, low, high)
        elif not low <= value <= high:
            sign, end = (1, low) if math.isfinite(low) else (-1, high)
            value = end + sign * 10 ** generator.uniform(-1, 1) * (abs(end) or 1.0)
        limit = 10.0**decades
        near_zero = value and abs(value) < 1 / limit
        values[key] = math.copysign(1 / limit, value) if near_zero else value
    return {key: min(max(values[key], -(10.0**decades)), 10.0**decades) for key in arguments}


def _between(generator: random.Random, low: float, high: float) -> float:
    """Return a random number between two ends, of any magnitude if these differ in theirs."""
    part = generator.random()
    if low > 0 and high > MAGNITUDES * low:
        return float(min(max(low ** (1 - part) * high**part, low), high))
    return low + (high - low) * part


def _near(generator: random.Random, value: float) -> float:
    change = 10 ** generator.uniform(-16, -0.3)
    return value * (1 + generator.choice((-1, 1)) * change)


def _interval(
    key: str, known: Mapping[str, float], arguments: Sequence[str], vocabulary: Vocabulary
) -> tuple[float, float]:
    """Return the interval of an argument by the linear conditions on it and known arguments."""
    own = vocabulary.by_name[key]
    given = {vocabulary.by_name[name].symbol: Fraction(value) for name, value in known.items()}
    low, high = own_interval(own)
    for condition in {c for name in arguments for c in vocabulary.by_name[name].domain}:
        names = symbols_of(condition)
        if key in names and len(names) > 1 and names <= {key, *known}:
            least, most = _ends_of(condition, own.symbol, given)
            low, high = max(low, least), min(high, most)
    return low, high


@lru_cache(maxsize=1024)
def own_interval(argument: Argument) -> tuple[float, float]:
    """Return the interval of an argument by the linear conditions on it alone."""
    alone = [c for c in argument.domain if symbols_of(c) == {argument.name}]
    ends = [_ends_of(condition, argument.symbol, {}) for condition in alone]
    lows, highs = zip((-math.inf, math.inf), *ends, strict=True)
    return max(lows), min(highs)


def _ends_of(
    condition: str, own: sp.Symbol, given: Mapping[sp.Symbol, Fraction]
) -> tuple[float, float]:
    """Return the interval in which a condition holds if it is linear in a symbol, or any number."""
    at = [excess(condition, {**given, own: Fraction(x)}) for x in (1, 2, 3)]
    slope = at[1] - at[0]
    if not slope or at[2] - at[1] != slope or "!=" in condition:
        return -math.inf, math.inf
    end = float(1 - at[0] / slope)
    return (-math.inf, end) if ("<" in condition) == (slope > 0) else (end, math.inf)


def _usual(generator: random.Random, argument: Argument) -> float:
    """Return a number of moderate size, inside the argument's own interval if one is found."""
    low, high = own_interval(argument)
    for _ in range(ATTEMPTS):
        value = _random(generator)
        if low <= value <= high:
            return value
    return value


def _random(generator: random.Random) -> float:
    """Return a number of moderate size, negative in one of three cases."""
    size = 10 ** generator.uniform(-2.5, 1.5)
    return -size if generator.random() < 1 / 3 else size


def _candidates(domain: Sequence[str]) -> Iterator[float]:
    """Yield powers of ten of both signs, and numbers next to the ends of the domain."""
    for exponent in EXPONENTS:
        yield from (10.0**exponent, -(10.0**exponent))
    for end in _ends(domain):
        yield from (end, math.nextafter(end, math.inf), math.nextafter(end, -math.inf))
        for part in FRACTIONS:
            yield from (end * (1 + part), end * (1 - part))


def _ends(domain: Sequence[str]) -> Iterator[float]:
    """Yield the numbers in the conditions of a domain."""
    for condition in domain:
        for word in condition.split():
            try:
                yield float(word)
            except ValueError:  # a name or a sign
                continue


def around(points: Sequence[float]) -> Iterator[float]:
    """Yield numbers, their neighbours, and the doubles at a distance of 32 ULP."""
    for point in points:
        neighbourhood = neighbours(point, 32)
        yield from (
            neighbourhood[0],
            neighbourhood[31],
            neighbourhood[32],
            neighbourhood[33],
            neighbourhood[64],
        )
