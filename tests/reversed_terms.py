"""The coefficients of the reversed series by balls."""

from functools import cache

import flint
from flint import arb, arb_series

from derivation.plate.contact.oracle import balls as contact_balls


@cache
def reversed_terms(h: float, b: float, terms: int) -> tuple[arb, ...]:
    """p_0 = 1, p_1, ... by the theory's coefficients."""
    series = [arb(1), *(arb(0) for _ in range(terms - 1))]
    for order in range(1, terms, 2):
        series[order] = contact_balls.coefficient(order, h, b, 25)
    cap, flint.ctx.cap = flint.ctx.cap, terms
    try:
        with flint.ctx.workprec(200):
            bracket = arb_series(series, terms)
            powers = [bracket ** (arb(-(n + 3)) / 2) for n in range(terms)]
            return tuple(power[n] * 3 / (n + 3) for n, power in enumerate(powers))
    finally:
        flint.ctx.cap = cap
