"""Evanescent amplitude c of a mode, ratio of face to mean deflection, modal weight, and stress.

With J1 = q J0 the kinetic energy over J0^2 is a function of q. In the first mode of a supported
plate, whose k vanishes at nu = -1, all terms are positive for k < j_1 of

    w = c V(k2^2) - V(-k^2),   V(y) = I0(sqrt(y)) - I0(r sqrt(y)).
"""

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Let, Several
from derivation.engine.formula.proof import lower_bessel
from derivation.plate.edge_modes.kernels.states import (
    NAMES,
    bending_part,
    c,
    j0,
    j1,
    k,
    left,
    less,
    mean,
    q,
    t,
    turned,
)
from derivation.plate.edge_modes.theory import mindlin
from derivation.plate.edge_modes.theory import waves as theory
from derivation.plate.edge_modes.theory.mindlin import k_2
from derivation.plate.vocabulary import eta, k_n, nu
from derivation.plate.waves.theory.wave_stress import MODE, S_A

r = sp.Symbol("r", positive=True)
scaled, turn, partner, y = sp.symbols("scaled turn partner y", real=True)
growth, growth_2, short, short_2 = sp.symbols("growth growth_2 short short_2", real=True)
series, series_2, kinetic, part_stress = sp.symbols(
    "series series_2 kinetic part_stress", real=True
)
FADED = theory.I0 * sp.exp(-k_2)
"""I0 e^(-k2)."""
PART = j0 / scaled * sp.exp(-k_2)
_NORM = theory.NORM.subs(mindlin.c, theory.PART)


@named_routine
def first_part() -> Claims:
    """Return c in terms of I0 e^(-k2)."""
    return Claims((j0, scaled, k_2), (), (PART,), (theory.PART,), {j0: theory.J0, scaled: FADED})


def _weight_of(kinetic: sp.Expr) -> sp.Expr:
    return theory.WEIGHT.subs({theory.N: kinetic, theory.t: theory.FACE, mindlin.c: theory.PART})


@named_routine
def weight() -> Claims:
    """Return c, t and W."""
    total, of_w, of_psi = sp.symbols("total of_w of_psi", real=True)
    square = 1 + (q**2 - left * (k * mean / 2) ** 2) / 2 - 2 * (q / k + left * mean / 2) / total
    turning = (
        bending_part**2 * (1 + q**2 - 2 * q / k) / 2
        + (turned * k) ** 2 * (mean**2 / 4 - less) / 2
        + 2 * bending_part * turned * (q / k - mean / 2) / total
    )
    norm = of_w + turn * of_psi
    value = ((1 - c * t) / j0) ** 2 * (1 + turn * bending_part**2) / (2 * sp.pi * norm)
    at_mode = {theory.J1: q * theory.J0}
    return Claims(
        (k, eta, nu, left, bending_part, turned, mean, less, scaled, k_2, q, j1),
        (
            Let(j0, j1 / q),
            Let(c, PART),
            Let(total, 1 + left),
            Let(turn, (k * eta) ** 2 / 3),
            Let(of_w, square, "of w, over J0^2"),
            Let(of_psi, turning, "of psi"),
            Let(t, 1 + theory.BULGE * turn * total),
        ),
        (c, t, value),
        (theory.PART, theory.FACE, _weight_of(_NORM).subs(at_mode)),
        {**NAMES, j1: q * theory.J0, scaled: FADED},
    )


@named_routine
def energy() -> Claims:
    """Return (w^2 + (eta^2/3) psi^2) r."""
    w, psi = sp.symbols("w psi", real=True)
    turning = mindlin.rotation(theory.g_1, theory.g_2)
    stated = (mindlin.DEFLECTION**2 + eta**2 / 3 * turning**2) * r
    inner = sp.besselj(0, k_n * r), sp.besseli(0, k_2 * r)
    means = [2 * f / z for f, z in (
        (sp.besselj(1, k_n * r), k_n * r), (sp.besseli(1, k_2 * r), k_2 * r)
    )]  # fmt: skip
    return Claims(
        (k, eta, r, c, left, bending_part, turned),
        (
            Let(y, -(k**2)),
            Let(partner, k**2 * left, "k2^2"),
            Several((growth,), "grown", (y, r), (theory.J0 - inner[0],)),
            Several((growth_2,), "grown", (partner, r), (theory.I0 - inner[1],)),
            Several((short,), "odd", (y * r**2,), (means[0],)),
            Several((short_2,), "odd", (partner * r**2,), (means[1],)),
            Let(w, c * growth_2 - growth),
            Let(psi, k**2 * r / 2 * (bending_part * short + c * turned * short_2)),
        ),
        ((w**2 + eta**2 / 3 * psi**2) * r,),
        (stated.subs(mindlin.c, theory.PART),),
        NAMES,
        lower_bessel,
    )


@named_routine
def first_weight() -> Claims:
    """Return t and W of the first mode of a supported plate."""
    bulge, axis = sp.symbols("bulge axis", real=True)
    less_one = (theory.J0 - 1) / -(k_n**2), (theory.I0 - 1) / k_2**2
    return Claims(
        (k, eta, nu, left, bending_part, c, kinetic),
        (
            Let(partner, k**2 * left, "k2^2"),
            Several((series,), "even_beyond", (-(k**2),), less_one[:1]),
            Several((series_2,), "even_beyond", (partner,), less_one[1:]),
            Let(growth, k**2 * series, "1 - J0"),
            Let(growth_2, partner * series_2, "I0 - 1"),
            Let(turn, (k * eta) ** 2 / 3),
            Let(bulge, theory.BULGE * turn * (1 + left), "t - 1"),
            Let(axis, (growth_2 + growth) / (1 + growth_2) - c * bulge, "1 - c t"),
        ),
        (1 + bulge, axis**2 * (1 + turn * bending_part**2) / (2 * sp.pi * kinetic)),
        (theory.FACE, _weight_of(theory.N)),
        {**NAMES, kinetic: theory.N},
    )


@named_routine
def mode_stress() -> Claims:
    """Return h/mu times the stress of a mode on the back face, over its deflection, from S_a."""
    return Claims(
        (part_stress, bending_part, turned, c, t),
        (),
        (part_stress * (1 + c * turned / bending_part) / (1 - c * t),),
        (MODE.subs({theory.t: theory.FACE, mindlin.c: theory.PART}),),
        {**NAMES, part_stress: S_A},
    )


ROUTINES = (first_part, weight, energy, first_weight, mode_stress)
