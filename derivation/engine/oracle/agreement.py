"""mpmath references by independent methods, and their comparison with the Arb references."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import flint
import sympy as sp
from mpmath import mp, mpf

from derivation.engine.failed import FailedError
from derivation.engine.formula.ball import LOG2_10
from derivation.engine.oracle.oracle import Balls

Values = Mapping[str, mpf]
Route = Callable[[Values], mpf]

FLOOR_DIGITS = 400
"""Two results below 10^-400 count as zero; the smallest double is larger by 76 digits."""

MAX_DIGITS = 4000


class RouteError(ArithmeticError):
    """A method did not give a reliable value."""


class OracleError(FailedError):
    """The two references contradict each other; neither is used."""


def _none_lost(_: Mapping[str, float]) -> int:
    return 0


@dataclass(frozen=True, eq=False)
class Routes:
    """A paper's mpmath references, and the references they are compared with.

    Parameters
    ----------
    balls
        The Arb references.
    routes
        For each formula, the method for its value or for one term of it. A formula without a method
        is evaluated as derived; it shares only the expression with the Arb reference.
    term
        Function from j and the arguments to the quantities that depend on the j-th term of a summed
        formula.
    lost
        Function that estimates the digits that a method loses at a point; it reduces the number of
        attempts.
    """

    balls: Balls
    routes: Mapping[str, Route]
    term: Callable[[int, Values], dict[str, mpf]] | None = None
    lost: Callable[[Mapping[str, float]], int] = _none_lost

    def evaluate(self, name: str, values: Mapping[str, float], modes: int | None) -> mpf:
        """Return a formula's value by its method, at the current precision of mpmath."""
        exact = {key: mpf(value) for key, value in values.items()}
        route = self.routes[name] if name in self.routes else self._as_stated(name)
        if modes is None or self.term is None:
            return route(exact)
        return mp.fsum(route(exact | self.term(j, exact)) for j in range(1, modes + 1))

    @cached_property
    def _stated(self) -> dict[str, Route]:
        return {}

    def _as_stated(self, name: str) -> Route:
        """Return a method that evaluates the formula's expression in mpmath."""
        if name not in self._stated:
            try:
                _, expression = self.balls.stated(name)
            except KeyError:
                known = ", ".join(self.routes)
                raise KeyError(f"no route to {name!r}; expected one of {known}") from None
            symbols = sorted(expression.free_symbols, key=str)
            function = sp.lambdify(symbols, expression, modules="mpmath")
            self._stated[name] = lambda values: mpf(
                function(*(values[str(symbol)] for symbol in symbols))
            )
        return self._stated[name]

    def value(
        self, name: str, values: Mapping[str, float], digits: int = 50, modes: int | None = None
    ) -> mpf:
        """Return a formula's value by its method, with the requested number of correct digits.

        The precision is increased by a quarter until two successive results agree; two results
        below 10^-400 count as zero.

        Raises
        ------
        KeyError
            If there is neither a method nor a formula of this name.
        RouteError
            If no precision up to 4000 digits gives two equal results, or the quadrature does not
            converge.
        """
        if name not in self.routes:
            self._as_stated(name)
        # A multiple of 40, so that cached integrals can be used at many points.
        working = 40 * math.ceil((digits + 30 + self.lost(values)) / 40)
        with mp.workdps(working):
            coarse = self.evaluate(name, values, modes)
        while working <= MAX_DIGITS:
            working = 40 * math.ceil(working * 1.25 / 40)
            with mp.workdps(working):
                fine = self.evaluate(name, values, modes)
                if _agree(coarse, fine, digits):
                    return mpf(0) if abs(fine) < mpf(10) ** -FLOOR_DIGITS else fine
            coarse = fine
        raise RouteError(f"{name} at {dict(values)}: no two results agree to {digits} digits")

    def agree(
        self, name: str, values: Mapping[str, float], digits: int = 50, modes: int | None = None
    ) -> flint.arb:
        """Compare both references at a point; return the Arb reference.

        Raises
        ------
        OracleError
            If they differ by more than 10^-digits of the value.
        """
        ball = self.balls.value(name, values, digits + 2, modes)
        other = to_ball(self.value(name, values, digits + 2, modes))
        with flint.ctx.workprec(int(LOG2_10 * digits) + 64):
            if bool(abs(ball - other) <= abs(ball) * flint.arb(10) ** -digits):
                return ball
        point = ", ".join(f"{symbol} = {value!r}" for symbol, value in values.items())
        terms = f" ({modes} terms)" if modes else ""
        raise OracleError(
            f"the references of {name} contradict each other at {point}{terms}: {ball.str(20)} by "
            f"the derived formula against {other.str(20)} by the second method; correct one of them"
        )


def _agree(one: mpf, other: mpf, digits: int) -> bool:
    floor = mpf(10) ** -FLOOR_DIGITS
    if not (mp.isfinite(one) and mp.isfinite(other)):
        return False
    if abs(one) < floor and abs(other) < floor:
        return True
    return bool(abs(one - other) <= mpf(10) ** -(digits + 5) * abs(other))


def to_ball(number: mpf) -> flint.arb:
    """Return an mpmath number as an exact Arb ball of radius zero."""
    sign, mantissa, exponent, _ = number._mpf_
    with flint.ctx.workprec(max(53, int(mantissa).bit_length())):
        return flint.arb(int(-mantissa if sign else mantissa)) * flint.arb(2) ** int(exponent)
