"""Taylor sections near removable singularities: exact coefficients, degree from a bound."""

from dataclasses import dataclass
from itertools import pairwise

import sympy as sp

UNIT_ROUNDOFF = sp.Rational(1, 2**53)


@dataclass(frozen=True)
class Section:
    """A truncated power series y^lead (c_0 + c_1 y^2 + c_2 y^4 + ...).

    Parameters
    ----------
    lead
        Power of y taken out.
    coefficients
        Exact rationals c_0, c_1, ...
    bound
        Bound on the relative truncation error for |y| <= seam.
    """

    lead: int
    coefficients: tuple[sp.Rational, ...]
    bound: sp.Rational

    def polynomial(self, square: sp.Expr) -> sp.Expr:
        """The polynomial in y^2, as a call of the generated Horner scheme."""
        return sp.Function("polynomial")(square, *self.coefficients)


def taylor_section(function: sp.Expr, y: sp.Symbol, seam: sp.Rational) -> Section:
    """Taylor section of an even or odd function about 0, relative error below half a ULP/4.

    The functions here are entire with coefficients that alternate or keep
    their sign and fall faster than those of a geometric series of ratio q
    once c_(k+1) seam^2 / c_k < q; the tail is then below the first term left
    out times 1/(1 - q), and the whole above c_0 (1 - |c_1| seam^2/c_0).

    Raises
    ------
    ValueError
        If the function has no such series, or the seam is too wide for it.
    """
    terms = _coefficients(function, y, 48)
    lead = min(terms)
    if any((power - lead) % 2 for power in terms):
        raise ValueError(f"{function} is neither even nor odd in {y}")
    found = [terms.get(power, sp.Integer(0)) for power in range(lead, 48, 2)]
    scaled = [abs(c) * seam ** (2 * k) for k, c in enumerate(found)]
    ratios = [later / earlier for earlier, later in pairwise(scaled)]
    if any(later > earlier for earlier, later in pairwise(ratios)):
        raise ValueError(f"the coefficient ratios of {function} do not fall")
    lowest = scaled[0] if all(c * found[0] > 0 for c in found) else scaled[0] - scaled[1]
    if lowest <= 0:
        raise ValueError(f"the seam {seam} is too wide for the series of {function}")
    for degree in range(1, len(ratios)):
        if ratios[degree] < 1:
            bound = scaled[degree] / (1 - ratios[degree]) / lowest
            if bound < UNIT_ROUNDOFF / 4:
                return Section(lead, tuple(found[:degree]), bound)
    raise ValueError(f"no degree below 48 suffices for {function} up to {seam}")


def _coefficients(function: sp.Expr, y: sp.Symbol, order: int) -> dict[int, sp.Rational]:
    """Nonzero Taylor coefficients by power, below the given order."""
    polynomial = sp.Poly(sp.series(function, y, 0, order).removeO(), y)
    return {int(power): coefficient for (power,), coefficient in polynomial.terms()}
