"""Independent simulation of impacts on a thin plate, with or without stretching (von Karman)."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.optimize import brentq
from scipy.special import i0e, i1e, j0, j1

Array = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class ThinPlate:
    """Modes of a circular thin plate, and the forces by stretching of its middle plane.

    Parameters
    ----------
    young, nu, density
        Elastic constants and density [Pa, 1, kg/m^3].
    thickness, radius
        Dimensions [m].
    edge
        `clamped`, `simply-supported` (free in its plane) or `paper`.
    modes, points
        Number of modes, and of points on the radius.
    """

    young: float
    nu: float
    density: float
    thickness: float
    radius: float
    edge: str
    modes: int = 30
    points: int = 150

    @cached_property
    def r(self) -> Array:
        """Points on the radius, denser near the axis."""
        return self.radius * np.linspace(0.0, 1.0, self.points + 1)[1:] ** 1.5

    @cached_property
    def bending_stiffness(self) -> float:
        return self.young * self.thickness**3 / 12.0 / (1.0 - self.nu**2)

    @cached_property
    def wave_numbers(self) -> Array:
        """Wave numbers of the modes times the radius."""

        def at_edge(k: float) -> float:
            if self.edge == "paper":
                return float(j0(k))
            clamped = j0(k) * i1e(k) + j1(k) * i0e(k)
            if self.edge == "clamped":
                return float(clamped)
            return float((1.0 - self.nu) * clamped - 2.0 * k * j0(k) * i0e(k))

        grid = np.arange(0.5, np.pi * (self.modes + 3), 0.1)
        values = [at_edge(k) for k in grid]
        changes = np.flatnonzero(np.diff(np.sign(values)))[: self.modes]
        return np.array([brentq(at_edge, grid[i], grid[i + 1], xtol=1e-13) for i in changes])

    @cached_property
    def shapes(self) -> tuple[Array, Array, Array, Array]:
        """Deflection, slope and curvature of each mode on the radius, and deflection at 0."""
        k = self.wave_numbers
        x, per = np.outer(self.r / self.radius, k), k / self.radius
        ratio = 0.0 if self.edge == "paper" else j0(k) / i0e(k)
        grown = ratio * np.exp(x - k)
        deflection = j0(x) - grown * i0e(x)
        slope = -(j1(x) + grown * i1e(x)) * per
        curvature = -(j0(x) - j1(x) / x + grown * (i0e(x) - i1e(x) / x)) * per**2
        return deflection, slope, curvature, 1.0 - ratio * np.exp(-k)

    @cached_property
    def frequencies(self) -> Array:
        mass = self.density * self.thickness
        return np.sqrt(self.bending_stiffness / mass) * (self.wave_numbers / self.radius) ** 2

    @cached_property
    def masses(self) -> Array:
        """Modal masses."""
        deflection, *_, centre = self.shapes
        r, w = np.r_[0.0, self.r], np.vstack([centre, deflection])
        square = np.trapezoid(w**2 * r[:, None], r, axis=0)
        return 2.0 * np.pi * self.density * self.thickness * square

    @cached_property
    def tension(self) -> Array:
        """Matrix from the load of the middle plane to its radial force per length [N/m].

        The middle plane is in equilibrium: u'' + u'/r - u/r^2 = -load.
        """
        r, nu = self.r, self.nu
        load = np.vstack([np.zeros(r.size), np.eye(r.size)])
        whole = np.r_[0.0, r]
        zeroth = cumulative_trapezoid(load, whole, axis=0)
        second = cumulative_trapezoid(load * whole[:, None] ** 2, whole, axis=0)
        own = -(1.0 + nu) / 2.0 * zeroth - (1.0 - nu) / 2.0 * second / r[:, None] ** 2
        shift = {
            "clamped": (1.0 + nu) / 2.0 * (zeroth[-1] - second[-1] / r[-1] ** 2),
            "simply-supported": -own[-1],
            "paper": (1.0 + nu) / 2.0 * zeroth[-1],
        }[self.edge]
        return 12.0 * self.bending_stiffness / self.thickness**2 * (own + shift)

    def stretched(self, q: Array) -> tuple[Array, Array]:
        """Return the radial force of the middle plane per length [N/m], and the slope."""
        r, nu = self.r, self.nu
        _, slopes, curvatures, _ = self.shapes
        slope = slopes @ q
        half = slope**2 / 2.0
        load = slope * (curvatures @ q) + (1.0 - nu) / r * half
        # N_r vanishes on a supported edge, and N_r + N_phi on the paper's.
        fixed = {"simply-supported": 1.0, "paper": (1.0 + nu) / 2.0}.get(self.edge, 0.0)
        free = half - fixed * half[-1]
        own = self.tension @ load
        return own + 12.0 * self.bending_stiffness / self.thickness**2 * free, slope

    def force_by_stretching(self, tension: Array, slope: Array) -> Array:
        """Return the modal forces [N] of the stretched middle plane."""
        return -2.0 * np.pi * (self.weights * tension * slope) @ self.shapes[1]

    def in_plane(self, count: int) -> "InPlane":
        """Return modes of the middle plane in its plane."""
        nu, b = self.nu, self.radius

        def at_edge(k: float) -> float:
            held = {"clamped": j1(k), "paper": j0(k)}
            return float(held.get(self.edge, k * j0(k) - (1.0 - nu) * j1(k)))

        grid = np.arange(0.3, np.pi * (count + 3), 0.1)
        values = [at_edge(k) for k in grid]
        changes = np.flatnonzero(np.diff(np.sign(values)))[:count]
        k = np.array([brentq(at_edge, grid[i], grid[i + 1], xtol=1e-13) for i in changes])
        x = np.outer(self.r / b, k)
        strains = (k / b) * j0(x) - (1.0 - nu) * j1(x) / self.r[:, None]
        area = b * b * (j0(k) ** 2 + j1(k) ** 2 - 2.0 * j0(k) * j1(k) / k)
        stiffness = 12.0 * self.bending_stiffness / self.thickness**2
        masses = np.pi * self.density * self.thickness * area
        frequencies = np.sqrt(stiffness / (self.density * self.thickness)) * k / b
        return InPlane(strains, masses, frequencies, stiffness)

    @cached_property
    def bending_stresses(self) -> Array:
        """Bending stress of each mode on the axis of the face opposite the load [Pa/m]."""
        k = self.wave_numbers
        ratio = 0.0 if self.edge == "paper" else j0(k) / i0e(k)
        curvature = (1.0 + ratio * np.exp(-k)) * (k / self.radius) ** 2 / 2.0
        return self.young * self.thickness / (2.0 * (1.0 - self.nu)) * curvature

    @cached_property
    def weights(self) -> Array:
        """Weights of r in integrals over the radius of functions that vanish on the axis."""
        whole = np.r_[0.0, self.r, self.r[-1]]
        return (whole[2:] - whole[:-2]) / 2.0 * self.r

    def stiffening(self) -> float:
        """Return the relative stiffening over (w/H)^2 under a small static load on the axis."""
        centre = self.shapes[-1]
        stiffnesses = self.masses * self.frequencies**2
        q = centre / stiffnesses
        stretched = -q @ self.force_by_stretching(*self.stretched(q))
        return float(stretched / (q @ (stiffnesses * q)) * (self.thickness / (centre @ q)) ** 2)


class InPlane(NamedTuple):
    """Modes of the middle plane: u' + nu u/r on the radius, masses, frequencies; stiffness."""

    strains: Array
    masses: Array
    frequencies: Array
    stiffness: float


