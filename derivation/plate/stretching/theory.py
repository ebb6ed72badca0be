"""Step 33: stretching of a thin plate's middle plane, and the stiffening that it causes.

A plate that deflects by a fraction of its thickness H stretches its middle plane. Its equations
(von Karman, 1910), under a load P on the axis, with the radial displacement u(r) of this plane, are

    D laplacian^2 w = (1/r) d/dr(r N_r w') + P delta(r)/(2 pi r),   d(r N_r)/dr = N_phi,
    N_r = (12 D/H^2) (u' + w'^2/2 + nu u/r),   N_phi = (12 D/H^2) (u/r + nu (u' + w'^2/2)).

For any slope w' the middle plane is in equilibrium with the tension

    N_r = (E H/4) (kappa/b^2 int_0^b w'^2 s ds + int_0^b w'^2 s/max(r, s)^2 ds).

A clamped edge fixes the middle plane (u = 0): kappa = (1 + nu)/(1 - nu). A simply supported edge
does not (N_r = 0): kappa = -1. The paper's edge has N_r + N_phi = 0, which without deflection is
its condition u' + u/r = 0, and conserves energy: kappa = 0. The kernel is symmetric in r and s, so
that the forces of stretching have the energy

    (pi/2) int_0^b N_r w'^2 r dr.

Under a small load, dw/dx = 4 x (log x - g) w_0/(1 + 2 g) with x = r/b, where g depends on the edge.
All three edges make the bending operator self-adjoint; multiplied by this w and integrated, the
first equation then gives the force at the deflection w_0 to first order:

    P = k w_0 (1 + A w_0^2/H^2),   k A w_0^3/H^2 = (2 pi/w_0) int_0^b N_r w'^2 r dr.

The tension N_r/H on the axis is B w_0/H times 3 (1 + nu) P/(2 pi H^2). Under Hertz pressure the
bending stress is this unit times log(b/a) + 5/6 - log(2) + g (the mean of log(b/r) - 1/2 + g, see
Timoshenko and Woinowsky-Krieger, section 19), above 1 for a < 0.4 b: then B w_0/H is an upper bound
on the tension over the bending stress.

For nu = 0.3, A is 0.445 (clamped) and 0.272 (simply supported); Timoshenko and Woinowsky-Krieger,
Theory of Plates and Shells, 2nd ed. 1959, table 82, have 0.443 and 0.272.
"""

from functools import cache
from typing import NamedTuple

import sympy as sp

from derivation.engine.formula.proof import prove
from derivation.plate.vocabulary import Formula, nu

_x, _g, _t = sp.symbols("x g t", positive=True)
_kappa = sp.Symbol("kappa", real=True)
_slope = sp.Function("slope")


class Edge(NamedTuple):
    """An edge of the plate.

    Attributes
    ----------
    g
        Its g.
    bending
        The quantity of bending that vanishes there.
    kappa
        Its kappa.
    in_plane
        Factors of N_r and N_phi in the sum that vanishes there.
    """

    g: sp.Expr
    bending: sp.Expr
    kappa: sp.Expr
    in_plane: tuple[sp.Expr, sp.Expr]


def slope() -> sp.Expr:
    """Return dw/dx under a small load, for a deflection of 1 + 2 g on the axis."""
    return 4 * _x * (sp.log(_x) - _g)


def tension(square: sp.Expr) -> sp.Expr:
    """Return b^2/(E H) N_r for a square of the slope (dw/dx)^2."""
    of = square.subs(_x, _t)
    every, inside, beyond = (
        sp.Integral(term, limits)
        for term, limits in (
            (of * _t, (_t, 0, 1)),
            (of * _t, (_t, 0, _x)),
            (of / _t, (_t, _x, 1)),
        )
    )
    return (_kappa * every + inside / _x**2 + beyond) / 4


def hoop(radial: sp.Expr) -> sp.Expr:
    """Return b^2/(E H) N_phi, by equilibrium of the middle plane."""
    return sp.diff(_x * radial, _x)


def edges() -> dict[str, Edge]:
    """Return the three edges, by name."""
    shape = slope()
    moment = sp.diff(shape, _x) + nu * shape / _x
    zero, one = sp.S.Zero, sp.S.One
    return {
        "clamped": Edge(zero, shape, (1 + nu) / (1 - nu), (-nu, one)),  # u = 0
        "supported": Edge(1 / (1 + nu), moment, -one, (one, zero)),
        "paper": Edge(sp.Rational(1, 2), sp.diff(shape, _x) + shape / _x, zero, (one, one)),
    }


class Stretched(NamedTuple):
    """The middle plane of an edge: b^2/(E H) N_r on the axis, and the work.

    The work is the integral of N_r w'^2 x, in this unit.
    """

    on_axis: sp.Expr
    work: sp.Expr


@cache
def stretched(name: str) -> Stretched:
    """Return the middle plane of an edge under a small load."""
    edge = edges()[name]
    square = slope().subs(_g, edge.g) ** 2
    radial = sp.expand(tension(square).subs(_kappa, edge.kappa).doit())
    work = sp.integrate(sp.expand(radial * square * _x), (_x, 0, 1))
    return Stretched(sp.limit(radial, _x, 0), work)


