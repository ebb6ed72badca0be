"""Difficult points of any function, from the domains of its arguments; the same in every run.

Each argument in turn takes powers of ten of both signs from 1e-150 to 1e9, values next to the ends
of its domain, and values on both sides of the switch points of its forms. The other arguments have
random values inside their domains.
"""

import math
import random
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from derivation.engine.formula.domain import violated_conditions
from derivation.engine.formula.ulp import neighbours
from derivation.engine.formula.vocabulary import Vocabulary

EXPONENTS = (-150, -100, -50, -20, -12, -8, -5, -3, -2, -1, 0, 1, 2, 3, 6, 9)
"""Exponents of the powers of ten that every argument takes, inside its domain."""
FRACTIONS = (0.5, 1e-3, 1e-8, 1e-15)
"""Distances from the end of a domain, relative to the end."""
DRAWN = 24
"""Number of points at which all arguments are random."""
ATTEMPTS = 400
"""Number of random points that are tried to find one in the domain."""


def inside(vocabulary: Vocabulary, values: Mapping[str, float]) -> bool:
    """Return whether a point lies in the domain of its symbols."""
    arguments = vocabulary.by_name
    domain = [condition for key in values for condition in arguments[key].domain]
    return not violated_conditions(
        domain, {arguments[key].symbol: Fraction(value) for key, value in values.items()}
    )


def domain_grid(
    name: str,
    arguments: Sequence[str],
    vocabulary: Vocabulary,
    switches: Mapping[str, Sequence[float]],
) -> tuple[dict[str, float], ...]:
    """Return difficult points of a function, as arguments by name.

    Parameters
    ----------
    name
        Name of the function; it seeds the random values.
    arguments
        Names of its arguments.
    vocabulary
        The symbols with their domains.
    switches
        Switch points of its forms, by argument.

    Raises
    ------
    ValueError
        If no random point lies in the domain.
    """
    generator = random.Random(f"{name} on {','.join(arguments)}")

    def drawn() -> dict[str, float]:
        for _ in range(ATTEMPTS):
            values = {key: _random(generator) for key in arguments}
            if inside(vocabulary, values):
                return values
        raise ValueError(f"found no point in the domain of {name}; widen the domain")

    points = [drawn() for _ in range(DRAWN)]
    for key in arguments:
        own = (*_candidates(vocabulary.by_name[key].domain), *around(switches.get(key, ())))
        points += [drawn() | {key: value} for value in own]
    return tuple(values for values in points if inside(vocabulary, values))


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
