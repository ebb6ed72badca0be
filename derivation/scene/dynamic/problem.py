"""The problem of an impact on a plate with inertia in units of m, v0 and T, and its states."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from derivation.scene.contact_law.yielding import Yielding
from derivation.scene.dynamic.contact_tables import ContactSamples, ContactTables
from derivation.scene.dynamic.middle_plane import MiddlePlane
from derivation.scene.dynamic.modal import Indices
from derivation.scene.dynamic.oscillators import FreeMotion
from generated.arrays import Double as Array

MOST_RECOVERED = 700.0
"""Time over A_v beyond which a face has recovered to the smallest double."""
POWERS = 14
"""Number of exponential functions of time in the force of a shape while a face recovers."""
RECOVERY = (1.0 + np.cos(np.pi * np.arange(POWERS * 2) / (POWERS * 2))) / 2.0
"""Radii of a face that recovers, over that at separation, by Hertz's law."""
PART = 32768
"""Number of values of modes at nodes that are computed at once, so that they fit in the cache."""


class ImpactState(NamedTuple):
    """Displacement and velocity of the sphere, deflection and velocity of the modes.

    `approach` is the displacement of the sphere minus the deflection of the plate. It is
    integrated, because the difference would be inaccurate if it is far smaller than both.
    """

    displacement: float
    velocity: float
    q: Array
    q_dot: Array
    approach: float

    @property
    def separation_speed(self) -> float:
        """Velocity of the plate less that of the sphere; positive if they separate."""
        return float(self.q_dot.sum()) - self.velocity


