"""Sensitivities of an impact as the code computes them, proved equal to those of the theory.

The contact time is an integral over q = 1 - u^2 of N/sqrt(S); N and S are sums over the powers n of
the law, like V = (R/a) d delta/da and the work E.
"""

from collections.abc import Mapping

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Facts, Let, Routine, Statement, routine
from derivation.engine.formula.functions import unspecified_function
from derivation.plate.contact.kernels import law
from derivation.plate.contact.kernels.law import CORRECTION, DEPTH, FORCE, log_eta
from derivation.plate.impact.theory.impact import contact_time, geometric, orders
from derivation.plate.impact.theory.sensitivity import modulus_slope, peaks, times, weighted
from derivation.plate.vocabulary import D, D_eta, R, a, lam, mu, u_t

energy, rate, lift, energy_slope, lift_slope = sp.symbols(
    "energy rate lift energy_slope lift_slope", real=True
)
n, term, s, x, q, weight, powers = sp.symbols("n term s x q weight powers", positive=True)
first, second, by_energy, by_eta = sp.symbols("first second by_energy by_eta", real=True)
total, by_radius, by_thickness = sp.symbols("total by_radius by_thickness", positive=True)
own, of_energy, of_eta = sp.symbols("own of_energy of_eta", real=True)

# --- sums over the powers of the law


@named_routine
def power_work() -> Claims:
    """Return the work of a term proportional to the n-th power of A: int_0^1 x^3 d(term x^n)."""
    return Claims(
        (n, term),
        (),
        (term * (n / (n + 3)),),
        (sp.integrate(x**3 * sp.diff(term * x**n, x), (x, 0, 1)),),
        {},
        sp.simplify,
    )


@named_routine
def power_slope() -> Claims:
    """Return the derivative, with respect to log A, of the term A^(n-2) of F (A^n in delta)."""
    return Claims(
        (n, term), (), (term * (n - 2),), (sp.diff(term * x ** (n - 2), x).subs(x, 1),), {}
    )


class NearNodes:
    """Positions of the inner integral's nodes, w = 1 - u from 0 to 1 - sqrt(1 - ratio)."""

    node, ratio, root, factor = sp.symbols("node ratio root factor", positive=True)
    last, w, rest, left, short, height = sp.symbols("last w rest left short height", positive=True)


@named_routine
def near_nodes() -> Claims:
    """Return q, s = q/ratio, 1 - q, (1 - s) ratio^5/(1 - q) and max w, where root^2 = 1 - ratio."""
    k = NearNodes
    u = 1 - (1 - k.root) * k.node
    there, s_there = 1 - u**2, (1 - u**2) / (1 - k.root**2)
    statements = (
        Let(k.last, k.ratio / (1 + k.root)),
        Let(k.w, k.last * k.node),
        Let(k.rest, k.last * (1 - k.node)),
        Let(q, k.w * (2 - k.w)),
        Let(k.height, k.root + k.rest),
        Let(k.left, k.height**2),
        Let(k.short, k.rest * (k.root + k.height) / k.ratio, "1 - s"),
    )
    results = q, q / k.ratio, k.left, k.short * k.ratio**5 / k.left, k.last
    factor = (1 - s_there) * (1 - k.root**2) ** 5 / (1 - there)
    return Claims(
        (k.node, k.ratio, k.root),
        statements,
        results,
        (there, s_there, 1 - there, factor, 1 - k.root),
        {k.ratio: 1 - k.root**2},
        sp.cancel,
    )


@named_routine
def work_weight() -> Claims:
    """Return the factor of V in int x^3 d(x^2 (1 + F))."""
    rise = R / a * sp.diff(DEPTH, a)
    return Claims(
        (x, weight),
        (),
        (weight * x**4,),
        (weight * sp.cancel(R * a**3 * sp.diff(DEPTH, a) / rise),),
        {x: a},
    )


@named_routine
def rates() -> Claims:
    """Return V = 2 (1 + F) + A F', and its derivatives with respect to log A and log(h/b)."""
    F, slope, curve, deeper = sp.symbols("F slope curve deeper", real=True)
    rise = R / a * sp.diff(DEPTH, a)
    grown = a * sp.diff(CORRECTION, a)
    lifted = sp.diff(CORRECTION, log_eta)
    meaning = {
        F: CORRECTION,
        slope: grown,
        curve: a * sp.diff(grown, a),
        lift: lifted,
        deeper: a * sp.diff(lifted, a),
    }
    return Claims(
        (F, slope, curve, lift, deeper),
        (Let(law.indentation_ratio, 1 + F),),
        (2 * law.indentation_ratio + slope, 2 * slope + curve, 2 * lift + deeper),
        (rise, a * sp.diff(rise, a), sp.diff(rise, log_eta)),
        meaning,
        sp.simplify,
    )


