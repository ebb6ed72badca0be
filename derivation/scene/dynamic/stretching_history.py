"""Forces of stretching and tension of the middle plane over time, from the time elements."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import legvander

from derivation.scene.dynamic.contact_sequence import ContactRun, ImpactHistory
from derivation.scene.dynamic.stretched_flight import BEGIN
from derivation.scene.dynamic.time_element import TimeElement
from derivation.scene.numerics.collocation import ONSET
from generated.arrays import Double as Array


class StretchingHistory(NamedTuple):
    """Force on each shape that stretches the plate [N], and tension on the axis [N/m], at times."""

    pull: Array
    tension: Array


class _Piece(NamedTuple):
    """An element, its start in time, and what is added to a time to obtain that of the element."""

    start: float
    shift: float
    element: TimeElement


def stretching_history(history: ImpactHistory, times: Array) -> StretchingHistory:
    """Return forces and tension of a plate that stretches at times [s] since first contact.

    Between two elements and after the last one they are those at the end of the one before.
    """
    problem = history.problem
    plane = problem.middle_plane
    assert plane is not None
    pieces = [piece for touching in history.contacts for piece in _pieces(touching)]
    elements = [piece.element.element for piece in pieces]
    t = times / problem.T
    place = np.searchsorted([piece.start for piece in pieces], t, side="right") - 1
    x = np.maximum(t + np.array([piece.shift for piece in pieces])[place], 0.0) ** (1.0 / ONSET)
    starts, lengths = np.array([(one.x, one.length) for one in elements]).T
    s = np.minimum(2.0 * (x - starts[place]) / lengths[place] - 1.0, 1.0)
    basis = legvander(s, elements[0].slope.size - 1)
    pull, tension = np.zeros((t.size, plane.slopes.shape[0])), np.zeros(t.size)
    for index in sorted(set(place[place >= 0].tolist())):
        here, stretched = place == index, pieces[index].element.stretched
        assert stretched is not None
        pull[here] = problem.force * (basis[here] @ stretched.pull)
        tension[here] = basis[here] @ stretched.tension
    return StretchingHistory(pull, tension)


def _pieces(touching: ContactRun) -> Iterator[_Piece]:
    """Yield the elements of a contact and of the flight after it, in order."""
    shift = touching.pieces[0].element.x ** ONSET - touching.start
    for piece in touching.pieces:
        yield _Piece(piece.element.x**ONSET - shift, shift, piece)
    for flown in touching.flight:
        yield _Piece(touching.end + flown.since, BEGIN - touching.end, flown.made)
