"""Routines of finite spheres and of the motion of faces for the generated package."""

import sympy as sp

from derivation.engine.emit.modules import Routines
from derivation.engine.emit.routine import Routine, routine
from derivation.plate.modules import ComputedModule
from derivation.plate.sphere.theory import finite_sphere
from derivation.plate.vocabulary import Formula, k, nu


def _of(formula: Formula) -> Routine:
    """Return the routine of a formula in the degree and Poisson's ratio."""
    value, summary = formula.expression, f"Return the {formula.meaning}."
    arguments = tuple(symbol for symbol in (k, nu) if value.has(symbol))
    return routine(formula.name, arguments, (), (value,), (value,), summary, {}, sp.cancel)


def sphere_kernels() -> Routines:
    """Return the routines of the step, without the compliance itself."""
    title = "Change of Hertz's indentation by a finite sphere and by motion of the faces."
    return Routines("sphere_kernels", title, tuple(map(_of, finite_sphere()[1:])), {})


MODULES = (ComputedModule("sphere_kernels", sphere_kernels),)
