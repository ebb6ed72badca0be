"""Routines of stretching for the generated package."""

import sympy as sp

from derivation.engine.emit.modules import Routines
from derivation.engine.emit.routine import Let, Routine, routine
from derivation.plate.modules import ComputedModule
from derivation.plate.stretching.theory import stretching
from derivation.plate.vocabulary import Formula, nu

SUM = sp.Symbol("one_plus_nu", positive=True)


def _stable(expression: sp.Expr) -> sp.Expr:
    """Return the expression in 1 + nu, in which its numerator does not cancel."""
    top, bottom = sp.fraction(sp.together(expression))
    constant, factors = sp.factor_list(top.subs(nu, SUM - 1), SUM)
    positive = [factor if factor.subs(SUM, 1) > 0 else -factor for factor, _ in factors]
    return abs(constant) * sp.Mul(*(sp.horner(factor, SUM) for factor in positive)) / bottom


def of_ratio(formula: Formula) -> Routine:
    """Return the routine of a function of Poisson's ratio."""
    return routine(
        formula.name,
        (nu,),
        (Let(SUM, 1 + nu),),
        (_stable(formula.expression),),
        (formula.expression,),
        f"Return {formula.meaning}.",
        {},
        sp.cancel,
    )


def stretching_kernels() -> Routines:
    """Return the routines of the three edges."""
    title = "Stiffening and tension by stretching of a plate's middle plane, to first order."
    return Routines("stretching_kernels", title, tuple(map(of_ratio, stretching())), {})


MODULES = (ComputedModule("stretching_kernels", stretching_kernels),)
