"""Ends simulations with plate inertia early if they cannot meet their tolerance.

The error by omitted modes is known only after a run with more modes. The change by omitted wave
branches is known earlier: when the first contact has its largest radius, or when it ends.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.contact_sequence import ENOUGH, ContactRun, ImpactHistory
from derivation.scene.dynamic.mode_count import needs_infinite_plate
from derivation.scene.dynamic.problem import DynamicProblem
from derivation.scene.dynamic.results import dynamic_impact_of
from derivation.scene.effects.effect import Changes
from derivation.scene.effects.inertia import higher_branch_error
from derivation.scene.errors import SceneError
from derivation.scene.scene import OUTPUTS

INFINITE = ', or set extent = "infinite" in [inertia], because no wave returns in time'
ROOM = 1.5
"""Tolerance over the change by omitted branches, from which a third of the tolerance remains for
omitted modes."""


class OutOfReachError(SceneError):
    """The error of a simulation that ends early, because it cannot meet its tolerance.

    Attributes
    ----------
    change
        Estimated change by what is omitted [1].
    why
        The cause of the error.
    remedy
        How to reduce it, instead of a larger tolerance.
    """

    def __init__(self, change: float, why: str, remedy: str) -> None:
        super().__init__(change, why, remedy)  # the arguments from which pickle restores it
        self.change, self.why, self.remedy = change, why, remedy

    @property
    def least(self) -> float:
        """Tolerance that the error can be expected to meet [1]."""
        return ROOM * self.change

    def __str__(self) -> str:
        return f"rtol: expected at least about {self.least:.2g}, because {self.why}; {self.remedy}"


@dataclass(frozen=True)
class Reach:
    """The tolerance of a simulation, which ends early if it cannot be met.

    Attributes
    ----------
    law
        The law of the scene, with the wave branches that the scene gives.
    outputs
        The results that the tolerance applies to.
    need
        Largest error by omitted modes and branches that meets the tolerance [1]; infinite without
        a tolerance.
    """

    law: ContactLaw
    outputs: tuple[str, ...]
    need: float

    def watch(self, used: ContactLaw, unit: float) -> Callable[[float], None] | None:
        """Return a function that raises an error if a contact is too wide for one wave branch.

        It is called with contact radii over `unit` [m]. The change by the omitted branches is at
        least that of an infinitely long contact of this radius. None if the law includes all
        branches.
        """
        if not self._checks(used):
            return None

        widest, loss = 0.0, 2.0 * used.damping_ratio

        def watch(radius: float) -> None:
            nonlocal widest
            if radius > widest:  # the change grows with the radius
                widest = radius
                self.check(higher_branch_error(used.model, unit * radius, math.inf, loss))

        return watch

    def enough(
        self, used: ContactLaw, problem: DynamicProblem
    ) -> Callable[[tuple[ContactRun, ...]], bool] | None:
        """Return a function of the contacts so far that raises the error of `watch`.

        It always returns that more contacts are needed.
        """
        if not self._checks(used):
            return None

        def enough(contacts: tuple[ContactRun, ...]) -> bool:
            yielded = replace(problem, yielding=contacts[-1].yielding)
            begun = dynamic_impact_of(used, ImpactHistory(yielded, contacts, ENOUGH))
            self.check(begun.inertia.omitted_branch_error)
            return False

        return enough

    def _checks(self, used: ContactLaw) -> bool:
        return used.model.inertia.branches != "all" and math.isfinite(self.need)

    def check(self, changes: Changes, known: float = 0.0) -> None:
        """Raise an error if the omitted branches change an output by more than is allowed.

        Parameters
        ----------
        changes
            Estimated changes of all outputs [1].
        known
            A change that they must also exceed [1].
        """
        found = {name: float(changes[OUTPUTS.index(name)]) for name in self.outputs}
        worst = max(found, key=lambda name: found[name])
        if not found[worst] > max(self.need, known):
            return
        cause, remedy = self._branches_in_words()
        raise OutOfReachError(
            found[worst],
            f"{cause}, and the omitted branches may change {worst} by about "
            f"{found[worst]:.1e} (estimated)",
            remedy,
        )

    def _branches_in_words(self) -> tuple[str, str]:
        """Return why wave branches are omitted, and what to change instead of the tolerance."""
        if self.law.viscous:
            return (
                "a viscoelastic contact is simulated with the lowest wave branch only",
                "set effects.viscosity = false for an elastic contact",
            )
        if self.law.model.inertia.branches == "A0":
            return (
                'only the lowest wave branch is included (inertia.branches = "A0")',
                "remove inertia.branches",
            )
        return (
            "the contact is too short for all wave branches, so that only the lowest is included",
            f"use a smaller or thinner plate{INFINITE if needs_infinite_plate(self.law) else ''}",
        )
