"""The course of an impact on a moving plate: contacts, histories, and where the energy goes."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from html import escape
from typing import Any, NamedTuple

import numpy as np

from derivation.scene import bounces
from derivation.scene.bounces import Course
from derivation.scene.collocation import ONSET
from derivation.scene.dynamics import LEAK, A, E, P, Problem, V, W, Z, oscillating
from derivation.scene.effects.effect import Array, Results
from derivation.scene.html import html_table
from derivation.scene.law import Law
from derivation.scene.motion import Ledger, Motion
from derivation.scene.scene import OUTPUTS

IRREGULAR = 2.0
"""What modes left out may change, over what half of those there are did."""
LOOKS = 2001
"""Times at which a contact's force is looked at."""
HEADS = ("#start [s]", "#end [s]", "#impulse [N s]", "#peak force [N]", "#closing speed [v0]")
"""Heads of the table of contacts."""


class Touch(NamedTuple):
    """A contact of an impact.

    Attributes
    ----------
    start, end
        When, since the first contact began [s].
    impulse
        Of the contact force [N s].
    peak_force
        Largest contact force [N].
    closing
        Speed at which sphere and plate meet, over that of the impact [1].
    """

    start: float
    end: float
    impulse: float
    peak_force: float
    closing: float


@dataclass(frozen=True)
class Inertia:
    """What an impact on a moving plate has beside the results of every impact.

    Attributes
    ----------
    contacts
        Every contact, the first one first.
    total_time
        From the first contact to the last release [s].
    reason
        Why the course ends there.
    modes
        How many oscillators the plate has.
    energies
        Energy left in each of them [J].
    doubt
        Relative change of each result with the number of modes [1].
    branches
        What the branches left out may change each result besides [1].
    """

    contacts: tuple[Touch, ...]
    total_time: float
    reason: str
    modes: int
    energies: tuple[float, ...]
    doubt: Results
    branches: Results

    def left(self, outputs: Sequence[str]) -> tuple[float, float]:
        """What modes and branches left out may change, the worst of some results [1]."""
        places = [OUTPUTS.index(name) for name in outputs]
        return IRREGULAR * max(self.doubt[k] for k in places), max(self.branches[k] for k in places)


