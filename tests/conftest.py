"""Fixtures shared by all tests."""

from collections.abc import Mapping

import pytest

from derivation import derived
from derivation.formula.record import Formula


@pytest.fixture(scope="session")
def formulas() -> Mapping[str, Formula]:
    return derived.formulas()
