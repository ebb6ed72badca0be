"""The contact time of an impact without stepping: paper's formulas, quadrature, oracle."""

import math

import numpy as np
from flint import arb

from derivation.plate.benchmark.arithmetic import Array, BallArithmetic
from derivation.plate.benchmark.interface import Call, Method, Regime
from derivation.plate.benchmark.law_sums import EXACT, wrapped
from derivation.plate.benchmark.reference_law import sure_duration
from derivation.plate.contact.oracle.balls import modulus
from derivation.plate.impact.oracle import impact as contact_impact
from generated.impact import _parts, _solve, impact
from generated.impact_shapes import time_rate
from generated.perturbation import PrintedMotion, printed_motion
from generated.ranges import product

NODES = 24
"""Of the generated code."""

MODES = 100
"""Where the paper's divergent sums are cut off for its perturbation."""

HERTZ_TIME = 4 * math.sqrt(math.pi) * math.gamma(0.4) / (5 * math.gamma(0.9))
"""Contact time v0/delta_max on a half-space [1]."""


def hertz_time(regime: Regime) -> Call:
    """Contact times on a half-space [s] for speeds [m/s]."""
    stiff = 4 / 3 * regime.modulus * math.sqrt(regime.R)
    return lambda v0: HERTZ_TIME * (1.25 * regime.m * v0 * v0 / stiff) ** 0.4 / v0


def hertz() -> Method:
    """The plate left out."""

    def same(regime: Regime) -> Call:
        with EXACT.context():
            fifth = arb(1) / 5
            factor = 4 * arb.pi().sqrt() * (2 * fifth).gamma() / (5 * (arb(9) / 10).gamma())
            stiff = 4 * modulus(regime.lam, regime.mu) * arb(regime.R).sqrt() / 3
            scale = factor * (5 * arb(regime.m) / (4 * stiff)) ** (2 * fifth)
            return wrapped(EXACT, lambda v0: scale / np.array([v**fifth for v in v0]))

    return Method("impact", "Hertz", "", hertz_time, same=same)


def paper_motion(
    regime: Regime, v0: float, modes: int, *, corrected: bool = False
) -> PrintedMotion:
    """The paper's motion in a regime at a speed [m/s]."""
    r = regime
    return printed_motion(r.R, r.m, v0, r.h, r.b, r.lam, r.mu, modes, corrected=corrected)


def linear(modes: int) -> Method:
    """The paper's linear term (15), whose contact time does not know the speed."""

    def prepare(regime: Regime) -> Call:
        time = paper_motion(regime, regime.v0, modes).contact_time
        return lambda v0: np.full(np.shape(v0), time)

    def same(regime: Regime) -> Call:
        """pi sqrt(m gamma_2), gamma_2 = R/(4 E*) sum phi^3 K."""
        with EXACT.context():
            h, b, m = (EXACT.array(x) for x in (regime.h, regime.b, regime.m))
            j, slope = EXACT.zeros(modes)
            factors = (1 + EXACT.excess(2 * h * j / b)) / (j * slope * slope)
            gamma = 8 * factors.sum() / (4 * modulus(regime.lam, regime.mu) * arb.pi() * b)
            time = arb.pi() * (m * gamma).sqrt()
        return lambda v0: np.array([time] * np.size(v0))

    return Method("impact", "paper's linear term", f"{modes} modes", prepare, same=same)


def perturbation(corrected: bool) -> Method:
    """The paper's correction (16) with xi_3 as printed or corrected: twice the turning point."""
    kind = "corrected" if corrected else "as printed"

    def fails(regime: Regime) -> str:
        # Everywhere: both xi_3 are sums of positive terms.
        share = paper_motion(regime, regime.v0, MODES, corrected=corrected).share
        return f"root of a negative number in (17), (18) from {share:.3g} of the way to the top on"

    def prepare(regime: Regime) -> Call:
        def one(v0: float) -> float:
            motion = paper_motion(regime, v0, MODES, corrected=corrected)
            t = np.linspace(0, motion.contact_time / 2, 2001)
            return float(2 * t[int(np.nanargmax(motion.corrected(t)))])

        return lambda v0: np.array([one(float(v)) for v in np.atleast_1d(v0)])

    return Method(
        "impact", f"paper's perturbation, {kind}", f"{MODES} modes", prepare, fails=fails,
        one_by_one=True,
    )  # fmt: skip


def gauss(nodes: int) -> Method:
    """The generated code's integrand for the contact time with another number of nodes."""
    x, w = np.polynomial.legendre.leggauss(nodes)
    x, w = (1 + x) / 2, w / 2

    def prepare(regime: Regime) -> Call:
        r = regime
        R, m, h, b, lam, mu = (np.asarray(y, float) for y in (r.R, r.m, r.h, r.b, r.lam, r.mu))

        def call(v0: Array) -> Array:
            with np.errstate(all="ignore"):  # as `impact` itself
                found, _, depth, _, _ = _solve(R, m, v0, h, b, lam, mu)
                integral = np.empty_like(found.A)
                for part in _parts(found.A.size):
                    at = np.broadcast_to(x, (found.A[part].size, nodes))
                    integral[part] = (time_rate(at, found, part) * w).sum(axis=1)
                return product((2.0, *depth, integral), (v0,))

        return call

    return Method("impact", "Gauss-Legendre", f"{nodes} nodes", prepare, same=sure_duration(nodes))


def production(dtype: type[np.float32 | np.float64] = np.float64) -> Method:
    """`impact` as called, with its 24 nodes and all four results."""

    def prepare(regime: Regime) -> Call:
        r = regime
        R, m, h, b, lam, mu = (dtype(x) for x in (r.R, r.m, r.h, r.b, r.lam, r.mu))
        return lambda v0: impact(R, m, v0.astype(dtype), h, b, lam, mu).contact_time

    name = np.dtype(dtype).name
    return Method("impact", "production", "as called", prepare, name, sure_duration(NODES))


def oracle(digits: int, quick: bool = True) -> Method:
    """The conservative impact in balls."""

    def prepare(regime: Regime) -> Call:
        def one(v0: float) -> object:
            r = regime
            found = contact_impact.impact(r.R, r.m, v0, r.h, r.b, r.lam, r.mu, digits)
            return found.contact_time

        return lambda v0: [one(float(v)) for v in np.atleast_1d(v0)]

    return Method(
        "impact", "integrals in balls", f"{digits} digits", prepare, BallArithmetic(digits).name,
        one_by_one=True, certified=True, quick=quick,
    )  # fmt: skip
