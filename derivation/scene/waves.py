"""Impact on a plate that moves: its oscillators, its contacts, and where the energy goes.

The modes up to some frequency are oscillators (see `modal`), the others follow at rest. With
twice as many the impact is computed again, and that is the result: the difference says what the
modes left out are worth. The endless plate of Zener (1941) has no modes: it yields at a speed
P/(8 sqrt(D rho H)), whatever is left of the plate's static deflection without bending.
"""

import math
from dataclasses import replace
from functools import lru_cache

import numpy as np

from derivation.scene import bounces, motion
from derivation.scene.bounces import Course
from derivation.scene.dynamics import (
    LEAK,
    LOST,
    A,
    P,
    Piece,
    Problem,
    State,
    Z,
)
from derivation.scene.effects.effect import Results
from derivation.scene.effects.inertia import WIDER, further_branches, weight_share
from derivation.scene.law import Law
from derivation.scene.limits import zener_number
from derivation.scene.modal import MANY, Modes, contact_of, far_plate, modes_of
from derivation.scene.motion import Ledger, Motion
from derivation.scene.quadrature import NODES, gauss
from derivation.scene.scene import OUTPUTS
from derivation.scene.wave_motion import Inertia, Touch, WaveMotion

STAGES = 14, 16
"""Nodes of an element, of the run that checks and of the one that counts."""
PHASE = 12.5
"""omega_M That/max(1, lambda^(2/3)) of the fastest oscillator, of the run that checks."""
FEWEST, MOST = 2, 750
"""Modes of the run that checks, to begin with; the one that counts has twice as many."""
LOOSE, SHARE = 3e-4, 1.0 / 3.0
"""Change with the number of modes that is small enough: where no tolerance is given [1], and of
one that is given."""
NONE: Results = (0.0, 0.0, 0.0, 0.0, 0.0)
INTEGRATION, ROUNDING = 1e-10, 2e-12
"""What tests hold elements and arithmetic to, beside the change with the modes [1]."""


def goal(rtol: float | None) -> float:
    """How much the modes left out may change, of a tolerance of everything [1]."""
    return LOOSE if rtol is None else SHARE * rtol


@lru_cache(maxsize=4)
def impact(law: Law, goal: float = LOOSE, outputs: tuple[str, ...] = OUTPUTS) -> WaveMotion | None:
    """The impact by a law with inertia; None beyond the law's limit.

    Parameters
    ----------
    goal
        Relative change of the results with the number of modes that is small enough: while it
        is larger the modes are doubled, unless the scene says how many there are. Where branches
        left out are worth more than modes could mend, a tenth of that is small enough.
    outputs
        The results that it applies to.

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
    lagging = "viscosity" in law.effects
    rough = _run(law, rest, modes_of(model, count, lagging), quick, STAGES[0])
    while True:
        found = _run(law, rest, modes_of(model, 2 * count, lagging), quick, STAGES[1])
        judged, count, rough = _judged(rough, found), 2 * count, found
        doubt, beyond = judged.inertia.left(outputs)
        enough = goal if beyond <= goal / SHARE else max(goal, 0.1 * beyond)
        # Of all branches there are four times as many up to twice the frequency.
        next_ = (4 if model.inertia.branches == "all" else 2) * judged.inertia.modes
        if model.inertia.modes or doubt <= enough or next_ > MANY:
            return judged


def _quick(law: Law) -> Motion | None:
    """The impact on a plate that does not yield; None if there is none in the law's range."""
    stiff = {"hertz", "sphere_elasticity", "curvature", "gravity"}
    found = motion.impact(replace(law, effects=law.effects & stiff))
    if found is None or not all(0.0 < value < math.inf for value in found.numbers):
        return None
    return found


def problem_of(law: Law, count: int) -> Problem | None:
    """An impact with so many bending modes, to be followed by `bounces`; None as of `impact`."""
    quick = _quick(law)
    if quick is None:
        return None
    rest = replace(law, effects=law.effects - {"inertia", "viscosity", "gravity"})
    return _problem(law, rest, modes_of(law.model, count, "viscosity" in law.effects), quick)


def _run(law: Law, rest: Law, modes: Modes, quick: Motion, n: int) -> WaveMotion:
    """The impact with given oscillators by elements of n nodes."""
    return _motion(law, bounces.course(_problem(law, rest, modes, quick), n))


def _judged(rough: WaveMotion, found: WaveMotion) -> WaveMotion:
    """A run with what it differs by from one with fewer modes."""
    pairs = zip(found.numbers, rough.numbers, strict=True)
    time, depth, force, radius, speed = (abs(new - old) / abs(new) for new, old in pairs)
    doubt = time, depth, force, radius, speed
    return replace(found, inertia=replace(found.inertia, doubt=doubt))


@lru_cache(maxsize=64)
def count_of(law: Law) -> int:
    """How many oscillators the run that checks has."""
    model = law.model
    if model.inertia.modes:
        return model.inertia.modes // 2
    highest = _highest(law)
    # Modes are counted by their bending: of all branches there are far more oscillators.
    model = replace(model, inertia=replace(model.inertia, branches="A0"))
    count = FEWEST
    while count < MOST and modes_of(model, count).omega[-1] < highest:
        count = min(2 * count, MOST)
    slower = int(np.searchsorted(modes_of(model, count).omega, highest))
    return max(FEWEST, min(count, slower + 1))


def _highest(law: Law) -> float:
    """Angular frequency [1/s] of the fastest oscillator of the run that checks."""
    model = law.model
    stiffness = 4.0 / 3.0 * law.modulus * math.sqrt(model.R)
    duration = math.pow(model.m / stiffness, 0.4) / math.pow(model.v0, 0.2)
    return PHASE * max(1.0, math.pow(zener_number(model), 2.0 / 3.0)) / duration


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
        NONE,
        _branches(law, problem, problem.a * largest[A], problem.depth * way, problem.T * first.end),
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


def _branches(law: Law, problem: Problem, a: float, way: float, T: float) -> Results:
    """What the branches left out may change in each result [1]: also of all, those too fast.

    Where there is a weight, all but the way change by more.
    """
    model = law.model
    if model.inertia.infinite_plate:
        return NONE
    share, heavier = 1.0, 1.0 + weight_share(model, way)
    if model.inertia.branches == "all":
        share = min(1.0, _highest(law) / float(np.max(problem.contact.modes.omega)))
    time, depth, force, radius, speed = (share * x for x in further_branches(model, a, T))
    return heavier * time, depth, heavier * force, heavier * radius, heavier * speed


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
