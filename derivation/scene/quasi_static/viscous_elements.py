"""Time elements of impacts with viscoelastic contacts on quasi-static plates, of many scenes.

The contact is viscoelastic (Kuwabara and Kono 1987, Brilliantov et al. 1996), the bending elastic.
With contact radius a, P_e and delta_e force and indentation of the elastic law at a, and w the
bending deflection of the plate,

    m z'' = m g - P,   P = P_e + A_v dP_e/dt,   z = delta_e + w(P) - w(P_e)

until P falls to zero, because the contact transmits no tension. A plastic contact adds the depth of
its branch to delta_e; depths are measured from the dent at the beginning of the branch. The onset
of contact is analytic in x = (t/T)^(1/6), T being the contact time without viscosity. On each time
element da/dx is a polynomial through Radau nodes, computed by Newton's iteration.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.yielding import Yielding
from derivation.scene.effects.effect import Numbers
from derivation.scene.numerics.collocation import NEWTON, ONSET, Radau, radau
from derivation.scene.numerics.many_elements import Mask, all_converged, newton_steps
from derivation.scene.quasi_static.viscous_law import (
    Curve,
    CurvePoints,
    ElasticBending,
    TabulatedCurve,
    Units,
    bending_of,
    degrees_of,
    part_of,
    tables_of,
)
from generated.arrays import Double as Array

_ROUGH = 1e-3
POWER = 4
"""Power of x with which the radius is assumed to grow at the onset, for a first guess."""
A, V, Z, P, LOST = range(5)
"""Rows of a time element: contact radius, velocity, indentation, force, energy loss per x."""


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
    """Scenes in units of their impacts without viscosity: columns, or numbers that are all equal.

    Attributes
    ----------
    curve, bending
        The contact law, and its elastic part, the bending of the plate, in these units.
    units, T
        Units of radius, force and depth, and of time [s]; that of velocity is v0.
    start
        Hertz's radius of the depth 1, which is that of the onset.
    delay, weight
        Retardation time and gravitational acceleration.
    yielding
        The current branch of a plastic contact, of a single scene; None without plasticity.
    """

    curve: Curve | TabulatedCurve
    bending: ElasticBending
    units: Units
    T: Array
    start: Array
    delay: Numbers
    weight: Numbers
    yielding: Yielding | None = None

    @property
    def dent(self) -> Numbers:
        """Depth of the dent from which depths are measured, in units of the problem."""
        return self.yielding.dent / self.units.depth if self.yielding else 0.0

    def take(self, index: Any) -> "ViscousProblem":
        """Return some of many scenes."""
        numbers = self.T, self.start, self.delay, self.weight
        parts: Any = (part_of(x, index) for x in numbers)
        units = Units(*(part_of(x, index) for x in self.units))
        laws = self.curve.take(index), self.bending.take(index)
        return replace(ViscousProblem(*laws, units, *parts), yielding=self.yielding)

    def at(self, a: Array) -> CurvePoints:
        """Return the law at radii, with the depth added by yielding."""
        points = self.curve.at(a)
        if self.yielding is None:
            return points
        radius, force, depth = self.units
        added = self.yielding.added(points.force * force, points.force_a * (force / radius))
        return points._replace(
            depth=points.depth + added.depth / depth,
            depth_a=points.depth_a + added.depth_a * (radius / depth),
        )

    def states(self, delay: Array, a: Array, y: Array) -> States:
        """Return forces and depths at radii a with da/dx = y.

        `delay` is the retardation time over dt/dx.
        """
        force, depth, force_a, depth_a = self.at(a)
        P_y = delay * force_a
        late = P_y * y
        # d^2 P_e/da^2 = (2/a) dP_e/da by Hertz's law, and approximately by other laws.
        P, P_a = force + late, force_a + 2.0 * late / a
        if self.bending.table is None:
            return States(P, depth, late * depth_a * y, P_a, P_y, depth_a, np.zeros_like(P))
        (bent, static), (bent_P, static_P) = self.bending.at(np.array([P, force]))
        local = depth_a - static_P * force_a
        return States(
            P,
            depth + bent - static,
            late * local * y,
            P_a,
            P_y,
            local + bent_P * P_a,
            bent_P * P_y,
        )


def problems_of(
    law: ContactLaw, a: Array, T: Array, yielding: Yielding | None = None
) -> Iterator[tuple[NDArray[np.intp], ViscousProblem]]:
    """Yield the scenes whose laws have accurate tables, and the others, with their indices.

    Parameters
    ----------
    a, T
        Largest radius [m] and contact time [s] without viscosity, as columns.
    yielding
        The first branch of a plastic contact, of a single scene.
    """
    model = law.model
    units = Units(a, model.m * (model.v0 / T), model.v0 * T)
    (curve, accurate), bending = tables_of(law, a, units), bending_of(law, a, units)
    numbers = (
        T, np.sqrt(model.R * units.depth) / a, model.retardation_time / T,
        law.gravity * (T / model.v0),
    )  # fmt: skip
    whole = ViscousProblem(curve, bending, units, *numbers, yielding=yielding)
    degrees = np.where(accurate, degrees_of(curve, bending), 0)
    for degree in np.unique(degrees).tolist():
        rows = np.flatnonzero(degrees == degree)
        problem = whole if len(rows) == len(degrees) else whole.take(rows)
        if not degree:
            of_law = Curve(law, units)
            yield rows, replace(problem, curve=of_law.take(rows) if len(a) > 1 else of_law)
            continue
        tables = curve.take(rows).cut(degree), bending.take(rows).cut(degree)
        yield rows, replace(problem, curve=tables[0], bending=tables[1])


class Times(NamedTuple):
    """Time elements before their computation: beginning and length in x, state at the beginning.

    Attributes
    ----------
    x, length
        Beginning and length, shape (scenes,).
    radius, velocity, depth
        State at the beginning, shape (scenes,).
    """

    x: Array
    length: Array
    radius: Array
    velocity: Array
    depth: Array

    def take(self, index: Any) -> "Times":
        """Return those of some scenes."""
        return Times(*(column[index] for column in self))

    def nodes(self, rule: Radau) -> Array:
        """Return x at the nodes."""
        return self.x[:, None] + self.length[:, None] * rule.x


class Elements(NamedTuple):
    """Time elements: a matrix of the Legendre coefficients of each, and those of da/dx.

    Attributes
    ----------
    found
        Whether Newton's iteration has converged; else the rest is NaN.
    rows, slope
        Coefficients, shape (scenes, quantities, n), and those of da/dx, shape (scenes, n).
    end
        Radius, velocity and depth at the end, shape (3, scenes).
    """

    found: Mask
    rows: Array
    slope: Array
    end: Array


class _Iteration(NamedTuple):
    """Numbers of elements that Newton's iteration does not change, and its last steps.

    Attributes
    ----------
    delay, t
        Retardation time over dt/dx, and time at the nodes.
    radius, velocity, depth
        State at the beginning; the velocity with that by the weight, at the nodes.
    by_x, by_t, twice
        Matrices of the integrals over x and time, and of the double one over time, over the time.
    y, size
        da/dx and the size of the last step; NaN before the first.
    found
        Whether the iteration has converged.
    """

    delay: Array
    t: Array
    radius: Array
    velocity: Array
    depth: Array
    by_x: Array
    by_t: Array
    twice: Array
    y: Array
    size: Array
    found: Mask

    def take(self, index: Any) -> "_Iteration":
        """Return those of some scenes."""
        return _Iteration(*(x[index] for x in self))


def elements(problem: ViscousProblem, n: int, start: Times, y: Array) -> Elements:
    """Return the time elements of all scenes, by Newton's iteration from guesses of da/dx."""
    count = len(y)
    made = Elements(
        np.zeros(count, dtype=bool), np.full((count, 5, n), np.nan), np.full((count, n), np.nan),
        np.full((3, count), np.nan),
    )  # fmt: skip
    now, left = _begun(problem, radau(n), start, y), np.arange(count)
    for _ in range(NEWTON):
        a = now.radius + _times(now.by_x, now.y)
        if not a.min() > 0.0:
            positive = np.asarray((a > 0.0).all(axis=-1))
            problem, now, left, a = _kept(positive, problem, now, left, a)
            if not left.size:
                break
        at = problem.states(now.delay, a, now.y)
        v = now.velocity - _times(now.by_t, at.P)
        z = now.depth + _times(now.by_t, v)
        if now.found.any():
            done = now.found
            values = np.stack((a, v, z + problem.dent, at.P, at.lost), axis=1)
            _put(made, left[done], values[done], now.y[done], z[done, -1])
            if done.all():
                break
            problem, now, left, a, z, *columns = _kept(~done, problem, now, left, a, z, *at)
            at = States(*columns)
        now = _stepped(now, at, a, z)
        if not now.size.max() < np.inf:
            problem, now, left = _kept(now.size < np.inf, problem, now, left)
            if not left.size:
                break
    return made


