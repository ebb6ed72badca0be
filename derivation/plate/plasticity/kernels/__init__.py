"""Modules of the elastic-plastic contact for the generated package."""

from pathlib import Path

from derivation.engine.emit.modules import Numbers, Routines
from derivation.engine.emit.tables import Constant
from derivation.plate.modules import ComputedModule, RuntimeModule
from derivation.plate.plasticity.kernels import fully_plastic, hertz, printed
from derivation.plate.plasticity.theory.contact import ONSET
from derivation.plate.plasticity.theory.fully_plastic import FULLY_PLASTIC

RUNTIME = Path(__file__).parents[1] / "runtime"


def plasticity_numbers() -> Numbers:
    """Return the limit of the pressure, and its largest value beyond the model."""
    limit = Constant(
        "YIELD_LIMIT", float(ONSET), "Largest contact pressure over the smaller yield stress."
    )
    risen = Constant(
        "FULLY_PLASTIC",
        float(FULLY_PLASTIC),
        "Mean pressure of a fully plastic contact over the yield stress.",
    )
    return Numbers("plasticity_numbers", "Constants of elastic-plastic contact.", (limit, risen))


def plasticity_kernels() -> Routines:
    """Return the routines of the elastic-plastic contact."""
    imports = {"ranges": ("moderate", "product", "root_factors")}
    title = "Formulas of the elastic-plastic contact, proved equal to those of the theory."
    made = (*printed.ROUTINES, *hertz.ROUTINES, *fully_plastic.ROUTINES)
    return Routines("plasticity_kernels", title, tuple(make() for make in made), imports)


MODULES = (
    ComputedModule("plasticity_numbers", plasticity_numbers),
    ComputedModule("plasticity_kernels", plasticity_kernels),
    RuntimeModule("plasticity", RUNTIME / "plasticity.py"),
)
