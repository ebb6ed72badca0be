"""Contact law and impact of a scene to many digits, by both references."""

from derivation.engine.activity import Progress
from derivation.plate.impact.oracle import many_digits as oracle
from derivation.scene.result import Result


def time_of_reference(known: Result, digits: int) -> str:
    """Return the estimated run time of `reference`, in words."""
    seconds = oracle.expected_seconds(_motion(known), known.max_contact_radius, digits)
    time = f"{seconds / 60:.0f} min" if seconds > 90 else f"{seconds:.0f} s"
    return f"estimated time: about {time} on an idle machine"


def reference(known: Result, digits: int, progress: Progress) -> oracle.ImpactReference:
    """Return contact law and impact of a scene to many digits, by both references.

    Raises
    ------
    ValueError
        If this number of digits cannot be reached for the scene.
    """
    try:
        return oracle.reference(_motion(known), digits, progress)
    except ArithmeticError as error:  # an interval too wide, a zero not certified, no convergence
        raise ValueError(
            f"digits: {digits} digits cannot be reached for this scene ({error}); use fewer"
        ) from None


def _motion(known: Result) -> oracle.Motion:
    m = known.model
    return m.R, m.m, m.v0, m.h, m.b, m.lam, m.mu