# --- results


def _weights(of: Mapping[int, sp.Expr], of_hertz: int) -> dict[int, sp.Expr]:
    return {k: sp.Integer(of_hertz) if k == 2 else of[k] for k in orders()}


LAW_WEIGHTS, ETA_WEIGHTS = _weights(D, 1), _weights(D_eta, 0)
RADIUS_WEIGHTS = {k: (k - 2) * value for k, value in LAW_WEIGHTS.items()}


def _work(k: int) -> sp.Rational:
    return sp.Rational(k, k + 3)


SUMS: Facts = {
    energy: weighted(LAW_WEIGHTS, _work),
    rate: weighted(LAW_WEIGHTS, sp.Integer),
    lift: weighted(LAW_WEIGHTS, lambda _: sp.Integer(1)),
    energy_slope: weighted(ETA_WEIGHTS, _work),
    lift_slope: weighted(ETA_WEIGHTS, lambda _: sp.Integer(1)),
}
"""Meaning of the sums."""


@named_routine
def peak_growth() -> Claims:
    """Return logarithmic derivatives of A_m, delta_m, P_m with respect to energy number and h/b."""
    by_radius = a * sp.diff(sp.log(FORCE), a)
    growth = tuple(formula.expression for formula in peaks())
    return Claims(
        (energy, rate, energy_slope, lift, lift_slope),
        (Let(first, energy / rate), Let(second, -energy_slope / rate)),
        (
            first,
            second,
            energy / lift,
            (lift_slope - energy_slope) / lift,
            by_radius * first,
            by_radius * second,
        ),
        (*growth, *(by_radius * value for value in growth[:2])),
        SUMS,
        sp.cancel,
    )


@named_routine
def whole_work() -> Claims:
    """Return the work over A_m^5 from that over A_near^5 and the added work; near is A_near/A_m."""
    near, within, rise = sp.symbols("near within rise", positive=True)
    work = sp.integrate(x**3 * sp.diff(term * x**n, x), x)
    return Claims(
        (near, within, rise),
        (),
        (within * near**5 + rise,),
        (sp.simplify(work.subs(x, 1)),),
        {within: work.subs(x, near) / near**5, rise: work.subs(x, 1) - work.subs(x, near)},
        sp.simplify,
    )


# --- the contact time


