"""What every parameter does to an impact, as code computes it, proved to be that of the theory.

The contact time is an integral over q = 1 - u^2 of N/sqrt(S); N and S are sums over the powers n of
the law, as V = (R/a) d delta/da and the work E are.
"""

from collections.abc import Mapping

import sympy as sp

from derivation.engine.emit.routine import Facts, Let, Routine, routine
from derivation.plate.contact.kernels import law
from derivation.plate.contact.kernels.law import CORRECTION, DEPTH, log_eta
from derivation.plate.impact.theory.impact import contact_time, orders
from derivation.plate.impact.theory.sensitivity import modulus_slope, peaks, times, weighted
from derivation.plate.vocabulary import D, D_eta, R, a, lam, mu, u_t

energy, rate, lift, energy_slope, lift_slope = sp.symbols(
    "energy rate lift energy_slope lift_slope", real=True
)
n, term, s, x, weight, powers = sp.symbols("n term s x weight powers", positive=True)
first, second, by_energy, by_eta = sp.symbols("first second by_energy by_eta", real=True)
total, by_radius, by_thickness = sp.symbols("total by_radius by_thickness", positive=True)
own, of_energy, of_eta = sp.symbols("own of_energy of_eta", real=True)

# --- sums over the powers of the law


def power_work() -> Routine:
    """E of one power of A."""
    return routine(
        "power_work",
        (n, term),
        (),
        (term * (n / (n + 3)),),
        (sp.integrate(x**3 * sp.diff(term * x**n, x), (x, 0, 1)),),
        "The work of a term that goes with the n-th power of A: int_0^1 x^3 d(term x^n).",
        {},
        sp.simplify,
    )


def hertz_work() -> Routine:
    """What Hertz's term adds to S."""
    nested = sp.Integer(1)
    for _ in range(4):
        nested = 1 + s * nested
    work = sp.integrate(x**3 * sp.diff(x**2, x), (x, s, 1))
    return routine(
        "hertz_work",
        (s,),
        (Let(powers, nested),),
        (sp.Rational(2, 5) * powers,),
        (sp.cancel(work / (1 - s)),),
        "Work of Hertz's term from s to 1, over 1 - s.",
        {},
        sp.expand,
    )


class Nodes:
    """Where the inner integral's nodes lie, w = 1 - u from 0 to 1 - sqrt(1 - ratio)."""

    node, ratio, root = sp.symbols("node ratio root", positive=True)
    last, w, rest, q, left, short = sp.symbols("last w rest q left short", positive=True)
    height = sp.Symbol("height", positive=True)


def near_nodes() -> Routine:
    """q, 1 - q and s = q/ratio at the nodes, without cancellation."""
    k = Nodes
    u = 1 - (1 - k.root) * k.node
    q, s_there = 1 - u**2, (1 - u**2) / (1 - k.root**2)
    statements = (
        Let(k.last, k.ratio / (1 + k.root)),
        Let(k.w, k.last * k.node),
        Let(k.rest, k.last * (1 - k.node)),
        Let(k.q, k.w * (2 - k.w)),
        Let(k.height, k.root + k.rest),
        Let(k.left, k.height**2),
        Let(k.short, k.rest * (k.root + k.height) / k.ratio, "1 - s"),
    )
    results = k.q, k.q / k.ratio, k.left, k.short * k.ratio**5 / k.left, k.last
    return routine(
        "near_nodes",
        (k.node, k.ratio, k.root),
        statements,
        results,
        (q, s_there, 1 - q, (1 - s_there) * (1 - k.root**2) ** 5 / (1 - q), 1 - k.root),
        "q, s = q/ratio, 1 - q, (1 - s) ratio^5/(1 - q), and where w ends; root^2 is 1 - ratio.",
        {k.ratio: 1 - k.root**2},
        sp.cancel,
    )


def work_weight() -> Routine:
    """What of a node's weight makes the work of V."""
    rise = R / a * sp.diff(DEPTH, a)
    return routine(
        "work_weight",
        (x, weight),
        (),
        (weight * x**4,),
        (weight * sp.cancel(R * a**3 * sp.diff(DEPTH, a) / rise),),
        "What V is multiplied by in int x^3 d(x^2 (1 + F)).",
        {x: a},
    )


