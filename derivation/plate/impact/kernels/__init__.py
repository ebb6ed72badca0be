"""Modules of the impact for the generated package."""

from pathlib import Path

from derivation.engine.emit.modules import Routines
from derivation.engine.emit.routine import SCALARS
from derivation.plate.impact.kernels import scene_laws, simple, simple_laws
from derivation.plate.impact.kernels.inversion import reversed_kernels
from derivation.plate.impact.kernels.motion import impact_kernels
from derivation.plate.impact.kernels.numbers import impact_numbers
from derivation.plate.impact.kernels.perturbation import motion_kernels, perturbation_kernels
from derivation.plate.modules import ComputedModule, RuntimeModule

RUNTIME = Path(__file__).parents[1] / "runtime"


def simple_impact_kernels() -> Routines:
    """Return the routines of the impact by Hertz's law and by its first correction."""
    title = "An impact by Hertz's law and by its first correction: formulas of single numbers."
    names = [part.name for part in simple.numbers().constants]
    made = tuple(make() for make in simple_laws.ROUTINES)
    imports = {"simple_impact_numbers": tuple(names)}
    return Routines("simple_impact_kernels", title, made, imports, SCALARS)


def scene_law_kernels() -> Routines:
    """Return the contact laws of the code of one scene."""
    made = tuple(make() for make in scene_laws.ROUTINES)
    return Routines("scene_laws", "Contact laws as the code of one scene needs them.", made, {})


def scene_impact_kernels() -> Routines:
    """Return the impact of the code of one scene, for single numbers."""
    title = "Impact by Hertz's law as the code of one scene needs it."
    imports = {"simple_impact_numbers": ("HERTZ_TIME",)}
    return Routines("scene_impact", title, (scene_laws.hertz_impact(),), imports, SCALARS)


MODULES = (
    ComputedModule("reversed_kernels", reversed_kernels),
    RuntimeModule("reversed_series", RUNTIME / "reversed_series.py"),
    ComputedModule("impact_numbers", impact_numbers),
    ComputedModule("impact_kernels", impact_kernels),
    RuntimeModule("impact_shapes", RUNTIME / "impact_shapes.py"),
    RuntimeModule("impact", RUNTIME / "impact.py"),
    ComputedModule("simple_impact_numbers", simple.numbers),
    ComputedModule("simple_impact_kernels", simple_impact_kernels),
    RuntimeModule("simple_impact", RUNTIME / "simple_impact.py"),
    ComputedModule("scene_laws", scene_law_kernels),
    ComputedModule("scene_impact", scene_impact_kernels),
    ComputedModule("motion_kernels", motion_kernels),
    ComputedModule("perturbation_kernels", perturbation_kernels),
    RuntimeModule("perturbation", RUNTIME / "perturbation.py"),
)
