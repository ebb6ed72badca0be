"""Hertz's contact as one that yields needs it: by E* of both bodies, and by its force."""

import sympy as sp

from derivation.engine.emit.routine import Let, Routine, routine
from derivation.plate.contact.theory.hertz import contact_radius
from derivation.plate.factors import PRODUCT
from derivation.plate.modes.theory.influence import PLANE_STRAIN_MODULUS
from derivation.plate.plasticity.theory import contact as theory
from derivation.plate.vocabulary import P, R, a, xi_y

modulus, a_y, energy_ratio, strain = sp.symbols("modulus a_y energy_ratio strain", positive=True)
CUBE_ROOT = sp.Function("np.cbrt")
FORCE = contact_radius().expression
BODIES = {modulus: PLANE_STRAIN_MODULUS}


def hertz_radius() -> Routine:
    """Radius by the force."""
    return routine(
        "hertz_radius",
        (P, R, modulus),
        (Let(strain, P / modulus),),
        (CUBE_ROOT(sp.Rational(3, 4) * strain * R),),
        (a,),
        "Radius at which Hertz's law has a force.",
        BODIES | {P: FORCE},
        _cleared,
    )


def hertz_modulus() -> Routine:
    """E* by force and radius."""
    return routine(
        "hertz_modulus",
        (P, R, a),
        (),
        (sp.Rational(3, 4) * PRODUCT(sp.Tuple(P, R), sp.Tuple(a, a, a)),),
        (PLANE_STRAIN_MODULUS,),
        "E* with which Hertz's law has a force at a radius.",
        {P: FORCE},
        _cleared,
    )


def hertz_energy() -> Routine:
    """Energy by the radius."""
    brought = sp.integrate(FORCE * sp.diff(a**2 / R, a), (a, 0, a))
    return routine(
        "hertz_energy",
        (a, R, modulus),
        (),
        (sp.Rational(8, 15) * PRODUCT(sp.Tuple(modulus, a, a, a, a, a), sp.Tuple(R, R)),),
        (brought,),
        "Energy that Hertz's contact takes up to a radius.",
        BODIES,
        _cleared,
    )


def widening() -> Routine:
    """How fast the contact that yields widens: its area grows with the force."""
    force = P / FORCE.subs(a, a_y)  # xi^3
    radius = a_y * sp.sqrt(theory.loading().area.subs(xi_y, sp.cbrt(force)))
    wide = FORCE.subs(a, a_y) * (3 * a**2 / a_y**2 - 1) / 2
    return routine(
        "widening",
        (a, a_y, R, modulus),
        (),
        (R / (4 * modulus * a_y * a),),
        (sp.diff(radius, P).subs(P, wide),),
        "Growth of the contact radius with the force on loading, at a radius.",
        BODIES,
        _cleared,
    )


def reached() -> Routine:
    """xi by the energy brought."""
    work, ratio = theory.plastic_work().expression, theory.flattening().expression
    brought = sp.expand(work + ratio * xi_y**5)
    return routine(
        "reached",
        (energy_ratio,),
        (),
        (((6 * energy_ratio - 1) / 5) ** sp.Rational(1, 6),),
        (xi_y,),
        "xi up to which loading takes an energy, over Hertz's at the onset of yield.",
        {energy_ratio: brought},
        _cleared,
    )


def _cleared(expression: sp.Expr) -> sp.Expr:
    """Products as such, and roots of powers taken."""
    found = expression.replace(CUBE_ROOT, sp.cbrt)
    found = found.replace(PRODUCT, lambda above, below: sp.Mul(*above) / sp.Mul(*below))
    return sp.simplify(sp.powdenest(sp.simplify(found), force=True))


ROUTINES = hertz_radius, hertz_modulus, hertz_energy, widening, reached
