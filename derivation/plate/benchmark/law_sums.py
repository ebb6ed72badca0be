"""The contact law as sums over the modes: as printed, stable, and split into convergent parts."""

import math
from collections.abc import Callable
from functools import cache

import flint
from flint import arb

from derivation.plate.benchmark.arithmetic import (
    DOUBLE,
    HAS_LONG,
    LONG,
    Arithmetic,
    Array,
    BallArithmetic,
)
from derivation.plate.benchmark.interface import Call, Method, Regime

EXACT = BallArithmetic(40)
"""What stands for exact arithmetic where a truncated method in doubles is judged."""

DIRECT_MODES, SPLIT_MODES = 1000, 10_000
"""Sums of more modes are repeated in long doubles, not in balls. A direct sum leaves out so much
that these tell it; a split one, whose modes decay, far less than they tell."""

WIDE_MODES = 1000
"""Split sums of more modes are left out where numbers are taken one by one."""

_MODES, _ELEMENTS = 4096, 65536
"""Modes, and elements of an array, worked on at a time, so that they stay in the cache."""

OVERFLOW = 709.78
"""Exponent from which e^x is no double."""


def modal(ar: Arithmetic, phi: Array, weights: Array) -> Call:
    """sum_j weights_j s(phi_j a), the block of the last modes first: their terms are small."""

    def call(a: Array) -> Array:
        total = a * 0
        for begin in reversed(range(0, phi.size, _MODES)):
            some, factors = phi[begin : begin + _MODES], weights[begin : begin + _MODES]
            step = max(1, _ELEMENTS // some.size)
            for k in range(0, a.size, step):
                terms = ar.shape(a[k : k + step, None] * some) * factors
                total[k : k + step] += terms.sum(axis=-1)
        return total

    return call


def wrapped(ar: Arithmetic, inner: Call) -> Call:
    """A call on doubles in an arithmetic's precision."""

    def call(a: Array) -> Array:
        with ar.context():
            return inner(ar.array(a))

    return call


def exact_for(ar: Arithmetic) -> BallArithmetic:
    """Exact arithmetic beside another: with digits enough for its rounding to be seen."""
    return EXACT if ar.digits < EXACT.digits - 5 else BallArithmetic(ar.digits + 20)


def _plate(ar: Arithmetic, regime: Regime) -> tuple[Array, Array, Array, Array]:
    """R, h, b and pi in an arithmetic."""
    R, h, b = (ar.array(x) for x in (regime.R, regime.h, regime.b))
    with flint.ctx.workprec(bits_for(ar)):  # Arb's precision is not set by other contexts
        return R, h, b, ar.array(arb.pi())


def bits_for(ar: Arithmetic) -> int:
    """Precision at which constants are found for an arithmetic."""
    return math.ceil(3.33 * (ar.digits + 10)) + 64


def same_sum(ar: Arithmetic, modes: int, most: int) -> Arithmetic:
    """In what a sum is repeated for its rounding: balls up to so many modes, else long doubles.

    Raises
    ------
    NotImplementedError
        If it is of more modes, and in numbers as long as the long doubles there are.
    """
    if modes <= most:
        return exact_for(ar)
    if not HAS_LONG or ar.digits >= LONG.digits:
        raise NotImplementedError("so many modes in balls would take minutes")
    return LONG


def _direct(ar: Arithmetic, modes: int, printed: bool) -> Callable[[Regime], Call]:
    def prepare(regime: Regime) -> Call:
        with ar.context():
            R, h, b, pi = _plate(ar, regime)
            j, slope = ar.zeros(modes)
            phi = j / b
            factor = ar.printed_factor(phi * h) if printed else 1 + ar.excess(2 * phi * h)
            square = phi * phi
            weights = 8 * factor / (pi * R * b * b * square * square * slope * slope)
            return wrapped(ar, modal(ar, phi, weights))

    return prepare


def printed(modes: int) -> Method:
    """The paper's sum (6) with its own plate factor, in doubles."""

    def fails(regime: Regime) -> str | None:
        most = 8 * math.pi * modes * regime.eta
        return (
            f"overflow: e^(8 phi h) with phi h up to {most / 8:.3g} is infinite, inf/inf is NaN"
            if most > OVERFLOW
            else None
        )

    return Method(
        "law", "printed sum", f"{modes} modes", _direct(DOUBLE, modes, True),
        same=_direct(EXACT, modes, True), fails=fails,
    )  # fmt: skip


def direct(modes: int, ar: Arithmetic = DOUBLE, quick: bool = True) -> Method:
    """The same sum with a plate factor that neither overflows nor cancels."""

    def same(regime: Regime) -> Call:
        return _direct(same_sum(ar, modes, DIRECT_MODES), modes, False)(regime)

    return Method(
        "law", "direct sum", f"{modes:g} modes", _direct(ar, modes, False), ar.name, same,
        quick=quick,
    )  # fmt: skip


# --- split: Hertz's term, the side wall by n nodes, the thickness by m modes


@cache
def wall_nodes(count: int, digits: int, double_exponential: bool, bits: int) -> list[list[arb]]:
    """Nodes y, and weights times K0/(I0 y^3), of the side wall's integral, good for alpha <= 1.

    Double exponential: trapezoidal rule in t, y = exp(t - exp(-t)), which does away with
    K0's logarithm at 0. Otherwise Gauss-Legendre in u, y = u^3.
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


def _split(
    ar: Arithmetic, nodes: int, share: float, double_exponential: bool, digits: int
) -> Callable[[Regime], Call]:
    def prepare(regime: Regime) -> Call:
        found = wall_nodes(nodes, digits, double_exponential, bits_for(ar))
        with ar.context():
            y, W = (ar.array(column) for column in found)
            R, h, b, pi = _plate(ar, regime)
            j, slope = ar.zeros(modes_of(regime, share))
            phi = j / b
            square = phi * phi
            weights = 8 * ar.excess(2 * phi * h) / (pi * R * b * b * square * square)
            thickness = modal(ar, phi, weights / (slope * slope))
            factor = 8 * b * b / (pi * pi * R)

            def call(a: Array) -> Array:
                found = thickness(a) + a * a / R
                for k in range(0, a.size, _ELEMENTS // 64):
                    part = slice(k, k + _ELEMENTS // 64)
                    t = (a[part] / b)[:, None] * y
                    found[part] -= factor * (ar.wall_shape(t) * W).sum(axis=-1)
                return found

            return wrapped(ar, call)

    return prepare


def modes_of(regime: Regime, share: float) -> int:
    """Modes of the thickness' part, which decays like e^(-4 pi n h/b)."""
    return max(1, math.ceil(share / regime.eta))


def split(
    nodes: int, share: float, ar: Arithmetic = DOUBLE, double_exponential: bool = True,
    quick: bool = True,
) -> Method:  # fmt: skip
    """Hertz's term less the side wall's integral plus the thickness' sum of share b/h modes."""
    digits = ar.digits + 1
    rule = "" if double_exponential else ", y = u^3"

    def fails(regime: Regime) -> str | None:
        modes = modes_of(regime, share)
        dear = modes > WIDE_MODES and ar.name != DOUBLE.name
        return f"takes {modes} modes a point in numbers other than doubles" if dear else None

    def same(regime: Regime) -> Call:
        numbers = same_sum(ar, modes_of(regime, share), SPLIT_MODES)
        return _split(numbers, nodes, share, double_exponential, digits)(regime)

    return Method(
        "law", f"split{rule}", f"{nodes} nodes, {share:g} b/h modes",
        _split(ar, nodes, share, double_exponential, digits), ar.name,
        same, fails, ar.wide, quick=quick,
    )  # fmt: skip
