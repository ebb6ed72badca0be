"""Modules of the non-Hertzian pressure for the generated package."""

from pathlib import Path

from derivation.engine.emit.modules import Routines
from derivation.plate.modules import ComputedModule, RuntimeModule
from derivation.plate.pressure.kernels.numbers import pressure_numbers
from derivation.plate.pressure.kernels.printed import ROUTINES

RUNTIME = Path(__file__).parents[1] / "runtime"


def pressure_kernels() -> Routines:
    """Return the routines of the kernel's cosines and of the sphere's profile."""
    title = "Cosines of the kernel of the integral equation, and profile of the sphere."
    return Routines("pressure_kernels", title, tuple(make() for make in ROUTINES), {})


MODULES = (
    ComputedModule("pressure_numbers", pressure_numbers),
    ComputedModule("pressure_kernels", pressure_kernels),
    RuntimeModule("non_hertzian_pressure", RUNTIME / "non_hertzian_pressure.py"),
)
