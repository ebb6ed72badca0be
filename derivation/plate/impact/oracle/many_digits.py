"""Contact law and conservative impact to many digits: Arb balls, compared with mpmath.

The law of the Arb reference is in `ball_law`; the mpmath reference is `contact.route.residue_law`.
Arguments are doubles, taken as exact numbers.
"""

import math
from collections.abc import Iterator, Sequence
from html import escape
from typing import Any, NamedTuple

import flint
from flint import arb
from mpmath import mpf

from derivation.engine.oracle.agreement import to_ball as exactly
from derivation.plate.contact.oracle.balls import ratio_of
from derivation.plate.contact.route import residue_law
from derivation.plate.impact.oracle import ball_law
from derivation.plate.impact.oracle import impact as contact_impact

Motion = tuple[float, float, float, float, float, float, float]
"""R [m], m [kg], v0 [m/s], h [m], b [m], lam [Pa], mu [Pa]."""

INPUTS = ("R", "m", "v0", "h", "b", "lam", "mu")

FRACTIONS = (0.25, 0.5, 1.0)
"""Fractions of the largest contact radius at which the law is given."""

UNITS = {
    "contact_time": "s",
    "max_indentation": "m",
    "max_force": "N",
    "max_contact_radius": "m",
    "indentation": "m",
    "stiffness": "N/m",
}

MOST = 1000
"""Largest number of digits that can be requested."""

_SPARE = 3
"""Additional digits of the computation; the stated radius is that of rounding to shown digits."""


class Quantity(NamedTuple):
    """A number from the Arb reference, and its agreement with mpmath.

    Attributes
    ----------
    name, unit
        Name of the quantity and its SI unit.
    ball
        Ball of the Arb reference, which contains the value.
    compared
        Number of digits computed by mpmath.
    agreed
        Number of digits on which both agree, including the ball's radius: a lower bound.
    """

    name: str
    unit: str
    ball: arb
    compared: int
    agreed: float

    @property
    def agrees(self) -> bool:
        """Whether mpmath agrees to the requested digits, except for the last one."""
        return self.agreed >= self.compared - 1

    def shown(self, digits: int) -> tuple[str, str]:
        """Return the decimal value of this many digits, and a bound of its error."""
        text = self.ball.str(digits, more=True).strip("[]")
        value, _, radius = text.partition(" +/- ")
        return value, radius or "0"


class StaticContact(NamedTuple):
    """The contact law at a contact radius [m], which is exactly this double."""

    contact_radius: float
    quantities: tuple[Quantity, ...]


class ImpactReference(NamedTuple):
    """The results of both reference methods for a scene.

    Attributes
    ----------
    motion
        The scene as numbers; doubles are exact.
    digits
        Number of requested digits, which determines the radii of the balls.
    impact
        Contact time, largest indentation, force and contact radius.
    law
        Indentation and stiffness at fractions of the largest contact radius.
    """

    motion: Motion
    digits: int
    impact: tuple[Quantity, ...]
    law: tuple[StaticContact, ...]

    @property
    def quantities(self) -> Iterator[Quantity]:
        """All quantities of the impact and of the law."""
        yield from self.impact
        for pressed in self.law:
            yield from pressed.quantities

    @property
    def agrees(self) -> bool:
        """Whether both methods agree on every compared number."""
        return all(quantity.agrees for quantity in self.quantities)

    def to_json(self) -> dict[str, Any]:
        """Return plain data: numbers as text, because they exceed the precision of doubles."""

        def plain(quantity: Quantity) -> dict[str, Any]:
            value, radius = quantity.shown(self.digits)
            return {
                "value": value,
                "radius": radius,
                "unit": quantity.unit,
                "compared_digits": quantity.compared,
                "agreed_digits": math.floor(min(quantity.agreed, self.digits)),
            }

        law = [
            {"contact_radius": pressed.contact_radius}
            | {quantity.name: plain(quantity) for quantity in pressed.quantities}
            for pressed in self.law
        ]
        impact = {quantity.name: plain(quantity) for quantity in self.impact}
        inputs = dict(zip(INPUTS, self.motion, strict=True))
        return {"digits": self.digits, "inputs": inputs, "impact": impact, "law": law}

    def __str__(self) -> str:
        """Return every value as text."""
        return "\n".join(self.lines())

    def _repr_html_(self) -> str:
        """Return every value for a notebook."""
        return f"<pre>{escape(str(self))}</pre>"

    def lines(self) -> list[str]:
        """Return every value with its radius and the digits to which mpmath agrees, as text."""

        def block(quantity: Quantity) -> list[str]:
            value, radius = quantity.shown(self.digits)
            agreed = math.floor(min(quantity.agreed, self.digits))
            return [
                f"{quantity.name.replace('_', ' ')} [{quantity.unit}]",
                f"  {value}",
                f"  +- {radius}; mpmath agrees to {agreed} of {quantity.compared} digits",
            ]

        rows = [line for quantity in self.impact for line in block(quantity)]
        for pressed in self.law:
            rows.append(f"at contact radius {pressed.contact_radius!r} m (exactly this double)")
            rows += [line for quantity in pressed.quantities for line in block(quantity)]
        return rows


