"""Where a contact begins or ceases to yield: time elements end there, another branch follows."""

from dataclasses import replace

import numpy as np
from numpy.polynomial.legendre import legder, legroots, legval

from derivation.scene.collocation import Element, radau
from derivation.scene.time_element import A, DynamicProblem, ImpactState, TimeElement, element

_TRIES, _CLOSE = 6, 1e-13
"""How often an element is made anew to end at an event, and how near it ends, over its length."""
_REAL, _BEGUN, _BEYOND = 1e-7, 1e-9, 1.05
"""Imaginary part that is rounding; how far from its start an element's event is, and how far beyond
its end one is looked for when it has been cut, in its variable on [-1, 1]."""


def next_branch(
    problem: DynamicProblem, n: int, made: TimeElement, start: ImpactState, radius: float
) -> tuple[TimeElement, DynamicProblem]:
    """The element, cut at its first event, and the problem on the branch after it.

    A contact that does not yield begins to where its radius exceeds the end of its branch; one
    that yields ceases to where its radius is largest.
    """
    place = _event(problem, made.element, 1.0)
    if place is None:
        return made, problem
    x = made.element.x
    for _ in range(_TRIES):
        guess = made.element.slope_at(x + (place - x) * radau(n).x)
        cut = element(problem, n, x, place - x, start, radius, guess)
        if cut is None:
            break
        made = cut
        again = _event(problem, made.element, _BEYOND)
        if again is None or abs(again - place) <= _CLOSE * made.element.length:
            break
        place = again
    branch = problem.yielding
    assert branch is not None
    if not branch.loading:
        return made, replace(problem, yielding=branch.begun())
    a = problem.a * made.radius
    turned = branch.turned(a, float(problem.contact.at(np.array([a])).force[0]))
    sunk = (turned.dent - branch.dent) / problem.depth
    end = made.end._replace(approach=made.end.approach - sunk)
    return made._replace(end=end), replace(problem, yielding=turned)


def _event(problem: DynamicProblem, found: Element, last: float) -> float | None:
    """Where the first event of an element is, looked for up to `last` on its [-1, 1]."""
    branch = problem.yielding
    assert branch is not None
    # What grows through zero at an event: -da/dx, or the radius less that at the branch's end.
    rising = -found.slope if branch.loading else found.rows[A].copy()
    if not branch.loading:
        rising[0] -= branch.end / problem.a
    if float(np.sum(np.abs(rising[1:]))) < -float(rising[0]):  # below zero on [-1, 1]
        return None
    roots = legroots(rising)
    real = np.sort(roots.real[np.abs(roots.imag) < _REAL])
    inside = real[(real > _BEGUN - 1.0) & (real <= last)]
    grows = inside[legval(inside, legder(rising)) > 0.0]
    return None if not grows.size else found.x + found.length * (1.0 + float(grows[0])) / 2.0
