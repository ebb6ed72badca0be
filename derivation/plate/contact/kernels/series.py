"""Correction F of the contact law as the code computes it, proved equal to that of the theory.

For a thin plate F = c1 A + c3 A^3 + Phi(A), v = 1/eta = b/h; for any plate it is a sum over the
modes. Where the code uses a polynomial instead, F = A S(t) with t = (A^2 - middle)/half.
"""

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Facts, Let, Routine, Several, routine
from derivation.engine.formula.functions import unspecified_function
from derivation.plate.blocks import blocks
from derivation.plate.contact.theory.split import reduced_split
from derivation.plate.contact.theory.thin_law import sine_kernel
from derivation.plate.contact.theory.thin_plate import thin_coefficient
from derivation.plate.modes.theory.plate_factor import plate_factor_slope, plate_factors
from derivation.plate.vocabulary import J1, T, alpha, eta, j_n

v, log_v, linear, cubic, rest = sp.symbols("v log_v linear cubic rest", positive=True)
REACH, MIDDLE, HALF = sp.symbols("REACH FAR_MIDDLE FAR_HALF", positive=True)
LINEAR, CUBIC = sp.symbols("LINEAR CUBIC", real=True)
A, square, middle, half, inverse_half = sp.symbols(
    "A square middle half inverse_half", positive=True
)
F, S, slope, curve, step, order = sp.symbols("F S slope curve step order", real=True)
y, weight, excess, total, rise, limited, shape, ratio = sp.symbols(
    "y weight excess total rise limited shape ratio", positive=True
)
change, steep, first, second = sp.symbols("change steep first second", real=True)


# --- the closed form of a thin plate


def thin(k: int) -> sp.Expr:
    """Return c_(2k-3) as a function of v."""
    coefficient: sp.Expr = thin_coefficient(k).expression.subs(eta, 1 / v)
    return coefficient


def constant(k: int) -> sp.Expr:
    """Return the part of c_(2k-3) that does not depend on v."""
    return thin(k).subs(v, 1) - thin(k).diff(v, 2).limit(v, sp.oo) / 2


THIN: Facts = {LINEAR: constant(2), CUBIC: constant(3)}
"""Meaning of the constants."""


def _with_logarithm(expression: sp.Expr) -> sp.Expr:
    return sp.expand(sp.expand_log(sp.expand(expression), force=True))


@named_routine
def thin_coefficients() -> Claims:
    """Return c1 and c3 of a thin plate."""
    claims = _with_logarithm(thin(2)), _with_logarithm(thin(3))
    by_log = [part.coeff(sp.log(v)) for part in claims]
    grows = claims[0].coeff(v**2)
    return Claims(
        (v,),
        (
            Let(log_v, sp.log(v)),
            Let(rest, LINEAR + by_log[0] * log_v),
        ),
        (grows * v**2 + rest, CUBIC + by_log[1] * log_v),
        (thin(2), thin(3)),
        THIN,
        _with_logarithm,
    )


