"""What the pressure hands in for the generated package."""

from pathlib import Path

from derivation.engine.emit.package import Routines
from derivation.plate.modules import ComputedModule, RuntimeModule
from derivation.plate.pressure.kernels.numbers import pressure_numbers
from derivation.plate.pressure.kernels.printed import ROUTINES

RUNTIME = Path(__file__).parents[1] / "runtime"


def pressure_kernels() -> Routines:
    """The kernel's waves and the profile of the sphere, printed."""
    title = "Waves of the kernel of a contact, and the profile of the sphere."
    imports = {"pressure_numbers": ("LOW",)}
    return Routines("pressure_kernels", title, tuple(make() for make in ROUTINES), imports)


MODULES = (
    ComputedModule("pressure_numbers", pressure_numbers),
    ComputedModule("pressure_kernels", pressure_kernels),
    RuntimeModule("non_hertzian_pressure", RUNTIME / "non_hertzian_pressure.py"),
)
