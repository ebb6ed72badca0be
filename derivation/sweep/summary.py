"""Summary of a study: number of points by status, and range of each result."""

from collections import Counter
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from derivation.engine.text import aligned, paragraph, wording
from derivation.scene.input.keys import written
from derivation.scene.quantity import common_prefix, counted, rounded_up, up_to
from derivation.scene.result import UNITS
from derivation.scene.scene import OUTPUTS, outputs_of
from derivation.scene.selection.effect_selection import named
from derivation.sweep.dataset import column
from derivation.sweep.sensitivity import Sensitivities
from derivation.sweep.store import Store

BLOCK = 2**16
"""Number of points that are read together."""
DIGITS = 4
"""Number of significant digits of a range."""
MOST_WARNINGS = 5
"""Largest number of different reasons and warnings."""


class Reason(NamedTuple):
    """A warning, or why there is no result: the first point, its text, and the number of points."""

    where: str
    text: str
    points: int

    def in_words(self) -> str:
        """Return the text, and at how many points there is a similar one."""
        others = self.points - 1
        more = f", and similarly at {counted(others, 'other point')}" if others else ""
        return f"at {self.where}{more}: {self.text}"


@dataclass(frozen=True)
class Summary:
    """The summary of a study.

    Attributes
    ----------
    points, computed
        Number of all points, and of those computed in this run.
    counts
        Number of points by status.
    ranges
        Smallest and largest value of each result, in SI units; results without values are missing.
    largest_bound
        Largest bound on the relative error [1]; infinite if a point has none, NaN without results.
    largest_model_error
        Largest relative error of the model [1]; NaN without results.
    warnings
        The first reasons and warnings that differ in more than numbers, each with its first point.
    warned
        Number of points with a warning, or with a reason why there is no result.
    sensitivities
        Sensitivity indices, if requested.
    outputs
        The results that the bounds apply to.
    disabled
        The effects that the scene disables, which the bounds do not include.
    """

    points: int
    computed: int
    counts: dict[str, int]
    ranges: dict[str, tuple[float, float]]
    largest_bound: float
    largest_model_error: float
    warnings: tuple[str, ...]
    warned: int
    sensitivities: Sensitivities | None
    outputs: tuple[str, ...] = OUTPUTS
    disabled: tuple[str, ...] = ()

    def to_json(self) -> dict[str, Any]:
        """Return the summary under fixed keys, in SI units."""
        data = {key: value for key, value in vars(self).items() if key != "sensitivities"}
        data |= {"warnings": list(self.warnings)}
        for name in ("largest_bound", "largest_model_error"):
            data[name] = data[name] if np.isfinite(data[name]) else None
        return data | (
            {"sensitivities": self.sensitivities.to_json()} if self.sensitivities else {}
        )

    def to_text(self) -> str:
        """Return the summary as text."""
        counts = ", ".join(f"{count:,} {status}" for status, count in self.counts.items())
        rows = []
        for name, ends in self.ranges.items():
            values, unit = np.array(ends), UNITS[name]
            if unit != "1":
                values, unit = common_prefix(values, unit)
            rows.append([name.replace("_", " "), *(f"{x:#.{DIGITS}g}" for x in values), unit])
        whose = named(self.outputs, "")
        accuracy = (
            f"relative error{whose and f' of {whose}'} at most {rounded_up(self.largest_bound)}"
        )
        if self.largest_bound == np.inf:
            accuracy = "no error bound is known at some points"
        if np.isnan(self.largest_bound):
            accuracy = "no point has a result"
        elif self.largest_model_error:
            accuracy += f", model error {up_to(self.largest_model_error)}"
        text = (
            f"{self.points:,} points: {counts} ({self.computed:,} computed in this run)\n\n"
            f"{aligned(['result', '#smallest', '#largest', 'unit'], rows)}\n\n"
            f"{paragraph(f'Accuracy: {accuracy}')}"
        )
        if self.disabled:
            names = ", ".join(self.disabled)
            text += f"\n{paragraph(f'Disabled by the scene, not included in this bound: {names}')}"
        return f"{text}\n\n{self.sensitivities.to_text()}" if self.sensitivities else text


def summary(store: Store, computed: int, sensitivities: Sensitivities | None) -> Summary:
    """Summarise a finished study, block by block.

    Parameters
    ----------
    computed
        Number of points computed in this run.
    sensitivities
        Sensitivity indices, if requested.
    """
    counts, reasons, warned = Counter[str](), dict[str, Reason](), 0
    low, high = dict.fromkeys(UNITS, np.inf), dict.fromkeys(UNITS, -np.inf)
    bound = model_error = np.nan
    for start, _, table in store.tables(BLOCK):
        status = column(table, "status")
        counts.update(status.tolist())
        bound = float(np.fmax(bound, np.fmax.reduce(column(table, "bound"))))
        model_error = float(np.fmax(model_error, np.fmax.reduce(column(table, "model_error"))))
        for name in UNITS:
            values = column(table, name)
            low[name] = float(np.fmin(low[name], np.fmin.reduce(values)))
            high[name] = float(np.fmax(high[name], np.fmax.reduce(values)))
        reason = column(table, "reason").astype(str)
        warned += int(np.count_nonzero(reason != ""))
        _add_reasons(reasons, store, start, status, reason)
    ranges = {name: (low[name], high[name]) for name in UNITS if low[name] <= high[name]}
    warnings = tuple(reason.in_words() for reason in reasons.values())
    size, keys = store.study.plan.size, store.study.plan.keys
    effects = store.study.scene.effects.disabled
    disabled = tuple(name for name in effects if f"effects.{name}" not in keys)
    return Summary(
        size, computed, dict(sorted(counts.items())), ranges, bound, model_error, warnings, warned,
        sensitivities, outputs_of(store.study.scene), disabled,
    )  # fmt: skip


def _add_reasons(
    reasons: dict[str, Reason], store: Store, start: int, status: Any, new: Any
) -> None:
    """Add new reasons and warnings to `reasons` by their wording."""
    texts, first, counts = np.unique(new, return_index=True, return_counts=True)
    for i in np.argsort(first).tolist():
        text, number = str(texts[i]), start + int(first[i])
        kind = wording(text)
        if kind in reasons:
            known = reasons[kind]
            reasons[kind] = known._replace(points=known.points + int(counts[i]))
        elif text and len(reasons) < MOST_WARNINGS:
            points = store.study.plan.points(number, number + 1)
            where = ", ".join(f"{key} = {written(values[0])}" for key, values in points.items())
            state = str(status[first[i]])
            where += "" if state == "finished" else f" ({state})"
            reasons[kind] = Reason(where, text, int(counts[i]))
