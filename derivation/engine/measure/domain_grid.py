"""Hard points of any function, from the domains of its arguments: the same in every run.

Every argument takes decades from the smallest to the largest, places next to the ends of its own
domain and both sides of the switch points of its forms; the others are drawn at random inside
their domains meanwhile.
"""

import math
import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction

from derivation.engine.formula.chain import Chain
from derivation.engine.formula.domain import broken
from derivation.engine.formula.ulp import neighbours
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.measure.check import Judge
from derivation.engine.measure.point import Point
from derivation.engine.oracle.agreement import Route, Routes
from derivation.engine.oracle.oracle import Balls
from derivation.engine.rewrite.blocks import Definition, built
from derivation.engine.rewrite.form import Seam

EXPONENTS = (-150, -100, -50, -20, -12, -8, -5, -3, -2, -1, 0, 1, 2, 3, 6, 9)
"""Decades that every argument is set to, as far as its domain reaches."""
FRACTIONS = (0.5, 1e-3, 1e-8, 1e-15)
"""Distances from the end of a domain, as a share of the end."""
DRAWN = 24
"""Points at which all arguments are random."""
ATTEMPTS = 400


def domain_judge(
    chain: Chain,
    routes: Mapping[str, Route],
    package: str,
    blocks: tuple[Definition, ...],
    easy: Callable[[Point], bool],
) -> Judge:
    """The judge of closed formulas: on these points, by balls and by the routes given.

    Parameters
    ----------
    chain
        The formulas with their vocabulary.
    routes
        For each formula another route to its value; without one mpmath evaluates the formula.
    package
        Import name of the generated package.
    blocks
        Building blocks of the forms, whose switch points are hard points.
    easy
        Whether a route takes little time at a point.
    """
    own = chain.vocabulary

    def grid(name: str, arguments: Sequence[str], _: bool) -> tuple[Point, ...]:
        return domain_grid(name, arguments, own, seams_of(blocks))

    references = Routes(Balls(own, chain.formulas), routes)
    return Judge(references, grid, package, easy, lambda point: inside(own, point.values))


def seams_of(blocks: tuple[Definition, ...]) -> dict[str, tuple[float, ...]]:
    """Where building blocks change branches, by variable."""
    found: dict[str, set[float]] = {}
    for block in built(blocks).values():
        if isinstance(block.value, Seam):
            found.setdefault(str(block.value.variable), set()).add(float(block.value.at))
    return {variable: tuple(sorted(places)) for variable, places in found.items()}


def inside(vocabulary: Vocabulary, values: Mapping[str, float]) -> bool:
    """Whether a point lies in the domain of its symbols."""
    own = vocabulary.by_name
    domain = [condition for key in values for condition in own[key].domain]
    return not broken(domain, {own[key].symbol: Fraction(value) for key, value in values.items()})


def domain_grid(
    name: str,
    arguments: Sequence[str],
    vocabulary: Vocabulary,
    seams: Mapping[str, Sequence[float]],
) -> tuple[Point, ...]:
    """Points for a function.

    Parameters
    ----------
    name
        The function's name; seeds what is drawn at random.
    arguments
        Its arguments' names.
    vocabulary
        The symbols with their domains.
    seams
        Where its forms change branches, by argument.

    Raises
    ------
    ValueError
        If nothing that is drawn lies in the domain.
    """
    generator = random.Random(f"{name} on {','.join(arguments)}")

    def drawn() -> dict[str, float]:
        for _ in range(ATTEMPTS):
            values = {key: _random(generator) for key in arguments}
            if inside(vocabulary, values):
                return values
        raise ValueError(f"no point of {name} is found in its domain; widen the domain")

    points = [drawn() for _ in range(DRAWN)]
    for key in arguments:
        own = (*_candidates(vocabulary.by_name[key].domain), *_around(seams.get(key, ())))
        points += [drawn() | {key: value} for value in own]
    return tuple(Point(values) for values in points if inside(vocabulary, values))


def _random(generator: random.Random) -> float:
    """A number of moderate size, one in three negative."""
    size = 10 ** generator.uniform(-2.5, 1.5)
    return -size if generator.random() < 1 / 3 else size


def _candidates(domain: Sequence[str]) -> Iterator[float]:
    """Decades of both signs, and numbers next to those that the domain names."""
    for exponent in EXPONENTS:
        yield from (10.0**exponent, -(10.0**exponent))
    for end in _ends(domain):
        yield from (end, math.nextafter(end, math.inf), math.nextafter(end, -math.inf))
        for part in FRACTIONS:
            yield from (end * (1 + part), end * (1 - part))


def _ends(domain: Sequence[str]) -> Iterator[float]:
    """Numbers that the conditions name."""
    for condition in domain:
        for word in condition.split():
            try:
                yield float(word)
            except ValueError:  # a name or a sign
                continue


def _around(places: Sequence[float]) -> Iterator[float]:
    """Places, their neighbours, and the doubles 32 away."""
    for place in places:
        near = neighbours(place, 32)
        yield from (near[0], near[31], near[32], near[33], near[64])
