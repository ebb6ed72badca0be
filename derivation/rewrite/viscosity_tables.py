"""Constant of the viscous contact: the first coefficient of its restitution."""

import flint

from derivation.rewrite.bessel_tables import nearest_double
from derivation.rewrite.moment_tables import BITS
from derivation.theory.viscosity import loss_ball


def viscosity_context() -> dict[str, object]:
    """What the template of the viscous contact needs, numbers as text."""
    with flint.ctx.workprec(BITS):
        return {"loss": repr(nearest_double(loss_ball(40)))}
