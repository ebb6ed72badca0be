"""Arb reference for clamped and supported plates of finite thickness: step 30 as balls.

S/Gam - beta changes sign between two numbers that enclose k; kap there is the Arb reference of A0
at each of the two. That there is only one change in an interval is tested, not certified. kap and
the residue of A0 are monotonic along k and are enclosed by their values at both ends.
"""

from collections.abc import Callable
from fractions import Fraction
from functools import cache
from typing import NamedTuple

import flint
import sympy as sp
from flint import arb

from derivation.engine.formula.ball import Exact, enclose, to_ball
from derivation.mathematics.bessel.oracle import j0_zero
from derivation.plate.contact.oracle.balls import refine_to_digits
from derivation.plate.edge_modes.oracle.modes import Edge, RootError
from derivation.plate.edge_modes.theory import waves as theory
from derivation.plate.edge_modes.theory.mindlin import c, k_2
from derivation.plate.vocabulary import alpha, eta, k_n, kap, nu
from derivation.plate.waves import oracle as inertia_balls

_HALVINGS, _STEPS = 8, 200
_GUARD = 64
_LOWEST = Fraction(1, 2**14)
"""Start of the search for the first supported mode, below its value at nu = -1 + 2^-53."""


class EdgeMode(NamedTuple):
    """k b, omega h/c_T, k2 b, amplitude of I0, face over mean deflection, W, rho h r."""

    k: arb
    root: arb
    k2: arb
    c: arb
    t: arb
    weight: arb
    residue: arb


def wave(edge: Edge, n: int, thickness: Exact, ratio: Exact, digits: int = 30) -> EdgeMode:
    """Return the n-th mode of a clamped or supported plate.

    Parameters
    ----------
    edge
        Edge condition, "clamped" or "supported".
    n
        Number of the mode, from 1.
    thickness, ratio
        h/b > 0 and Poisson's ratio, -1 < ratio < 1/2.
    digits
        Correct decimal digits required of the balls.

    Raises
    ------
    ValueError
        If an argument is outside its range.
    RootError
        If there is no change of sign in the mode's interval below the cut-off.
    PrecisionError
        If the precision is not sufficient.
    """
    if n < 1 or not thickness > 0 or not -1 < ratio < Fraction(1, 2):
        raise ValueError(
            f"expected n >= 1, h/b > 0 and -1 < nu < 1/2, got {n}, {thickness}, {ratio}"
        )
    given = Fraction(thickness), Fraction(ratio)

    def compute(bits: int) -> tuple[arb, ...]:
        with flint.ctx.workprec(bits + 2 * n.bit_length() + _GUARD):
            return _values(*_root(edge, n, *given, bits), *given, bits)

    return EdgeMode(
        *refine_to_digits(compute, digits, f"{edge} wave {n} at {float(thickness)}, {float(ratio)}")
    )


@cache
def cutoff(ratio: Exact, digits: int = 30) -> tuple[Fraction, Fraction]:
    """Return numbers below and above x = k h/b at which k2 vanishes."""
    partner = _expression("evanescent_wave_number") ** 2
    low, high = Fraction(1), Fraction(3)
    while high - low > low / 10**digits:
        x = (low + high) / 2
        load = inertia_balls.zero(x, ratio, digits=digits + 10)
        with flint.ctx.workprec(4 * digits + _GUARD):
            square = enclose(partner, _known(to_ball(x), load, Fraction(1), Fraction(ratio)))
            if not (square > 0 or square < 0):
                break
            low, high = (x, high) if square > 0 else (low, x)
    return low, high


@cache
def _expression(name: str) -> sp.Expr:
    """Return quantities of step 30 in k, kap, eta and nu."""
    return theory.in_k(
        {
            "evanescent_wave_number": k_2,
            "evanescent_amplitude": theory.PART,
            "face_ratio": theory.FACE,
            "wave_weight": theory.WEIGHT.subs(theory.N, theory.NORM),
            "supported_wave": theory.TURN - theory.SUPPORTED * theory.BEND,
            "clamped_wave": theory.TURN - theory.CLAMPED * theory.BEND,
        }[name]
    )


