"""Step 33: stiffening of a thin plate by stretching, to first order in its deflection.

A plate that deflects by a fraction of its thickness H stretches its middle plane. Its equations
(von Karman, 1910), under a load P on the axis, with the radial displacement u(r) of this plane, are

    D laplacian^2 w = (1/r) d/dr(r N_r w') + P delta(r)/(2 pi r),   d(r N_r)/dr = N_phi,
    N_r = (12 D/H^2) (u' + w'^2/2 + nu u/r),   N_phi = (12 D/H^2) (u/r + nu (u' + w'^2/2)).

Without stretching, dw/dx = 4 x (log x - g) w_0/(1 + 2 g) with x = r/b, where g depends on the edge.
All three edges make the bending operator self-adjoint; multiplied by this w and integrated, the
first equation then gives the force at the deflection w_0 to first order:

    P = k w_0 (1 + A w_0^2/H^2),   k A w_0^3/H^2 = (2 pi/w_0) int_0^b N_r w'^2 r dr.

The tension N_r/H on the axis is B w_0/H times 3 (1 + nu) P/(2 pi H^2). Under Hertz pressure the
bending stress is this unit times log(b/a) + 5/6 - log(2) + g (the mean of log(b/r) - 1/2 + g, see
Timoshenko and Woinowsky-Krieger, section 19), above 1 for a < 0.4 b: then B w_0/H is an upper bound
on the tension over the bending stress.

A clamped edge fixes the middle plane (u = 0), a simply supported edge does not (N_r = 0), and the
paper's edge has u' + u/r = 0. For nu = 0.3, A is 0.445 and 0.272; Timoshenko and Woinowsky-Krieger,
Theory of Plates and Shells, 2nd ed. 1959, table 82, have 0.443 and 0.272.
"""

from functools import cache
from typing import NamedTuple

import sympy as sp

from derivation.engine.formula.proof import prove
from derivation.plate.vocabulary import Formula, nu

_x, _g, _c, _log = sp.symbols("x g c log_x", positive=True)
_first, _second, _third = sp.symbols("first second third")


class Edge(NamedTuple):
    """An edge: its g, and the quantities of bending and of the middle plane that vanish there."""

    g: sp.Expr
    bending: sp.Expr
    in_plane: sp.Expr


def slope() -> sp.Expr:
    """Return dw/dx without stretching, for a deflection of 1 + 2 g on the axis."""
    return 4 * _x * (sp.log(_x) - _g)


@cache
def middle_plane() -> sp.Expr:
    """Return u b of the middle plane for this slope; c is fixed by the edge."""
    shape = slope()
    load = shape * sp.diff(shape, _x) + (1 - nu) / (2 * _x) * shape**2
    u = _x**3 * (_first * sp.log(_x) ** 2 + _second * sp.log(_x) + _third)
    left = sp.diff(u, _x, 2) + sp.diff(u, _x) / _x - u / _x**2 + load
    powers = sp.Poly(sp.expand(left / _x).subs(sp.log(_x), _log), _log)
    return u.subs(sp.solve(powers.coeffs(), [_first, _second, _third])) + _c * _x


def _strain(u: sp.Expr) -> sp.Expr:
    """Return b^2 H^2/(12 D) N_r."""
    return sp.diff(u, _x) + slope() ** 2 / 2 + nu * u / _x


def edges() -> dict[str, Edge]:
    """Return the three edges, by name."""
    u, shape = middle_plane(), slope()
    moment = sp.diff(shape, _x) + nu * shape / _x
    return {
        "clamped": Edge(sp.Integer(0), shape, u),
        "supported": Edge(1 / (1 + nu), moment, _strain(u)),
        "paper": Edge(sp.Rational(1, 2), sp.diff(shape, _x) + shape / _x, sp.diff(u, _x) + u / _x),
    }


class Stretched(NamedTuple):
    """The middle plane of an edge: its c, b^2 H^2/(12 D) N_r, this on the axis, and the work."""

    c: sp.Expr
    tension: sp.Expr
    on_axis: sp.Expr
    work: sp.Expr


