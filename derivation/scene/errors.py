"""Errors of a scene: a message with key, expectation, value and remedy."""

from dataclasses import dataclass


class SceneError(ValueError):
    """The error of a scene, file or argument that is not valid or cannot be computed.

    The message states the key, what was expected, what was given, and what to do.

    Examples
    --------
    >>> import platecontact as pc
    >>> try:
    ...     pc.Impact(speed=-1.0)
    ... except pc.SceneError as error:
    ...     print(str(error).partition("; ")[0])
    impact.speed: expected a positive number (impact speed [m/s]), got -1
    """


@dataclass(frozen=True)
class Slower:
    """Advice for a contact that is too wide.

    Attributes
    ----------
    speed
        A speed at which the contact is narrow enough [m/s]; 0 if none is known.
    others
        What else the user can do.
    """

    speed: float
    others: str

    def __str__(self) -> str:
        enough = f" ({self.speed:.2g} m/s is low enough for this limit)" if self.speed else ""
        return f"reduce impact.speed{enough}{self.others}"


class WideContactError(SceneError):
    """The error of a contact that is wider than the contact law allows.

    Attributes
    ----------
    why, remedy
        The key that determines the radius with what was expected and given; what the user can do.
    ratio
        The contact radius over the largest one [1].
    """

    def __init__(self, why: str, remedy: str | Slower, ratio: float) -> None:
        super().__init__(why, remedy, ratio)  # the arguments from which pickle restores it
        self.why, self.remedy, self.ratio = why, remedy, ratio

    def __str__(self) -> str:
        return f"{self.why}; {self.remedy}"


def wide_contact(
    key: str, limit: str, got: str, remedy: str | Slower, ratio: float
) -> WideContactError:
    """Return the error of a contact that is wider than the contact law allows.

    Parameters
    ----------
    key
        Key or argument that determines the radius, as the user writes it.
    limit
        Largest contact radius of the law, in words.
    got
        The contact radius, in words without its unit.
    remedy
        What the user can do.
    ratio
        The contact radius over the largest one [1].
    """
    why = f"{key}: expected a contact radius below {limit}, got {got} m"
    return WideContactError(why, remedy, ratio)


class HeldError(SceneError):
    """The error of a sphere that does not rebound because its weight holds it on the plate."""


class IncompleteError(SceneError):
    """The error of an impact with plate inertia that could not be computed to its end."""

    def __init__(self, why: str, remedy: str | Slower) -> None:
        super().__init__(why, remedy)  # the arguments from which pickle restores it
        self.why, self.remedy = why, remedy

    def __str__(self) -> str:
        return f"effects.inertia: {self.why}; {self.remedy}"


class EndlessError(IncompleteError):
    """The error of a contact or a flight that takes more time steps than are allowed."""


class StiffUnloadingError(IncompleteError):
    """The error of a yielded contact that unloads more stiffly than short plate modes respond.

    Attributes
    ----------
    fewer
        A number of modes with which there may be a solution; 0 if none is known.
    branched
        Whether the lowest wave branch alone may have one.
    chosen
        Whether the scene gives the number of modes; an automatic one is often that of the modes for
        which there is a solution.
    """

    def __init__(self, why: str, fewer: int, branched: bool, chosen: bool = False) -> None:
        remedies = ['inertia.modes = "auto"'] if chosen else []
        if fewer:
            few = f"fewer modes without a tolerance, such as inertia.modes = {fewer}"
            remedies.append(few)
        if branched:
            remedies.append('inertia.branches = "A0"')
        if not fewer:
            remedies.append("a lower impact.speed")
            remedies.append("effects.plasticity = false for an elastic contact")
        super().__init__(why, "try " + ", or ".join(remedies))
        self.fewer, self.branched = fewer, branched
        self.args = why, fewer, branched, chosen  # from which pickle restores it

    def named(self, fewer: int, chosen: bool) -> "StiffUnloadingError":
        """Return the error with a number of modes that has a solution, or with 0 for none."""
        return StiffUnloadingError(self.why, fewer, self.branched, chosen)


class ToleranceError(SceneError):
    """The error of a tolerance that the results do not meet.

    Attributes
    ----------
    message
        The message.
    error
        Error bound that the results reach, or are expected to reach [1].
    growth
        Factor by which the bounds on the omitted effects must decrease, if the tolerance is met
        without them [1]; else 0.
    """

    def __init__(self, message: str, error: float, growth: float = 0.0) -> None:
        super().__init__(message, error, growth)  # the arguments from which pickle restores it
        self.message, self.error, self.growth = message, error, growth

    def __str__(self) -> str:
        return self.message
