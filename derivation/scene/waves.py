"""Impact on a plate that moves: its oscillators, its contacts, and where the energy goes.

The modes up to some frequency are oscillators (see `modal`), the others follow at rest. With
twice as many the impact is computed again, and that is the result: the difference says what the
modes left out are worth. The endless plate of Zener (1941) has no modes: it yields at a speed
P/(8 sqrt(D rho H)), whatever is left of the plate's static deflection without bending.
"""

import math
from dataclasses import asdict, dataclass, field, replace
from functools import lru_cache
from html import escape
from typing import Any, NamedTuple

import numpy as np

from derivation.scene import bounces, motion
from derivation.scene.bounces import Course
from derivation.scene.dynamics import (
    LEAK,
    LOST,
    ONSET,
    A,
    E,
    P,
    Piece,
    Problem,
    State,
    V,
    W,
    Z,
    oscillating,
)
from derivation.scene.effects.effect import Array
from derivation.scene.effects.inertia import further_branches
from derivation.scene.law import Law
from derivation.scene.limits import zener_number
from derivation.scene.modal import Modes, contact_of, far_plate, modes_of
from derivation.scene.model import Model
from derivation.scene.motion import Ledger, Motion
from derivation.scene.quadrature import NODES, gauss

STAGES = 14, 16
"""Nodes of an element, of the run that checks and of the one that counts."""
PHASE = 12.5
"""omega_M That/max(1, lambda^(2/3)) of the fastest oscillator, of the run that checks."""
FEWEST, MOST = 2, 1500
"""Oscillators of the run that checks; the one that counts has twice as many."""
WIDER = 1.05
"""Radius up to which the contact is tabled, over that on a plate that does not yield."""
LOOKS = 2001
"""Times at which a contact's force is looked at."""
LOOSE = 3e-4
"""Change with the number of modes that is small enough where no tolerance is given [1]."""
INTEGRATION, ROUNDING = 1e-10, 2e-12
"""What tests hold elements and arithmetic to, beside the change with the modes [1]."""


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
        Relative change of the results with the number of modes [1].
    branches
        What branches beyond the first may change besides [1].
    """

    contacts: tuple[Touch, ...]
    total_time: float
    reason: str
    modes: int
    energies: tuple[float, ...]
    doubt: float
    branches: float


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
            "change_with_modes": inertia.doubt,
            "further_branches": inertia.branches,
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
        return energies, ended + f"oscillators, half as many change it by {inertia.doubt:.1e}"

    def to_html(self) -> str:
        """The contacts and where the energy went, for a notebook."""
        heads = "".join(f"<th>{escape(head.lstrip('#'))}</th>" for head in HEADS)
        lines = ("".join(f"<td>{cell}</td>" for cell in line) for line in self.lines())
        rows = "".join(f"<tr>{line}</tr>" for line in (heads, *lines))
        notes = "".join(f"<p>{escape(note)}</p>" for note in self.notes())
        return f"<table>{rows}</table>{notes}"

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


def goal(rtol: float | None) -> float:
    """How much the modes left out may change, of a tolerance of everything [1]."""
    return LOOSE if rtol is None else rtol / 3.0


@lru_cache(maxsize=16)
def impact(law: Law, goal: float = LOOSE) -> WaveMotion | None:
    """The impact by a law with inertia; None beyond the law's limit.

    Parameters
    ----------
    goal
        Relative change of the results with the number of modes that is small enough: while it
        is larger the modes are doubled, unless the scene says how many there are.

    Raises
    ------
    SceneError
        If a contact cannot be followed, or the sphere's weight keeps it on the plate.
    """
    quick = _quick(law)
    if quick is None:
        return None
    model = law.model
    rest = replace(law, effects=law.effects - {"inertia", "viscosity", "gravity"})
    if model.inertia.infinite_plate:
        rest, plate = replace(rest, effects=rest.effects - {"bending"}), far_plate(model)
        runs = [_run(law, rest, plate, quick, n) for n in STAGES]
        return _judged(*runs)
    count = count_of(law)
    rough = _run(law, rest, modes_of(model, count), quick, STAGES[0])
    while True:
        found = _run(law, rest, modes_of(model, 2 * count), quick, STAGES[1])
        judged, count, rough = _judged(rough, found), 2 * count, found
        if model.inertia.modes or judged.inertia.doubt <= goal or count >= MOST:
            return judged


def _quick(law: Law) -> Motion | None:
    """The impact on a plate that does not yield; None if there is none in the law's range."""
    stiff = {"hertz", "sphere_elasticity", "curvature", "gravity"}
    found = motion.impact(replace(law, effects=law.effects & stiff))
    if found is None or not all(0.0 < value < math.inf for value in found.numbers):
        return None
    return found


def prepared(law: Law) -> None:
    """Make the oscillators and tables of an impact, to see how long that takes."""
    quick = _quick(law)
    if quick is not None:
        rest = replace(law, effects=law.effects - {"inertia", "viscosity", "gravity"})
        _problem(law, rest, modes_of(law.model, 2 * count_of(law)), quick)


def _run(law: Law, rest: Law, modes: Modes, quick: Motion, n: int) -> WaveMotion:
    """The impact with given oscillators by elements of n nodes."""
    return _motion(law, bounces.course(_problem(law, rest, modes, quick), n))


