"""Arb reference of forces and pressures: Hertz's closed forms in terms of the contact radius."""

from flint import arb

from derivation.engine.formula.ball import Exact, to_ball
from derivation.plate.contact.oracle import balls as contact_balls


def force_of_radius(a: Exact, R: Exact, lam: Exact, mu: Exact, digits: int = 50) -> arb:
    """Return P = 4 E* a^3/(3 R)."""

    def compute(_: int) -> tuple[arb]:
        return (4 * contact_balls.modulus(lam, mu) * to_ball(a) ** 3 / (3 * to_ball(R)),)

    return contact_balls.refine_to_digits(compute, digits, f"P at {a, R}")[0]


def radius_of_force(P: Exact, R: Exact, lam: Exact, mu: Exact, digits: int = 50) -> arb:
    """Return the contact radius at a force."""

    def compute(_: int) -> tuple[arb]:
        cube = 3 * to_ball(P) * to_ball(R) / (4 * contact_balls.modulus(lam, mu))
        return (cube.root(3),)

    return contact_balls.refine_to_digits(compute, digits, f"a at {P, R}")[0]


def max_pressure(a: Exact, R: Exact, lam: Exact, mu: Exact, digits: int = 50) -> arb:
    """Return p_0 = 2 E* a/(pi R)."""

    def compute(_: int) -> tuple[arb]:
        return (2 * contact_balls.modulus(lam, mu) * to_ball(a) / (arb.pi() * to_ball(R)),)

    return contact_balls.refine_to_digits(compute, digits, f"p_0 at {a, R}")[0]


def force(
    delta: Exact, R: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact, digits: int = 50
) -> arb:
    """Return the force at an indentation."""
    a = contact_balls.contact_radius(delta, R, h, b, digits + 2)

    def compute(_: int) -> tuple[arb]:
        return (4 * contact_balls.modulus(lam, mu) * a**3 / (3 * to_ball(R)),)

    return contact_balls.refine_to_digits(compute, digits, f"P at {delta, R, h, b}")[0]