class Motion(NamedTuple):
    """Rate of the indentation after a time step: `rate` minus `softness` times the force."""

    rate: float
    softness: float
    dt: float


@dataclass
class Hertz:
    """An elastic contact with the force `stiffness` times depth^(3/2)."""

    stiffness: float

    def press(self, depth: float, motion: "Motion") -> tuple[float, float]:
        """Return the force, and a number proportional to the contact radius, after a time step."""
        del motion  # only a viscoelastic force depends on it
        depth = max(depth, 0.0)
        return self.stiffness * depth**1.5, math.sqrt(depth)


@dataclass
class Viscoelastic(Hertz):
    """A viscoelastic contact without tensile force; the face recovers after separation."""

    retardation_time: float
    face: float = 0.0
    touching: bool = False

    def press(self, depth: float, motion: "Motion") -> tuple[float, float]:
        if not self.touching:
            self.face *= math.exp(-2.0 / 3.0 * motion.dt / self.retardation_time)
            self.touching = depth > self.face
        if not self.touching:
            return 0.0, 0.0
        elastic, radius = super().press(depth, motion)
        lag = 1.5 * self.stiffness * radius * self.retardation_time
        force = (elastic + lag * motion.rate) / (1.0 + lag * motion.softness)
        self.face, self.touching = depth, force > 0.0
        return (force, radius) if self.touching else (0.0, 0.0)


