"""The check: every kernel against its truth on its hard points, one row each."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from derivation.engine.activity import Tell, quiet
from derivation.engine.formula.ulp import DOUBLE, SINGLE, Format, overflows
from derivation.engine.measure.judge import Errors, Truth, measured
from derivation.engine.measure.kernels import Kernel, generated_kernels, printed_kernels
from derivation.engine.measure.point import Point, to_single
from derivation.engine.measure.suite import Suite
from derivation.engine.oracle.agreement import Routes
from derivation.engine.oracle.oracle import Balls

AGREEMENTS = 2
"""Points per kernel at which the second oracle is asked too."""

SMALL = 1e-60
"""Size of a value above which a route reaches its digits in little time."""

EVERY = 4
"""Single precision is judged at every fourth point."""


def _anywhere(_: Point) -> bool:
    return True


@dataclass(frozen=True, eq=False)
class Judge:
    """What a paper's generated functions are compared with, and where.

    Parameters
    ----------
    routes
        Both references.
    grid
        The points of a function, from its name, its arguments' names and whether it is a sum.
    package
        Import name of the generated package.
    easy
        Whether the second reference takes little time at a point.
    inside
        Whether a point lies in the domain, which rounding to single precision may leave.
    hard
        The hard cases, if there are any. A function, so that what they need is loaded when they
        are asked for.
    """

    routes: Routes
    grid: Callable[[str, Sequence[str], bool], Sequence[Point]]
    package: str
    easy: Callable[[Point], bool] = _anywhere
    inside: Callable[[Point], bool] = _anywhere
    hard: Callable[[], Suite] | None = None


@dataclass(frozen=True)
class Row:
    """A kernel's result.

    Parameters
    ----------
    kernel, module
        Name and place.
    budget
        What is promised, in ULP; None for the formulas as printed.
    double
        Errors with double arguments.
    single
        Errors with single-precision arguments, in ULP of single precision;
        None for tables, which take none, and for the formulas as printed.
    oracles
        At how many points both oracles gave the same value.
    passed
        Whether the promise is kept; None if there is none.
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
    progress: Tell = quiet,
) -> tuple[Row, ...]:
    """Measure kernels against the truth.

    Parameters
    ----------
    by
        The references and the points.
    digits
        Decimal digits that the reference balls' radius warrants, at least 20.
    kernels
        What to measure; everything generated, and the formulas as printed, by
        default.
    progress
        Told about each kernel before it is measured.

    Raises
    ------
    OracleError
        If the two oracles contradict each other: then there is no truth to
        measure against.
    ValueError
        If fewer digits are asked than errors in double precision need.
    """
    if digits < 20:
        raise ValueError(f"a reference needs at least 20 digits to judge doubles, got {digits}")
    chosen = (
        (*generated_kernels(by.package), *printed_kernels(by.package))
        if kernels is None
        else tuple(kernels)
    )
    known: dict[str, list[Truth]] = {}
    rows = []
    for number, kernel in enumerate(chosen, start=1):
        progress(kernel.name, number, len(chosen))
        points = by.grid(kernel.name, kernel.arguments, kernel.modes)
        if kernel.name not in known:
            known[kernel.name] = truths(by.routes.balls, kernel.name, points, digits)
        rows.append(_row(by, kernel, points, known[kernel.name], digits))
    return tuple(rows)


def _row(
    by: Judge, kernel: Kernel, points: Sequence[Point], found: Sequence[Truth], digits: int
) -> Row:
    double = measured(kernel, found, len(points) - len(found))
    if kernel.budget is None:
        return Row(kernel.name, kernel.module, None, double, None, 0, None)
    single = None if kernel.by_count else _single(by, kernel, points, digits)
    passed = double.kept() and (single is None or single.kept(SINGLE))
    oracles = confirm(by, kernel, found, digits)
    return Row(kernel.name, kernel.module, kernel.budget, double, single, oracles, passed)


def truths(
    balls: Balls, name: str, points: Sequence[Point], digits: int, fmt: Format = DOUBLE
) -> list[Truth]:
    """References at the points whose value the format can hold."""
    found = ((p, balls.reference(name, p.values, digits, p.modes)) for p in points)
    return [Truth(point, (true,)) for point, true in found if not overflows(true.value, fmt)]


def _single(by: Judge, kernel: Kernel, points: Sequence[Point], digits: int) -> Errors:
    """Judge a kernel in single precision, at every fourth point it can hold."""
    singles = (single for p in points[::EVERY] if (single := to_single(p)) is not None)
    rounded = [single for single in singles if by.inside(single)]
    found = truths(by.routes.balls, kernel.name, rounded, digits, SINGLE)
    return measured(kernel, found, len(rounded) - len(found), SINGLE)


def confirm(by: Judge, kernel: Kernel, found: Sequence[Truth], digits: int) -> int:
    """Ask the second oracle too, where its routes are short; how many points were confirmed.

    Raises
    ------
    OracleError
        If it contradicts the first.
    """
    easy = [t for t in found if by.easy(t.point) and bool(abs(t.references[0].value) > SMALL)]
    chosen = easy[:: max(1, len(easy) // AGREEMENTS)][:AGREEMENTS]
    for truth in chosen:
        by.routes.agree(kernel.name, truth.point.values, digits, truth.point.modes)
    return len(chosen)
