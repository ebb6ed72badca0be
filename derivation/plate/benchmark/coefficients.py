"""Coefficients of the contact law's power series in a/h to any number of digits, in balls.

delta = (a^2/R) (1 + A (c_1 + c_3 A^2 + ...)), A = a/h: the power series of the Arb reference; for
plates so thin that the residues at the roots of sinh T = +-T are negligible, the closed form. The
methods of the benchmark use them; truncation errors are not bounded.
"""

import math
from functools import cache

import flint
from flint import arb

from derivation.engine.formula.ball import LOG2_10
from derivation.plate.benchmark.interface import BenchmarkCase, largest_contact_radius
from derivation.plate.contact.oracle import points as contact_points
from derivation.plate.contact.oracle.balls import ratio_of
from derivation.plate.contact.oracle.moments import finite_part
from derivation.plate.contact.oracle.sums import FACTORS

ROOT_HEIGHT = 4.2
"""The first residue is of the order e^(-ROOT_HEIGHT b/h)."""

RADIUS = 4.0
"""Radius of convergence in a/h for a thin plate."""

LEAST = 0.5
"""Smallest a/h up to which coefficients are computed, even if all contacts are smaller."""

MOST_ZEROS = 20_000
"""Number of zeros of J0 above which their computation takes minutes."""

LAW_DIGITS, MOST_TERMS = 40, 200
"""Number of digits of the law that is used as exact, and number of its terms for a thin plate."""


def is_thin(h: float, b: float, digits: int) -> bool:
    """Return whether the closed form gives this many digits."""
    return ROOT_HEIGHT * b / h > (digits + 5) * math.log(10)


def coefficients(case: BenchmarkCase, count: int, digits: int) -> list[arb]:
    """Return c_1, c_3 ... to a number of digits; fewer if the others are negligible."""
    if is_thin(case.h, case.b, digits):
        return closed_form(case.h, case.b, count, digits)
    reach = max(
        case.high if case.high < RADIUS else 0.0,
        1.05 * largest_contact_radius(case) / case.h,
    )
    return arb_coefficients(case.h, case.b, min(max(reach, LEAST), 0.95 / case.eta), digits)[:count]


def exact_law(case: BenchmarkCase) -> list[arb]:
    """Return all coefficients up to a test case's largest contact, to LAW_DIGITS.

    Raises
    ------
    NotImplementedError
        If they would take minutes.
    """
    top = min(
        1.05 * largest_contact_radius(case) / case.h,
        RADIUS * contact_points.DEEPEST * (1 - 1e-9),
    )
    if is_thin(case.h, case.b, LAW_DIGITS):
        count = math.ceil(LAW_DIGITS / (2 * math.log10(RADIUS / top))) + 2 if top < RADIUS else 0
        if 0 < count < MOST_TERMS:
            return closed_form(case.h, case.b, count, LAW_DIGITS)
    return arb_coefficients(case.h, case.b, top, LAW_DIGITS)


@cache
def arb_coefficients(h: float, b: float, top: float, digits: int) -> list[arb]:
    """Return coefficients of the Arb reference up to a/h = top; for a > 4 h its terms cancel."""
    eta, bits = ratio_of(h, b), math.ceil((digits + 5) * LOG2_10)
    if contact_points.mode_count(float(eta), bits) > MOST_ZEROS:
        raise NotImplementedError("the law of so large contacts on so thin a plate takes minutes")
    known = contact_points.series(eta, top * float(eta) * (1 + 1e-9), bits)
    with flint.ctx.workprec(known.working + 64):
        ratio = arb(eta.numerator) / eta.denominator
        factor = FACTORS["hertz"] * ratio / arb.pi()
        return [
            factor * ratio ** (2 * k) * power
            for k, power in enumerate(known.powers["hertz"].coeffs())
        ]  # fmt: skip


@cache
def closed_form(h: float, b: float, count: int, digits: int) -> list[arb]:
    """Return the coefficients of the thin plate: a logarithm and finite parts M_k."""
    bits = math.ceil(digits * LOG2_10) + 64
    with flint.ctx.workprec(bits):
        eta, pi = arb(h) / arb(b), arb.pi()
        log = arb.const_euler() - (4 * eta).log()
        M = [finite_part(k, bits) for k in range(2, max(count, 2) + 2)]
        coefficients = [
            1 / (4 * pi * eta**2) + 2 / (3 * pi) * (M[0] + log * 6 / 5),
            -(M[1] + 6 * log) / (60 * pi),
        ]
        for k in range(4, count + 2):
            factor = (-1) ** k * 8 * (2 * k - 2) / (pi * math.factorial(2 * k - 1))
            coefficients.append(factor * M[k - 2] / arb(2) ** (2 * k - 2))
        return coefficients[:count]
