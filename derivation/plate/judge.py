"""References and test points for the plate's generated functions."""

from functools import partial
from typing import TYPE_CHECKING

from derivation.engine.measure import check as general
from derivation.engine.measure import kernels
from derivation.engine.measure.point import Point
from derivation.plate import oracle as balls
from derivation.plate.grids import grid
from derivation.plate.modes.route import routes

if TYPE_CHECKING:
    from derivation.engine.measure.suite import Suite


def _is_easy(point: Point) -> bool:
    """Return whether the second reference is fast: moderate x and y, low indices."""
    values = point.values
    x = values.get("T", values.get("phi", 1.0) * values.get("h", 1.0))
    y = values.get("phi", 1.0) * values.get("a", 1.0)
    low = all(values.get(index, 1) <= 1000 for index in ("count", "n", "k"))
    return 1e-8 < x < 50 and 1e-30 < y < 50 and low and (point.modes or 1) <= 3


def _hard() -> "Suite":
    from derivation.plate.cases.suite import suite

    return suite()


PACKAGE = "generated"
JUDGE = general.Judge(routes.ORACLE, grid, PACKAGE, _is_easy, hard=_hard)
check = partial(general.check, JUDGE)
reference_values = partial(general.reference_values, balls.ORACLE)
generated_kernels = partial(kernels.generated_kernels, PACKAGE)
printed_kernels = partial(kernels.printed_kernels, PACKAGE)
kernel_of_row = partial(kernels.kernel_of_row, PACKAGE)
