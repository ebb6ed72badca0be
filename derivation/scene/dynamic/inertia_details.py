"""The contacts of an impact on a plate with inertia, and the errors of its omitted modes."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from derivation.scene.dynamic.first_contact import IRREGULAR
from derivation.scene.effects.effect import Results
from derivation.scene.scene import OUTPUTS

LATE = 2.5
"""Estimated error of the contact time by omitted modes over its change since half as many [1]. Just
before the separation the force falls as the power 3/2 of the time left, and a mode lags it by a
power -3/2 of its frequency. The sum over the omitted modes of a half-space, and with it the error
of the contact time, decreases as the square root of their number: it tends to 1/(sqrt(2) - 1) =
2.42 times the change."""
EARLIER = 1.0
"""Estimated error of the omitted modes over the change between the two runs before [1]. Waves that
return during the contact make results converge irregularly: two runs may agree by chance."""
BY_CHANCE = 0.5
"""Least estimated change of a result by more modes, over the largest change of any result: two runs
may agree in one result by chance. Without it, errors of single results in random scenes were up to
2.2 times the estimates; 0.34 would have been enough for all of them."""
SLOWER, BY_CHANCE_TWICE = 1.5, 0.1
"""Factor of that error if all modes are slower than a short contact, and `BY_CHANCE` for the larger
one of two changes, since half and since a quarter as many modes. Errors were at most 0.6 of the
estimates in 73 runs of 17 random scenes with 8 to 85 modes, and the factors are those of others."""


class ContactInterval(NamedTuple):
    """A contact of an impact.

    Attributes
    ----------
    start, end
        Times since first contact [s].
    impulse
        Impulse of the contact force [N s].
    peak_force
        Largest contact force [N].
    relative_approach_speed
        Speed at which sphere and face of the plate meet, over the impact speed [1].
    """

    start: float
    end: float
    impulse: float
    peak_force: float
    relative_approach_speed: float


@dataclass(frozen=True)
class InertiaDetails:
    """Details of an impact with plate inertia.

    Attributes
    ----------
    contacts
        All contacts, in order.
    total_time
        Time from first contact to last separation [s].
    end_reason
        Why the simulation ends.
    remedy
        Advice to make an incomplete simulation complete; empty if it is complete.
    modes
        Number of dynamic modes, of all included branches.
    energies
        Energy of each mode after the last separation [J].
    mode_convergence
        Relative change of each result since the run with half as many modes [1], or the larger one
        of this and the change since a quarter as many; infinite if there is no estimate.
    earlier_change
        Relative change of each result between the two runs before, with half and with a quarter as
        many modes [1]; 0 if there was none.
    ripple, ripple_error
        Largest changes of force and contact radius near their maxima since the run with half as
        many modes, over these maxima [1]; the errors of contact time, largest force and largest
        radius estimated from such changes [1].
    recounted
        Whether the run with half as many modes has another number of contacts, so that its results
        are no measure of the convergence.
    omitted_branch_error
        Estimated relative change of each result by the omitted wave branches [1]; 0 if all
        branches are included.
    omitted_octaves
        Doublings of the largest wave number that would each change the results as much as the last
        one, because the omitted modes would be damped in the contact [1]; 0 without damping.
    curvature
        Largest contact radius over that of the static law at the largest radius, less 1: the plate
        is curved less or more than under a static load [1].
    echo_ripple, echo_error
        Bound on the change of a viscoelastic force by short waves from the edge in the omitted
        modes, over the largest force; the error of the largest force by it [1].
    shape_error
        Estimated error of each result by the shapes that do not stretch the plate [1].
    first_change
        Largest such change of duration, impulse and peak force of the first of several contacts.
    slow
        Whether all modes are slower than a short contact, so that a change of the first contact's
        duration is no measure of the other results.
    jump
        Relative change of the first contact's duration if more modes or branches split it, or join
        it with the next contact [1]; 0 if that is not expected.
    """

    contacts: tuple[ContactInterval, ...]
    total_time: float
    end_reason: str
    remedy: str
    modes: int
    energies: tuple[float, ...]
    mode_convergence: Results
    omitted_branch_error: Results
    omitted_octaves: float = 0.0
    curvature: float = 0.0
    jump: float = 0.0
    earlier_change: Results = (0.0, 0.0, 0.0, 0.0, 0.0)
    recounted: bool = False
    ripple: tuple[float, float] = (0.0, 0.0)
    ripple_error: tuple[float, float, float] = (0.0, 0.0, 0.0)
    first_change: float = math.nan
    slow: bool = False
    echo_ripple: float = 0.0
    echo_error: float = 0.0
    shape_error: Results = (0.0, 0.0, 0.0, 0.0, 0.0)

    @property
    def complete(self) -> bool:
        """Whether no further contact follows."""
        return not self.remedy

    def left(self, outputs: Sequence[str]) -> tuple[float, float]:
        """Return the largest estimated errors of outputs by omitted modes and by branches [1]."""
        remaining = max(map(self.error_of_modes, outputs))
        indices = [OUTPUTS.index(name) for name in outputs]
        return remaining, max(self.omitted_branch_error[k] for k in indices)

    def error_of_modes(self, output: str) -> float:
        """Return the estimated error of an output by omitted modes [1]."""
        by_shapes = self.shape_error[OUTPUTS.index(output)]
        return by_shapes + max(self.error_by_change(output), self.error_by_ripple(output))

    def error_by_change(self, output: str) -> float:
        """Return that error as estimated from changes of the results [1]."""
        index, regular = OUTPUTS.index(output), output == "contact_time"
        factor = (LATE if regular else IRREGULAR) + self.omitted_octaves
        factor *= SLOWER if self.slow else 1.0
        own = regular and not math.isnan(self.first_change)  # not affected by later contacts
        counting = self.mode_convergence[self.slow :]  # the first one is the contact time's
        largest = self.first_change if own else max(counting)
        by_chance = BY_CHANCE_TWICE if self.slow else BY_CHANCE
        change = max(self.mode_convergence[index], by_chance * largest)
        earlier = 0.0 if regular else EARLIER * self.earlier_change[index]
        return max(factor * change, earlier)

    def error_by_ripple(self, output: str) -> float:
        """Return that error as estimated from changes of force and radius over time [1]."""
        outputs = "contact_time", "max_force", "max_contact_radius"
        return dict(zip(outputs, self.ripple_error, strict=True)).get(output, 0.0)

    def error(self, outputs: Sequence[str]) -> float:
        """Return the largest estimated error of outputs by all that is omitted [1]."""
        modes, branches = self.left(outputs)
        modes = max(modes, self.echo_error if "max_force" in outputs else 0.0)
        return modes + branches + (self.jump if "contact_time" in outputs else 0.0)
