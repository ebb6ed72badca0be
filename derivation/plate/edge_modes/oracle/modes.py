"""Arb reference for thin clamped and supported plates: each root is certified as a ball.

(J1/J0 + I1/I0)/k increases between neighbouring zeros of J0 (step 29). Minus S, with S = 0 for a
clamp and 2/(1 - nu) for a simple support, it has one change of sign there: the only root.
"""

from typing import Literal, NamedTuple

import flint
from flint import arb

from derivation.engine.formula.ball import Exact, enclose, to_ball
from derivation.mathematics.bessel.oracle import j0_zero
from derivation.plate.contact.oracle.balls import refine_to_digits
from derivation.plate.edge_modes.theory.modes import NORM, PART, WEIGHT
from derivation.plate.vocabulary import k_n

Edge = Literal["clamped", "supported"]
_HALVINGS, _NEWTON = 64, 12
_GUARD = 64


class Mode(NamedTuple):
    """Wave number times plate radius, part of I0, and weight."""

    k: arb
    c: arb
    weight: arb


class RootError(ArithmeticError):
    """Error: a root could not be certified."""


def mode(edge: Edge, n: int, nu: Exact = 0, digits: int = 30) -> Mode:
    """Return the n-th mode of a clamped or supported plate.

    Parameters
    ----------
    edge
        Edge condition, "clamped" or "supported".
    n
        Number of the mode, from 1.
    nu
        Poisson's ratio, which a clamped plate does not depend on; -1 < nu < 1.
    digits
        Correct decimal digits required of the balls.

    Raises
    ------
    ValueError
        If n or nu is outside its range.
    PrecisionError
        If the precision is not sufficient.
    """
    if n < 1 or not -1 < nu < 1:
        raise ValueError(f"expected n >= 1 and -1 < nu < 1, got {n} and {nu}")

    def compute(bits: int) -> tuple[arb, ...]:
        # I0 contains e^k, and the relative error of c is that of k times k.
        with flint.ctx.workprec(bits + 2 * n.bit_length() + _GUARD):
            known = {k_n: _root(edge, n, nu, bits + n.bit_length() + 8)}
            return known[k_n], enclose(PART, known), enclose(WEIGHT, known)

    return Mode(*refine_to_digits(compute, digits, f"{edge} mode {n} at nu = {float(nu)}"))


def _root(edge: Edge, n: int, nu: Exact, bits: int) -> arb:
    slope = arb(0) if edge == "clamped" else 2 / (1 - to_ball(nu))
    first = n if edge == "clamped" else n - 1
    low = j0_zero(first, bits + _GUARD).upper() if first else arb(0)
    high = j0_zero(first + 1, bits + _GUARD).lower()

    def excess(k: arb) -> arb:
        return (k.bessel_j(1) / k.bessel_j(0) + k.bessel_i(1) / k.bessel_i(0)) / k - slope

    for _ in range(_HALVINGS):
        middle = ((low + high) / 2).mid()
        value = excess(middle)
        if not (value > 0 or value < 0):
            break
        low, high = (low, middle) if value > 0 else (middle, high)
    k = ((low + high) / 2).mid()
    for _ in range(_NEWTON):
        growth = 2 * enclose(NORM, {k_n: k}) / (k * k.bessel_j(0) ** 2)
        k = (k - excess(k) / growth).mid()
    radius = k * arb(2) ** -bits
    if not (excess(k - radius) < 0 < excess(k + radius)):
        raise RootError(f"no change of sign at {k} for {edge} mode {n}, nu = {float(nu)}")
    return arb(k, radius)