@dataclass(frozen=True)
class DynamicProblem:
    """A scene in units of m, v0 and T; the unit of forces is m v0/T, that of depths v0 T.

    Attributes
    ----------
    contact
        Tables of the contact.
    a, T, m, v0
        Units of radius [m] and time [s], mass [kg] and speed [m/s].
    weight
        Gravitational acceleration during contact, in units of v0/T.
    retardation_time
        A_v over T.
    first_echo
        Time after which waves may return from the edge, for an infinite plate; else infinite.
    damping_ratio
        Damping ratio of each mode [1].
    yielding
        The current branch of a plastic contact; None without plasticity.
    limit
        Largest contact radius [m] of the contact law; infinite if it is not checked.
    range_end
        This limit in words.
    bending_fraction
        Fraction of the static compliance of each shape that is bending, and thus elastic in a
        viscoelastic contact [1].
    middle_plane
        The middle plane, if it stretches.
    rough_plane
        The same with few shapes, for flights that need not be accurate; None without enough shapes.
    """

    contact: ContactTables
    a: float
    T: float
    m: float
    v0: float
    weight: float = 0.0
    retardation_time: float = 0.0
    first_echo: float = math.inf
    damping_ratio: float = 0.0
    yielding: Yielding | None = None
    limit: float = math.inf
    range_end: str = ""
    bending_fraction: Array | float = 1.0
    middle_plane: MiddlePlane | None = None
    rough_plane: MiddlePlane | None = None

    @property
    def force(self) -> float:
        """Unit of forces [N]."""
        return self.m * (self.v0 / self.T)

    @property
    def depth(self) -> float:
        """Unit of depths [m]."""
        return self.v0 * self.T

    @cached_property
    def omega(self) -> Array:
        """Angular frequencies of the modes, in units of 1/T."""
        return self.contact.modes.omega * self.T

    @cached_property
    def fastest(self) -> float:
        """Largest angular frequency, in units of 1/T; 0 without modes."""
        return float(np.max(self.omega, initial=0.0))

    @cached_property
    def inverse_modal_mass(self) -> Array:
        """Acceleration of each mode by a unit force, in units of 1/m."""
        return self.contact.modes.inverse_modal_mass * self.m

    @cached_property
    def strength(self) -> Array:
        """Amplitude of each mode after a unit impulse: inverse modal mass over omega."""
        return self.inverse_modal_mass / self.omega

    def lagging(self, radius: float, t: Array) -> tuple[Array, Array]:
        """Return deflection and velocity of each mode by the face that recovers.

        After a viscoelastic contact P = 0, and P_e = P_e(radius) exp(-t/A_v) drives all deflection
        other than bending. By Hertz's law the radius decreases as exp(-t/(3 A_v)), and the force
        that drives a shape is expanded in powers of this function.

        Parameters
        ----------
        radius
            Contact radius at separation; above 0.
        t
            Times after it.
        """
        if radius not in self._recoveries:
            self._recoveries[radius] = self._recovering_forces(radius)
        forces = self._recoveries[radius]
        driving = ((1.0 - self.bending_fraction) * forces)[:, self.contact.modes.shape]
        rates = (1.0 + np.arange(POWERS)[:, None] / 3.0) / self.retardation_time
        stiff = self.omega**2 + rates * (rates - 2.0 * self.damping_ratio * self.omega)
        deflections = self.inverse_modal_mass * driving / stiff
        left = np.exp(-np.minimum(np.multiply.outer(t, rates[:, 0]), MOST_RECOVERED))
        return left @ deflections, -left @ (rates * deflections)

    @cached_property
    def _recoveries(self) -> dict[float, Array]:
        return {}

    def _recovering_forces(self, radius: float) -> Array:
        """Return the coefficients of `lagging`, shape (powers, shapes).

        The force and its rate at separation are exact, because the gap opens slowly at first. The
        remainder is fitted, because a wide contact drives short waves with alternating signs as its
        radius decreases.
        """
        at = self.contact.at(np.array([self.a * radius]))
        modal_forces, narrow = (
            at.modal_forces[0],
            at.forces_a[0, 1:] * (at.force[0] / at.force_a[0]),
        )
        forces = np.zeros((POWERS, modal_forces.size))
        forces[0], forces[3] = 2.0 * modal_forces - narrow, narrow - modal_forces
        x = RECOVERY[:, None]
        a = self.recovering(radius, -3.0 * np.log(RECOVERY))
        rest = self.contact.forces(self.a * a)[:, 1:] / x**3 - forces[0] - x**3 * forces[3]
        basis = (1.0 - x) ** 2 * x ** np.arange(POWERS - 2)
        more = np.linalg.lstsq(basis, rest, rcond=None)[0]
        forces[:-2] += more
        forces[1:-1] -= 2.0 * more
        forces[2:] += more
        return forces / self.force

    def recovering(self, radius: float, t: Array) -> Array:
        """Return the radius of the face after times without force, over A_v: P_e = exp(-t)."""
        grid = radius * np.linspace(0.0, 1.0, 64)
        root = np.cbrt(self.contact.at(self.a * grid).force)
        goal = root[-1] ** 3 * np.exp(-t)
        a = np.interp(np.cbrt(goal), root, grid)
        for _ in range(3):
            a = a * np.cbrt(goal / self.contact.at(self.a * a).force)
        return np.asarray(a, dtype=np.float64)

    def freed(self, state: ImpactState, radius: float, t: float, sign: float = 1.0) -> ImpactState:
        """Return a state without the deflection of `lagging`, which belongs to the face.

        Its modes move freely. With `sign` = -1 the deflection is added again.
        """
        [lagging], [rate] = self.lagging(radius, np.array([t]))
        return state._replace(
            q=state.q - sign * lagging,
            q_dot=state.q_dot - sign * rate,
            approach=state.approach + sign * float(np.sum(lagging)),
        )

    def parts(self, n: int) -> tuple["Part", ...]:
        """Return the modes in parts, whose values at n nodes fit in the cache."""
        return tuple(map(Part._make, self.contact.modes.parts(max(1, PART // n))))

    @cached_property
    def by_speed(self) -> NDArray[np.intp]:
        """Indices of the modes, the slowest first."""
        return np.argsort(self.omega, kind="stable")

    def at(self, a: Array) -> ContactSamples:
        """Return the contact at radii [m], with the depth added by yielding."""
        samples = self.contact.at(a)
        if self.yielding is None:
            return samples
        depth, depth_a = self.yielding.added(samples.force, samples.force_a)
        return samples._replace(depth=samples.depth + depth, depth_a=samples.depth_a + depth_a)

    def begin(self) -> ImpactState:
        """Return the state at first contact."""
        none = np.zeros_like(self.omega)
        return ImpactState(0.0, 1.0, none, none, 0.0)

    def energies(self, state: ImpactState) -> Array:
        """Return the energy of each mode, in units of m v0^2."""
        return (state.q_dot**2 + (self.omega * state.q) ** 2) / (2.0 * self.inverse_modal_mass)

    def flight_loss(self, state: ImpactState, t: float) -> float:
        """Return the energy dissipated by damping in free flight, in units of m v0^2."""
        if not self.damping_ratio:
            return 0.0
        from generated.damping_kernels import free_loss

        swing, phase = self.omega * state.q, self.omega * t
        lost = free_loss(phase, np.asarray(self.damping_ratio), swing, state.q_dot)
        return float(np.sum(lost / self.inverse_modal_mass))

    def flown(self, state: ImpactState, t: float) -> ImpactState:
        """Return the state after free flight for a time."""
        bent, q_dot = self._vibrated(state, t)
        fallen = 0.5 * self.weight * t * t
        return ImpactState(
            state.displacement + state.velocity * t + fallen,
            state.velocity + self.weight * t,
            state.q + state.q_dot * t + bent,
            q_dot,
            state.approach - state.separation_speed * t + (fallen - float(np.sum(bent))),
        )

    def flights(self, state: ImpactState, t: Array, radius: float) -> Array:
        """Return velocity, displacement, plate deflection and plate energy after free flights.

        Shape (4, times). `flown` returns the whole state after one of them. Deflection and energy
        include the part that recovers with a viscoelastic face, whose radius at separation is above
        0.
        """
        bent, q_dot = self._vibrated(state, t[:, None])
        q = state.q + state.q_dot * t[:, None] + bent
        if self.retardation_time:
            lagging, rate = self.lagging(radius, t)
            q, q_dot = q + lagging, q_dot + rate
        after = state._replace(q=q, q_dot=q_dot)
        velocity = state.velocity + self.weight * t
        displacement = state.displacement + (state.velocity + velocity) / 2.0 * t
        energy = np.sum(self.energies(after), axis=-1)
        return np.array([velocity, displacement, np.sum(after.q, axis=-1), energy])

    def deflections(self, state: ImpactState, t: Array, modes: Indices | slice) -> Array:
        """Return the deflection of some modes after free flights, shape (times, modes)."""
        q, q_dot, t = state.q[modes], state.q_dot[modes], t[:, None]
        free = FreeMotion(t * self.omega[modes], self.damping_ratio)
        return np.asarray(q + q_dot * t + (q_dot * t * free.by_rate - q * free.by_q))

    def _vibrated(self, state: ImpactState, t: float | Array) -> tuple[Array, Array]:
        """Return q - q_0 - q_0' t and q' of each mode after free vibration; t may be a column."""
        free = FreeMotion(t * self.omega, self.damping_ratio)
        bent = state.q_dot * t * free.by_rate - state.q * free.by_q
        return bent, state.q_dot * free.cos - state.q * self.omega * free.sin


class Part(NamedTuple):
    """Some shapes with all their modes.

    `shape` is the index of the shape of each mode, and `first` the index of the first mode of each
    shape, both counted within the part.
    """

    shapes: slice
    modes: slice
    shape: NDArray[np.intp]
    first: NDArray[np.intp]

    def by_mode(self, values: Array) -> Array:
        """Return the value of its shape for each mode."""
        return values if self.first.size == self.shape.size else values[..., self.shape]

    def by_shape(self, values: Array) -> Array:
        """Return the sum over the modes of each shape."""
        if self.first.size == self.shape.size:
            return values
        return np.asarray(np.add.reduceat(values, self.first, axis=-1), dtype=np.float64)
