"""Comparison of both reference methods of the contact law: a value is used only if both agree."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import flint
from flint import arb

from derivation.engine.oracle.agreement import OracleError, to_ball
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle import forces as contact_forces
from derivation.plate.contact.route import residue_law
from derivation.plate.impact.oracle import impact as contact_impact

SPARE = 2
"""Additional digits of the Arb reference, beyond those to which both methods must agree."""


class Agreement(NamedTuple):
    """A reference value: the Arb balls, and the number of digits to which mpmath agrees.

    The number of digits includes the radii of the balls and is a lower bound.
    """

    values: tuple[arb, ...]
    digits: float


FIRST: Mapping[str, Callable[..., Any]] = {
    "indentation": contact_balls.indentation,
    "slope": contact_balls.slope,
    "stiffness": contact_balls.stiffness,
    "contact_radius": contact_balls.contact_radius,
    "force": contact_forces.force,
    "force_of_radius": contact_forces.force_of_radius,
    "radius_of_force": contact_forces.radius_of_force,
    "max_pressure": contact_forces.max_pressure,
    "impact": contact_impact.impact,
}
"""Arb reference, in ball arithmetic."""

SECOND: dict[str, Callable[..., Any]] = {name: getattr(residue_law, name) for name in FIRST}
"""mpmath reference, by residues."""


def agree(name: str, arguments: Sequence[float], digits: int = 40) -> Agreement:
    """Return the results of both methods for a quantity.

    Raises
    ------
    OracleError
        If the results differ by more than 10^-digits (relative).
    """
    balls = _several(FIRST[name](*arguments, digits=digits + SPARE))
    others = _several(SECOND[name](*arguments, digits=digits))
    agreed = math.inf
    with flint.ctx.workprec(400):
        for ball, other in zip(balls, others, strict=True):
            apart = (abs(ball - to_ball(other)) / abs(ball)).abs_upper()
            if not apart <= arb(10) ** -digits:
                raise OracleError(f"{name} at {tuple(arguments)}: {ball} against {other}")
            # Both results may be the same exact number.
            agreed = min(agreed, -math.log10(max(float(apart), 1e-99)))
    return Agreement(balls, agreed)


def _several(values: Any) -> tuple[Any, ...]:
    return tuple(values) if isinstance(values, tuple) else (values,)
