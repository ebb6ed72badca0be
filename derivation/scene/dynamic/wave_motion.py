"""Results of an impact on a plate with inertia: contacts, time history, energy balance."""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from functools import cached_property
from html import escape
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import local_indentation
from derivation.scene.dynamic.contact_sequence import ImpactHistory
from derivation.scene.dynamic.first_contact import EVALUATIONS, IRREGULAR, decisive_change, minima
from derivation.scene.dynamic.history_at import ROUNDED, deflections, rows_of
from derivation.scene.dynamic.middle_plane import MiddlePlane, Steepness
from derivation.scene.dynamic.stretched_flight import reach
from derivation.scene.dynamic.time_element import A, C, E, P, V, W, Z
from derivation.scene.effects.effect import Results
from derivation.scene.numerics.collocation import ONSET
from derivation.scene.output.html import html_table
from derivation.scene.quantity import counted, rounded_up
from derivation.scene.quasi_static.motion import EnergyBalance, Motion
from derivation.scene.scene import OUTPUTS
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from derivation.scene.dynamic.back_face import BackFace

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
FLIGHT = 129
"""Number of times at which the plate is evaluated in flight; a peak is underestimated by 1 %."""
HEADS = (
    "#start [s]", "#end [s]", "#impulse [N s]", "#peak force [N]",
    "#approach speed / impact speed",
)  # fmt: skip
"""Column heads of the table of contacts."""


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
        Relative change of each result since the run with half as many modes [1]; infinite if there
        is no estimate, for example if all modes are slower than the contact.
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
        own = regular and not math.isnan(self.first_change)  # not affected by later contacts
        largest = self.first_change if own else max(self.mode_convergence)
        change = max(self.mode_convergence[index], BY_CHANCE * largest)
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


