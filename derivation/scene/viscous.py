"""Impact on a viscous contact: collocation in time, since energy alone no longer tells.

The contact is viscoelastic (Kuwabara and Kono 1987, Brilliantov et al. 1996), bending elastic.
With a the contact radius, P_e and delta_e force and indentation of the law at it, w the plate's
bending:

    m z'' = m g - P,   P = P_e + A_v dP_e/dt,   z = delta_e + w(P) - w(P_e)

until P falls to zero: there is no tension. A contact that yields adds the depth of its branch to
delta_e; depths are counted from the dent that was there when the branch began. In x = (t/T)^(1/6),
T the time without viscosity, the onset is analytic. On each of a row of elements da/dx is a
polynomial through Radau's nodes, found by Newton's iteration; elements are as long as their last
coefficients are rounding.
"""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import leggauss

from derivation.scene import motion
from derivation.scene.collocation import NEWTON, ONSET, Element, Radau, newton_step, radau, settled
from derivation.scene.effects.effect import Array
from derivation.scene.law import ContactLaw
from derivation.scene.motion import EnergyBalance, Motion
from derivation.scene.scene import SceneError
from derivation.scene.viscous_law import (
    Curve,
    CurvePoints,
    ElasticBending,
    bending_of,
    curve_of,
)
from derivation.scene.yield_events import branch_after, cut
from derivation.scene.yielding import Yielding, yielding_of

STAGES = 9, 12
"""Nodes of an element, of the run that checks and of the one that counts."""
FIRST, LONGEST, SHORTEST, MOST = 0.05, 0.25, 1e-13, 2000
"""First, largest and least length of an element in x, and how many are tried."""
TOLERANCE = 1e-11
"""An element's last coefficients over the largest there are."""
ROUNDING = 2e-12
"""What tests hold the results to, beside the change with the nodes [1]."""
OWN = 1e3
"""How much less exact the radius may be beside the largest of its element."""
_ROUGH = 1e-3
A, V, Z, P, LOST = range(5)
"""Rows of an element: contact radius, velocity, indentation, force, and energy lost per x."""


class Point(NamedTuple):
    """Contact radius, velocity and indentation at a time, in the problem's units."""

    radius: float
    velocity: float
    depth: float


class States(NamedTuple):
    """Force, depth, loss per x, and slopes: of both by the radius a and by da/dx."""

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
        The contact law, and what of it is elastic.
    a, T
        Units of radius [m] and time [s]; those of velocity, depth and force are v0, v0 T and
        m v0/T.
    yielding
        The contact that yields, on the branch on which it is; None of one that does not.
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
        """What presses the sphere on, in units of v0/T."""
        return self.law.gravity * (self.T / self.law.model.v0)

    @property
    def dent(self) -> float:
        """Depth from which depths are counted, in units of the problem."""
        return self.yielding.dent / self.depth if self.yielding else 0.0

    def at(self, a: Array) -> CurvePoints:
        """The law at radii [m], and what yielding adds to its depth."""
        found = self.curve.at(a)
        if self.yielding is None:
            return found
        depth, depth_a = self.yielding.added(found.force, found.force_a)
        return found._replace(depth=found.depth + depth, depth_a=found.depth_a + depth_a)

    def states(self, x: Array, a: Array, y: Array) -> States:
        """Forces and depths at radii a that grow with x by y."""
        found = self.at(self.a * a)
        delay = self.law.model.retardation_time / self.T / (ONSET * x ** (ONSET - 1))
        force_a = found.force_a * (self.a / self.force)
        elastic, P_y = found.force / self.force, delay * force_a
        P = elastic + P_y * y
        # dP_e/da has the slope 2/a of itself for Hertz's law, and nearly so for others.
        P_a = force_a + 2.0 * P_y * y / a
        (bent, bent_P), (calm, calm_P) = (self.bending.at(f * self.force) for f in (P, elastic))
        unit = self.force / self.depth
        local = found.depth_a * (self.a / self.depth) - unit * calm_P * force_a
        depth = (found.depth + bent - calm) / self.depth
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
    """The element and the state after it, by Newton's iteration from a guess of da/dx.

    None if it does not converge.
    """
    rule = radau(n)
    xs = x + length * rule.x
    by_x = length * rule.integral
    by_t = by_x * (ONSET * xs ** (ONSET - 1))
    t, size = xs**ONSET, math.inf
    for _ in range(NEWTON):
        a = start.radius + by_x @ y
        if not np.all(a > 0.0):
            return None
        at = problem.states(xs, a, y)
        v = start.velocity + problem.weight * (t - x**ONSET) - by_t @ at.P
        z = start.depth + by_t @ v
        P_y = at.P_a[:, None] * by_x + np.diag(at.P_y)
        slope = at.depth_a[:, None] * by_x + np.diag(at.depth_y) + by_t @ (by_t @ P_y)
        step = newton_step(slope / t[:, None], (z - at.depth) / t, by_x, a)
        if step is None:
            return None
        y, before, size = y + step[0], size, step[1]
        if settled(size, before):
            break
    else:
        return None
    rows = np.array([a, v, z + problem.dent, at.P, at.lost]) @ rule.analysis.T
    found = Element(x, length, rows, rule.analysis @ y)
    return found, Point(float(a[-1]), float(v[-1]), float(z[-1]))


