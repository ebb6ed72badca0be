"""What the plasticity hands in for the generated package."""

from pathlib import Path

from derivation.engine.emit.package import Numbers, Routines
from derivation.engine.emit.tables import Constant
from derivation.plate.modules import ComputedModule, RuntimeModule
from derivation.plate.plasticity.kernels.printed import ROUTINES
from derivation.plate.plasticity.theory.contact import ONSET

RUNTIME = Path(__file__).parents[1] / "runtime"


def plasticity_numbers() -> Numbers:
    """The limit of the pressure."""
    limit = Constant(
        "YIELD_LIMIT", float(ONSET), "Largest contact pressure over the smaller yield stress."
    )
    return Numbers("plasticity_numbers", "Number of the yielding contact.", (limit,))


def plasticity_kernels() -> Routines:
    """The yielding contact's formulas, printed."""
    imports = {"ranges": ("moderate", "product", "root_factors")}
    title = "Formulas of the yielding contact, proved equal to what the theory derives."
    return Routines("plasticity_kernels", title, tuple(make() for make in ROUTINES), imports)


MODULES = (
    ComputedModule("plasticity_numbers", plasticity_numbers),
    ComputedModule("plasticity_kernels", plasticity_kernels),
    RuntimeModule("plasticity", RUNTIME / "plasticity.py"),
)
