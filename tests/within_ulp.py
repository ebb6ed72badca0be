"""Expected values of a function within some ULP, for several versions of its module."""

from collections.abc import Callable, Sequence
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np


class WithinUlp(NamedTuple):
    """A call, the expected values with type and shape, and the allowed error in ULP."""

    call: Callable[[ModuleType], Any]
    expected: np.ndarray
    ulp: float

    def accepts(self, module: ModuleType) -> bool:
        actual = np.asarray(self.call(module))
        if actual.shape != self.expected.shape or actual.dtype != self.expected.dtype:
            return False
        with np.errstate(all="ignore"):
            close = np.abs(actual - self.expected) <= self.ulp * np.spacing(np.abs(self.expected))
        return bool(
            (close | (actual == self.expected) | (np.isnan(actual) & np.isnan(self.expected))).all()
        )


def expected(
    name: str, points: Sequence[tuple[float, ...]], exact: Sequence[Any], ulp: float
) -> list[WithinUlp]:
    """Return tests of a function at all points in one array, and at each point as scalars."""
    values = np.array([[float(x) for x in np.atleast_1d(row)] for row in exact])
    values = values[:, 0] if values.shape[1] == 1 else values.T
    columns = [np.array(column, dtype=float) for column in zip(*points, strict=True)]
    actual = [WithinUlp(lambda m: getattr(m, name)(*columns), values, ulp)]
    for index, point in enumerate(points):
        one = np.float64(values[..., index])
        actual.append(WithinUlp(lambda m, point=point: getattr(m, name)(*point), one, ulp))
    return actual