Piece = tuple[Element, Yielding | None]
"""An element, and the branch that a contact which yields was on."""


def elements(problem: ViscousProblem, n: int) -> tuple[Piece, ...]:
    """The impact, element by element, until the force is gone.

    Raises
    ------
    SceneError
        If it does not end, or no element is short enough.
    """
    found: list[Piece] = []
    x, length, start = 0.0, FIRST, Point(0.0, 1.0, 0.0)
    # Before a quantity has grown, what counts is how large it will be.
    scale, last = np.full((5, 1), 0.1), None
    for _ in range(MOST):
        if length < SHORTEST:
            break
        xs = x + length * radau(n).x
        guess = last.slope_at(xs) if found and last else _onset(problem, radau(n), length)
        made = element(problem, n, x, length, start, guess)
        if made is None:
            length *= 0.5
            continue
        last, end = made
        own = np.max(np.abs(last.rows), axis=1, keepdims=True)
        largest = np.maximum(scale, own)
        # Where the contact closes its radius matters beside itself: it says when.
        unit = np.vstack((OWN * own[A], largest[V:LOST]))
        error = float(np.max(np.abs(last.rows[:LOST, -2:]) / unit))
        change = 0.9 * (TOLERANCE / max(error, 1e-300)) ** (1.0 / n)
        if error > TOLERANCE:
            length *= min(0.8, max(0.1, change))
            continue
        piece = problem.yielding
        if piece is not None:
            last, end, problem = _next_branch(problem, n, (last, end), start)
        found.append((last, piece))
        if float(np.sum(last.rows[P])) <= 0.0:
            return tuple(found)
        if start.velocity < 0.0 < end.velocity:
            raise SceneError(
                "plate.retardation_time: the sphere does not rebound because its weight holds it "
                "on the plate; reduce retardation_time (plate, sphere) or increase impact.speed"
            )
        x, start, scale = last.x + last.length, end, largest
        length = min(LONGEST, length * min(2.0, change))
    raise SceneError(
        "plate.retardation_time: expected a contact that can be followed to its end, got one that "
        f"cannot at {problem.T * x**ONSET:.6g} s; give a shorter time"
    )


def _next_branch(
    problem: ViscousProblem, n: int, made: tuple[Element, Point], start: Point
) -> tuple[Element, Point, ViscousProblem]:
    """The element and the state after it, cut at its first event, and the problem from there on."""
    branch, x = problem.yielding, made[0].x
    assert branch is not None

    def shorter(length: float, guess: Array) -> tuple[Element, Point] | None:
        return element(problem, n, x, length, start, guess)

    found = cut(branch, problem.a, made, lambda made: made[0], shorter)
    if found is None:
        return *made, problem
    last, end = found
    a = problem.a * end.radius
    after = branch_after(branch, a, float(problem.curve.at(np.array([a])).force[0]))
    sunk = (after.dent - branch.dent) / problem.depth
    return last, end._replace(depth=end.depth - sunk), replace(problem, yielding=after)