def _known(k: arb, load: arb, thickness: Fraction, ratio: Fraction) -> dict[sp.Basic, arb]:
    return {k_n: k, kap: load, eta: to_ball(thickness), nu: to_ball(ratio)}


def on_face(punch: bool, k: Exact, partner: Exact, ratio: Exact, at: Exact) -> arb:
    """Return the contact face at r/b over that on the axis, or its mean under a punch minus 1.

    Parameters
    ----------
    punch
        Return the mean instead.
    k, partner, ratio, at
        Wave numbers times b, t, and r/b or the punch's radius over b.
    """
    value = (theory.UNDER_PUNCH if punch else theory.ON_FACE) / (1 - c * theory.t)
    known = {k_n: k, k_2: partner, theory.t: ratio, alpha: at}
    balls = {s: to_ball(x) for s, x in known.items()}
    return enclose(value.subs(c, theory.PART) - int(punch), balls)


def _root(
    edge: Edge, n: int, thickness: Fraction, ratio: Fraction, bits: int
) -> tuple[Fraction, Fraction]:
    """Return numbers below and above k at which the edge's condition has opposite signs."""
    condition = _expression(f"{edge}_wave") / k_n**2

    def excess(k: Fraction) -> arb:
        load = inertia_balls.zero(k * thickness, ratio, digits=_decimals(bits))
        return enclose(condition, _known(to_ball(k), load, thickness, ratio))

    def regular(k: Fraction) -> arb:
        """Return the condition without poles at the zeros of J0."""
        return excess(k) * to_ball(k).bessel_j(0)

    first = n if edge == "clamped" else n - 1
    low = _exact(j0_zero(first, bits // 2).upper()) if first else _LOWEST
    high = _exact(j0_zero(first + 1, bits // 2).lower())
    high = min(high, cutoff(ratio)[0] / thickness)
    if low >= high or not excess(high) > 0:
        raise RootError(f"{edge} mode {n} is beyond the cut-off at h/b = {float(thickness)}")
    k = _illinois(regular, low, high, bits)
    radius = k / 2**bits
    if not (excess(k - radius) < 0 < excess(k + radius)):
        raise RootError(f"no change of sign at {float(k)} for {edge} mode {n}")
    return k - radius, k + radius


def _illinois(
    function: Callable[[Fraction], arb], low: Fraction, high: Fraction, bits: int
) -> Fraction:
    """Return an approximation of a root, by bisection and then the Illinois method."""
    at_low, at_high = (_exact(function(k).mid()) for k in (low, high))
    for step in range(_STEPS):
        k = (low + high) / 2
        if step >= _HALVINGS:
            k = high - at_high * (high - low) / (at_high - at_low)
        k = _exact(to_ball(k).mid())
        value = _exact(function(k).mid())
        moved = abs(k - high)
        if (value > 0) != (at_high > 0):
            low, at_low = high, at_high
        elif step >= _HALVINGS:
            at_low /= 2
        high, at_high = k, value
        if value == 0 or moved < k / 2 ** (bits + 4):
            return k
    raise RootError(f"no root found near {float(high)}")


def _values(
    low: Fraction, high: Fraction, thickness: Fraction, ratio: Fraction, bits: int
) -> tuple[arb, ...]:
    """Return all quantities of a mode from two numbers that enclose k."""
    digits = _decimals(bits)

    def between(function: Callable[..., arb]) -> arb:
        ends = [function(k * thickness, ratio, digits=digits) for k in (low, high)]
        return ends[0].union(ends[1])

    k, load = to_ball(low).union(to_ball(high)), between(inertia_balls.zero)
    known = _known(k, load, thickness, ratio)
    names = ("evanescent_wave_number", "evanescent_amplitude", "face_ratio", "wave_weight")
    k2, c, t, weight = (enclose(_expression(name), known) for name in names)
    return k, load.sqrt(), k2, c, t, weight, between(inertia_balls.residue)


def _decimals(bits: int) -> int:
    return bits * 3 // 10 + 20


def _exact(point: arb) -> Fraction:
    mantissa, exponent = point.mid().man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
