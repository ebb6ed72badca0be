"""Solves many scenes that differ in some numbers: arrays of values in, arrays of results out."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derivation.scene.impact import simulate
from derivation.scene.result import UNITS
from derivation.scene.scene import Scene, SceneError, read
from derivation.scene.sweep import varied


@dataclass(frozen=True)
class Rows:
    """Results of many scenes, one element of each array per scene.

    Attributes
    ----------
    results
        By name, in SI units; NaN where there is none.
    bound
        Bound of the relative error [1].
    model_error
        Largest relative error of the model itself [1].
    status
        "finished", "incomplete" or "refused".
    reason
        Why the scene is refused or incomplete, else its warnings joined by "; ".
    effects
        Names of the effects included, joined by spaces.
    """

    results: dict[str, NDArray[np.float64]]
    bound: NDArray[np.float64]
    model_error: NDArray[np.float64]
    status: NDArray[np.str_]
    reason: NDArray[np.object_]
    effects: NDArray[np.object_]


def solve(
    scene: Scene, columns: Mapping[str, NDArray[np.float64]], rtol: float | None = None
) -> Rows:
    """Simulate the scene once for each row of values.

    Parameters
    ----------
    scene
        The scene.
    columns
        By `table.key`, the values that the key takes, in SI units; all of one length.
    rtol
        Relative tolerance, as `simulate` takes it.
    """
    keys = list(columns)
    found = [
        _row(scene, dict(zip(keys, map(float, row), strict=True)), rtol)
        for row in zip(*columns.values(), strict=True)
    ]
    none = dict.fromkeys(UNITS, np.nan)
    results = {name: np.array([(row[0] or none)[name] for row in found]) for name in UNITS}
    others: list[NDArray[Any]] = [
        np.array([row[i] for row in found], dtype=kind)
        for i, kind in enumerate((float, float, str, object, object), start=1)
    ]
    return Rows(results, *others)


def _row(
    scene: Scene, values: dict[str, float], rtol: float | None
) -> tuple[dict[str, float], float, float, str, str, str]:
    """One scene: results, bound, model error, status, reason, effects."""
    try:
        found = simulate(read(varied(scene, values)), rtol=rtol)
    except SceneError as error:
        return {}, np.nan, np.nan, "refused", str(error), ""
    effects = " ".join(found.effects.included)
    if not found.complete:
        note = found.incomplete_note
        return {}, found.accuracy.bound, found.model_error, "incomplete", note, effects
    results = {name: float(getattr(found, name)) for name in UNITS}
    remark = "; ".join(found.warnings)
    return results, found.accuracy.bound, found.model_error, "finished", remark, effects
