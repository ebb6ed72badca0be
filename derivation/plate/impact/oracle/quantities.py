"""Arb reference of quantities derived from the contact law: the reversed series, the motion."""

from collections.abc import Sequence
from fractions import Fraction

import flint
from flint import arb

from derivation.engine.formula.ball import Exact, PrecisionError, to_ball
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle.balls import modulus
from derivation.plate.impact.oracle import impact as contact_impact

_GRID, _STEPS = 8, 12
_LEAST = 14
_NEXT = 13
"""A power series is used within 10^-13 of the contact time from the turning point."""

Motion = tuple[Exact, Exact, Exact, Exact, Exact, Exact, Exact]
"""R, m, v0, h, b, lam and mu of an impact."""


def truncated_series(
    delta: Exact, R: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact,
    digits: int = 50, terms: int = 12,
) -> tuple[arb, arb]:  # fmt: skip
    """Return the first terms of the reversed series P(delta), and their sum's condition number.

    p_n = 3/(n + 3) [A^n] (1 + c_1 A + c_3 A^3 + ...)^(-(n + 3)/2), eps = sqrt(R delta)/h.
    """
    with flint.ctx.workprec(8 * digits + 128):
        law = [arb(1)] + [arb(0)] * (terms - 1)
        for order in range(1, terms, 2):
            law[order] = contact_balls.coefficient(order, h, b, digits + 10)
        eps = (to_ball(R) * to_ball(delta)).sqrt() / to_ball(h)
        contributions = []
        for n in range(terms):
            coefficient = power(law, arb(flint.fmpq(-(n + 3), 2)))[n]
            contributions.append(arb(flint.fmpq(3, n + 3)) * coefficient * eps**n)
        total = sum(contributions, arb(0))
        hertz = 4 * modulus(lam, mu) / 3 * (to_ball(R) * to_ball(delta)).sqrt() * to_ball(delta)
        return hertz * total, sum(map(abs, contributions), arb(0)) / abs(total)


def power(series: Sequence[arb], exponent: arb) -> list[arb]:
    """Return a power of a power series 1 + ..., with as many terms (Euler's recurrence)."""
    powers = [arb(1)]
    for n in range(1, len(series)):
        contributions = (
            (exponent * k - (n - k)) * series[k] * powers[n - k] for k in range(1, n + 1)
        )
        powers.append(sum(contributions, arb(0)) / n)
    return powers


def state(
    t: Exact, R: Exact, m: Exact, v0: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact,
    digits: int = 40,
) -> tuple[arb, arb, arb, arb]:  # fmt: skip
    """Return indentation, its rate, contact radius and force at a time since first contact.

    The contact radius is found by Newton's iteration on the times at which it is reached, and
    certified by a time on either side. The rate follows from the energy. Near the turning point a
    power series is used, see `_turned`.

    Raises
    ------
    PrecisionError
        If the ends do not enclose the time.
    """
    motion: Motion = (R, m, v0, h, b, lam, mu)
    whole_impact = contact_impact.impact(*motion, digits + 8)
    with flint.ctx.workprec(8 * digits + 64):
        if abs(to_ball(t) / whole_impact.contact_time - 0.5) < arb(10) ** -_NEXT:
            return _turned(t, contact_impact.impact(*motion, digits + 2 * _NEXT), motion)
        left = whole_impact.contact_time - to_ball(t)
        if t <= 0 or left <= 0:
            return arb(0), to_ball(v0) * (1 if t <= 0 else -1), arb(0), arb(0)
        falling = bool(left < to_ball(t))
        goal = left if falling else to_ball(t)
    a = _start(goal, whole_impact, motion)
    for step in range(_STEPS):
        shown = min(digits + 8, _LEAST * 2**step)
        (reached,) = contact_impact.history([a], *motion, shown)
        with flint.ctx.workprec(8 * digits + 64):
            rate = _speed(a, motion, shown) / contact_balls.slope(a, R, h, b, shown)
            change = (goal - reached) * rate
            a = fraction(to_ball(a) + change)
            if shown == digits + 8 and abs(change) < to_ball(a) * arb(10) ** -(digits + 2):
                break
    with flint.ctx.workprec(8 * digits + 64):
        width = to_ball(a) * arb(10) ** -(digits + 1)
        low, high = fraction(to_ball(a) - width), fraction(to_ball(a) + width)
        before, after = contact_impact.history([low, high], *motion, digits + 6)
        if not (before < goal < after):
            raise PrecisionError(f"the state at {t} is not enclosed by {low} and {high}")
        speeds = (_speed(end, motion, digits + 6) for end in (low, high))
        speed = next(speeds).union(next(speeds))
        depths = (contact_balls.indentation(end, R, h, b, digits + 6) for end in (low, high))
        depth = next(depths).union(next(depths))
        radius = to_ball(low).union(to_ball(high))
        load = 4 * modulus(lam, mu) * radius**3 / (3 * to_ball(R))
        return depth, -speed if falling else speed, radius, load


