"""What a search compares with reference values: a function, its domain and its allowance."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from random import Random
from types import CodeType

from derivation.engine.formula.ball import PrecisionError
from derivation.engine.formula.ulp import from_ordinal, ordinal, overflows, ulp_error
from derivation.engine.measure.check import Judge
from derivation.engine.measure.judge import Error, judge, largest
from derivation.engine.measure.kernels import Kernel
from derivation.engine.measure.point import Point
from derivation.engine.oracle.reference import Reference

Numbers = tuple[float, ...]
"""A function's results at a point."""
NO_REFERENCE = PrecisionError, ValueError, ZeroDivisionError, OverflowError
"""What a reference raises where it has no value: at singular points, outside the domain."""

_DIGITS, _FEW = 50, 20
"""Digits of the reference, and of the upper bound."""


@dataclass(frozen=True)
class Domain:
    """Where a function is searched.

    Parameters
    ----------
    name
        The function.
    arguments
        Their names in order.
    modes
        Whether it is a modal sum.
    conditions
        What the arguments satisfy, as comparisons in Python's notation; the doubles are compared as
        a function compares them, rounding included. Those that name other arguments do not count.
    whole
        Whether its arguments are whole numbers.
    """

    name: str
    arguments: tuple[str, ...]
    modes: bool
    conditions: tuple[str, ...]
    whole: bool = False

    def holds(self, point: Point) -> bool:
        """Whether a point lies in the domain."""
        codes = _compiled(self.conditions, self.arguments)
        finite = all(math.isfinite(value) for value in point.values.values())
        # The conditions are a manifest's and a paper's own, never a stranger's.
        return finite and all(eval(code, {"abs": abs}, dict(point.values)) for code in codes)

    def moved(self, point: Point, name: str, steps: int) -> Point:
        """Return the point with one argument so many floats, or whole numbers, further on."""
        value = point.values[name]
        there = value + steps if self.whole else _beside(value, steps)
        return Point({**point.values, name: there}, point.modes)


@cache
def _compiled(conditions: tuple[str, ...], arguments: tuple[str, ...]) -> tuple[CodeType, ...]:
    """The conditions that name nothing but arguments."""
    codes = (compile(condition, "<domain>", "eval") for condition in conditions)
    return tuple(code for code in codes if set(code.co_names) - {"abs"} <= set(arguments))


def _beside(value: float, floats: int) -> float:
    end = ordinal(math.nextafter(math.inf, 0.0))
    return from_ordinal(min(max(ordinal(value) + floats, -end), end))


Draw = Callable[[Domain, Random], Point]
"""Returns a random point of a domain."""
Measure = Callable[[Point, Numbers], Error | None]
"""Point and results -> the largest error; None where no double holds the reference value, there is
none, or the point lies outside the domain after all."""


@dataclass(frozen=True)
class Target:
    """A function to be searched.

    Parameters
    ----------
    domain
        Where.
    draw
        Draws a point of the domain.
    call
        Points -> results.
    measure
        Judges results.
    bound
        Point and results -> a number that `measure`'s ratio never exceeds, found with less effort;
        None where there is no such short cut.
    share, every
        Points per turn, and how many rounds go by for one turn.
    """

    domain: Domain
    draw: Draw
    call: Callable[[Sequence[Point]], list[Numbers]]
    measure: Measure
    bound: Callable[[Point, Numbers], float] | None
    share: int
    every: int

    @property
    def name(self) -> str:
        """The function's name."""
        return self.domain.name


def measure_by(references: Callable[[Point], Sequence[Reference] | None], budget: float) -> Measure:
    """Return what judges all results at a point by their references."""

    def measure(point: Point, results: Numbers) -> Error | None:
        try:
            found = references(point)
        except NO_REFERENCE:
            return None
        if found is None or any(overflows(true.value) for true in found):
            return None
        pairs = zip(results, found, strict=True)
        return largest(judge(got, true, budget) for got, true in pairs)

    return measure


def closed_target(
    by: Judge, domain: Domain, kernel: Kernel, draw: Draw, share: int = 48, every: int = 1
) -> Target:
    """Return a function of the manifest, with its budget and what conditioning allows."""
    balls, budget = by.routes.balls, float(kernel.budget or 0.0)

    def call(points: Sequence[Point]) -> list[Numbers]:
        return [(float(value),) for value in kernel.results(points)]

    def bound(point: Point, results: Numbers) -> float:
        # The allowance is the budget and more, so error over budget is an upper bound:
        # who stays below the worst ratio by this is spared the condition numbers.
        try:
            ball = balls.truth(kernel.name, point.values, _FEW, point.modes)
        except NO_REFERENCE:
            return math.inf
        return ulp_error(results[0], ball) / budget

    def references(point: Point) -> tuple[Reference]:
        return (balls.reference(kernel.name, point.values, _DIGITS, point.modes),)

    return Target(domain, draw, call, measure_by(references, budget), bound, share, every)
