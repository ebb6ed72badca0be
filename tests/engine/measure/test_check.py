"""Every generated function is within its error budget; the contact pressure ends at r = a."""

import numpy as np

import generated
from derivation.plate.judge import check
from generated.manifest import KERNELS


def test_every_function_is_within_its_budget() -> None:
    rows = check(30)
    assert not [row.kernel for row in rows if row.passed is False]
    assert {row.kernel for row in rows if row.passed} == {row["name"] for row in KERNELS}


def test_pressure_is_defined_up_to_the_contact_radius() -> None:
    assert generated.p(0.1, 0.1, 5.0) == 0
    assert np.isnan(generated.p(np.nextafter(0.1, 1), 0.1, 5.0))