def _put(made: Elements, index: NDArray[np.intp], values: Array, y: Array, depth: Array) -> None:
    """Set the elements of some scenes from values at the nodes, and the depth at the end."""
    analysis = radau(y.shape[-1]).analysis
    made.found[index], made.end[: V + 1, index] = True, values[:, : V + 1, -1].T
    made.end[Z, index] = depth
    made.rows[index] = np.vecdot(analysis, values[:, :, None, :])
    made.slope[index] = np.vecdot(analysis, y[:, None, :])


def _kept(which: Mask, *parts: Any) -> tuple[Any, ...]:
    """Return the parts of some scenes."""
    index = np.flatnonzero(which)
    if not index.size:
        return tuple(x[index] if isinstance(x, np.ndarray) else x for x in parts)
    return tuple(x[index] if isinstance(x, np.ndarray) else x.take(index) for x in parts)


def _times(matrices: Array, values: Array) -> Array:
    """Multiply the values of each scene by its matrix."""
    return np.vecdot(matrices, values[:, None, :])  # type: ignore[no-any-return]


def _begun(problem: ViscousProblem, rule: Radau, start: Times, y: Array) -> _Iteration:
    """Return the numbers of elements before the first step."""
    x, columns = start.nodes(rule), Times(*(column[:, None] for column in start))
    rate, t = _rate(x), _sixth(x)
    by_x = columns.length[:, :, None] * rule.integral
    by_t = by_x * rate[:, None, :]
    fallen = problem.weight * (t - _sixth(columns.x))
    return _Iteration(
        problem.delay / rate, t, columns.radius, columns.velocity + fallen, columns.depth,
        by_x, by_t, (by_t @ by_t) / t[:, :, None], y, np.full(len(y), np.nan),
        np.zeros(len(y), dtype=bool),
    )  # fmt: skip


