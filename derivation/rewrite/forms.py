"""Stable forms of the formulas, each proved equal to the derived one.

Those of one dimensionless variable are found by the rules; the fields of a mode,
which depend on the depth too, are written out in `mode_forms` and proved like the rest.
"""

from collections.abc import Mapping

import sympy as sp
from sympy.codegen.cfunctions import expm1

from derivation.formula.record import Formula
from derivation.formula.symbols import P, R, T, a, mu, r
from derivation.rewrite.automatic import RATIO, automatic, core, ratio
from derivation.rewrite.blocks import blocks
from derivation.rewrite.form import Form, Seam, Step, form
from derivation.rewrite.mode_forms import mode_forms
from derivation.rewrite.sections import sections

odd, modulus, shape, slender, fade, near_share = sp.symbols(
    "odd modulus shape slender fade near_share", real=True
)


def stable_forms(formulas: Mapping[str, Formula]) -> tuple[Form, ...]:
    """The stable form of every formula that is generated, in module order.

    Raises
    ------
    ProofError
        Naming the form that is not its formula.
    UnreachableError
        Naming a formula that the rules do not reach.
    """
    known = blocks()

    def found(name: str) -> _Shape:
        return automatic(formulas[name].expression, known)

    groups: dict[str, dict[str, _Shape]] = {
        "omega": {name: found(name) for name in OMEGAS},
        "influence": {name: found(name) for name in INFLUENCE} | {"G_slope": _factor_slope()},
        "pressure": _pressure() | {name: found(name) for name in ("sonine", "A_j")},
        "mode_shapes": mode_forms(),
    }
    return tuple(
        form(name, module, formulas[name].expression, steps, value, known | sections())
        for module, group in groups.items()
        for name, (steps, value) in group.items()
    )


OMEGAS = tuple(f"Omega_{k}{tail}" for tail in ("", "_scaled") for k in range(1, 5))
INFLUENCE = ("G", "G_m", "G_minus_1", "C_top", "C_bottom", "K_j", "K_j_bottom")
AUTOMATIC = (*OMEGAS, *INFLUENCE, "sonine", "A_j")
"""Formulas whose forms the rules find."""

_Shape = tuple[tuple[Step, ...], sp.Expr | Seam]


def _factor_slope() -> _Shape:
    """T dG/dT; the rules leave T^5 below, which underflows where the value is finite."""
    known = blocks()
    product = known["sinh_minus"](T) * known["sinh_plus"](T)
    steps = (
        Step(fade, sp.exp(-T), "half of the decay, twice: neither factor underflows alone"),
        Step(odd, -expm1(-2 * T) / T, "2 e^(-T) sinh T/T"),
        Step(near_share, fade * (odd / product) ** 2),
    )
    return steps, -8 * fade * (near_share / T**3)


def _pressure() -> dict[str, _Shape]:
    """Hertz pressure and the contact force: the edge's root by its two factors."""
    edge_root = Step(shape, sp.sqrt(a - r) * sp.sqrt(a + r) / a, "1 in the centre, 0 at the edge")
    return {
        "p": ((edge_root, Step(core, P / a**2)), -3 * core * shape / (2 * sp.pi)),
        "P": (
            (RATIO, Step(modulus, 16 * mu / (3 * ratio), "(4/3) E*"), Step(slender, a / R)),
            modulus * a**2 * slender,
        ),
    }
