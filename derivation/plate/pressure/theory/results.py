"""Results from a solution of the contact's integral equation, in units of the half-space.

With x = t/a, chi = (E*/pi) (a^2/R) c(x) and f = (a^2/R) g(x). The constant N_0 of the kernel is a
compliance in series with the rest, and so is that of the support: both are omitted from the
equation for c, and for psi of the flat punch. chi gives the elastic energy: because I + N is
symmetric, dU/da = P d delta/da for U = pi int chi (delta - f) dt.

Without N_0 there is a radius at which I + N is singular: the rest of a flexible plate alone has no
stiffness there. At a given force it is always regular. c is therefore solved for given int c and
c(1), with an unknown depth and an unknown curvature (`remaining_curvature`), and psi of the flat
punch, where (I + N) psi = firm, is the sum of such solutions with int psi = 1.
"""

from functools import cache
from typing import NamedTuple

import sympy as sp

from derivation.engine.formula.proof import Proof, prove
from derivation.plate.vocabulary import R, a, r

E, N_0, support = sp.symbols("E N_0 support", positive=True)
force, depth, work, firm = sp.symbols("force depth work firm", positive=True)
rim, bend, centre = sp.symbols("rim bend centre", positive=True)
"""int c, delta R/a^2, int c (depth - g), (I + N) psi, psi(1), -c'(1), int -c'/x; int psi = 1."""
_t, _u, _x = sp.symbols("t u x", positive=True)
_c, _g = sp.Function("c"), sp.Function("g")


class Results(NamedTuple):
    """Quantities of the contact, the unit of chi, and the proof that the solution gives them."""

    force: sp.Expr
    indentation: sp.Expr
    stiffness: sp.Expr
    slope: sp.Expr
    energy: sp.Expr
    centre_pressure: sp.Expr
    mean_pressure: sp.Expr
    chi: sp.Expr
    proof: Proof


@cache
def results() -> Results:
    """Return all results in terms of the numbers of the solution."""
    series = a * N_0 + 2 * E * a * support
    load = 2 * E * a**3 / R * force
    formulas = (
        load,
        a**2 / R * (depth + series * force),
        2 * E * a / (firm + series),
        a / R * bend / rim * (firm + series),
        E * a**5 / R**2 * (work + series * force**2),
        E * a / (sp.pi * R) * centre,
        load / (sp.pi * a**2),
    )
    return Results(*formulas, unit := E * a**2 / (sp.pi * R), _proof(*formulas, unit))


def _proof(
    load: sp.Expr, indentation: sp.Expr, stiffness: sp.Expr, slope: sp.Expr, energy: sp.Expr,
    peak: sp.Expr, mean: sp.Expr, unit: sp.Expr,
) -> Proof:  # fmt: skip
    chi = unit * _c(_t / a)
    # The flat punch of unit depth: int psi and psi at the end, of the remaining and of the whole
    # kernel.
    flat, edge = 1 / firm, rim / firm
    whole = a * flat / (1 + N_0 * a * flat)
    last = edge * (1 - N_0 * whole)
    end = sp.diff(chi, _t).subs(_t, a * _x).doit().subs({sp.diff(_c(_x), _x): -bend, _x: 1})
    moved = -end / (E / sp.pi * last)
    stored = sp.pi * chi * (a**2 / R * (depth - _g(_t / a)))
    squares = (N_0 / (2 * E) + support) * load**2 / 2
    return prove(
        "Results of the contact's integral equation",
        r"Integrals over $t$ are written in $x = t/a$; $\chi(a) = 0$ is differentiated; "
        "compliances are added.",
        {
            "force": over_x(2 * sp.pi * chi) - load / force * _c(_x),
            "indentation": a**2 / R * depth + (N_0 / (2 * E) + support) * load - indentation,
            "stiffness": 1 / (2 * E * whole) + support - 1 / stiffness,
            "slope": moved * (1 + support * 2 * E * whole) - slope,
            "energy": over_x(stored) / (_c(_x) * (depth - _g(_x))) * work + squares - energy,
            "centre": over_x(-sp.diff(chi, _t) / _t) * _x + peak / centre * sp.diff(_c(_x), _x),
            "mean": mean * sp.pi * a**2 - load,
        },
    )


def over_x(integrand: sp.Expr) -> sp.Expr:
    """Return the integrand over x from 0 to 1 that replaces one over t from 0 to a."""
    return (a * integrand.subs(_t, a * _x)).doit()


@cache
def substitution() -> tuple[sp.Expr, sp.Expr, Proof]:
    """Return t in terms of u, and the factor of the pressure's integral of -chi'/t over u."""
    t = sp.sqrt(r**2 + (a**2 - r**2) * _u**2)
    front = sp.sqrt(a**2 - r**2)
    proof = prove(
        "Points of the pressure's integral",
        r"In $\int \chi'/\sqrt{t^2 - r^2} dt$ the measure $dt/\sqrt{t^2 - r^2}$ is the factor "
        "times $du/t$.",
        {
            "measure": (sp.diff(t, _u) * t / (front * _u)) - front,
            "square root": t**2 - r**2 - (front * _u) ** 2,
            "lower limit": t.subs(_u, 0) - r,
            "upper limit": t.subs(_u, 1) - a,
        },
    )
    return t, front, proof
