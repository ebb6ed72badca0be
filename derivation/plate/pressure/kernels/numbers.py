"""Constants for the generated solution of the integral equation: its quadratures.

With lengths in units of b the kernel is

    k(x) = (4/pi) sum w_n cos(x j_n) - (4/pi^2) int_0^oo K0(y)/I0(y) cosh(x y) dy.

For 1/eta up to THIN few modes are needed; above, the sum is replaced by the thin plate's integral
(1/pi) int (G - 1) cos(A T/2) dT with its c_1 and c_3, up to e^(-4.2124/eta + 2.11 x/h) as in
the contact law. In both cases k is a sum of cosines, so that its matrices are products.
"""

import math

import flint
import numpy as np
import sympy as sp
from flint import arb as Ball

from derivation.engine.emit.modules import Numbers
from derivation.engine.emit.tables import Constant
from derivation.engine.formula.ball import enclose
from derivation.mathematics.bessel.kernels import nearest_double
from derivation.plate.budgets import read_stated_limits
from derivation.plate.contact.kernels.moments import BITS
from derivation.plate.contact.theory.thin_plate import plate_excess
from derivation.plate.pressure.theory.integral_equation import kernel, kernel_by_powers
from derivation.plate.vocabulary import c_A

NODES = 24
"""Collocation points: the positive ones of a rule on (-a, a) exact up to the degree 95."""
THIN = 16
"""1/eta above which a plate is thin: e^(-4.2124 THIN + 2.11 * 2 WIDEST) is below 1e-16."""
WIDEST = 7
"""Largest a/h. In a thin plate, contact at the centre is lost before that."""
DIRECTIONS, LARGEST_T = 80, 24
"""Number of Gauss nodes for a thin plate, and the largest T, where G - 1 = 4 T^2 e^(-2T) <
1e-17."""
FADED = 23
"""T = 2 eta j_n up to which modes are summed in plates that are not thin."""
WIDEST_OVER_B = 0.95
"""Largest a/b: the kernel is singular where t + s = 2 b."""
WIDEST_OVER_R = 0.95
"""Largest a/R of a sphere: the slope of its profile is singular where a = R."""
LATERAL_STEPS, LATERAL_FIRST, LATERAL_LAST = 5, -12, 30
"""Number of trapezoids per unit of u for the integral of the lateral surface, y = exp(u - e^(-u)).

The integrand behaves like y^2 log y and is below 1e-20 before the first; the last y is 400.
"""


def pressure_numbers() -> Numbers:
    """Return collocation points, wave numbers of the thin plate, nodes in y, and limits."""
    first, cubic = _powers()
    with flint.ctx.workprec(3 * BITS):
        nodes, waves, lateral = (
            _doubles(pairs) for pairs in (_collocation(), _waves(), _lateral())
        )
        modes = nearest_double(_front(0))
    square = math.fsum((waves[1] * waves[0] ** 2).tolist()) / 2
    return Numbers(
        "pressure_numbers",
        "Constants of the non-Hertzian pressure: quadratures of its kernel, limits.",
        (
            Constant("THIN", float(THIN), "1/eta = b/h above which a plate is thin."),
            Constant("WIDEST", float(WIDEST), "Largest a/h."),
            Constant(
                "WIDEST_OVER_B", WIDEST_OVER_B, "Largest a/b: the kernel is singular at the edge."
            ),
            Constant(
                "WIDEST_OVER_R", WIDEST_OVER_R, "Largest a/R of a sphere: a singular slope at 1."
            ),
            Constant(
                "ERROR",
                read_stated_limits("pressure")["error"],
                "Tested limit of the relative error; for pressures, of the mean pressure.",
            ),
            Constant("FADED", float(FADED), "T = 2 eta j_n up to which modes are summed."),
            Constant("FIRST", first, "N(0, 0) over c_1/h."),
            Constant("CUBIC", cubic, "Factor of c_3 a^2/h^3 (x^2 + s^2) in N."),
            Constant("SQUARE", square, "Factor of x^2 + s^2 in the sum of the cosines."),
            Constant("MODES", modes, "Factor of the modes' weights in the kernel."),
            Constant("NODES", nodes[0], "Collocation points t/a."),
            Constant("WEIGHTS", nodes[1], "Weights of int_0^1 of an even function."),
            Constant("WAVES", waves[0], "Wave numbers w h = T/2, thin plate."),
            Constant("WAVE_WEIGHTS", waves[1], "Their weights (G(T) - 1)/pi dT."),
            Constant("LATERAL", lateral[0], "Nodes y of the lateral surface."),
            Constant("LATERAL_WEIGHTS", lateral[1], "Their weights (4/pi^2) K0/I0 e^(2y) dy."),
        ),
    )


def _doubles(pairs: list[tuple[Ball, Ball]]) -> tuple[np.ndarray, np.ndarray]:
    places, weights = (
        np.array([nearest_double(x) for x in row]) for row in zip(*pairs, strict=True)
    )
    return places, weights


def _powers() -> tuple[float, float]:
    """Return the factors of c_1 and c_3 in the kernel."""
    parts = kernel_by_powers()
    (x, *_) = sorted(parts[3].free_symbols - {c_A[3]}, key=str)
    return float(parts[1] / c_A[1]), float(sp.diff(parts[3], x, 2) / 2 / c_A[3])


def _front(part: int) -> Ball:
    """Return the constant factor of the kernel's modes, or of its lateral surface."""
    expression = kernel()[part].expression
    factors = expression.function.args if isinstance(expression, sp.Integral) else expression.args
    return abs(enclose(sp.Mul(*(x for x in factors if x.is_number)), {}))


def _collocation() -> list[tuple[Ball, Ball]]:
    """Return x = t/a, ascending, with the weights of int_0^1."""
    pairs = [Ball.legendre_p_root(2 * NODES, i, weight=True) for i in reversed(range(NODES))]
    return [(x, w) for x, w in pairs]


def _waves() -> list[tuple[Ball, Ball]]:
    """Return wave numbers times h, T/2, and weights, (G - 1)/pi included, of the thin plate."""
    half = Ball(LARGEST_T) / 2
    pairs = [Ball.legendre_p_root(DIRECTIONS, i, weight=True) for i in reversed(range(DIRECTIONS))]
    places = [(half * (1 + x), half * w) for x, w in pairs]
    return [(T / 2, w * plate_excess(T) / Ball.pi()) for T, w in places]


def _lateral() -> list[tuple[Ball, Ball]]:
    """Return nodes y and weights of the lateral surface, times e^(2y) and (4/pi^2) K0/I0."""
    front, rows = _front(1), []
    for index in range(LATERAL_FIRST, LATERAL_LAST + 1):
        u = Ball(index) / LATERAL_STEPS
        exponential = (-u).exp()
        y = (u - exponential).exp()
        bessel = y.bessel_k(Ball(0)) / y.bessel_i(Ball(0)) * (2 * y).exp()
        rows.append((y, y * (1 + exponential) / LATERAL_STEPS * bessel * front))
    return rows