def stiffening(edge: Edge, plane: Stretched) -> sp.Expr:
    """Return A of an edge."""
    # k = 16 pi D/(b^2 (1 + 2 g)) and w_0 = 1 + 2 g.
    work = (1 - nu**2) * plane.work
    return sp.factor(sp.simplify(sp.Rational(3, 2) * work / (1 + 2 * edge.g) ** 3))


def tension_ratio(edge: Edge, plane: Stretched) -> sp.Expr:
    """Return B of an edge."""
    # Over D/(H^3 b^2): the tension for this w_0, and its unit for P = k w_0, times w_0/H.
    on_axis = (1 - nu**2) * plane.on_axis
    return sp.factor(sp.simplify(12 * on_axis / (24 * (1 + nu) * (1 + 2 * edge.g))))


def any_slope(held: sp.Expr) -> dict[str, sp.Expr]:
    """Return what vanishes if `tension` is that of the middle plane, for any slope.

    Parameters
    ----------
    held
        kappa of the clamped edge.
    """
    square, every = _slope(_x) ** 2, sp.Symbol("every", positive=True)
    radial = tension(square)
    around = hoop(radial)
    displacement = _x * (around - nu * radial)  # E H/b^3 u
    strain = sp.diff(displacement, _x) + square / 2 - (radial - nu * around)
    residuals = {"strain": sp.expand(strain)}
    of_edge = {
        sp.Integral(_slope(_t) ** 2 / _t, (_t, 1, 1)): 0,
        sp.Integral(_slope(_t) ** 2 * _t, (_t, 0, 1)): every,
    }
    for name, edge in edges().items():
        sums = edge.in_plane[0] * radial + edge.in_plane[1] * around
        kappa = held if name == "clamped" else edge.kappa
        residuals[f"middle plane of the {name} edge"] = (
            sp.expand(sums).subs(_x, 1).subs(of_edge).subs(_kappa, kappa)
        )
    return residuals


def of_load(values: dict[tuple[str, str], sp.Expr]) -> dict[str, sp.Expr]:
    """Return what vanishes if the deflection under a small load, A and B of the edges are true."""
    shape = slope()
    laplacian = sp.expand(sp.diff(_x * shape, _x) / _x)
    # P = -2 pi D x d/dx(laplacian), with the sign of a deflection along the load; D = H = b = 1.
    force = sp.expand(2 * sp.pi * _x * sp.diff(laplacian, _x))
    residuals = {
        "bending": sp.expand(sp.diff(_x * sp.diff(laplacian, _x), _x)),
        "load": force - 16 * sp.pi,
        "deflection": sp.integrate(shape, (_x, 0, 1)) + 1 + 2 * _g,
    }
    for name, edge in edges().items():
        plane, w_0, unit = stretched(name), 1 + 2 * edge.g, 12 * (1 - nu**2)  # E H
        stress = 3 * (1 + nu) * force / (2 * sp.pi)
        residuals |= {
            f"bending of the {name} edge": edge.bending.subs(_x, 1).subs(_g, edge.g),
            f"A, {name} edge": force / w_0 * values["stiffening", name] * w_0**3
            - 2 * sp.pi / w_0 * unit * plane.work,
            f"B, {name} edge": values["tension", name] * stress * w_0 - unit * plane.on_axis,
        }
    return residuals


@cache
def stretching() -> tuple[Formula, ...]:
    """Return the formulas of the step."""
    kinds = (
        ("stiffening", "A", "the stiffening 1 + A (w/H)^2 of a plate by stretching", stiffening),
        ("tension", "B", "the tension by stretching over 3 (1 + nu) P w/(2 pi H^3)",
         tension_ratio),
    )  # fmt: skip
    values = {
        (kind, name): value(edge, stretched(name))
        for kind, _, _, value in kinds
        for name, edge in edges().items()
    }
    kappa = edges()["clamped"].kappa
    proof = prove(
        "Stretching of the middle plane",
        "For any slope the middle plane is in equilibrium and satisfies the edge conditions. The "
        "deflection under a small load satisfies the equation of bending and carries the load $P = "
        "k w_0$. The work of its tension gives $A$, its tension on the axis $B$.",
        lambda held, *claims: any_slope(held) | of_load(dict(zip(values, claims, strict=True))),
        kappa,
        *values.values(),
    )
    ratios = tuple(
        Formula(
            f"{kind}_{name}",
            rf"{symbol}_\text{{{name}}}",
            f"{symbol} of {meaning}, {name} edge",
            values[kind, name],
            "1",
            "",
            (),
            proof,
        )
        for kind, symbol, meaning, _ in kinds
        for name in edges()
    )
    held = Formula(
        "edge_tension_clamped",
        r"\kappa_\text{clamped}",
        "kappa of the tension by stretching, clamped edge",
        kappa,
        "1",
        "",
        (),
        proof,
    )
    return (*ratios, held)


STEPS = (("stretching", stretching),)
