"""Generated functions at the ends of what they take: no sign of zero, no mask, no tiny products."""

import importlib
import math
import warnings
from random import Random
from typing import Any

import numpy as np
import pytest
from given import EXAMPLE

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
def test_zero_has_no_sign(row: Any) -> None:
    for name in row["arguments"]:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            plus, minus = (call(row, EXAMPLE | {name: zero}) for zero in (0.0, -0.0))
        np.testing.assert_array_equal(plus, minus)


@pytest.mark.parametrize("row", ROWS.values(), ids=ROWS)
def test_masked_arrays_are_refused(row: Any) -> None:
    """A mask is lost on the way: what comes back would be numbers in its place."""
    for name in row["arguments"]:
        masked = np.ma.masked_array([EXAMPLE[name]] * 2, mask=[False, True])
        with pytest.raises(TypeError, match="without a mask"):
            call(row, EXAMPLE | {name: masked})


@pytest.mark.parametrize("row", TINY.values(), ids=TINY)
def test_products_below_the_tested_range_give_nan(row: Any) -> None:
    """In silence; inside it there is a number, and at its end too."""
    for product, there in ((1.01e-151, True), (0.99e-151, False), (1e-200, False), (0.0, False)):
        half = np.sqrt(product)
        values = EXAMPLE | {"T": product, "phi": half, "h": half, "z": 0.3 * half}
        if product == 0.0:  # by underflow alone
            values |= {"phi": 1e-200, "h": 1e-200, "z": 0.0}
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            found = call(row, values)
        assert bool(np.isnan(found)) != there, (row["name"], product)


@pytest.mark.parametrize("target", WITH_UNITS.values(), ids=WITH_UNITS)
def test_no_choice_of_units_gives_a_wrong_number(target: Target) -> None:
    """Where the value is subnormal the allowance counts in the smallest number there is."""
    generator = Random(f"units of {target.name}")
    for _ in range(8 if target.domain.modes or target.every > 1 or target.share < 48 else 24):
        point = draw(target.domain, generator)
        length, stress, force = (generator.randint(-n, n) for n in (500, 500, 900))
        powers = {name: power * length for name, power in LENGTHS.items()}
        powers |= dict.fromkeys(STRESSES, stress) | {"P": force}
        values = {name: _scaled(value, powers.get(name, 0)) for name, value in point.values.items()}
        there = Point(values, point.modes)
        with np.errstate(all="ignore"):
            (found,) = target.call([there])[0]
        if math.isfinite(found) and target.domain.holds(there):
            error = target.measure(there, (found,))
            assert error is None or error.ratio <= 1.0, (there, found)


def _scaled(value: float, power: int) -> float:
    """The value times a power of two; infinite beyond the doubles."""
    try:
        return math.ldexp(value, power)
    except OverflowError:
        return math.inf


def test_there_are_such_functions() -> None:
    assert len(TINY) >= 20
    assert len(WITH_UNITS) >= 30
    assert contact_law.contact_radius(-0.0, 0.1, 0.01, 1.0) == 0.0


SUMS = ("delta", "u", "w", "sigma_rr", "sigma_tt", "sigma_zz", "sigma_rz")


@pytest.mark.parametrize("name", SUMS)
@pytest.mark.parametrize("power", [-530, -300, 300, 500])
def test_a_power_of_two_as_unit_of_length_changes_no_bit(name: str, power: int) -> None:
    """Intermediate results leave the normal numbers no earlier than the result does."""
    values = EXAMPLE | {"lam": 3.6e5, "mu": 4.3e5}
    there = {n: math.ldexp(x, power * LENGTHS.get(n, 0)) for n, x in values.items()}
    displacement = power if name in ("delta", "u", "w") else 0
    found, expected = call(ROWS[name], there), call(ROWS[name], values)
    np.testing.assert_array_equal(found, np.ldexp(expected, displacement))
