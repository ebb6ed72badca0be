"""Inside their domain, generated functions have a value for arguments of any size."""

import importlib
from typing import Any

import numpy as np
import pytest

import generated
from generated import manifest

pytestmark = [pytest.mark.usefixtures("no_warning"), pytest.mark.one_version]

COUNT = 20_000
WHOLE = ("bessel", "series_constants")  # modules whose functions take whole numbers
FUNCTIONS = [row for row in manifest.KERNELS if not row["modes"] and row["module"] not in WHOLE]
OF_RESULTS = ("that result", "the largest a", "radius of convergence")  # in conditions of domains
LAWS = [
    row
    for row in manifest.CONTACT
    if row["name"] != "plate_coefficients"  # returns polynomials
    and not any(text in row["domain"] for text in OF_RESULTS)
]
SUMS = [row for row in manifest.KERNELS if row["modes"]]


def arguments(row: dict[str, Any], largest: float, rng: np.random.Generator) -> dict[str, Any]:
    """Draw arguments of any size up to 10^largest, and of usual size for half of the numbers."""
    actual = {}
    for name in row["arguments"]:
        size = np.where(rng.random(COUNT) < 0.5, largest, 3.0)
        actual[name] = 10.0 ** (size * rng.uniform(-1.0, 1.0, COUNT))
    if "lam" in actual:
        actual["lam"] *= rng.choice((-1.0, 1.0), COUNT)
    if "nu" in actual:
        actual["nu"] = rng.uniform(-1.0, 0.5, COUNT)
    for name in {"a_over_R", "alpha", "xi_y"} & set(actual):  # up to 1, or from 1 to 1e50
        power = np.log10(actual[name]) / largest
        actual[name] = 10.0 ** (50.0 * abs(power) if name == "xi_y" else -largest * abs(power))
    for name, limits in {"z": "h", "a": "bR", "r": "a" if "P" in actual else "b"}.items():
        below = [actual[limit] for limit in limits if limit in actual]
        if name in actual and below:
            lowest = -1.0 if name == "z" else 0.0
            actual[name] = np.minimum.reduce(below) * rng.uniform(lowest, 1.0, COUNT)
    return actual


def in_domain(row: dict[str, Any], given: dict[str, Any]) -> Any:
    """Return where the arguments meet the conditions that the docstring states."""
    with np.errstate(all="ignore"):
        return np.logical_and.reduce(
            [
                np.logical_or.reduce([eval(part, {"abs": np.abs, **given}) for part in either])
                for either in (text.split(" or ") for text in row["domain"].split(", "))
            ]
        )


@pytest.mark.parametrize("row", [*FUNCTIONS, *LAWS], ids=lambda row: row["name"])
def test_a_function_has_a_value_in_its_whole_domain(row: dict[str, Any]) -> None:
    given = arguments(row, 307.0, np.random.default_rng(1))
    function = getattr(importlib.import_module(f"generated.{row['module']}"), row["name"])
    inside = in_domain(row, given)
    assert inside.sum() > COUNT / 5
    actual = function(*given.values())
    for values in actual if isinstance(actual, tuple) else (actual,):
        assert not np.isnan(values[inside]).any()


@pytest.mark.parametrize("row", SUMS, ids=lambda row: row["name"])
def test_a_sum_has_a_value_in_its_whole_domain(row: dict[str, Any]) -> None:
    """Terms of opposite sign may overflow beyond lengths of 1e50 m."""
    given = arguments(row, 50.0, np.random.default_rng(2))
    function = getattr(importlib.import_module(f"generated.{row['module']}"), row["name"])
    inside = in_domain(row, given)
    assert inside.sum() > COUNT / 5
    assert not np.isnan(function(*given.values(), modes=2)[inside]).any()


@pytest.mark.parametrize("name", ["Omega_1", "Omega_2"])
def test_constants_of_a_plate_of_the_largest_thickness_tend_to_those_of_a_half_space(
    name: str,
) -> None:
    """e^(phi h) Omega tends to h/(2 mu) for phi h >> 1, and Omega itself to 0."""
    h, mu = 1.7e308, 2.0
    given = 1.0, h, 1.0, mu  # phi, h, lam, mu
    scaled = getattr(generated, f"{name}_scaled")
    assert getattr(generated, name)(*given) == 0.0
    assert scaled(*given) == pytest.approx(h / (2.0 * mu), rel=1e-15)
