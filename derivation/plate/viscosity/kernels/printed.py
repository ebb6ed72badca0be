"""Formulas of the viscoelastic contact as code computes them, each proved."""

import sympy as sp
from sympy.codegen.cfunctions import expm1, log1p

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Let
from derivation.plate.factors import MODERATE, PRODUCT, YOUNG, multiplied, root
from derivation.plate.viscosity.theory import bounds as theory
from derivation.plate.viscosity.theory.contact import (
    C_1,
    P_e,
    compliance,
    delayed_force,
    epsilon,
    lag,
    rate,
    stiffness,
)
from derivation.plate.viscosity.theory.contact import viscous_number as number
from derivation.plate.viscosity.theory.contact import weak_restitution as restitution
from derivation.plate.viscosity.theory.two_bodies import (
    contact_time,
    plate_time,
    softness,
    sphere_time,
)
from derivation.plate.vocabulary import R, lam, m, mu, v0, viscous_time, x_v

LOSS = sp.Symbol("LOSS", positive=True)
energy_loss = sp.Symbol("energy_loss", positive=True)
STIFFNESS = sp.Rational(16, 3), *YOUNG[1:]
"""(4/3) E* as factors."""


@named_routine
def viscous_number_of_factors() -> Claims:
    """Return the viscous parameter x_v."""
    rate = root("rate", 5, (*STIFFNESS, *STIFFNESS, R, v0), m, m)
    return Claims(
        (R, m, v0, lam, mu, viscous_time),
        (*MODERATE, rate),
        (PRODUCT(sp.Tuple(sp.Float(1.5), viscous_time, *rate.symbols)),),
        (number().expression,),
        {},
        lambda e: sp.nsimplify(multiplied(e)),
    )


@named_routine
def restitution_of_number() -> Claims:
    """Return the restitution of a weakly viscoelastic contact to second order."""
    first = sp.Symbol("first", positive=True)
    return Claims(
        (x_v,),
        (Let(first, LOSS * x_v),),
        (1 + first * (sp.Float(0.6) * first - 1),),
        (restitution().expression,),
        {LOSS: C_1},
        lambda e: sp.expand(sp.nsimplify(e)),
    )


def _by_logarithms(expression: sp.Expr) -> sp.Expr:
    reduced = expression.replace(expm1, lambda x: sp.exp(x) - 1)
    reduced = reduced.replace(log1p, lambda x: sp.log(1 + x))
    return sp.simplify(sp.expand_log(reduced.replace(sp.log, lambda x: sp.log(sp.factor(x)))))


@named_routine
def spiral_bounds() -> Claims:
    """Return logarithms for time, depth, radius and force, and the largest energy loss."""
    quarter, loss, square, pull = sp.symbols("quarter loss square pull", positive=True)
    of, t = theory.bounds(), theory
    return Claims(
        (epsilon, t.steepness, t.fall, t.rise, t.depth, t.radius, t.energy),
        (
            Let(quarter, sp.pi / 4 * epsilon),
            Let(loss, 2 * quarter / (1 - epsilon / 2)),
            Let(square, epsilon * epsilon),
            Let(pull, log1p(square) / 2),
        ),
        (
            t.rise * loss - log1p(-epsilon / 2),
            t.fall * loss + log1p(epsilon / 2) - log1p(-t.steepness * epsilon / 2),
            t.depth * quarter,
            t.radius * quarter,
            pull,
            (1 + t.rise) * quarter,
            -expm1(-2 * (loss + pull)) * t.energy,
        ),
        (of.longer, of.shorter, of.depth, of.radius, of.pull, of.weaker, of.energy_loss),
        {},
        _by_logarithms,
    )


@named_routine
def rebound_bounds() -> Claims:
    """Return logarithms for the restitution: from the energy loss, and from the weight."""
    of, t = theory.bounds(), theory
    return Claims(
        (energy_loss, epsilon, t.steepness, t.energy),
        (),
        (-log1p(-energy_loss) / 2, log1p((t.energy - 1) * t.steepness * epsilon) / 2),
        (of.slower, of.faster),
        {energy_loss: of.energy_loss},
        _by_logarithms,
    )


@named_routine
def retardation_of_two() -> Claims:
    """Return the retardation time of a contact: its bodies' mean, weighted by compliance."""
    return Claims(
        (plate_time, sphere_time, softness),
        (),
        ((plate_time + softness * sphere_time) / (1 + softness),),
        (contact_time().expression,),
        {},
        sp.simplify,
    )


@named_routine
def viscous_force() -> Claims:
    """Return the force [N] of a contact with the elastic force P_e, if the plate does not bend."""
    exact = delayed_force().by_rate
    return Claims((P_e, stiffness, rate, viscous_time), (), (exact,), (exact,), {})


@named_routine
def bent_viscous_force() -> Claims:
    """Return the force [N] and dP_e/dt [N/s] if the plate bends elastically."""
    force, elastic_rate = delayed_force().force, delayed_force().elastic_rate
    more = sp.Symbol("more", real=True)
    return Claims(
        (P_e, lag, compliance, viscous_time),
        (Let(more, lag / compliance),),
        (P_e + more, more / viscous_time),
        (force, elastic_rate),
        {},
        sp.simplify,
    )


ROUTINES = viscous_number_of_factors, restitution_of_number, viscous_force, bent_viscous_force
BOUNDS = spiral_bounds, rebound_bounds
BODIES = (retardation_of_two,)
