"""Printed functions of the plate's modes, and the constants that they need."""

from pathlib import Path

from derivation.plate.modes.kernels.contributions import contributions
from derivation.plate.modules import ComputedModule, RuntimeModule

RUNTIME = Path(__file__).parents[1] / "runtime"

MODULES = (
    RuntimeModule("mode_sums", RUNTIME / "mode_sums.py"),
    ComputedModule("mode_contributions", contributions),
)
