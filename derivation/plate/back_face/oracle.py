"""Arb reference for the stress on the back face: the defining modal sum in balls.

    S = sum 4 eta^2 g(alpha j) B(T)/J1^2,  T = 2 eta j,  B = 2 T sinh T/(sinh^2 T - T^2)

Remainder: |g| <= 1, 1/J1^2 < pi j/2 (`edge.theory.sums`) and, for T >= 4, B <= 4.4 T e^(-T). Hence
a term is below 14 eta T^2 e^(-T), which decreases by e^(-3 eta) at least from mode to mode.
"""

import math
from fractions import Fraction

import flint
from flint import arb

from derivation.engine.formula.ball import Exact, to_ball
from derivation.plate.contact.oracle.balls import ratio_of, refine_to_digits
from derivation.plate.edge.oracle import supported as edge_balls


def back_face_sum(a: Exact, h: Exact, b: Exact, digits: int = 30) -> arb:
    """Return S; the stress is (1 + nu) P/(2 pi H^2) times S.

    Parameters
    ----------
    a, h, b
        Exact numbers; 0 < a < b. The run time is proportional to b/h.
    digits
        Correct decimal digits required of the ball.

    Raises
    ------
    ValueError
        Unless all are above 0 and a < b.
    """
    width, eta = ratio_of(a, b), ratio_of(h, b)
    if not width < 1:
        raise ValueError(f"expected a < b, got a/b = {float(width)}")
    return refine_to_digits(
        lambda bits: (_summed(width, eta, bits),), digits, f"S at a/b = {float(width)}"
    )[0]


def _summed(width: Fraction, eta: Fraction, bits: int) -> arb:
    count = math.ceil((0.7 * bits + 12) / (2 * math.pi * float(eta))) + 1
    # For a thick plate the sum is as small as its first term.
    lost = int(7 * float(eta)) + 3 * max(0, -math.frexp(float(width))[1])
    working = bits + 64 * (2 + (lost + 4 * max(0, -math.frexp(float(eta))[1])) // 64)
    with flint.ctx.workprec(working):
        alpha, x, total = to_ball(width), to_ball(eta), arb(0)
        for j, slope in edge_balls.modes(count, working):
            y, T = alpha * j, 2 * x * j
            growth = T.exp()
            sinh = (growth - 1 / growth) / 2
            g = 3 * (y.sin() - y * y.cos()) / y**3
            total += 8 * x**2 * g * T * sinh / (sinh**2 - T**2) / slope**2
        T = 2 * x * (count + arb(3) / 4) * arb.pi()
        if not T > 4:
            raise ValueError(f"expected more modes in the sum, which ends at T = {T}")
        rest = 14 * x * T**2 * (-T).exp() / (1 - (-3 * x).exp())
        return total + arb(0, rest.abs_upper())


def back_face_edge(a: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact, digits: int = 30) -> arb:
    """Return the edge term of S: 12 bent + 8 n eta stretched, from the sums of `edge.oracle`."""
    width, eta = ratio_of(a, b), ratio_of(h, b)
    thinning = Fraction(lam) / (Fraction(lam) + 2 * Fraction(mu))

    def compute(bits: int) -> tuple[arb]:
        bent, stretched = edge_balls.sums("indentation", width, eta, thinning, bits)
        return (12 * bent + 8 * to_ball(thinning * eta) * stretched,)

    return refine_to_digits(compute, digits, f"the edge term of S at a/b = {float(width)}")[0]