def stretched(edge: Edge) -> Stretched:
    """Return the middle plane of an edge; the work is the integral of N_r w'^2 x, in this unit."""
    c = sp.solve(sp.expand(edge.in_plane.subs(_x, 1)), _c)[0].subs(_g, edge.g)
    tension = sp.expand(_strain(middle_plane()).subs({_c: c, _g: edge.g}))
    work = sp.integrate(sp.expand(tension * slope().subs(_g, edge.g) ** 2 * _x), (_x, 0, 1))
    return Stretched(c, tension, sp.limit(tension, _x, 0), work)


def stiffening(edge: Edge, plane: Stretched) -> sp.Expr:
    """Return A of an edge."""
    # k = 16 pi D/(b^2 (1 + 2 g)) and w_0 = 1 + 2 g.
    return sp.factor(sp.simplify(sp.Rational(3, 2) * plane.work / (1 + 2 * edge.g) ** 3))


def tension_ratio(edge: Edge, plane: Stretched) -> sp.Expr:
    """Return B of an edge."""
    # Over D/(H^3 b^2): the tension for this w_0, and its unit for P = k w_0, times w_0/H.
    return sp.factor(sp.simplify(12 * plane.on_axis / (24 * (1 + nu) * (1 + 2 * edge.g))))


@cache
def stretching() -> tuple[Formula, ...]:
    """Return the formulas of the step."""
    shape, u = slope(), middle_plane()
    tension = _strain(u)
    hoop = u / _x + nu * (sp.diff(u, _x) + shape**2 / 2)
    laplacian = sp.expand(sp.diff(_x * shape, _x) / _x)
    # P = -2 pi D x d/dx(laplacian), with the sign of a deflection along the load; D = H = b = 1.
    force = sp.expand(2 * sp.pi * _x * sp.diff(laplacian, _x))
    kinds = (
        ("stiffening", "A", "the stiffening 1 + A (w/H)^2 of a plate by stretching", stiffening),
        ("tension", "B", "the tension by stretching over 3 (1 + nu) P w/(2 pi H^3)",
         tension_ratio),
    )  # fmt: skip
    planes = {name: stretched(edge) for name, edge in edges().items()}
    values = {
        (kind, name): value(edges()[name], plane)
        for kind, _, _, value in kinds
        for name, plane in planes.items()
    }

    def of_edges(*claims: sp.Expr) -> dict[str, sp.Expr]:
        given = dict(zip(values, claims, strict=True))
        residuals: dict[str, sp.Expr] = {}
        for name, edge in edges().items():
            plane, w_0 = planes[name], 1 + 2 * edge.g
            unit = 3 * (1 + nu) * force / (2 * sp.pi)
            residuals |= {
                f"bending of the {name} edge": edge.bending.subs(_x, 1).subs(_g, edge.g),
                f"middle plane of the {name} edge": edge.in_plane.subs(_x, 1).subs(
                    {_c: plane.c, _g: edge.g}
                ),
                f"A, {name} edge": force / w_0 * given["stiffening", name] * w_0**3
                - 2 * sp.pi / w_0 * 12 * plane.work,
                f"B, {name} edge": given["tension", name] * unit * w_0 - 12 * plane.on_axis,
            }
        return residuals

    proof = prove(
        "Stretching of the middle plane",
        "The linear deflection satisfies the equation of bending and the edge conditions, and "
        "carries the load $P = k w_0$; the middle plane is in equilibrium. The work of its tension "
        "gives $A$, its tension on the axis $B$.",
        lambda *claims: {
            "bending": sp.expand(sp.diff(_x * sp.diff(laplacian, _x), _x)),
            "load": force - 16 * sp.pi,
            "deflection": sp.integrate(shape, (_x, 0, 1)) + 1 + 2 * _g,
            "middle plane": sp.expand(sp.diff(_x * tension, _x) - hoop),
            **of_edges(*claims),
        },
        *values.values(),
    )
    return tuple(
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
        for name in planes
    )


STEPS = (("stretching", stretching),)
