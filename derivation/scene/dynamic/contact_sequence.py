"""Simulates an impact with plate inertia: successive contacts, and free flight between them."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from derivation.engine.activity import announce
from derivation.scene.contact_law.yielding import Yielding
from derivation.scene.dynamic.contact_errors import (
    STUCK,
    check_width,
    no_solution,
    or_quasi_static,
    too_many_steps,
)
from derivation.scene.dynamic.flight import next_contact, recovering_radius
from derivation.scene.dynamic.next_element import (
    PHASE,
    begun,
    error_and_scales,
    left_after,
    longest,
    next_length,
    solved,
)
from derivation.scene.dynamic.problem import DynamicProblem, ImpactState
from derivation.scene.dynamic.separation import last_element, released
from derivation.scene.dynamic.stretched_flight import FlightPiece, flight
from derivation.scene.dynamic.time_element import LOST, C, P, TimeElement
from derivation.scene.dynamic.yield_events import UncutError, next_branch
from derivation.scene.errors import EndlessError, IncompleteError
from derivation.scene.numerics.collocation import NEXT, ONSET

FIRST, SHORTEST = 0.3, 1e-13
"""First and smallest length of an element in x."""
TOLERANCE = 1e-11
"""Last coefficients of an element over the largest ones so far [1]."""
CLOSED = 0.25
"""Remaining over elapsed time of a contact below which its end is computed in one step, over the
power 2/5 of the tolerance: the impulse that remains falls as the power 5/2 of the time."""
SOLVED = 1e-3
"""Tolerance of Newton's iteration over that of the element, if its derivative is exact."""
CONTACTS, ELEMENTS, WORK = 100, 20_000, 3.5e7
"""Largest numbers of contacts and of computed elements of an impact, and largest work: the numbers
of elements and of evaluations in flight, weighted by the run time of each."""
PROGRESS = 50
"""Elements after which the simulation reports its progress."""
STAYS = 20.0
"""Contact time over half a period of the sphere on the plate, above which its weight is assumed to
hold it there."""
STRETCHED = 1.0
"""Work of stretching at a node, over the number of shapes and points."""
LEFT, ENOUGH = "no further contact is possible", "no further contact is needed"
"""End reasons of a complete simulation, and of one that its caller ends."""


class ContactRun(NamedTuple):
    """A contact: start and end in units of the problem, time elements, states before and after.

    `radius` is the contact radius at the start; it is above 0 if the face has not recovered from
    the last contact. The modes of the state after the contact vibrate freely; the deflection that
    recovers with a viscoelastic face is not part of them. `tried` is the number of computed
    elements, including rejected ones. `yielding` is the branch of a plastic contact at its end, and
    `flight` contains the elements of the flight after it if the plate stretches.
    """

    start: float
    end: float
    radius: float
    pieces: tuple[TimeElement, ...]
    before: ImpactState
    after: ImpactState
    tried: int
    yielding: Yielding | None = None
    flight: tuple[FlightPiece, ...] = ()


@dataclass(frozen=True)
class ImpactHistory:
    """The contacts of an impact.

    Attributes
    ----------
    reason
        Why the simulation ends.
    remedy
        Advice to make the simulation complete; empty if it is complete.
    work
        Work in the units of `WORK`; an upper bound if the simulation is incomplete.
    tolerance
        Tolerance of the time elements [1].
    endless
        Whether it is incomplete because it takes more time steps than are allowed.
    """

    problem: DynamicProblem
    contacts: tuple[ContactRun, ...]
    reason: str
    remedy: str = ""
    work: float = 0.0
    tolerance: float = TOLERANCE
    endless: bool = False

    @property
    def complete(self) -> bool:
        """Whether no further contact follows."""
        return not self.remedy


