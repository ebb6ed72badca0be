"""Constants of the impact by simple laws, and of the bounds of what these leave out.

`theory.substitution` shows 1 + 3/2 c_1 A - K_3 A^3 <= S <= 1 + 3/2 c_1 A. For 1/eta up to THIN
both c_1 and K_3 are sums over a few modes; beyond it they are the thin plate's closed forms
less sums over roots with a proven bound. Every constant is a ball; bounds are rounded up.
"""

import math

import flint
from flint import arb as Ball

from derivation.engine.formula.ball import evaluate
from derivation.mathematics.bessel.kernels import nearest_double, wrapped
from derivation.plate.contact.kernels.moments import BITS
from derivation.plate.contact.kernels.tables import IMPACT_NODES, gauss_legendre, modes
from derivation.plate.contact.theory.plate_series import coefficient, kappa_ball
from derivation.plate.contact.theory.split import zero_of_j0
from derivation.plate.contact.theory.thin_law import thin_coefficient_ball
from derivation.plate.impact.theory.impact import hertz_time
from derivation.plate.impact.theory.substitution import (
    roots_bound,
    time_quadrature_bound,
    wall_rest_ball,
)

THIN = 6
"""1/eta from which on the roots' share, like e^(-pi/eta), is left out."""
FADED = 18
"""T = 2 eta j_n beyond which modes are left out, for 1/eta <= THIN."""


def simple_impact_context() -> dict[str, object]:
    """What the template of the generated simple impacts needs, numbers as text."""
    # T_n = 2 eta j_n > FADED for n beyond these, for every 1/eta <= THIN.
    count = math.ceil(FADED * THIN / (2 * math.pi) + 0.25)
    if not 2 * zero_of_j0(count, 64) > FADED * THIN:
        raise ArithmeticError("too few modes for the tail's bound")
    with flint.ctx.workprec(BITS):
        wall, rest = _wall(), wall_rest_ball()
        thin = {k: thin_coefficient_ball(k, 1) for k in (2, 3)}
        bending = 1 / (4 * Ball.pi())
        cubic_wall = rest - 2 * kappa_ball(2) / (3 * Ball.pi() ** 2)
        constants = {
            "wall": nearest_double(wall),
            "thin_linear": nearest_double(thin[2] - bending),
            "thin_cubic": nearest_double(-Ball(5) / 2 * thin[3]),
            "wall_rest": above(rest),
            "wall_cubic": above(cubic_wall),
            "roots_linear": above(_roots(2)),
            "roots_cubic": above(Ball(5) / 2 * _roots(3)),
            "faded_linear": above(_faded(0)),
            "faded_cubic": above(_faded(2)),
            "hertz_time": nearest_double(evaluate(hertz_time().expression, {})),
            "quadrature": above(time_quadrature_bound(IMPACT_NODES)),
        }
        pairs = [(nearest_double(j), nearest_double(w)) for j, w in modes(count)]
    nodes, weights = gauss_legendre(IMPACT_NODES)
    rule = [_node(u, weight) for u, weight in zip(nodes, weights, strict=True)]
    return {name: repr(value) for name, value in constants.items()} | {
        "modes": [wrapped(map(repr, pair))[0] for pair in pairs],
        "rule": [wrapped(map(repr, row))[0] for row in rule],
        "thin": str(THIN),
        "faded": str(FADED),
    }


def above(bound: Ball) -> float:
    """A short number above a bound: 0.1 % is more than four digits' rounding, 0.05 %."""
    return float(f"{1.001 * float(bound.abs_upper()):.4g}")


def _wall() -> Ball:
    """What the side wall takes from c_1, over eta."""
    share = coefficient(2).by_plate_radius[1]
    (kappa_0,) = share.free_symbols
    return evaluate(-share / kappa_0, {}) * kappa_ball(0)


def _roots(k: int) -> Ball:
    """C of |roots' share of c_(2k-3)| <= C e^(-pi/eta) for 1/eta >= THIN."""
    decay = (-Ball.pi() * THIN).exp()
    later = sum((Ball(n) ** (2 * k - 4) * decay ** (n - 1) for n in range(1, 40)), Ball(0))
    # From n = 40 on terms fall by far more than half.
    return roots_bound(k) * (later + 2 * Ball(40) ** (2 * k - 4) * decay**39)


def _faded(power: int) -> Ball:
    """Bound of the sum of w_n T_n^power over the modes with T_n >= FADED, 1/eta <= THIN.

    w_n = (G - 1)/(j_n J1^2) with 1/(j_n J1^2) < 2 and G - 1 <= 16 T^2 e^(-2T) for T >= 2;
    T^4 e^(-2T) falls there, and neighbours are at least 2 eta 3 >= 6/THIN apart.
    """
    gap = Ball(6) / THIN
    steps = [FADED + gap * n for n in range(60)]
    terms = [32 * T ** (2 + power) * (-2 * T).exp() for T in steps]
    return sum(terms, Ball(0)) + 2 * terms[-1]


def _node(u: float, weight: float) -> tuple[float, ...]:
    """q = 1 - u^2, 6 g_5, 5 g_6 and 8 q times the weight, g_n = 1 + ... + q^(n-1)."""
    with flint.ctx.workprec(BITS):
        q = 1 - Ball(u) ** 2
        fifth = sum((q**n for n in range(5)), Ball(0))
        row = q, 6 * fifth, 5 * (fifth + q**5), 8 * q * Ball(weight)
        return tuple(nearest_double(x) for x in row)
