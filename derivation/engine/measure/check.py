"""Check of the generated functions against reference values at difficult points."""

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import flint

from derivation.engine.activity import Progress, quiet
from derivation.engine.formula.ball import PrecisionError
from derivation.engine.formula.ulp import DOUBLE, SINGLE, Format, overflows
from derivation.engine.measure.judge import Errors, PointReference, measured_errors
from derivation.engine.measure.kernels import Kernel, generated_kernels, printed_kernels
from derivation.engine.measure.point import Point, to_single
from derivation.engine.measure.suite import Suite
from derivation.engine.oracle.agreement import Routes
from derivation.engine.oracle.oracle import Balls
from derivation.engine.oracle.reference import Reference

AGREEMENTS = 2
"""Number of points per function at which the second reference method is evaluated too."""

SMALL = 1e-60
"""Magnitude of a value above which the second reference method is fast."""

STEEP = 1e4
"""Condition number next to a point from which the slope at the point counts as infinite."""

EVERY = 4
"""Single precision is tested at every fourth point."""


def _anywhere(_: Point) -> bool:
    return True


def _in_any_domain(_: str, __: Point) -> bool:
    return True


@dataclass(frozen=True, eq=False)
class Judge:
    """The references and the points with which a paper's generated functions are tested.

    Parameters
    ----------
    routes
        Both reference methods.
    grid
        Function from a function's name, its arguments' names and whether it is a sum to its points.
    package
        Import name of the generated package.
    easy
        Function that returns whether the second reference method is fast at a point.
    inside
        Function that returns whether a point lies in the domain of the function with a given name;
        a point that is rounded to single precision may not.
    hard
        Function that returns the hard cases, if there are any; their modules are loaded when it is
        called.
    """

    routes: Routes
    grid: Callable[[str, Sequence[str], bool], Sequence[Point]]
    package: str
    easy: Callable[[Point], bool] = _anywhere
    inside: Callable[[str, Point], bool] = _in_any_domain
    hard: Callable[[], Suite] | None = None


@dataclass(frozen=True)
class Row:
    """The result of one function.

    Parameters
    ----------
    kernel, module
        Name of the function and of its module.
    budget
        Error budget in ULP; None for the formulas as published.
    double
        Errors with double arguments.
    single
        Errors with single-precision arguments, in ULP of single precision; None for tables, which
        take no such arguments, and for the formulas as published.
    oracles
        Number of points at which two independent reference methods were compared, and agree.
    passed
        Whether no error exceeds the budget; None without a budget.
    """

    kernel: str
    module: str
    budget: float | None
    double: Errors
    single: Errors | None
    oracles: int
    passed: bool | None


def check(
    by: Judge,
    digits: int = 50,
    kernels: Sequence[Kernel] | None = None,
    progress: Progress = quiet,
) -> tuple[Row, ...]:
    """Measure the errors of functions against reference values.

    Parameters
    ----------
    by
        The references and the points.
    digits
        Number of correct decimal digits of the reference values, at least 20.
    kernels
        Functions to measure; by default all generated ones and the formulas as published.
    progress
        Called for each function before it is measured.

    Returns
    -------
    tuple of Row
        Errors, budget and result of each function.

    Raises
    ------
    OracleError
        If the reference methods contradict each other, so that there is no reference value.
    ValueError
        If the number of digits is below 20.
    """
    if digits < 20:
        raise ValueError(f"expected at least 20 digits of the reference values, got {digits}")
    chosen = (
        (*generated_kernels(by.package), *printed_kernels(by.package))
        if kernels is None
        else tuple(kernels)
    )
    known: dict[str, list[PointReference]] = {}
    rows = []
    for number, kernel in enumerate(chosen, start=1):
        progress(kernel.name, number, len(chosen))
        points = by.grid(kernel.name, kernel.arguments, kernel.modes)
        if kernel.name not in known:
            known[kernel.name] = reference_values(by.routes.balls, kernel.name, points, digits)
        rows.append(_row(by, kernel, points, known[kernel.name], digits))
    return tuple(rows)


def _row(
    by: Judge,
    kernel: Kernel,
    points: Sequence[Point],
    references: Sequence[PointReference],
    digits: int,
) -> Row:
    double = measured_errors(kernel, references, len(points) - len(references))
    if kernel.budget is None:
        return Row(kernel.name, kernel.module, None, double, None, 0, None)
    single = None if kernel.by_count else _single(by, kernel, points, digits)
    passed = double.within_limits() and (single is None or single.within_limits(SINGLE))
    oracles = confirm(by, kernel, references, digits)
    return Row(kernel.name, kernel.module, kernel.budget, double, single, oracles, passed)


def reference_values(
    balls: Balls, name: str, points: Sequence[Point], digits: int, fmt: Format = DOUBLE
) -> list[PointReference]:
    """Return the reference values at those points at which they do not overflow the format."""

    def reference(point: Point) -> Reference:
        try:
            return balls.reference(name, point.values, digits, point.modes)
        except PrecisionError as error:
            found = without_slope(point)
            if found is not None:
                return found
            raise ValueError(
                f"{error}: expected a value in the whole domain; cancel divisors that vanish there "
                "in the formula, or exclude the point by the domains of its arguments"
            ) from None

    def without_slope(point: Point) -> Reference | None:
        """Return the value at a point where the slope is unknown, with the slope next to it.

        A steep slope counts as infinite, like that of a root at the end of its domain: the sum
        of the condition numbers then allows any finite result.
        """
        with suppress(PrecisionError):
            value = balls.value(name, point.values, digits, point.modes)
            for neighbour in neighbouring_references(point):
                steep = neighbour.total > STEEP * neighbour.magnitude
                slopes = {"all": flint.arb.pos_inf()} if steep else neighbour.sensitivity
                return replace(neighbour, value=value, sensitivity=slopes, magnitude=abs(value))
        return None

    def neighbouring_references(point: Point) -> Iterator[Reference]:
        """Yield the references that exist at the floating-point numbers next to each argument."""
        for key, x in point.values.items():
            for end in (-math.inf, math.inf):
                values = {**point.values, key: math.nextafter(x, end)}
                with suppress(PrecisionError):
                    neighbour = balls.reference(name, values, digits, point.modes)
                    if neighbour.value.is_finite():
                        yield neighbour

    references = ((point, reference(point)) for point in points)
    return [
        PointReference(point, (ref,)) for point, ref in references if not overflows(ref.value, fmt)
    ]


def _single(by: Judge, kernel: Kernel, points: Sequence[Point], digits: int) -> Errors:
    """Return the errors of a function in single precision, at every fourth point."""
    singles = (single for p in points[::EVERY] if (single := to_single(p)) is not None)
    rounded = [single for single in singles if by.inside(kernel.name, single)]
    references = reference_values(by.routes.balls, kernel.name, rounded, digits, SINGLE)
    return measured_errors(kernel, references, len(rounded) - len(references), SINGLE)


def confirm(by: Judge, kernel: Kernel, references: Sequence[PointReference], digits: int) -> int:
    """Compare both reference methods at points where the second is fast; return their number.

    It is 0 for a formula without a method of its own, which is only evaluated again, by mpmath.

    Raises
    ------
    OracleError
        If the methods contradict each other.
    """
    easy = [t for t in references if by.easy(t.point) and bool(abs(t.references[0].value) > SMALL)]
    chosen = easy[:: max(1, len(easy) // AGREEMENTS)][:AGREEMENTS]
    for at in chosen:
        by.routes.agree(kernel.name, at.point.values, digits, at.point.modes)
    return len(chosen) if kernel.name in by.routes.routes else 0
