"""Constant of the viscous contact: the first coefficient of its restitution."""

import flint

from derivation.mathematics.bessel.kernels import nearest_double
from derivation.plate.contact.kernels.moments import BITS
from derivation.plate.viscosity.theory import loss_ball


def viscosity_context() -> dict[str, object]:
    """What the template of the viscous contact needs, numbers as text."""
    with flint.ctx.workprec(BITS):
        return {"loss": repr(nearest_double(loss_ball(40)))}
