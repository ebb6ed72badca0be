"""Tested bounds on the errors of the results of an impact that its time elements cause."""

from derivation.scene.dynamic.contact_sequence import ImpactHistory
from derivation.scene.dynamic.next_element import ROUGH
from derivation.scene.dynamic.problem import DynamicProblem

INTEGRATION, GROWTH = 10.0, 1e-12
"""Tested bounds [1]: error of the results over the tolerance of the time elements and the number of
contacts; rounding error amplified by contacts, over the cube of their number."""


def integration_error(history: ImpactHistory) -> float:
    """Return the tested bound on the error of the results due to the time elements [1]."""
    return error_after(history.problem, history.tolerance, len(history.contacts))


def error_after(problem: DynamicProblem, tolerance: float, contacts: int = 1) -> float:
    """Return the bound; it is larger for a viscoelastic contact, whose force is less accurate.

    Every contact adds errors, and each contact amplifies the errors of those before it.
    """
    viscous = problem.retardation_time > 0.0
    each = (ROUGH if viscous else INTEGRATION) * tolerance
    return each * contacts + GROWTH * (contacts - 1) ** 3
