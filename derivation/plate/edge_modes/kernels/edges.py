"""Frequency equations of clamped and supported plates, and their derivatives with respect to k.

The condition of the edge is J1 = q J0,

    q = k [beta (1 + left) - turned M/2]/bending_part.

For the first mode of a supported plate, whose k vanishes at nu = -1, it is

    bending_part R(-k^2) + J0 [turned R(k2^2)/I0 + (n xi k^2/8 - goal)(1 + left)] = 0,
    R(y) = y/8 I0 - I2 at sqrt(y), R(-k^2) = J2 - (k^2/8) J0,   goal = (1 + nu)/(1 - nu),

where all terms but the last are positive for k < j_1.
"""

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Let, Several
from derivation.engine.formula.proof import lower_bessel
from derivation.plate.edge_modes.kernels.states import (
    NAMES,
    bending_part,
    beta,
    by_wave_number,
    change,
    changes,
    in_xi,
    j0,
    j1,
    k,
    left,
    less,
    mean,
    of_xi,
    parts,
    q,
    slope_of,
    square,
    turned,
    xi,
)
from derivation.plate.edge_modes.theory import waves as theory
from derivation.plate.edge_modes.theory.mindlin import ROTARY, k_2
from derivation.plate.vocabulary import eta, k_n, nu

goal, i0, slope, excess, lacking = sp.symbols("goal i0 slope excess lacking", real=True)
curl, steep, curl_2, steep_2 = sp.symbols("curl steep curl_2 steep_2", real=True)
_y = sp.Symbol("y", positive=True)


def condition(of: sp.Expr) -> sp.Expr:
    """Return (S - beta Gam) J0/(g1 k), which is J1 - q J0."""
    return (theory.TURN - of * theory.BEND) * theory.J0 / (theory.g_1 * k_n)


def _plain(expression: sp.Expr) -> sp.Expr:
    """Evaluate at a quarter of xi, so that k2^2 > 0 at every trial value."""
    return lower_bessel(expression).subs(xi, xi / 4)


def _between(expression: sp.Expr) -> sp.Expr:
    """Return the derivative of an expression of the theory along k, for any change of xi."""
    return by_wave_number(in_xi(expression))


@named_routine
def edge() -> Claims:
    """Return q, J1 - q J0, which vanishes at a mode, and its slope with respect to k."""
    value = k * (beta * (1 + left) - turned * mean / 2) / bending_part
    steep_q = slope_of(value, {mean: (less - mean**2 / 4) * square})
    stated = condition(beta)
    (root,) = sp.solve(stated, theory.J1)
    return Claims(
        (k, nu, beta, xi, left, bending_part, turned, mean, less, j0, j1),
        (
            Let(q, value),
            *changes(),
            Let(slope, sp.collect(sp.expand(steep_q), (change, square), sp.factor)),
            Let(excess, j1 - q * j0),
        ),
        (q, excess, j0 - j1 / k + q * j1 - slope * j0),
        (in_xi(root / theory.J0), in_xi(stated), _between(stated)),
        of_xi(),
        _plain,
    )


def curl_of(of: type[sp.Function]) -> sp.Expr:
    """Return R(y) by J for y = -k^2, or by I for y = k^2, in k."""
    sign = -1 if of is sp.besselj else 1
    return sign * (k_n**2 / 8 * of(0, k_n) - of(2, k_n))


def _curls(partner: sp.Symbol) -> tuple[Several, Several]:
    """Return R and its slope with respect to y, for both waves."""
    first, second = (curl_of(of) for of in (sp.besselj, sp.besseli))
    slopes = -sp.diff(first, k_n) / (2 * k_n), sp.diff(second, k_n) / (2 * k_n)
    wave_number = k_n * sp.sqrt(parts()[left])
    of_partner = (value.subs(k_n, k_2).subs(k_2, wave_number) for value in (second, slopes[1]))
    return (
        Several((curl, steep), "curled", (-(k**2),), (first, slopes[0])),
        Several((curl_2, steep_2), "curled", (partner,), tuple(of_partner)),
    )


