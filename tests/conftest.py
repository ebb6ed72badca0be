"""Fixtures that several test files share."""

import json
import warnings
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import settings

from derivation.plate import derived
from derivation.plate.vocabulary import Formula

if TYPE_CHECKING:  # they load the generated package, without which its own tests have to run
    from derivation.engine.measure.case import HardCase
    from derivation.engine.measure.suite import Known, Suite

# The same draws in every run, however slow; `pytest --hypothesis-profile default` draws others.
settings.register_profile("same", derandomize=True, deadline=None, database=None)
settings.load_profile("same")


@pytest.fixture(scope="session")
def formulas() -> Mapping[str, Formula]:
    return derived.formulas()


@pytest.fixture
def no_warning() -> Iterator[None]:
    """No warning is given."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


@pytest.fixture
def silent(no_warning: None) -> Iterator[None]:  # noqa: ARG001
    """Nor does any step of NumPy's overflow, underflow or have no value."""
    with np.errstate(all="raise"):
        yield


@pytest.fixture(scope="session")
def suite() -> "Suite":
    """The hard cases with all that they are compared with."""
    from derivation.plate.cases.suite import suite

    return suite()


@pytest.fixture(scope="session")
def cases(suite: "Suite") -> "tuple[HardCase, ...]":
    """The hard cases."""
    return suite.cases


@pytest.fixture(scope="session")
def references(cases: "tuple[HardCase, ...]") -> "dict[str, Known]":
    """Their references, as recorded."""
    from derivation.engine.measure import hard
    from derivation.plate.paper import PAPER

    return hard.committed(json.loads(PAPER.hard.read_text()), cases)
