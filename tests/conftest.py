"""Fixtures that several test files share."""

import gc
import json
import os
import signal
import sys
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import settings

from derivation.engine.threads import one_thread
from derivation.plate import derived
from derivation.plate.vocabulary import Formula

if TYPE_CHECKING:  # these modules import the generated package, which may be missing in a test
    from derivation.engine.measure.case import HardCase
    from derivation.engine.measure.suite import Known, Suite

# Write compiled modules, even if the environment disables this: the tests start hundreds of
# processes, and each would compile its imports again.
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# Processes that a shell starts in the background ignore Ctrl-C. Commands that tests interrupt would
# inherit this.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# Libraries that are loaded later, and processes, multiply matrices in one thread. Otherwise the
# threads of two test processes on two cores wait for each other, which takes several times as long.
os.environ.update(dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1"))

# Matplotlib looks for all fonts again, which takes seconds, if it has no cache: tests with an own
# folder for cached results would have none.
_CACHE = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
os.environ.setdefault("MPLCONFIGDIR", str(_CACHE / "matplotlib"))

# SymPy creates many small objects that are not deleted. With the default threshold of 700, garbage
# collection takes a sixth of the time of tests with formulas.
gc.set_threshold(50_000, 20, 20)

# Use the same examples in every run; `pytest --hypothesis-profile default` uses random ones.
settings.register_profile("same", derandomize=True, deadline=None, database=None)
settings.load_profile("same")


@pytest.fixture(scope="session", autouse=True)
def _one_thread() -> Iterator[None]:
    """Multiply matrices in one thread also in libraries that are already loaded."""
    with one_thread():
        yield


@pytest.fixture(scope="session")
def formulas() -> Mapping[str, Formula]:
    return derived.formulas()


@pytest.fixture
def no_warning() -> Iterator[None]:
    """Turn warnings into errors."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


@pytest.fixture
def silent(no_warning: None) -> Iterator[None]:  # noqa: ARG001
    """Turn warnings and all floating-point exceptions of NumPy into errors."""
    with np.errstate(all="raise"):
        yield


@pytest.fixture(scope="session")
def suite() -> "Suite":
    """Return the hard cases with their functions and references."""
    from derivation.plate.cases.suite import suite

    return suite()


@pytest.fixture(scope="session")
def cases(suite: "Suite") -> "tuple[HardCase, ...]":
    """Return the hard cases."""
    return suite.cases


@pytest.fixture(scope="session")
def references(cases: "tuple[HardCase, ...]") -> "dict[str, Known]":
    """Return the recorded reference values of the hard cases, by key."""
    from derivation.engine.measure import hard
    from derivation.plate.paper import PAPER

    return hard.committed_references(json.loads(PAPER.hard.read_text()), cases)
