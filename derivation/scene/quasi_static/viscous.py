"""Impact with a viscoelastic contact on a quasi-static plate, by collocation in time.

The contact is viscoelastic (Kuwabara and Kono 1987, Brilliantov et al. 1996), the bending elastic.
With contact radius a, P_e and delta_e force and indentation of the elastic law at a, and w the
bending deflection of the plate,

    m z'' = m g - P,   P = P_e + A_v dP_e/dt,   z = delta_e + w(P) - w(P_e)

until P falls to zero, because the contact transmits no tension. A plastic contact adds the depth of
its branch to delta_e; depths are measured from the dent at the beginning of the branch. The onset
of contact is analytic in x = (t/T)^(1/6), T being the contact time without viscosity. On each time
element da/dx is a polynomial through Radau nodes, computed by Newton's iteration. The length of an
element is limited so that its last coefficients are of the size of rounding.
"""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.yielding import Yielding, yielding_of
from derivation.scene.dynamic.yield_events import UncutError, branch_after, cut
from derivation.scene.errors import HeldError, SceneError
from derivation.scene.numerics.collocation import (
    NEWTON,
    ONSET,
    Element,
    Radau,
    converged,
    largest_of,
    newton_step,
    radau,
)
from derivation.scene.numerics.quadrature import gauss
from derivation.scene.quasi_static import motion
from derivation.scene.quasi_static.motion import EnergyBalance, Motion
from derivation.scene.quasi_static.viscous_law import (
    Curve,
    CurvePoints,
    ElasticBending,
    bending_of,
    curve_of,
)
from generated.arrays import Double as Array

STAGES = 9, 12
"""Nodes of a time element, in the run for the error estimate and in the final run."""
FIRST, LONGEST, SHORTEST, MOST = 0.05, 0.25, 1e-13, 2000
"""First, largest and smallest length of a time element in x, and largest number of elements."""
TOLERANCE = 1e-11
"""Largest ratio of the last coefficients of an element to the largest coefficient."""
ROUNDING = 1e-11
"""Tested bound on the rounding errors of the results [1]. The contact time has the largest errors,
of at most 7e-12 in random scenes."""
OWN = 1e3
"""Factor on the tolerance of the radius relative to its largest value in the element."""
_ROUGH = 1e-3
POWER = 4
"""Power of x with which the radius is assumed to grow at the onset, for a first guess."""
A, V, Z, P, LOST = range(5)
"""Rows of a time element: contact radius, velocity, indentation, force, energy loss per x."""


class Point(NamedTuple):
    """Contact radius, velocity and indentation at a time, in the units of the problem."""

    radius: float
    velocity: float
    depth: float


class States(NamedTuple):
    """Force P, depth d, energy loss per x, and derivatives of P and d: for a and for y = da/dx."""

    P: Array
    depth: Array
    lost: Array
    P_a: Array
    P_y: Array
    depth_a: Array
    depth_y: Array


@dataclass(frozen=True)
class ViscousProblem:
    """A scene in units of the impact without viscosity.

    Attributes
    ----------
    curve, bending
        The contact law, and its elastic part, the bending of the plate.
    a, T
        Units of radius [m] and time [s]; those of velocity, depth and force are v0, v0 T and
        m v0/T.
    yielding
        The current branch of a plastic contact; None without plasticity.
    """

    curve: Curve
    bending: ElasticBending
    a: float
    T: float
    yielding: Yielding | None = None

    @property
    def law(self) -> ContactLaw:
        """The contact law."""
        return self.curve.law

    @property
    def force(self) -> float:
        """Unit of forces [N]."""
        return self.law.model.m * (self.law.model.v0 / self.T)

    @property
    def depth(self) -> float:
        """Unit of depths [m]."""
        return self.law.model.v0 * self.T

    @property
    def weight(self) -> float:
        """Gravitational acceleration in units of v0/T."""
        return self.law.gravity * (self.T / self.law.model.v0)

    @property
    def dent(self) -> float:
        """Depth of the dent from which depths are measured, in units of the problem."""
        return self.yielding.dent / self.depth if self.yielding else 0.0

    def at(self, a: Array) -> CurvePoints:
        """Return the law at radii [m], with the depth added by yielding."""
        points = self.curve.at(a)
        if self.yielding is None:
            return points
        depth, depth_a = self.yielding.added(points.force, points.force_a)
        return points._replace(depth=points.depth + depth, depth_a=points.depth_a + depth_a)

    def states(self, x: Array, a: Array, y: Array) -> States:
        """Return forces and depths at radii a with da/dx = y."""
        points = self.at(self.a * a)
        delay = self.law.model.retardation_time / self.T / (ONSET * x ** (ONSET - 1))
        force_a = points.force_a * (self.a / self.force)
        elastic, P_y = points.force / self.force, delay * force_a
        P = elastic + P_y * y
        # d^2 P_e/da^2 = (2/a) dP_e/da by Hertz's law, and approximately by other laws.
        P_a = force_a + 2.0 * P_y * y / a
        bending = self.bending.at(np.array([P, elastic]) * self.force)
        (bent, static), (bent_P, static_P) = bending
        unit = self.force / self.depth
        local = points.depth_a * (self.a / self.depth) - unit * static_P * force_a
        depth = (points.depth + bent - static) / self.depth
        return States(
            P,
            depth,
            P_y * local * y * y,
            P_a,
            P_y,
            local + unit * bent_P * P_a,
            unit * bent_P * P_y,
        )