def impact_history(
    problem: DynamicProblem,
    n: int,
    tolerance: float = TOLERANCE,
    work: float = WORK,
    enough: Callable[[tuple[ContactRun, ...]], bool] | None = None,
    watch: Callable[[float], None] | None = None,
) -> ImpactHistory:
    """Simulate an impact from the first contact on, by elements of n nodes.

    Parameters
    ----------
    tolerance
        Largest ratio of the last coefficients of an element to the largest ones so far [1].
    work
        Largest work, in the units of `WORK`.
    enough
        Function of the contacts so far that returns whether no more are needed. It is called after
        1, 2, 4, ... contacts.
    watch
        Function that `contact` calls with contact radii; it may raise an error to end the
        simulation.

    Returns
    -------
    ImpactHistory
        All contacts; of an incomplete simulation, those before the one that has no end.

    Raises
    ------
    IncompleteError
        If the first contact cannot be computed to its end.
    """
    t, radius, state, runs = 0.0, 0.0, problem.begin(), list[ContactRun]()
    weight, tried, used = weight_of(problem, n), 0, 0.0
    while True:
        most = min(ELEMENTS, tried + steps_of(problem, n, work - used))
        try:
            touching = contact(problem, n, state, t, radius, tolerance, tried, most, watch)
            runs.append(touching)
            tried, used = tried + touching.tried, used + touching.tried * weight
            if enough and not len(runs) & (len(runs) - 1) and enough(tuple(runs)):
                return ImpactHistory(problem, tuple(runs), ENOUGH, "", used, tolerance)
            after, last = touching.after, touching.pieces[-1].radius
            if touching.yielding is not problem.yielding:
                problem = replace(problem, yielding=touching.yielding)
            flown = _flight(problem, n, after, last, work - used, tolerance)
            runs[-1], used = touching._replace(flight=flown.pieces), used + flown.work
            if flown.wait == math.inf or touching.end + flown.wait > problem.first_echo:
                return ImpactHistory(problem, tuple(runs), LEFT, "", used, tolerance)
            _check_count(problem, runs, touching.end + flown.wait)
        except IncompleteError as end:
            if not runs:
                raise
            why = end.why, str(end.remedy)
            endless = isinstance(end, EndlessError)
            return ImpactHistory(problem, tuple(runs), *why, work, tolerance, endless)
        t, radius = touching.end + flown.wait, flown.radius
        state = flown.end or problem.flown(after, flown.wait)
        if radius:
            state = problem.freed(state, last, flown.wait, -1.0)
        if not radius:
            state = state._replace(approach=0.0)


class FlightRun(NamedTuple):
    """A flight: its duration, contact radius at its end, and work.

    The duration is infinite if no contact follows. If the plate stretches, the flight also has
    elements, and the state at its end.
    """

    wait: float
    radius: float
    work: float
    pieces: tuple[FlightPiece, ...] = ()
    end: ImpactState | None = None


def _flight(
    problem: DynamicProblem,
    n: int,
    after: ImpactState,
    radius: float,
    work: float,
    tolerance: float,
) -> FlightRun:
    """Return the flight after a separation.

    A sphere that falls back only by its weight has left the plate: its return is another impact.
    """
    weightless = replace(problem, weight=0.0) if problem.weight else problem
    one = _flight_with(weightless, n, after, radius, work, tolerance)
    if not problem.weight or one.wait == math.inf:
        return one
    other = _flight_with(problem, n, after, radius, work - one.work, tolerance)
    return other._replace(work=one.work + other.work)


def _flight_with(
    problem: DynamicProblem,
    n: int,
    after: ImpactState,
    radius: float,
    work: float,
    tolerance: float,
) -> FlightRun:
    """Return the flight after a separation, with the weight of the problem."""
    if problem.middle_plane is None:
        return FlightRun(*next_contact(problem, after, radius, work))
    flown = flight(problem, n, after, radius, steps_of(problem, n, work), tolerance)
    wait = flown.pieces[-1].end if flown.met else math.inf
    used = len(flown.pieces) * weight_of(problem, n)
    at_end = float(recovering_radius(problem, np.array([wait]), radius)[0]) if flown.met else 0.0
    return FlightRun(wait, at_end, used, flown.pieces, flown.end)


def steps_of(problem: DynamicProblem, n: int, work: float = WORK) -> int:
    """Return how many elements of n nodes may be computed; more modes allow fewer elements."""
    return int(min(ELEMENTS, max(work, 0.0) / weight_of(problem, n)))


def weight_of(problem: DynamicProblem, n: int) -> float:
    """Return the work of an element: its run time in units of about 0.4 microseconds."""
    modes, degree = problem.contact.modes, problem.contact.degree
    each = 0.3 * modes.omega.size + (0.1 + 0.003 * degree) * modes.phi.size
    if problem.middle_plane is not None:
        each += STRETCHED * sum(problem.middle_plane.slopes.shape)
    return 2000.0 + n * each


def work_of(history: ImpactHistory) -> float:
    """Return the work of the accepted time elements, in the units of `WORK`."""
    pieces = [piece.element for touching in history.contacts for piece in touching.pieces]
    return len(pieces) * weight_of(history.problem, pieces[0].slope.size)


def expected_work(problem: DynamicProblem, n: int, coarse: ImpactHistory) -> float:
    """Return the work of an impact, estimated from a run with fewer modes.

    Its contacts are assumed to last as long. Elements are shorter only where `PHASE` limits them.
    """
    lasted = sum(touching.end - touching.start for touching in coarse.contacts)
    more, fewer = (lasted * one.fastest / PHASE for one in (problem, coarse.problem))
    nodes = coarse.contacts[0].pieces[0].element.slope.size
    others = sum(touching.tried for touching in coarse.contacts) - fewer / nodes
    return (more / n + max(0.0, others)) * weight_of(problem, n)


def least_work(history: ImpactHistory, fastest: float, count: int) -> float:
    """Return a lower bound on the work of the elements of a run with more modes, by its `PHASE`.

    Parameters
    ----------
    history
        A run with fewer modes, with an equally long time in contact.
    fastest
        Largest angular frequency of the modes [1/s].
    count
        Number of modes.
    """
    lasted = sum(touching.end - touching.start for touching in history.contacts)
    problem = history.problem
    more = weight_of(problem, 1) - weight_of(problem, 0)
    return lasted * fastest * problem.T / PHASE * more * count / problem.omega.size