@dataclass
class Plastic(Hertz):
    """A plastic contact of a sphere; it yields above the contact radius `onset` [m] of Hertz."""

    radius: float
    onset: float
    largest: float = 0.0
    flattening: float = 1.0
    dent: float = 0.0

    def press(self, depth: float, motion: "Motion") -> tuple[float, float]:
        del motion
        u = math.sqrt(max(depth - self.dent, 0.0) * self.radius / self.flattening)
        if u > max(self.largest, self.onset):
            cube = (3.0 * depth * self.radius / self.onset**2 - 1.0) / 2.0
            u = self.onset * math.cbrt(cube)
            area = self.onset**2 * (2.0 * cube + 1.0) / 3.0
            self.largest, self.flattening = u, u / math.sqrt(area)
            self.dent = (area - self.flattening * u**2) / self.radius
        return self.stiffness * (u / math.sqrt(self.radius)) ** 3, u / self.flattening


def impact(
    plate: ThinPlate,
    mass: float,
    contact: Hertz,
    speed: float,
    stretched: bool,
    loss_factor: float = 0.0,
    in_plane: int = 0,
    static_plane: bool = False,
) -> dict[str, float]:
    """Simulate the impact of a sphere.

    With a number `in_plane` of modes the middle plane has inertia in its plane; with `static_plane`
    these modes only determine the time step.

    The modes move exactly between impulses of the contact force and of stretching. The simulation
    ends when the sphere has been above the plate for three times the time of the last contact.
    """
    plane = plate.in_plane(in_plane)
    bending, none = plate.frequencies.size, np.zeros(in_plane)
    centre = np.append(plate.shapes[-1], none)
    omega = np.append(plate.frequencies, plane.frequencies)
    masses = np.append(plate.masses, plane.masses)
    damping = np.append(np.full(bending, loss_factor / 2.0), none)
    duration = 2.9 * (mass**2 / (contact.stiffness**2 * speed)) ** 0.2
    dt = min(duration / 100.0, 0.25 / np.max(omega))
    slower = np.sqrt(1.0 - damping**2)
    decay = np.exp(-damping * omega * dt)
    cosine, sine = decay * np.cos(slower * omega * dt), decay * np.sin(slower * omega * dt) / slower
    q, rate, y, v, t = 0.0 * omega, 0.0 * omega, 0.0, speed, 0.0
    first, last = 0.0, duration
    peak = depth = deflected = widest = stress = largest = 0.0
    q_push, y_push, pull = 0.0 * omega, 0.0, 0.0 * omega
    softness = dt / 2.0 * (1.0 / mass + float(np.sum(centre**2 / masses)))
    while t < 3.0 * last or v > 0.0 or y > -deflected:
        rate, v = rate + dt / 2.0 * q_push, v + dt / 2.0 * y_push
        q, rate = (
            q * (cosine + damping * sine) + rate / omega * sine,
            rate * (cosine - damping * sine) - q * omega * sine,
        )
        y, t = y + v * dt, t + dt
        bent = float(plate.bending_stresses @ q[:bending])
        if stretched:
            tension, slope = plate.stretched(q[:bending])
            pushed = none
            if in_plane and not static_plane:
                half = slope**2 / 2.0
                tension = plane.stiffness * (half + plane.strains @ q[bending:])
                pushed = -2.0 * np.pi * plane.stiffness * (plate.weights * half) @ plane.strains
            pull = np.append(plate.force_by_stretching(tension, slope), pushed) / masses
            bent += float(tension[0]) / plate.thickness
        closing = v - centre @ (rate + dt / 2.0 * pull)
        force, radius = contact.press(y - centre @ q, Motion(closing, softness, dt))
        q_push, y_push = force * centre / masses + pull, -force / mass
        rate, v = rate + dt / 2.0 * q_push, v + dt / 2.0 * y_push
        peak, depth, widest = max(peak, force), max(depth, y), max(widest, radius)
        deflected = max(deflected, abs(centre @ q))
        stress = max(stress, bent)
        last, largest = (t, stress) if force else (last, largest)
        first = t if not first and not force else first
    return {
        "contact_time": first, "max_indentation": depth, "max_force": peak,
        "max_contact_radius": widest, "restitution": -v / speed, "max_tensile_stress": largest,
        "deflection": deflected,
    }  # fmt: skip
