"""Formulas of the elastic-plastic contact as code computes them, each proved."""

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Let
from derivation.plate.factors import MODERATE, PRODUCT, YOUNG, multiplied, root
from derivation.plate.plasticity.theory import contact as theory
from derivation.plate.vocabulary import R, lam, m, mu, xi_y, yield_stress

beyond, cube, ratio, cubed = sp.symbols("beyond cube ratio cubed", positive=True)
THREE = sp.Integer(3)
MODULUS_RATIO, DOUBLED = YOUNG[2], 2 * cube + 1
BEYOND = Let(beyond, xi_y - 1)
CUBE = Let(cube, xi_y * xi_y * xi_y)
RATIO = Let(ratio, xi_y * sp.sqrt(THREE / DOUBLED))


@named_routine
def yield_radius_of_factors() -> Claims:
    """Return the contact radius at which the largest Hertz pressure is 1.6 Y."""
    return Claims(
        (R, lam, mu, yield_stress),
        MODERATE,
        (PRODUCT(sp.Tuple(sp.pi / 5, R, yield_stress), sp.Tuple(mu, MODULUS_RATIO)),),
        (theory.yield_radius().expression,),
        {},
        multiplied,
    )


@named_routine
def yield_speed_of_factors() -> Claims:
    """Return the impact speed at which a half-space begins to yield."""
    above = (sp.Rational(64, 75) * sp.pi, yield_stress, R, R, R)
    rate = root("rate", 2, above, m)
    strain = sp.pi / 5, yield_stress, sp.pi / 5, yield_stress
    return Claims(
        (R, m, lam, mu, yield_stress),
        (*MODERATE, rate),
        (
            PRODUCT(
                sp.Tuple(*strain, *rate.symbols), sp.Tuple(mu, MODULUS_RATIO, mu, MODULUS_RATIO)
            ),
        ),
        (theory.yield_speed().expression,),
        {},
        multiplied,
    )


@named_routine
def loaded() -> Claims:
    """Return the plastic part of the indentation on loading over a_y^2/R, and its slope by xi."""
    extra = theory.plastic_indentation().expression
    return Claims(
        (xi_y,),
        (BEYOND,),
        (beyond * beyond * (2 * xi_y + 1) / 3, 2 * xi_y * beyond),
        (extra, sp.diff(extra, xi_y)),
        {},
    )


@named_routine
def unloaded() -> Claims:
    """Return Hertz over actual radius at unloading, and residual indentation over a_y^2/R."""
    cubic = beyond * (xi_y * xi_y + xi_y + 1)
    squared = sp.Symbol("squared", positive=True)
    return Claims(
        (xi_y,),
        (BEYOND, CUBE, RATIO, Let(squared, (cubic / DOUBLED) ** 2), Let(cubed, ratio**3)),
        (ratio, squared * (8 * cube + 1) / (3 * (1 + cubed))),
        (theory.flattening().expression, theory.dent().expression),
        {},
        _by_roots,
    )


@named_routine
def worked() -> Claims:
    """Return plastic work over energy at the onset of yield, and restitution of a half-space."""
    quintic = sp.Symbol("quintic", positive=True)
    brought = ((((5 * xi_y + 4) * xi_y + 3) * xi_y + 2) * xi_y + 1) / 6
    return Claims(
        (xi_y,),
        (
            BEYOND,
            CUBE,
            RATIO,
            Let(quintic, cube * xi_y * xi_y),
            Let(cubed, quintic * (2 * xi_y + 1) / (DOUBLED * (1 + ratio))),
        ),
        (
            beyond * beyond * (brought + cubed),
            sp.sqrt(6 * ratio * quintic / (5 * quintic * xi_y + 1)),
        ),
        (theory.plastic_work().expression, theory.plastic_restitution().expression),
        {},
        _by_roots,
    )


def _by_roots(expression: sp.Expr) -> sp.Expr:
    """Return the expression with one symbol for the root of 2 xi^3 + 1; it is then rational."""
    root = sp.Symbol("root", positive=True)
    expression_in_roots = sp.powdenest(
        expression.subs(xi_y, sp.cbrt((root**4 - 1) / 2)), force=True
    )
    return sp.simplify(expression_in_roots)


ROUTINES = yield_radius_of_factors, yield_speed_of_factors, loaded, unloaded, worked
