"""Contact law and conservative impact to many digits: oracle 1's balls, repeated by oracle 2.

Oracle 1 takes the law as a power series (`contact.oracle.points`), or in integrals
(`contact.oracle.sums`) where a contact is too deep or a plate too thin for that. Oracle 2 is
`residue_law`, or `contact.route.sums` where a contact is so deep that the former's powers would
take too long. Either is evaluated once: what it is compared with is certified. Arguments are
doubles, taken exactly.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import flint
from flint import arb
from mpmath import mpf

from derivation.engine.formula.ball import to_ball
from derivation.engine.oracle.agreement import to_ball as exactly
from derivation.plate.contact.oracle import points as contact_points
from derivation.plate.contact.oracle.balls import modulus, ratio_of, settle
from derivation.plate.contact.route import residue_law
from derivation.plate.contact.route import sums as contact_routes
from derivation.plate.impact.oracle import impact as contact_impact
from derivation.plate.impact.oracle.impact import BallLaw, Integrals
from derivation.plate.impact.oracle.many_costs import (
    INPUTS,
    Motion,
    by_residues,
    by_series,
    second_digits,
)

Tell = Callable[[str, int, int], None]
"""Wants to be told what is being done, which part of it, and of how many."""

SHARES = (0.25, 0.5, 1.0)
"""At which parts of the largest contact radius the law is given."""

UNITS = {
    "contact_time": "s",
    "max_indentation": "m",
    "max_force": "N",
    "max_contact_radius": "m",
    "indentation": "m",
    "stiffness": "N/m",
}

MOST = 1000
"""Digits that can be asked for."""

_SPARE = 3
"""Digits computed beyond those shown, so that rounding to the latter is what the radius is."""

_MARGIN = 1 + 2.0**-30
"""The law is made for contacts larger than the largest by this factor."""


class Quantity(NamedTuple):
    """A number by oracle 1, and how far oracle 2 repeats it.

    Attributes
    ----------
    name, unit
        What it is, in SI.
    ball
        Oracle 1's ball: it contains the value.
    compared
        To how many digits oracle 2 was asked.
    shared
        On how many digits both agree, the ball's own width counted: a lower bound.
    """

    name: str
    unit: str
    ball: arb
    compared: int
    shared: float

    @property
    def agrees(self) -> bool:
        """Whether oracle 2 repeats the digits that it was asked for, but for the last one."""
        return self.shared >= self.compared - 1

    def shown(self, digits: int) -> tuple[str, str]:
        """Decimal value of so many digits, and a bound of what it differs from the truth by."""
        text = self.ball.str(digits, more=True).strip("[]")
        value, _, radius = text.partition(" +/- ")
        return value, radius or "0"


class Pressed(NamedTuple):
    """The contact law at a contact radius [m], which is exactly this double."""

    contact_radius: float
    quantities: tuple[Quantity, ...]


class ImpactReference(NamedTuple):
    """What both oracles say of a scene.

    Attributes
    ----------
    motion
        The scene in numbers, doubles taken exactly.
    digits
        Digits asked for, to which oracle 1's balls are narrow.
    impact
        Contact time, largest indentation, force and contact radius.
    law
        Indentation and stiffness at parts of the largest contact radius.
    """

    motion: Motion
    digits: int
    impact: tuple[Quantity, ...]
    law: tuple[Pressed, ...]

    @property
    def quantities(self) -> Iterator[Quantity]:
        """All of them."""
        yield from self.impact
        for pressed in self.law:
            yield from pressed.quantities

    @property
    def agrees(self) -> bool:
        """Whether both oracles agree wherever both were asked."""
        return all(quantity.agrees for quantity in self.quantities)

    def to_json(self) -> dict[str, Any]:
        """Plain data: numbers as text, since no double holds them."""

        def plain(quantity: Quantity) -> dict[str, Any]:
            value, radius = quantity.shown(self.digits)
            return {
                "value": value,
                "radius": radius,
                "unit": quantity.unit,
                "compared_digits": quantity.compared,
                "agreed_digits": math.floor(min(quantity.shared, self.digits)),
            }

        law = [
            {"contact_radius": pressed.contact_radius}
            | {quantity.name: plain(quantity) for quantity in pressed.quantities}
            for pressed in self.law
        ]
        impact = {quantity.name: plain(quantity) for quantity in self.impact}
        inputs = dict(zip(INPUTS, self.motion, strict=True))
        return {"digits": self.digits, "inputs": inputs, "impact": impact, "law": law}

    def lines(self) -> list[str]:
        """Every number with its radius and with what oracle 2 says, to be read by people."""

        def block(quantity: Quantity) -> list[str]:
            value, radius = quantity.shown(self.digits)
            agreed = math.floor(min(quantity.shared, self.digits))
            return [
                f"{quantity.name.replace('_', ' ')} [{quantity.unit}]",
                f"  {value}",
                f"  +- {radius}, oracle 2, asked for {quantity.compared} digits, repeats {agreed}",
            ]

        found = [line for quantity in self.impact for line in block(quantity)]
        for pressed in self.law:
            found.append(f"at contact radius {pressed.contact_radius!r} m, this double exactly")
            found += [line for quantity in pressed.quantities for line in block(quantity)]
        return found


def reference(motion: Motion, digits: int, tell: Tell) -> ImpactReference:
    """Law and impact by both oracles.

    Parameters
    ----------
    motion
        The scene in numbers, doubles taken exactly.
    digits
        Relative radius of all balls is below 10^-digits.
    tell
        Told what is being done.

    Raises
    ------
    ValueError
        If the contact reaches the plate's edge, or the digits are not 1 to 1000.
    derivation.engine.formula.ball.PrecisionError
        If a ball does not become narrow enough.
    derivation.engine.oracle.agreement.RouteError
        If oracle 2 does not answer for its digits.
    """
    if not 1 <= digits <= MOST:
        raise ValueError(f"expected 1 to {MOST} digits, got {digits}")
    R, _, _, h, b, lam, mu = motion
    tell("largest contact radius", 1, 1)
    reach = _reach(motion)
    law, wanted = law_of(ratio_of(h, b), reach, digits, tell), digits + _SPARE
    found = contact_impact.impact(*motion, wanted, law)
    radii = [float(found.max_contact_radius) * share for share in SHARES]
    balls = [pressed(a, R, b, lam, mu, law, wanted) for a in radii]
    second = _second(motion, reach, digits)
    laws: list[Pressed] = []
    for a, both in zip(radii, balls, strict=True):
        tell("oracle 2: law", len(laws) + 1, len(radii))
        again = _beside(("indentation", "stiffness"), both, second.law(a), second.digits)
        laws.append(Pressed(a, again))
    tell("oracle 2: impact", 1, 1)
    moved = _beside(found._fields, found, second.impact(), second.digits)
    return ImpactReference(motion, digits, moved, tuple(laws))


class _Second(NamedTuple):
    """Oracle 2 to so many digits: indentation and stiffness at a contact radius, the impact."""

    digits: int
    law: Callable[[float], Sequence[mpf]]
    impact: Callable[[], Sequence[mpf]]


def _second(motion: Motion, reach: float, digits: int) -> _Second:
    R, m, v0, h, b, lam, mu = motion
    asked = second_digits(h / b, reach, digits)
    if by_residues(h / b, reach, digits):
        of = residue_law.law(h, b, reach, asked)
        return _Second(
            asked,
            lambda a: (
                residue_law.indentation(a, R, of, asked),
                residue_law.stiffness(a, R, lam, mu, of, asked),
            ),
            lambda: residue_law.impact(R, m, v0, lam, mu, of, asked),
        )
    how = contact_routes.setting(asked)
    return _Second(
        asked,
        lambda a: (
            contact_routes.indentation(a, R, h, b, asked, how),
            contact_routes.stiffness(a, R, h, b, lam, mu, asked, how),
        ),
        lambda: contact_routes.impact(*motion, asked, how),
    )


def law_for(motion: Sequence[Any], digits: int) -> Callable[[int], BallLaw]:
    """Oracle 1's law at so many bits, up to the largest contact of an impact of exact numbers."""
    return law_of(ratio_of(motion[3], motion[4]), _reach(motion), digits, lambda *_: None)


