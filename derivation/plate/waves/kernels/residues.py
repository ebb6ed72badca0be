"""Residues of the higher branches: -1/B' at the zeros of B, without cancellation."""

from functools import partial

import sympy as sp

from derivation.engine.emit.routine import Choice, Facts, Let, Routine, Several, Statement, routine
from derivation.plate.vocabulary import gam, kap
from derivation.plate.waves.kernels.entire import (
    FIRST,
    MEANING,
    E_p,
    E_q,
    at_zero,
    cosh_p,
    cosh_q,
    level,
    m,
    over,
    rest,
    sinh_p,
    sinh_q,
    square,
    stiffness,
    x,
)
from derivation.plate.waves.theory.dynamic_modes import p, q, with_roots

double_p, double_q, fading_p = sp.symbols("double_p double_q fading_p", real=True)
ratio_q, ratio_p, larger, first, second, size, energy, safe = sp.symbols(
    "ratio_q ratio_p larger first second size energy safe", real=True
)
SMALLEST = sp.Float("5e-324")


def _double(symbol: sp.Symbol, of: sp.Expr, root: sp.Symbol, scale: sp.Symbol) -> Several:
    exact = scale**2 * (sp.sinh(2 * root) / (2 * root) - 1) / root**2
    return Several((symbol,), "double", (of,), (exact,))


class _Parts:
    """Formulas that differ between bending and extension.

    B = 0 gives the ratio of the amplitudes of q and p in two ways, `near` and `far`. Where one is
    the quotient of two small numbers, the other one is accurate.
    """

    def __init__(self, bends: bool) -> None:
        shear = 4 * square
        self.scale: Facts = {}
        if bends:
            self.near = cosh_q, cosh_p
            self.far = -shear * over * sinh_q, m**2 * sinh_p
            self.in_p = gam * m**2 * double_p / 2 - 2 * m * sinh_p * cosh_p
            self.in_q = 2 * square * (sinh_q * cosh_q + 1)
            self.extra: tuple[Statement, ...] = (_double(double_p, level, p, E_p),)
            self.scale = {E_q: sp.Integer(1)}  # over > 0 for all but A0: q is imaginary
            return
        lift = level * sinh_p
        self.near = sinh_q, lift
        self.far = shear * cosh_q, m**2 * cosh_p
        self.in_p = gam * m**2 * (cosh_p * sinh_p + fading_p) / 2 - 2 * m * lift * cosh_p
        self.in_q = 2 * square * double_q
        fading = Several((fading_p,), "fading", (level,), (E_p**2,))
        self.extra = (fading, _double(double_q, -over, q, E_q))


def residue(bends: bool) -> Routine:
    """Return -1/B' at the zeros of B."""
    parts = _Parts(bends)
    least = sp.Function("least")(sinh_p, level, sinh_q, over)
    small = sp.Min(sp.Abs(cosh_p), sp.Abs(cosh_q))
    exact = sp.Gt(least, small) if bends else sp.Gt(small, least)
    swap = sp.And(exact, sp.Gt(sp.Abs(parts.near[1]), sp.Abs(parts.near[0])))
    largest = sp.Max(sp.Abs(ratio_q), sp.Abs(ratio_p), SMALLEST)
    nothing = "the branch is not excited by pressure"
    statements: tuple[Statement, ...] = (
        *FIRST,
        *parts.extra,
        Choice(ratio_q, exact, parts.far[0], parts.near[0]),
        Choice(ratio_p, exact, parts.far[1], parts.near[1]),
        Let(larger, largest, "only the ratio is needed", opaque=True),
        Let(first, ratio_q / larger),
        Let(second, ratio_p / larger),
        Choice(size, swap, parts.near[1] * first, parts.near[0] * second),
        Let(energy, parts.in_p * first**2 + parts.in_q * second**2),
        Choice(safe, energy > 0, energy, sp.Integer(1), unclaimed="no", reason=nothing),
    )
    return routine(
        ("bending" if bends else "stretching") + "_residues",
        (over, x, gam, rest),
        statements,
        ((square + over) * size**2 / (2 * safe),),
        (-1 / sp.diff(with_roots(stiffness(bends)), kap),),
        f"Return -1/B{'a' if bends else 's'}' where B{'a' if bends else 's'} is 0.",
        MEANING,
        lambda e: at_zero(e.subs(parts.scale), bends),
    )


ROUTINES = (partial(residue, True), partial(residue, False))
