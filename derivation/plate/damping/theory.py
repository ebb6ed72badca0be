"""Step 32: modes of a plate with structural damping, solved exactly for each mode.

A plate of loss factor eta_l = 2 zeta (Cremer, Heckl and Petersson, Structure-Borne Sound, 3rd
ed. 2005, ch. 4) loses 2 pi eta_l of a mode's largest potential energy in each cycle. Equivalent
viscous damping at the mode's own frequency gives the same loss at resonance and is causal, unlike
a complex modulus in the time domain:

    q'' + 2 zeta omega q' + omega^2 q = omega^2 c P.

With w = omega sqrt(1 - zeta^2) and initial values q and q' at t = 0, the response to a unit
impulse and the free motion are

    g(t) = exp(-zeta omega t) sin(w t)/w,
    q(t) = exp(-zeta omega t) [q cos(w t) + (q' + zeta omega q) sin(w t)/w],

and by Duhamel's integral a force adds omega^2 c int_0^t g(t - s) P(s) ds. The damping dissipates
2 zeta omega q'^2 of the oscillator's (q'^2 + omega^2 q^2)/2; the loss in a free motion has a closed
form. After one cycle exp(-2 pi zeta/sqrt(1 - zeta^2)) of the amplitude is left (logarithmic
decrement).
"""

from functools import cache
from typing import NamedTuple

import sympy as sp

from derivation.engine.formula.proof import Proof, prove
from derivation.plate.vocabulary import Formula, omega, q_j, q_rate, t, zeta

ROOT = sp.sqrt(1 - zeta**2)
"""Angular frequency of the damped oscillator over that of the undamped one."""
POWER = 2 * zeta * omega * q_rate**2
"""Power dissipated by damping, per modal mass."""
DECAY, COS, SIN = sp.symbols("decay cosine sine", positive=True)
_root, _since, _push = sp.symbols("root since push", positive=True)


class FreeMotion(NamedTuple):
    """Displacement and velocity of a damped oscillator, and the energy loss per mass [m^2/s^2]."""

    q: sp.Expr
    rate: sp.Expr
    lost: sp.Expr


def impulse_response() -> sp.Expr:
    """Return the displacement after a unit change of the velocity."""
    return sp.exp(-zeta * omega * t) * sp.sin(omega * ROOT * t) / (omega * ROOT)


@cache
def free_motion() -> FreeMotion:
    """Return the free motion from an initial displacement and velocity."""
    g = impulse_response()
    q = q_j * (sp.diff(g, t) + 2 * zeta * omega * g) + q_rate * g
    x = omega * q_j
    # q' is the real part of C exp((-zeta + i root) omega t); its square is integrated.
    B = (x + zeta * q_rate) / ROOT
    even, odd = q_rate**2 - B**2, 2 * q_rate * B
    fading = sp.exp(-2 * zeta * omega * t)
    cosine = fading * sp.cos(2 * omega * ROOT * t) - 1
    sine = fading * sp.sin(2 * omega * ROOT * t)
    turned = ROOT * (even * sine + odd * cosine) - zeta * (even * cosine - odd * sine)
    lost = (q_rate**2 + B**2) / 2 * (1 - fading) + zeta / 2 * turned
    return FreeMotion(q, sp.diff(q, t), lost)


def by_phase(expression: sp.Expr) -> sp.Expr:
    """Return a polynomial in exp(-zeta omega t), sin(w t) and cos(w t), zero if it vanishes."""
    expanded = sp.expand_trig(expression.subs(ROOT, _root))
    expanded = sp.expand(expanded, power_exp=False)
    phase = omega * _root * t
    expanded = expanded.replace(sp.exp, lambda x: DECAY ** sp.cancel(-x / (zeta * omega * t)))
    expanded = sp.expand(expanded.subs({sp.cos(phase): COS, sp.sin(phase): SIN}))
    expanded = sp.expand(sp.numer(sp.together(expanded)))
    expanded = sp.expand(expanded.subs(zeta**2, 1 - _root**2))
    for square, value in ((COS, 1 - SIN**2), (zeta, 1 - _root**2)):
        expanded = sp.rem(sp.Poly(expanded, square), sp.Poly(square**2 - value, square)).as_expr()
    return sp.expand(expanded)


def _equation(q: sp.Expr) -> sp.Expr:
    """Return the left side of the oscillator's equation."""
    return sp.diff(q, t, 2) + 2 * zeta * omega * sp.diff(q, t) + omega**2 * q


class ResponseFactors(NamedTuple):
    """Factors of omega g(t - s), a difference of two products, and of g'(t - s), a sum of two.

    The response at all times to a force at all times is then a product of matrices. The factors
    of s increase, but stay moderate if t is counted from a time shortly before.
    """

    moved: tuple[sp.Expr, sp.Expr]
    rate: tuple[sp.Expr, sp.Expr]
    drive: tuple[sp.Expr, sp.Expr]


