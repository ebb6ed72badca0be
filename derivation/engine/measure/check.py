"""The check: every kernel against its truth on its hard points, one row each."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from derivation.engine.formula.ulp import DOUBLE, SINGLE
from derivation.engine.measure.evaluate import Errors, Truth, judge, to_single, truths
from derivation.engine.measure.kernels import Kernel, generated_kernels, printed_kernels
from derivation.engine.measure.point import Point
from derivation.engine.oracle.agreement import Routes

Progress = Callable[[str, int, int], None]
"""Called with a kernel's name, its number and how many there are, before it is measured."""

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
    """

    routes: Routes
    grid: Callable[[str, Sequence[str], bool], Sequence[Point]]
    package: str
    easy: Callable[[Point], bool] = _anywhere
    inside: Callable[[Point], bool] = _anywhere


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
    progress: Progress | None = None,
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
        if progress is not None:
            progress(kernel.name, number, len(chosen))
        points = by.grid(kernel.name, kernel.arguments, kernel.modes)
        if kernel.name not in known:
            known[kernel.name] = truths(by.routes.balls, kernel.name, points, digits)
        rows.append(_row(by, kernel, points, known[kernel.name], digits))
    return tuple(rows)


def _row(
    by: Judge, kernel: Kernel, points: Sequence[Point], found: Sequence[Truth], digits: int
) -> Row:
    double = judge(kernel, found, len(points) - len(found), DOUBLE)
    if kernel.budget is None:
        return Row(kernel.name, kernel.module, None, double, None, 0, None)
    single = None if kernel.by_count else judge_single(by, kernel, points, digits)
    passed = _kept(double, DOUBLE.name) and (single is None or _kept(single, SINGLE.name))
    oracles = confirm(by, kernel, found, digits)
    return Row(kernel.name, kernel.module, kernel.budget, double, single, oracles, passed)


def _kept(errors: Errors, dtype: str) -> bool:
    """Whether every result is finite, within its allowance, of the right type and silent."""
    within = errors.ratio is not None and errors.ratio <= 1.0
    return within and errors.not_finite == 0 and errors.dtype == dtype and not errors.warned


def judge_single(by: Judge, kernel: Kernel, points: Sequence[Point], digits: int) -> Errors:
    """Hold a kernel to the truth in single precision, at every fourth point it can hold."""
    singles = (single for p in points[::EVERY] if (single := to_single(p)) is not None)
    rounded = [single for single in singles if by.inside(single)]
    found = truths(by.routes.balls, kernel.name, rounded, digits, SINGLE)
    return judge(kernel, found, len(rounded) - len(found), SINGLE)


def confirm(by: Judge, kernel: Kernel, found: Sequence[Truth], digits: int) -> int:
    """Ask the second oracle too, where its routes are short; how many points were confirmed.

    Raises
    ------
    OracleError
        If it contradicts the first.
    """
    easy = [t for t in found if by.easy(t.point) and bool(abs(t.reference.value) > SMALL)]
    chosen = easy[:: max(1, len(easy) // AGREEMENTS)][:AGREEMENTS]
    for truth in chosen:
        by.routes.agree(kernel.name, truth.point.values, digits, truth.point.modes)
    return len(chosen)
