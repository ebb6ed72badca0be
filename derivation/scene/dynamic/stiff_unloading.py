"""Finds a number of modes for a yielded contact that has no solution with more of them.

With many modes such a contact may unload more stiffly than the short modes of the plate respond. A
message names a number of modes only if the contact has a solution with it.
"""

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.contact_sequence import impact_history
from derivation.scene.dynamic.mode_count import branching, coarser, with_modes
from derivation.scene.dynamic.results import dynamic_impact_of
from derivation.scene.dynamic.runs import LOOSE, Budget, time_tolerance
from derivation.scene.dynamic.time_in_contact import nodes_for
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.errors import EndlessError, SceneError, StiffUnloadingError
from derivation.scene.input.settings import FEWEST_MODES

ENOUGH = 5e5
"""Largest work, in the units of `contact_sequence.WORK`, of all contacts that only determine which
number a message names: half a second. A contact that takes more is assumed to have a solution."""


def number_with_solution(law: ContactLaw, error: StiffUnloadingError) -> int:
    """Return a number of modes with which the first contact has a solution; 0 if none is found.

    Only the first contact can reject a scene: an impact with another one is incomplete.
    """
    count, budget = error.fewer, Budget(ENOUGH)
    while count >= FEWEST_MODES:
        if _has_solution(with_modes(law, count), budget):
            return count
        count //= 2
    return 0


def _has_solution(law: ContactLaw, budget: Budget) -> bool:
    """Return whether the first contact has a solution with the modes of a law, and with half.

    An impact is simulated with half of the modes, too, to estimate its error.
    """
    count, branches = law.model.inertia.modes, [law.model.inertia.branches]
    if branches == ["auto"]:  # all are simulated if the higher ones matter
        branches = ["A0"] if law.viscous else ["all", "A0"]
    return all(
        _first_contact_ends(branching(law, one), number, budget)
        for number in (count, coarser(count))
        for one in branches
    )


def _first_contact_ends(law: ContactLaw, count: int, budget: Budget) -> bool:
    """Return whether the first contact can be computed to its end and is narrow enough."""
    close = time_tolerance(LOOSE)
    problem = problem_of(law, count, close)
    try:
        most = max(0.0, budget.left)
        history = impact_history(problem, nodes_for(problem), close, most, lambda _: True)
    except EndlessError:
        budget.left = 0.0
        return True
    except SceneError:
        return False
    budget.left -= history.work
    return dynamic_impact_of(law, history).max_contact_radius < law.limit
