"""A sphere on a plate with inertia: contact after contact, and free flight between them."""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from derivation.engine.activity import announce
from derivation.scene.collocation import NEWTON, NEXT, ONSET, change_of_length, radau
from derivation.scene.dynamic_problem import DynamicProblem, ImpactState
from derivation.scene.effects.effect import Array
from derivation.scene.effects.inertia import WIDER
from derivation.scene.flight import meeting
from derivation.scene.scene import IncompleteError
from derivation.scene.time_element import LOST, A, P, TimeElement, element
from derivation.scene.yield_events import UncutError, next_branch
from derivation.scene.yielding import Yielding

FIRST, LONGEST, SHORTEST = 0.3, 0.3, 1e-13
"""First, largest and least length of an element in x."""
EARLY = 0.5
"""How much faster elements may grow while they begin about at the onset."""
TOLERANCE = 1e-11
"""An element's last coefficients over the largest there are."""
PHASE = 0.75
"""Largest phase of an oscillator over an element, for each of its nodes."""
CLOSED = 1e-5
"""What is left of a contact when its end is taken in one step, over the time it took."""
TOWARDS = 0.75
"""How much of what is left of a contact an element may take."""
OWN = 1e3
"""How much less exact the radius may be beside the largest of its element."""
SOLVED = 1e-3
"""Tolerance of Newton's iteration over that of the element, where its slope is exact."""
ROUGH = 1e2
"""How much less exact the force of a viscoelastic contact may be."""
CONTACTS, ELEMENTS, WORK = 100, 20_000, 3e7
"""How many contacts of an impact are followed, how many elements are tried in all, with how much
work: elements and looks in flight weighted by the time that each takes."""
TOLD = 50
"""Elements after which the simulation reports its progress."""
SHARP = 0.05
"""How much of the slope of the gap is left where the plate is nearly as curved as the sphere."""
STAYS = 20.0
"""Contact time over half a swing on the resting plate from which a sphere is held to stay."""
LEFT = "no further contact is possible"
"""Why a simulation ends."""


class ContactRun(NamedTuple):
    """A contact: when it began and ended, in units of the problem, its elements and states.

    `radius` is that at its beginning, not 0 where the face has not recovered from the last one.
    `tried` counts its elements, those too that were tried and made shorter. `yielding` is the
    branch of a contact that yields at its end.
    """

    start: float
    end: float
    radius: float
    pieces: tuple[TimeElement, ...]
    before: ImpactState
    after: ImpactState
    tried: int
    yielding: Yielding | None = None


@dataclass(frozen=True)
class ImpactHistory:
    """The contacts of an impact.

    Attributes
    ----------
    reason
        Why the simulation ends.
    remedy
        What to change so that it ends when the sphere has separated for good; empty if it does.
    work
        What it took, in the units of `WORK`; if it is incomplete at most this.
    tolerance
        Tolerance of its elements [1].
    """

    problem: DynamicProblem
    contacts: tuple[ContactRun, ...]
    reason: str
    remedy: str = ""
    work: float = 0.0
    tolerance: float = TOLERANCE

    @property
    def complete(self) -> bool:
        """Whether the sphere has left the plate for good."""
        return not self.remedy


