"""Fixtures shared by all tests."""

from collections.abc import Mapping

import pytest

from derivation import pipeline
from derivation.formula.record import Formula


@pytest.fixture(scope="session")
def formulas() -> Mapping[str, Formula]:
    return pipeline.formulas()