def element(
    problem: ViscousProblem, n: int, x: float, length: float, start: Point, y: Array
) -> tuple[Element, Point] | None:
    """Return a time element and the state at its end, by Newton's iteration from a guess of da/dx.

    Returns None if the iteration does not converge.
    """
    rule = radau(n)
    xs = x + length * rule.x
    by_x = length * rule.integral
    by_t = by_x * (ONSET * xs ** (ONSET - 1))
    t, size, found = xs**ONSET, math.inf, False
    for _ in range(NEWTON):
        a = start.radius + by_x @ y
        if not np.all(a > 0.0):
            return None
        at = problem.states(xs, a, y)
        v = start.velocity + problem.weight * (t - x**ONSET) - by_t @ at.P
        z = start.depth + by_t @ v
        if found:
            rows = np.array([a, v, z + problem.dent, at.P, at.lost]) @ rule.analysis.T
            made = Element(x, length, rows, rule.analysis @ y)
            return made, Point(float(a[-1]), float(v[-1]), float(z[-1]))
        P_y = at.P_a[:, None] * by_x + np.diag(at.P_y)
        slope = at.depth_a[:, None] * by_x + np.diag(at.depth_y) + by_t @ (by_t @ P_y)
        step = newton_step(slope / t[:, None], (z - at.depth) / t, by_x, a)
        if step is None:
            return None
        y, before, size = y + step[0], size, step[1]
        found = converged(size, before, 1)
    return None


ViscousElement = tuple[Element, Yielding | None]
"""A time element, and the branch of a plastic contact."""


def elements(problem: ViscousProblem, n: int) -> tuple[ViscousElement, ...]:
    """Return the time elements of the impact, until the force falls to zero.

    Raises
    ------
    SceneError
        If the impact does not end, or the iteration does not converge for the shortest element.
    """
    viscous_elements: list[ViscousElement] = []
    x, length, start = 0.0, FIRST, Point(0.0, 1.0, 0.0)
    # At the onset quantities are small; the tolerance refers to their expected size.
    scale, last = np.full((5, 1), 0.1), None
    for _ in range(MOST):
        if length < SHORTEST:
            break
        xs = x + length * radau(n).x
        guess = (
            last.slope_at(xs) if viscous_elements and last else _onset(problem, radau(n), length)
        )
        made = element(problem, n, x, length, start, guess)
        if made is None:
            length *= 0.5
            continue
        last, end = made
        own = np.max(np.abs(last.rows), axis=1, keepdims=True)
        largest = np.maximum(scale, own)
        # At the end of contact the radius needs a small relative error, because it determines the
        # time.
        unit = np.vstack((OWN * own[A], largest[V:LOST]))
        error = float(np.max(np.abs(last.rows[:LOST, -2:]) / unit))
        change = 0.9 * (TOLERANCE / max(error, 1e-300)) ** (1.0 / n)
        if error > TOLERANCE:
            length *= min(0.8, max(0.1, change))
            continue
        branch = problem.yielding
        if branch is not None:
            try:
                last, end, problem = _next_branch(problem, n, (last, end), start)
            except UncutError:
                length *= 0.5
                continue
        viscous_elements.append((last, branch))
        if float(np.sum(last.rows[P])) <= 0.0:
            return tuple(viscous_elements)
        if start.velocity < 0.0 < end.velocity:
            raise HeldError(
                "plate.retardation_time: the sphere does not rebound because its weight holds it "
                "on the plate; reduce retardation_time of plate or sphere, or increase impact.speed"
            )
        x, start, scale = last.x + last.length, end, largest
        length = min(LONGEST, length * min(2.0, change))
    raise SceneError(
        "plate.retardation_time: the time integration failed at "
        f"{problem.T * x**ONSET:.6g} s; reduce retardation_time of plate or sphere"
    )


def _next_branch(
    problem: ViscousProblem, n: int, made: tuple[Element, Point], start: Point
) -> tuple[Element, Point, ViscousProblem]:
    """Return element and state, cut at the first yield event, and the problem after it."""
    branch, x = problem.yielding, made[0].x
    assert branch is not None

    def shorter(length: float, guess: Array) -> tuple[Element, Point] | None:
        return element(problem, n, x, length, start, guess)

    first = cut(branch, problem.a, made, lambda made: made[0], shorter)
    if first is None:
        return *made, problem
    last, end = first
    a = problem.a * end.radius
    after = branch_after(branch, a, float(problem.curve.at(np.array([a])).force[0]))
    sunk = (after.dent - branch.dent) / problem.depth
    return last, end._replace(depth=end.depth - sunk), replace(problem, yielding=after)


