"""Where a contact begins or ceases to yield: time elements end there, another branch follows."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

import numpy as np
from numpy.polynomial.legendre import legder, legroots, legval

from derivation.scene.collocation import Element, radau
from derivation.scene.dynamic_problem import DynamicProblem, ImpactState
from derivation.scene.effects.effect import Array
from derivation.scene.time_element import A, TimeElement, element
from derivation.scene.yielding import Yielding

Made = TypeVar("Made")

_TRIES, _CLOSE, _NEAR = 6, 1e-13, 1e-9
"""How often an element is made anew to end at an event; distance from the event, over its length,
that is sought, and that is enough."""
_REAL, _BEGUN, _BEYOND = 1e-7, 1e-9, 1.05
"""Imaginary part that is rounding; how far from its start an element's event is, and how far beyond
its end one is looked for when it has been cut, in its variable on [-1, 1]."""


class UncutError(ArithmeticError):
    """An element could not be made to end at its event; a shorter one is needed."""


def next_branch(
    problem: DynamicProblem, n: int, made: TimeElement, start: ImpactState, radius: float
) -> tuple[TimeElement, DynamicProblem]:
    """Return the element, cut at its first event, and the problem on the branch after it.

    Raises
    ------
    UncutError
        As `cut` does.
    """
    branch, x = problem.yielding, made.element.x
    assert branch is not None

    def shorter(length: float, guess: Array) -> TimeElement | None:
        return element(problem, n, x, length, start, radius, guess)

    found = cut(branch, problem.a, made, lambda made: made.element, shorter)
    if found is None:
        return made, problem
    a = problem.a * found.radius
    after = branch_after(branch, a, float(problem.contact.at(np.array([a])).force[0]))
    sunk = (after.dent - branch.dent) / problem.depth
    end = found.end._replace(approach=found.end.approach - sunk)
    return found._replace(end=end), replace(problem, yielding=after)


def cut(
    branch: Yielding,
    unit: float,
    made: Made,
    element_of: Callable[[Made], Element],
    shorter: Callable[[float, Array], Made | None],
) -> Made | None:
    """What an element was made into, made anew so that it ends at its first event.

    A contact that does not yield begins to where its radius exceeds the end of its branch; one
    that yields ceases to where its radius is largest.

    Parameters
    ----------
    unit
        Unit of the radii [m].
    element_of
        The element of what is made.
    shorter
        Makes it anew, of a length, from a guess of the slope at its nodes.

    Returns
    -------
    Made or None
        None if there is no event.

    Raises
    ------
    UncutError
        If no element that ends at the event is found.
    """
    first = element_of(made)
    place, nodes = _event(branch, unit, first, 1.0), radau(first.slope.size).x
    if place is None:
        return None
    off = math.inf
    for _ in range(_TRIES):
        length = place - first.x
        remade = shorter(length, element_of(made).slope_at(first.x + length * nodes))
        if remade is None:
            raise UncutError
        made, again = remade, _event(branch, unit, element_of(remade), _BEYOND)
        off = 0.0 if again is None else abs(again - place) / length
        if again is None or off <= _CLOSE:
            break
        place = again
    if off > _NEAR:
        raise UncutError
    return made


def branch_after(branch: Yielding, a: float, force: float) -> Yielding:
    """The branch after an event at a radius of the law [m] and its force [N]."""
    return branch.turned(a, force) if branch.loading else branch.begun()


def _event(branch: Yielding, unit: float, found: Element, last: float) -> float | None:
    """Where the first event of an element is, looked for up to `last` on its [-1, 1]."""
    # What grows through zero at an event: -da/dx, or the radius less that at the branch's end.
    rising = -found.slope if branch.loading else found.rows[A].copy()
    if not branch.loading:
        rising[0] -= branch.end / unit
    if float(np.sum(np.abs(rising[1:]))) < -float(rising[0]):  # below zero on [-1, 1]
        return None
    roots = legroots(rising)
    real = np.sort(roots.real[np.abs(roots.imag) < _REAL])
    inside = real[(real > _BEGUN - 1.0) & (real <= last)]
    grows = inside[legval(inside, legder(rising)) > 0.0]
    return None if not grows.size else found.x + found.length * (1.0 + float(grows[0])) / 2.0