def in_powers(center: sp.Expr, width: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return the contributions of c1 and c3 to S_0 and S_1, t = (A^2 - center)/width."""
    t = sp.Symbol("t", real=True)
    polynomial = sp.Poly(linear + cubic * (center + width * t), t)
    return polynomial.coeff_monomial(1), polynomial.coeff_monomial(t)


def thin_start(name: str, center: sp.Expr, width: sp.Expr) -> Routine:
    """Return the routine of the contributions of c1 and c3 to a polynomial."""
    t = sp.Symbol("t", real=True)
    law = sp.expand((thin(2) * A + thin(3) * A**3) / A).subs(A, sp.sqrt(center + width * t))
    law = sp.Poly(sp.expand(law), t)
    exact = thin(2), thin(3)
    return routine(
        name,
        (v,),
        (Several((linear, cubic), "thin_coefficients", (v,), exact),),
        in_powers(center, width),
        (law.coeff_monomial(1), law.coeff_monomial(t)),
        "Return the contributions of c1 A + c3 A^3 to S_0 and S_1.",
        THIN,
        _with_logarithm,
    )


def thin_near() -> Routine:
    """Return the routine of the contributions of c1 and c3 to the first polynomial."""
    return thin_start("thin_near", sp.Integer(0), REACH**2)


def thin_far() -> Routine:
    """Return the routine of the contributions of c1 and c3 to the second polynomial."""
    return thin_start("thin_far", MIDDLE, HALF)


@named_routine
def linear_by_log() -> Claims:
    """Return the derivative of c1 with respect to log v."""
    derivative = sp.expand(v * sp.diff(thin(2), v))
    return Claims(
        (v,),
        (),
        (derivative,),
        (-eta * sp.diff(thin_coefficient(2).expression, eta),),
        {v: 1 / eta},
        sp.simplify,
    )


def cubic_by_log() -> sp.Expr:
    """Return the derivative of c3 with respect to log v, a number."""
    return sp.simplify(v * sp.diff(thin(3), v))


# --- modes

MODE_TERM = reduced_split()[1].expression
"""One mode's term of F."""
WEIGHT = plate_factors()[2].expression.subs(T, 2 * eta * j_n) / (j_n * J1**2)
"""w_n."""


@named_routine
def mode_weight() -> Claims:
    """Return w_n, the weight of a mode."""
    exact = plate_factors()[2].expression.subs(T, 2 * eta * j_n)
    return Claims(
        (eta, j_n, J1),
        (Several((excess,), "G_minus_1", (2 * eta * j_n,), (exact,)),),
        (excess / (j_n * J1**2),),
        (MODE_TERM / (8 * alpha / sp.pi * sine_kernel(alpha * j_n)),),
        {},
        sp.simplify,
    )


@named_routine
def weight_by_thickness() -> Claims:
    """Return the derivative of w_n with respect to log(h/b)."""
    exact = plate_factor_slope().expression.subs(T, 2 * eta * j_n)
    return Claims(
        (eta, j_n, J1),
        (Several((excess,), "G_slope", (2 * eta * j_n,), (exact,)),),
        (excess / (j_n * J1**2),),
        (eta * sp.diff(WEIGHT, eta),),
        {},
    )


@named_routine
def mode_terms() -> Claims:
    """Return one mode's terms of both sums, y = alpha j_n."""
    block = blocks()["hertz_shape"]
    return Claims(
        (y, weight),
        (
            Let(limited, sp.Min(y, block.near(sp.oo)), opaque=True),
            Several((shape,), "hertz_shape", (y,), ((sp.sin(y) / y - sp.cos(y)) / limited**2,)),
            Let(ratio, limited / y),
            Let(first, shape * ratio**2),
        ),
        (weight * first, weight * (sp.sinc(y) - 2 * first)),
        (
            weight * sine_kernel(y),
            weight * sp.diff(y * sine_kernel(y), y),
        ),
        {},
        lambda e: sp.simplify(e.replace(sp.sinc, lambda x: sp.sin(x) / x)),
    )


@named_routine
def of_modes() -> Claims:
    """Return the contributions of the modes to F and A F'."""
    kernel = sine_kernel(y)
    sums = {total: kernel, rise: sp.diff(y * kernel, y)}
    return Claims(
        (alpha, total, rise),
        (Let(ratio, 8 * alpha / sp.pi),),
        (ratio * total, ratio * rise),
        (MODE_TERM, alpha * sp.diff(MODE_TERM, alpha)),
        {name: WEIGHT * value.subs(y, alpha * j_n) for name, value in sums.items()},
        sp.simplify,
    )


# --- polynomials


SeriesCurve = unspecified_function("SeriesCurve")
"""S''/2 of t."""
SeriesSlope = unspecified_function("SeriesSlope", lambda t: 2 * SeriesCurve(t))
"""S' of t."""
Series = unspecified_function("Series", SeriesSlope)
"""S as a function of t."""
PLACE = (A**2 - middle) / half
"""t."""
LAW = A * Series(PLACE)
"""F."""
POLYNOMIAL: Facts = {
    S: Series(PLACE),
    slope: SeriesSlope(PLACE),
    curve: SeriesCurve(PLACE),
    square: A**2,
    inverse_half: 1 / half,
}
"""Result of Horner's rule."""


def by_log_radius(expression: sp.Expr) -> sp.Expr:
    """Return the derivative with respect to log A."""
    return A * sp.diff(expression, A)


@named_routine
def with_slope_of() -> Claims:
    """Return F and A F' from A, A^2, S and dS/dt."""
    return Claims(
        (A, square, inverse_half, S, slope),
        (Let(step, square * inverse_half), Let(F, A * S)),
        (F, F + 2 * A * step * slope),
        (LAW, by_log_radius(LAW)),
        POLYNOMIAL,
        sp.expand,
    )


@named_routine
def with_slopes_of() -> Claims:
    """Return F, A F' and A (A F')' from A, A^2, S, dS/dt and (d^2 S/dt^2)/2."""
    return Claims(
        (A, square, inverse_half, S, slope, curve),
        (
            Let(step, square * inverse_half),
            Let(F, A * S),
            Let(steep, A * step * slope),
            Let(change, A * step * step * curve),
        ),
        (F, F + 2 * steep, F + 8 * steep + 8 * change),
        (LAW, by_log_radius(LAW), by_log_radius(by_log_radius(LAW))),
        POLYNOMIAL,
        sp.expand,
    )


TableSlope = unspecified_function("TableSlope")
"""Derivative of `Table` with respect to log(eta)."""
Table = unspecified_function("Table", TableSlope)
"""S_k/eta of a thick plate, t = (a/b)^2, as a function of log(eta)."""


@named_routine
def thick_by_thickness() -> Claims:
    """Return dS_k/dlog(h/b) at fixed A, in powers of A eta; order is 2k + 1."""
    coefficient = eta**order * Table(sp.log(eta))
    return Claims(
        (order, S, eta, change),
        (),
        (eta * change + order * S,),
        (eta * sp.diff(coefficient, eta) / eta ** (order - 1),),
        {S: eta * Table(sp.log(eta)), change: TableSlope(sp.log(eta))},
        sp.simplify,
    )


@named_routine
def range_by_thickness() -> Claims:
    """Return dt/dlog v at fixed A, divided by -(1 + t), for ranges up to A = v."""
    start = sp.Symbol("start", positive=True)
    place = PLACE.subs({middle: (v**2 + start**2) / 2, half: (v**2 - start**2) / 2})
    return Claims(
        (v, half),
        (),
        (v * v / half,),
        (sp.simplify(-v * sp.diff(place, v) / (1 + place)),),
        {half: (v**2 - start**2) / 2},
        sp.simplify,
    )


ROUTINES = (
    thin_coefficients,
    thin_near,
    thin_far,
    linear_by_log,
    mode_weight,
    weight_by_thickness,
    mode_terms,
    of_modes,
    with_slope_of,
    with_slopes_of,
    thick_by_thickness,
    range_by_thickness,
)
