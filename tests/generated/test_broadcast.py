"""The result has the shape of an array argument, even if the value does not depend on it."""

from typing import Any

import numpy as np
import pytest

from derivation.plate.cases import suite as hard_suite

CASES = {case.kernel: case for case in hard_suite.cases() if case.expect == "value" and case.points}
LAST_AXIS = {"plate_coefficients"}
"""Functions whose results have an additional last axis."""


@pytest.mark.parametrize("name", sorted(CASES.keys() - LAST_AXIS))
def test_result_has_the_shape_of_a_single_array_argument(name: str) -> None:
    kernel, case = hard_suite.kernels()[name], CASES[name]
    if kernel.by_count:
        return
    point = case.points[0]
    modes: dict[str, Any] = {} if case.modes is None else {"modes": case.modes}
    with np.errstate(all="ignore"):
        alone = np.asarray(kernel.call(*(point[x] for x in kernel.arguments), **modes))
        for argument in kernel.arguments:
            given = [np.full(3, point[x]) if x == argument else point[x] for x in kernel.arguments]
            actual = np.asarray(kernel.call(*given, **modes))
            assert actual.shape == (*alone.shape, 3), argument
            np.testing.assert_allclose(actual, np.stack([alone] * 3, -1), rtol=1e-12)
