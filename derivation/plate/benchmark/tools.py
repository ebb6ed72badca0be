"""What other tools make of the parts of the problem they can do, in an interpreter of their own.

None computes a plate with an edge: they are held to a half-space, on which Hertz's formulas
are exact, and so is the generated code, with h and b so large that the plate's share is below
rounding. The scripts in `tools/` import nothing of this project; `PLATECONTACT_TOOLS` names
the Python that runs them.
"""

import json
import math
import os
import subprocess
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from derivation.plate.benchmark.motion import HERTZ_TIME
from generated.contact_law import indentation
from generated.impact import impact

VARIABLE = "PLATECONTACT_TOOLS"
SCRIPTS = Path(__file__).parent / "tools"
LIMIT = 120
"""Time after which a tool is given up [s]."""

FAR = 1e20
"""Half-thickness and radius of the plate over the contact radius, for the generated code."""


@dataclass(frozen=True)
class Tool:
    """What a tool did with a problem.

    Attributes
    ----------
    name, version
        The tool.
    problem, setting
        What it computed, and how.
    error, seconds
        Relative error, and time of one result [s].
    cannot
        What it cannot do of the contact of a sphere and a plate.
    missing
        Why it is not here, if it is not.
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
    """Every tool's results, and the generated code's on the same problems."""
    found = [*own()]
    for script in sorted(SCRIPTS.glob("*.py")):
        found += run(script, os.environ)
    return found


def run(script: Path, environment: Mapping[str, str]) -> list[Tool]:
    """One tool's results."""
    name, python = script.stem.replace("_", " "), environment.get(VARIABLE)
    if python is None:
        return [Tool(name, missing=f"not installed: {VARIABLE} names no Python that has it")]
    try:
        done = subprocess.run(
            [python, str(script)], capture_output=True, text=True, timeout=LIMIT, check=False
        )
    except OSError as error:
        return [Tool(name, missing=f"not installed: {python}: {error.strerror}")]
    except subprocess.TimeoutExpired:
        return [Tool(name, missing=f"no result within {LIMIT} s")]
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ["no message"])[-1]
        absent = "not installed: " if "ModuleNotFoundError" in last else "failed: "
        return [Tool(name, missing=absent + last)]
    return read(json.loads(done.stdout.splitlines()[-1]))


def read(data: Mapping[str, Any]) -> list[Tool]:
    """A script's JSON: name, version and cannot, and rows of problem, setting, error, seconds."""
    return [
        Tool(data["name"], data["version"], cannot=data["cannot"], **row) for row in data["rows"]
    ]


def own() -> list[Tool]:
    """The generated code on the same problems."""
    R, a = 1.0, 0.1
    far = FAR * a
    depth, law = _timed(lambda: float(indentation(a, R, far, far)))
    m, v0, lam, mu = 72.2, 1.0, 0.36e9, 0.43e9
    stiff = 16 * mu * (lam + mu) / (3 * (lam + 2 * mu)) * math.sqrt(R)
    duration = HERTZ_TIME * (1.25 * m * v0 * v0 / stiff) ** 0.4 / v0
    found, motion = _timed(lambda: float(impact(R, m, v0, far, far, lam, mu).contact_time))
    return [
        Tool(
            "platecontact", "", "indentation of a half-space", f"h = b = {FAR:g} a",
            abs(depth * R / a**2 - 1), law, "pressure other than Hertz's",
        ),
        Tool(
            "platecontact", "", "contact time on a half-space", f"h = b = {FAR:g} a",
            abs(found / duration - 1), motion, "motion of the plate itself",
        ),
    ]  # fmt: skip


def _timed(call: Any) -> tuple[float, float]:
    times = []
    for _ in range(50):
        begin = time.perf_counter()
        value = call()
        times.append(time.perf_counter() - begin)
    return value, float(np.quantile(times, 0.25))
