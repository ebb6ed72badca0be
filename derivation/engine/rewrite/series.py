"""Truncated Taylor series near removable singularities, with proved error bounds."""

from dataclasses import dataclass
from itertools import islice

import sympy as sp

from derivation.engine.rewrite.terms import Terms, UnreachableError, taylor, truncation_bound

UNIT_ROUNDOFF = sp.Rational(1, 2**53)
MOST_TERMS = 72
"""Largest number of coefficients other than 0."""

POLYNOMIAL = sp.Function("polynomial")
"""The generated Horner scheme, from variable, constant term, and coefficients in rising order."""


@dataclass(frozen=True)
class Section:
    """A truncated power series y^lead (c_0 + c_1 y^stride + c_2 y^(2 stride) + ...).

    Parameters
    ----------
    lead
        Power of y that is factored out.
    stride
        2 for even and odd functions, 1 for others.
    coefficients
        Exact rationals c_0, c_1, ...
    bound
        Bound of the relative truncation error between y = 0 and the switch point.
    """

    lead: int
    stride: int
    coefficients: tuple[sp.Rational, ...]
    bound: sp.Rational

    def polynomial(self, power: sp.Expr) -> sp.Expr:
        """Return the polynomial in y^stride, as a call of the generated Horner scheme."""
        return POLYNOMIAL(power, *self.coefficients)


def leading_power(terms: Terms) -> int:
    """Return the lowest power of the Taylor series."""
    for power, value in enumerate(islice(taylor(terms), MOST_TERMS)):
        if sp.expand(value) != 0:
            return power
    raise UnreachableError("the sum vanishes at 0 with all its derivatives")


def truncated_taylor(terms: Terms, switch: sp.Rational, *, both_signs: bool = False) -> Section:
    """Return the truncated series of a sum about 0, with a relative error below 2^-55.

    The truncation error is bounded by Taylor's theorem term by term. The sum is at least its first
    coefficient, minus the magnitudes of all other terms unless they have the same sign. The bound
    holds between -switch and switch if `both_signs`.

    Raises
    ------
    UnreachableError
        If no such series reaches the switch point.
    """
    if any(value.free_symbols for value in terms.values()):
        raise UnreachableError("the series of a sum with further variables is not rational")
    lead = leading_power(terms)
    coefficients = list(islice(taylor(terms), lead, 2 * MOST_TERMS))
    stride = 1 if any(coefficients[1::2]) else 2
    coefficients = coefficients[::stride][:MOST_TERMS]
    sizes = [abs(c) * switch ** (stride * k) for k, c in enumerate(coefficients)]
    for degree in range(2, len(coefficients)):
        rest = truncation_bound(terms, lead + stride * degree, switch) / switch**lead
        same = all(c * coefficients[0] >= 0 for c in coefficients[:degree])
        same = same and (stride == 2 or not both_signs)
        lowest = sizes[0] - (0 if same else sp.Add(*sizes[1:degree])) - rest
        if lowest > 0 and rest / lowest < UNIT_ROUNDOFF / 4:
            return Section(lead, stride, tuple(coefficients[:degree]), rest / lowest)
    raise UnreachableError(f"no section of at most {len(coefficients)} terms reaches {switch}")
