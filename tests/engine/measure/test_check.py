"""The check itself: everything generated keeps its promise."""

import numpy as np

import generated
from derivation.plate.judge import check
from generated.manifest import KERNELS


def test_every_stated_limit_is_kept() -> None:
    rows = check(30)
    assert not [row.kernel for row in rows if row.passed is False]
    assert {row.kernel for row in rows if row.passed} == {row["name"] for row in KERNELS}


def test_pressure_ends_at_the_rim() -> None:
    assert generated.p(0.1, 0.1, 5.0) == 0
    assert np.isnan(generated.p(np.nextafter(0.1, 1), 0.1, 5.0))
