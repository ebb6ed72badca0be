"""Impact by Hertz's law and by its first correction: proved formulas for single numbers."""

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Facts, Let, Sums
from derivation.plate.contact.theory.hertz import contact_radius
from derivation.plate.contact.theory.plate_series import coefficient, small_contact
from derivation.plate.contact.theory.thin_plate import thin_coefficient
from derivation.plate.impact.theory.impact import (
    contact_time,
    geometric,
    hertz_time,
    work_of_contact,
)
from derivation.plate.impact.theory.sensitivity import (
    energy_number,
    energy_scale,
    reduced_modulus,
)
from derivation.plate.impact.theory.substitution import exponents, one_sided
from derivation.plate.modes.theory.plate_factor import plate_factors
from derivation.plate.vocabulary import (
    J1,
    D,
    E,
    R,
    T,
    a,
    a_ratio,
    alpha,
    c_A,
    eta,
    j_n,
    lam,
    m,
    mu,
    u_t,
    v0,
)

LATERAL, LATERAL_REST, LATERAL_CUBIC = sp.symbols(
    "LATERAL LATERAL_REST LATERAL_CUBIC", positive=True
)
THIN_LINEAR, THIN_CUBIC, HERTZ_TIME = sp.symbols("THIN_LINEAR THIN_CUBIC HERTZ_TIME", real=True)
FADED_LINEAR, FADED_CUBIC = sp.symbols("FADED_LINEAR FADED_CUBIC", positive=True)
RULE = sp.Symbol("RULE")
gauss = sp.Symbol("w", positive=True)
bend, bend_error, steep, s, x, y = sp.symbols("bend bend_error steep s x y", real=True)
rest, v, over_h, A, modulus, depth = sp.symbols("rest v over_h A modulus depth", positive=True)
fall, rise = sp.symbols("fall rise", nonnegative=True)


def slope_factor(power: int) -> sp.Rational:
    """Return the factor of c A^power in (R/2a) d delta/da, for a term c A^power of delta R/a^2."""
    return sp.diff(A ** (power + 2), A) / (2 * A ** (power + 1))


CUBIC = slope_factor(3)
lateral_linear, lateral_cubic = (-coefficient(k).by_plate_radius[1] for k in (2, 3))
"""Reductions of c_1 and c_3 by the finite radius, over the power of eta."""
MEANING: Facts = {
    LATERAL: lateral_linear,
    LATERAL_CUBIC: LATERAL_REST - CUBIC * lateral_cubic,
    THIN_LINEAR: (thin_coefficient(2).expression - eta**-2 / (4 * sp.pi)).subs(eta, 1),
    THIN_CUBIC: -CUBIC * thin_coefficient(3).expression.subs(eta, 1),
    HERTZ_TIME: hertz_time().expression,
}
"""Meaning of the module's constants, except bounds."""
_q = 1 - u_t**2
ROW = (_q, 6 * geometric(5, _q), 5 * geometric(6, _q), 8 * _q * gauss)
"""A row of Gauss' rule: q = a/a_m at a node, sums of its powers, and 8 q times the weight."""


def most(c_1: sp.Expr, radius: sp.Expr) -> sp.Expr:
    """Return S_1 = 1 + 3/2 c_1 A."""
    law: sp.Expr = one_sided().expression.subs({c_A[1]: c_1, a_ratio: radius})
    return law


