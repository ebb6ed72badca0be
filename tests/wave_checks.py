"""Checks of the formulas of waves that do not contain the formulas themselves.

They supplement `formula_checks`, for `test_formula_mutants`.
"""

import mpmath as mp
import sympy as sp
from formula_checks import Check, close, evaluator, number

from derivation.plate.waves import oracle as inertia_balls
from derivation.plate.waves import route as inertia_routes


def by_first_order_system(name: str) -> Check:
    """Check the influence of waves against eigenvectors of the first-order equations (mpmath)."""
    points = [(1.5, 0.75, 0.25), (0.5, 0.125, 0.375)]
    h, mu = mp.mpf("0.3"), mp.mpf("1.7")
    expected = []
    for point in points:
        bending, extension = inertia_routes.influence(*point, 20)
        parts = {"B_a": 1 / bending, "B_s": 1 / extension}
        expected.append(parts.get(name.removesuffix("_slow"), h / mu * (bending + extension)))

    def passes(expression: sp.Expr) -> bool:
        call = evaluator(expression)
        for (x, kap, nu), value in zip(points, expected, strict=True):
            gam = (1 - 2 * mp.mpf(nu)) / (2 - 2 * mp.mpf(nu))
            values = {"x_h": mp.mpf(x), "kap": mp.mpf(kap), "gam": gam, "h": h, "mu": mu}
            if not close(call(values), value, 1e-15):
                return False
        return True

    return passes


def by_free_wave(name: str) -> Check:
    """Check the stress of a free wave against eigenvectors of first-order equations (mpmath)."""
    bends = name == "bending_wave_stress"
    kind, expected = inertia_balls.KINDS[0 if bends else 1], []
    for x, nu in ((1.5, 0.25), (0.5, 0.375)):
        kap = number(inertia_balls.zero(x, nu, kind, digits=40))
        expected.append((x, kap, nu, inertia_routes.wave_stress(x, kap, nu, bends, 15)))

    def passes(expression: sp.Expr) -> bool:
        call = evaluator(expression)
        for x, kap, nu, value in expected:
            gam = (1 - 2 * mp.mpf(nu)) / (2 - 2 * mp.mpf(nu))
            if not close(call({"x_h": mp.mpf(x), "kap": kap, "gam": gam}), value, 1e-12):
                return False
        return True

    return passes
