"""Run times of the contact law, impacts, stable functions and commands, with their limits.

Most results are ratios of two times. Both are measured in alternation, so that other load of the
machine affects both. The lower quartile of each is used; the ratio of upper to lower quartile is
recorded as a measure of the load.
"""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from derivation.engine.activity import Progress, quiet
from derivation.plate.modes.naive import FIELDS, naive_field
from generated import (
    G,
    G_minus_1,
    K_j,
    Omega_1,
    Omega_2,
    Omega_3,
    Omega_4,
    as_printed,
    mode_shapes,
    sonine,
)
from generated.arrays import as_doubles, as_result, inside
from generated.contact_law import force_of_radius, indentation
from generated.impact import impact

POINTS = 1_000_000
"""Number of contact radii for the contact law."""
SCENES = 100_000
"""Number of scenes in a batch of impacts."""
ROUNDS = 25
"""Number of measurements of each time."""
COMMAND = "from derivation.cli import main; main()"
START, PLATE_START, EXPLAIN_START = 2.0, 6.0, 2.0
"""Limits for a command in a new process, relative to the imports of its libraries: `simulate`,
`simulate` with a solution of its own, and `explain`.

A plate with inertia is simulated with two numbers of modes for its error bound, in steps that NumPy
cannot combine. `explain` computes the bounds of all effects, also those of a plastic contact.
"""
SWITCHES = (
    "spherical_profile",
    "bending",
    "finite_thickness",
    "finite_radius",
    "non_hertzian_pressure",
)
"""Effects of `block.toml` that can be disabled."""
COLD_ROUNDS = 9
"""Number of measurements of a process."""
LIBRARIES = "import numpy, scipy.special, pydantic, typer, rich"
ETA = 0.1
"""h/b of the paper's plate."""


@dataclass(frozen=True)
class SpeedTiming:
    """The result of a comparison.

    Parameters
    ----------
    name
        Name of the comparison.
    value, unit
        The result: a ratio of times, or a rate.
    limit
        Stated limit: the largest ratio, or the smallest rate.
    spread
        Largest ratio of upper to lower quartile among its times.
    passed
        Whether the result is within the limit.
    """

    name: str
    value: float
    unit: str
    limit: float
    spread: float
    passed: bool


def interleaved(
    candidates: Sequence[Callable[[], object]], rounds: int
) -> tuple[list[float], float]:
    """Return the lower quartile of the times of each function [s], and the largest spread."""
    times = np.empty((rounds, len(candidates)))
    for row in times:
        for index, candidate in enumerate(candidates):
            begin = time.perf_counter()
            candidate()
            row[index] = time.perf_counter() - begin
    low, high = np.quantile(times, (0.25, 0.75), axis=0)
    return low.tolist(), float((high / low).max())


def ratio(name: str, one: Callable[[], object], base: Callable[[], object], limit: float,
          rounds: int = ROUNDS) -> SpeedTiming:  # fmt: skip
    """Measure the time of a function relative to that of another."""
    (mine, other), spread = interleaved((one, base), rounds)
    return SpeedTiming(name, mine / other, "times", limit, spread, mine / other <= limit)


def law_over_exp(top: float, limit: float) -> SpeedTiming:
    """Measure the contact law for one plate, a/h up to `top`, relative to `numpy.exp`."""
    a = np.random.default_rng(1).uniform(1e-3, top, POINTS)
    name = f"contact law relative to numpy.exp, {POINTS:,} points, h/b = {ETA}, a/h up to {top}"
    return ratio(name, lambda: indentation(a, 100.0, 1.0, 1 / ETA), lambda: np.exp(a), limit)


def _naive_G(x: Any) -> Any:
    return (np.sinh(x) * np.cosh(x) + x) / (np.sinh(x) ** 2 - x**2)


