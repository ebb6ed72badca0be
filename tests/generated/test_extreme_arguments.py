"""Inside their domain, functions of one mode have a value for arguments of any size."""

import importlib
from typing import Any

import numpy as np
import pytest

from generated import manifest

pytestmark = pytest.mark.usefixtures("no_warning")

COUNT = 20_000
WHOLE = ("bessel", "series_constants")  # modules whose functions take whole numbers
FUNCTIONS = [row for row in manifest.KERNELS if not row["modes"] and row["module"] not in WHOLE]
SUMS = [row for row in manifest.KERNELS if row["modes"]]


def arguments(row: dict[str, Any], largest: float, rng: np.random.Generator) -> dict[str, Any]:
    """Draw arguments of any size up to 10^largest, and of usual size for half of the numbers."""
    found = {}
    for name in row["arguments"]:
        size = np.where(rng.random(COUNT) < 0.5, largest, 3.0)
        found[name] = 10.0 ** (size * rng.uniform(-1.0, 1.0, COUNT))
        if name == "lam":
            found[name] *= rng.choice((-1.0, 1.0), COUNT)
    if "z" in found:
        found["z"] = found["h"] * rng.uniform(-1.0, 1.0, COUNT)
    if "r" in found:
        found["r"] = found.get("b", found["a"]) * rng.uniform(0.0, 1.0, COUNT)
    return found


def in_domain(row: dict[str, Any], given: dict[str, Any]) -> Any:
    """Return where the arguments meet the conditions that the docstring states."""
    with np.errstate(all="ignore"):
        parts = [eval(text, {"abs": np.abs, **given}) for text in row["domain"].split(", ")]
    return np.logical_and.reduce(parts)


@pytest.mark.parametrize("row", FUNCTIONS, ids=lambda row: row["name"])
def test_a_function_has_a_value_in_its_whole_domain(row: dict[str, Any]) -> None:
    given = arguments(row, 308.0, np.random.default_rng(1))
    function = getattr(importlib.import_module(f"generated.{row['module']}"), row["name"])
    inside = in_domain(row, given)
    assert inside.sum() > COUNT / 5
    assert not np.isnan(function(*given.values())[inside]).any()


@pytest.mark.parametrize("row", SUMS, ids=lambda row: row["name"])
def test_a_sum_has_a_value_in_its_whole_domain(row: dict[str, Any]) -> None:
    """Terms of opposite sign may overflow beyond lengths of 1e50 m."""
    given = arguments(row, 50.0, np.random.default_rng(2))
    given["a"] = np.minimum(given["b"], given["R"]) * np.random.default_rng(3).random(COUNT)
    function = getattr(importlib.import_module(f"generated.{row['module']}"), row["name"])
    inside = in_domain(row, given)
    assert inside.sum() > COUNT / 5
    assert not np.isnan(function(*given.values(), modes=2)[inside]).any()
