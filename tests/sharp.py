"""What a function must give to some units in the last place, whichever module it is from."""

from collections.abc import Callable, Sequence
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np


class Sharp(NamedTuple):
    """What a function gives: values of the type and shape here, within so many of their ULP."""

    call: Callable[[ModuleType], Any]
    true: np.ndarray
    ulp: float

    def holds(self, module: ModuleType) -> bool:
        found = np.asarray(self.call(module))
        if found.shape != self.true.shape or found.dtype != self.true.dtype:
            return False
        with np.errstate(all="ignore"):
            close = np.abs(found - self.true) <= self.ulp * np.spacing(np.abs(self.true))
        return bool((close | (found == self.true) | (np.isnan(found) & np.isnan(self.true))).all())


def expected(
    name: str, points: Sequence[tuple[float, ...]], true: Sequence[Any], ulp: float
) -> list[Sharp]:
    """All points at once, in single precision too, and every one as a scalar."""
    values = np.array([[float(x) for x in np.atleast_1d(row)] for row in true])
    values = values[:, 0] if values.shape[1] == 1 else values.T
    columns = [np.array(column, dtype=float) for column in zip(*points, strict=True)]
    found = [Sharp(lambda m: getattr(m, name)(*columns), values, ulp)]
    for index, point in enumerate(points):
        one = np.float64(values[..., index])
        found.append(Sharp(lambda m, point=point: getattr(m, name)(*point), one, ulp))
    return found