def _time_parts(weights: Mapping[int, sp.Expr], at: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return N and S."""
    stored = weighted(weights, lambda k: _work(k) * geometric(k + 3, at))
    return weighted(weights, lambda k: k * at ** (k - 1)), stored


def _near_terms(name: str, hertz: int, summary: str) -> Routine:
    """Return the routine of N and S at s = q/ratio, from sums over the powers from the third on."""
    k = NearNodes
    rest, square, cube, six, start, rise = sp.symbols("rest square cube six start rise")
    every = _weights(D, hertz)
    deeper = {j: weight for j, weight in every.items() if j > 2}
    limited = [_work(j) * weight * k.ratio ** (j - 2) for j, weight in deeper.items()]
    at = q / k.ratio
    further = [sp.Add(*limited[i:]) * at ** (2 * i - 2) for i in range(1, len(limited))]
    nested = 1 + s * (1 + s * (1 + s * (1 + s)))
    statements: tuple[Statement, ...] = (
        Let(square, s**2),
        Let(cube, square * s),
        Let(six, (1 + s + square) * (1 + cube), "1 + s + ... + s^5"),
        Let(start, first * six + hertz * sp.Rational(2, 5) * nested),
    )
    left = start + cube**2 * (1 + s) * rest
    return routine(
        name,
        (q, s, k.left, k.factor, rate, first, rest, rise),
        statements,
        (q * (s * rate + 2 * hertz), left * k.factor + rise / k.left),
        _time_parts(every, q),
        summary,
        {
            rate: weighted(deeper, lambda j: j * k.ratio ** (j - 2) * at ** (j - 3)),
            first: sp.Add(*limited),
            rest: sp.Add(*further),
            rise: weighted(every, lambda j: _work(j) * (1 - k.ratio ** (j + 3))),
            k.factor: (1 - at) * k.ratio**5 / (1 - q),
            k.left: 1 - q,
            s: at,
        },
        sp.cancel,
    )


def near_terms() -> Routine:
    """Return the routine of N and S for the law."""
    what = "Return N and S from sums over the terms of F at s = A/A_near, and the work beyond."
    return _near_terms("near_terms", 1, what)


def near_slope_terms() -> Routine:
    """Return the routine of N and S for derivatives of the law, which lack Hertz's term."""
    what = "Return N and S for a slope of F, from the same sums without Hertz's term."
    return _near_terms("near_slope_terms", 0, what)


@named_routine
def far_nodes() -> Claims:
    """Return the node of [q, 1], measured from 1, where 1 - q = gap u^2."""
    gap, u = sp.symbols("gap u", positive=True)
    return Claims(
        (gap, u, NearNodes.node),
        (),
        (1 - gap * u**2 * NearNodes.node,),
        (1 - NearNodes.node * (1 - q),),
        {gap: (1 - q) / u**2},
        sp.expand,
    )


@named_routine
def time_terms() -> Claims:
    """Return terms of int N/sqrt(S) and of its derivatives with respect to log A_m and log(h/b)."""
    names = sp.symbols("N S N_1 S_1 N_2 S_2", positive=True)
    N, S, N_1, S_1, N_2, S_2 = names
    scaled, half = sp.symbols("scaled half", positive=True)
    values = [
        value
        for weights in (LAW_WEIGHTS, RADIUS_WEIGHTS, ETA_WEIGHTS)
        for value in _time_parts(weights, 1 - u_t**2)
    ]
    return Claims(
        (*names, weight),
        (Let(scaled, weight / sp.sqrt(S)), Let(half, N / (2 * S))),
        (N * scaled, (N_1 - half * S_1) * scaled, (N_2 - half * S_2) * scaled),
        tuple(weight / 2 * part.expression for part in (contact_time()[0], *times())),
        dict(zip(names, values, strict=True)),
    )


TimeIntegral = unspecified_function(
    "TimeIntegral", lambda log_A, _: by_radius / sp.exp(log_A), lambda *_: by_thickness
)
"""The integral of N/sqrt(S) as a function of A_m and log(h/b)."""


@named_routine
def time_growth() -> Claims:
    """Return derivatives of the contact time, with respect to energy number and h/b, from A_m's."""
    log_A = sp.Symbol("log_A", real=True)
    A = sp.exp(log_A)
    time = sp.log(TimeIntegral(log_A, log_eta)) + sp.expand_log(sp.log(A**2 / sp.sqrt(A**5)))
    value = time.subs(TimeIntegral(log_A, log_eta), total)
    slopes = [by_radius / total, by_thickness / total]
    by_log_A, by_log_eta = sp.diff(value, log_A) + slopes[0], sp.diff(value, log_eta) + slopes[1]
    return Claims(
        (total, by_radius, by_thickness, first, second),
        (Let(rate, by_radius / total - sp.Rational(1, 2)),),
        (rate * first, rate * second + by_thickness / total),
        (by_log_A * first, by_log_A * second + by_log_eta),
        {},
        sp.simplify,
    )


@named_routine
def parameter_power() -> Claims:
    """Return the power of a parameter in a result: its own, and those by energy number and h/b."""
    log_p = sp.Symbol("log_p", real=True)
    change = own * log_p + by_energy * (of_energy * log_p) + by_eta * (of_eta * log_p)
    return Claims(
        (own, of_energy, of_eta, by_energy, by_eta),
        (),
        (own + by_energy * of_energy + by_eta * of_eta,),
        (sp.diff(change, log_p),),
        {},
        sp.expand,
    )


@named_routine
def constants_powers() -> Claims:
    """Return the powers of lam and mu in a result from the power of E*."""
    by_lam = modulus_slope().expression
    return Claims(
        (powers, lam, mu),
        (Let(first, lam / (lam + mu)), Let(second, mu / (lam + 2 * mu)), Let(own, first * second)),
        (powers * own, powers * (1 - own)),
        (powers * by_lam, powers * (1 - by_lam)),
        {},
        sp.cancel,
    )


ROUTINES = (
    power_work,
    power_slope,
    near_nodes,
    work_weight,
    rates,
    peak_growth,
    whole_work,
    near_terms,
    near_slope_terms,
    far_nodes,
    time_terms,
    time_growth,
    parameter_power,
    constants_powers,
)