def _onset(problem: ViscousProblem, rule: Radau, length: float) -> Array:
    """Return da/dx at the onset of contact, where delta = v0 t.

    The radius grows as a power of x between the third, by Hertz's law, and the fourth, if its rate
    bends a thin plate. The depth is a convex function of the radius. Newton's iteration therefore
    converges from Hertz's radius, the largest possible one.
    """
    x = length * rule.x
    a = math.sqrt(problem.law.model.R * problem.depth) / problem.a * x**3
    for _ in range(NEWTON):
        at = problem.states(x, a, POWER * a / x)
        move = (at.depth - x**ONSET) / (at.depth_a + at.depth_y * POWER / x)
        a = np.maximum(a - move, 0.5 * a)
        if np.all(np.abs(move) <= _ROUGH * a):
            break
    return np.asarray(np.linalg.solve(length * rule.integral, a), dtype=np.float64)


@dataclass(frozen=True)
class ViscousMotion(Motion):
    """An impact on a viscoelastic contact, with its time elements."""

    problem: ViscousProblem | None = None
    elements: tuple[ViscousElement, ...] = ()

    def history(self, law: ContactLaw, times: Array) -> tuple[Array, Array, Array, Array]:  # noqa: ARG002
        """Return indentation [m], velocity [m/s], contact radius [m] and force [N] at times [s]."""
        problem = self.problem
        assert problem is not None
        x = (np.minimum(times, self.contact_time) / problem.T) ** (1.0 / ONSET)
        starts = [element.x for element, _ in self.elements]
        place = np.searchsorted(starts, x, side="right") - 1
        rows = np.empty((LOST + 1, x.size))
        for index in sorted(set(place.tolist())):
            element, branch = self.elements[index]
            part = element.at(x[place == index])
            if branch is not None:
                a = problem.a * np.maximum(part[A], 0.0)
                part[A] = branch.widened(a, problem.curve.at(a).force) / problem.a
            rows[:, place == index] = part
        velocity, force = problem.law.model.v0 * rows[V], problem.force * np.maximum(rows[P], 0.0)
        return problem.depth * rows[Z], velocity, problem.a * rows[A], force


def impact(law: ContactLaw) -> ViscousMotion:
    """Return the impact by a law with viscosity.

    Raises
    ------
    SceneError
        If the impact exceeds the range of the law, the sphere does not rebound, or the time
        integration fails.
    """
    elastic = _without_viscosity(law.only(lambda e: not e.viscous))
    a, T = elastic.max_contact_radius, elastic.contact_time
    problem = ViscousProblem(curve_of(law, a), bending_of(law, a), a, T, yielding_of(law))
    rough, fine = (_motion(problem, elements(problem, n)) for n in STAGES)
    pairs = zip(fine.numbers, rough.numbers, strict=True)
    return replace(fine, quadrature=max(abs(new / old - 1.0) for new, old in pairs))


def _without_viscosity(law: ContactLaw) -> Motion:
    """Return the impact without viscosity; a plastic contact is wider than the elastic law's."""
    if not law.plastic:
        return motion.impact(law)
    from derivation.scene.quasi_static import plastic

    return plastic.impact(law)


def _motion(problem: ViscousProblem, viscous_elements: tuple[ViscousElement, ...]) -> ViscousMotion:
    """Return the results of an impact from its time elements."""
    elements = tuple(element for element, _ in viscous_elements)
    problem = replace(problem, yielding=viscous_elements[-1][1])
    last = elements[-1].end(P)
    a, v, z, _, _ = elements[-1].at(np.array([last]))[:, 0]
    depth, force, radius = (largest_of(elements, row) for row in (Z, P, A))
    branch = problem.yielding
    energy = problem.law.model.m * problem.law.model.v0 * problem.law.model.v0
    energy_balance = EnergyBalance(
        initial_kinetic=0.5 * energy,
        gravity_work=energy * problem.weight * float(z),
        rebound_kinetic=0.5 * energy * float(v) ** 2,
        viscous_loss=energy * sum(_lost(element, last) for element in elements),
        unrecovered_elastic=_left(problem, problem.a * float(a)),
        plastic_loss=branch.work if branch else 0.0,
    )
    return ViscousMotion(
        problem.T * last**ONSET,
        problem.depth * depth,
        problem.force * force,
        problem.a * radius / (branch.flattening if branch else 1.0),
        0.0,
        -float(v),
        energy_balance,
        problem=problem,
        elements=viscous_elements,
        dent=branch.dent if branch else 0.0,
    )


def _lost(element: Element, last: float) -> float:
    """Return the energy loss in a time element up to x = last, by Gauss' rule."""
    x, weights = gauss(element.slope.size)
    length = min(element.length, last - element.x)
    return length * float(weights @ element.at(element.x + length * x)[LOST])


def _left(problem: ViscousProblem, a: float) -> float:
    """Return the stored viscoelastic energy [J] at a radius [m]: int P_e d(delta_e - w)."""
    x, weights = gauss(48)
    point = problem.at(a * x)
    slope = point.depth_a - problem.bending.at(point.force)[1] * point.force_a
    return a * float(weights @ (point.force * slope))
