"""Arb reference for a clamped edge, in exact rational arithmetic.

Except for 1/pi, everything is rational in the arguments. For Hertz pressure the mean of r^2 is
2 a^2/5; in the slope it is that of a flat punch, 2 a^2/3.
"""

from fractions import Fraction

from flint import arb

from derivation.engine.formula.ball import Exact, to_ball
from derivation.plate.contact.oracle.balls import ratio_of, refine_to_digits
from derivation.plate.edge.theory.clamped import LEVEL_FIT, TURN_FIT

SPREAD = {"indentation": Fraction(2, 5), "slope": Fraction(2, 3)}
"""Mean of r^2/a^2, by kind."""


def constants(n: Fraction) -> tuple[Fraction, Fraction]:
    """Return chi and G of the clamped edge."""
    turn, level = (
        Fraction(1000) / sum(c * n**i for i, c in enumerate(powers))
        for powers in (TURN_FIT, LEVEL_FIT)
    )
    return n * n * turn, level


def clamp_part(
    kind: str, a: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact, digits: int = 30
) -> arb:
    """Return the reduction of delta R/a^2, or of (R/2a) d delta/da for kind `slope`.

    Parameters
    ----------
    kind
        `indentation` or `slope`.
    a, h, b, lam, mu
        Exact numbers; 0 < a < b.
    digits
        Correct decimal digits required of the ball.

    Raises
    ------
    ValueError
        Unless 0 < a < b.
    """
    width, eta = ratio_of(a, b), ratio_of(h, b)
    n = Fraction(lam) / (Fraction(lam) + 2 * Fraction(mu))
    if not width < 1:
        raise ValueError(f"expected a < b, got a/b = {float(width)}")
    chi, level = constants(n)
    lost = 2 * n * eta**2 * (1 - 2 * level)
    wide = 1 - SPREAD[kind] * width**2
    bending = (1 - lost) * (wide - lost) + 2 * chi * eta * wide
    # Shear, and extension.
    total = bending / (8 * eta**3) + Fraction(1, 40) + 2 * n**2 * eta / 3
    total *= width if kind == "indentation" else 3 * width / 2
    return refine_to_digits(lambda _: (to_ball(total) / arb.pi(),), digits, f"the clamp's {kind}")[
        0
    ]


def curvature(h: Exact, b: Exact, lam: Exact, mu: Exact, digits: int = 30) -> arb:
    """Return the coefficient of (t^2 + s^2)/h^3 in the kernel of the integral equation."""
    eta, n = ratio_of(h, b), Fraction(lam) / (Fraction(lam) + 2 * Fraction(mu))
    chi, level = constants(n)
    total = Fraction(3, 8) * (1 - 2 * n * eta**2 * (1 - 2 * level) + 2 * chi * eta)
    return refine_to_digits(
        lambda _: (to_ball(total) / arb.pi(),), digits, "the clamp's curvature"
    )[0]


def back_face_clamp(
    a: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact
) -> tuple[Fraction, Fraction]:
    """Return the reduction of S by bending and by extension."""
    width, eta = ratio_of(a, b), ratio_of(h, b)
    n = Fraction(lam) / (Fraction(lam) + 2 * Fraction(mu))
    chi, level = constants(n)
    wide = 1 - SPREAD["indentation"] * width**2
    turn = wide * (1 + 2 * chi * eta) - 2 * n * eta**2 * (1 - 2 * level)
    return 3 * turn / 2, 2 * n * eta**2
