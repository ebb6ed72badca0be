"""Step 20: the integral equation in terms of the curvature that remains between sphere and plate.

With x = t/a, the kernel has the terms nu (cos(w x) cos(w s) - 1) and square (x^2 + s^2). A wide
contact bends the plate almost to the sphere's curvature, so that their x^2 almost cancel. With
1 - cos(w x) = q x^2 - e(x) and the remaining curvature kappa, the equation of `results` is

    c(x) + sum nu e(x) int c(s) cos(w s) ds = D - kappa x^2 - [g(x) - x^2].
"""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import Proof, prove

nu, w, x, square = sp.symbols("nu w x square", positive=True)
depth, force, transform, second = sp.symbols("depth force transform second", positive=True)
"""delta R/a^2, int c, int c cos(w s), int c s^2."""


def parts_of_wave(cosine: sp.Expr, x: sp.Symbol) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Return 1 - cos = q x^2 - e, then its deviation e from the parabola, and q."""
    risen = 1 - cosine
    parabola = sp.limit(risen / x**2, x, 0)
    return risen, parabola * x**2 - risen, parabola


@cache
def remaining_curvature() -> Proof:
    """Prove that the equation of one wave and of the squares is that of the remaining curvature."""
    c, g = sp.symbols("c g", real=True)
    cosine = sp.cos(w * x)
    _, deviation, q = parts_of_wave(cosine, x)
    kernel = nu * (cosine * transform - force) + square * (x**2 * force + second)
    curvature = 1 - nu * q * transform + square * force
    end = depth + nu * (force - transform) - square * second
    left = c + nu * deviation * transform
    return prove(
        "Equation for the remaining curvature",
        r"$\cos(w x) = 1 - q x^2 + e(x)$; terms with $x^2$ are collected in $\kappa$, "
        "constants in $D$.",
        {
            "equation": (c + kernel - (depth - g)) - (left - (end - curvature * x**2 - g + x**2)),
            "order": sp.limit(deviation / x**2, x, 0),
        },
    )
