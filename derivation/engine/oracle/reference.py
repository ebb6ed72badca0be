"""A reference value: what is true, how much the arguments' rounding moves it, and as text."""

from collections.abc import Mapping
from dataclasses import dataclass

import flint
from flint import arb

from derivation.engine.formula.ulp import Format, overflows

DIGITS = 45
"""Digits written of a reference; the radius is written beside it."""

_BITS = 512
"""Precision for the way from balls to text and back, far beyond `DIGITS`."""

_ENDLESS = {"nan": arb.nan(), "inf": arb.pos_inf(), "-inf": arb.neg_inf()}

Stored = dict[str, str]
"""A reference as text: "value" and "radius" of the ball, "rounding" for the sum of the
sensitivities |x df/dx|, "magnitude" and "scale". Of a value "nan", "inf" or "-inf" there is
nothing else to say."""


@dataclass(frozen=True)
class Reference:
    """A function's reference value at a point, and what its arguments' rounding does to it.

    Parameters
    ----------
    value
        Ball around the value. NaN outside the domain, infinite where no format holds it.
    sensitivity
        |x_i df/dx_i| by argument. For a summed formula these are added over the
        terms; an argument acts through those of a term too, which stand among the
        arguments, as a function reads them from a table.
    magnitude
        |value|, or for a summed formula the sum of its terms' magnitudes.
    scale
        What the budget is multiplied by.
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


def unsized(value: arb, scale: float = 1.0) -> Reference:
    """A reference value that rounding the arguments excuses nothing of."""
    return Reference(value, {}, abs(value), scale)


def bare(value: str) -> Stored:
    """The text of a value that there is nothing else to say of."""
    return {"value": value, "radius": "0", "rounding": "0", "magnitude": "0", "scale": "1"}


def stored(found: Reference, fmt: Format) -> Stored:
    """A reference as text; of a value that the format cannot hold the sign alone."""
    with flint.ctx.workprec(_BITS):
        value = found.value
        if overflows(value, fmt):
            return bare("inf" if value > 0 else "-inf")
        text = "0" if value == 0 else value.mid().str(DIGITS, radius=False)
        radius = (abs(value - arb(text))).abs_upper()
        return {
            "value": text,
            "radius": "0" if radius == 0 else _upwards(radius),
            "rounding": _upwards(found.total.abs_upper()),
            "magnitude": _upwards(found.magnitude.abs_upper()),
            "scale": repr(found.scale),
        }


def _upwards(number: arb) -> str:
    """Three digits that are not below a number."""
    if number == 0:
        return "0"
    raised = number * (1 + arb(10) ** -2)
    return str(raised.mid().str(3, radius=False))


def restored(text: Mapping[str, str]) -> Reference:
    """The reference that was written."""
    if text["value"] in _ENDLESS:
        return unsized(_ENDLESS[text["value"]])
    with flint.ctx.workprec(_BITS):
        value = arb(text["value"])
        ball = value if text["radius"] == "0" else value + arb(0, arb(text["radius"]))
        magnitude, rounding = arb(text["magnitude"]), arb(text["rounding"])
        return Reference(ball, {"all": rounding}, magnitude, float(text["scale"]))
