"""A clamp: what it takes from the law and from the slope, and how much at most."""

from functools import partial

import sympy as sp

from derivation.engine.emit.routine import Facts, Let, Routine, Several, Statement, routine
from derivation.plate.edge.kernels.supported import in_ratio, n
from derivation.plate.edge.theory.clamped import (
    HERTZ_MEAN,
    SHEAR,
    clamp_bound,
    clamp_law,
    depth_lost,
    turn,
)
from derivation.plate.edge.theory.supported import RATIO
from derivation.plate.vocabulary import Formula, alpha, eta

chi, lost, inverse, wide, bending, thinned, scale = sp.symbols(
    "chi lost inverse wide bending thinned scale", real=True
)
PUNCH_MEAN = sp.Rational(2, 3)
"""Mean of r^2/a^2 under a flat punch, which the slope's load is that of."""
MEANING: Facts = {n: RATIO}


def _by_horner(expression: sp.Expr) -> sp.Expr:
    """In n, its denominator by Horner's rule."""
    above, below = sp.fraction(sp.together(in_ratio(expression)))
    return above / sp.horner(below, n)


def rotation() -> Routine:
    """chi: how a clamped edge turns."""
    return routine(
        "turn_of_clamp",
        (n,),
        (),
        (_by_horner(turn()),),
        (turn(),),
        "chi, by which a clamped edge turns under its moment: psi = chi eta psi'.",
        MEANING,
        in_ratio,
    )


def depth() -> Routine:
    """s over eta, 1 - 2 G in one piece."""
    level, rate = sp.symbols("level rate", real=True)
    twice = 1 - depth_lost() / (2 * RATIO * eta**2)
    return routine(
        "depth_lost",
        (eta, n),
        (Let(level, 1 - _by_horner(twice)), Let(rate, 2 * n * level)),
        (eta * rate,),
        (depth_lost() / eta,),
        "s/eta, s being what the bending state of a clamped plate is less deep by.",
        MEANING,
        in_ratio,
    )


def _parts() -> tuple[Statement, ...]:
    """What the law and its bound are made of."""
    return (
        Let(inverse, 1 / eta),
        Several((lost,), "depth_lost", (eta, n), (depth_lost() / eta,)),
        Several((chi,), "turn_of_clamp", (n,), (turn(),)),
        Let(thinned, sp.Rational(16, 3) * n**2),
    )


REST = SHEAR + thinned * eta
"""Of the end's shear and of stretching."""


def law(name: str, formula: int, spread: sp.Rational, times: sp.Rational) -> Routine:
    """What a clamp adds, by the mean of r^2/a^2 under the load."""
    taken: Formula = clamp_law()[formula]
    return routine(
        name,
        (alpha, eta, n),
        (
            *_parts(),
            Let(wide, 1 - spread * alpha**2),
            Let(bending, (inverse - lost) * (wide * inverse - lost) * inverse),
            Let(scale, -times / (8 * sp.pi)),
        ),
        (scale * alpha * (bending + 2 * chi * wide * inverse**2 + REST),),
        (-taken.expression,),
        f"What a clamp adds to {'the slope' if formula else 'delta R/a^2'}.",
        MEANING,
        in_ratio,
    )


def bound() -> Routine:
    """The bound of the slope."""
    left = sp.Symbol("left", real=True)
    return routine(
        "clamp_bound",
        (alpha, eta, n),
        (
            *_parts(),
            Let(left, inverse - lost),
            Let(bending, (left * left + inverse * (sp.Abs(left) - left) / 3) * inverse),
            Let(scale, 3 / (16 * sp.pi)),
        ),
        (scale * alpha * (bending + 2 * chi * inverse**2 + REST),),
        (clamp_bound().expression,),
        "Bound of what a clamp takes from the slope, for every contact up to this one.",
        MEANING,
        in_ratio,
    )


ROUTINES = (
    rotation,
    depth,
    partial(law, "of_clamp", 0, HERTZ_MEAN, sp.Integer(1)),
    partial(law, "slope_of_clamp", 1, PUNCH_MEAN, sp.Rational(3, 2)),
    bound,
)