def _reach(motion: Sequence[Any]) -> float:
    """Somewhat above the largest a/b of an impact, and below 1."""
    R, m, v0, h, b, lam, mu = motion
    with flint.ctx.workprec(64):
        law = Integrals(ratio_of(h, b))
        largest = contact_impact.largest_ratio(R, m, v0, h, b, lam, mu, law)
    return min(float(largest.upper()) * _MARGIN, math.nextafter(1.0, 0.0))


def law_of(eta: Fraction, reach: float, digits: int, tell: Tell) -> Callable[[int], BallLaw]:
    """Oracle 1's law at so many bits: a power series where that is possible and quicker.

    Parameters
    ----------
    eta
        h/b [1].
    reach
        Largest a/b [1] asked for.
    digits
        Digits, which decide what is quicker.
    tell
        Told of every zero of J0.
    """
    if not by_series(float(eta), reach, digits):
        tell("oracle 1: integrals", 1, 1)
        return lambda _: Integrals(eta)

    def law(bits: int) -> BallLaw:
        contact_points.prepare(eta, reach, bits, lambda k, n: tell("oracle 1: zeros of J0", k, n))
        tell("oracle 1: power series", 1, 1)
        return contact_points.series(eta, reach, bits)

    return law


def pressed(
    a: float, R: float, b: float, lam: float, mu: float, law: Callable[[int], BallLaw], digits: int
) -> tuple[arb, ...]:
    """Indentation [m] and stiffness [N/m] at a contact radius [m]."""
    alpha = ratio_of(a, b)

    def compute(bits: int) -> tuple[arb, arb]:
        known, x = law(bits), to_ball(alpha)
        delta = to_ball(a) ** 2 / to_ball(R) * (1 + known.excess("hertz", x))
        return delta, 2 * modulus(lam, mu) * to_ball(a) / (1 + known.excess("sinc", x))

    return settle(compute, digits, f"the law at {a}")


def _beside(
    names: Sequence[str], balls: Sequence[arb], others: Sequence[mpf], compared: int
) -> tuple[Quantity, ...]:
    return tuple(
        Quantity(name, UNITS[name], ball, compared, shared(ball, other))
        for name, ball, other in zip(names, balls, others, strict=True)
    )


def shared(ball: arb, other: mpf) -> float:
    """On how many digits a number agrees with a ball, at least."""
    value = exactly(other)
    with flint.ctx.workprec(64 + max(_bits(ball), _bits(value))):
        apart = (abs(ball - value) / abs(ball)).abs_upper()
        # The logarithm of a ball: no double holds 10^-1000.
        return math.inf if apart == 0 else -float((apart.log() / arb(10).log()).upper())


def _bits(ball: arb) -> int:
    return int(ball.bits())
