"""Printed functions of the plate's modes, and the constants that they need."""

from pathlib import Path

from derivation.plate.modes.kernels.shares import shares
from derivation.plate.modules import ComputedModule, RuntimeModule

RUNTIME = Path(__file__).parents[1] / "runtime"

MODULES = (
    RuntimeModule("mode_sums", RUNTIME / "mode_sums.py"),
    ComputedModule("mode_shares", shares),
)
