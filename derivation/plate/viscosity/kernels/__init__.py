"""Modules of the viscoelastic contact for the generated package."""

from pathlib import Path

import flint

from derivation.engine.emit.modules import Numbers, Routines
from derivation.engine.emit.routine import SCALARS
from derivation.engine.emit.tables import Constant
from derivation.mathematics.bessel.kernels import nearest_double
from derivation.plate.contact.kernels.moments import BITS
from derivation.plate.modules import ComputedModule, RuntimeModule
from derivation.plate.viscosity.kernels.printed import BODIES, BOUNDS, ROUTINES
from derivation.plate.viscosity.theory.contact import loss_ball

RUNTIME = Path(__file__).parents[1] / "runtime"


def viscosity_numbers() -> Numbers:
    """Return the first coefficient of the restitution."""
    with flint.ctx.workprec(BITS):
        loss = nearest_double(loss_ball(40))
    constant = Constant("LOSS", loss, "(4/5)^(2/5) B(3/5, 3/2), coefficient of the restitution.")
    return Numbers("viscosity_numbers", "Constant of the viscoelastic contact.", (constant,))


def viscosity_kernels() -> Routines:
    """Return the routines of the viscoelastic contact."""
    imports = {
        "ranges": ("moderate", "product", "root_factors"),
        "viscosity_numbers": ("LOSS",),
    }
    title = "Formulas of the viscoelastic contact, proved equal to those of the theory."
    return Routines("viscosity_kernels", title, tuple(make() for make in ROUTINES), imports)


def viscosity_bounds() -> Routines:
    """Return the bounds of the effect of viscosity, for single numbers."""
    title = "Bounds of the effect of viscosity on an impact, proved in the theory."
    return Routines("viscosity_bounds", title, tuple(make() for make in BOUNDS), {}, SCALARS)


def viscous_bodies() -> Routines:
    """Return the retardation time of a contact from those of the bodies, for single numbers."""
    title = "Retardation time of a contact from those of its bodies, proved in the theory."
    return Routines("viscous_bodies", title, tuple(make() for make in BODIES), {}, SCALARS)


MODULES = (
    ComputedModule("viscosity_numbers", viscosity_numbers),
    ComputedModule("viscosity_kernels", viscosity_kernels),
    ComputedModule("viscosity_bounds", viscosity_bounds),
    ComputedModule("viscous_bodies", viscous_bodies),
    RuntimeModule("viscosity", RUNTIME / "viscosity.py"),
)
