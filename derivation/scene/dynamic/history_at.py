"""The state of an impact at given times, from the time elements of its contacts."""

import numpy as np
from numpy.polynomial.legendre import legvander

from derivation.scene.dynamic.contact_sequence import ContactRun, ImpactHistory
from derivation.scene.dynamic.flight import AT_ONCE
from derivation.scene.dynamic.flight_history import rows_in_flight, shapes_in_flight
from derivation.scene.dynamic.modal_response import nodes_of
from derivation.scene.dynamic.problem import DynamicProblem, ImpactState
from derivation.scene.dynamic.time_element import A, C, E, P, V, W, Z, deflections_at
from derivation.scene.numerics.collocation import ONSET, Element
from generated.arrays import Double as Array

ROUNDED = 1e-12
"""Relative difference of two times that is due to rounding [1]."""


def deflections(history: ImpactHistory, t: float) -> Array:
    """Return the deflection of each shape at the axis at a time, in units of the problem."""
    problem = history.problem
    starts = [touching.start for touching in history.contacts]
    touching = history.contacts[max(int(np.searchsorted(starts, t, side="right")) - 1, 0)]
    if t > _computed(touching):
        return _in_flight(problem, touching, t - touching.end)
    pieces = touching.pieces
    x = (max(t - touching.start, 0.0) + pieces[0].element.x ** ONSET) ** (1.0 / ONSET)
    index = max(int(np.searchsorted([piece.element.x for piece in pieces], x, side="right")) - 1, 0)
    before, radius = touching.before, touching.radius
    if index:
        before, radius = pieces[index - 1].end, pieces[index - 1].radius
    return oscillating(problem, pieces[index].element, before, radius, x)


def _in_flight(problem: DynamicProblem, touching: ContactRun, since: float) -> Array:
    """Return the deflection of each shape at a time after the separation, or just before it."""
    by_shape = problem.contact.modes.by_shape
    if touching.flight and since > 0.0:
        q = shapes_in_flight(problem, touching.flight, since)
    else:
        q = by_shape(problem.flown(touching.after, since).q)
    if problem.retardation_time:
        lagging = problem.lagging(touching.pieces[-1].radius, np.array([since]))[0][0]
        q = q + by_shape(lagging)
    return q


def oscillating(
    problem: DynamicProblem, found: Element, start: ImpactState, radius: float, x: float
) -> Array:
    """Return the deflection of each shape at x, computed as the end of a shorter element."""
    if x <= found.x:
        return problem.contact.modes.by_shape(start.q)
    length = min(x - found.x, found.length)
    nodes = nodes_of(problem, found.slope.size, found.x, length, start)
    q = deflections_at(problem, nodes, radius, found.slope_at(nodes.x))
    return np.asarray(q[-1], dtype=np.float64)


def _computed(touching: ContactRun) -> float:
    """Return the time at which the last element of a contact ends.

    From then on to its end, the force is so small that sphere and plate move as in flight.
    """
    first, last = touching.pieces[0].element, touching.pieces[-1].element
    end = touching.start + ((last.x + last.length) ** ONSET - first.x**ONSET)
    return end if end < (1.0 - ROUNDED) * touching.end else touching.end


def rows_of(problem: DynamicProblem, touching: ContactRun, t: Array) -> Array:
    """Return the rows in a contact and in the flight after it, at times in problem units."""
    found = np.zeros((C + 1, t.size))
    pieces, known = touching.pieces, _computed(touching)
    # A viscoelastic contact ends with a large radius, also at a time that rounding moves beyond its
    # end.
    inside = t <= known * (1.0 + ROUNDED)
    starts, lengths = np.array([(one.element.x, one.element.length) for one in pieces]).T
    since = np.maximum(t - touching.start, 0.0) + starts[0] ** ONSET
    x = since ** (1.0 / ONSET)
    place = np.searchsorted(starts, x, side="right") - 1
    x = np.minimum(x, starts[-1] + lengths[-1])
    s = 2.0 * (x[inside] - starts[place[inside]]) / lengths[place[inside]] - 1.0
    basis = np.zeros((t.size, pieces[0].element.slope.size))
    basis[inside] = legvander(s, basis.shape[1] - 1)
    ordered = np.flatnonzero(inside)[np.argsort(place[inside], kind="stable")]
    ends = np.flatnonzero(np.diff(place[ordered])) + 1
    for here in np.split(ordered, ends) if ordered.size else ():
        piece = pieces[place[here[0]]]
        found[:, here] = piece.element.rows @ basis[here].T
        if piece.yielding is not None:
            a = problem.a * np.maximum(found[A, here], 0.0)
            widened = piece.yielding.widened(a, problem.contact.at(a).force) / problem.a
            positive = found[A, here] > 0.0
            touched = here[positive]
            found[C, touched] *= widened[positive] / found[A, touched]
            found[A, here] = widened
    flight = np.flatnonzero(~inside)
    block, radius = max(1, AT_ONCE // max(problem.omega.size, 1)), pieces[-1].radius
    for indices in (flight[k : k + block] for k in range(0, flight.size, block)):
        flights = _flights(problem, touching, t[indices] - touching.end, radius)
        found[V, indices], found[Z, indices], found[W, indices], found[E, indices] = flights
    found[[A, P, C]] = np.maximum(found[[A, P, C]], 0.0)
    ending = ~inside & (t < touching.end)
    if np.any(ending):  # the square of the radius vanishes linearly
        left = (touching.end - t[ending]) / (touching.end - known)
        start = rows_of(problem, touching, np.array([known]))
        found[A, ending], found[C, ending] = start[A] * np.sqrt(left), start[C] * np.sqrt(left)
        found[P, ending] = start[P] * left**1.5
    if not touching.radius:  # exact, without the rounding error of the polynomial
        found[np.ix_([A, C], t == touching.start)] = 0.0
    return found


def _flights(problem: DynamicProblem, touching: ContactRun, t: Array, radius: float) -> Array:
    """Return velocity, displacement, plate deflection and energy at times after the separation.

    Times before it belong to the last part of a contact, in which the force is very small. If the
    plate stretches, the energy does not include that of a viscoelastic face that recovers.
    """
    flights = problem.flights(touching.after, t, radius)
    if problem.middle_plane is None:
        return flights
    at = problem.contact.modes.by_shape(touching.after.q)
    flights[3] += problem.middle_plane.energy(at)
    after = t > 0.0
    if touching.flight and np.any(after):
        flights[:, after] = rows_in_flight(problem, touching.flight, t[after])
        if problem.retardation_time:
            lagging = problem.lagging(radius, t[after])[0]
            flights[2, after] += np.sum(lagging, axis=1)
    return flights
