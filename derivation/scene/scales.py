"""Scales of an impact: on a half-space, Zener's parameter, the volume of the sphere."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from derivation.scene import kernels

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
    return _number(kernels.hertz_constant(np.asarray(model.R), np.asarray(of_both)))


def time_unit(model: "Model", modulus: float | None = None) -> float:
    """Return T [s], T^5 = m^2/(K^2 v0); K as in `hertz_constant`."""
    K = hertz_constant(model, modulus)
    return _number(kernels.zener_time_unit(*map(np.asarray, (model.m, model.v0, K))))


def largest_depth(model: "Model", modulus: float | None = None) -> float:
    """Return the largest indentation [m] without gravity; K as in `hertz_constant`."""
    K = hertz_constant(model, modulus)
    return _number(kernels.hertz_depth(*map(np.asarray, (model.m, model.v0, K))))


def zener_number(model: "Model") -> float:
    """Return the Zener parameter [1], with the elasticity of the sphere included."""
    R, m, v0, h, _, lam, mu = model.numbers
    of_rigid_sphere = kernels.zener_number(R, m, v0, h, lam, mu, model.density)
    return _number(of_rigid_sphere / np.power(1.0 + model.softness, 0.4))


def volume(R: Any) -> Any:
    """Return the volume of a sphere of a radius [m], or of many [m^3]."""
    return 4.0 / 3.0 * math.pi * (R * R * R)


def _number(value: Any) -> float:
    """Return a number as such; for a column of models, as elsewhere, the array."""
    number: float = value if np.ndim(value) else float(value)
    return number