@dataclass(frozen=True)
class WaveMotion(Motion):
    """An impact on a moving plate, with its course."""

    course: Course = field(kw_only=True, repr=False)
    inertia: Inertia = field(kw_only=True)
    ledger: Ledger = field(kw_only=True)

    @property
    def least(self) -> float:
        """Smallest force between two maxima of a contact, over the largest; 1 if there is none."""
        found = [1.0]
        for touching in self.course.contacts:
            times = np.linspace(touching.start, touching.end, LOOKS) * self.course.problem.T
            force = self.rows(times)[P] / self.max_force
            inner = (force[1:-1] <= force[:-2]) & (force[1:-1] < force[2:])
            found += force[1:-1][inner].tolist()
        return min(found)

    def to_json(self) -> dict[str, Any]:
        """Contacts, energies and what the modes are worth, under fixed keys."""
        inertia, ledger = self.inertia, self.ledger
        return {
            "total_time": inertia.total_time,
            "reason": inertia.reason,
            "contacts": [touch._asdict() for touch in inertia.contacts],
            "modes": inertia.modes,
            "mode_energies": list(inertia.energies),
            "change_with_modes": dict(zip(OUTPUTS, inertia.doubt, strict=True)),
            "further_branches": dict(zip(OUTPUTS, inertia.branches, strict=True)),
            "ledger": asdict(ledger) | {"closure": ledger.closure},
        }

    def lines(self) -> list[tuple[str, ...]]:
        """Start, end, impulse, peak force and closing speed of every contact."""
        return [tuple(f"{value:.6g}" for value in touch) for touch in self.inertia.contacts]

    def notes(self) -> tuple[str, ...]:
        """Where the energy went, and why the course ends, in sentences."""
        ledger, inertia = self.ledger, self.inertia
        shares = {
            "the sphere": ledger.returned,
            "the plate": ledger.plate,
            "the viscous contact": ledger.dissipated + ledger.left,
            "the closure's leak": ledger.leak,
        }
        told = ", ".join(f"{100 * e / ledger.brought:.3g} % in {n}" for n, e in shares.items() if e)
        energies = f"energy after: {told}; the ledger closes to {abs(ledger.closure):.1e}"
        ended = f"{inertia.reason} after {len(inertia.contacts)} contact(s); {inertia.modes} "
        return energies, ended + f"oscillators, half as many change it by {max(inertia.doubt):.1e}"

    def to_html(self) -> str:
        """The contacts and where the energy went, for a notebook."""
        notes = "".join(f"<p>{escape(note)}</p>" for note in self.notes())
        return html_table(HEADS, self.lines()) + notes

    _repr_html_ = to_html

    def history(self, law: Law, times: Array) -> tuple[Array, Array, Array, Array]:  # noqa: ARG002
        """Way of the sphere [m], velocity [m/s], contact radius [m] and force [N] at times [s]."""
        rows = self.rows(times)
        return rows[Z], rows[V], rows[A], rows[P]

    def rows(self, times: Array) -> Array:
        """Everything at times [s], in SI: the rows of `dynamics`, energies in J."""
        problem, t = self.course.problem, np.asarray(times, dtype=np.float64)
        found = np.zeros((LEAK + 1, t.size))
        starts = np.array([touching.start for touching in self.course.contacts])
        place = np.maximum(np.searchsorted(starts, t / problem.T, side="right") - 1, 0)
        for index in np.unique(place):
            here = place == index
            found[:, here] = _rows(problem, self.course.contacts[index], t[here] / problem.T)
        energy = problem.m * problem.v0**2
        units = np.ones(LEAK + 1)
        units[[A, V, Z, P, W, E]] = (
            problem.a, problem.v0, problem.depth, problem.force, problem.depth, energy
        )  # fmt: skip
        return found * units[:, None]

    def profiles(self, times: Array, r: Array) -> Array:
        """Deflection [m] of the plate's modes at times [s] (rows) and distances [m] (columns)."""
        problem = self.course.problem
        shapes = problem.contact.modes.shapes(r)
        found = [deflections(self.course, float(t) / problem.T) @ shapes for t in times]
        return problem.depth * np.array(found)


def deflections(course: Course, t: float) -> Array:
    """Deflection of every oscillator at the axis at a time, in units of the problem."""
    problem = course.problem
    starts = [touching.start for touching in course.contacts]
    touching = course.contacts[max(int(np.searchsorted(starts, t, side="right")) - 1, 0)]
    if t > touching.end:
        return problem.flown(touching.after, t - touching.end).q
    pieces = touching.pieces
    x = (max(t - touching.start, 0.0) + pieces[0].element.x ** ONSET) ** (1.0 / ONSET)
    index = max(int(np.searchsorted([piece.element.x for piece in pieces], x, side="right")) - 1, 0)
    before, radius = touching.before, touching.radius
    if index:
        before, radius = pieces[index - 1].end, pieces[index - 1].radius
    return oscillating(problem, pieces[index].element, before, radius, x)


def _rows(problem: Problem, touching: bounces.Touching, t: Array) -> Array:
    """The rows in a contact and in the flight after it."""
    found = np.zeros((LEAK + 1, t.size))
    pieces, inside = touching.pieces, t <= touching.end
    starts = np.array([piece.element.x for piece in pieces])
    since = np.maximum(t - touching.start, 0.0) + starts[0] ** ONSET
    x = since ** (1.0 / ONSET)
    last = pieces[-1].element.x + pieces[-1].element.length
    place = np.searchsorted(starts, x, side="right") - 1
    for index in np.unique(place[inside]):
        here = inside & (place == index)
        found[:, here] = pieces[index].element.at(np.minimum(x[here], last))
    for k in np.flatnonzero(~inside):
        state = problem.flown(touching.after, float(t[k]) - touching.end)
        found[[V, Z, W, E], k] = (
            state.velocity, state.way, float(np.sum(state.q)) + state.far,
            float(np.sum(problem.energies(state))),
        )  # fmt: skip
    found[P] = np.maximum(found[P], 0.0)
    return found
