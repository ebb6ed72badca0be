"""Motion and energy of sphere and plate in flights over a plate that stretches."""

import numpy as np

from derivation.scene.dynamic.problem import DynamicProblem
from derivation.scene.dynamic.stretched_flight import BEGIN, FlightPiece, FlightProblem
from derivation.scene.dynamic.time_element import DAMPED, E, V, W, Z, free_element, integral
from derivation.scene.numerics.collocation import ONSET
from generated.arrays import Double as Array


def rows_in_flight(problem: DynamicProblem, pieces: tuple[FlightPiece, ...], t: Array) -> Array:
    """Return velocity, displacement, deflection and energy of the plate at times after separation.

    Shape (4, times); times after the last element count as its end.
    """
    parts, found = FlightProblem(problem), np.empty((4, t.size))
    t = np.minimum(t, pieces[-1].end)
    place = np.searchsorted([piece.since for piece in pieces], t, side="right") - 1
    place = np.maximum(place, 0)
    for index in sorted(set(place.tolist())):
        here, piece = place == index, pieces[index]
        x = (t[here] + BEGIN) ** (1.0 / ONSET)
        found[:, here] = piece.made.element.at(x)[[V, Z, W, E]]
        others = parts.split(piece.start)[1]
        if others.q.size:
            found[2:, here] += parts.others.flights(others, t[here] - piece.since, 0.0)[2:]
    return found


def shapes_in_flight(problem: DynamicProblem, pieces: tuple[FlightPiece, ...], t: float) -> Array:
    """Return the deflection of each shape at a time after separation."""
    parts = FlightProblem(problem)
    index = int(np.searchsorted([piece.since for piece in pieces], t, side="right")) - 1
    piece = pieces[max(index, 0)]
    own, others = parts.split(piece.start)
    x, n = piece.made.element.x, piece.made.element.slope.size
    length = min((t + BEGIN) ** (1.0 / ONSET) - x, piece.made.element.length)
    if length <= 0.0:
        return problem.contact.modes.by_shape(piece.start.q)
    found = free_element(parts.stretched, n, x, length, own)
    assert found is not None  # the longer element, of which this one is a part, has a solution
    rest = parts.others.flown(others, t - piece.since).q
    return problem.contact.modes.by_shape(parts.together(found[2].q[-1], rest))


def energy_lost(problem: DynamicProblem, pieces: tuple[FlightPiece, ...]) -> float:
    """Return the energy that damping dissipates in a flight, in units of m v0^2."""
    parts = FlightProblem(problem)
    return sum(
        integral(piece.made, DAMPED)
        + parts.others.flight_loss(parts.split(piece.start)[1], piece.end - piece.since)
        for piece in pieces
    )
