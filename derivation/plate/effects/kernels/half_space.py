"""Hertz's law: contact of a paraboloid with a half-space; `modulus` is E*."""

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Let
from derivation.plate.contact.theory.hertz import contact_radius, pressure
from derivation.plate.impact.theory.sensitivity import reduced_modulus
from derivation.plate.vocabulary import P, R, a, r

modulus, flat = sp.symbols("modulus flat", positive=True)
FORCE, DEPTH = contact_radius().expression, a**2 / R
BODIES = {modulus: reduced_modulus()}


@named_routine
def hertz_force() -> Claims:
    """Return the force [N] at a contact radius a [m]."""
    return Claims(
        (a, R, modulus),
        (Let(flat, a / R),),
        (4 * modulus * a**2 * flat / 3,),
        (FORCE,),
        BODIES,
    )


@named_routine
def hertz_stiffness() -> Claims:
    """Return the derivative of the force by the indentation [N/m] at a contact radius a [m]."""
    claim = sp.diff(FORCE, a) / sp.diff(DEPTH, a)
    return Claims((a, modulus), (), (2 * modulus * a,), (claim,), BODIES)


@named_routine
def hertz_pressure() -> Claims:
    """Return the pressure at the centre [Pa] at a contact radius a [m]."""
    compression = -pressure().expression.subs({r: 0, P: FORCE})
    value = 2 * modulus * flat / sp.pi
    return Claims((a, R, modulus), (Let(flat, a / R),), (value,), (compression,), BODIES)


ROUTINES = hertz_force, hertz_stiffness, hertz_pressure
