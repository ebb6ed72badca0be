"""Formulas of the effects as the code computes them, each proved equal to that of the theory."""

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import (
    GUARDED,
    RAISED,
    Choice,
    Facts,
    Let,
    Routine,
    Several,
    routine,
)
from derivation.plate.contact.theory.reversion import force_formulas
from derivation.plate.contact.theory.spherical_profile import spherical_contact
from derivation.plate.effects.kernels.numbers import NEAR, arc_coefficients, factor
from derivation.plate.effects.theory import bending
from derivation.plate.factors import MODERATE, PRODUCT, YOUNG, multiplied, root
from derivation.plate.impact.theory.sensitivity import reduced_modulus
from derivation.plate.modes.theory.influence import PLANE_STRAIN_MODULUS
from derivation.plate.vocabulary import (
    R,
    a,
    a_ratio,
    b,
    delta,
    delta_0,
    eta,
    h,
    lam,
    m,
    mu,
    rho,
    v0,
)
from derivation.plate.waves.theory.plate_motion import (
    TIME_UNIT,
    K,
    infinite_plate_rates,
    local,
    plate_motion,
    speed,
    weight,
    zener,
)

ZENER, PERIOD = sp.symbols("ZENER PERIOD", positive=True)
_FACTORS: Facts = {ZENER: factor("zener_number"), PERIOD: factor("bending_period")}
a_over_R, square = sp.symbols("a_over_R square", positive=True)
modulus = sp.Symbol("modulus", positive=True)
THREE_HALVES = sp.Float(1.5)


def _by_contact_radius(expression: sp.Expr) -> sp.Expr:
    """Return the expression in a/R, with the hyperbolic arc as a logarithm."""
    reduced = expression.subs(a, a_over_R * R).replace(sp.log, lambda x: sp.log(sp.cancel(x)))
    reduced = reduced.replace(sp.atanh, lambda x: sp.log((1 + x) / (1 - x)) / 2)
    return sp.cancel(reduced)


ARC = (sp.atanh(a_over_R) - a_over_R) / a_over_R**3


@named_routine
def sphere_over_paraboloid() -> Claims:
    """Return force, indentation and its slope of a sphere over those of a paraboloid."""
    arc, series, depth, scaled_force = sp.symbols("arc series depth scaled_force", positive=True)
    far, steep = sp.symbols("far steep", positive=True)
    delta, force = (formula.expression for formula in spherical_contact())
    hertz = sp.Rational(4, 3) * PLANE_STRAIN_MODULUS * a**3 / R
    near = sp.Rational(NEAR)
    limited, cube = GUARDED(square, near), RAISED(square * a_over_R, near ** sp.Rational(3, 2))
    return Claims(
        (a_over_R,),
        (
            Let(square, a_over_R * a_over_R),
            Several((series,), "polynomial", (limited, *arc_coefficients()), (ARC,)),
            Let(far, RAISED(a_over_R, sp.sqrt(near))),
            Choice(arc, sp.Lt(square, near), series, (sp.atanh(far) - far) / cube),
            Let(depth, 1 + square * arc),
            Let(steep, depth + 1 / ((1 - a_over_R) * (1 + a_over_R)), within=True),
            Let(scaled_force, 1 + (1 + square) * arc, within=True),
        ),
        (
            sp.Float(0.75) * scaled_force,
            depth,
            steep / 2,
        ),
        (force / hertz, delta * R / a**2, R / (2 * a) * sp.diff(delta, a)),
        {a_over_R: a / R},
        _by_contact_radius,
    )


@named_routine
def bent_plate() -> Claims:
    """Return the contributions of bending to F and S."""
    part, over, depth = sp.symbols("part over depth", positive=True)
    depth_term = bending().expression
    return Claims(
        (a_ratio, eta),
        (
            Let(part, a_ratio / (4 * sp.pi), within=True),
            Let(over, part / eta, within=True),
            Let(depth, over / eta),
        ),
        (depth, THREE_HALVES * depth),
        (depth_term, depth_term + a_ratio * sp.diff(depth_term, a_ratio) / 2),
        {},
    )


