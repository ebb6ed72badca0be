"""Scales of an impact: on a half-space, Zener's parameter, the volume of the sphere."""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from derivation.scene import kernels
from derivation.scene.numerics import columns

if TYPE_CHECKING:
    from derivation.scene.model import Model


def hertz_constant(model: "Model", modulus: float | None = None) -> float:
    """Return K = (4/3) E* sqrt(R), the force over the indentation to the power 3/2 [N/m^(3/2)].

    Parameters
    ----------
    modulus
        E* [Pa]; by default that of plate and sphere.
    """
    of_both = model.modulus / (1.0 + model.softness) if modulus is None else modulus
    return evaluated(kernels.hertz_constant, model.R, of_both)


def time_unit(model: "Model", modulus: float | None = None) -> float:
    """Return T [s], T^5 = m^2/(K^2 v0); K as in `hertz_constant`."""
    K = hertz_constant(model, modulus)
    return evaluated(kernels.zener_time_unit, model.m, model.v0, K)


def largest_depth(model: "Model", modulus: float | None = None) -> float:
    """Return the largest indentation [m] without gravity; K as in `hertz_constant`."""
    K = hertz_constant(model, modulus)
    return evaluated(kernels.hertz_depth, model.m, model.v0, K)


def zener_number(model: "Model") -> float:
    """Return the Zener parameter [1], with the elasticity of the sphere included."""
    R, m, v0, h, _, lam, mu = model.numbers
    of_rigid_sphere = evaluated(kernels.zener_number, R, m, v0, h, lam, mu, model.density)
    number: float = of_rigid_sphere / np.power(1.0 + model.softness, 0.4)
    return number


def volume(R: Any) -> Any:
    """Return the volume of a sphere of a radius [m], or of many [m^3]."""
    return 4.0 / 3.0 * math.pi * (R * R * R)


def evaluated(function: Callable[..., Any], *numbers: Any) -> float:
    """Return the value of a generated function for the numbers of a model; for many, as a column.

    The function takes arrays: NumPy rounds the power of a single number differently, and results
    must not depend on whether a scene is one of many.
    """
    number: Any = columns.number(np.asarray(function(*map(np.atleast_1d, numbers))))
    return number  # type: ignore[no-any-return]