def _check_count(problem: DynamicProblem, runs: list[ContactRun], t: float) -> None:
    """Raise an error if the simulation has reached the largest number of contacts."""
    if len(runs) >= CONTACTS:
        undamped = "give the damping of the plate as plate.loss_factor if it has any, "
        damped = "" if problem.damping_ratio else undamped
        raise IncompleteError(
            f"the sphere had not separated for good after {len(runs)} contacts and "
            f"{problem.T * t:.6g} s, the limit",
            f"{damped}use a thicker plate or a lighter sphere{or_quasi_static(problem)}",
        )


def contact(
    problem: DynamicProblem,
    n: int,
    begin: ImpactState,
    start: float,
    radius: float,
    tolerance: float = TOLERANCE,
    tried: int = 0,
    most: int = ELEMENTS,
    watch: Callable[[float], None] | None = None,
) -> ContactRun:
    """Simulate a contact, element by element, until the force vanishes.

    Parameters
    ----------
    radius
        Contact radius at the start: above 0 if the face has not recovered from the last contact.
    tolerance
        As for `impact_history`.
    tried, most
        Number of elements computed for earlier contacts, and the largest number in all.
    watch
        Function that is called with a radius just before the largest one of the curved plate, in
        units of the problem, when it has decreased.

    Raises
    ------
    IncompleteError
        If the contact needs more elements, or has no solution that can be found.
    """
    elements: list[TimeElement] = []
    x, length, state, first = begun(begin, radius), FIRST, begin, radius
    origin = start - x**ONSET
    # Yield events are located more closely than the tolerance of an element.
    exact = not (problem.retardation_time or problem.yielding)
    enough = max(NEXT, SOLVED * tolerance) if exact else NEXT
    closed = CLOSED * math.pow(tolerance, 0.4)
    # At the start the tolerance is relative to the expected size of each quantity.
    scale = np.full((LOST, 1), 0.1)
    for step in range(tried, most):
        if step % PROGRESS == PROGRESS - 1:
            now, count = problem.T * (origin + x**ONSET), problem.omega.size
            announce(f"{now:.3g} s after first contact, {count} modes")
        remaining = left_after(elements[-1]) if elements else math.inf
        length = min(length, longest(problem, n, x, state, remaining, tolerance))
        if length < SHORTEST * max(x, 1.0):
            break
        made = solved(problem, n, x, length, state, radius, elements[-1:], enough)
        if made is None:
            if length < STUCK * max(x, 1.0):
                break
            length *= 0.5
            continue
        error, change, largest = error_and_scales(problem, made, scale, tolerance)
        if error > tolerance:
            length *= change
            continue
        if problem.yielding is not None:
            try:
                made, problem = next_branch(problem, n, made, state, radius)
            except UncutError:
                length *= 0.5
                continue
        # A viscoelastic face separates before it is flat, and may touch the sphere again within an
        # element.
        ending = problem.retardation_time or float(made.element.rows[P].sum()) <= 0.0
        # At first the force is smaller than its error; a zero while the radius still grows is not
        # the end of the contact.
        if ending and (end := made.element.fall(P)) is not None:
            last = last_element(problem, n, made, end, state, radius, enough)
            ended = origin + (last.element.x + last.element.length) ** ONSET
            pieces = (*elements, last)
            tries = step + 1 - tried
            after = last.end
            if problem.retardation_time:
                after = problem.freed(after, last.radius, 0.0)
            return ContactRun(start, ended, first, pieces, begin, after, tries, problem.yielding)
        elements.append(made)
        x = made.element.x + made.element.length
        _check_weight(problem, x)
        if watch and made.radius < radius and len(elements) > 1:
            watch(float(elements[-2].element.rows[C].sum()))
        state, radius, scale = made.end, made.radius, largest
        check_width(problem, radius)
        length = next_length(made, x, change)
        left = left_after(made)
        near = left < closed * x**ONSET and not problem.retardation_time
        if near and (parted := released(problem, made, left)):
            more, after = parted
            ended = start + x**ONSET + more
            tries, pieces = step + 1 - tried, tuple(elements)
            return ContactRun(start, ended, first, pieces, begin, after, tries, problem.yielding)
    else:
        raise too_many_steps(problem, origin + x**ONSET, most, tolerance)
    raise no_solution(problem, state, radius, problem.T * (origin + x**ONSET))


def _check_weight(problem: DynamicProblem, x: float) -> None:
    """Raise an error if the contact lasts so long that the weight holds the sphere on the plate."""
    if not problem.weight:
        return
    swing = math.pi * math.sqrt(float(np.sum(problem.inverse_modal_mass / problem.omega**2)))
    if x**ONSET > STAYS * max(1.0, swing):
        raise IncompleteError(
            "the sphere does not rebound because its weight holds it on the plate",
            "increase impact.speed, or remove impact.gravity",
        )
