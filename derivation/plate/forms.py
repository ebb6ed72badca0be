"""Stable forms of the formulas, each proved equal to the derived one.

The rules find the forms of functions of one dimensionless variable. The fields of a mode, which
also depend on z, are written in `modes.kernels.forms`; all are proved.
"""

from collections.abc import Mapping

import sympy as sp

from derivation.engine.emit.package import Shape
from derivation.engine.formula.record import Record
from derivation.engine.rewrite.automatic import automatic
from derivation.engine.rewrite.every_variable import accurate
from derivation.engine.rewrite.form import TIMES, Block, Form, Step, form
from derivation.engine.rewrite.scales import Ratio, Scale, Scales
from derivation.engine.rewrite.truncated_series import truncated_series
from derivation.plate.blocks import blocks
from derivation.plate.contact.theory.hertz import SINE_MINUS
from derivation.plate.modes.kernels.forms import mode_forms
from derivation.plate.modes.kernels.steps import RATIO, ratio
from derivation.plate.modules import printed_modules
from derivation.plate.vocabulary import P, R, a, h, lam, mu, phi, r

r_over_a = sp.Symbol("r_over_a", real=True)
x, y, T = sp.symbols("x y T", positive=True)
SCALES = Scales(
    (
        Scale(phi * h, x, h, phi),
        Scale(2 * phi * h, T, h, phi),
        Scale(a * phi, y, a, phi, joined=True),
        Scale(T, T, T),
    ),
    Ratio(RATIO, lam + 2 * mu, lam + mu),
)
"""Products of symbols that the plate's functions depend on."""


def stable_forms(formulas: Mapping[str, Record]) -> tuple[Form, ...]:
    """Return the stable form of every generated formula, in the order of the modules.

    Raises
    ------
    ProofError
        Naming the form that differs from its formula.
    UnreachableError
        Naming a formula for which the rules find no form.
    """
    known = blocks()

    def accurate_shape(name: str) -> Shape:
        shape = automatic(formulas[name].expression, known, SCALES, name in CLOSE)
        accurate(formulas[name], *shape, known)
        return shape

    groups: dict[str, dict[str, Shape]] = {
        "omega": {name: accurate_shape(name) for name in OMEGAS},
        "influence": {name: accurate_shape(name) for name in INFLUENCE},
        "pressure": _pressure() | {name: accurate_shape(name) for name in ("sonine", "A_j")},
        "mode_shapes": mode_forms(),
        "modal_sum": {"delta": _indentation(formulas, known)},
    }
    for printed in printed_modules():
        groups[printed.name] = dict(printed.stated())
    return tuple(
        form(name, module, formulas[name].expression, steps, value, known | truncated_series())
        for module, group in groups.items()
        for name, (steps, value) in group.items()
    )


OMEGAS = tuple(f"Omega_{k}{tail}" for tail in ("", "_scaled") for k in range(1, 5))
INFLUENCE = ("G", "G_m", "G_minus_1", "C_top", "C_bottom", "K_j", "K_j_bottom", "G_slope")
AUTOMATIC = (*OMEGAS, *INFLUENCE, "sonine", "A_j")
"""Formulas whose forms the rules find."""

CLOSE = ("G_m",)
"""Those among them whose budget does not allow for the rounding of their powers."""


def _pressure() -> dict[str, Shape]:
    """Return forms of Hertz pressure, whose root is split into two factors, and of the force."""
    fraction = Step(r_over_a, r / a)
    root = sp.sqrt((1 - r_over_a) * (1 + r_over_a))
    return {
        "p": ((fraction,), TIMES(-3 * root / (2 * sp.pi), P, 1, a, -2)),
        "P": ((RATIO,), TIMES(16 / (3 * ratio), mu, 1, a, 3, R, -1)),
    }


def _indentation(formulas: Mapping[str, Record], known: Mapping[str, Block]) -> Shape:
    """Return one term of the indentation as K_j phi^3 times s(a phi)/phi^3; powers round once."""
    face, face_value = automatic(formulas["K_j"].expression * phi**3, known, SCALES)
    contact, contact_value = automatic(SINE_MINUS / phi**3, known, SCALES)
    core, *powers = face_value.args
    shape, *more = contact_value.args
    return (*face, *contact), TIMES(core * shape, *powers, *more)
