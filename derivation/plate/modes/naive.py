"""The fields of a mode in textbook form, with hyperbolic functions: for comparison."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from generated.arrays import as_doubles, as_result, inside


class _Point(NamedTuple):
    """T = 2 phi h, distances from back and contact face times phi, 1 - 2 nu, and sinh T."""

    T: Any
    u: Any
    v: Any
    c: Any
    s: Any


def _f(p: _Point) -> Any:
    by_far = p.s * ((1 + p.c) * np.cosh(p.u) + p.v * np.sinh(p.u))
    return (by_far + p.T * ((1 + p.c) * np.cosh(p.v) + p.u * np.sinh(p.v))) / 2


def _in_plane(p: _Point, c: Any) -> Any:
    by_far = p.s * (c * np.sinh(p.u) - p.v * np.cosh(p.u))
    return by_far - p.T * (c * np.sinh(p.v) - p.u * np.cosh(p.v))


def _zz(p: _Point) -> Any:
    versine, cubic = np.cosh(p.u) - 1, np.sinh(p.u) - p.u
    return p.s * (p.v * versine + cubic) + p.T * (np.sinh(p.v) * versine + np.cosh(p.v) * cubic)


FIELDS: Mapping[str, Callable[[_Point], Any]] = {
    "mode_f": _f,
    "mode_g": lambda p: _in_plane(p, p.c) / 2,
    "mode_zz": _zz,
    "mode_rz": lambda p: -p.s * p.v * np.sinh(p.u) - p.T * p.u * np.sinh(p.v),
    "mode_rr": lambda p: _in_plane(p, 1.0),
    "mode_tt": lambda p: p.s * np.sinh(p.u) - p.T * np.sinh(p.v),
}
"""Contributions of both faces times sinh^2 T - T^2, by field."""


def naive_field(name: str, *given: Any) -> Any:
    """Return the textbook form of a field as a function with the usual checks of arguments."""
    kind, [z, phi, h, lam, mu, A_j] = as_doubles(*given)
    [z, phi, h, lam, mu, A_j] = inside(
        [z, phi, h, lam, mu, A_j], abs(z) <= h, phi > 0, h > 0, 3 * lam > -2 * mu, mu > 0
    )
    T = 2 * phi * h
    point = _Point(T, phi * (h + z), phi * (h - z), mu / (lam + mu), np.sinh(T))
    value = A_j * FIELDS[name](point) / (point.s**2 - T**2)
    if name == "mode_f":
        value = value / (mu * phi)
    elif name == "mode_g":
        value = value / (mu * phi**2)
    elif name == "mode_tt":
        value = value * lam / (lam + mu)
    return as_result(value, kind)
