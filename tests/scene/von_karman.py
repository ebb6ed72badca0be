"""Independent simulation of impacts on a thin plate, with or without stretching (von Karman)."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

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
        """Points on the radius, more of them near the axis."""
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

    def force_by_stretching(self, q: Array) -> Array:
        """Return the modal forces [N] of the stretched middle plane."""
        r, nu = self.r, self.nu
        _, slopes, curvatures, _ = self.shapes
        slope = slopes @ q
        half = slope**2 / 2.0
        load = slope * (curvatures @ q) + (1.0 - nu) / r * half
        free = half - half[-1] if self.edge == "simply-supported" else half
        tension = self.tension @ load + (12.0 * self.bending_stiffness / self.thickness**2 * free)
        return -2.0 * np.pi * (self.weights * tension * slope) @ slopes

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
        stretched = -q @ self.force_by_stretching(q)
        return float(stretched / (q @ (stiffnesses * q)) * (self.thickness / (centre @ q)) ** 2)


def impact(
    plate: ThinPlate, mass: float, stiffness: float, speed: float, stretched: bool
) -> dict[str, float]:
    """Simulate the impact of a sphere with the Hertz force stiffness times indentation^(3/2).

    The modes move exactly between impulses of the contact force and of stretching. The simulation
    ends when the sphere has been above the plate for three times the time of the last contact.
    """
    centre, omega = plate.shapes[-1], plate.frequencies
    contact = 2.9 * (mass**2 / (stiffness**2 * speed)) ** 0.2
    dt = min(contact / 100.0, 0.25 / omega[-1])
    cosine, sine = np.cos(omega * dt), np.sin(omega * dt)
    q, rate, y, v, t = 0.0 * omega, 0.0 * omega, 0.0, speed, 0.0
    first, last = 0.0, contact
    peak = depth = deflected = 0.0
    q_push, y_push = 0.0 * omega, 0.0
    while t < 3.0 * last or v > 0.0 or y > -deflected:
        rate, v = rate + dt / 2.0 * q_push, v + dt / 2.0 * y_push
        q, rate = q * cosine + rate / omega * sine, rate * cosine - q * omega * sine
        y, t = y + v * dt, t + dt
        force = stiffness * max(y - centre @ q, 0.0) ** 1.5
        pull = plate.force_by_stretching(q) if stretched else 0.0
        q_push, y_push = (force * centre + pull) / plate.masses, -force / mass
        rate, v = rate + dt / 2.0 * q_push, v + dt / 2.0 * y_push
        peak, depth = max(peak, force), max(depth, y)
        deflected = max(deflected, abs(centre @ q))
        last = t if force else last
        first = t if not first and not force else first
    return {
        "contact_time": first, "max_indentation": depth, "max_force": peak,
        "max_contact_radius": peak ** (1.0 / 3.0), "restitution": -v / speed,
    }  # fmt: skip
