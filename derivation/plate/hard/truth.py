"""References of the hard cases: balls from the original expressions, as text and back."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import flint
from flint import arb

from derivation.engine.formula.ball import to_ball
from derivation.engine.formula.ulp import overflows, upper_float
from derivation.engine.measure.kernels import Kernel
from derivation.engine.oracle.oracle import Reference
from derivation.plate.cases.laws import LAWS
from derivation.plate.contact.cases.truth import tolerance
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.hard.case import HardCase
from derivation.plate.hard.law import HardLaw
from derivation.plate.impact.oracle import quantities as contact_quantities
from derivation.plate.oracle import reference

DIGITS = 45
"""Digits written of a reference; the radius is written beside it."""

_SLOPE_DIGITS, _SLOPE_STEP = 15, Fraction(1, 2**20)
"""Sensitivities only set allowances: a difference quotient to a few digits will do."""

_BITS = 512
"""Precision for the way from balls to text and back, far beyond `DIGITS`."""

Stored = dict[str, str]
"""A reference as text: "value" and "radius" of the ball, "rounding" for the sum of the
sensitivities |x df/dx|, "magnitude" as of `Reference`, and "scale", by which the budget is
multiplied. Of a value "nan", "inf" or "-inf" there is nothing else to say."""


class Known(NamedTuple):
    """The references of a case, and the hash of what they follow from, see `origin`."""

    origin: str
    references: Sequence[Stored]


def known_of(data: Mapping[str, Any]) -> dict[str, Known]:
    """What is recorded, by key."""
    return {row["key"]: Known(row["origin"], row["references"]) for row in data["cases"]}


def references(case: HardCase, kernel: Kernel) -> list[Stored]:
    """The truth of a case: for every result, and of each for every point."""
    if case.expect != "value":
        values = {"nan": "nan", "zero": "0"}
        return [_bare(values[case.expect])] * (outputs(kernel.name) * len(case.points))
    law = LAWS.get(kernel.name)
    rows = [
        [_closed(case, kernel, point)] if law is None else _of_law(case, kernel, law, point)
        for point in case.points
    ]
    return [row[output] for output in range(outputs(kernel.name)) for row in rows]


def outputs(name: str) -> int:
    """How many results a kernel has."""
    return LAWS[name].results if name in LAWS else 1


def _closed(case: HardCase, kernel: Kernel, point: Mapping[str, float]) -> Stored:
    given = {name: point[name] for name in kernel.arguments}
    if any(number != number or abs(number) == float("inf") for number in given.values()):
        return _bare("nan")
    found = reference(kernel.name, given, DIGITS + 2, case.modes)
    return _stored(case, found.value, found.total, found.magnitude, 1.0)


def _of_law(
    case: HardCase, kernel: Kernel, law: HardLaw, point: Mapping[str, float]
) -> list[Stored]:
    given = [point[name] for name in kernel.arguments]
    values = law.values(given, DIGITS + 2)
    slopes: Sequence[arb] = [arb(0)] * len(values)
    if law.conditioned:
        slopes = law.slopes(given, values) if law.slopes else _sensitivities(kernel, law, given)
    sizes = law.sizes(given, values) if law.sizes else [abs(value) for value in values]
    scale = _scale(kernel.name, given, values[0])
    return [
        _stored(case, value, slope, size, scale)
        for value, slope, size in zip(values, slopes, sizes, strict=True)
    ]


def _sensitivities(kernel: Kernel, law: HardLaw, given: Sequence[float]) -> list[arb]:
    """Of every result, the sum of |x df/dx| over the arguments."""
    here = law.values(given, _SLOPE_DIGITS)
    totals = [arb(0)] * len(here)
    for place, name in enumerate(kernel.arguments):
        # Plates grow and contacts shrink, so that none comes to lie beyond the edge.
        step = _SLOPE_STEP if name in ("b", "h", "R", "lam", "mu") else -_SLOPE_STEP
        moved: list[Any] = list(given)
        moved[place] = Fraction(given[place]) * (1 + step)
        there = law.values(moved, _SLOPE_DIGITS)
        with flint.ctx.workprec(_BITS):
            totals = [
                total + abs(new - old) / to_ball(_SLOPE_STEP)
                for total, new, old in zip(totals, there, here, strict=True)
            ]
    return totals


def _scale(name: str, given: Sequence[Any], value: arb) -> float:
    """What multiplies the budget, see `contact.cases.truth.tolerance`."""
    if name in ("indentation", "contact_radius", "stiffness"):
        return tolerance(name, tuple(given), float(value))
    if name == "force":
        delta, R, h, b = given[:4]
        radius = float(contact_balls.contact_radius(delta, R, h, b, _SLOPE_DIGITS))
        return tolerance("contact_radius", (delta, R, h, b), radius)
    if name == "force_by_series":
        return upper_float(contact_quantities.truncated_series(*given)[1])
    return 1.0


def _bare(value: str) -> Stored:
    return {"value": value, "radius": "0", "rounding": "0", "magnitude": "0", "scale": "1"}


def _stored(case: HardCase, value: arb, slope: arb, magnitude: arb, scale: float) -> Stored:
    with flint.ctx.workprec(_BITS):
        if overflows(value, case.format):
            return _bare("inf" if value > 0 else "-inf")
        text = "0" if value == 0 else value.mid().str(DIGITS, radius=False)
        radius = (abs(value - arb(text))).abs_upper()
        return {
            "value": text,
            "radius": "0" if radius == 0 else _upwards(radius),
            "rounding": _upwards(slope.abs_upper()),
            "magnitude": _upwards(magnitude.abs_upper()),
            "scale": repr(scale),
        }


def _upwards(number: arb) -> str:
    """Three digits that are not below a number."""
    if number == 0:
        return "0"
    raised = number * (1 + arb(10) ** -2)
    return str(raised.mid().str(3, radius=False))


def restored(stored: Mapping[str, str]) -> Reference:
    """The reference that was written."""
    with flint.ctx.workprec(_BITS):
        value = arb(stored["value"])
        ball = value if stored["radius"] == "0" else value + arb(0, arb(stored["radius"]))
        magnitude, rounding = arb(stored["magnitude"]), arb(stored["rounding"])
        return Reference(ball, {"all": rounding}, magnitude)
