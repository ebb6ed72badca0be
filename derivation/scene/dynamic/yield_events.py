"""Events at which a contact begins or ceases to yield: time elements end at them."""

from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

import numpy as np
from numpy.polynomial.legendre import legder, legroots, legtrim, legval

from derivation.scene.contact_law.yielding import Yielding
from derivation.scene.dynamic.problem import DynamicProblem, ImpactState
from derivation.scene.dynamic.time_element import A, TimeElement, element
from derivation.scene.numerics.collocation import Element, radau
from generated.arrays import Double as Array

Made = TypeVar("Made")

_TRIES, _CLOSE, _NEAR = 6, 1e-13, 1e-9
"""Largest number of attempts to end an element at an event; intended and largest accepted distance
from the event over the length of the element."""
_SAME = 1e-13
"""Relative change of the radius between the end of an element and its event for which the distance
from the event has no effect."""
_HIGHER = 3e-13
"""Relative excess of the radius over the end of its branch that is due to rounding."""
_ROUNDING = 1e-15
"""Size of coefficients that are rounding errors, over the largest coefficient."""
_REAL, _BEGUN, _BEYOND = 1e-7, 1e-9, 1.05
"""Largest imaginary part due to rounding; smallest distance of an event from the start of an
element, and end of the search in a shortened element, in its variable on [-1, 1]."""


class UncutError(ArithmeticError):
    """The error of an element that cannot be shortened so that it ends at its event."""


def next_branch(
    problem: DynamicProblem, n: int, made: TimeElement, start: ImpactState, radius: float
) -> tuple[TimeElement, DynamicProblem]:
    """Return the element, shortened to its first event, and the problem on the next branch.

    Raises
    ------
    UncutError
        As `cut` does.
    """
    branch, x = problem.yielding, made.element.x
    assert branch is not None

    def shorter(length: float, guess: Array) -> TimeElement | None:
        return element(problem, n, x, length, start, radius, guess)

    result = cut(branch, problem.a, made, lambda made: made.element, shorter)
    if result is None:
        return made, problem
    a = problem.a * result.radius
    after = branch_after(branch, a, float(problem.contact.at(np.array([a])).force[0]))
    sunk = (after.dent - branch.dent) / problem.depth
    end = result.end._replace(approach=result.end.approach - sunk)
    return result._replace(end=end), replace(problem, yielding=after)


def turned(problem: DynamicProblem, radius: float) -> DynamicProblem:
    """Return the problem on the branch of unloading that begins at a radius, in its unit."""
    branch = problem.yielding
    if branch is None or not branch.loading or not radius:
        return problem
    force = problem.contact.at(np.array([problem.a * radius])).force[0]
    return replace(problem, yielding=branch.turned(problem.a * radius, float(force)))


def cut(
    branch: Yielding,
    unit: float,
    made: Made,
    element_of: Callable[[Made], Element],
    shorter: Callable[[float, Array], Made | None],
) -> Made | None:
    """Return an element, shortened so that it ends at its first event; None without an event.

    A contact begins to yield where its radius exceeds the end of its branch, and ceases to yield
    where its radius is largest.

    Parameters
    ----------
    branch
        The branch of the element.
    unit
        Unit of the radii [m].
    made
        The element with its results.
    element_of
        Function that returns the element from `made`.
    shorter
        Function that computes the element with another length, from a guess of the slope at its
        nodes; None without convergence.

    Raises
    ------
    UncutError
        If no element that ends at the event is found.
    """
    first = element_of(made)
    position, nodes = _event(branch, unit, first, 1.0), radau(first.slope.size).x
    if position is None:
        return None
    close = False
    for _ in range(_TRIES):
        length = position - first.x
        remade = shorter(length, element_of(made).slope_at(first.x + length * nodes))
        if remade is None:
            raise UncutError
        made, again = remade, _event(branch, unit, element_of(remade), _BEYOND)
        if again is None:
            return made
        off = abs(again - position) / length
        # At its maximum the radius hardly depends on the position, which rounding changes.
        close = off <= _NEAR or _radius_change(element_of(made), again) <= _SAME
        if off <= _CLOSE:
            break
        position = again
    if not close:
        raise UncutError
    return made


def _radius_change(element: Element, x: float) -> float:
    """Return the relative change of the radius from the end of an element to a place nearby."""
    radius = legval([1.0, 2.0 * (x - element.x) / element.length - 1.0], element.rows[A])
    return abs(float(radius[1] / radius[0]) - 1.0)


def branch_after(branch: Yielding, a: float, force: float) -> Yielding:
    """Return the branch after an event at a radius of the elastic law [m] and its force [N]."""
    return branch.turned(a, force) if branch.loading else branch.begun()


def _event(branch: Yielding, unit: float, element: Element, last: float) -> float | None:
    """Return x of the first event of an element up to `last` on [-1, 1]; None without one."""
    # At an event -da/dx, or the radius less that at the end of the branch, increases through zero.
    rising = -element.slope if branch.loading else element.rows[A].copy()
    if not branch.loading:
        rising[0] -= branch.end * (1.0 + _HIGHER) / unit
    below = float(np.sum(np.abs(rising[1:]))) < -float(rising[0])  # zero, on [-1, 1]
    if below and last <= 1.0:
        return None
    # Coefficients that are rounding errors would make the roots of the companion matrix inaccurate.
    rising = legtrim(rising, _ROUNDING * float(np.max(np.abs(rising))))
    roots = legroots(rising)
    real = np.sort(roots.real[np.abs(roots.imag) < _REAL])
    inside = real[(real > _BEGUN - 1.0) & (real <= last)]
    grows = inside[legval(inside, legder(rising)) > 0.0]
    return None if not grows.size else element.x + element.length * (1.0 + float(grows[0])) / 2.0
