"""Impact with a viscoelastic contact on a quasi-static plate, by collocation in time.

The equations are those of `viscous_elements`. All scenes are computed together, each with its own
time elements; one scene is computed like many. The length of an element is limited so that its last
coefficients are of the size of rounding.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.yielding import Yielding, yielding_of
from derivation.scene.dynamic.yield_events import UncutError, branch_after, cut
from derivation.scene.errors import HeldError, SceneError
from derivation.scene.numerics.collocation import ONSET, Element, radau
from derivation.scene.numerics.many_elements import (
    Mask,
    continued,
    largest_values,
    values_at,
    zeros_of,
)
from derivation.scene.numerics.quadrature import gauss
from derivation.scene.quasi_static import motion
from derivation.scene.quasi_static.motion import EnergyBalance, Motion
from derivation.scene.quasi_static.viscous_elements import (
    LOST,
    A,
    Elements,
    P,
    Times,
    V,
    ViscousProblem,
    Z,
    elements,
    onset,
    problems_of,
)
from derivation.scene.quasi_static.viscous_law import number_of
from generated.arrays import Double as Array

STAGES = 9, 12
"""Nodes of a time element, in the run for the error estimate and in the final run."""
FIRST, LONGEST, SHORTEST, MOST = 0.05, 0.25, 1e-13, 2000
"""First, largest and smallest length of a time element in x, and largest number of elements."""
TOLERANCE = 1e-11
"""Largest ratio of the last coefficients of an element to the largest coefficient."""
ROUNDING = 1e-11
"""Bound on the rounding errors of the results, besides the change between both runs [1]. In 581
random scenes, results differed from those of more accurate runs by at most 0.94 of both together;
the contact time has the largest errors, up to 4e-11."""
OWN = 1e3
"""Factor on the tolerance of the radius relative to its largest value in the element."""
TOGETHER = 512
"""Number of scenes whose elements are computed together, so that they fit into the cache."""
ViscousElement = tuple[Element, Yielding | None]
"""A time element, and the branch of a plastic contact."""


@dataclass
class Run:
    """Impacts of some scenes by elements with a number of nodes.

    Attributes
    ----------
    problem
        The scenes.
    end
        Where the force falls to zero, in x, shape (scenes,); NaN without a result.
    last
        Radius, velocity and depth there, in the units of the problem, shape (scenes, 3).
    largest
        Largest radius, depth and force, shape (scenes, 3).
    fastest
        Largest velocity, shape (scenes,).
    errors
        Why an impact has no result, by scene.
    elements
        The elements of a single scene.
    """

    problem: ViscousProblem
    end: Array = field(init=False)
    last: Array = field(init=False)
    largest: Array = field(init=False)
    fastest: Array = field(init=False)
    errors: dict[int, SceneError] = field(default_factory=dict)
    elements: list[ViscousElement] = field(default_factory=list)

    def __post_init__(self) -> None:
        count = len(self.problem.T)
        self.end, self.last = np.full(count, np.nan), np.full((count, 3), np.nan)
        self.largest, self.fastest = np.full((count, 3), -np.inf), np.ones(count)

    @property
    def numbers(self) -> tuple[Array, ...]:
        """The five outputs without plasticity, in SI units, as columns; NaN without a result."""
        problem, (a, depth, force) = self.problem, (x[:, None] for x in self.largest.T)
        unit, cube = problem.units, self.end * self.end * self.end
        time = problem.T * (cube * cube)[:, None]
        numbers = time, unit.depth * depth, unit.force * force, unit.a * a
        known = ~np.isnan(time)
        return *(np.where(known, x, np.nan) for x in numbers), -self.last[:, V, None]


class _State:
    """Scenes whose impacts have not ended: their next elements, and the last ones computed."""

    def __init__(self, problem: ViscousProblem, n: int) -> None:
        count = len(problem.T)
        none, one = np.zeros(count), np.ones(count)
        self.problem, self.index = problem, np.arange(count)
        self.next = Times(none, FIRST * one, none, one, none)
        self.begun = np.zeros(count, dtype=bool)
        self.x, self.length, self.slope = none, one, np.zeros((count, n))
        # At the onset quantities are small; the tolerance refers to their expected size.
        self.scale = np.full((count, LOST + 1), 0.1)

    def keep(self, which: Mask) -> None:
        """Keep some of the scenes."""
        kept = np.flatnonzero(which)
        self.index, self.next = self.index[kept], self.next.take(kept)
        if not kept.size:
            return
        self.problem = self.problem.take(kept)
        for name in ("begun", "x", "length", "slope", "scale"):
            setattr(self, name, getattr(self, name)[kept])

    def guess(self, n: int) -> Array:
        """Return first guesses of da/dx, by the last elements or at the onset of contact."""
        rule, begun = radau(n), self.begun
        if not begun.any():
            return onset(self.problem, rule, self.next.length)
        ahead = (self.next.nodes(rule) - (self.x + self.length)[:, None]) / self.length[:, None]
        guess = continued(self.slope, ahead)
        if not begun.all():
            first = np.flatnonzero(~begun)
            guess[first] = onset(self.problem.take(first), rule, self.next.length[first])
        return guess


def run(problem: ViscousProblem, n: int) -> Run:
    """Return the impacts by elements with n nodes, until the forces fall to zero."""
    result, state = Run(problem), _State(problem, n)
    for _ in range(MOST):
        _fail(result, state, state.next.length < SHORTEST, _unfinished)
        if not len(state.index):
            break
        now = state.next
        made = elements(state.problem, n, now, state.guess(n))
        found, length = made.found, now.length
        state.x, state.length = (
            np.where(found, new, old) for new, old in ((now.x, state.x), (length, state.length))
        )
        state.slope = np.where(found[:, None], made.slope, state.slope)
        own = np.abs(made.rows).max(axis=-1)
        largest = np.maximum(state.scale, own)
        # At the end of contact the radius needs a small relative error, because it determines the
        # time.
        unit = largest[:, :LOST].copy()
        unit[:, A] = OWN * own[:, A]
        error = (np.abs(made.rows[:, :LOST, -2:]).max(axis=-1) / unit).max(axis=-1)
        change = 0.9 * np.exp(np.log(TOLERANCE / np.maximum(error, 1e-300)) / n)
        accepted = error <= TOLERANCE
        shorter = np.where(found, length * np.minimum(0.8, np.fmax(0.1, change)), 0.5 * length)
        longer = np.minimum(LONGEST, length * np.minimum(2.0, change))
        width = length
        if (branch := state.problem.yielding) is not None and accepted.all():
            try:
                made, width = _next_branch(state, n, made)
            except UncutError:
                accepted, shorter = ~accepted, 0.5 * length
        if not accepted.any():
            state.next = now._replace(length=shorter)
            continue
        if len(problem.T) == 1:
            result.elements.append((_element(now.x, width, made), branch))
        put = state.index[accepted]
        rows = made.rows[accepted][:, (A, Z, P)]
        result.largest[put] = largest_values(rows, result.largest[put])
        ended = accepted & (made.rows[:, P].sum(axis=-1) <= 0.0)
        if ended.any():
            result.fastest[state.index[ended]] = largest[ended, V]
            _end(result, state.index[ended], now.x[ended], width[ended], made.rows[ended])
        end = Times(now.x + width, longer, *made.end)
        state.next = Times(
            *(np.where(accepted, new, old) for new, old in zip(end, now, strict=True))
        )._replace(length=np.where(accepted, longer, shorter))
        state.scale = np.where(accepted[:, None], largest, state.scale)
        state.begun |= accepted
        held = accepted & ~ended & (now.velocity < 0.0) & (state.next.velocity > 0.0)
        _fail(result, state, held, _held)
        ended = ended[~held]
        if ended.any():
            state.keep(~ended)
    _fail(result, state, np.ones(len(state.index), dtype=bool), _unfinished)
    return result


def _element(x: Array, length: Array, made: Elements) -> Element:
    """Return the time element of a single scene."""
    return Element(x.item(), length.item(), made.rows[0], made.slope[0])


def _end(result: Run, index: NDArray[np.intp], x: Array, length: Array, rows: Array) -> None:
    """Set where the forces of the last elements fall to zero, and the states there."""
    s = zeros_of(rows[:, P])
    result.end[index] = x + length * (1.0 + s) / 2.0
    result.last[index] = values_at(rows[:, : Z + 1], s[:, None])


def _fail(result: Run, state: _State, which: Mask, why: Callable[[float], SceneError]) -> None:
    """Remove scenes whose impacts have no result, with the reason at a time [s]."""
    if not which.any():
        return
    x = state.next.x[which]
    times = np.ravel(state.problem.T)[which] * (x * x * x) ** 2
    for index, time in zip(state.index[which].tolist(), times.tolist(), strict=True):
        result.errors[index] = why(time)
    state.keep(~which)


def _held(_: float) -> SceneError:
    return HeldError(
        "plate.retardation_time: the sphere does not rebound because its weight holds it "
        "on the plate; reduce retardation_time of plate or sphere, or increase impact.speed"
    )


def _unfinished(time: float) -> SceneError:
    return SceneError(
        f"plate.retardation_time: the time integration failed at {time:.6g} s; reduce "
        "retardation_time of plate or sphere"
    )


def _next_branch(state: _State, n: int, made: Elements) -> tuple[Elements, Array]:
    """Return the element of a single scene, cut at its first yield event, and its length.

    The problem of the state is then that after the event.
    """
    problem, now = state.problem, state.next
    branch, unit = problem.yielding, number_of(problem.units.a)
    assert branch is not None

    def shorter(length: float, guess: Array) -> tuple[Elements, Element] | None:
        times = now._replace(length=np.array([length]))
        one = elements(problem, n, times, guess[None])
        return (one, _element(now.x, times.length, one)) if one.found[0] else None

    whole = made, _element(now.x, now.length, made)
    first = cut(branch, unit, whole, lambda one: one[1], shorter)
    if first is None:
        return made, now.length
    made, element = first
    radius, (_, force, depth) = made.end[A].item(), problem.units
    pressed = problem.curve.at(np.array([[radius]])).force * force
    after = branch_after(branch, unit * radius, pressed.item())
    made.end[Z] -= (after.dent - branch.dent) / number_of(depth)
    state.problem, state.slope = replace(problem, yielding=after), made.slope
    state.length = np.array([element.length])
    return made, state.length


@dataclass(frozen=True)
class ViscousMotion(Motion):
    """An impact on a viscoelastic contact, with its time elements."""

    problem: ViscousProblem | None = None
    elements: tuple[ViscousElement, ...] = ()

    def history(self, law: ContactLaw, times: Array) -> tuple[Array, Array, Array, Array]:
        """Return indentation [m], velocity [m/s], contact radius [m] and force [N] at times [s]."""
        problem = self.problem
        assert problem is not None
        x = (np.minimum(times, self.contact_time) / problem.T.item()) ** (1.0 / ONSET)
        starts = [element.x for element, _ in self.elements]
        unit, force, depth = map(number_of, problem.units)
        place = np.searchsorted(starts, x, side="right") - 1
        rows = np.empty((LOST + 1, x.size))
        for index in sorted(set(place.tolist())):
            element, branch = self.elements[index]
            part = element.at(x[place == index])
            if branch is not None:
                a = np.maximum(part[A], 0.0)
                pressed = force * problem.curve.at(a[None]).force[0]
                part[A] = branch.widened(unit * a, pressed) / unit
            rows[:, place == index] = part
        pressed = force * np.maximum(rows[P], 0.0)
        return depth * rows[Z], law.model.v0 * rows[V], unit * rows[A], pressed


def impact(law: ContactLaw) -> ViscousMotion:
    """Return the impact by a law with viscosity.

    Raises
    ------
    SceneError
        If the impact exceeds the range of the law, the sphere does not rebound, or the time
        integration fails.
    """
    elastic = _without_viscosity(law.only(lambda e: not e.viscous))
    a, T = (np.array([[unit]]) for unit in (elastic.max_contact_radius, elastic.contact_time))
    [(_, problem)] = problems_of(law, a, T, yielding_of(law))
    rough, fine = (_checked(run(problem, n)) for n in STAGES)
    return _motion(fine, law, _errors(fine, rough).item())


def impacts(law: ContactLaw, a: Array, T: Array) -> tuple[Array, ...]:
    """Return the outputs and their relative errors for many scenes, as columns.

    They are NaN where `impact` raises an error, or for an extreme scene.

    Parameters
    ----------
    law
        A law with viscosity and without plasticity, with columns of numbers.
    a, T
        Largest radii [m] and contact times [s] without viscosity, as columns.
    """
    found = np.full((6, *a.shape), np.nan)
    for rows, problem in problems_of(law, a, T):
        rough, fine = (run(problem, n) for n in STAGES)
        found[:, rows] = *fine.numbers, _errors(fine, rough)
    sound = (found > 0.0).all(axis=0) & np.isfinite(found).all(axis=0)
    return tuple(np.where(sound, column, np.nan) for column in found)


def _errors(fine: Run, rough: Run) -> Array:
    """Return the largest relative errors of the results by the elements [1].

    It is the change by more nodes and, since both runs have the same tolerance, which is relative
    to the largest velocity, the error by an increase of the velocity by the weight.
    """
    pairs = zip(fine.numbers, rough.numbers, strict=True)
    change = np.maximum.reduce([np.abs(new / old - 1.0) for new, old in pairs])
    return np.asarray(change + TOLERANCE * (fine.fastest[:, None] - 1.0) / fine.numbers[-1])


def _checked(result: Run) -> Run:
    """Return the impact of a single scene, or raise its error."""
    if result.errors:
        raise result.errors[0]
    return result


def _without_viscosity(law: ContactLaw) -> Motion:
    """Return the impact without viscosity; a plastic contact is wider than the elastic law's."""
    if not law.plastic:
        return motion.impact(law)
    from derivation.scene.quasi_static import plastic

    return plastic.impact(law)


