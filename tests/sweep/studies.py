"""A scene that is fast to simulate, and helpers that run and inspect a sweep."""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import platecontact as pc

from derivation.engine.files import ROOT
from derivation.sweep.store import FILE

QUICK = ROOT / "derivation" / "scene" / "examples" / "paper.toml"
UNIFORM = {"distribution": "uniform", "low": 0.15, "high": 0.25}
NORMAL = {"distribution": "normal", "mean": 1.0, "std": 0.1}


def scene() -> Any:
    """Return the scene."""
    return pc.load(QUICK)


def begin(*arguments: str) -> "subprocess.Popen[str]":
    """Start the command `sweep` for the scene in a separate process."""
    command = [sys.executable, "-m", "derivation.cli", "sweep", str(QUICK), *arguments]
    return subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=ROOT,
        env=os.environ | {"PYTHONPATH": str(ROOT)}, start_new_session=True,
    )  # fmt: skip


def parts(out: Path) -> list[Path]:
    """Return the files of finished batches that belong to an output file."""
    return sorted(out.with_name(f"{out.name}.parts").glob("*.parquet"))


def counts(out: Path, size: int) -> np.ndarray:
    """Count the finished batches that contain each point."""
    actual = np.zeros(size, dtype=int)
    for path in parts(out):
        known = FILE.fullmatch(path.name)
        assert known
        actual[int(known[1]) : int(known[2])] += 1
    return actual


def journal(out: Path, size: int) -> np.ndarray:
    """Count from the journal how often each point was computed and stored."""
    actual = np.zeros(size, dtype=int)
    for line in (out.with_name(f"{out.name}.parts") / "journal.txt").read_text().splitlines():
        start, stop, computed, *_ = line.split()
        assert int(computed) == int(stop) - int(start)
        actual[int(start) : int(stop)] += 1
    return actual
