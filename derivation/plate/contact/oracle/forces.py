"""Forces and pressures of a contact by both oracles: Hertz's closed forms on either's radius.

What follows from the contact radius alone is computed twice, in ball arithmetic and by
mpmath; the force at an indentation takes the radius from the oracle it belongs to.
"""

from flint import arb
from mpmath import mp, mpf

from derivation.engine.formula.ball import Exact, to_ball
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.route import sums as contact_routes

_SPARE = 15
"""Digits the second oracle works with beyond those asked."""


def force_of_radius(a: Exact, R: Exact, lam: Exact, mu: Exact, digits: int = 50) -> arb:
    """P = 4 E* a^3/(3 R), oracle 1."""

    def compute(_: int) -> tuple[arb]:
        return (4 * contact_balls.modulus(lam, mu) * to_ball(a) ** 3 / (3 * to_ball(R)),)

    return contact_balls.settle(compute, digits, f"P at {a, R}")[0]


def radius_of_force(P: Exact, R: Exact, lam: Exact, mu: Exact, digits: int = 50) -> arb:
    """The contact radius of a force, oracle 1."""

    def compute(_: int) -> tuple[arb]:
        cube = 3 * to_ball(P) * to_ball(R) / (4 * contact_balls.modulus(lam, mu))
        return (cube.root(3),)

    return contact_balls.settle(compute, digits, f"a at {P, R}")[0]


def max_pressure(a: Exact, R: Exact, lam: Exact, mu: Exact, digits: int = 50) -> arb:
    """p_0 = 2 E* a/(pi R), oracle 1."""

    def compute(_: int) -> tuple[arb]:
        return (2 * contact_balls.modulus(lam, mu) * to_ball(a) / (arb.pi() * to_ball(R)),)

    return contact_balls.settle(compute, digits, f"p_0 at {a, R}")[0]


def force(
    delta: Exact, R: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact, digits: int = 50
) -> arb:
    """The force at an indentation, oracle 1."""
    a = contact_balls.contact_radius(delta, R, h, b, digits + 2)

    def compute(_: int) -> tuple[arb]:
        return (4 * contact_balls.modulus(lam, mu) * a**3 / (3 * to_ball(R)),)

    return contact_balls.settle(compute, digits, f"P at {delta, R, h, b}")[0]


def second_force_of_radius(a: float, R: float, lam: float, mu: float, digits: int = 40) -> mpf:
    """The force of a contact radius, oracle 2."""
    with mp.workdps(digits + _SPARE):
        return contact_routes.hertz_stiffness(mpf(R), lam, mu) * mpf(a) ** 3


def second_radius_of_force(P: float, R: float, lam: float, mu: float, digits: int = 40) -> mpf:
    """The contact radius of a force, oracle 2."""
    with mp.workdps(digits + _SPARE):
        return mp.cbrt(mpf(P) / contact_routes.hertz_stiffness(mpf(R), lam, mu))


def second_max_pressure(a: float, R: float, lam: float, mu: float, digits: int = 40) -> mpf:
    """p_0 = 3 P/(2 pi a^2), oracle 2."""
    with mp.workdps(digits + _SPARE):
        P = second_force_of_radius(a, R, lam, mu, digits + _SPARE)
        return 3 * P / (2 * mp.pi * mpf(a) ** 2)


def second_force(
    delta: float, R: float, h: float, b: float, lam: float, mu: float, digits: int = 40
) -> mpf:
    """The force at an indentation, oracle 2."""
    a = contact_routes.contact_radius(delta, R, h, b, digits + 1)
    with mp.workdps(digits + _SPARE):
        return contact_routes.hertz_stiffness(mpf(R), lam, mu) * a**3
