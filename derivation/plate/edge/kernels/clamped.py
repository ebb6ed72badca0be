"""A clamped edge: its change of the law, of the slope and of the kernel, and a bound."""

from functools import partial

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Facts, Let, Routine, Several, Statement, routine
from derivation.plate.edge.kernels.supported import in_ratio, n
from derivation.plate.edge.theory.clamped import (
    HERTZ_MEAN,
    SHEAR_TERM,
    clamp_bound,
    clamp_law,
    indentation_loss,
    turn,
)
from derivation.plate.edge.theory.curvature import N_s, edge_curvature, law_of_square
from derivation.plate.edge.theory.supported import RATIO
from derivation.plate.vocabulary import Formula, a_ratio, alpha, eta

chi, loss, inverse, wide, bending, thinning, scale, cubic = sp.symbols(
    "chi loss inverse wide bending thinning scale cubic", real=True
)
PUNCH_MEAN = sp.Rational(2, 3)
"""Mean of r^2/a^2 under a flat punch, which is the load in the slope."""
MEANING: Facts = {n: RATIO}


def _by_horner(expression: sp.Expr) -> sp.Expr:
    """Return the expression in n, with its denominator in Horner form."""
    above, below = sp.fraction(sp.together(in_ratio(expression)))
    return above / sp.horner(below, n)


@named_routine
def turn_of_clamp() -> Claims:
    """Return chi: a clamped edge under a moment has psi = chi eta psi'."""
    return Claims(
        (n,),
        (),
        (_by_horner(turn()),),
        (turn(),),
        MEANING,
        in_ratio,
    )


def depth() -> Routine:
    """Return s/eta, with 1 - 2 G as one fraction."""
    level, rate = sp.symbols("level rate", real=True)
    twice = 1 - indentation_loss() / (2 * RATIO * eta**2)
    return routine(
        "indentation_loss",
        (eta, n),
        (Let(level, 1 - _by_horner(twice)), Let(rate, 2 * n * level)),
        (eta * rate,),
        (indentation_loss() / eta,),
        "Return s/eta; s is the relative reduction of a clamped plate's bending deflection.",
        MEANING,
        in_ratio,
    )


def _parts() -> tuple[Statement, ...]:
    """Return the statements common to the law and its bound."""
    return (
        Let(inverse, 1 / eta),
        Several((loss,), "indentation_loss", (eta, n), (indentation_loss() / eta,)),
        Several((chi,), "turn_of_clamp", (n,), (turn(),)),
        Let(thinning, sp.Rational(16, 3) * n**2),
    )


REST = SHEAR_TERM + thinning * eta
"""Contribution of the shear at the edge and of extension."""


def law(name: str, formula: int, spread: sp.Rational, times: sp.Rational) -> Routine:
    """Return the change due to a clamped edge for a given mean of r^2/a^2 under the load."""
    taken: Formula = clamp_law()[formula]
    return routine(
        name,
        (alpha, eta, n),
        (
            *_parts(),
            Let(wide, 1 - spread * alpha**2),
            Let(bending, (inverse - loss) * (wide * inverse - loss) * inverse),
            Let(scale, -times / (8 * sp.pi)),
        ),
        (scale * alpha * (bending + 2 * chi * wide * inverse**2 + REST),),
        (-taken.expression,),
        f"Return the change of {'the slope' if formula else 'delta R/a^2'} by a clamped edge.",
        MEANING,
        in_ratio,
    )


def bound() -> Routine:
    """Return the bound of the slope's change."""
    left = sp.Symbol("left", real=True)
    return routine(
        "clamp_bound",
        (alpha, eta, n),
        (
            *_parts(),
            Let(left, inverse - loss),
            Let(bending, (left * left + inverse * (sp.Abs(left) - left) / 3) * inverse),
            Let(scale, 3 / (16 * sp.pi)),
        ),
        (scale * alpha * (bending + 2 * chi * inverse**2 + REST),),
        (clamp_bound().expression,),
        "Return a bound of the slope's change by a clamped edge, for all radii up to this one.",
        MEANING,
        in_ratio,
    )


@named_routine
def kernel_of_clamp() -> Claims:
    """Return the coefficient of (t^2 + s^2)/h^3 in the kernel by a clamped edge."""
    return Claims(
        (eta, n),
        (
            Several((loss,), "indentation_loss", (eta, n), (indentation_loss() / eta,)),
            Several((chi,), "turn_of_clamp", (n,), (turn(),)),
            Let(scale, sp.Rational(3, 8) / sp.pi),
        ),
        (scale * (1 + (2 * chi - loss) * eta),),
        (edge_curvature()[1].expression,),
        MEANING,
        in_ratio,
    )


def of_square() -> Routine:
    """Return the contributions of the kernel's term to the law with Hertz pressure."""
    depth, slope = law_of_square()
    return routine(
        "law_of_square",
        (N_s, a_ratio),
        (Let(cubic, N_s * a_ratio**3),),
        (2 * cubic / 15, cubic / 3),
        (depth, slope),
        "Return the contributions to delta R/a^2 and to S of N_s (t^2 + s^2)/h^3 in the kernel.",
        {},
    )


ROUTINES = (
    turn_of_clamp,
    depth,
    partial(law, "of_clamp", 0, HERTZ_MEAN, sp.Integer(1)),
    partial(law, "slope_of_clamp", 1, PUNCH_MEAN, sp.Rational(3, 2)),
    bound,
    kernel_of_clamp,
    of_square,
)
