"""Reference values with the effect of the arguments' rounding, and their text."""

from collections.abc import Mapping
from dataclasses import dataclass

import flint
from flint import arb

from derivation.engine.formula.ulp import Format, overflows

DIGITS = 45
"""Number of digits written for a reference; the radius is written separately."""

_BITS = 512
"""Precision for conversion from balls to text and back, far beyond `DIGITS`."""

_ENDLESS = {"nan": arb.nan(), "inf": arb.pos_inf(), "-inf": arb.neg_inf()}

Stored = dict[str, str]
"""A reference as text: "value" and "radius" of the ball, "rounding" for the sum of the
sensitivities |x df/dx|, "magnitude" and "scale". A value "nan", "inf" or "-inf" has no other
entries."""


@dataclass(frozen=True)
class Reference:
    """A function's reference value at a point, and the effect of its arguments' rounding.

    Parameters
    ----------
    value
        Ball around the value; NaN outside the domain, infinite if it overflows.
    sensitivity
        |x_i df/dx_i| by argument, including the effect through quantities that a function reads
        from a table. For a summed formula the sensitivities of all terms are added.
    magnitude
        |value|, or for a summed formula the sum of its terms' magnitudes.
    scale
        Factor of the budget.
    """

    value: arb
    sensitivity: Mapping[str, arb]
    magnitude: arb
    scale: float = 1.0

    @property
    def total(self) -> arb:
        """Sum of the sensitivities."""
        return sum(self.sensitivity.values(), arb(0))

    @property
    def condition(self) -> dict[str, float]:
        """Condition number by argument; infinite (or NaN for 0/0) where the value is zero."""
        if self.value == 0:
            return {n: float("inf") if s > 0 else float("nan") for n, s in self.sensitivity.items()}
        return {n: float((s / abs(self.value)).mid()) for n, s in self.sensitivity.items()}


def exact_reference(value: arb, scale: float = 1.0) -> Reference:
    """Return a reference value without allowance for rounding of the arguments."""
    return Reference(value, {}, abs(value), scale)


def value_only(value: str) -> Stored:
    """Return the text of a value without other entries."""
    return {"value": value, "radius": "0", "rounding": "0", "magnitude": "0", "scale": "1"}


def reference_text(reference: Reference, fmt: Format) -> Stored:
    """Return a reference as text; a value that overflows the format becomes "inf" or "-inf"."""
    with flint.ctx.workprec(_BITS):
        value = reference.value
        if overflows(value, fmt):
            return value_only("inf" if value > 0 else "-inf")
        text = "0" if value == 0 else value.mid().str(DIGITS, radius=False)
        radius = (abs(value - arb(text))).abs_upper()
        return {
            "value": text,
            "radius": "0" if radius == 0 else _rounded_up(radius),
            "rounding": _rounded_up(reference.total.abs_upper()),
            "magnitude": _rounded_up(reference.magnitude.abs_upper()),
            "scale": repr(reference.scale),
        }


def _rounded_up(number: arb) -> str:
    """Return a positive number as text with three digits, not below the number."""
    if number == 0:
        return "0"
    raised = number * (1 + arb(10) ** -2)
    return str(raised.mid().str(3, radius=False))


def reference_from_text(text: Mapping[str, str]) -> Reference:
    """Return the reference that `stored` has converted to text."""
    if text["value"] in _ENDLESS:
        return exact_reference(_ENDLESS[text["value"]])
    with flint.ctx.workprec(_BITS):
        value = arb(text["value"])
        ball = value if text["radius"] == "0" else value + arb(0, arb(text["radius"]))
        magnitude, rounding = arb(text["magnitude"]), arb(text["rounding"])
        return Reference(ball, {"all": rounding}, magnitude, float(text["scale"]))