def rates() -> Routine:
    """V and its slopes by log A and by log eta."""
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
    return routine(
        "rates",
        (F, slope, curve, lift, deeper),
        (Let(law.whole, 1 + F),),
        (2 * law.whole + slope, 2 * slope + curve, 2 * lift + deeper),
        (rise, a * sp.diff(rise, a), sp.diff(rise, log_eta)),
        "V = 2 (1 + F) + A F', and its slopes by log A and by log(h/b).",
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
"""What the sums stand for."""


def peak_growth() -> Routine:
    """How the largest radius and indentation grow."""
    return routine(
        "peak_growth",
        (energy, rate, energy_slope, lift, lift_slope),
        (),
        (energy / rate, -energy_slope / rate, energy / lift, (lift_slope - energy_slope) / lift),
        tuple(formula.expression for formula in peaks()),
        "How A_m and delta_m grow with energy number and h/b: logarithmic slopes.",
        SUMS,
        sp.cancel,
    )


def _time_parts(weights: Mapping[int, sp.Expr]) -> tuple[sp.Expr, sp.Expr]:
    """N and S."""
    q = 1 - u_t**2
    stored = weighted(weights, lambda k: _work(k) * sp.Add(*(q**i for i in range(k + 3))))
    return weighted(weights, lambda k: k * q ** (k - 1)), stored


def time_terms() -> Routine:
    """The integrand of the contact time and its slopes, a term of the quadrature each."""
    names = sp.symbols("N S N_1 S_1 N_2 S_2", positive=True)
    N, S, N_1, S_1, N_2, S_2 = names
    scaled, half = sp.symbols("scaled half", positive=True)
    values = [
        value
        for weights in (LAW_WEIGHTS, RADIUS_WEIGHTS, ETA_WEIGHTS)
        for value in _time_parts(weights)
    ]
    return routine(
        "time_terms",
        (*names, weight),
        (Let(scaled, weight / sp.sqrt(S)), Let(half, N / (2 * S))),
        (N * scaled, (N_1 - half * S_1) * scaled, (N_2 - half * S_2) * scaled),
        tuple(weight / 2 * part.expression for part in (contact_time()[0], *times())),
        "Terms of int N/sqrt(S) and of its slopes by log A_m and log(h/b).",
        dict(zip(names, values, strict=True)),
    )


class TimeIntegral(sp.Function):
    """Integral of N/sqrt(S), of A_m and log(h/b)."""

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """By log A_m, or by log(h/b)."""
        return (by_radius / sp.exp(self.args[0]), by_thickness)[argindex - 1]


def time_growth() -> Routine:
    """How the contact time grows: it goes with a_m^2/sqrt(a_m^5) times the integral."""
    log_A = sp.Symbol("log_A", real=True)
    A = sp.exp(log_A)
    time = sp.log(TimeIntegral(log_A, log_eta)) + sp.expand_log(sp.log(A**2 / sp.sqrt(A**5)))
    value = time.subs(TimeIntegral(log_A, log_eta), total)
    slopes = [by_radius / total, by_thickness / total]
    by_log_A, by_log_eta = sp.diff(value, log_A) + slopes[0], sp.diff(value, log_eta) + slopes[1]
    return routine(
        "time_growth",
        (total, by_radius, by_thickness, first, second),
        (Let(rate, by_radius / total - sp.Rational(1, 2)),),
        (rate * first, rate * second + by_thickness / total),
        (by_log_A * first, by_log_A * second + by_log_eta),
        "How the contact time grows with energy number and h/b, by how A_m does.",
        {},
        sp.simplify,
    )


def parameter_power() -> Routine:
    """The power of a parameter, locally."""
    log_p = sp.Symbol("log_p", real=True)
    change = own * log_p + by_energy * (of_energy * log_p) + by_eta * (of_eta * log_p)
    return routine(
        "parameter_power",
        (own, of_energy, of_eta, by_energy, by_eta),
        (),
        (own + by_energy * of_energy + by_eta * of_eta,),
        (sp.diff(change, log_p),),
        "Power of a parameter in a result: its own, and those by energy number and h/b.",
        {},
        sp.expand,
    )


def share_of_lam() -> Routine:
    """Of the modulus; quotients, so that products stay in range."""
    return routine(
        "share_of_lam",
        (lam, mu),
        (Let(first, lam / (lam + mu)), Let(second, mu / (lam + 2 * mu))),
        (first * second,),
        (modulus_slope().expression,),
        "d log E*/d log lam; that by log mu is the rest to 1.",
        {},
        sp.cancel,
    )


ROUTINES = (
    power_work,
    hertz_work,
    near_nodes,
    work_weight,
    rates,
    peak_growth,
    time_terms,
    time_growth,
    parameter_power,
    share_of_lam,
)