def _as_kernel(naive: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """Add the argument checks and type conversions of a generated function to a textbook form."""

    def call(x: Any) -> Any:
        kind, [x] = as_doubles(x)
        [x] = inside([x], x > 0)
        return as_result(naive(x), kind)

    return call


NAIVE_POINTS = 10_000
"""Number of arguments for functions of a mode; arrays of this size fit in the cache."""


def _field(name: str) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """Return a field of a mode and its textbook form, as functions of x = phi h."""
    stable, depths = getattr(mode_shapes, name), np.linspace(-1.0, 1.0, NAIVE_POINTS)
    return (
        lambda x: stable(depths, x, 1.0, 1.2, 0.8, -1.0),
        lambda x: naive_field(name, depths, x, 1.0, 1.2, 0.8, -1.0),
    )


NAIVE: Mapping[str, tuple[Callable[..., Any], Callable[..., Any]]] = {
    "G": (G, _as_kernel(_naive_G)),
    "G_minus_1": (G_minus_1, _as_kernel(lambda T: _naive_G(T) - 1)),
    "sonine": (
        lambda y: sonine(y, 1.0),
        _as_kernel(lambda y: (np.sin(y) - y * np.cos(y)) / y**3),
    ),
    "Omega_1": (lambda x: Omega_1(x, 1.0, 1.2, 0.8), lambda x: as_printed.Omega_1(x, 1, 1.2, 0.8)),
    "Omega_2": (lambda x: Omega_2(x, 1.0, 1.2, 0.8), lambda x: as_printed.Omega_2(x, 1, 1.2, 0.8)),
    "Omega_3": (lambda x: Omega_3(x, 1.0, 0.8), lambda x: as_printed.Omega_3(x, 1.0, 0.8)),
    "Omega_4": (lambda x: Omega_4(x, 1.0, 0.8), lambda x: as_printed.Omega_4(x, 1.0, 0.8)),
    "K_j": (
        lambda x: K_j(x, 1.0, 1.0, 2.0, 0.5),
        lambda x: as_printed.K_j(x, 1.0, 1.0, 2.0, 0.5),
    ),
} | {name: _field(name) for name in FIELDS}
"""Stable functions and their textbook forms: as published, if that is correct up to a factor."""

NAIVE_RANGE = (2.0, 80.0)
"""Arguments at which textbook forms do not overflow and lose at most one bit by cancellation."""


def stable_over_naive(name: str) -> SpeedTiming:
    """Measure a stable function relative to its textbook form, at arguments accurate for both.

    A large array is allocated and released first. Otherwise the C library would return memory to
    the operating system after every call, and allocation would dominate the times.
    """
    np.ones(4_000_000)
    stable, naive = NAIVE[name]
    x = np.random.default_rng(3).uniform(*NAIVE_RANGE, NAIVE_POINTS)
    title = f"{name} relative to its textbook form, {NAIVE_POINTS:,} points from 2 to 80"
    return ratio(title, lambda: stable(x), lambda: naive(x), 3.0, 20 * ROUNDS)


def scenes(low: float, high: float, count: int = SCENES) -> dict[str, Any]:
    """Return random arguments of `impact` whose largest a/h lies between `low` and `high`."""
    random = np.random.default_rng(2)
    eta, h = 10 ** random.uniform(-3.0, -0.8, count), 10 ** random.uniform(-3.0, 0.0, count)
    b = h / eta
    R, a = b * random.uniform(2.0, 50.0, count), h * random.uniform(low, high, count)
    a = np.minimum(a, 0.9 * b)
    lam, mu = 10 ** random.uniform(8.0, 11.0, count), 10 ** random.uniform(8.0, 11.0, count)
    work = 0.7 * force_of_radius(a, R, lam, mu) * indentation(a, R, h, b)
    m = 10 ** random.uniform(-3.0, 3.0, count)
    return {"R": R, "m": m, "v0": np.sqrt(work / m), "h": h, "b": b, "lam": lam, "mu": mu}


def impact_rate(low: float, high: float, limit: float) -> SpeedTiming:
    """Measure the number of impacts per second in one batch of different scenes."""
    arguments = scenes(low, high)
    (duration,), spread = interleaved((lambda: impact(**arguments),), 5)
    rate = SCENES / duration
    name = f"impacts in a batch of {SCENES:.0e} scenes, a_m/h from {low} to {high}"
    return SpeedTiming(name, rate, "1/s", limit, spread, rate >= limit)


def cold_start(command: str, scene: Path, limit: float) -> SpeedTiming:
    """Measure a command in a new process, relative to a process that only imports its libraries."""
    name = f"platecontact {command} {scene.name}, first start, relative to importing its libraries"
    return ratio(name, process(COMMAND, command, str(scene), "--json", "-"), process(LIBRARIES),
                 limit, COLD_ROUNDS)  # fmt: skip


def process(code: str, *arguments: str) -> Callable[[], object]:
    """Return a function that runs Python code in a new process, with its usual bytecode cache."""
    call = [sys.executable, "-c", code, *arguments]
    usual = {k: value for k, value in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    return lambda: subprocess.run(call, check=True, capture_output=True, env=usual)


def hertz_alone(scene: Path, limit: float) -> SpeedTiming:
    """Measure a scene for which the program selects Hertz theory alone.

    The reference is the same scene with all other effects disabled, so that the ratio is the run
    time of the automatic selection.
    """
    with tempfile.TemporaryDirectory() as folder:
        plain = Path(folder) / scene.name
        keys = "".join(f"{name} = false\n" for name in SWITCHES)
        plain.write_text(f"{scene.read_text()}\n[effects]\n{keys}")
        name = (
            f"platecontact simulate {scene.name}, Hertz only: selected, "
            "relative to all others disabled"
        )
        auto, off = (
            process(COMMAND, "simulate", str(path), "--json", "-") for path in (scene, plain)
        )
        return ratio(name, auto, off, limit, COLD_ROUNDS)


def measure(
    examples: Sequence[Path],
    solved: Collection[Path] = (),
    progress: Progress = quiet,
    further: Sequence[tuple[str, Callable[[], SpeedTiming]]] = (),
) -> list[SpeedTiming]:
    """Measure all comparisons in sequence.

    Parameters
    ----------
    examples
        Scene files whose start is timed; `block.toml` is also compared with Hertz theory alone.
    solved
        Those of the scene files whose pressure is computed from the integral equation.
    progress
        Called before each comparison with its name, its number and the total number.
    further
        Additional comparisons, each with its name.
    """
    planned: tuple[tuple[str, Callable[[], SpeedTiming]], ...] = (
        ("small contacts", lambda: law_over_exp(0.3, 6.0)),
        ("contacts up to 3 h", lambda: law_over_exp(3.0, 15.0)),
        ("impacts", lambda: impact_rate(0.01, 2.9, 5e4)),
        ("deep impacts", lambda: impact_rate(0.01, 5.9, 5e4)),
    )
    for scene in examples:
        limit = PLATE_START if scene in solved else START
        planned += (
            ("cold start", partial(cold_start, "simulate", scene, limit)),
            ("cold start", partial(cold_start, "explain", scene, EXPLAIN_START)),
        )
        if scene.name == "block.toml":
            planned += (("Hertz alone", partial(hertz_alone, scene, 1.2)),)
    planned += tuple((name, partial(stable_over_naive, name)) for name in NAIVE)
    planned += tuple(further)
    rows = []
    for number, (name, timing) in enumerate(planned, start=1):
        progress(name, number, len(planned))
        rows.append(timing())
    return rows


def as_data(timings: Sequence[SpeedTiming]) -> dict[str, Any]:
    """Return the results as plain data, with the machine and its load."""
    return {"machine": dict(machine()), "rows": [asdict(timing) for timing in timings]}


def machine() -> Mapping[str, str]:
    """Return the processor, the load, and the instructions that NumPy uses for exp."""
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.is_file() else []
    model = next((line.partition(":")[2].strip() for line in lines if "model name" in line), "")
    targets = np.lib.introspect.opt_func_info(func_name="^exp$", signature="float64")
    used = ", ".join(kind["current"] for of in targets.values() for kind in of.values())
    return {
        "processor": model or "unknown",
        "cores": str(os.cpu_count()),
        "load": f"{os.getloadavg()[0]:.1f}",
        "numpy.exp": used,
        "numpy": np.__version__,
    }