def _turned(
    t: Exact, whole_impact: contact_impact.ImpactBalls, motion: Motion
) -> tuple[arb, arb, arb, arb]:
    """Return the state near the turning point, at the current precision.

    m z'' = -P(z) from rest at z_m, with K = dP/dz there: in powers of x = (K/m) tau^2,

        z = z_m - (P_m/K) (x/2 - x^2/24 ...),  z' = -(P_m/m) tau (1 - x/6 ...)

    The omitted terms are of the relative order of x^2, below 10^-50. Ten times as much is added to
    the radius, which is an estimate, not a proof.
    """
    R, m, _, h, b, lam, mu = motion
    tau = to_ball(t) - whole_impact.contact_time / 2
    a = fraction(whole_impact.max_contact_radius)
    force = whole_impact.max_force
    stiff = contact_balls.stiffness(a, R, h, b, lam, mu, 4 * _NEXT)
    x = stiff / to_ball(m) * tau**2
    error_estimate = arb(1, (10 * x).abs_upper())
    sunk = force / stiff * x / 2 * (1 - x / 12 * error_estimate)
    speed = -force / to_ball(m) * tau * (1 - x / 6 * error_estimate)
    load = force * (1 - x / 2 * error_estimate)
    radius = (3 * load * to_ball(R) / (4 * modulus(lam, mu))).root(3)
    return whole_impact.max_indentation - sunk, speed, radius, load


def _start(goal: arb, whole_impact: contact_impact.ImpactBalls, motion: Motion) -> Fraction:
    """Return the contact radius a_m (1 - u^2) near a time, u interpolated between times of a grid.

    In the first panel it is proportional to the root of the time, as in free flight.
    """
    largest, grid = fraction(whole_impact.max_contact_radius), range(1, _GRID)
    radii = [largest * (1 - (1 - Fraction(k, _GRID)) ** 2) for k in grid]
    times = [float(time) for time in contact_impact.history(radii, *motion, _LEAST)]
    if float(goal) <= times[0]:
        return radii[0] * fraction((goal / times[0]).sqrt())
    ends = [*times, float(whole_impact.contact_time) / 2]
    panel = next((k for k, late in enumerate(ends) if float(goal) <= late), len(times))
    early, late = ends[panel - 1 : panel + 1]
    u = 1 - (panel + Fraction((float(goal) - early) / (late - early))) / _GRID
    return largest * (1 - u**2)


def _speed(a: Exact, motion: Motion, digits: int) -> arb:
    """Return the speed at a contact radius, from the remaining energy."""
    R, m, v0, h, b, lam, mu = motion
    stored = contact_impact.stored_energy(a, R, h, b, lam, mu, digits)
    return (to_ball(v0) ** 2 - 2 * stored / to_ball(m)).sqrt()


def fraction(ball: arb) -> Fraction:
    """Return the midpoint of a ball, exactly."""
    mantissa, exponent = ball.mid().man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
