"""Generated functions at the limits of their input: signed zeros, masks, tiny products, units."""

import importlib
import math
import warnings
from random import Random
from typing import Any

import numpy as np
import pytest
from domains import EXAMPLE

from derivation.engine.measure.target import Target
from derivation.plate.grids import Point
from derivation.plate.search.draw import draw
from derivation.plate.search.targets import targets
from generated import contact_law
from generated.manifest import CONTACT, KERNELS

ROWS: dict[str, Any] = {
    row["name"]: row for row in (*KERNELS, *CONTACT) if "count" not in row["arguments"]
}
TINY = {
    name: row for name, row in ROWS.items() if "1e-151" in row["domain"] and not row.get("modes")
}

LENGTHS = {"h": 1, "b": 1, "a": 1, "R": 1, "r": 1, "z": 1, "delta": 1, "phi": -1}
STRESSES = {"mu", "lam", "A_j"}
WITH_UNITS = {
    target.name: target
    for target in targets()
    if set(target.domain.arguments) & LENGTHS.keys() and target.name != "impact"
}


def call(row: Any, values: Any) -> Any:
    function = getattr(importlib.import_module(f"generated.{row['module']}"), row["name"])
    extra = {"modes": 5} if row.get("modes") else {}
    return function(*(values[name] for name in row["arguments"]), **extra)


@pytest.mark.parametrize("row", ROWS.values(), ids=ROWS)
def test_sign_of_zero_has_no_effect(row: Any) -> None:
    for name in row["arguments"]:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            plus, minus = (call(row, EXAMPLE | {name: zero}) for zero in (0.0, -0.0))
        np.testing.assert_array_equal(plus, minus)


@pytest.mark.parametrize("row", ROWS.values(), ids=ROWS)
def test_masked_arrays_are_rejected(row: Any) -> None:
    """The functions do not propagate masks, so that masked values would become results."""
    for name in row["arguments"]:
        masked = np.ma.masked_array([EXAMPLE[name]] * 2, mask=[False, True])
        with pytest.raises(TypeError, match="without a mask"):
            call(row, EXAMPLE | {name: masked})


@pytest.mark.parametrize("row", TINY.values(), ids=TINY)
def test_products_below_the_tested_range_give_nan(row: Any) -> None:
    """No warning is issued; inside the tested range, up to its end, the result is a number."""
    for product, is_number in (
        (1.01e-151, True),
        (0.99e-151, False),
        (1e-200, False),
        (0.0, False),
    ):
        half = np.sqrt(product)
        values = EXAMPLE | {"T": product, "phi": half, "h": half, "z": 0.3 * half}
        if product == 0.0:  # the product underflows
            values |= {"phi": 1e-200, "h": 1e-200, "z": 0.0}
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            result = call(row, values)
        assert bool(np.isnan(result)) != is_number, (row["name"], product)


@pytest.mark.one_version
@pytest.mark.parametrize("target", WITH_UNITS.values(), ids=WITH_UNITS)
def test_results_are_within_the_budget_in_any_units(target: Target) -> None:
    """Finite results are within the budget; the unit of subnormal values is the smallest double."""
    generator = Random(f"units of {target.name}")
    for _ in range(8 if target.domain.modes or target.every > 1 or target.turn_size < 48 else 24):
        point = draw(target.domain, generator)
        length, stress, force = (generator.randint(-n, n) for n in (500, 500, 900))
        powers = {name: power * length for name, power in LENGTHS.items()}
        powers |= dict.fromkeys(STRESSES, stress) | {"P": force}
        values = {name: _scaled(value, powers.get(name, 0)) for name, value in point.values.items()}
        scaled = Point(values, point.modes)
        with np.errstate(all="ignore"):
            (result,) = target.call([scaled])[0]
        if math.isfinite(result) and target.domain.holds(scaled):
            error = target.measure(scaled, (result,))
            assert error is None or error.ratio <= 1.0, (scaled, result)


def _scaled(value: float, power: int) -> float:
    """Return the value times a power of two; infinite if it overflows."""
    try:
        return math.ldexp(value, power)
    except OverflowError:
        return math.inf


def test_enough_functions_are_tested() -> None:
    assert len(TINY) >= 20
    assert len(WITH_UNITS) >= 30
    assert contact_law.contact_radius(-0.0, 0.1, 0.01, 1.0) == 0.0


SUMS = ("delta", "u", "w", "sigma_rr", "sigma_tt", "sigma_zz", "sigma_rz")


@pytest.mark.parametrize("name", SUMS)
@pytest.mark.parametrize("power", [-530, -300, 300, 500])
def test_scaling_of_lengths_by_a_power_of_two_is_exact(name: str, power: int) -> None:
    """Intermediate values neither overflow nor underflow if the result does not."""
    values = EXAMPLE | {"lam": 3.6e5, "mu": 4.3e5}
    scaled = {n: math.ldexp(x, power * LENGTHS.get(n, 0)) for n, x in values.items()}
    displacement = power if name in ("delta", "u", "w") else 0
    result, expected = call(ROWS[name], scaled), call(ROWS[name], values)
    np.testing.assert_array_equal(result, np.ldexp(expected, displacement))