def _motion(result: Run, law: ContactLaw, quadrature: float) -> ViscousMotion:
    """Return the results of the impact of a single scene."""
    branch = result.elements[-1][1]
    problem, [(a, _, z)] = replace(result.problem, yielding=branch), result.last.tolist()
    time, depth, force, radius, restitution = (number.item() for number in result.numbers)
    energy = law.model.m * law.model.v0 * law.model.v0
    energy_balance = EnergyBalance(
        initial_kinetic=0.5 * energy,
        gravity_work=energy * number_of(problem.weight) * z,
        rebound_kinetic=0.5 * energy * restitution**2,
        viscous_loss=energy * sum(_lost(one, result.end.item()) for one, _ in result.elements),
        unrecovered_elastic=energy * _left(problem, a),
        plastic_loss=branch.work if branch else 0.0,
    )
    return ViscousMotion(
        time,
        depth,
        force,
        radius / (branch.flattening if branch else 1.0),
        quadrature,
        restitution,
        energy_balance,
        problem=problem,
        elements=tuple(result.elements),
        dent=branch.dent if branch else 0.0,
    )


def _lost(element: Element, last: float) -> float:
    """Return the energy loss in a time element up to x = last, by Gauss' rule."""
    x, weights = gauss(element.slope.size)
    length = min(element.length, last - element.x)
    return length * float(weights @ element.at(element.x + length * x)[LOST])


def _left(problem: ViscousProblem, a: float) -> float:
    """Return the stored viscoelastic energy at a radius: int P_e d(delta_e - w)."""
    x, weights = gauss(48)
    point = problem.at(a * x[None])
    slope = point.depth_a - problem.bending.at(point.force)[1] * point.force_a
    return a * float(weights @ (point.force * slope)[0])
