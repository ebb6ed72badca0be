"""Link 14, for all contact radii: F = c_1 A + c_3 A^3 + Phi(A) for a thin plate, A = a/h.

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
from derivation.plate.contact.theory.plate_series import FIRST, LAST, sine_coefficient
from derivation.plate.contact.theory.thin_plate import (
    excess_for_large,
    finite_part_ball,
    plate_excess,
    plate_factor_at_zero,
    regular_part,
    thin_coefficient,
)
from derivation.plate.modes.theory.plate_factor import plate_factors
from derivation.plate.vocabulary import Formula, M, T, a_ratio, eta

_y = sp.Symbol("y", positive=True)
SERIES_REACH = 4
"""|y| below which the kernel is computed by its power series."""


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
        "start": series.coeff(_y, 0) + series.coeff(_y, 2) * _y**2 - low,
    }
    for k in range(4, LAST + 1):
        term = 2 * a_ratio / sp.pi * series.coeff(_y, 2 * k - 4) * (y / T) ** (2 * k - 4) * M[k]
        residuals[f"c_{2 * k - 3}"] = term - thin_coefficient(k).expression * a_ratio ** (2 * k - 3)
    mean = sp.integrate((1 - T**2) * sp.cos(_y * T) / 2, (T, 0, 1))
    residuals["mean of cosines"] = sp.expand(mean - sine_kernel(_y))
    proof = prove(
        "Thin plate's universal part",
        r"The terms of $M_k$, $k \ge 4$, are those of $s(y)/y^3$ beyond its first two; "
        "$s(y)/y^3$ is a mean of cosines, so that the error of each truncation of its series is "
        "below the next term.",
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


@cache
def _kernel_series(bits: int) -> tuple[flint.acb_poly, flint.arb]:
    """Return (s(y)/y^3 - 1/3 + y^2/30)/y^4 in powers of y^2, and its truncation error for |y| <= 4.

    Coefficients are below 1/(2m+6)!, and each term is less than half of the previous one.
    """
    count = 4
    while flint.arb(SERIES_REACH) ** (2 * count) / flint.arb.fac_ui(2 * count + 6) > (
        flint.arb(2) ** -bits
    ):
        count += 1
    values = [sine_coefficient(m + 4) for m in range(count)]
    terms = flint.acb_poly([flint.fmpq(int(q.p), int(q.q)) for q in values])
    return terms, 2 * flint.arb(SERIES_REACH) ** (2 * count) / flint.arb.fac_ui(2 * count + 6)


def _kernel(y: flint.acb) -> flint.acb:
    """Return (s(y)/y^3 - 1/3 + y^2/30)/y^4 on a complex ball."""
    if y.abs_upper() < SERIES_REACH:
        series, rest = _kernel_series(flint.ctx.prec)
        spread = flint.arb(0, rest.upper())
        return series(y * y) + flint.acb(spread, spread)
    return ((y.sin() - y * y.cos()) / y**3 - flint.acb(1) / 3 + y * y / 30) / y**4


@cache
def universal_ball(A: Exact, digits: int = 30) -> flint.arb:
    """Return a ball around Phi(A), A > 0, with a relative radius below 10^-digits.

    The form that ball arithmetic evaluates is Phi = A^5/(8 pi) int T^4 (kernel/y^4) (G - 1) dT.
    """
    excess_for_large()
    universal_part()
    g = plate_factor_at_zero()
    third, first = (int(g.at(-3)), flint.fmpq(int(g.at(-1).p), int(g.at(-1).q)))

    def compute() -> flint.arb:
        half = to_ball(A) / 2
        end = flint.arb(int(0.6 * flint.ctx.prec) + 20)

        def near(x: flint.acb, _: bool) -> flint.acb:
            return _kernel(half * x) * (third * x + first * x**3 + x**4 * (regular_part(x) - 1))

        def far(x: flint.acb, _: bool) -> flint.acb:
            return _kernel(half * x) * x**4 * plate_excess(x)

        total = flint.acb.integral(near, flint.acb(0), flint.acb(1)).real
        total += flint.acb.integral(far, flint.acb(1), flint.acb(end)).real
        # |kernel| <= 1/840, and G - 1 <= 16 T^2 e^(-2T) for T >= 2; from T = 6 on
        # the logarithm of the integrand decreases by at least 1 per unit of T.
        rest = 16 * end**6 * (-2 * end).exp() / 840
        return 2 * half**5 * 2 / flint.arb.pi() * (total + flint.arb(0, rest.upper()))

    return refine(compute, digits, f"Phi({A})")


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


def thin_law_ball(A: Exact, ratio: Exact, digits: int = 30) -> flint.arb:
    """Return a ball around c_1 A + c_3 A^3 + Phi(A), the thin plate's F."""

    def compute() -> flint.arb:
        more = int(flint.ctx.prec / LOG2_10) + 1
        radius = to_ball(A)
        low = (thin_coefficient_ball(k, ratio, more) * radius ** (2 * k - 3) for k in (FIRST, 3))
        return sum(low, universal_ball(A, more))

    return refine(compute, digits, f"thin plate's F at {A, ratio}")