def _onset(problem: ViscousProblem, rule: Radau, length: float) -> Array:
    """da/dx where the contact begins, delta = v0 t, by Euler's method backwards.

    The depth grows with the radius, and faster and faster, so that Newton's iteration comes
    down from Hertz's radius, which is the largest there can be.
    """
    xs, a, last = length * rule.x, np.zeros(rule.x.size), 0.0
    for index, x in enumerate(xs):
        here, step = xs[index : index + 1], x - (xs[index - 1] if index else 0.0)
        radius = np.array([math.sqrt(problem.law.model.R * problem.depth) / problem.a * x**3])
        for _ in range(NEWTON):
            at = problem.states(here, radius, (radius - last) / step)
            move = (at.depth - x**ONSET) / (at.depth_a + at.depth_y / step)
            radius = np.maximum(radius - move, 0.5 * radius)
            if abs(float(move[0])) <= _ROUGH * float(radius[0]):
                break
        a[index] = last = float(radius[0])
    return np.asarray(np.linalg.solve(length * rule.integral, a), dtype=np.float64)


@dataclass(frozen=True)
class ViscousMotion(Motion):
    """An impact on a viscoelastic contact, with its time elements."""

    problem: ViscousProblem | None = None
    pieces: tuple[Piece, ...] = ()

    def history(self, law: ContactLaw, times: Array) -> tuple[Array, Array, Array, Array]:  # noqa: ARG002
        """Indentation [m], velocity [m/s], contact radius [m] and force [N] at times [s]."""
        problem = self.problem
        assert problem is not None
        x = (np.minimum(times, self.contact_time) / problem.T) ** (1.0 / ONSET)
        starts = [element.x for element, _ in self.pieces]
        place = np.searchsorted(starts, x, side="right") - 1
        rows = np.empty((LOST + 1, x.size))
        for index in np.unique(place):
            found, branch = self.pieces[index]
            part = found.at(x[place == index])
            if branch is not None:
                a = problem.a * np.maximum(part[A], 0.0)
                part[A] = branch.widened(a, problem.curve.at(a).force) / problem.a
            rows[:, place == index] = part
        velocity, force = problem.law.model.v0 * rows[V], problem.force * np.maximum(rows[P], 0.0)
        return problem.depth * rows[Z], velocity, problem.a * rows[A], force


def impact(law: ContactLaw) -> ViscousMotion:
    """The impact by a law with viscosity.

    Raises
    ------
    SceneError
        If it exceeds the law's range, the sphere does not separate again, or the time history
        cannot be resolved.
    """
    calm = _calm(law.only(lambda e: not e.viscous))
    a, T = calm.max_contact_radius, calm.contact_time
    problem = ViscousProblem(curve_of(law, a), bending_of(law, a), a, T, yielding_of(law))
    rough, found = (_motion(problem, elements(problem, n)) for n in STAGES)
    pairs = zip(found.numbers, rough.numbers, strict=True)
    return replace(found, quadrature=max(abs(new / old - 1.0) for new, old in pairs))


def _calm(law: ContactLaw) -> Motion:
    """The impact without viscosity. If it yields its radius is larger than the elastic law's."""
    if not law.plastic:
        return motion.impact(law)
    from derivation.scene import plastic

    return plastic.impact(law)


def _motion(problem: ViscousProblem, pieces: tuple[Piece, ...]) -> ViscousMotion:
    """The results of an impact."""
    elements = tuple(element for element, _ in pieces)
    problem = replace(problem, yielding=pieces[-1][1])
    last = elements[-1].end(P)
    a, v, z, _, _ = elements[-1].at(np.array([last]))[:, 0]
    depth, force, radius = (max(element.largest(row) for element in elements) for row in (Z, P, A))
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
        pieces=pieces,
        dent=branch.dent if branch else 0.0,
    )


def _lost(element: Element, last: float) -> float:
    """Energy lost in an element up to x = last, by Gauss' rule."""
    nodes, weights = leggauss(element.slope.size)
    length = min(element.length, last - element.x)
    x = element.x + length * (1.0 + nodes) / 2.0
    return length / 2.0 * float(weights @ element.at(x)[LOST])


def _left(problem: ViscousProblem, a: float) -> float:
    """Energy [J] that the viscoelastic part holds at a radius [m]: int P_e d(delta_e - w)."""
    nodes, weights = leggauss(48)
    found = problem.at(a * (1.0 + nodes) / 2.0)
    slope = found.depth_a - problem.bending.at(found.force)[1] * found.force_a
    return a / 2.0 * float(weights @ (found.force * slope))
