"""The functions that are searched for larger errors, with domains and allowances."""

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
from derivation.engine.nearest import did_you_mean, one_of
from derivation.engine.oracle.reference import Reference

Numbers = tuple[float, ...]
"""A function's results at a point."""
NO_REFERENCE = PrecisionError, ValueError, ZeroDivisionError, OverflowError
"""Exceptions if there is no reference value: at singular points and outside the domain."""

_DIGITS, _FEW = 50, 20
"""Numbers of digits of the reference and of the upper bound."""


@dataclass(frozen=True)
class Domain:
    """The domain in which a function is searched.

    Parameters
    ----------
    name
        Name of the function.
    arguments
        Names of the arguments in order.
    modes
        Whether it is a modal sum.
    conditions
        Conditions on the arguments, as comparisons in Python's notation; the doubles are compared
        as in a function, rounding included. Conditions with other arguments are ignored.
    whole
        Whether its arguments are whole numbers.
    """

    name: str
    arguments: tuple[str, ...]
    modes: bool
    conditions: tuple[str, ...]
    whole: bool = False

    def holds(self, point: Point) -> bool:
        """Return whether a point is in the domain."""
        codes = _compiled(self.conditions, self.arguments)
        finite = all(math.isfinite(value) for value in point.values.values())
        # The conditions come from the manifest and the paper, never from the user.
        return finite and all(eval(code, {"abs": abs}, dict(point.values)) for code in codes)

    def moved(self, point: Point, name: str, steps: int) -> Point:
        """Return the point with one argument changed by a number of floats, or of integers."""
        value = point.values[name]
        moved_value = value + steps if self.whole else _moved_value(value, steps)
        return Point({**point.values, name: moved_value}, point.modes)


@cache
def _compiled(conditions: tuple[str, ...], arguments: tuple[str, ...]) -> tuple[CodeType, ...]:
    """Return the conditions that contain no other names than those of the arguments."""
    codes = (compile(condition, "<domain>", "eval") for condition in conditions)
    return tuple(code for code in codes if set(code.co_names) - {"abs"} <= set(arguments))


def _moved_value(value: float, floats: int) -> float:
    end = ordinal(math.nextafter(math.inf, 0.0))
    return from_ordinal(min(max(ordinal(value) + floats, -end), end))


Draw = Callable[[Domain, Random], Point]
"""Function that returns a random point of a domain."""
Measure = Callable[[Point, Numbers], Error | None]
"""Function from point and results to the largest error; None if there is no reference value, it
overflows, or the point lies outside the domain."""


@dataclass(frozen=True)
class Target:
    """A function to be searched.

    Parameters
    ----------
    domain
        The domain of the search.
    draw
        Function that returns a random point of the domain.
    call
        Function of points that returns the results.
    measure
        Function that returns the error of the results.
    bound
        Function of point and results that returns an upper bound of the ratio of error to allowance
        in less time than `measure`; None if there is none.
    turn_size, every
        Number of points in a turn, and number of rounds from one turn to the next.
    """

    domain: Domain
    draw: Draw
    call: Callable[[Sequence[Point]], list[Numbers]]
    measure: Measure
    bound: Callable[[Point, Numbers], float] | None
    turn_size: int
    every: int

    @property
    def name(self) -> str:
        """Name of the function."""
        return self.domain.name


def named_targets(known: Sequence[Target], names: Sequence[str]) -> tuple[Target, ...]:
    """Return all targets, or those with the given names.

    Raises
    ------
    ValueError
        If no function has one of the names.
    """
    every = [one.name for one in known]
    unknown = [name for name in names if name not in every]
    if unknown:
        suggestion = did_you_mean(unknown[0], every, most=3)
        raise ValueError(
            f"--function: no generated function {unknown[0]!r}: {suggestion}expected one of "
            f"{one_of(every)}"
        )
    return tuple(one for one in known if not names or one.name in names)


def measure_by(
    references: Callable[[Point], Sequence[Reference] | None], budget: float, share: float = 0.5
) -> Measure:
    """Return a function that compares all results at a point with their reference values."""

    def measure(point: Point, results: Numbers) -> Error | None:
        try:
            references_at = references(point)
        except NO_REFERENCE:
            return None
        if references_at is None or any(overflows(reference.value) for reference in references_at):
            return None
        pairs = zip(results, references_at, strict=True)
        return largest(judge(got, reference, budget, share=share) for got, reference in pairs)

    return measure


def closed_target(
    by: Judge, domain: Domain, kernel: Kernel, draw: Draw, turn_size: int = 48, every: int = 1
) -> Target:
    """Return the search target for a function with a budget, and an allowance for conditioning."""
    balls, budget = by.routes.balls, float(kernel.budget or 0.0)

    def call(points: Sequence[Point]) -> list[Numbers]:
        return [(float(value),) for value in kernel.results(points)]

    def bound(point: Point, results: Numbers) -> float:
        # The allowance is at least the budget, so that error over budget is an upper bound. If it
        # does not exceed the largest ratio, condition numbers are not needed.
        try:
            ball = balls.value(kernel.name, point.values, _FEW, point.modes)
        except NO_REFERENCE:
            return math.inf
        return ulp_error(results[0], ball) / budget

    def references(point: Point) -> tuple[Reference]:
        return (balls.reference(kernel.name, point.values, _DIGITS, point.modes),)

    return Target(
        domain, draw, call, measure_by(references, budget, kernel.share), bound, turn_size, every
    )
