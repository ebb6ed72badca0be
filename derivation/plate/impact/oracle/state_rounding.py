"""Effect of rounding the arguments on an impact's state at a time; used for tolerances alone.

In units of h^2/R for the indentation, h for the contact radius, E* h^3/R for the force and
sqrt(m/(E* h)) for time, the state is a function of the time, of the energy number Y and of h/b.
Changing v0 changes only Y, changing b changes only h/b; the effect of the time follows from the
motion.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

import flint
from flint import arb

from derivation.engine.formula.ball import to_ball
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.impact.oracle.quantities import fraction
from derivation.plate.impact.theory.sensitivity import exponents

_STEP, _DIGITS = Fraction(1, 2**20), 15
_SPEED, _RADIUS = 3, 5
"""Positions of v0 and b among the arguments."""

State = Callable[[Sequence[Any], int], tuple[arb, ...]]
"""Function of arguments (time first) and digits: indentation, rate, contact radius, force."""


def rounding(state: State, given: Sequence[Any], values: Sequence[arb]) -> list[arb]:
    """Return, for each component of the state `values`, the sum of |x d/dx| over the arguments."""
    by_speed, by_radius = (state(_moved(given, place), _DIGITS) for place in (_SPEED, _RADIUS))
    lam, mu = (Fraction(x) for x in given[6:])
    by_lam = lam * mu / ((lam + mu) * (lam + 2 * mu))
    of_modulus = to_ball(abs(by_lam) + abs(1 - by_lam))
    table = exponents()
    units = [table["max_indentation"], (), table["max_contact_radius"], table["max_force"]]
    units[1] = tuple(x - y for x, y in zip(units[0], table["contact_time"], strict=True))
    roundings = []
    with flint.ctx.workprec(4 * _DIGITS + 64):
        flows = _flows(given, values)
        for unit, value, flow, fast, wide in zip(
            units, values, flows, by_speed, by_radius, strict=True
        ):
            by_energy, by_eta = ((x - value) / to_ball(_STEP) for x in (fast, wide))
            rows = zip(unit, table["energy"], table["eta"], table["contact_time"], strict=True)
            changes = [
                abs(
                    _ball(own) * value
                    + _ball(energy) * by_energy / 2
                    - _ball(eta) * by_eta
                    - _ball(time) * flow
                )
                for own, energy, eta, time in rows
            ]
            roundings.append(abs(flow) + sum(changes[:-1], arb(0)) + changes[-1] * of_modulus)
    return roundings


def _moved(given: Sequence[Any], place: int) -> list[Any]:
    return [Fraction(x) * (1 + _STEP) if i == place else x for i, x in enumerate(given)]


def _ball(number: Any) -> arb:
    return to_ball(Fraction(int(number.p), int(number.q)))


def _flows(given: Sequence[Any], values: Sequence[arb]) -> list[arb]:
    """Return t d/dt of every component: without contact only the sphere moves."""
    t, R, m, _, h, b, _, _ = given
    _, speed, radius, force = values
    if radius == 0:
        return [arb(0)] * len(values)
    growth = speed / contact_balls.slope(fraction(radius), R, h, b, _DIGITS)
    rates = (speed, -force / to_ball(m), growth, 3 * force / radius * growth)
    return [to_ball(t) * rate for rate in rates]
