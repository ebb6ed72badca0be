"""Comparison with other programs on an elastic half-space.

None of these programs can compute a plate with an edge. On a half-space, Hertz theory gives the
exact reference values. The generated code is called with h and b so large that the compliance of
the plate is below rounding errors. The script `half_space` runs the other programs; the environment
variable `PLATECONTACT_TOOLS` names the Python interpreter in which they are installed.
"""

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from derivation.plate.benchmark import half_space
from derivation.plate.benchmark.arithmetic import DOUBLE
from derivation.plate.benchmark.interface import BenchmarkCase
from derivation.plate.benchmark.ready_methods import hertz_law, hertz_time
from generated.contact_law import indentation
from generated.impact import impact

VARIABLE = "PLATECONTACT_TOOLS"
LIMIT = 120
"""Time limit for a program [s]."""

FAR = 1e20
"""h/a and b/a of the plate that represents the half-space in the generated code."""


@dataclass(frozen=True)
class Tool:
    """The result of a program for a problem.

    Attributes
    ----------
    name, version
        Name and version of the program.
    problem, setting
        The problem solved, and the settings of the program.
    error, seconds
        Relative error of the result, and its run time [s].
    limitation
        What the program cannot compute of the impact of a sphere on a plate.
    missing
        Reason why there is no result, or None.
    """

    name: str
    version: str = ""
    problem: str = ""
    setting: str = ""
    error: float | None = None
    seconds: float | None = None
    limitation: str = ""
    missing: str | None = None


def tools() -> list[Tool]:
    """Return the results of the generated code and of all other programs for the same problems."""
    return own_results() + [row for name in half_space.PROGRAMS for row in run(name, os.environ)]


def run(name: str, environment: Mapping[str, str]) -> list[Tool]:
    """Run one program in a separate process; SciPy runs in the current interpreter."""
    python = sys.executable if name.startswith("SciPy") else environment.get(VARIABLE)
    if python is None:
        return [Tool(name, missing=f"not installed: {VARIABLE} names no Python that has it")]
    script = str(Path(half_space.__file__))
    try:
        done = subprocess.run(
            [python, script, name], capture_output=True, text=True, timeout=LIMIT, check=False
        )
    except OSError as error:
        return [Tool(name, missing=f"not installed: {python}: {error.strerror}")]
    except subprocess.TimeoutExpired:
        return [Tool(name, missing=f"no result within {LIMIT} s")]
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ["no message"])[-1]
        absent = "not installed: " if "ModuleNotFoundError" in last else "failed: "
        return [Tool(name, missing=absent + last)]
    return [Tool(**row) for row in json.loads(done.stdout.splitlines()[-1])]


def own_results() -> list[Tool]:
    """Return the results of the generated code for indentation and contact time."""
    far = BenchmarkCase("half-space", 1.0, 0.1 * FAR, 0.1 * FAR, 0.0, 0.0, 1.0)
    r, a, setting = far, 0.1, f"h = b = {FAR:g} a"
    delta, law_time = _timed(lambda: float(indentation(a, r.R, r.h, r.b)))
    contact_time, impact_time = _timed(
        lambda: float(impact(r.R, r.m, r.speed, r.h, r.b, r.lam, r.mu).contact_time)
    )
    errors = [
        abs(delta / hertz_law(r, DOUBLE)(a) - 1),
        abs(contact_time / hertz_time(r, DOUBLE)(r.speed) - 1),
    ]  # fmt: skip
    return [
        Tool("platecontact", "", "indentation of a half-space", setting, float(errors[0]),
             law_time, "pressure other than Hertz's"),
        Tool("platecontact", "", "contact time on a half-space", setting, float(errors[1]),
             impact_time, "motion of the plate itself"),
    ]  # fmt: skip


def _timed(call: Callable[[], float]) -> tuple[float, float]:
    """Return the result of a call, and the lower quartile of its times [s]."""
    times = []
    for _ in range(50):
        begin = time.perf_counter()
        value = call()
        times.append(time.perf_counter() - begin)
    return value, float(np.quantile(times, 0.25))
