"""Modules of the effects for the generated package."""

from pathlib import Path

from derivation.engine.emit.modules import Routines
from derivation.plate.effects.kernels import half_space, printed
from derivation.plate.effects.kernels.numbers import effect_numbers
from derivation.plate.modules import ComputedModule, RuntimeModule

RUNTIME = Path(__file__).parents[1] / "runtime"


def effect_kernels() -> Routines:
    """Return the routines of the effects."""
    imports = {
        "blocks": ("polynomial",),
        "effect_numbers": ("PERIOD", "ZENER"),
        "ranges": ("moderate", "product", "root_factors"),
    }
    title = "Formulas of single effects, proved equal to those of the theory."
    made = (*printed.ROUTINES, *half_space.ROUTINES)
    return Routines("effect_kernels", title, tuple(make() for make in made), imports)


MODULES = (
    ComputedModule("effect_numbers", effect_numbers),
    ComputedModule("effect_kernels", effect_kernels),
    RuntimeModule("effects", RUNTIME / "effects.py"),
)
