"""A wave of a clamped or supported plate: variables of the code, and their derivatives d/dk.

With xi = kap/x^2, k2^2 = k^2 left, g1 = bending_part and g2 k2^2 = k^2 turned, no terms cancel for
thin plates. With M = 2 I1/(k2 I0) and L = (1 - M)/k2^2 = I2/(k2^2 I0), none do where k2 vanishes.
"""

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Choice, Facts, Let
from derivation.plate.edge_modes.theory import mindlin
from derivation.plate.edge_modes.theory import waves as theory
from derivation.plate.edge_modes.theory.mindlin import k_2, shear, slack
from derivation.plate.vocabulary import eta, k_n, kap, nu, x_h

k, x, xi, root = sp.symbols("k x xi root", positive=True)
left, bending_part, turned, mean, less, q = sp.symbols(
    "left bending_part turned mean less q", real=True
)
j0, j1, c, t, beta = sp.symbols("j0 j1 c t beta", real=True)
change, square, rate = sp.symbols("change square rate", real=True)

_RATIO = 2 * theory.I1 / (k_2 * theory.I0)
NAMES: Facts = {
    k: k_n,
    left: k_2**2 / k_n**2,
    bending_part: theory.g_1,
    turned: theory.g_2 * k_2**2 / k_n**2,
    mean: _RATIO,
    less: (1 - _RATIO) / k_2**2,
    j0: theory.J0,
    j1: theory.J1,
    t: theory.FACE,
    c: theory.PART,
}
"""Meaning of the variables, for any g1 and g2."""


def parts() -> dict[sp.Symbol, sp.Expr]:
    """Return left, bending_part and turned in terms of xi, with the shear coefficient of A0."""
    symbols = {left: mindlin.left(), bending_part: mindlin.u_1(), turned: mindlin.u_2()}
    return {s: sp.collect(sp.expand(v.subs(shear, slack())), xi) for s, v in symbols.items()}


def in_xi(expression: sp.Expr) -> sp.Expr:
    """Return an expression of the theory in k and xi."""
    result = parts()
    known = {theory.g_1: result[bending_part], theory.g_2: result[turned] / result[left]}
    return expression.subs(known).subs(k_2, k_n * sp.sqrt(result[left]))


def of_xi() -> Facts:
    """Return the meaning of the variables, as functions of k and xi."""
    names = {s: in_xi(sp.sympify(value)) for s, value in NAMES.items()}
    return names | parts()


def by_wave_number(expression: sp.Expr) -> sp.Expr:
    """Return the derivative of an expression in k and xi; `change` is that of xi."""
    return sp.diff(expression, k_n) + sp.diff(expression, xi) * change


def branch_rate() -> sp.Expr:
    """Return d log(xi)/d log(k) on Mindlin's branch, in xi, from the dispersion relation."""
    (there,) = sp.solve(mindlin.dispersion(x_h), x_h**2)
    return mindlin.on_lower_branch().subs(x_h**2, there).subs(shear, slack())


RATE = 2 * bending_part * turned / (bending_part + turned - bending_part * turned)
"""The same in the code's variables."""


def slope_of(value: sp.Expr, others: Facts) -> sp.Expr:
    """Return d/dk of the code's expression in k, in terms that depend on xi, and in others."""
    by_xi = sum(sp.diff(value, s) * sp.diff(part, xi) for s, part in parts().items())
    total = sp.diff(value, k) + (by_xi + sp.diff(value, xi)) * change
    return total + sum(sp.diff(value, s) * each for s, each in others.items())


def changes() -> tuple[Let, Let]:
    """Return d xi/dk and d k2^2/dk; the former applies to any branch."""
    return (
        Let(
            change, xi * RATE / k, "of xi by k", opaque=True, means=xi * branch_rate() / k_n
        ),
        Let(square, slope_of(k**2 * left, {}), "of k2^2 by k"),
    )  # fmt: skip


@named_routine
def wave() -> Claims:
    """Return xi, k2^2/k^2, g1, g2 k2^2/k^2 and k2."""
    limited = sp.Symbol("limited", real=True)
    beyond = "beyond the cut-off there are no modes"
    partner, first, second = (formula.expression for formula in mindlin.waves())
    return Claims(
        (k, eta, nu, root),
        (
            Let(xi, (root / (k * eta)) ** 2, "kap/x^2"),
            *(Let(symbol, value) for symbol, value in parts().items()),
            Choice(limited, left > 0, left, sp.Integer(0), unclaimed="no", reason=beyond),
        ),
        (xi, left, bending_part, turned, k * sp.sqrt(limited)),
        (kap / (k_n * eta) ** 2, partner**2 / k_n**2, first, second * partner**2 / k_n**2, partner),
        {k: k_n, root: sp.sqrt(kap)},
    )


@named_routine
def to_cutoff() -> Claims:
    """Return a Newton step in log x for k2 = 0."""
    plain = parts()[left]
    claim = x_h * (1 - plain / (xi * sp.diff(plain, xi) * branch_rate()))
    return Claims(
        (x, nu, root),
        (
            Let(xi, (root / x) ** 2),
            *(Let(symbol, value) for symbol, value in parts().items()),
            Let(rate, RATE),
        ),
        (x * (1 + left / ((1 - left) * rate)),),
        (claim.subs(xi, kap / x_h**2),),
        {x: x_h, root: sp.sqrt(kap)},
    )


@named_routine
def cutoff_of_mindlin() -> Claims:
    """Return x at which k2 vanishes on Mindlin's branch."""
    (there,) = sp.solve(mindlin.left(), xi)
    (square_there,) = sp.solve(mindlin.dispersion(x_h).subs(xi, there), x_h**2)
    exact = square_there.subs(shear, slack())
    return Claims(
        (nu,),
        (Let(square, sp.factor(exact), "of x", means=exact),),
        (sp.sqrt(square),),
        (sp.sqrt(exact),),
        {},
    )


ROUTINES = (wave, to_cutoff, cutoff_of_mindlin)
