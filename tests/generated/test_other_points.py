"""The result of a point is the same to the last bit whatever other points an array contains."""

import importlib

import numpy as np
import pytest
from domains import EXAMPLE, POINTWISE, ROWS

COUNT, CHECKED = 400, 60
WHOLE = {"n", "k"}
OWN_POLYNOMIALS = {"indentation", "contact_radius", "force"}
"""Functions that use another polynomial, with other rounding, for one sphere on one plate."""
SLOW = {"force_by_series"}
NAMES = [
    name
    for name in POINTWISE
    if name not in OWN_POLYNOMIALS | SLOW and set(ROWS[name]["arguments"]) <= EXAMPLE.keys()
]


@pytest.mark.parametrize("name", NAMES)
def test_result_of_a_point_does_not_depend_on_the_others(name: str) -> None:
    chance, row = np.random.default_rng(1), ROWS[name]
    given = [
        np.full(COUNT, EXAMPLE[key]) if key in WHOLE
        else EXAMPLE[key] * 10 ** chance.uniform(-0.7, 0.7, COUNT)
        for key in row["arguments"]
    ]  # fmt: skip
    function = getattr(importlib.import_module(f"generated.{row['module']}"), name)
    modes = {"modes": 50} if row.get("modes") else {}
    with np.errstate(all="ignore"):
        whole = np.asarray(function(*given, **modes))
        assert np.isfinite(whole).any()
        points = whole.shape.index(COUNT)  # some results have more axes
        for point in chance.integers(0, COUNT, CHECKED):
            alone = np.asarray(function(*(values[[point]] for values in given), **modes))
            np.testing.assert_array_equal(alone.take(0, points), whole.take(point, points))
