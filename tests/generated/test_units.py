"""Closed formulas in other units of length and stress: the same digits, whatever stands between."""

import itertools
import math
import sys

import numpy as np
import pytest

from derivation.plate.grids import grid
from derivation.plate.judge import generated_kernels
from derivation.plate.vocabulary import BY_NAME
from generated.manifest import KERNELS

POWERS = {
    "1": (0, 0), "m": (1, 0), "m^2": (2, 0), "1/m": (-1, 0),
    "Pa": (0, 1), "1/Pa": (0, -1), "m/Pa": (1, -1), "N": (2, 1),
}  # fmt: skip
"""What powers of a length and of a stress a unit is."""

UNIT_OF = {row["name"]: str(row["unit"]) for row in KERNELS}
CLOSED = {
    kernel.name: kernel
    for kernel in generated_kernels()
    if kernel.call.__module__ in ("generated.omega", "generated.influence", "generated.pressure")
}
SAFE = (sys.float_info.min * 2**60, sys.float_info.max / 2**60)


def representable(*values: float) -> bool:
    return all(value == 0.0 or SAFE[0] < abs(value) < SAFE[1] for value in values)


def test_all_closed_formulas_are_here() -> None:
    assert len(CLOSED) == 20


@pytest.mark.parametrize("name", sorted(CLOSED))
def test_digits_do_not_depend_on_units(name: str) -> None:
    kernel, compared = CLOSED[name], 0
    for point, *bits in itertools.product(
        grid(name, kernel.arguments)[::5], (-400, 0, 400), (-400, 0, 400)
    ):

        def shift(unit: str, bits: list[int] = bits) -> int:
            return sum(power * bit for power, bit in zip(POWERS[unit], bits, strict=True))

        plain = [point.values[key] for key in kernel.arguments]
        value = float(kernel.call(*plain))
        try:
            scaled = [
                math.ldexp(x, shift(BY_NAME[key].unit))
                for key, x in zip(kernel.arguments, plain, strict=True)
            ]
            expected = math.ldexp(value, shift(UNIT_OF[name]))
        except OverflowError:
            continue
        vanished = any(new == 0.0 != old for new, old in zip(scaled, plain, strict=True))
        if vanished or not representable(value, expected, *scaled):
            continue
        with np.errstate(all="raise"):
            assert float(kernel.call(*scaled)) == expected, (point.values, bits)
        compared += 1
    assert compared > 60


@pytest.mark.parametrize(
    "phi_h", [(1e-151, 1.0), (1e-75, 1e-75), (1e-300, 1e150), (1e154, 1e154), (1e300, 1e300)]
)
def test_products_beyond_the_doubles_give_the_limits(phi_h: tuple[float, float]) -> None:
    phi, h = phi_h
    thick = phi > 1.0
    with np.errstate(all="raise"):
        assert CLOSED["Omega_3_scaled"].call(phi, h, 1.0) == (-0.5 if thick else -0.125)
        assert CLOSED["Omega_4_scaled"].call(phi, h, 1.0) == (-0.5 if thick else -math.inf)
        assert CLOSED["Omega_1"].call(phi, h, 1.0, 1.0) == (0.0 if thick else math.inf)
        assert CLOSED["C_bottom"].call(phi, h, 1.0, 1.0) == (0.0 if thick else math.inf)
        assert CLOSED["C_top"].call(phi, h, 0.0, 1.0) == (1.0 / phi if thick else math.inf)


@pytest.mark.parametrize("T", [1e-151, 1e-120, 1e154, 1e300, 1.7e308])
def test_plate_factors_at_the_ends_of_the_doubles(T: float) -> None:
    thick = T > 1.0
    with np.errstate(all="raise"):
        assert CLOSED["G"].call(T) == (1.0 if thick else math.inf)
        assert CLOSED["G_m"].call(T) == (0.0 if thick else math.inf)
        assert CLOSED["G_minus_1"].call(T) == (0.0 if thick else math.inf)
        assert CLOSED["G_slope"].call(T) == (0.0 if thick else -math.inf)
