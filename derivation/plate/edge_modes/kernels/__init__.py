"""Modules of clamped and supported plates for the generated package."""

import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path

from derivation.engine.emit.modules import Routines
from derivation.plate.budgets import read_stated_limits
from derivation.plate.edge_modes.kernels import amplitudes, edges, faces, states
from derivation.plate.edge_modes.kernels.numbers import numbers
from derivation.plate.modules import ComputedModule, RuntimeModule

RUNTIME = Path(__file__).parents[1] / "runtime"


def edge_mode_kernels() -> Routines:
    """Return the routines of waves, conditions of both edges, weights and the contact face."""
    made = [make for part in (states, edges, amplitudes, faces) for make in part.ROUTINES]
    functions = "curled", "even", "even_beyond", "grown", "logarithm_series", "odd", "punch_beyond"
    imports = {
        "bessel": ("bessel_j0",),
        "edge_mode_functions": (*functions, "ratio_series", "turn_mean", "turn_means"),
        "edge_mode_numbers": ("SMALL", "START"),
        "wave_functions": ("shc",),
    }
    title = "Modes of clamped and supported plates: waves, edges, weights, contact face."
    return Routines("edge_mode_kernels", title, tuple(make() for make in made), imports)


def _limits() -> Mapping[str, Sequence[str]]:
    """Return tested limits as lines of a docstring."""
    stated_limits = read_stated_limits("edge_modes").items()
    numbers = ", ".join(f"{name} {ulp:g}" for name, ulp in stated_limits if name != "face")
    text = (
        f"Tested error limits in units in the last place (ULP): {numbers}; for c relative to "
        "c (1 + k), for k2 to k^2/k2, for t to max(1, |t|). Half the sum of the condition "
        "numbers of eta and nu is added. A mode whose x = k eta is within a few ULP of the "
        "cut-off may be missing or present."
    )
    return dict.fromkeys(("clamped_waves", "supported_waves"), textwrap.wrap(text, 84))


MODULES = (
    ComputedModule("edge_mode_numbers", numbers),
    ComputedModule("edge_mode_kernels", edge_mode_kernels),
    RuntimeModule("edge_mode_functions", RUNTIME / "edge_mode_functions.py"),
    RuntimeModule("edge_modes", RUNTIME / "edge_modes.py", _limits),
    RuntimeModule("wave_stress", RUNTIME / "wave_stress.py"),
)