def zener_parameter() -> Routine:
    """Return Zener's parameter."""
    waves = root("waves", 5, (m, m, m, R, v0))
    young = root("young", 5, YOUNG)
    mass = root("mass", 2, (rho, *young.symbols))
    value = PRODUCT(sp.Tuple(ZENER, *waves.symbols), sp.Tuple(h, h, *mass.symbols))
    return _of_motion("zener_number", (R, m, v0, h, lam, mu, rho), (waves, young, mass), value)


@named_routine
def hertz_constant() -> Claims:
    """Return force over indentation^(3/2) on a half-space, by Hertz's law; `modulus` is E*."""
    law = next(f.expression for f in force_formulas() if f.name == "P_half")
    claim = law / delta ** sp.Rational(3, 2)
    return Claims(
        (R, modulus),
        (),
        (4 * modulus / 3 * sp.sqrt(R),),
        (claim,),
        {modulus: reduced_modulus()},
    )


@named_routine
def hertz_depth() -> Claims:
    """Return the largest indentation of a half-space of the constant K of `hertz_constant`."""
    work = sp.integrate(K * delta ** sp.Rational(3, 2), (delta, 0, delta_0))
    claim = (m * v0**2 / 2 / (work / delta_0 ** sp.Rational(5, 2))) ** sp.Rational(2, 5)
    ratio = sp.Symbol("ratio", positive=True)
    value = ratio ** sp.Rational(2, 5) * v0 ** sp.Rational(4, 5)
    return Claims((m, v0, K), (Let(ratio, 5 * m / (4 * K)),), (value,), (claim,), {})


@named_routine
def zener_time_unit() -> Claims:
    """Return the unit of time of Zener's equation; K is that of `hertz_constant`."""
    ratio = sp.Symbol("ratio", positive=True)
    value = ratio ** sp.Rational(2, 5) / v0 ** sp.Rational(1, 5)
    return Claims((m, v0, K), (Let(ratio, m / K),), (value,), (TIME_UNIT,), {})


@named_routine
def zener_rates() -> Claims:
    """Return rates of local indentation and speed on an infinite plate; units: v0 T, v0 and T.

    T is `zener_time_unit` [s] and v0 the impact speed [m/s]: the rate of the indentation is in
    units of v0, that of the speed in units of v0/T, and `weight` is g T/v0.
    """
    force = sp.Symbol("force", positive=True)
    return Claims(
        (local, speed, zener, weight),
        (Let(force, local * sp.sqrt(local)),),
        (speed - zener * force, weight - force),
        tuple(infinite_plate_rates()),
        {},
    )


def first_period() -> Routine:
    """Return the first bending period."""
    slowness = root("slowness", 2, (rho,), *YOUNG)
    value = PRODUCT(sp.Tuple(PERIOD, b, b, *slowness.symbols), sp.Tuple(h))
    return _of_motion("bending_period", (h, b, lam, mu, rho), (slowness,), value)


def echo() -> Routine:
    """Return the time of two reflections."""
    slowness = root("slowness", 2, (rho,), sp.Integer(4), lam / 4 + mu / 2)
    value = PRODUCT(sp.Tuple(8, h, *slowness.symbols))
    return _of_motion("echo_time", (h, lam, mu, rho), (slowness,), value)


def _of_motion(
    name: str, arguments: tuple[sp.Symbol, ...], roots: tuple[Several, ...], value: sp.Expr
) -> Routine:
    """Return the routine of a formula of step 23."""
    formula = {f.name: f for f in plate_motion()}[name]
    scaled = MODERATE if name != "echo_time" else ()
    return routine(
        f"{name}_of_factors",
        arguments,
        (*scaled, *roots),
        (value,),
        (formula.expression,),
        f"{formula.meaning[0].upper()}{formula.meaning[1:]}.",
        _FACTORS,
        multiplied,
    )


ROUTINES = (
    sphere_over_paraboloid,
    bent_plate,
    hertz_constant,
    hertz_depth,
    zener_parameter,
    zener_time_unit,
    zener_rates,
    first_period,
    echo,
)
