"""A rigid sphere on the plate: static contact, and the time steps of an impact."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derivation.checks.finite_elements.mesh import Double
from derivation.checks.finite_elements.plate import System, factorised

Nodes = NDArray[np.bool_]
"""For each contact node, whether it touches the sphere."""
SPECTRAL_RADIUS = 0.8
"""Spectral radius of the time integration at infinite frequency."""
MAX_ITERATIONS = 60
"""Largest number of changes of the set of touching nodes in one time step; more are an error."""
CLEARANCE = 1.5
"""Height of the sphere above the undeformed plate, over the largest deflection so far, from which
no further contact is assumed."""
FLIGHT_STEP = 8
"""Length of the time steps between contacts over their length during a contact."""
GAP_STEPS = 20
"""Number of time steps without contact after which steps are longer, and that separates two
contacts."""
END_STEPS = 5
"""Number of last steps of a contact from which its end is extrapolated."""
STRESS_WINDOW, STRESS_TIMES, STRESS_STEPS = 0.06, 60, 5
"""Half the time, over the contact time, in which a parabola is fitted to the stress; number of
these parabolas in a contact time; smallest number of time steps of one."""
PEAK_WINDOW = 0.05
"""Half the time, over the contact time, in which a polynomial is fitted to the largest force."""


class WideContactError(ArithmeticError):
    """Error: the contact is wider than the fine part of the mesh."""


@dataclass(frozen=True)
class Sphere:
    """A rigid sphere, or the paraboloid r^2/(2 R).

    Parameters
    ----------
    radius, mass
        Radius [m] and mass [kg].
    speed
        Impact speed [m/s].
    exact
        Whether the profile is that of a sphere.
    """

    radius: float
    mass: float
    speed: float
    exact: bool = False

    def profile(self, r: Double) -> Double:
        """Return the height of the lower face over its lowest point [m]."""
        R = self.radius
        height: Double = r**2 / (R + np.sqrt(R**2 - r**2)) if self.exact else r**2 / (2.0 * R)
        return height


def contact_forces(compliance: Double, gap: Double, start: Nodes) -> tuple[Double, Nodes]:
    """Solve compliance @ force + gap >= 0, force >= 0, where at each node one of both is 0.

    The primal-dual active-set method is used, from a first guess.

    Returns
    -------
    Double, Nodes
        The forces, and for each node whether it touches the sphere.

    Raises
    ------
    ArithmeticError
        If the set of touching nodes still changes after `MAX_ITERATIONS` iterations.
    """
    active = start
    for _ in range(MAX_ITERATIONS):
        force = np.zeros_like(gap)
        place = np.flatnonzero(active)
        if place.size:
            force[place] = np.linalg.solve(compliance[np.ix_(place, place)], -gap[place])
        open_gap = compliance @ force + gap
        following = np.where(active, force > 0.0, open_gap < -1e-13 * np.abs(gap).max())
        if np.array_equal(following, active):
            return force, active
        active = following
    raise ArithmeticError("contact: expected a set of touching nodes, got none that stays")


def static_contact(system: System, sphere: Sphere, displacement: float) -> tuple[Double, Double]:
    """Return the static contact at a sphere displacement [m]: radii [m] and forces [N] of nodes."""
    nodes = system.contact_nodes
    columns = _unit_forces(system, system.static_solver)
    compliance = columns[nodes]
    gap = sphere.profile(system.contact_radii) - displacement
    force, _ = contact_forces(compliance, gap, gap < 0.0)
    return system.contact_radii, force


def _unit_forces(system: System, solver: Any) -> Double:
    """Return the displacements for a unit force, along +z, at each contact node."""
    load = np.zeros((system.free.size, system.contact_nodes.size))
    load[system.contact_nodes, np.arange(system.contact_nodes.size)] = 1.0
    displacement: Double = solver.solve(load)
    return displacement


@dataclass(frozen=True)
class History:
    """Results at every time step.

    Parameters
    ----------
    time
        Time since first contact [s].
    displacement, speed
        Displacement [m] and velocity [m/s] of the sphere, downwards.
    force
        Contact force [N].
    width
        Number of the outermost touching node, from 1; 0 without contact.
    stress
        Stress on the axis of the back face [Pa].
    energy
        Energy of plate and sphere after the last contact, over the initial one [1].
    """

    time: Double
    displacement: Double
    speed: Double
    force: Double
    width: Double
    stress: Double
    energy: float


class Stepper:
    """Generalised-alpha time steps of plate and sphere.

    The contact condition is satisfied at the end of each step. The scheme is that of Arnold and
    Bruels, of second order in displacements, velocities and contact forces.
    """

    def __init__(
        self, system: System, sphere: Sphere, step: float, damping: float = SPECTRAL_RADIUS
    ) -> None:
        self.system, self.sphere, self.h = system, sphere, step
        alpha_m = (2.0 * damping - 1.0) / (damping + 1.0)
        alpha_f = damping / (damping + 1.0)
        self.gamma = 0.5 + alpha_f - alpha_m
        self.beta = 0.25 * (1.0 + alpha_f - alpha_m) ** 2
        self.keep = alpha_f / (1.0 - alpha_m), alpha_m / (1.0 - alpha_m)
        self.c = (1.0 - alpha_f) / (1.0 - alpha_m)
        self.s = self.beta * step**2 * self.c
        self.solver = factorised(system.mass + self.s * system.stiffness)
        columns = _unit_forces(system, self.solver)
        self.predictor = np.ascontiguousarray((system.mass @ columns).T)
        self.compliance = self.s * (columns[system.contact_nodes] + 1.0 / sphere.mass)
        self.profile = sphere.profile(system.contact_radii)
        # The sphere is the last unknown, downwards.
        self.state = ElementState.at_rest(system.free.size + 1)
        self.state.v[-1] = sphere.speed
        self.active = np.zeros(system.contact_nodes.size, dtype=bool)

    def advance(self) -> Double:
        """Compute one step; return the contact forces [N] at the nodes."""
        h, old, mass = self.h, self.state, self.sphere.mass
        rest = self.keep[0] * old.real - self.keep[1] * old.a
        start = old.q + h * old.v + h**2 * ((0.5 - self.beta) * old.a + self.beta * rest)
        gap = self.profile - start[-1] - self.predictor @ start[:-1]
        force, self.active = contact_forces(self.compliance, gap, self.active)
        load = self.system.mass @ start[:-1]
        load[self.system.contact_nodes] -= self.s * force
        q = np.append(self.solver.solve(load), start[-1] - self.s * force.sum() / mass)
        real = (q - start) / self.s
        a = self.c * real + rest
        v = old.v + h * ((1.0 - self.gamma) * old.a + self.gamma * a)
        self.state = ElementState(q, v, a, real)
        return force

    def energy(self) -> float:
        """Return the energy of plate and sphere [J]."""
        q, v = self.state.q[:-1], self.state.v[:-1]
        plate = v @ (self.system.mass @ v) + q @ (self.system.stiffness @ q)
        return float(plate + self.sphere.mass * self.state.v[-1] ** 2) / 2.0


@dataclass(frozen=True)
class ElementState:
    """Displacements q, velocities v, accelerations a of the scheme and `real` of the equations."""

    q: Double
    v: Double
    a: Double
    real: Double

    @classmethod
    def at_rest(cls, size: int) -> "ElementState":
        """Return the undeformed state, all velocities zero."""
        return cls(*(np.zeros(size) for _ in range(4)))


def simulate_impact(
    system: System, sphere: Sphere, step: float, longest: float, *, until_end: bool = True
) -> History:
    """Simulate the impact until no further contact is possible.

    Parameters
    ----------
    system, sphere
        The plate on a mesh, and the sphere.
    step
        Time step during a contact [s]; between contacts it is `FLIGHT_STEP` times as long.
    longest
        Largest duration of the impact [s].
    until_end
        Whether further contacts are computed; if not, the impact ends with the first one.

    Raises
    ------
    WideContactError
        If the contact reaches the end of the fine mesh.
    ArithmeticError
        If the impact takes longer than `longest`.
    """
    fine, coarse = Stepper(system, sphere, step), None
    brought, nodes = fine.energy(), system.contact_nodes
    rows, deepest, apart, time = [(0.0, 0.0, sphere.speed, 0.0, 0.0, 0.0)], 0.0, 0, 0.0
    crossing, parted = _crossing_time(system) if until_end else 0.0, 0.0
    while True:
        used = fine
        if apart >= GAP_STEPS and rows[-1][1] < 0.0 < sphere.speed:
            coarse = coarse or Stepper(system, sphere, FLIGHT_STEP * step)
            before, coarse.state, used = fine.state, fine.state, coarse
        force = used.advance()
        if used is coarse and force.any():
            # The next contact is computed with short steps.
            fine.state, used, apart = before, fine, -FLIGHT_STEP
            force = used.advance()
        fine.state = used.state
        if force[-1] > 0.0:
            raise WideContactError("contact: expected it within the fine mesh, got a wider one")
        total, speed, displacement = (
            float(force.sum()),
            float(fine.state.v[-1]),
            float(fine.state.q[-1]),
        )
        time += used.h
        width = float(np.max(np.flatnonzero(force), initial=-1) + 1)
        stress = system.back_face_stress(fine.state.q[:-1])
        rows.append((time, displacement, speed, total, width, stress))
        apart = 0 if total > 0.0 else apart + 1
        parted = time if total > 0.0 else parted
        deepest = max(deepest, float(np.abs(fine.state.q[nodes]).max()))
        gone = speed < 0.0 and displacement < -CLEARANCE * deepest
        ended = apart > 0 and (gone or (apart >= GAP_STEPS and not until_end))
        if ended and time >= parted + crossing:
            times, ways, speeds, forces, widths, stresses = np.array(rows).T
            return History(times, ways, speeds, forces, widths, stresses, fine.energy() / brought)
        if time > longest:
            raise ArithmeticError(f"impact: expected its end within {longest:g} s, got none")


@dataclass(frozen=True)
class ElementImpact:
    """Results of an impact.

    Parameters
    ----------
    contact_time
        Duration of the first contact [s].
    max_indentation
        Largest displacement of the sphere since first contact [m].
    max_force
        Largest contact force [N].
    max_contact_radius
        Largest contact radius: midway between the outermost touching node and the next one [m].
    restitution
        Rebound speed after the last contact over the impact speed [1].
    total_time
        Time from first contact to the end of the last contact [s].
    max_tensile_stress
        Largest stress on the axis of the back face until shear waves have crossed the thickness
        after the last contact [Pa], without the fluctuations from node to node.
    contacts
        Number of contacts that are separated by at least `GAP_STEPS` steps without contact.
    energy
        Energy of plate and sphere after the last contact, over the initial one [1].
    """

    contact_time: float
    max_indentation: float
    max_force: float
    max_contact_radius: float
    restitution: float
    total_time: float
    max_tensile_stress: float
    contacts: int
    energy: float


def results(history: History, system: System) -> ElementImpact:
    """Return the results of an impact from its history and the plate on its mesh."""
    radii, crossing = system.contact_radii, _crossing_time(system)
    spans = _spans(history.force)
    ends = [_end(history, start, stop) for start, stop in spans]
    widest = int(history.width.max())
    return ElementImpact(
        contact_time=ends[0],
        max_indentation=float(history.displacement.max()),
        max_force=_peak(history, ends[0]),
        max_contact_radius=float(radii[widest - 1] + radii[widest]) / 2.0,
        restitution=-float(history.speed[-1]) / float(history.speed[0]),
        total_time=ends[-1],
        max_tensile_stress=largest_stress(
            history.time, history.stress, ends[0], ends[-1] + crossing
        ),
        contacts=len(spans),
        energy=history.energy,
    )


def _crossing_time(system: System) -> float:
    """Return the time in which shear waves cross the thickness [s]."""
    return system.plate.thickness / system.plate.shear_wave_speed


def _spans(force: Double) -> list[tuple[int, int]]:
    """Return the numbers of the first and last step of each contact."""
    steps = np.flatnonzero(force > 0.0)
    cuts = np.flatnonzero(np.diff(steps) > GAP_STEPS)
    starts = np.concatenate((steps[:1], steps[cuts + 1]))
    stops = np.concatenate((steps[cuts], steps[-1:]))
    return [(int(a), int(b)) for a, b in zip(starts, stops, strict=True)]


def _end(history: History, start: int, stop: int) -> float:
    """Return the end of a contact [s]; force^(2/3) is assumed to decrease linearly towards it."""
    last = np.arange(max(stop - END_STEPS + 1, start), stop + 1)
    last = last[history.force[last] > 0.0]
    if last.size < 2:
        return float(history.time[stop])
    line = np.polynomial.Polynomial.fit(history.force[last] ** (2.0 / 3.0), history.time[last], 1)
    return float(line(0.0))


def _peak(history: History, contact_time: float) -> float:
    """Return the largest force [N], without the fluctuations from node to node."""
    place = int(np.argmax(history.force))
    in_window = np.abs(history.time - history.time[place]) < PEAK_WINDOW * contact_time
    in_window &= history.force > 0.0
    time = history.time[in_window]
    fit = np.polynomial.Polynomial.fit(time, history.force[in_window], 4)
    return float(fit(np.linspace(time[0], time[-1], 1001)).max())


def largest_stress(time: Double, stress: Double, contact_time: float, until: float) -> float:
    """Return the largest stress up to a time [s], from parabolas through the stress around it.

    Parameters
    ----------
    time, stress
        Evenly spaced times [s] and the stress then [Pa].
    contact_time
        Duration of the first contact [s], of which each parabola covers a part.
    """
    largest = -math.inf
    for middle in np.linspace(0.0, until, 1 + math.ceil(STRESS_TIMES * until / contact_time)):
        near = np.abs(time - middle) <= STRESS_WINDOW * contact_time
        if np.count_nonzero(near) >= STRESS_STEPS:
            t = (time[near] - middle) / contact_time
            value = np.polynomial.polynomial.polyfit(t, stress[near], 2)[0]
            largest = max(largest, float(value))
    return largest
