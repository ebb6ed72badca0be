"""Hertz contact in the variables of an elastic-plastic contact: E*, force, radius."""

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Let
from derivation.plate.contact.theory.hertz import contact_radius
from derivation.plate.factors import PRODUCT
from derivation.plate.modes.theory.influence import PLANE_STRAIN_MODULUS
from derivation.plate.plasticity.theory import contact as theory
from derivation.plate.vocabulary import P, R, a, xi_y

modulus, a_y, energy_ratio, strain = sp.symbols("modulus a_y energy_ratio strain", positive=True)
CUBE_ROOT = sp.Function("np.cbrt")
FORCE = contact_radius().expression
BODIES = {modulus: PLANE_STRAIN_MODULUS}


@named_routine
def hertz_radius() -> Claims:
    """Return the radius at which Hertz's law gives a force."""
    return Claims(
        (P, R, modulus),
        (Let(strain, P / modulus),),
        (CUBE_ROOT(sp.Rational(3, 4) * strain * R),),
        (a,),
        BODIES | {P: FORCE},
        _without_roots,
    )


@named_routine
def hertz_modulus() -> Claims:
    """Return the E* for which Hertz's law gives a force at a radius."""
    return Claims(
        (P, R, a),
        (),
        (sp.Rational(3, 4) * PRODUCT(sp.Tuple(P, R), sp.Tuple(a, a, a)),),
        (PLANE_STRAIN_MODULUS,),
        {P: FORCE},
        _without_roots,
    )


@named_routine
def hertz_energy() -> Claims:
    """Return the energy of a Hertz contact at a radius."""
    brought = sp.integrate(FORCE * sp.diff(a**2 / R, a), (a, 0, a))
    return Claims(
        (a, R, modulus),
        (),
        (sp.Rational(8, 15) * PRODUCT(sp.Tuple(modulus, a, a, a, a, a), sp.Tuple(R, R)),),
        (brought,),
        BODIES,
        _without_roots,
    )


@named_routine
def widening() -> Claims:
    """Return the growth of the contact radius with the force on loading, at a radius."""
    force = P / FORCE.subs(a, a_y)  # xi^3
    radius = a_y * sp.sqrt(theory.loading().area.subs(xi_y, sp.cbrt(force)))
    wide = FORCE.subs(a, a_y) * (3 * a**2 / a_y**2 - 1) / 2
    return Claims(
        (a, a_y, R, modulus),
        (),
        (R / (4 * modulus * a_y * a),),
        (sp.diff(radius, P).subs(P, wide),),
        BODIES,
        _without_roots,
    )


@named_routine
def reached() -> Claims:
    """Return xi at which the loading energy is a multiple of Hertz's at the onset of yield."""
    work, ratio = theory.plastic_work().expression, theory.flattening().expression
    brought = sp.expand(work + ratio * xi_y**5)
    return Claims(
        (energy_ratio,),
        (),
        (((6 * energy_ratio - 1) / 5) ** sp.Rational(1, 6),),
        (xi_y,),
        {energy_ratio: brought},
        _without_roots,
    )


def _without_roots(expression: sp.Expr) -> sp.Expr:
    """Expand products, and take roots of powers."""
    expression_in_roots = expression.replace(CUBE_ROOT, sp.cbrt)
    expression_in_roots = expression_in_roots.replace(
        PRODUCT, lambda above, below: sp.Mul(*above) / sp.Mul(*below)
    )
    return sp.simplify(sp.powdenest(sp.simplify(expression_in_roots), force=True))


ROUTINES = hertz_radius, hertz_modulus, hertz_energy, widening, reached