@named_routine
def thick_plate() -> Claims:
    """Return c_1, the size of its parts, K_3, and the contributions of omitted modes."""
    rows, zero, weight, exponential, deficit, term, linear, cubic = sp.symbols(
        "modes zero weight exponential deficit term linear cubic", positive=True
    )
    height, square = sp.symbols("T square", positive=True)
    sums = Sums(
        (linear, cubic),
        (term, term * zero**2),
        rows,
        (zero, weight),
        (
            Let(height, 2 * eta * zero),
            Let(square, height**2),
            Let(exponential, sp.exp(-2 * height), "(sinh T)^2 = (1 - e)^2/(4 e), e = e^(-2T)"),
            Let(deficit, 1 - exponential),
            Let(exponential, 4 * exponential),
            Let(
                term,
                weight
                * exponential
                * (deficit / 2 + height + square)
                / (deficit**2 - exponential * square),
            ),
        ),
    )
    first, third = coefficient(2), coefficient(3)
    at = 2 * eta * j_n
    own = plate_factors()[2].expression.subs(T, at) / (j_n * J1**2)
    return Claims(
        (eta, rows),
        (sums,),
        (
            eta * (8 * linear / (3 * sp.pi) - LATERAL),
            eta * (8 * linear / (3 * sp.pi) + LATERAL),
            2 * cubic / (3 * sp.pi) * eta**3 + LATERAL_REST * eta**3,
            8 * eta * FADED_LINEAR / (3 * sp.pi),
            eta * FADED_CUBIC / (6 * sp.pi),
        ),
        (
            first.mode + first.side,
            first.mode - first.side,
            -CUBIC * third.mode + LATERAL_REST * alpha**3 / a_ratio**3,
            first.mode,
            -CUBIC * third.mode,
        ),
        {
            **MEANING,
            zero: j_n,
            weight: 1 / (j_n * J1**2),
            FADED_LINEAR: own,
            FADED_CUBIC: own * at**2,
        },
        lambda e: e.subs(alpha, eta * a_ratio),
    )


@named_routine
def thin_plate() -> Claims:
    """Return c_1 and K_3 of a thin plate for 1/eta = v without the roots' part, and its decay."""
    logarithm = sp.Symbol("logarithm", real=True)
    claim = -CUBIC * (thin_coefficient(3).expression - coefficient(3).side)
    return Claims(
        (v,),
        (Let(logarithm, sp.log(v)),),
        (
            v**2 / (4 * sp.pi) + (THIN_LINEAR + 4 * logarithm / (5 * sp.pi)),
            THIN_CUBIC + logarithm / (4 * sp.pi) + LATERAL_CUBIC / v**3,
            sp.exp(-sp.pi * v),
        ),
        (thin_coefficient(2).expression, claim + LATERAL_REST * eta**3, sp.exp(-sp.pi / eta)),
        {**MEANING, v: 1 / eta},
        lambda e: sp.expand(sp.expand_log(e, force=True)),
    )


@named_routine
def sphere() -> Claims:
    """Return E*, twice the initial kinetic energy, and the fifth power of Hertz's largest a."""
    energy = sp.Symbol("energy", positive=True)
    C = contact_radius().expression / a**3 / R
    brought = energy_number().expression * energy_scale().subs(E, reduced_modulus())
    return Claims(
        (R, m, v0, lam, mu),
        (Let(modulus, 4 * mu * ((lam + mu) / (lam + 2 * mu))), Let(energy, m * v0**2)),
        (modulus, energy, sp.Rational(15, 16) * (energy / modulus) * R**2),
        (reduced_modulus(), 2 * brought, brought / (C * work_of_contact(0))),
        {},
    )


@named_routine
def hertz_bounds() -> Claims:
    """Return how much S at A may be below 1, and above 1."""
    upper, lower = most(bend + bend_error, A), most(bend - bend_error, A) - rest * A**3
    factor = sp.Symbol("factor", positive=True)
    return Claims(
        (bend, bend_error, rest, A),
        (Let(factor, 3 * A / 2),),
        (rest * A**3 - factor * (bend - bend_error), factor * (bend + bend_error)),
        (1 - lower, upper - 1),
        {},
    )


@named_routine
def steepness() -> Claims:
    """Return S_1 - 1 at A."""
    return Claims((bend, A), (), (3 * bend * A / 2,), (most(bend, A) - 1,), {})


@named_routine
def leading_bounds() -> Claims:
    """Return changes over S_1 at A, by an error of c_1 and by K_3 A^3; and d log S_1/d log A."""
    slope_ratio = sp.Symbol("slope_ratio", positive=True)
    law = most(bend, A)
    meaning: Facts = {steep: law - 1}
    return Claims(
        (bend_error, rest, steep, A),
        (Let(slope_ratio, 1 + steep),),
        (
            3 * bend_error * A / (2 * slope_ratio),
            rest * A**2 * (A / slope_ratio),
            steep / slope_ratio,
        ),
        (most(bend + bend_error, A) / law - 1, rest * A**3 / law, A * sp.diff(law, A) / law),
        meaning,
    )