@named_routine
def first_edge() -> Claims:
    """Return the function that vanishes at the first supported mode, and its derivative d/dk."""
    partner = sp.Symbol("partner", real=True)
    bracket = turned * curl_2 / i0 + (ROTARY * xi * k**2 / 8 - goal) * (1 + left)
    value = bending_part * curl + j0 * bracket
    others = {
        curl: -2 * k * steep,
        curl_2: steep_2 * square,
        i0: i0 * mean / 4 * square,
        j0: -j1,
    }
    stated = condition(theory.SUPPORTED) * 2 * theory.g_1 / k_n
    return Claims(
        (k, nu, goal, xi, left, bending_part, turned, mean, j0, j1),
        (
            Let(partner, k**2 * left, "k2^2"),
            Several((i0,), "even", (partner,), (in_xi(theory.I0),)),
            *_curls(partner),
            *changes(),
            Let(excess, value),
        ),
        (excess, slope_of(value, others)),
        (in_xi(stated), _between(stated)),
        {**of_xi(), goal: 2 * theory.SUPPORTED - 1},
        _plain,
    )


@named_routine
def first_power() -> Claims:
    """Return k^4 of the first mode of a supported plate, near nu = -1."""
    u = sp.Symbol("u", positive=True)
    lowest = 2 * curl_powers(2)[1] * u + eta**2 / 12 * u - 2 * goal
    return Claims((eta, goal), (), (sp.solve(lowest, u)[0],), (_lowest_power(),), {})


def curl_powers(count: int) -> tuple[sp.Rational, ...]:
    """Return R in powers of y, from y^1 on."""
    rows = []
    for m in range(count):
        own, other = sp.factorial(m) ** 2, sp.factorial(m) * sp.factorial(m + 2)
        rows.append(sp.Rational(1, 8 * 4**m * own) - sp.Rational(1, 4 ** (m + 1) * other))
    return tuple(rows)


def _lowest_power() -> sp.Expr:
    """Return k^4 to lowest order of the support's condition, where 1 + nu is of order k^4."""
    size, u = sp.symbols("size u", positive=True)
    order = 5

    def bessel(of: type[sp.Function], n: int) -> sp.Expr:
        sign = -1 if of is sp.besselj else 1
        return sp.Lambda(_y, sp.Add(*(
            sign**m * (_y / 2) ** (2 * m + n) / (sp.factorial(m) * sp.factorial(m + n))
            for m in range(order)
        )))  # fmt: skip

    equation = in_xi((theory.TURN - theory.SUPPORTED * theory.BEND) / k_n**2)
    for of in (sp.besselj, sp.besseli):
        equation = equation.replace(of, lambda n, z, of=of: bessel(of, int(n))(z))
    small = {nu: (goal - 1) / (goal + 1), xi: k_n**2 * eta**2 / (3 * ROTARY)}
    for s in (xi, nu):
        equation = equation.subs(s, small[s])
    equation = sp.cancel(sp.together(equation).subs(goal, goal * size**4).subs(k_n, size))
    (value,) = sp.solve(sp.series(equation, size, 0, order).removeO().coeff(size, 4), goal)
    return sp.solve(value * u - goal, u)[0]


@named_routine
def support() -> Claims:
    """Return goal, and beta of a simple support."""
    return Claims(
        (nu,),
        (),
        ((1 + nu) / (1 - nu), theory.SUPPORTED),
        (2 * theory.SUPPORTED - 1, theory.SUPPORTED),
        {},
    )


@named_routine
def clamp() -> Claims:
    """Return beta of a clamped edge."""
    chi = sp.Symbol("chi", real=True)
    return Claims(
        (eta, nu),
        (Let(chi, theory.CLAMP, "by finite elements"),),
        (theory.CLAMPED.subs(theory.CLAMP, chi),),
        (theory.CLAMPED,),
        {},
    )


@named_routine
def moved() -> Claims:
    """Return J0 and J1 at the root, from the difference between k and the root."""
    exact = tuple(sp.besselj(order, k_n) for order in (0, 1))
    known = {exact[0]: j0, exact[1]: j1, k_n: k}
    slopes = [lower_bessel(sp.diff(f, k_n)) for f in exact]
    return Claims(
        (k, lacking, j0, j1),
        (),
        tuple(f + lacking * s.subs(known) for f, s in zip((j0, j1), slopes, strict=True)),
        tuple(f + lacking * sp.diff(f, k_n) for f in exact),
        {s: NAMES[s] for s in (k, j0, j1)},
        lower_bessel,
    )


ROUTINES = (support, clamp, edge, moved, first_power, first_edge)