def _judged(rough: WaveMotion, found: WaveMotion) -> WaveMotion:
    """A run with what it differs by from one with fewer modes."""
    pairs = zip(found.numbers, rough.numbers, strict=True)
    doubt = max(abs(new - old) / abs(new) for new, old in pairs)
    return replace(found, inertia=replace(found.inertia, doubt=doubt))


def count_of(law: Law) -> int:
    """How many oscillators the run that checks has."""
    model = law.model
    if model.inertia.modes:
        return model.inertia.modes // 2
    stiffness = 4.0 / 3.0 * law.modulus * math.sqrt(model.R)
    duration = (model.m / stiffness) ** 0.4 / model.v0**0.2
    highest = PHASE * max(1.0, zener_number(model) ** (2.0 / 3.0)) / duration
    count = FEWEST
    while count < MOST and modes_of(model, count).omega[-1] < highest:
        count = min(2 * count, MOST)
    slower = int(np.searchsorted(modes_of(model, count).omega, highest))
    return max(FEWEST, min(count, slower + 1))


def _problem(law: Law, rest: Law, modes: Modes, quick: Motion) -> Problem:
    """The scene in units of the impact on a plate that does not yield."""
    model, (a, T) = law.model, (quick.max_contact_radius, quick.contact_time)
    contact = contact_of(rest, modes, min(WIDER * a, rest.limit), model.inertia.pointwise)
    lag = model.viscous_time / T if "viscosity" in law.effects else 0.0
    return Problem(contact, a, T, model.m, model.v0, law.gravity * (T / model.v0), lag)


def _motion(law: Law, course: Course) -> WaveMotion:
    """The results of a course."""
    problem, last = course.problem, course.contacts[-1].after
    energy = problem.m * problem.v0**2
    pieces = [piece for touching in course.contacts for piece in touching.pieces]
    largest = {row: max(piece.element.largest(row) for piece in pieces) for row in (A, Z, P)}
    way = max(largest[Z], max(touching.before.way for touching in course.contacts))
    energies = problem.energies(last)
    lost, leak = (sum(_sum(piece, row) for piece in pieces) for row in (LOST, LEAK))
    endless = law.model.inertia.infinite_plate
    ledger = Ledger(
        brought=0.5 * energy,
        weight=energy * problem.weight * last.way,
        returned=0.5 * energy * last.velocity**2,
        dissipated=0.0 if endless else energy * lost,
        left=energy * sum(_given_up(problem, touching) for touching in course.contacts),
        plate=energy * (lost if endless else float(np.sum(energies))),
        leak=energy * leak,
    )
    first, total = course.contacts[0], course.contacts[-1].end
    inertia = Inertia(
        tuple(_touch(problem, touching) for touching in course.contacts),
        problem.T * total,
        course.reason,
        problem.omega.size,
        tuple((energy * energies).tolist()),
        0.0,
        _branches(law.model, problem.a * largest[A], problem.T * first.end),
    )
    return WaveMotion(
        problem.T * first.end,
        problem.depth * way,
        problem.force * largest[P],
        problem.a * largest[A],
        0.0,
        -last.velocity,
        ledger=ledger,
        course=course,
        inertia=inertia,
    )


def _branches(model: Model, a: float, T: float) -> float:
    """What the branches left out may change [1]."""
    left_out = model.inertia.branches == "A0" and not model.inertia.infinite_plate
    return further_branches(model, a, T) if left_out else 0.0


def _given_up(problem: Problem, touching: bounces.Touching) -> float:
    """Energy over m v0^2 in a contact that lags at its end, less what it found at its beginning."""
    if not problem.lag:
        return 0.0
    begun = _stored(problem, touching.radius, touching.before) if touching.radius else 0.0
    return _stored(problem, touching.pieces[-1].radius, touching.after) - begun


def _stored(problem: Problem, radius: float, state: State) -> float:
    """Energy over m v0^2 in a contact: int P dD + sum q_j (P s_j - P_j)."""
    nodes, weights = gauss(NODES[1])
    at = problem.contact.at(problem.a * radius * nodes)
    rest = problem.a * radius * float(weights @ (at.force * at.depth_a))
    end = problem.contact.at(problem.a * np.array([radius]))
    more = float((end.force * (1.0 + end.less[0]) - end.felt[0]) @ state.q)
    return rest / (problem.force * problem.depth) + more / problem.force


def _touch(problem: Problem, touching: bounces.Touching) -> Touch:
    """A contact in SI."""
    before, after = touching.before, touching.after
    lasted = touching.end - touching.start
    return Touch(
        problem.T * touching.start,
        problem.T * touching.end,
        problem.m * problem.v0 * (before.velocity - after.velocity + problem.weight * lasted),
        problem.force * max(piece.element.largest(P) for piece in touching.pieces),
        -before.opening,
    )


def _sum(piece: Piece, row: int) -> float:
    """Integral over an element of a row that is a rate by x, by Gauss' rule."""
    nodes, weights = gauss(piece.element.slope.size)
    values = piece.element.at(piece.element.x + piece.element.length * nodes)[row]
    return piece.element.length * float(weights @ values)
