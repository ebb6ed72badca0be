"""Results of an impact on a plate with inertia: contacts, time history, energy balance."""

import math
from dataclasses import asdict, dataclass, field
from functools import cached_property
from html import escape
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import local_indentation
from derivation.scene.dynamic.contact_sequence import ImpactHistory
from derivation.scene.dynamic.first_contact import EVALUATIONS, decisive_change, minima
from derivation.scene.dynamic.history_at import ROUNDED, deflections, rows_of
from derivation.scene.dynamic.inertia_details import InertiaDetails
from derivation.scene.dynamic.middle_plane import MiddlePlane, Steepness
from derivation.scene.dynamic.stretched_flight import reach
from derivation.scene.dynamic.time_element import A, C, E, P, V, W, Z
from derivation.scene.numerics.collocation import ONSET
from derivation.scene.output.html import html_table
from derivation.scene.quantity import counted, rounded_up
from derivation.scene.quasi_static.motion import EnergyBalance, Motion
from derivation.scene.scene import OUTPUTS
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from derivation.scene.dynamic.back_face import BackFace

FLIGHT = 129
"""Number of times at which the plate is evaluated in flight; a peak is underestimated by 1 %."""
HEADS = (
    "#start [s]", "#end [s]", "#impulse [N s]", "#peak force [N]",
    "#approach speed / impact speed",
)  # fmt: skip
"""Column heads of the table of contacts."""


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

    @cached_property
    def flat_contact_errors(self) -> dict[str, float]:
        """Relative error of each result by the curvature under the sphere [1]."""
        from derivation.scene.dynamic.flat_contact import flat_contact_errors

        return flat_contact_errors(self)

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
        return max(*touching, self.deflection_between_contacts)

    @cached_property
    def deflection_between_contacts(self) -> float:
        """Largest deflection at the axis in the flights between contacts [m]."""
        contacts = self.impact_history.contacts
        flights = (self._in_flight(one.end, other.start) for one, other in pairwise(contacts))
        return max(flights, default=0.0)

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
        if inertia.slow:
            change = (
                "with half and a quarter of the bending modes the results differ by at most "
                f"{rounded_up(max(inertia.mode_convergence))}; faster modes would need too many "
                "time steps"
            )
        elif math.isfinite(max(inertia.mode_convergence)):
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

        It is the force of the law at the radius that it has at the same force, over that at the
        largest radius of the plate, which is curved less or more.
        """
        if not self.inertia.curvature:
            return 1.0
        branch, radius = self.impact_history.problem.yielding, self.max_contact_radius
        if branch is not None:
            radius *= branch.flattening
        radii = radius / np.array([1.0 + self.inertia.curvature, 1.0])
        of_law, there = self.law.force(radii, self.law.at(radii))
        return float(of_law / there)

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