def _sixth(x: Array) -> Array:
    """Return t/T = x^6, with rounding errors that do not depend on the number of values."""
    cube = x * x * x
    return cube * cube


def _rate(x: Array) -> Array:
    """Return the derivative of t/T with respect to x."""
    square = x * x
    return ONSET * (square * square * x)


def _stepped(now: _Iteration, at: States, a: Array, z: Array) -> _Iteration:
    """Return the iteration after a step; its size is NaN where there is none."""
    force = _with_diagonal(at.P_a[:, :, None] * now.by_x, at.P_y)
    local = (at.depth_a / now.t)[:, :, None] * now.by_x
    system = _with_diagonal(local, at.depth_y / now.t) + now.twice @ force
    step, size = newton_steps(system, (z - at.depth) / now.t, now.by_x, a)
    return now._replace(y=now.y + step, size=size, found=all_converged(size, now.size))


def _with_diagonal(matrices: Array, diagonal: Array) -> Array:
    """Add numbers to the diagonals of matrices, in place."""
    count, n = diagonal.shape
    matrices.reshape(count, n * n)[:, :: n + 1] += diagonal
    return matrices


def onset(problem: ViscousProblem, rule: Radau, length: Array) -> Array:
    """Return da/dx at the onset of contact, where delta = v0 t.

    The radius grows as a power of x between the third, by Hertz's law, and the fourth, if its rate
    bends a thin plate. The depth is a convex function of the radius. Newton's iteration therefore
    converges from Hertz's radius, the largest possible one.
    """
    x = length[:, None] * rule.x
    delay = problem.delay / _rate(x)
    a = problem.start * (x * x * x)
    moving = np.ones(len(a), dtype=bool)
    for _ in range(NEWTON):
        at = problem.states(delay, a, POWER * a / x)
        move = (at.depth - _sixth(x)) / (at.depth_a + at.depth_y * POWER / x)
        a = np.where(moving[:, None], np.maximum(a - move, 0.5 * a), a)
        moving &= ~(np.abs(move) <= _ROUGH * a).all(axis=-1)
        if not moving.any():
            break
    integrals = np.broadcast_to(rule.integral, (len(a), *rule.integral.shape))
    return np.asarray(np.linalg.solve(integrals, (a / length[:, None])[..., None])[..., 0])
