"""Modules of the contact law for the generated package."""

from pathlib import Path

from derivation.engine.emit.modules import Routines
from derivation.engine.emit.routine import SCALARS
from derivation.plate.contact.kernels import law, moments, sensitivities, series
from derivation.plate.contact.kernels.numbers import numbers
from derivation.plate.modules import ComputedModule, RuntimeModule

RUNTIME = Path(__file__).parents[1] / "runtime"


def contact_kernels() -> Routines:
    """Return the routines of correction, indentation and force, printed from proved expressions."""
    imports = {
        "blocks": ("hertz_shape",),
        "contact_numbers": ("CUBIC", "FAR_HALF", "FAR_MIDDLE", "LINEAR", "REACH"),
        "influence": ("G_minus_1", "G_slope"),
        "ranges": ("root", "times"),
    }
    made = (make() for part in (series, law) for make in part.ROUTINES)
    title = "Contact law of a sphere on a plate: correction, indentation, force and their slopes."
    return Routines("contact_kernels", title, tuple(made), imports)


def contact_point_kernels() -> Routines:
    """Return routines of the contact law for single numbers."""
    made = (series.with_slope_of(), *(make() for make in law.POINT_ROUTINES))
    title = "Contact law of a sphere on a plate: formulas of single, ordinary numbers."
    return Routines("contact_point_kernels", title, made, {}, SCALARS)


def sensitivity_kernels() -> Routines:
    """Return the routines of an impact's sensitivities to each parameter."""
    made = tuple(make() for make in sensitivities.ROUTINES)
    return Routines("sensitivity_kernels", "Slopes of an impact by its parameters.", made, {})


MODULES = (
    *moments.MODULES,
    ComputedModule("contact_numbers", numbers),
    ComputedModule("contact_kernels", contact_kernels),
    ComputedModule("contact_point_kernels", contact_point_kernels),
    ComputedModule("sensitivity_kernels", sensitivity_kernels),
    RuntimeModule("contact_cells", RUNTIME / "contact_cells.py"),
    RuntimeModule("contact_series", RUNTIME / "contact_series.py"),
    RuntimeModule("contact_points", RUNTIME / "contact_points.py"),
    RuntimeModule("contact_domain", RUNTIME / "contact_domain.py"),
    RuntimeModule("plate_arrays", RUNTIME / "plate_arrays.py"),
    RuntimeModule("plate_points", RUNTIME / "plate_points.py"),
    RuntimeModule("prepared_plate", RUNTIME / "prepared_plate.py"),
    RuntimeModule("contact_law", RUNTIME / "contact_law.py"),
    RuntimeModule("contact_thickness", RUNTIME / "contact_thickness.py"),
    RuntimeModule("sensitivity", RUNTIME / "sensitivity.py"),
)
