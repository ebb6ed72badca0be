"""Results of other programs for the parts of the problem that they can solve.

None computes a plate with an edge. They are compared on a half-space, for which Hertz's formulas
are exact. For the generated code h and b are so large that the plate's contribution is below
rounding. `half_space` runs them; `PLATECONTACT_TOOLS` names the Python that has them.
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
from derivation.plate.benchmark.interface import Regime
from derivation.plate.benchmark.shipped import hertz_law, hertz_time
from generated.contact_law import indentation
from generated.impact import impact

VARIABLE = "PLATECONTACT_TOOLS"
LIMIT = 120
"""Time limit for a program [s]."""

FAR = 1e20
"""Half-thickness and radius of the plate over the contact radius, for the generated code."""


@dataclass(frozen=True)
class Tool:
    """The result of a program for a problem.

    Attributes
    ----------
    name, version
        The program.
    problem, setting
        The problem, and the settings.
    error, seconds
        Relative error, and time of one result [s].
    cannot
        The parts of the contact of a sphere and a plate that it cannot compute.
    missing
        Why it is not available, if it is not.
    """

    name: str
    version: str = ""
    problem: str = ""
    setting: str = ""
    error: float | None = None
    seconds: float | None = None
    cannot: str = ""
    missing: str | None = None


def tools() -> list[Tool]:
    """Return the results of every program, and of the generated code for the same problems."""
    return own() + [row for name in half_space.PROGRAMS for row in run(name, os.environ)]


def run(name: str, environment: Mapping[str, str]) -> list[Tool]:
    """Return the results of one program; SciPy runs in this Python."""
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


def own() -> list[Tool]:
    """Return the results of the generated code for the same problems."""
    far = Regime("half-space", 1.0, 0.1 * FAR, 0.1 * FAR, 0.0, 0.0, 1.0)
    r, a, made = far, 0.1, f"h = b = {FAR:g} a"
    depth, law = _timed(lambda: float(indentation(a, r.R, r.h, r.b)))
    lasted, motion = _timed(
        lambda: float(impact(r.R, r.m, r.speed, r.h, r.b, r.lam, r.mu).contact_time)
    )
    off = [
        abs(depth / hertz_law(r, DOUBLE)(a) - 1), abs(lasted / hertz_time(r, DOUBLE)(r.speed) - 1)
    ]  # fmt: skip
    return [
        Tool("platecontact", "", "indentation of a half-space", made, float(off[0]), law,
             "pressure other than Hertz's"),
        Tool("platecontact", "", "contact time on a half-space", made, float(off[1]), motion,
             "motion of the plate itself"),
    ]  # fmt: skip


def _timed(call: Callable[[], float]) -> tuple[float, float]:
    times = []
    for _ in range(50):
        begin = time.perf_counter()
        value = call()
        times.append(time.perf_counter() - begin)
    return value, float(np.quantile(times, 0.25))
