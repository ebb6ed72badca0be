"""The accuracy of a result: method, error bound, the parts of the bound and their bases."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from derivation.scene.quantity import rounded_up
from derivation.scene.scene import OUTPUTS

METHODS = {
    "hertz": "Hertz's law",
    "leading": "Hertz's law with the first correction for the plate",
    "coarse": "contact law with all included effects, half the quadrature nodes",
    "full": "contact law with all included effects",
}
"""The methods and their descriptions, from the fastest to the slowest."""
BASES = PROVED, ROUNDING_ANALYSIS, TESTED, ESTIMATED = (
    "proved", "rounding_analysis", "tested", "estimated",
)  # fmt: skip
"""The bases of a bound, the strongest first: a proof; an analysis of the rounding errors of all
operations; an error budget that the test suite enforces; an estimate without guarantee, such as
that of omitted modes and wave branches."""


NAMES = {
    "effects": "omitted effects",
    "law": "omitted terms or modes",
    "quadrature": "quadrature",
    "rounding": "rounding",
    "constant": "constant from the measured restitution",
}
"""The parts of a bound as they are printed."""


@dataclass(frozen=True)
class Part:
    """One part of an error bound.

    Attributes
    ----------
    bound
        Relative error [1].
    basis
        `proved`, `rounding_analysis`, `tested` or `estimated`.
    """

    bound: float
    basis: str


@dataclass(frozen=True)
class AchievedAccuracy:
    """The method by which an impact was computed, and its error bound.

    Attributes
    ----------
    method
        One of `METHODS`.
    rtol
        The requested tolerance [1]; None if there is none.
    law, quadrature, rounding
        Parts of the bound: omitted terms of the contact law or omitted modes and wave branches,
        truncation error of the integration in time, and rounding errors (including tables).
    effects
        Part of the bound: the effects omitted by the selection.
    outputs
        The results that the bound applies to.
    constant
        Part of the bound: the error of a constant that follows from a measured restitution.
    """

    method: str
    rtol: float | None
    law: Part
    quadrature: Part
    rounding: Part
    effects: Part = Part(0.0, PROVED)
    outputs: tuple[str, ...] = OUTPUTS
    constant: Part | None = None

    @property
    def parts(self) -> dict[str, Part]:
        """The parts of the bound by name."""
        names = ("effects", "law", "quadrature", "rounding")
        by_name = {name: getattr(self, name) for name in names}
        return by_name | ({} if self.constant is None else {"constant": self.constant})

    @property
    def bound(self) -> float:
        """Bound on the relative error of each output [1]."""
        # With NumPy's functions, so that the bound is that of a row, to the last bit.
        return float(np.expm1(sum(np.log1p(part.bound) for part in self.parts.values())))

    @property
    def remaining(self) -> float | None:
        """The part of the tolerance for the simulation, less the error of a constant [1]."""
        return self.rtol if self.constant is None else remaining(self.rtol, self.constant.bound)

    @property
    def pressure_bound(self) -> float:
        """Bound on the relative error of the largest pressure [1].

        In the law the pressure grows with the radius a. Omitted effects, such as the curvature of
        the plate under the contact, may change a at an equal force P, and the pressure as P/a^2.
        """
        return float(np.expm1(np.log1p(self.bound) + 2.0 * np.log1p(self.effects.bound)))

    def to_json(self) -> dict[str, Any]:
        """Return method, tolerance and bound, with the parts of the bound and their bases."""
        parts = {
            name: {
                "bound": part.bound if math.isfinite(part.bound) else None,
                "basis": part.basis,
            }
            for name, part in self.parts.items()
        }
        bound = self.bound if math.isfinite(self.bound) else None
        made = {"method": self.method, "rtol": self.rtol, "bound": bound, "parts": parts}
        return made | {"outputs": list(self.outputs)}

    @property
    def _outputs_in_words(self) -> str:
        """The outputs that the bound applies to; empty for all."""
        if self.outputs == OUTPUTS:
            return ""
        return " of " + ", ".join(name.replace("_", " ") for name in self.outputs)

    @property
    def basis(self) -> str:
        """The basis of the whole bound: the weakest basis of its parts."""
        return max((part.basis for part in self.parts.values() if part.bound), key=BASES.index)

    @property
    def largest_part(self) -> str:
        """The largest part of the bound, in words."""
        largest = max(self.parts, key=lambda name: self.parts[name].bound)
        return "the constant" if largest == "constant" else NAMES[largest]

    @property
    def summary(self) -> str:
        """The bound with its basis, in words."""
        if not math.isfinite(self.bound):
            return "no error bound is known"
        bound = f"{rounded_up(self.bound)} ({self.basis.replace('_', ' ')})"
        return f"relative error{self._outputs_in_words} at most {bound}"

    def __str__(self) -> str:
        """Return method and bound as sentences."""
        if not math.isfinite(self.bound):
            return f"Method: {self.method} ({METHODS[self.method]}). No error bound is known."
        parts = ", ".join(
            f"{NAMES[name]} {rounded_up(part.bound)} ({part.basis.replace('_', ' ')})"
            for name, part in self.parts.items()
            if part.bound
        )
        return (
            f"Method: {self.method} ({METHODS[self.method]}). Relative error bound"
            f"{self._outputs_in_words} {rounded_up(self.bound)}: {parts}."
        )


def remaining(rtol: float | None, error: float) -> float | None:
    """Return the part of a tolerance that an error leaves [1]; None without a tolerance."""
    return None if rtol is None else (rtol - error) / (1.0 + error)
