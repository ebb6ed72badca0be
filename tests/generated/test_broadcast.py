"""Whichever argument is an array, its shape is the result's, whether or not the value needs it."""

from typing import Any

import numpy as np
import pytest

from derivation.plate.cases import suite as hard_suite

CASES = {case.kernel: case for case in hard_suite.cases() if case.expect == "value" and case.points}
LAST_AXIS = {"plate_coefficients"}
"""Kernels whose results lie along a last axis of their own."""


@pytest.mark.parametrize("name", sorted(CASES.keys() - LAST_AXIS))
def test_one_argument_alone_gives_its_shape(name: str) -> None:
    kernel, case = hard_suite.kernels()[name], CASES[name]
    if kernel.by_count:
        return
    point = case.points[0]
    modes: dict[str, Any] = {} if case.modes is None else {"modes": case.modes}
    with np.errstate(all="ignore"):
        alone = np.asarray(kernel.call(*(point[x] for x in kernel.arguments), **modes))
        for moved in kernel.arguments:
            given = [np.full(3, point[x]) if x == moved else point[x] for x in kernel.arguments]
            found = np.asarray(kernel.call(*given, **modes))
            assert found.shape == (*alone.shape, 3), moved
            np.testing.assert_allclose(found, np.stack([alone] * 3, -1), rtol=1e-12)
