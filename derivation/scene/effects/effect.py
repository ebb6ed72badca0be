"""What an effect answers: whether it applies, its number, its bound, its share of the law.

Shares and bounds are parts of F and S: at equal force P, a being Hertz's radius with the modulus
E* of the law, a^3 = 3 P R/(4 E*),

    delta = (a^2/R) (1 + F),   d delta/da = (2a/R) S.
"""

from dataclasses import dataclass, replace
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from derivation.scene import kernels
from derivation.scene.model import Model

PLATES = 1e-50, 1e50
"""h/b for which bounds are known."""
Array = NDArray[np.float64]


class Share(NamedTuple):
    """A part of F and of S at radii [1]."""

    depth: Array
    slope: Array


class Along(NamedTuple):
    """The law taken at contact radii up to its largest.

    Force [N], indentation [m], stiffness [N/m], energy [J] and d log delta/d log a [1].
    """

    force: Array
    depth: Array
    stiffness: Array
    energy: Array
    growth: Array


@dataclass(frozen=True)
class Place:
    """Where a bound is asked for.

    Attributes
    ----------
    radii
        Hertz's radii of the force [m], from 0 on, growing.
    depth
        Largest indentation [m], of an impact.
    along
        The law taken, of an impact.
    """

    radii: Array
    depth: float = 0.0
    along: Along | None = None

    def stretched(self, factor: float) -> "Place":
        """The same with all radii larger."""
        return replace(self, radii=self.radii * factor)


Results = tuple[float, float, float, float, float]
"""A number for each of the outputs."""


class Bound(NamedTuple):
    """What leaving an effect out changes at most.

    Attributes
    ----------
    low, up
        How far S may be below and above the law without the effect, at the radii given and
        all smaller ones; not negative [1].
    energy
        Logarithm of the factor by which more energy may go into the contact [1].
    radius
        Logarithm of the factor by which the contact radius may differ besides [1].
    results
        The same of every result, in the order of the outputs [1].
    """

    low: Array
    up: Array
    energy: float = 0.0
    radius: float = 0.0
    results: Results = (0.0, 0.0, 0.0, 0.0, 0.0)


class Effect:
    """An effect: a base whose answers are those of one that is always there.

    Attributes
    ----------
    name
        As the scene file calls it.
    adds
        What it adds, in a few words.
    equation
        Its equation.
    number
        The dimensionless number that says when it matters.
    source
        Who derived it, and the link of the chain that proves it here.
    forced
        Whether it cannot be left out.
    by_itself
        Whether the gate may take it in. If not, it is no part of the law, and stands beside the
        result where a scene asks for it.
    """

    name: ClassVar[str]
    adds: ClassVar[str]
    equation: ClassVar[str]
    number: ClassVar[str]
    source: ClassVar[str]
    forced: ClassVar[bool] = False
    by_itself: ClassVar[bool] = True

    def absent(self, model: Model) -> str:  # noqa: ARG002
        """Why the scene has no such effect by itself; empty if it has."""
        return "" if self.by_itself else "never by itself: for comparison only"

    def value(self, model: Model, a: float) -> float:
        """The dimensionless number at a largest contact radius [m]."""
        raise NotImplementedError

    def bound(self, model: Model, place: Place) -> Bound:
        """What leaving it out changes at most."""
        raise NotImplementedError


class PlateEffect(Effect):
    """An effect that adds to the deflection of the plate under the contact force."""

    def share(self, model: Model, a: Array) -> Share:
        """Its part of F and S at Hertz's radii [m], of a rigid sphere."""
        raise NotImplementedError


def plate_of(model: Model) -> kernels.Plate:
    """c_1, its doubt and K_3 of the plate; infinite where h/b is out of their range."""
    low, high = PLATES
    if not low < model.eta < high:
        return kernels.Plate(np.inf, np.inf, np.inf)
    return kernels.plate_of(model.eta)


def none_of(a: Array) -> Array:
    """Zeros at radii."""
    return np.zeros_like(a)