def reference(motion: Motion, digits: int, progress: ball_law.Progress) -> ImpactReference:
    """Return law and impact with many digits, from both reference methods.

    Parameters
    ----------
    motion
        The scene as numbers; doubles are exact.
    digits
        The relative radius of each ball is below 10^-digits.
    progress
        Called with the current task and its progress.

    Raises
    ------
    ValueError
        If the contact reaches the plate's edge, or the number of digits is not between 1 and 1000.
    derivation.engine.formula.ball.PrecisionError
        If a ball does not become narrow enough.
    derivation.engine.oracle.agreement.RouteError
        If mpmath does not reach its digits.
    """
    if not 1 <= digits <= MOST:
        raise ValueError(f"expected 1 to {MOST} digits, got {digits}")
    R, _, _, h, b, lam, mu = motion
    progress("largest contact radius", 1, 1)
    law = ball_law.law_of(ratio_of(h, b), contact_impact.reach_of(motion), digits, progress)
    wanted = digits + _SPARE
    impact_balls = contact_impact.impact(*motion, wanted, law)
    radii = [float(impact_balls.max_contact_radius) * fraction for fraction in FRACTIONS]
    balls = [ball_law.static_contact(a, R, b, lam, mu, law, wanted) for a in radii]
    laws: list[StaticContact] = []
    for a, both in zip(radii, balls, strict=True):
        progress("mpmath: law", len(laws) + 1, len(radii))
        again = (
            residue_law.indentation(a, R, h, b, digits),
            residue_law.stiffness(a, R, h, b, lam, mu, digits),
        )
        laws.append(
            StaticContact(
                a, _compared_quantities(("indentation", "stiffness"), both, again, digits)
            )
        )
    progress("mpmath: impact", 1, 1)
    moved = _compared_quantities(
        impact_balls._fields, impact_balls, residue_law.impact(*motion, digits), digits
    )
    return ImpactReference(motion, digits, moved, tuple(laws))


def expected_seconds(motion: Motion, radius: float, digits: int) -> float:
    """Return the approximate run time of `reference` [s] on one idle core, for both methods.

    Parameters
    ----------
    motion
        The scene as numbers.
    radius
        Largest contact radius [m], for which a double is sufficient.
    digits
        Number of requested digits.
    """
    h, b = motion[3:5]
    first = ball_law.first_seconds(h / b, radius / b, digits)
    return 1 + first + residue_law.seconds(h / b, radius / b, digits)


def _compared_quantities(
    names: Sequence[str], balls: Sequence[arb], others: Sequence[mpf], compared: int
) -> tuple[Quantity, ...]:
    """Return the balls as quantities, each with its agreement with mpmath."""
    return tuple(
        Quantity(name, UNITS[name], ball, compared, agreed_digits(ball, other))
        for name, ball, other in zip(names, balls, others, strict=True)
    )


def agreed_digits(ball: arb, other: mpf) -> float:
    """Return a lower bound of the number of digits to which a number agrees with a ball."""
    value = exactly(other)
    with flint.ctx.workprec(64 + max(_bits(ball), _bits(value))):
        apart = (abs(ball - value) / abs(ball)).abs_upper()
        # The logarithm of a ball, because 10^-1000 is below the range of doubles.
        return math.inf if apart == 0 else -float((apart.log() / arb(10).log()).upper())


def _bits(ball: arb) -> int:
    return int(ball.bits())
