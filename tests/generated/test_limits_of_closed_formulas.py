"""Closed formulas return their limits if products of arguments overflow or underflow."""

import math

import numpy as np
import pytest

from derivation.plate.judge import generated_kernels

CLOSED = {kernel.name: kernel for kernel in generated_kernels()}


@pytest.mark.parametrize(
    "phi_h", [(1e-151, 1.0), (1e-75, 1e-75), (1e-300, 1e150), (1e154, 1e154), (1e300, 1e300)]
)
def test_overflow_and_underflow_of_products_give_the_limits(phi_h: tuple[float, float]) -> None:
    phi, h = phi_h
    thick = phi > 1.0
    with np.errstate(all="raise"):
        assert CLOSED["Omega_3_scaled"].call(phi, h, 1.0) == (-0.5 if thick else -0.125)
        assert CLOSED["Omega_4_scaled"].call(phi, h, 1.0) == (-0.5 if thick else -math.inf)
        assert CLOSED["Omega_1"].call(phi, h, 1.0, 1.0) == (0.0 if thick else math.inf)
        assert CLOSED["C_bottom"].call(phi, h, 1.0, 1.0) == (0.0 if thick else math.inf)
        assert CLOSED["C_top"].call(phi, h, 0.0, 1.0) == (1.0 / phi if thick else math.inf)


@pytest.mark.parametrize("T", [1e-151, 1e-120, 1e154, 1e300, 1.7e308])
def test_plate_factors_at_very_small_and_large_arguments(T: float) -> None:
    thick = T > 1.0
    with np.errstate(all="raise"):
        assert CLOSED["G"].call(T) == (1.0 if thick else math.inf)
        assert CLOSED["G_m"].call(T) == (0.0 if thick else math.inf)
        assert CLOSED["G_minus_1"].call(T) == (0.0 if thick else math.inf)
        assert CLOSED["G_slope"].call(T) == (0.0 if thick else -math.inf)
