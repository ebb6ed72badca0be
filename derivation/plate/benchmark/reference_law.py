"""The law that stands for the exact one where a truncated method is repeated without rounding.

For small contacts the power series in a/h, for large ones the oracle's, moved to the middle of
the contacts that a regime's impacts make.
"""

from collections.abc import Callable

import flint
from flint import arb, arb_poly

from derivation.engine.formula.ball import to_ball
from derivation.plate.benchmark.arithmetic import Arithmetic, Array
from derivation.plate.benchmark.by_series import LONG_NUMBERS, BenchmarkLaw, SeriesLaw, duration
from derivation.plate.benchmark.interface import Call, Regime, deepest
from derivation.plate.contact.oracle import points as contact_points
from derivation.plate.contact.oracle.balls import ratio_of
from derivation.plate.contact.oracle.sums import SHARES

TERMS = 28
"""Of the power series: at a/h = 0.5 they leave out 1e-50."""

DEPTH = 0.6
"""a/h up to which they stand for the law."""

BITS = 200
"""Of the law of large contacts: 60 digits."""

MOST_ZEROS = 20_000
"""Of J0, from which on finding them takes minutes."""


class DeepLaw(BenchmarkLaw):
    """The law up to a regime's largest contact by polynomials in t, A^2 = half (1 + t).

    Parameters
    ----------
    regime
        Plate, sphere and speed.
    ar
        Arithmetic, in whose context it is made.

    Raises
    ------
    NotImplementedError
        If contacts are larger, or the plate is thinner, than the oracle's series serves.
    """

    def __init__(self, regime: Regime, ar: Arithmetic) -> None:
        super().__init__(regime, ar)
        top = 1.05 * deepest(regime) / regime.h
        known = _oracles(regime, top)
        with flint.ctx.workprec(known.working + 64):
            half, eta = arb(top) ** 2 / 2, to_ball(ratio_of(regime.h, regime.b))
            squares = eta * eta * arb_poly([half, half])
            c, s, e = (
                SHARES[name] * eta / arb.pi() * known.powers[name](squares)
                for name in ("hertz", "sinc", "work")
            )
        self.c, self.s, self.e = (_as_numbers(ar, polynomial) for polynomial in (c, s, e))
        with flint.ctx.workprec(BITS):
            self.half = ar.array(half)

    def variable(self, A: Array) -> Array:
        """t."""
        return A * A / self.half - 1

    def quotient(self, A: Array, q: Array) -> Array:
        """As it stands: numbers are long enough for what cancels where q is near 1."""
        return (1 - q**5 * (self.work(A * q) / self.work(A))) / (1 - q)


def _oracles(regime: Regime, top: float) -> contact_points.PointSeries:
    """Oracle 1's power series of a plate up to a/h = top."""
    reach = top * regime.eta * (1 + 1e-9)
    if contact_points.mode_count(regime.eta, BITS) > MOST_ZEROS:
        raise NotImplementedError("the law of so large contacts on so thin a plate takes minutes")
    if not (reach < 1 and top < 4 * contact_points.DEEPEST):
        raise NotImplementedError("the law's series does not reach contacts so large")
    return contact_points.series(ratio_of(regime.h, regime.b), reach, BITS)


def _as_numbers(ar: Arithmetic, polynomial: arb_poly) -> list[Array]:
    """Coefficients up to those too small to count for |t| <= 1."""
    with flint.ctx.workprec(BITS):
        terms = polynomial.coeffs()
        least = max(abs(term) for term in terms) * arb(10) ** (-ar.digits - 4)
        last = max(k for k, term in enumerate(terms) if abs(term) > least)
        return list(ar.array(terms[: last + 1]))


def sure_law(regime: Regime, ar: Arithmetic = LONG_NUMBERS) -> BenchmarkLaw:
    """The law without rounding, or next to none, to be used in the context of an arithmetic.

    Raises
    ------
    NotImplementedError
        If neither series serves the regime's impacts.
    """
    with ar.context():
        if deepest(regime) <= DEPTH * regime.h:
            return SeriesLaw(regime, TERMS, ar)
        return DeepLaw(regime, ar)


def sure_duration(nodes: int) -> Callable[[Regime], Call]:
    """Gauss-Legendre on that law."""
    return duration(nodes, sure_law, LONG_NUMBERS)