def _work(c_1: sp.Expr) -> sp.Expr:
    """Return the work up to A over that by Hertz's law."""
    return sp.expand(work_of_contact(1) / work_of_contact(0)).subs(D[3], c_1)


@named_routine
def beside_hertz() -> Claims:
    """Return the first correction's relative contribution to the work up to Hertz's largest A."""
    return Claims((bend, over_h), (), (5 * bend * over_h / 4,), (_work(bend * over_h) - 1,), {})


@named_routine
def work_step() -> Claims:
    """Return s^5 (1 + y s) - 1, the work up to s times Hertz's radius, and its derivative d/ds."""
    fourth, inner = sp.symbols("fourth inner", real=True)
    work = s**5 * _work(s * sp.Symbol("z", real=True))
    z = 4 * y / 5
    claim = work.subs(sp.Symbol("z", real=True), z) - 1
    return Claims(
        (s, y),
        (Let(fourth, s**4), Let(inner, s * y)),
        (fourth * s * (1 + inner) - 1, fourth * (5 + 6 * inner)),
        (claim, sp.diff(claim, s)),
        {},
    )


@named_routine
def leading_time() -> Claims:
    """Return the contact time by Gauss' rule; x is S_1 - 1 at the largest radius a."""
    q, fifth, sixth, weight, total = sp.symbols("q fifth sixth weight total", positive=True)
    whole = 6 + 5 * x
    sums = Sums(
        (total,),
        (weight * (1 + x * q) * sp.sqrt(whole / (fifth + x * sixth)),),
        RULE,
        (q, fifth, sixth, weight),
    )
    integrand = contact_time(1)[0].expression
    claim = 2 * (a**2 / R) / v0 * sp.sqrt(work_of_contact(1)) * gauss * integrand
    row: Facts = dict(zip((q, fifth, sixth, weight), ROW, strict=True))
    return Claims(
        (a, R, v0, x),
        (sums,),
        (total * (a**2 / R) / v0,),
        (claim,),
        {**row, x: most(D[3] / a_ratio, a_ratio) - 1},
    )


@named_routine
def hertz_peaks() -> Claims:
    """Return contact time, indentation and force on a half-space at the largest contact radius."""
    law = a**2 / R
    return Claims(
        (a, R, v0, modulus),
        (Let(depth, a**2 / R),),
        (HERTZ_TIME * depth / v0, depth, 4 * modulus / 3 * a * depth),
        (hertz_time().expression * law / v0, law, contact_radius().expression),
        {**MEANING, modulus: reduced_modulus()},
    )


@named_routine
def peaks() -> Claims:
    """Return indentation and force at a contact radius; bending_part is c_1 A."""
    bending_part = sp.Symbol("bending_part", real=True)
    law = small_contact().expression.subs({c: 0 for n, c in c_A.items() if n > 1})
    return Claims(
        (a, R, modulus, bending_part),
        (),
        (a**2 / R * (1 + bending_part), 4 * modulus / 3 * a**2 * (a / R)),
        (a**2 / R * law, contact_radius().expression),
        {modulus: reduced_modulus(), bending_part: c_A[1] * a_ratio},
    )


@named_routine
def elasticities() -> Claims:
    """Return d/dlog of the largest radius of the logarithms of work, indentation and time."""
    powers = exponents(fall, rise)
    return Claims(
        (fall, rise), (), tuple(powers.values()), tuple(exponents(fall, rise).values()), {}
    )


ROUTINES = (
    thick_plate,
    thin_plate,
    sphere,
    hertz_bounds,
    steepness,
    leading_bounds,
    beside_hertz,
    work_step,
    leading_time,
    hertz_peaks,
    peaks,
    elasticities,
)
