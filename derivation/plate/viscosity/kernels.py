"""Constant of the viscous contact: the first coefficient of its restitution."""

from pathlib import Path

import flint

from derivation.mathematics.bessel.kernels import nearest_double
from derivation.plate.contact.kernels.moments import BITS
from derivation.plate.modules import FunctionRow, TemplateModule
from derivation.plate.viscosity.theory import loss_ball


def viscosity_context() -> dict[str, object]:
    """What the template of the viscous contact needs, numbers as text."""
    with flint.ctx.workprec(BITS):
        return {"loss": repr(nearest_double(loss_ball(40)))}


FOLDER = Path(__file__).parent
MODULES = (
    TemplateModule(
        "viscosity",
        FOLDER,
        viscosity_context,
        (
            FunctionRow(
                "viscous_number",
                ("R", "m", "v0", "lam", "mu", "viscous_time"),
                "1",
                "x",
                "",
                "what a viscous contact takes of the speed",
            ),
            FunctionRow(
                "restitution_weak",
                ("x_v",),
                "1",
                "e",
                "",
                "restitution of a weakly viscous contact",
            ),
        ),
    ),
)
