"""Modules of the waves for the generated package."""

from pathlib import Path

from derivation.engine.emit.modules import Routines
from derivation.plate.modules import ComputedModule, RuntimeModule
from derivation.plate.waves.kernels import (
    any_frequency,
    lowest_branch,
    residues,
    static_fraction,
    wave_stress,
)
from derivation.plate.waves.kernels.numbers import numbers

RUNTIME = Path(__file__).parents[1] / "runtime"


def wave_kernels() -> Routines:
    """Return the routines of stiffness, residues, the lowest branch and stresses."""
    parts = any_frequency, residues, lowest_branch, static_fraction, wave_stress
    made = [make for part in parts for make in part.ROUTINES]
    functions = "compared", "differences", "double", "fading", "hyperbolic", "least"
    imports = {
        "wave_functions": (*functions, "series", "shc", "slope", "tanhc"),
        "wave_numbers": ("NEAR",),
        "blocks": ("sinh_minus", "sinh_plus"),
    }
    title = "Waves of a plate: stiffness, residues, the lowest branch, and stresses."
    return Routines("wave_kernels", title, tuple(make() for make in made), imports)


MODULES = (
    ComputedModule("wave_numbers", numbers),
    ComputedModule("wave_kernels", wave_kernels),
    RuntimeModule("wave_functions", RUNTIME / "wave_functions.py"),
    RuntimeModule("inertia", RUNTIME / "inertia.py"),
    RuntimeModule("plate_waves", RUNTIME / "plate_waves.py"),
)
