"""Oracle 1 of what follows from the contact law: forces, the reversed series, the motion."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

import flint
from flint import arb

from derivation.formula.ball import Exact, PrecisionError, to_ball
from derivation.reference import contact_balls, contact_impact
from derivation.reference.contact_balls import modulus, settle

_GRID, _STEPS = 32, 12
_LEAST = 14

Motion = tuple[Exact, Exact, Exact, Exact, Exact, Exact, Exact]
"""R, m, v0, h, b, lam, mu of an impact."""


def force_of_radius(a: Exact, R: Exact, lam: Exact, mu: Exact, digits: int = 50) -> arb:
    """P = (4/3) E* a^3/R."""
    return settle(
        lambda _: (4 * modulus(lam, mu) * to_ball(a) ** 3 / (3 * to_ball(R)),), digits, "P"
    )[0]


def radius_of_force(P: Exact, R: Exact, lam: Exact, mu: Exact, digits: int = 50) -> arb:
    """a = (3 P R/(4 E*))^(1/3)."""
    return settle(
        lambda _: ((3 * to_ball(P) * to_ball(R) / (4 * modulus(lam, mu))).root(3),), digits, "a"
    )[0]


def max_pressure(a: Exact, R: Exact, lam: Exact, mu: Exact, digits: int = 50) -> arb:
    """3 P/(2 pi a^2) = 2 E* a/(pi R)."""
    return settle(
        lambda _: (2 * modulus(lam, mu) * to_ball(a) / (arb.pi() * to_ball(R)),), digits, "p_0"
    )[0]


def force(
    delta: Exact, R: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact, digits: int = 50
) -> arb:
    """Force at an indentation, by way of the contact radius."""
    a = contact_balls.contact_radius(delta, R, h, b, digits + 2)
    with flint.ctx.workprec(4 * digits + 64):
        return 4 * modulus(lam, mu) * a**3 / (3 * to_ball(R))


def truncated_series(
    delta: Exact, R: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact,
    digits: int = 50, terms: int = 12,
) -> tuple[arb, arb]:  # fmt: skip
    """The first terms of the reversed series P(delta), and their magnitudes' sum over theirs.

    p_n = 3/(n + 3) [A^n] (1 + c_1 A + c_3 A^3 + ...)^(-(n + 3)/2), eps = sqrt(R delta)/h.
    """
    with flint.ctx.workprec(8 * digits + 128):
        law = [arb(1)] + [arb(0)] * (terms - 1)
        for order in range(1, terms, 2):
            law[order] = contact_balls.coefficient(order, h, b, digits + 10)
        eps = (to_ball(R) * to_ball(delta)).sqrt() / to_ball(h)
        shares = []
        for n in range(terms):
            coefficient = power(law, arb(flint.fmpq(-(n + 3), 2)))[n]
            shares.append(arb(flint.fmpq(3, n + 3)) * coefficient * eps**n)
        total = sum(shares, arb(0))
        hertz = 4 * modulus(lam, mu) / 3 * (to_ball(R) * to_ball(delta)).sqrt() * to_ball(delta)
        return hertz * total, sum(map(abs, shares), arb(0)) / abs(total)


def power(series: Sequence[arb], exponent: arb) -> list[arb]:
    """A power of a power series that begins with 1, to as many terms (Euler's recurrence)."""
    found = [arb(1)]
    for n in range(1, len(series)):
        shares = ((exponent * k - (n - k)) * series[k] * found[n - k] for k in range(1, n + 1))
        found.append(sum(shares, arb(0)) / n)
    return found


def state(
    t: Exact, R: Exact, m: Exact, v0: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact,
    digits: int = 40,
) -> tuple[arb, arb, arb, arb]:  # fmt: skip
    """Indentation, its rate, contact radius and force at a time since the first touch.

    The contact radius is found by Newton's iteration on the times that it is reached
    at, certified by a time on either side; the rate follows from the energy.

    Raises
    ------
    PrecisionError
        If the ends do not enclose the time, for instance too close to the turning point.
    """
    course = contact_impact.impact(R, m, v0, h, b, lam, mu, digits + 8)
    with flint.ctx.workprec(8 * digits + 64):
        left = course.contact_time - to_ball(t)
        if t <= 0 or left <= 0:
            return arb(0), to_ball(v0) * (1 if t <= 0 else -1), arb(0), arb(0)
        falling = bool(left < to_ball(t))
        goal = left if falling else to_ball(t)
    motion: Motion = (R, m, v0, h, b, lam, mu)
    a = _start(goal, course.max_contact_radius, motion)
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


def _start(goal: arb, largest: arb, motion: Motion) -> Fraction:
    """Contact radius near a time, interpolated between times of a grid dense at the largest."""
    shares = [1 - (1 - Fraction(k, _GRID)) ** 2 for k in range(1, _GRID)]
    radii = [fraction(largest) * share for share in shares]
    times = [float(time) for time in contact_impact.history(radii, *motion, _LEAST)]
    known = [(0.0, Fraction(0)), *zip(times, radii, strict=True)]
    for (early, inner), (late, outer) in pairwise(known):
        if float(goal) <= late:
            return inner + (outer - inner) * Fraction((float(goal) - early) / (late - early))
    raise PrecisionError("the time asked for is too close to the turning point")


def _speed(a: Exact, motion: Motion, digits: int) -> arb:
    """Speed at a contact radius, from the energy that is left."""
    R, m, v0, h, b, lam, mu = motion
    stored = contact_impact.stored_energy(a, R, h, b, lam, mu, digits)
    return (to_ball(v0) ** 2 - 2 * stored / to_ball(m)).sqrt()


def fraction(ball: arb) -> Fraction:
    """Midpoint of a ball, exactly."""
    mantissa, exponent = ball.mid().man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
