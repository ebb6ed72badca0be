"""Step 14, for all contact radii: F = c_1 A + c_3 A^3 + Phi(A) for a thin plate, A = a/h.

From c_5 on, the thin plate's coefficients contain only the finite parts M_k and do not depend on
h/b. Together they are one function of A,

    Phi(A) = (2A/pi) int_0^oo [s(y)/y^3 - 1/3 + y^2/30] (G(T) - 1) dT,   y = A T/2,

s(y) = sin y - y cos y, which converges for every A, also beyond A = 4, the radius of convergence of
its series.
"""

from functools import cache

import flint
import sympy as sp

from derivation.engine.formula.ball import LOG2_10, Exact, enclose, refine, to_ball
from derivation.engine.formula.proof import prove
from derivation.plate.contact.theory.plate_series import LAST, sine_coefficient
from derivation.plate.contact.theory.thin_plate import (
    finite_part_ball,
    thin_coefficient,
)
from derivation.plate.modes.theory.plate_factor import plate_factors
from derivation.plate.vocabulary import Formula, M, T, a_ratio, eta

_y = sp.Symbol("y", positive=True)


def sine_kernel(y: sp.Expr) -> sp.Expr:
    """Return s(y)/y^3, the weight function of a mode: 1/3 at 0."""
    return (sp.sin(y) - y * sp.cos(y)) / y**3


@cache
def universal_part() -> Formula:
    """Return Phi(A), the sum of M_k's terms from c_5 on."""
    y = a_ratio * T / 2
    low = sp.Add(*(sine_coefficient(k) * _y ** (2 * k - 4) for k in (2, 3)))
    kernel = (sine_kernel(_y) - low).subs(_y, y)
    series = sp.series(sine_kernel(_y), _y, 0, 2 * LAST - 3).removeO()
    residuals = {
        "first two terms": series.coeff(_y, 0) + series.coeff(_y, 2) * _y**2 - low,
    }
    for k in range(4, LAST + 1):
        term = 2 * a_ratio / sp.pi * series.coeff(_y, 2 * k - 4) * (y / T) ** (2 * k - 4) * M[k]
        residuals[f"c_{2 * k - 3}"] = term - thin_coefficient(k).expression * a_ratio ** (2 * k - 3)
    mean = sp.integrate((1 - T**2) * sp.cos(_y * T) / 2, (T, 0, 1))
    residuals["mean of cosines"] = sp.expand(mean - sine_kernel(_y))
    proof = prove(
        "Thin plate's universal part",
        r"The terms of $M_k$, $k \ge 4$, are those of the series of $s(y)/y^3$ after its first "
        r"two. $s(y)/y^3$ is a mean of cosines, so each truncation error of its series is smaller "
        r"than the next term.",
        residuals,
    )
    factor = 2 * a_ratio / sp.pi * kernel
    return Formula(
        "Phi",
        r"\Phi(A)",
        r"part of $\delta R/a^2$ that is the same for all thin plates",
        sp.Integral(factor * plate_factors()[2].expression, (T, 0, sp.oo)),
        "1",
        "10",
        tuple(f"c_{2 * k - 3}_thin" for k in range(4, LAST + 1)),
        proof,
        stated=sp.Integral(factor * (sp.Function("G")(T) - 1), (T, 0, sp.oo)),
    )


def thin_coefficient_ball(k: int, ratio: Exact, digits: int = 30) -> flint.arb:
    """Return a ball around c_(2k-3) of a thin plate at h/b = ratio.

    Its relative radius is below 10^-digits.

    Raises
    ------
    PrecisionError
        If the coefficient vanishes.
    """
    expression = thin_coefficient(k).expression

    def compute() -> flint.arb:
        finite = finite_part_ball(k, int(flint.ctx.prec / LOG2_10) + 1)
        return enclose(expression, {eta: to_ball(ratio), M[k]: finite})

    return refine(compute, digits, f"thin plate's c_{2 * k - 3} at {ratio}")
