"""The contact law by Levin's u-transformation of the direct sum's partial sums."""

import math
from functools import cache

import numpy as np
from flint import acb, arb

from derivation.mathematics.bessel import oracle as certified
from derivation.plate.benchmark.arithmetic import DOUBLE
from derivation.plate.benchmark.interface import Call, Method, Regime
from derivation.plate.benchmark.law_sums import EXACT
from derivation.plate.contact.oracle.sums import plate_excess

TURN = 2 * math.pi / 3
"""Phase between two samples of the partial sums: a third of a circle separates them best."""

MOST_MODES = 100_000

ZERO_BITS = 150
"""Of zeros in balls: the transformation takes digits, and the head of the sum too."""


def levin(samples: int) -> Method:
    """s(y) = Im (1 - i y) e^(iy): complex partial sums, sampled and extrapolated.

    The head, y < TURN, is summed as s itself, since (1 - i y) e^(iy) cancels there.
    """

    def fails(regime: Regime) -> str | None:
        needed = round((samples + 3) * TURN / (regime.low * regime.eta * math.pi))
        if needed > MOST_MODES:
            return f"its {samples} samples, a third of a turn apart, take {needed:.1g} modes"
        return None

    def prepare(regime: Regime) -> Call:
        alpha = regime.low * regime.eta
        most = (samples + 3) * (1 + round(TURN / (alpha * math.pi)))
        j, slope = DOUBLE.zeros(most)
        factor = 1 + DOUBLE.excess(2 * j * regime.eta)
        weights = 8 * regime.b**2 * factor / (math.pi * regime.R * j**4 * slope**2)

        def one(a: float) -> float:
            stride = max(1, round(TURN / (a / regime.b * math.pi)))
            count = stride * (samples + 2)
            y, w = a / regime.b * j[:count], weights[:count]
            head = (w[:stride] * DOUBLE.shape(y[:stride])).sum()
            y, w = y[stride:], w[stride:]
            terms = w * (1 - 1j * y) * np.exp(1j * y)
            at = stride * np.arange(1, samples + 2) - 1
            place = at + 1.0 + stride
            limit = u_transform(np.cumsum(terms)[at], place * terms[at], place)
            return float(head + limit.imag)

        return lambda a: np.array([one(float(x)) for x in np.atleast_1d(a)])

    def same(regime: Regime) -> Call:
        def one(a: float) -> arb:
            with EXACT.context():
                return _in_balls(a, regime, samples)

        return lambda a: [one(float(x)) for x in a]

    return Method(
        "law", "Levin u", f"{samples} samples", prepare, same=same, fails=fails, one_by_one=True
    )  # fmt: skip


def _in_balls(a: float, regime: Regime, samples: int) -> arb:
    """The same samples of the same sum, without rounding."""
    alpha = arb(a) / arb(regime.b)
    scale = 8 * arb(regime.b) ** 2 / (arb.pi() * arb(regime.R))
    stride = max(1, round(TURN / (a / regime.b * math.pi)))
    head, total = arb(0), acb(0)
    sums, estimates, places = [], [], []
    for n in range(1, stride * (samples + 2) + 1):
        j, weight = _mode(n, regime.h, regime.b)
        y = alpha * j
        if n <= stride:
            head += weight * EXACT.shape(y)
            continue
        sine, cosine = y.sin_cos()
        term = weight * acb(cosine + y * sine, sine - y * cosine)
        total += term
        if n % stride == 0:
            sums.append(total)
            estimates.append(n * term)
            places.append(arb(n))
    return scale * (head + _limit(sums, estimates, places).imag)


@cache
def _mode(n: int, h: float, b: float) -> tuple[arb, arb]:
    """j_n, and G/(j_n^4 J1(j_n)^2)."""
    j, slope = certified.j0_zero(n, ZERO_BITS), certified.j1_at_zero(n, ZERO_BITS)
    factor = 1 + plate_excess(acb(2 * j * arb(h) / arb(b))).real
    return j, factor / (j**4 * slope**2)


def _limit(sums: list[acb], estimates: list[acb], places: list[arb]) -> acb:
    """`u_transform` in balls."""
    k = len(sums) - 1
    weights = [
        (-1) ** i * math.comb(k, i) * (places[i] / places[-1]) ** (k - 1) / estimates[i]
        for i in range(k + 1)
    ]
    above = (weight * value for weight, value in zip(weights, sums, strict=True))
    return sum(above, acb(0)) / sum(weights, acb(0))


def u_transform(sums: np.ndarray, estimates: np.ndarray, places: np.ndarray) -> complex:
    """Levin's transformation: partial sums and estimates of their remainders at given places.

    The k-th divided differences of places^(k-1) sums/estimates and places^(k-1)/estimates,
    their quotient.
    """
    k = len(sums) - 1
    binomials = np.array([(-1) ** i * math.comb(k, i) for i in range(k + 1)], dtype=np.float64)
    weights = binomials * (places / places[-1]) ** (k - 1) / estimates
    return complex((weights * sums).sum() / weights.sum())