def impact_history(
    problem: DynamicProblem,
    n: int,
    tolerance: float = TOLERANCE,
    work: float = WORK,
    first: ContactRun | None = None,
) -> ImpactHistory:
    """Simulate an impact from the first contact on, by elements of n nodes.

    Parameters
    ----------
    tolerance
        Of an element's last coefficients over the largest there are [1].
    work
        What it may take.
    first
        The first contact, if it is known.

    Returns
    -------
    ImpactHistory
        All contacts; those before, if one is not followed to its end.

    Raises
    ------
    IncompleteError
        If the first contact is not followed to its end.
    """
    t, radius, state, found = 0.0, 0.0, problem.begin(), list[ContactRun]()
    weight, tried, used = weight_of(problem, n), 0, 0.0
    while True:
        most = min(ELEMENTS, tried + steps_of(problem, n, work - used))
        try:
            touching = first or contact(problem, n, state, t, radius, tolerance, tried, most)
            first = None
            found.append(touching)
            tried, used = tried + touching.tried, used + touching.tried * weight
            after, last = touching.after, touching.pieces[-1].radius
            if touching.yielding is not problem.yielding:
                problem = replace(problem, yielding=touching.yielding)
            # A sphere that would come back only by its weight has left: that is another impact.
            weightless = replace(problem, weight=0.0) if problem.weight else problem
            wait, radius, looks = meeting(weightless, after, last, work - used)
            used += looks
            if problem.weight and wait < math.inf:
                wait, radius, looks = meeting(problem, after, last, work - used)
                used += looks
            if wait == math.inf or touching.end + wait > problem.heard:
                return ImpactHistory(problem, tuple(found), LEFT, "", used, tolerance)
            _check_count(problem, found, touching.end + wait)
        except IncompleteError as end:
            if not found:
                raise
            return ImpactHistory(problem, tuple(found), end.why, end.remedy, work, tolerance)
        t, state = touching.end + wait, problem.flown(after, wait)
        if not radius:
            state = state._replace(approach=0.0)


def steps_of(problem: DynamicProblem, n: int, work: float = WORK) -> int:
    """Elements of n nodes that may be tried: fewer, the more oscillators each has."""
    return int(min(ELEMENTS, max(work, 0.0) / weight_of(problem, n)))


def weight_of(problem: DynamicProblem, n: int) -> float:
    """Time that an element takes, in units of which two to three million pass in a second."""
    modes, degree = problem.contact.modes, problem.contact.degree
    each = 0.3 * modes.omega.size + (0.1 + 0.003 * degree) * modes.phi.size
    return 2000.0 + n * each


def expected_work(problem: DynamicProblem, n: int, coarse: ImpactHistory) -> float:
    """Return the work of an impact, estimated from a run with fewer modes.

    Its contacts are assumed to last as long. Elements are shorter only where `PHASE` limits them.
    """
    lasted = sum(touching.end - touching.start for touching in coarse.contacts)
    more, fewer = (lasted * some.fastest / PHASE for some in (problem, coarse.problem))
    others = sum(touching.tried for touching in coarse.contacts) - fewer / n
    return (more / n + max(0.0, others)) * weight_of(problem, n)


