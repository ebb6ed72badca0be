"""Stress of a free wave on the axis of the back face, over its deflection of the contact face."""

from functools import partial

import sympy as sp

from derivation.engine.emit.routine import Routine, routine
from derivation.plate.vocabulary import gam
from derivation.plate.waves.kernels.entire import (
    FIRST,
    MEANING,
    cosh_p,
    level,
    m,
    over,
    reduce,
    rest,
    sinh_p,
    x,
)
from derivation.plate.waves.kernels.lowest_branch import nu
from derivation.plate.waves.theory.dynamic_modes import p
from derivation.plate.waves.theory.wave_stress import stress


def of_wave(bends: bool) -> Routine:
    """Return S_a or S_s; (1 + nu)/(1 - nu) is 3 - 4 gam without cancellation."""
    ratio = sinh_p / cosh_p if bends else -cosh_p / (level * sinh_p)
    tanh_p = sp.tanh(p) if bends else sp.coth(p)
    return routine(
        "bending_stress" if bends else "extension_stress",
        (over, x, gam, rest, nu),
        (*FIRST[:3], FIRST[-1]),  # without those of q
        ((1 + nu) / (1 - nu) * m * ratio / 2,),
        (stress(tanh_p, bends),),
        f"Return h/mu times the stress of a wave in {'bending' if bends else 'extension'} on the "
        "back face, over its deflection.",
        {**MEANING, nu: (1 - 2 * gam) / (2 * (1 - gam))},
        reduce,
    )


ROUTINES = (partial(of_wave, True), partial(of_wave, False))
