"""The result has the shape of an array argument, even if the value does not depend on it."""

import json
from typing import Any

import numpy as np
import pytest

from derivation.engine.measure.suite import Suite
from derivation.plate.paper import PAPER

LAST_AXIS = {"plate_coefficients"}
"""Functions whose results have an additional last axis."""
# The names are read from the record because each process that collects tests would otherwise create
# the cases, which takes 15 seconds.
RECORDED = json.loads(PAPER.hard.read_text())["cases"]
WITH_VALUE = {x["kernel"] for x in RECORDED if x["expect"] == "value" and x["form"] != "empty"}


@pytest.mark.parametrize("name", sorted(WITH_VALUE - LAST_AXIS))
def test_result_has_the_shape_of_a_single_array_argument(name: str, suite: Suite) -> None:
    """The point is from the last hard case in which the function has a value."""
    kernel = suite.kernels[name]
    if kernel.by_count:
        return
    usable = [x for x in suite.cases if (x.kernel, x.expect) == (name, "value") and x.points]
    case = usable[-1]
    point = case.points[0]
    modes: dict[str, Any] = {} if case.modes is None else {"modes": case.modes}
    with np.errstate(all="ignore"):
        alone = np.asarray(kernel.call(*(point[x] for x in kernel.arguments), **modes))
        for argument in kernel.arguments:
            given = [np.full(3, point[x]) if x == argument else point[x] for x in kernel.arguments]
            actual = np.asarray(kernel.call(*given, **modes))
            assert actual.shape == (*alone.shape, 3), argument
            np.testing.assert_allclose(actual, np.stack([alone] * 3, -1), rtol=1e-12)
