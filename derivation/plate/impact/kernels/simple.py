"""Constants of the impact by simple laws, and bounds of the error of these laws.

`theory.substitution` shows 1 + 3/2 c_1 A - K_3 A^3 <= S <= 1 + 3/2 c_1 A. For 1/eta up to THIN both
c_1 and K_3 are sums over a few modes; for larger 1/eta they are the thin plate's closed forms minus
sums over roots with a proved bound. Every constant is a ball; bounds are rounded up.
"""

import math

import flint
import sympy as sp
from flint import arb as Ball

from derivation.engine.emit.modules import Numbers
from derivation.engine.emit.tables import Constant
from derivation.engine.formula.ball import evaluate
from derivation.mathematics.bessel.kernels import nearest_double
from derivation.plate.contact.kernels.moments import BITS
from derivation.plate.contact.kernels.tables import IMPACT_NODES, gauss_legendre, modes
from derivation.plate.contact.theory.plate_series import kappa_ball
from derivation.plate.contact.theory.split import zero_of_j0
from derivation.plate.contact.theory.thin_law import thin_coefficient_ball
from derivation.plate.impact.kernels.simple_laws import (
    CUBIC,
    ROW,
    gauss,
    lateral_cubic,
    lateral_linear,
)
from derivation.plate.impact.theory.impact import hertz_time
from derivation.plate.impact.theory.substitution import (
    lateral_rest_ball,
    roots_bound,
    time_quadrature_bound,
)
from derivation.plate.vocabulary import u_t

THIN = 6
"""1/eta from which on the contribution of the roots, like e^(-pi/eta), is omitted."""
FADED = 18
"""T = 2 eta j_n above which modes are omitted, for 1/eta <= THIN."""


def numbers() -> Numbers:
    """Return the constants of the generated simple impacts: modes, Gauss' rule, bounds."""
    # T_n = 2 eta j_n > FADED for n beyond these, for every 1/eta <= THIN.
    count = math.ceil(FADED * THIN / (2 * math.pi) + 0.25)
    if not 2 * zero_of_j0(count, 64) > FADED * THIN:
        raise ArithmeticError("too few modes for the tail's bound")
    with flint.ctx.workprec(BITS):
        rest = lateral_rest_ball()
        bending_part = 1 / (4 * Ball.pi())
        thin = {k: thin_coefficient_ball(k, 1) for k in (2, 3)}
        pairs = tuple((nearest_double(j), nearest_double(w)) for j, w in modes(count))
        cubic = rest - _cubic(_lateral(lateral_cubic, 2))
        constants = (
            Constant("MODES", pairs, "j_n and 1/(j_n J1(j_n)^2)."),
            Constant("RULE", _rule(), "Gauss' rule: a/a_m, 6 g_5, 5 g_6, and its weights."),
            Constant("THIN", float(THIN), "1/eta beyond which c_1 and K_3 are closed forms."),
            Constant("FADED", float(FADED), "T = 2 eta j_n beyond which modes are omitted."),
            Constant("FADED_LINEAR", above(_faded(0)), "Bound of the sum of their weights w_n."),
            Constant("FADED_CUBIC", above(_faded(2)), "Bound of the sum of w_n T_n^2 over them."),
            Constant(
                "LATERAL",
                nearest_double(_lateral(lateral_linear, 0)),
                "Reduction of c_1 by the finite radius, over eta.",
            ),
            Constant("LATERAL_REST", above(rest), "Bound of its part of K_3/eta^3."),
            Constant("LATERAL_CUBIC", above(cubic), "Bound of its part of (K_3 + 5/2 c_3)/eta^3."),
            Constant(
                "THIN_LINEAR",
                nearest_double(thin[2] - bending_part),
                "c_1 - v^2/(4 pi) at v = 1/eta = 1.",
            ),
            Constant("THIN_CUBIC", nearest_double(-_cubic(thin[3])), "-5/2 c_3 at v = 1."),
            Constant(
                "ROOTS_LINEAR",
                above(_roots(2)),
                "Bound of the roots' part of c_1, over e^(-pi/eta).",
            ),
            Constant(
                "ROOTS_CUBIC", above(_cubic(_roots(3))), "Bound of their part of K_3, likewise."
            ),
            Constant(
                "HERTZ_TIME",
                nearest_double(evaluate(hertz_time().expression, {})),
                "Contact time times v0/delta_m on a half-space.",
            ),
            Constant(
                "QUADRATURE",
                above(time_quadrature_bound(IMPACT_NODES)),
                "Bound of the relative error of Gauss' rule in `leading`, proved.",
            ),
        )
    return Numbers("simple_impact_numbers", "Constants of the impact by simple laws.", constants)


def _rule() -> tuple[tuple[float, ...], ...]:
    """Return the rows that `simple_laws` defines."""
    nodes, weights = gauss_legendre(IMPACT_NODES)
    return tuple(
        tuple(nearest_double(evaluate(part, {u_t: u, gauss: weight})) for part in ROW)
        for u, weight in zip(nodes, weights, strict=True)
    )


def above(bound: Ball) -> float:
    """Return a bound increased by 0.1 % and rounded to four digits, which changes it less."""
    return float(f"{1.001 * float(bound.abs_upper()):.4g}")


def _lateral(reduction: sp.Expr, index: int) -> Ball:
    """Return the reduction of a coefficient by the finite radius, over the power of eta."""
    (kappa_n,) = reduction.free_symbols
    return evaluate(reduction / kappa_n, {}) * kappa_ball(index)


def _cubic(coefficient: Ball) -> Ball:
    """Return the contribution to the slope of a coefficient of A^3 in the law."""
    return coefficient * int(CUBIC.p) / int(CUBIC.q)


def _roots(k: int) -> Ball:
    """Return C, where the roots' part of c_(2k-3) is at most C e^(-pi/eta) for 1/eta >= THIN."""
    decay = (-Ball.pi() * THIN).exp()
    later = sum((Ball(n) ** (2 * k - 4) * decay ** (n - 1) for n in range(1, 40)), Ball(0))
    # From n = 40 on each term is far below half of the previous one.
    return roots_bound(k) * (later + 2 * Ball(40) ** (2 * k - 4) * decay**39)


def _faded(power: int) -> Ball:
    """Return a bound of the sum of w_n T_n^power over the modes with T_n >= FADED, 1/eta <= THIN.

    w_n = (G - 1)/(j_n J1^2) with 1/(j_n J1^2) < 2 and G - 1 <= 16 T^2 e^(-2T) for T >= 2; T^4
    e^(-2T) decreases there, and successive T_n differ by at least 2 eta 3 >= 6/THIN.
    """
    gap = Ball(6) / THIN
    steps = [FADED + gap * n for n in range(60)]
    terms = [32 * T ** (2 + power) * (-2 * T).exp() for T in steps]
    return sum(terms, Ball(0)) + 2 * terms[-1]
