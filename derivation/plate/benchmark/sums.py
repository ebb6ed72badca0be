"""The contact law as sums over the modes: as printed, stable, extrapolated, and split."""

import math
from functools import cache, partial

import flint
import numpy as np
from flint import arb

from derivation.plate.benchmark.arithmetic import DOUBLE, LONG_DOUBLE, Arithmetic, Array
from derivation.plate.benchmark.interface import BenchmarkCase, Call, Method

WIDE_MODES = 1000
"""Direct sums of more modes are repeated in long doubles, in which their truncation error shows.
Split sums of more modes are omitted where numbers are evaluated one by one."""

_MODES, _ELEMENTS = 4096, 65536
"""Modes and array elements that are processed at a time, so that they fit into the cache."""

OVERFLOW = 709.78
"""Exponent above which e^x exceeds the largest double."""

TURN = 2 * math.pi / 3
"""Phase between two samples of Levin's partial sums, a third of a circle."""

MOST_MODES = 100_000


def modal(ar: Arithmetic, phi: Array, weights: Array) -> Call:
    """Return sum_j weights_j s(phi_j a) as a function of a; small terms are added first."""

    def call(a: Array) -> Array:
        total = a * 0
        for begin in reversed(range(0, phi.size, _MODES)):
            block, factors = phi[begin : begin + _MODES], weights[begin : begin + _MODES]
            step = max(1, _ELEMENTS // block.size)
            for k in range(0, a.size, step):
                terms = ar.shape(a[k : k + step, None] * block) * factors
                total[k : k + step] += terms.sum(axis=-1)
        return total

    return call


def _direct(modes: int, is_printed: bool, case: BenchmarkCase, ar: Arithmetic) -> Call:
    R, h, b = (ar.number(x) for x in (case.R, case.h, case.b))
    j, slope = ar.zeros(modes)
    phi = j / b
    factor = ar.printed_factor(phi * h) if is_printed else 1 + ar.excess(2 * phi * h)
    square = phi * phi * slope
    return modal(ar, phi, 8 * factor / (ar.pi() * R * b * b * square * square))


def printed(modes: int) -> Method:
    """Return the method of the paper's sum (6) with its published plate factor, in doubles."""

    def fails(case: BenchmarkCase) -> str | None:
        most = 8 * math.pi * modes * case.eta
        return (
            f"overflow: e^(8 phi h) with phi h up to {most / 8:.3g} is infinite, inf/inf is NaN"
            if most > OVERFLOW
            else None
        )

    return Method("law", "published sum", f"{modes} modes", partial(_direct, modes, True),
                  fails=fails)  # fmt: skip


def direct(modes: int, ar: Arithmetic = DOUBLE, quick: bool = True) -> Method:
    """Return the method of that sum with a plate factor without overflow and cancellation."""
    return Method(
        "law", "direct sum", f"{modes:g} modes", partial(_direct, modes, False), ar,
        "long" if modes > WIDE_MODES and ar is not LONG_DOUBLE else "wide", quick=quick,
    )  # fmt: skip


# --- Levin's transformation


def levin(samples: int) -> Method:
    """Return the method of Levin's u transformation of sampled complex partial sums.

    s(y) = Im (1 - i y) e^(iy). The terms with y < TURN are summed as s itself, because
    (1 - i y) e^(iy) cancels there.
    """

    def fails(case: BenchmarkCase) -> str | None:
        needed = round((samples + 3) * TURN / (case.low * case.eta * math.pi))
        if needed > MOST_MODES:
            return f"its {samples} samples (three in each period) need {needed:.1g} modes"
        return None

    def prepare(case: BenchmarkCase, ar: Arithmetic) -> Call:
        R, h, b = (ar.number(x) for x in (case.R, case.h, case.b))
        j, slope = ar.zeros((samples + 3) * stride_at(case.low * case.eta))
        square = j * j * slope
        weights = 8 * b * b * (1 + ar.excess(2 * j * h / b)) / (ar.pi() * R * square * square)

        def one(a: Array) -> Array:
            stride = stride_at(float(a) / case.b)
            count = stride * (samples + 2)
            y, w = a / b * j[:count], weights[:count]
            head = (w[:stride] * ar.shape(y[:stride])).sum()
            terms = w[stride:] * ar.complex_shape(y[stride:])
            at = stride * np.arange(1, samples + 2) - 1
            index = ar.array(at + 1.0 + stride)
            limit = u_transform(np.cumsum(terms)[at], index * terms[at], index)
            return head + limit.imag

        return lambda a: np.array([one(x) for x in np.atleast_1d(a)])

    return Method(
        "law", "Levin u transform", f"{samples} samples", prepare, fails=fails, scalar=True
    )


def stride_at(alpha: float) -> int:
    """Return the number of modes between two samples."""
    return max(1, round(TURN / (alpha * math.pi)))


def u_transform(sums: Array, estimates: Array, indices: Array) -> Array:
    """Return Levin's limit of partial sums, from estimates of their remainders.

    It is the quotient of the k-th divided differences of places^(k-1) sums/estimates and
    places^(k-1)/estimates.
    """
    k = len(sums) - 1
    binomials = np.array([(-1.0) ** i * math.comb(k, i) for i in range(k + 1)])
    weights = binomials * (indices / indices[-1]) ** (k - 1) / estimates
    return (weights * sums).sum() / weights.sum()


# --- split: Hertz's term, the finite-radius integral by n nodes, the thickness term by m modes


@cache
def lateral_nodes(count: int, digits: int, double_exponential: bool, bits: int) -> list[list[arb]]:
    """Return nodes y and weights times K0/(I0 y^3) of the finite-radius integral, alpha <= 1.

    Double exponential: the trapezoidal rule in t, y = exp(t - exp(-t)), which removes the
    logarithm of K0 at 0. Otherwise Gauss-Legendre in u, y = u^3.
    """
    with flint.ctx.workprec(bits):
        if double_exponential:
            low = -math.log(math.log(10) * digits)
            high = math.log(math.log(10) * (digits + 1)) + 0.05
            step = arb(high - low) / (count - 1)
            times = [arb(low) + step * k for k in range(count)]
            ys = [(t - (-t).exp()).exp() for t in times]
            steps = [step * y * (1 + (-t).exp()) for t, y in zip(times, ys, strict=True)]
        else:
            end = (arb(digits + 2) * arb(10).log()).root(3)
            rule = [arb.legendre_p_root(count, k, weight=True) for k in range(count)]
            us = [end * (1 + x) / 2 for x, _ in rule]
            ys = [u**3 for u in us]
            steps = [end / 2 * w * 3 * u * u for u, (_, w) in zip(us, rule, strict=True)]
        weights = [
            w * y.bessel_k(0) / (y.bessel_i(0) * y**3) for w, y in zip(steps, ys, strict=True)
        ]
        return [ys, weights]


def modes_of(case: BenchmarkCase, multiple: float) -> int:
    """Return the number of modes of the thickness term, which decays like e^(-4 pi n h/b)."""
    return max(1, math.ceil(multiple / case.eta))


def split(
    nodes: int, multiple: float, ar: Arithmetic = DOUBLE, double_exponential: bool = True,
    quick: bool = True,
) -> Method:  # fmt: skip
    """Return the method of Hertz's term, the radius integral and a sum of `multiple` b/h modes."""
    end = ar.digits + 1  # digits for the ends of the integral

    def fails(case: BenchmarkCase) -> str | None:
        modes = modes_of(case, multiple)
        dear = modes > WIDE_MODES and ar.name != DOUBLE.name
        return f"needs {modes} modes for each point in slow arithmetic" if dear else None

    def prepare(case: BenchmarkCase, ar: Arithmetic) -> Call:
        y, W = (ar.array(row) for row in lateral_nodes(nodes, end, double_exponential, ar.bits))
        R, h, b = (ar.number(x) for x in (case.R, case.h, case.b))
        j, slope = ar.zeros(modes_of(case, multiple))
        phi, pi = j / b, ar.pi()
        square = phi * phi * slope
        thickness = modal(
            ar, phi, 8 * ar.excess(2 * phi * h) / (pi * R * b * b * square * square)
        )  # fmt: skip
        factor = 8 * b * b / (pi * pi * R)

        def call(a: Array) -> Array:
            values = thickness(a) + a * a / R
            for k in range(0, a.size, _ELEMENTS // 64):
                part = slice(k, k + _ELEMENTS // 64)
                t = (a[part] / b)[:, None] * y
                values[part] -= factor * (ar.lateral_shape(t) * W).sum(axis=-1)
            return values

        return call

    rule = "" if double_exponential else ", y = u^3"
    return Method("law", f"split sum{rule}", f"{nodes} nodes, {multiple:g} b/h modes", prepare, ar,
                  fails=fails, quick=quick)  # fmt: skip