def _check_count(problem: DynamicProblem, found: list[ContactRun], t: float) -> None:
    """End a simulation that has as many contacts as are followed."""
    if len(found) >= CONTACTS:
        raise IncompleteError(
            f"the sphere had not separated for good after {len(found)} contacts and "
            f"{problem.T * t:.6g} s, the limit",
            "use a thicker plate or a lighter sphere, or set effects.inertia = false for a "
            "quasi-static plate",
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
) -> ContactRun:
    """A contact, element by element, until the force is gone.

    Parameters
    ----------
    radius
        At its beginning: above 0 where the face has not recovered from the contact before.
    tolerance
        As `impact_history` takes it.
    tried, most
        Elements that contacts before it tried, and how many may be tried in all.

    Raises
    ------
    IncompleteError
        If it takes more elements, or cannot be followed.
    """
    found: list[TimeElement] = []
    x, length, state, first = _begun(begin, radius), FIRST, begin, radius
    origin = start - x**ONSET
    # Events of a contact that yields are looked for more closely than elements are exact.
    exact = not (problem.retardation_time or problem.yielding)
    enough = max(NEXT, SOLVED * tolerance) if exact else NEXT
    # Before a quantity has grown, what counts is how large it will be.
    scale = np.full((LOST, 1), 0.1)
    for step in range(tried, most):
        if step % TOLD == TOLD - 1:
            now, count = problem.T * (origin + x**ONSET), problem.omega.size
            announce(f"{now:.3g} s after first contact, {count} oscillators")
        length = min(length, _longest(problem, n, x, state if found else None))
        if length < SHORTEST * max(x, 1.0):
            break
        if found:
            guess = found[-1].element.slope_beyond(A, x + length * radau(n).x)
        else:
            guess = np.zeros(n) if first else _onset(problem, n, length, -begin.separation_speed)
        made = element(problem, n, x, length, state, radius, guess, enough)
        if made is None and found:  # an oscillating slope is no guess beyond its own element
            made = element(problem, n, x, length, state, radius, np.zeros(n), enough)
        if made is None:
            length *= 0.5
            continue
        sizes = np.abs(made.element.rows[:LOST])
        largest = np.maximum(scale, sizes.max(axis=1, keepdims=True))
        unit = largest.copy()
        # Where the contact closes its radius matters beside itself: it says when.
        unit[A] = OWN * sizes[A].max()
        # A force that depends on the rate of the radius is as rough as that; it is only integrated.
        if problem.retardation_time:
            unit[P] *= ROUGH
        error, change = change_of_length((sizes / unit).max(axis=0), tolerance)
        if error > tolerance:
            length *= change
            continue
        if problem.yielding is not None:
            try:
                made, problem = next_branch(problem, n, made, state, radius)
            except UncutError:
                length *= 0.5
                continue
        # A viscoelastic contact separates before it is flat, and may meet again within an element.
        ending = problem.retardation_time or float(made.element.rows[P].sum()) <= 0.0
        if ending and (end := made.element.fall(P)) is not None:
            last = _let_go(problem, n, made, end, state, radius, enough)
            ended = origin + (last.element.x + last.element.length) ** ONSET
            pieces = (*found, last)
            tries = step + 1 - tried
            return ContactRun(start, ended, first, pieces, begin, last.end, tries, problem.yielding)
        found.append(made)
        x = made.element.x + made.element.length
        _check_weight(problem, x)
        state, radius, scale = made.end, made.radius, largest
        # What limits it is even in time, but for the onset.
        more = x**ONSET - made.element.x**ONSET
        more *= change * (1.0 + EARLY * more / x**ONSET)
        length = min(LONGEST, (x**ONSET + more) ** (1.0 / ONSET) - x)
        left = _left(state)
        if left < CLOSED * x**ONSET and not problem.retardation_time:
            more, after = _released(problem, made, left)
            ended = start + x**ONSET + more
            tries, pieces = step + 1 - tried, tuple(found)
            return ContactRun(start, ended, first, pieces, begin, after, tries, problem.yielding)
    else:
        raise _endless(problem, origin + x**ONSET, most)
    raise _lost(problem, state, radius, problem.T * (origin + x**ONSET))


def _begun(begin: ImpactState, radius: float) -> float:
    """Where a contact begins in x: later than 0 if the face has not recovered.

    Such a contact has no onset. Its times are regular if they are counted from when the sphere,
    as fast as now, would have begun to press in the face by as much as it still is: later, they
    are too coarse for the forces of a small radius.
    """
    if not radius or begin.separation_speed >= 0.0:
        return 1.0 if radius else 0.0
    return min(1.0, float((begin.approach / -begin.separation_speed) ** (1.0 / ONSET)))


def _onset(problem: DynamicProblem, n: int, length: float, meeting: float) -> Array:
    """da/dx where a contact begins: the depth grows at the speed at which they meet."""
    rule = radau(n)
    goal = meeting * (length * rule.x) ** ONSET
    a = np.sqrt(goal * problem.depth * problem.contact.R) / problem.a
    for _ in range(NEWTON):  # depth grows faster than a^2: the iteration comes down
        at = problem.at(problem.a * a)
        move = (at.depth / problem.depth - goal) / (at.depth_a * (problem.a / problem.depth))
        a = np.maximum(a - move, 0.5 * a)
        if np.max(np.abs(move) / a) < 1e-3:
            break
    return np.asarray(np.linalg.solve(length * rule.integral, a), dtype=np.float64)


