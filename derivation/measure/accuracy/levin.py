"""The contact law by Levin's u-transformation of the direct sum's partial sums."""

import math

import numpy as np

from derivation.measure.accuracy.arithmetic import DOUBLE
from derivation.measure.accuracy.interface import Call, Method, Regime

TURN = 2 * math.pi / 3
"""Phase between two samples of the partial sums: a third of a circle separates them best."""

MOST_MODES = 100_000


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

    return Method("law", "Levin u", f"{samples} samples", prepare, fails=fails, one_by_one=True)


def u_transform(sums: np.ndarray, estimates: np.ndarray, places: np.ndarray) -> complex:
    """Levin's transformation: partial sums and estimates of their remainders at given places.

    The k-th divided differences of places^(k-1) sums/estimates and places^(k-1)/estimates,
    their quotient.
    """
    k = len(sums) - 1
    binomials = np.array([(-1) ** i * math.comb(k, i) for i in range(k + 1)], dtype=np.float64)
    weights = binomials * (places / places[-1]) ** (k - 1) / estimates
    return complex((weights * sums).sum() / weights.sum())
