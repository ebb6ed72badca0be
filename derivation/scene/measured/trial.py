"""Results of a measurement with trial values of a material constant."""

from typing import NamedTuple

from derivation.scene.effects.effect import Results
from derivation.scene.errors import SceneError


class UnreachedError(SceneError):
    """The error of a restitution below all that the constant gives.

    Attributes
    ----------
    least
        The smallest restitution less its error bound [1].
    value
        The approximate constant that gives it; 0 if it is unknown.
    """

    def __init__(self, text: str, least: float, value: float) -> None:
        super().__init__(text, least, value)  # the arguments from which pickle restores it
        self.text, self.least, self.value = text, least, value

    def __str__(self) -> str:
        return self.text


class ExceedsError(SceneError):
    """The error of a restitution above that without energy loss by the constant."""


class WideTrialError(SceneError):
    """The error of a restitution for which the contact is clearly too wide.

    Each trial begins with values that lose less energy than the solution: they are too wide as
    soon as the solution is.
    """


class IncompleteTrialError(SceneError):
    """The error of a restitution for which the impact has too many contacts or time steps.

    With more modes it has as many contacts and more time steps.
    """


class Trial(NamedTuple):
    """The results of a measurement with a trial value: outputs, pressure [Pa], error bound [1].

    `model_errors` are those of each output [1]; a rough simulation has none. `contacts` is the
    number of contacts.
    """

    outputs: Results
    max_pressure: float
    bound: float
    model_errors: dict[str, float]
    contacts: int = 1

    @property
    def contact_time(self) -> float:
        """Duration of the contact, with plate inertia of the first one [s]."""
        return self.outputs[0]

    @property
    def restitution(self) -> float:
        """The restitution [1]."""
        return self.outputs[-1]


class Point(NamedTuple):
    """Logarithm of a trial value, restitution less the measured one, and its lower bound [1]."""

    x: float
    above: float
    least: float


def vertex(one: Point, two: Point, three: Point) -> float:
    """Return the position of the vertex of the parabola through equidistant points."""
    curvature = one.above - 2.0 * two.above + three.above
    offset = 0.5 * (one.above - three.above) / curvature if curvature > 0.0 else 0.0
    return two.x + (two.x - one.x) * offset
