"""The check: every kernel against its truth on its hard points, one row each."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from derivation.formula.ulp import DOUBLE, SINGLE
from derivation.measure.grids import Point, grid
from derivation.measure.judge import Errors, Truth, judge, to_single, truths
from derivation.measure.kernels import Kernel, generated_kernels, printed_kernels
from derivation.reference.routes import agree

Progress = Callable[[str, int, int], None]
"""Called with a kernel's name, its number and how many there are, before it is measured."""

AGREEMENTS = 2
"""Points per kernel at which the second oracle is asked too."""

EVERY = 4
"""Single precision is judged at every fourth point."""


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
    digits: int = 50,
    kernels: Sequence[Kernel] | None = None,
    progress: Progress | None = None,
) -> tuple[Row, ...]:
    """Measure kernels against the truth.

    Parameters
    ----------
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
    chosen = (*generated_kernels(), *printed_kernels()) if kernels is None else tuple(kernels)
    known: dict[str, list[Truth]] = {}
    rows = []
    for number, kernel in enumerate(chosen, start=1):
        if progress is not None:
            progress(kernel.name, number, len(chosen))
        points = grid(kernel.name, kernel.arguments, kernel.modes)
        if kernel.name not in known:
            known[kernel.name] = truths(kernel.name, points, digits)
        rows.append(_row(kernel, points, known[kernel.name], digits))
    return tuple(rows)


def _row(kernel: Kernel, points: Sequence[Point], found: Sequence[Truth], digits: int) -> Row:
    double = judge(kernel, found, len(points) - len(found), DOUBLE)
    if kernel.budget is None:
        return Row(kernel.name, kernel.module, None, double, None, 0, None)
    single = None if kernel.by_count else judge_single(kernel, points, digits)
    passed = _kept(double, DOUBLE.name) and (single is None or _kept(single, SINGLE.name))
    oracles = confirm(kernel, found, digits)
    return Row(kernel.name, kernel.module, kernel.budget, double, single, oracles, passed)


def _kept(errors: Errors, dtype: str) -> bool:
    """Whether every result is finite, within its allowance, of the right type and silent."""
    within = errors.ratio is not None and errors.ratio <= 1.0
    return within and errors.not_finite == 0 and errors.dtype == dtype and not errors.warned


def judge_single(kernel: Kernel, points: Sequence[Point], digits: int) -> Errors:
    """Hold a kernel to the truth in single precision, at every fourth point it can hold."""
    rounded = [single for p in points[::EVERY] if (single := to_single(p)) is not None]
    found = truths(kernel.name, rounded, digits, SINGLE)
    return judge(kernel, found, len(rounded) - len(found), SINGLE)


def confirm(kernel: Kernel, found: Sequence[Truth], digits: int) -> int:
    """Ask the second oracle too, where its routes are short; how many points were confirmed.

    Raises
    ------
    OracleError
        If it contradicts the first.
    """
    easy = [t for t in found if _is_easy(t)]
    chosen = easy[:: max(1, len(easy) // AGREEMENTS)][:AGREEMENTS]
    for truth in chosen:
        agree(kernel.name, truth.point.values, digits, truth.point.modes)
    return len(chosen)


def _is_easy(truth: Truth) -> bool:
    """Whether neither quadrature nor cancellation takes long: a moderate value, x and y."""
    values = truth.point.values
    size = abs(truth.reference.value)
    x = values.get("T", values.get("phi", 1.0) * values.get("h", 1.0))
    y = values.get("phi", 1.0) * values.get("a", 1.0)
    return (
        1e-8 < x < 50
        and 1e-30 < y < 50
        and all(values.get(index, 1) <= 1000 for index in ("count", "n", "k"))
        and (truth.point.modes or 1) <= 3
        and bool(size > 1e-60)
    )
