"""Routines of damping for the generated package: motion and energy loss without cancellation.

`phase` is omega t of the undamped oscillator.
"""

import sympy as sp
from sympy.codegen.cfunctions import expm1

from derivation.engine.emit.modules import Routines
from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import (
    GUARDED,
    RAISED,
    Choice,
    Facts,
    Let,
    Routine,
    Several,
    routine,
)
from derivation.plate.damping.theory import POWER, ROOT, by_phase, free_motion, response_factors
from derivation.plate.modules import ComputedModule
from derivation.plate.vocabulary import omega, q_j, q_rate, t, zeta

phase, root, turn, decay_exponent, decay = sp.symbols(
    "phase root turn decay_exponent decay", positive=True
)
half, sine, cosine, growth, double = sp.symbols("half sine cosine growth double", positive=True)
swing, speed = sp.symbols("swing speed", real=True)
TURNED, SPENT = sp.Rational(1, 2), sp.Rational(1, 8)
"""Limits of the series; beyond them the closed forms are accurate."""
MEANING: Facts = {phase: omega * t}
BEGIN = (
    Let(root, sp.sqrt((1 - zeta) * (1 + zeta)), means=ROOT),
    Let(turn, root * phase),
    Let(decay_exponent, zeta * phase),
)


def _series(
    function: sp.Expr, variable: sp.Symbol, begin: int, step: int, end: int
) -> list[sp.Expr]:
    """Return the coefficients of a function's power series."""
    series = sp.series(function, variable, 0, end).removeO()
    return [series.coeff(variable, power) for power in range(begin, end, step)]


def _reduced(expression: sp.Expr) -> sp.Expr:
    """Replace half angles and shifted exponentials by whole ones."""
    reduced = expression.replace(expm1, lambda x: sp.exp(x) - 1)
    reduced = reduced.replace(
        lambda e: e.is_Pow and e.exp.is_Rational and e.exp.q == 2,
        lambda e: sp.expand(e.base) ** e.exp,
    )
    angle = omega * ROOT * t
    reduced = reduced.subs(sp.sin(angle / 2) ** 2, (1 - sp.cos(angle)) / 2)
    return by_phase(reduced)


def free() -> Routine:
    """Return the routine of the free motion from an initial displacement, and from a velocity."""
    late, later, decayed, less = sp.symbols("late later decayed less", positive=True)
    y = sp.Symbol("y", positive=True)
    of_turn = _series(1 - sp.sin(y) / y, y, 2, 2, 18)
    of_spent = _series(1 - (1 + y) * sp.exp(-y), y, 2, 1, 13)
    moved = free_motion()
    square = turn * turn
    return routine(
        "free_motion",
        (phase, zeta),
        (
            *BEGIN,
            Let(decay, sp.exp(-decay_exponent)),
            Let(half, sp.sin(turn / 2)),
            Let(sine, sp.sin(turn)),
            Several(
                (later,),
                "polynomial",
                (GUARDED(square, TURNED**2), *of_turn),
                ((1 - sp.sin(turn) / turn) / square,),
            ),
            Choice(late, sp.Lt(turn, TURNED), square * later, 1 - sine / RAISED(turn, TURNED)),
            Several(
                (less,),
                "polynomial",
                (GUARDED(decay_exponent, SPENT), *of_spent),
                ((1 - (1 + decay_exponent) * sp.exp(-decay_exponent)) / decay_exponent**2,),
            ),
            Choice(
                decayed,
                sp.Lt(decay_exponent, SPENT),
                decay_exponent * decay_exponent * less,
                -expm1(-decay_exponent) - decay_exponent * decay,
            ),
        ),
        (
            -(decay * (2 * half**2 + decay_exponent * late) + decayed),
            expm1(-decay_exponent) - decay * late,
            -decay * sine / root,
            decay * (1 - 2 * half**2 - zeta / root * sine),
        ),
        (
            sp.diff(moved.q, q_j) - 1,
            sp.diff(moved.q, q_rate) / t - 1,
            sp.diff(moved.rate, q_j) / omega,
            sp.diff(moved.rate, q_rate),
        ),
        "Return q/q_0 - 1, q/(t q_0') - 1, q'/(omega q_0), q'/q_0' for q_0 or q_0' alone.",
        MEANING,
        _reduced,
    )


@named_routine
def response() -> Claims:
    """Return the factors of t in omega g(t - s) and in g'(t - s), and those of s in both."""
    of = response_factors()
    return Claims(
        (phase, zeta),
        (
            *BEGIN,
            Let(decay, sp.exp(-decay_exponent)),
            Let(growth, sp.exp(decay_exponent)),
            Let(cosine, sp.cos(turn)),
            Let(sine, sp.sin(turn)),
        ),
        (
            decay * sine / root,
            decay * cosine / root,
            decay * (cosine - zeta / root * sine),
            decay * (sine + zeta / root * cosine),
            growth * cosine,
            growth * sine,
        ),
        (*of.moved, *of.rate, *of.drive),
        MEANING,
        _reduced,
    )


@named_routine
def free_by_response() -> Claims:
    """Return q/q_0 - 1 and q/(t q_0') - 1, except at small phases, from factors of `response`.

    `moved` and `rate` are its first and third result.
    """
    of, free = response_factors(), free_motion()
    moved, rate = sp.symbols("moved rate", real=True)
    return Claims(
        (phase, zeta, moved, rate),
        (),
        (rate + 2 * zeta * moved - 1, moved / phase - 1),
        (sp.diff(free.q, q_j) - 1, sp.diff(free.q, q_rate) / t - 1),
        {**MEANING, moved: of.moved[0], rate: of.rate[0]},
        _reduced,
    )


@named_routine
def free_loss() -> Claims:
    """Return the energy loss per mass of a free motion, swing = omega q_0 and speed = q_0'."""
    B, even, odd, fading = sp.symbols("B even odd fading")
    return Claims(
        (phase, zeta, swing, speed),
        (
            *BEGIN,
            Let(B, (swing + zeta * speed) / root),
            Let(even, (speed - B) * (speed + B)),
            Let(odd, 2 * speed * B),
            Let(fading, sp.exp(-2 * decay_exponent)),
            Let(half, sp.sin(turn)),
            Let(cosine, expm1(-2 * decay_exponent) - 2 * fading * half**2),
            Let(sine, fading * sp.sin(2 * turn)),
            Let(
                double,
                root * (even * sine + odd * cosine) - zeta * (even * cosine - odd * sine),
            ),
        ),
        (zeta / 2 * double - (speed * speed + B * B) / 2 * expm1(-2 * decay_exponent),),
        (free_motion().lost.subs(q_j, swing / omega).subs(q_rate, speed),),
        MEANING,
        _reduced,
    )


def power() -> Routine:
    """Return the rate of energy loss of a moving oscillator."""
    taken = (2 * zeta * omega * q_rate * q_rate,)
    summary = "Return the energy loss per mass and time of an oscillator."
    return routine("power_lost", (omega, zeta, q_rate), (), taken, (POWER,), summary, {})


ROUTINES = free, response, free_by_response, power, free_loss


def damping_kernels() -> Routines:
    """Return the routines of the damped oscillator."""
    title = "Damped oscillators: free motion, response to a force, and energy loss."
    made = tuple(make() for make in ROUTINES)
    return Routines("damping_kernels", title, made, {"blocks": ("polynomial",)})


MODULES = (ComputedModule("damping_kernels", damping_kernels),)
