"""Turns the theory of held plates into the numbers and forms its generated code needs.

With s = I1/I0, S = 2/(1 - nu) for a simple support and 0 for a clamp, the frequency equation is
J1 = q J0, q = S k - s, and there

    c = J1/(q I0),   W = (1 - c)^2/(pi J1^2 [1 - (2 S - 2 + s^2)/q^2])

whose brackets do not cancel beyond the first mode of a support. Where modulus and phase are used,
J1^2 = 2 p/(pi k (1 + t^2)), t the phase's tangent. That first mode is a function of u = k^4:
with A = J0 I0, B = (J0 I1 + J1 I0)/k - A and E = 2 (I0 - J0)/k^2, power series in u all three,

    B = A (1 + nu)/(1 - nu),   W = E^2/(16 pi (A B' - A' B)).
"""

from collections.abc import Iterable
from fractions import Fraction
from functools import cache
from math import factorial

import flint
import sympy as sp

from derivation.engine.formula.ball import to_ball
from derivation.engine.formula.proof import Proof, lower_bessel, prove
from derivation.mathematics.bessel.kernels import (
    TOLERANCE,
    asymptotic_start,
    first_true,
    nearest_double,
    wrapped,
)
from derivation.mathematics.bessel.theory.modified import (
    logarithm_bound,
    products,
    ratio_bound,
    ratio_series,
    sum_bound,
)
from derivation.plate.contact.kernels.moments import BITS
from derivation.plate.contact.theory.split import zero_of_j0
from derivation.plate.edge_modes.theory.modes import I0, I1, J0, J1, PART, WEIGHT
from derivation.plate.vocabulary import k_n, nu


@cache
def forms() -> Proof:
    """The code's forms are those of the theory."""
    s, S = I1 / I0, sp.Symbol("S", real=True)
    q = S * k_n - s
    bracket = 1 - (2 * S - 2 + s**2) / q**2
    direct = (1 - J1 / (q * I0)) ** 2 / (sp.pi * J1**2 * bracket)
    A, B = J0 * I0, (J0 * I1 + J1 * I0) / k_n - J0 * I0
    # d/du = d/dk/(4 k^3).
    cross = (A * sp.diff(B, k_n) - B * sp.diff(A, k_n)) / (4 * k_n**3)
    first = (2 * (I0 - J0) / k_n**2) ** 2 / (16 * sp.pi * cross)
    supported = J1 / J0 + s - 2 * k_n / (1 - nu)
    # J1 = sqrt(2 p/(pi k)) cos(theta), theta' = 1/p; J1' = J0 - J1/k.
    p, p_1, t, Q = sp.symbols("p p' t Q", positive=True)
    tangent = p * (1 / (2 * k_n) - 1 / Q) + p_1 / 2
    slope = p_1 / (2 * p) - 1 / (2 * k_n) - t / p
    return prove(
        "Forms of held plates",
        "With J1 = q J0 put in; for the first supported mode at any k, B/A being (J1/J0 + I1/I0)/k "
        "less 1; the tangent from the logarithmic slope of J1.",
        {
            "tangent": slope.subs(t, tangent) - (1 / Q - 1 / k_n),
            "part": (J1 / (q * I0)).subs(J1, q * J0) - PART,
            "weight": (1 / direct - 1 / WEIGHT).subs(J1, q * J0),
            "first weight": lower_bessel(1 / first - 1 / WEIGHT),
            "first frequency": B / A - (1 + nu) / (1 - nu) - supported / k_n,
        },
    )


def modes_before(start: Fraction) -> int:
    """How many modes of each kind lie below `start`, where all four functions become series.

    As many as there are zeros of J0: with j_n the last, (J1/J0 + I1/I0)/k is to lie between 0 and
    1 at the start, so that the n-th clamped mode lies below it and the next supported one beyond.

    Raises
    ------
    ArithmeticError
        If it does not.
    """
    k = to_ball(start)
    count = first_true(lambda n: bool(zero_of_j0(n, BITS // 2) > k), 64) - 1
    growth = (k.bessel_j(1) / k.bessel_j(0) + k.bessel_i(1) / k.bessel_i(0)) / k
    if not 0 < growth < 1:
        raise ArithmeticError(f"at k = {float(start)} clamped and supported modes do not part")
    return count


def series_terms(start: Fraction) -> int:
    """Terms of I1/I0 at infinity, so that neither it nor I0 is off by more than the tolerance."""
    limit = to_ball(TOLERANCE)

    def enough(terms: int) -> bool:
        if terms < 3:
            return False
        within = ratio_bound(terms, start), logarithm_bound(terms, start)
        return all(bool(bound <= limit) for bound in within)

    return first_true(enough, int(start))


def turn_steps(largest: Fraction) -> int:
    """Steps of Bessel's integral, an even number, for k up to the largest."""
    least = int(largest) // 2 + 2
    return 2 * (least + first_true(lambda n: sum_bound(2 * (least + n), largest) <= TOLERANCE))


def turns(steps: int) -> tuple[flint.arb, ...]:
    """1 - cos t over half a turn, the largest first."""
    halves = (flint.arb.sin_pi_fmpq(flint.fmpq(i, steps)) for i in reversed(range(steps // 2 + 1)))
    return tuple(2 * half**2 for half in halves)


def first_mode() -> tuple[
    tuple[sp.Rational, ...], tuple[sp.Rational, ...], tuple[sp.Rational, ...]
]:
    """Coefficients of A, B/u and E in u, as many as count up to the first zero of J0."""
    widest = 34  # above j_1^4

    def enough(terms: int) -> bool:
        whole, mixed = products(terms + 1)
        limit = sp.Rational(TOLERANCE)
        return all(abs(c[terms]) * widest**terms <= limit for c in (whole, mixed))

    count = first_true(enough, 32)
    whole, mixed = products(count + 1)
    rest = tuple(x - y for x, y in zip(mixed, whole, strict=True))
    rise = tuple(sp.Rational(1, 16**i * factorial(2 * i + 1) ** 2) for i in range(count))
    return whole[:count], rest[1:], rise


def _doubles(values: Iterable[flint.arb]) -> tuple[str, ...]:
    return wrapped(repr(nearest_double(value)) for value in values)


def _rationals(values: Iterable[sp.Rational]) -> tuple[str, ...]:
    return _doubles(to_ball(Fraction(int(c.p), int(c.q))) for c in values)


def held_context() -> dict[str, object]:
    """What the template of the generated held plates needs, numbers as text."""
    forms()
    start = asymptotic_start()
    with flint.ctx.workprec(BITS):
        series = ratio_series(series_terms(start))
        logarithm = tuple(-c / (m - 1) for m, c in enumerate(series) if m > 1)
        whole, rest, rise = first_mode()
        return {
            "near": str(modes_before(start)),
            "ratio": _rationals(series),
            "logarithm": _rationals(logarithm),
            "turns": _doubles(turns(turn_steps(start))),
            "whole": _rationals(whole),
            "rest": _rationals(rest),
            "rise": _rationals(rise),
            "pole": repr(nearest_double(zero_of_j0(1, BITS // 2) ** 4)),
        }
