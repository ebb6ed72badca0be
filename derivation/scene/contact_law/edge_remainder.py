"""Model error of a simply supported or clamped edge, measured against three-dimensional elasticity.

The table contains the error relative to the indentation by h/b, Poisson's ratio and a/b, and the
changes with coarser finite elements, which are added. Between the points of the table the largest
neighbouring value is used. Other columns contain the error of the stress on the axis of the back
face, relative to this stress. Both are model errors and not part of the error bound of the
computation.
"""

import json
import math
from functools import cache
from itertools import product
from typing import Any

import numpy as np

from derivation.engine.files import measurements
from derivation.scene.errors import SceneError
from derivation.scene.kernels import Numbers
from derivation.scene.model import Model
from derivation.scene.quantity import up_to, upwards
from generated.arrays import Double as Array

LARGEST = 0.01
"""Model error relative to the indentation above which a scene is rejected."""
LARGEST_H_OVER_B, LEAST_A_OVER_B = 1.0, 0.01
"""Largest h/b and smallest a/b of the table."""
KINDS = {"simply-supported": "supported", "clamped": "clamped"}
"""Names of the edges in the table."""
_KEYS = ("h_over_b", "nu", "a_over_b")
_NU, _DIGITS = _KEYS.index("nu"), 9
"""Poisson's ratio among the keys, and its decimals: it is computed from the Lame constants."""
_PARTS = ("relative_error", "lower_degree", "fewer_layers")
_STRESS = tuple(f"stress_{part}" for part in _PARTS)


@cache
def _table(parts: tuple[str, ...] = _PARTS) -> dict[tuple[Any, ...], float]:
    rows = json.loads((measurements() / "edge_remainder.json").read_text())["rows"]
    return {
        (row["support"], *(row[key] for key in _KEYS)): sum(abs(row[part]) for part in parts)
        for row in rows
    }


@cache
def _axes() -> tuple[list[float], ...]:
    """Return the points of each axis of the table."""
    return tuple(sorted({key[1 + i] for key in _table()}) for i in range(len(_KEYS)))


def edge_remainder(model: Model, a: float) -> float:
    """Return the largest model error of the edge at a contact radius [m], over the indentation [1].

    For h/b and a/b below the range of the table, its first values are used.

    Raises
    ------
    SceneError
        If the error exceeds 1 %, Poisson's ratio is below the range of the table, or h/b or a/b is
        above it.
    """
    kind, nu = KINDS[model.edge], round(float(model.poissons_ratio), _DIGITS)
    coordinates = {"h_over_b": model.eta, "nu": nu, "a_over_b": a / model.b}
    axes = _axes()
    for name, axis in zip(_KEYS, axes, strict=True):
        if name != "nu" and coordinates[name] > axis[-1]:
            raise SceneError(
                f"plate.edge: expected {name.replace('_over_', '/')} up to {axis[-1]} for a "
                f"{model.edge} edge, the range in which its model error is known, got "
                f"{coordinates[name]:.4g} (h half-thickness, a contact radius, b plate radius); "
                'write edge = "paper", or effects.edge = false'
            )
    if nu < axes[_NU][0]:
        raise SceneError(
            f"plate.poissons_ratio: expected at least {axes[_NU][0]} for a {model.edge} edge, the "
            f"range in which its model error is known, got {nu:.4g}; "
            'write plate.edge = "paper", or effects.edge = false'
        )
    around = [_neighbours(axis, coordinates[name]) for name, axis in zip(_KEYS, axes, strict=True)]
    remainder = max(_table()[(kind, *point)] for point in product(*around))
    if remainder > LARGEST:
        raise SceneError(
            f"plate.edge: expected a model error of the {model.edge} edge of at most 1 % of the "
            f"indentation, got {upwards(100 * remainder, 3):g} % at h/b = {model.eta:.4g}, "
            f"nu = {nu:.5g}, a/b = {a / model.b:.4g} (h half-thickness, "
            "a contact radius, b plate radius); use a larger plate, or set effects.edge = false"
        )
    return remainder


def edge_remainders(model: Model, a: Array) -> Array:
    """Return the model errors of many scenes as a column; NaN if `edge_remainder` rejects one."""
    remainders = largest_neighbours(model, a, model.eta)
    return np.where(remainders <= LARGEST, remainders, np.nan)


def edge_warnings(model: Model, a: float) -> tuple[str, ...]:
    """Return a warning if the model error of the edge exceeds 1 % or is unknown."""
    [error] = largest_neighbours(model, np.array([a]), model.eta)
    if error <= LARGEST:
        return ()
    size = "unknown" if np.isnan(error) else f"{up_to(error)} of the indentation"
    text = (
        f"the model error of the {model.edge} edge is {size} at h/b = {model.eta:.4g}, nu = "
        f"{model.poissons_ratio:.3g}, a/b = {a / model.b:.4g} (h half-thickness, a contact radius, "
        "b plate radius)"
    )
    return (text,)


def edge_stress_error(model: Model, a: float) -> float:
    """Return the largest model error of the static stress on the back face by the edge [1].

    It is relative to the stress, and infinite outside the range of the table.
    """
    [error] = edge_stress_errors(model, np.array([a]))
    return float(error)


def edge_stress_errors(model: Model, a: Array) -> Array:
    """Return the errors of `edge_stress_error` for many scenes as a column."""
    if model.edge not in KINDS:
        return np.zeros_like(a)
    errors = largest_neighbours(model, a, model.eta, _STRESS)
    return np.where(np.isfinite(errors), errors, math.inf)


def largest_neighbours(
    model: Model, a: Array, eta: Numbers, parts: tuple[str, ...] = _PARTS
) -> Array:
    """Return model errors at radii [m] and half-thicknesses h/b; NaN outside the range.

    `parts` are the columns of the table that are added.
    """
    nu = np.round(model.poissons_ratio, _DIGITS)
    # Only the radii have an axis for the points of a scene; the search takes longer than the table.
    axes, coordinates = _axes(), [np.asarray(x) for x in (eta, nu, a / model.b)]
    known, ends = coordinates[_NU] >= axes[_NU][0], []
    for name, axis, coordinate in zip(_KEYS, axes, coordinates, strict=True):
        if name != "nu":
            known = known & (coordinate <= axis[-1])
        below = np.searchsorted(axis, coordinate, side="right") - 1
        above = np.searchsorted(axis, coordinate, side="left")
        ends.append([np.clip(end, 0, len(axis) - 1) for end in (below, above)])
    table = _array(KINDS[model.edge], parts)
    return np.where(known, np.maximum.reduce([table[one] for one in product(*ends)]), np.nan)


@cache
def _array(kind: str, parts: tuple[str, ...]) -> Array:
    """Return the table of an edge as an array over its axes."""
    table = np.array([_table(parts)[(kind, *point)] for point in product(*_axes())])
    return table.reshape([len(axis) for axis in _axes()])


def _neighbours(axis: list[float], value: float) -> list[float]:
    """Return the points of an axis on both sides of a value."""
    below = [x for x in axis if x <= value] or axis[:1]
    above = [x for x in axis if x >= value] or axis[-1:]
    return sorted({below[-1], above[0]})
