"""Variance-based sensitivity indices: fraction of the variance of a result due to each key."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from derivation.engine.text import aligned
from derivation.scene.errors import SceneError
from derivation.scene.result import UNITS
from derivation.scene.scene import OUTPUTS, outputs_of
from derivation.sweep.dataset import column
from derivation.sweep.plan import Array, SaltelliPlan
from derivation.sweep.store import Store

if TYPE_CHECKING:
    import xarray as xr

CONFIDENCE = 0.95
"""Fraction of bootstrap samples that an interval covers."""
RESAMPLES = 999
"""Number of bootstrap samples."""
BLOCK = 100_000
"""Number of values in resampled studies that are evaluated at once."""
ORDERS = ("first_order", "total_order")


@dataclass(frozen=True)
class Sensitivities:
    """Sensitivity indices with their confidence intervals, each of shape (result, key).

    Attributes
    ----------
    keys
        The varied keys.
    runs
        Number of simulations.
    index
        "first_order" and "total_order": fraction of the variance of a result [1] due to a key
        alone, and including its interactions with all other keys.
    low, high
        Ends of the confidence intervals of both.

    unbounded
        Results without an error bound, because `accuracy.outputs` does not name them.

    The indices are NaN if the scatter of a result is within its error bound, or it has none.
    """

    keys: tuple[str, ...]
    runs: int
    index: dict[str, Array]
    low: dict[str, Array]
    high: dict[str, Array]
    unbounded: tuple[str, ...] = ()

    def to_text(self) -> str:
        """Return the indices as a table."""
        rows = []
        for i, name in enumerate(UNITS):
            rows.append([name.replace("_", " "), "", ""])
            for j, key in enumerate(self.keys):
                rows.append([f"  {key}", *(self._shown(order, i, j) for order in ORDERS)])
        title = (
            f"Sensitivity indices with {100 * CONFIDENCE:.0f} % confidence intervals, "
            f"from {self.runs:,} runs"
        )
        text = f"{title}\n\n{aligned(['key', '#first order', '#total order'], rows)}"
        unnamed = "unknown: accuracy.outputs does not name these results"
        return f"{text}\n\n{unnamed}" if self.unbounded else text

    def to_json(self) -> list[dict[str, Any]]:
        """Return a row for each result and key; null where the indices are NaN."""
        return [
            {"result": name, "key": key}
            | {
                f"{order}{end}": None if np.isnan(values[order][i, j]) else values[order][i, j]
                for order in ORDERS
                for end, values in (("", self.index), ("_low", self.low), ("_high", self.high))
            }
            for i, name in enumerate(UNITS)
            for j, key in enumerate(self.keys)
        ]

    def add_to(self, data: "xr.Dataset") -> "xr.Dataset":
        """Return the Dataset with the indices, over the dimensions `result` and `key`."""
        made: dict[str, Any] = {}
        for order in ORDERS:
            words = order.replace("_", "-") + " sensitivity index"
            for end, values in (("", self.index), ("_low", self.low), ("_high", self.high)):
                text = words + (f", {end[1:]} end of the confidence interval" if end else "")
                about = {"long_name": text, "units": "1"}
                made[order + end] = (("result", "key"), values[order], about)
        return data.assign(made).assign_coords(result=list(UNITS), key=list(self.keys))

    def _shown(self, order: str, i: int, j: int) -> str:
        value, low, high = (x[order][i, j] for x in (self.index, self.low, self.high))
        if np.isnan(value):
            return "unknown" if list(UNITS)[i] in self.unbounded else "no scatter"
        return f"{value:.3f} ({low:.3f} to {high:.3f})"


def sensitivities(store: Store) -> Sensitivities:
    """Compute the indices of a finished study whose plan is a `SaltelliPlan`.

    Raises
    ------
    SceneError
        If a point has no result, because the indices of the others would be biased.
    """
    plan = store.study.plan
    assert isinstance(plan, SaltelliPlan)
    table = store.table(0, plan.size)
    _check_finished(table)
    results = np.array([column(table, name) for name in UNITS])
    outputs = outputs_of(store.study.scene)
    errors = _errors(float(np.max(column(table, "bound"))), outputs)
    varies = np.ptp(results, axis=1) > 2.0 * errors * np.max(np.abs(results), axis=1)
    values = results[varies].reshape(-1, plan.base, plan.each)
    values_by_order = np.full((3, len(ORDERS), len(UNITS), len(plan.keys)), np.nan)
    if values.size:
        values_by_order[:, :, varies] = _with_intervals(values)
    unbounded = tuple(name for name, x in zip(UNITS, errors, strict=True) if np.isinf(x))
    index, low, high = (dict(zip(ORDERS, x, strict=True)) for x in values_by_order)
    return Sensitivities(plan.keys, plan.size, index, low, high, unbounded)


def _errors(bound: float, outputs: tuple[str, ...]) -> Array:
    """Return the bound on the error of each result [1]; infinite for a result without a bound.

    The bound applies to the results that `accuracy.outputs` names: effects on which only other
    results depend may be omitted. The bound of the pressure is three times that of all results, and
    that of the stress on the back face is that of the force.
    """
    errors = dict.fromkeys(UNITS, np.inf) | dict.fromkeys(outputs, bound)
    if set(OUTPUTS) <= set(outputs):
        errors["max_pressure"] = float(np.expm1(3.0 * np.log1p(bound)))
    errors["max_tensile_stress"] = errors["max_force"]
    return np.array([errors[name] for name in UNITS])


def _check_finished(table: Any) -> None:
    """Raise an error if a point has no result."""
    status = column(table, "status")
    wrong = np.flatnonzero(status != "finished")
    if wrong.size:
        reason = column(table, "reason")[wrong[0]]
        raise SceneError(
            f"sensitivity: expected every point to finish, but {wrong.size:,} of "
            f"{len(status):,} did not; point {wrong[0]} is {status[wrong[0]]}: {reason}; "
            "narrow the distributions"
        )


def _with_intervals(values: Array) -> Array:
    """Return indices, low and high ends, shape (3, order, result, key), by resampling base points.

    Parameters
    ----------
    values
        Results of shape (result, base, d + 2), d being the number of keys.
    """
    base, rng = values.shape[1], np.random.default_rng(0)
    count, again = max(1, BLOCK // values.size), []
    for begin in range(0, RESAMPLES, count):
        chosen = rng.integers(0, base, (min(count, RESAMPLES - begin), base))
        again.append(_indices(np.moveaxis(values[:, chosen], 1, 0)))
    outside = (1 - CONFIDENCE) / 2
    index, widening = _indices(values), _widening(base)
    ends = np.quantile(np.concatenate(again, axis=1), [outside, 1 - outside], axis=1)
    # An interval of quantiles may lie on one side of the index.
    low, high = np.minimum(ends[0] - index, 0.0), np.maximum(ends[1] - index, 0.0)
    return np.stack([index, index + widening * low, index + widening * high])


def _widening(base: int) -> float:
    """Return the width of Student's interval over that of the bootstrap, which is too narrow.

    The bootstrap has the variance of `base` points about their own mean, which is too small, and
    approximately normal quantiles.
    """
    from scipy.stats import norm, t

    inside = (1 + CONFIDENCE) / 2
    return math.sqrt(base / (base - 1)) * float(t.ppf(inside, base - 1) / norm.ppf(inside))


def _indices(values: Array) -> Array:
    """Return first-order and total indices, of shape (order, ..., result, key); 0 without variance.

    They are estimates (b) and (f) of table 2 of Saltelli et al. 2010.

    Parameters
    ----------
    values
        Results of shape (..., result, base, d + 2), d being the number of keys.
    """
    values = values - values[..., :2].mean(axis=(-2, -1), keepdims=True)
    one, other, mixed = values[..., :1], values[..., 1:2], values[..., 2:]
    variance = values[..., :2].var(axis=(-2, -1))[..., None]
    first, total = (other * (mixed - one)).mean(axis=-2), 0.5 * ((one - mixed) ** 2).mean(axis=-2)
    return np.stack([first, total]) / np.where(variance > 0.0, variance, np.inf)