@dataclass(frozen=True)
class DynamicImpact(Motion):
    """An impact on a plate with inertia, with its history."""

    impact_history: ImpactHistory = field(kw_only=True, repr=False)
    law: ContactLaw = field(kw_only=True, repr=False)
    inertia: InertiaDetails = field(kw_only=True)
    energy_balance: EnergyBalance = field(kw_only=True)

    @cached_property
    def histories(self) -> tuple[Array, ...]:
        """Rows of each contact at `EVALUATIONS` times, up to the deflection, in SI units."""
        problem, contacts = self.impact_history.problem, self.impact_history.contacts
        times = (np.linspace(one.start, one.end, EVALUATIONS) * problem.T for one in contacts)
        return tuple(self.rows(some)[: W + 1].copy() for some in times)

    @cached_property
    def back_face(self) -> "BackFace":
        """Largest tensile stress on the axis of the back face."""
        from derivation.scene.dynamic.back_face import back_face

        return back_face(self)

    @property
    def least(self) -> float:
        """Smallest force between two maxima in a contact, over the peak force [1]; 1 if none."""
        return min(self.least_force(rows) for rows in self.histories)

    @cached_property
    def decisive_change(self) -> float:
        """Relative change that may split the first contact, or join it with the second [1]."""
        return decisive_change(self)

    @property
    def flight(self) -> float:
        """Total time between contacts, over the contact time on a plate without deflection [1]."""
        contacts = self.impact_history.contacts
        return sum(after.start - before.end for before, after in pairwise(contacts))

    def least_force(self, rows: Array) -> float:
        """Return the smallest force between two maxima, over the peak force [1]; 1 if none."""
        force = rows[P] / self.max_force
        return float(np.min(force[minima(force)], initial=1.0))

    def largest_deflection(self, law: ContactLaw) -> float:
        """Return the largest deflection of the plate at the axis [m], in either direction.

        During contact it is that of the modes or, if larger, the displacement of the sphere less
        the local indentation. It includes flight and, if the impact is complete, one period of the
        slowest mode after the last contact.
        """
        later = self.later_deflection if self.inertia.complete else 0.0
        return max(later, self.deflection_before_separation(law))

    def deflection_before_separation(self, law: ContactLaw) -> float:
        """Return the largest deflection at the axis [m] up to the end of the last contact."""
        touching = (self.deflection_during(law, i) for i in range(len(self.histories)))
        contacts = self.impact_history.contacts
        flights = (self._in_flight(one.end, other.start) for one, other in pairwise(contacts))
        return max(*touching, *flights, 0.0)

    def deflection_during(self, law: ContactLaw, contact: int) -> float:
        """Return the largest deflection at the axis [m] during a contact, numbered from 0."""
        return float(self.deflections_so_far(law, contact)[-1])

    def deflections_so_far(self, law: ContactLaw, contact: int) -> Array:
        """Return the largest deflection at the axis [m] up to each time of a contact."""
        rows = self.histories[contact]
        a = np.minimum(np.maximum(rows[A], 0.0), law.limit)
        free = rows[Z] - local_indentation(law, a)
        largest = np.maximum.accumulate(np.maximum(np.abs(free), np.abs(rows[W])))
        return np.asarray(largest, dtype=np.float64)

    @cached_property
    def later_deflection(self) -> float:
        """Largest deflection at the axis in one period of the slowest mode after the impact [m].

        If the plate stretches, it is the bound by its energy.
        """
        problem, last = self.impact_history.problem, self.impact_history.contacts[-1]
        if problem.middle_plane is not None:
            return problem.depth * reach(problem, last.after)
        end = last.end
        slowest = float(np.min(problem.omega, initial=np.inf))
        return self._in_flight(end, end + 2.0 * np.pi / slowest)

    @cached_property
    def steepness(self) -> Steepness:
        """The slope of the plate in its time elements, also of one that does not stretch."""
        problem, contacts = self.impact_history.problem, self.impact_history.contacts
        modes = problem.contact.modes
        plane = problem.middle_plane or MiddlePlane.of(
            self.law.model, modes, problem.depth, problem.force
        )
        pieces = [piece for one in contacts for piece in one.pieces]
        ends = [modes.by_shape(piece.end.q) for piece in pieces]
        squares, fourths = np.maximum.accumulate([plane.steepness(q) for q in ends]).T
        so_far = (problem.depth / self.law.model.b) ** 2 * fourths / squares
        own = [piece.element for piece in contacts[0].pieces]
        times = np.array([one.x + one.length for one in own]) ** ONSET
        place = np.searchsorted(times, np.linspace(0.0, contacts[0].end, EVALUATIONS))
        first = so_far[np.minimum(place, len(own) - 1)]
        deflection = problem.depth * max(abs(float(np.sum(q))) for q in ends)
        return Steepness(float(so_far[-1]), first, deflection)

    def _in_flight(self, start: float, end: float) -> float:
        """Return the largest deflection at the axis [m] between two times in problem units."""
        times = np.linspace(start, end, FLIGHT) * self.impact_history.problem.T
        return float(np.max(np.abs(self.rows(times)[W])))

    def to_json(self) -> dict[str, Any]:
        """Return contacts, energies and error estimates under fixed keys, in SI units."""
        inertia, balance = self.inertia, self.energy_balance
        return {
            "total_time": inertia.total_time,
            "complete": inertia.complete,
            "end_reason": inertia.end_reason,
            "contacts": [touch._asdict() for touch in inertia.contacts],
            "modes": inertia.modes,
            "mode_energies": list(inertia.energies),
            "mode_convergence": {
                name: value if np.isfinite(value) else None
                for name, value in zip(OUTPUTS, inertia.mode_convergence, strict=True)
            },
            "omitted_branch_error": dict(zip(OUTPUTS, inertia.omitted_branch_error, strict=True)),
            "energy_balance": asdict(balance) | {"residual": balance.residual},
        }

    def lines(self) -> list[tuple[str, ...]]:
        """Return the cells of each contact, under `HEADS`."""
        return [tuple(f"{value:.6g}" for value in touch) for touch in self.inertia.contacts]

    def notes(self) -> tuple[str, ...]:
        """Return sentences about error estimates and the end of the simulation."""
        inertia, residual = self.inertia, abs(self.energy_balance.residual)
        energies = (
            "The numbers of single contacts have no error bounds. The energy balance closes to "
            f"{residual:.1e} of the initial kinetic energy."
        )
        if not inertia.complete:
            return (energies,)
        contacts = counted(len(inertia.contacts), "contact")
        fall = ", unless the weight returns the sphere" if self.law.model.gravity else ""
        ended = f"No further contact is possible after {contacts}{fall}. "
        branches = "all wave branches" if self.law.model.inertia.branches == "all" else "branch A0"
        change = "an error estimate requires more modes"
        if math.isfinite(max(inertia.mode_convergence)):
            change = (
                "halving the number of bending modes changes the results by at most "
                f"{rounded_up(max(inertia.mode_convergence))}"
            )
            if any(inertia.earlier_change):
                change += f", and halving it again by {rounded_up(max(inertia.earlier_change))}"
        return energies, ended + f"{counted(inertia.modes, 'mode')} ({branches}); {change}."

    def to_html(self) -> str:
        """Return the contacts and notes for a notebook."""
        notes = "".join(f"<p>{escape(note)}</p>" for note in self.notes())
        return html_table(HEADS, self.lines()) + notes

    _repr_html_ = to_html

    def history(self, law: ContactLaw, times: Array) -> tuple[Array, Array, Array, Array]:  # noqa: ARG002
        """Return indentation [m], velocity [m/s], contact radius [m] and force [N] at times [s]."""
        rows = self.rows(times)
        return rows[Z], rows[V], rows[C], rows[P]

    @property
    def at_equal_radius(self) -> float:
        """Force and pressure at the largest contact radius over those of the static law there [1].

        At equal force the curvature of the plate changes the radius, and P grows with its cube.
        """
        return (1.0 + self.inertia.curvature) ** -3

    def rows(self, times: Array) -> Array:
        """Return the rows of `time_element` at times [s]; in SI units without those of losses."""
        problem, t = self.impact_history.problem, np.asarray(times, dtype=np.float64)
        found = np.zeros((C + 1, t.size))
        starts = np.array([touching.start for touching in self.impact_history.contacts])
        # A time that rounding moves before the start of a contact belongs to it.
        begun = t / problem.T * (1.0 + ROUNDED)
        place = np.maximum(np.searchsorted(starts, begun, side="right") - 1, 0)
        for index in sorted(set(place.tolist())):
            here = place == index
            found[:, here] = rows_of(
                problem, self.impact_history.contacts[index], t[here] / problem.T
            )
        energy = problem.m * problem.v0**2
        units = np.ones(C + 1)
        units[[A, C, V, Z, P, W, E]] = (
            problem.a, problem.a, problem.v0, problem.depth, problem.force, problem.depth, energy
        )  # fmt: skip
        return found * units[:, None]

    def profiles(self, times: Array, r: Array) -> Array:
        """Return deflections [m] of the modes at times [s] (rows) and distances [m] (columns)."""
        problem = self.impact_history.problem
        shapes = problem.contact.modes.shapes(r)
        found = [deflections(self.impact_history, float(t) / problem.T) @ shapes for t in times]
        return problem.depth * np.array(found)