@cache
def response_factors() -> ResponseFactors:
    """Return the factors of displacement, of velocity, and of the force."""
    phase, decay = omega * ROOT * t, sp.exp(-zeta * omega * t)
    cosine, sine, ratio = decay * sp.cos(phase), decay * sp.sin(phase), zeta / ROOT
    factors = ResponseFactors(
        (sine / ROOT, cosine / ROOT),
        (cosine - ratio * sine, sine + ratio * cosine),
        (sp.cos(phase) / decay, sp.sin(phase) / decay),
    )
    g, since = impulse_response(), {t: t - _since}
    first, second = (part.subs(t, _since) for part in factors.drive)
    moved = factors.moved[0] * first - factors.moved[1] * second - omega * g.subs(since)
    rate = factors.rate[0] * first + factors.rate[1] * second - sp.diff(g, t).subs(since)
    prove(
        "Separated response",
        "Both sides are written out in $t$ and $s$.",
        {
            "displacement": sp.expand(sp.expand_trig(moved).rewrite(sp.exp)),
            "velocity": sp.expand(sp.expand_trig(rate).rewrite(sp.exp)),
        },
    )
    return factors


@cache
def oscillator() -> Proof:
    """Prove the free motion and the response to an impulse by inserting them into the equation."""
    g, free = impulse_response(), free_motion()
    start = {t: 0}

    def residuals(g: sp.Expr, q: sp.Expr) -> dict[str, sp.Expr]:
        return {
            "impulse": by_phase(_equation(g)),
            "from rest": g.subs(start),
            "unit velocity": sp.diff(g, t).subs(start) - 1,
            "free": by_phase(_equation(q)),
            "displacement": sp.expand(q.subs(start) - q_j),
            "velocity": sp.simplify(sp.diff(q, t).subs(start) - q_rate),
            "undamped": sp.simplify(g.subs(zeta, 0) - sp.sin(omega * t) / omega),
        }

    # d/dt of int_0^t g(t - s) P(s) ds is g(0) P(t) + int g'(t - s) P(s) ds.
    return prove(
        "Damped oscillator",
        "Both motions are inserted into the equation and evaluated at $t = 0$. Duhamel's "
        "integral solves it, because its second derivative is $g'(0) P$ plus the integral "
        "over $g''$.",
        residuals,
        *(g, free.q),
    )


@cache
def dissipation() -> Proof:
    """Prove the energy loss by damping, for any motion and for a free one."""
    free, q = free_motion(), sp.Function("q")(t)
    rate = sp.diff(q, t)
    energy = (rate**2 + omega**2 * q**2) / 2
    driven = _push - 2 * zeta * omega * rate - omega**2 * q
    flow = sp.diff(energy, t).subs(sp.diff(q, t, 2), driven)
    kept = (free.rate**2 + omega**2 * free.q**2) / 2
    at_first = (q_rate**2 + omega**2 * q_j**2) / 2
    cycle = 2 * sp.pi / (omega * ROOT)
    left = free.q.subs(t, cycle) / q_j
    decrement = sp.simplify(left - sp.exp(-2 * sp.pi * zeta / ROOT))
    return prove(
        "Energy loss by damping",
        "The rate of the energy follows from the oscillator's equation. In a free motion the loss "
        "grows by $2 \\zeta \\omega q'^2$ and equals the decrease of the energy. After one cycle "
        "the motion is the same, reduced by the decrement.",
        lambda lost: {
            "rate of the energy": sp.expand(flow - _push * rate + POWER.subs(q_rate, rate)),
            "rate of the loss": by_phase(sp.diff(lost, t) - POWER.subs(q_rate, free.rate)),
            "no loss at t = 0": sp.simplify(lost.subs(t, 0)),
            "balance": by_phase(at_first - kept - lost),
            "decrement": decrement,
        },
        free.lost,
    )


def damping() -> tuple[Formula, ...]:
    """Return the formulas of the step."""
    motion, energy, free = oscillator(), dissipation(), free_motion()
    response_factors()
    return (
        Formula(
            "damped_response", "g(t)", "displacement of a damped mode due to a unit impulse",
            impulse_response(), "s", "", (), motion,
        ),
        Formula(
            "damped_motion", "q_j(t)", "free motion of a damped mode", free.q, "m", "",
            ("damped_response",), motion,
        ),
        Formula(
            "damped_loss", "D_j(t)", "energy loss per modal mass of a damped free mode",
            free.lost, "m^2/s^2", "", ("damped_motion",), energy,
        ),
    )  # fmt: skip


STEPS = (("damping", damping),)
