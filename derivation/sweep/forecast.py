"""Forecast of a study: number of points, included effects and run time."""

import time
from collections import Counter
from dataclasses import dataclass
from typing import Any

import numpy as np

from derivation.engine.text import aligned
from derivation.scene.errors import SceneError
from derivation.scene.impact import selected_effects
from derivation.scene.input.keys import varied
from derivation.scene.rows.rows import solve
from derivation.scene.scene import read
from derivation.sweep.study import Study

MOST_PROBES = 32
"""Largest number of points whose effects are selected."""
TIMING_SIZES = (8, 64, 512, 4096)
"""Numbers of points that are timed, in turn, until a timing takes longer than `ENOUGH`."""
ENOUGH_SECONDS = 0.5
"""Duration of a timing that is sufficient for the estimate [s]."""


@dataclass(frozen=True)
class Forecast:
    """The forecast of a study.

    Attributes
    ----------
    points
        Number of points.
    probes
        Number of tested points: corners of a grid, or first points of a sample.
    effects
        Number of tested points at which each effect is included.
    rejected
        Reasons why tested points are rejected, each once.
    timed
        Number of points that were timed.
    seconds
        Estimated run time in one process [s].
    workers
        Number of processes.
    """

    points: int
    probes: int
    effects: dict[str, int]
    rejected: tuple[str, ...]
    timed: int
    seconds: float
    workers: int

    def to_json(self) -> dict[str, Any]:
        """Return the forecast under fixed keys."""
        return {**vars(self), "rejected": list(self.rejected)}

    def to_text(self) -> str:
        """Return the forecast as text."""
        rows = [(name, f"{count} of {self.probes}") for name, count in self.effects.items()]
        shared = self.seconds / self.workers
        return (
            f"{self.points:,} points\n\n"
            f"{aligned(['effect', '#included at tested points'], rows)}\n\n"
            f"Estimated time: {_duration(self.seconds)} on one process, {_duration(shared)} on "
            f"{self.workers}; from the run time of {self.timed:,} points"
        )


def forecast(study: Study, workers: int) -> Forecast:
    """Return the forecast of a study, from the effects of some points and the run time of others.

    Raises
    ------
    SceneError
        If every tested point is rejected.
    """
    columns = study.plan.probes(MOST_PROBES)
    count = len(next(iter(columns.values())))
    effects, rejected = Counter[str](), dict[str, None]()
    for number in range(count):
        values = {key: column[number].item() for key, column in columns.items()}
        try:
            chosen = selected_effects(read(varied(study.scene, values)), study.rtol)[1]
        except SceneError as error:
            rejected[str(error)] = None
            continue
        effects.update(chosen.included)
    if not effects:
        raise SceneError(
            f"sweep: expected points that can be simulated, but all {count} tested points are "
            f"rejected: {next(iter(rejected))}"
        )
    timed, seconds = _cost(study)
    return Forecast(
        study.plan.size, count, dict(effects), tuple(rejected), timed, seconds, max(workers, 1)
    )


def _cost(study: Study) -> tuple[int, float]:
    """Return the number of timed points, and the estimated run time of all points [s]."""
    size = study.plan.size
    for most in TIMING_SIZES:
        count = min(most, size)
        indices = np.unique(np.linspace(0, size - 1, count).astype(np.int64))
        points = [study.plan.points(int(index), int(index) + 1) for index in indices]
        columns = {key: np.concatenate([p[key] for p in points]) for key in study.plan.keys}
        start = time.perf_counter()
        solve(study.scene, columns, study.rtol)
        seconds = time.perf_counter() - start
        if seconds > ENOUGH_SECONDS or count == size:
            break
    return len(indices), seconds * size / len(indices)


def _duration(seconds: float) -> str:
    """Return a time [s] as text with one or two digits and a suitable unit."""
    for size, unit in ((86400.0, "days"), (3600.0, "h"), (60.0, "min")):
        if seconds >= 2 * size:
            return f"{seconds / size:,.{0 if seconds >= 10 * size else 1}f} {unit}"
    return f"{seconds:.2g} s"