def _endless(problem: DynamicProblem, t: float, most: int) -> IncompleteError:
    """A simulation that takes too many steps."""
    return IncompleteError(
        f"the sphere was still in contact {problem.T * t:.6g} s after the first contact, when the "
        f"limit of {most} time steps was reached",
        "reduce inertia.modes, increase accuracy.rtol, or set effects.inertia = false",
    )


def _lost(
    problem: DynamicProblem, state: ImpactState, radius: float, time: float
) -> IncompleteError:
    """Why a contact cannot be followed any further."""
    why, remedy = "has no solution that can be found", "use less extreme values"
    beyond = np.nextafter(problem.contact.top, 0.0) / problem.a
    if radius > 0.99 * beyond:
        why = f"grows wider than {problem.a * beyond:.4g} m, " + (
            f"the largest radius of the contact law: {problem.range_end}"
            if problem.range_end
            else f"{WIDER:g} times what the impact on a plate that does not deflect reaches"
        )
        remedy = "reduce impact.speed or impact.gravity, or use a lighter sphere or a thicker plate"
    for a in (radius, 1.2 * radius):  # where it is, and where it would go
        at = problem.at(problem.a * np.array([min(a, beyond)]))
        bent = at.less_a[0] @ problem.contact.modes.by_shape(state.q)
        own = at.depth_a[0] / problem.depth
        if a > 0.0 and not own + bent > SHARP * own:
            why = "is not circular, because the plate is more curved than the sphere"
            remedy = "use a smaller sphere or a thicker plate"
    return IncompleteError(f"the contact at {time:.6g} s {why}", remedy)


def _left(state: ImpactState) -> float:
    """How long a contact lasts if sphere and plate part as fast as now."""
    return state.approach / state.separation_speed if state.separation_speed > 0.0 else math.inf


def _longest(problem: DynamicProblem, n: int, x: float, state: ImpactState | None) -> float:
    """Length an element may have: by the fastest oscillator, and not beyond the release."""
    most = problem.fastest
    ahead = PHASE * n / most if most else math.inf
    if state is not None:
        ahead = min(ahead, TOWARDS * _left(state))
    return float((x**ONSET + ahead) ** (1.0 / ONSET) - x)


def _check_weight(problem: DynamicProblem, x: float) -> None:
    """End with a sphere that its weight keeps on the plate: it stays far longer than it swings."""
    if not problem.weight:
        return
    swing = math.pi * math.sqrt(float(np.sum(problem.inverse_modal_mass / problem.omega**2)))
    if x**ONSET > STAYS * max(1.0, swing):
        raise IncompleteError(
            "the sphere does not rebound because its weight holds it on the plate",
            "increase impact.speed, or remove impact.gravity",
        )


def _let_go(
    problem: DynamicProblem,
    n: int,
    made: TimeElement,
    end: float,
    state: ImpactState,
    radius: float,
    enough: float = NEXT,
) -> TimeElement:
    """The element that ends where its force does."""
    for _ in range(3):
        x = made.element.x
        guess = made.element.slope_at(x + (end - x) * radau(n).x)
        shorter = element(problem, n, x, end - x, state, radius, guess, enough)
        if shorter is None:
            break
        made, end = shorter, shorter.element.zero_near_end(P)
    return made


def _released(problem: DynamicProblem, last: TimeElement, left: float) -> tuple[float, ImpactState]:
    """The last of a contact, as a half-space's: the force falls by the power 3/2 of the time."""
    state, force = last.end, float(np.sum(last.element.rows[P]))
    after = state
    for _ in range(3):
        flown = problem.flown(state, left)
        push, shift = 0.4 * left, 2.0 / 7.0 * left * left
        pulled = problem.inverse_modal_mass * last.felt[problem.contact.modes.shape]
        after = ImpactState(
            flown.displacement - force * shift,
            flown.velocity - force * push,
            flown.q + pulled * shift,
            flown.q_dot + pulled * push,
            flown.approach - force * shift - float(np.sum(pulled)) * shift,
        )
        left += after.approach / after.separation_speed
    return left, after._replace(approach=0.0)
