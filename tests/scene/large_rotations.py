"""Independent simulation of impacts on a thin plate with large rotations, by finite elements.

The plate is a shell of revolution without shear (Reissner, 1949). A point at r moves to r + u in
its plane and by w across it. With X = 1 + u' and the length ratio L^2 = X^2 + w'^2, its normal
turns by the angle b with sin b = w'/L. The strains and curvatures are, radially and around,

    von Karman   u' + w'^2/2,    u/r,               w'',    w'/r
    angle        L - 1,          u/r,               b',     sin b/r
    Green        (L^2 - 1)/2,    u/r + u^2/(2 r^2), L b',   (1 + u/r) sin b/r

Forces and moments are linear in them: Green's strain is that of the St. Venant-Kirchhoff material.
The two exact theories differ by terms that are as small as the strain. Rotary inertia is neglected;
inertia in the plane is optional. The contact is that of `von_karman`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, NamedTuple

import numpy as np
from scipy.linalg import eigh

from tests.scene.von_karman import Hertz, Motion

Array = np.ndarray[Any, np.dtype[np.float64]]
Theory = Literal["von Karman", "angle", "Green"]
POINTS = 3
"""Gauss points of an element."""
TURNS = 60
"""Largest number of iterations."""
SLOW = 6
"""Number of iterations after which a stiffness is renewed."""
TINY = 1e-30
"""Imaginary step of a derivative."""


class Strains(NamedTuple):
    """Strains and curvatures, and the work of forces and moments.

    `values` are those radially and around, first the strains. `work` returns what does work by w',
    w'', u/r, u' and u'', of the two forces and two moments that do work by `values`.
    """

    values: tuple[Array, Array, Array, Array]
    work: Callable[[Array, Array, Array, Array], tuple[Array, Array, Array, Array, Array]]


def strains(theory: Theory, r: Array, w: tuple[Array, Array], u: tuple[Array, ...]) -> Strains:
    """Return strains and curvatures at points r for w', w'' and u/r, u', u''."""
    Y, bent, hoop, long, longer = *w, *u
    if theory == "von Karman":
        return Strains(
            (long + Y * Y / 2.0, hoop, bent, Y / r),
            lambda N, around, M, turning: (N * Y + turning / r, M, around, N, 0.0 * M),
        )
    X = 1.0 + long
    strain = long + (long * long + Y * Y) / 2.0  # (L^2 - 1)/2 without cancellation
    square = 1.0 + 2.0 * strain
    L = np.sqrt(square)
    sine, turned, wider = Y / L, (X * bent - Y * longer) / square, 1.0 + hoop

    def of_angle(
        N: Array, around: Array, M: Array, turning: Array
    ) -> tuple[Array, Array, Array, Array, Array]:
        M, tilt = M / square, turning / (r * square * L)
        along = N / L - 2.0 * turned * M
        by_slope = along * Y - M * longer + tilt * X * X
        return by_slope, M * X, around, along * X + M * bent - tilt * X * Y, -M * Y

    if theory == "angle":
        return Strains((2.0 * strain / (L + 1.0), hoop, turned, sine / r), of_angle)
    return Strains(
        (strain, hoop + hoop * hoop / 2.0, L * turned, wider * sine / r),
        lambda N, around, M, turning: of_angle(
            L * N + turned * M, wider * around + sine / r * turning, L * M, wider * turning
        ),
    )


@dataclass(frozen=True)
class Shell:
    """Finite elements of a circular plate, cubic in w and in u.

    Parameters
    ----------
    young, nu, density
        Elastic constants and density [Pa, 1, kg/m^3].
    thickness, radius
        Dimensions [m].
    edge
        `clamped`, `simply-supported` (free in its plane), `paper` (springs against rotation and in
        the plane), or `free`.
    elements
        Number of elements on the radius.
    hole
        Radius of a hole with a clamped edge [m]; 0 for none.
    """

    young: float
    nu: float
    density: float
    thickness: float
    radius: float
    edge: str
    elements: int = 24
    hole: float = 0.0

    @cached_property
    def nodes(self) -> Array:
        """Nodes, denser near the axis."""
        part = np.linspace(0.0, 1.0, self.elements + 1)
        return self.hole + (self.radius - self.hole) * part ** (1.0 if self.hole else 1.2)

    @cached_property
    def points(self) -> tuple[Array, Array]:
        """Gauss points, and weights of integrals over the plate."""
        s, weight = np.polynomial.legendre.leggauss(POINTS)
        length = np.diff(self.nodes)[:, None]
        r = (self.nodes[:-1, None] + length * (1.0 + s) / 2.0).ravel()
        return r, 2.0 * np.pi * r * (length * weight / 2.0).ravel()

    @cached_property
    def cubics(self) -> Array:
        """Values, first and second derivatives of the cubics at the points.

        The unknowns are value and slope at each node. Shape (3, points, unknowns).
        """
        s = (1.0 + np.polynomial.legendre.leggauss(POINTS)[0]) / 2.0
        found = np.zeros((3, self.elements, POINTS, 2 * self.elements + 2))
        for i, h in enumerate(np.diff(self.nodes)):
            rows = (
                (1 - 3 * s**2 + 2 * s**3, h * (s - 2 * s**2 + s**3),
                 3 * s**2 - 2 * s**3, h * (s**3 - s**2)),
                ((6 * s**2 - 6 * s) / h, 1 - 4 * s + 3 * s**2,
                 (6 * s - 6 * s**2) / h, 3 * s**2 - 2 * s),
                ((12 * s - 6) / h**2, (6 * s - 4) / h, (6 - 12 * s) / h**2, (6 * s - 2) / h),
            )  # fmt: skip
            found[:, i, :, 2 * i : 2 * i + 4] = np.moveaxis(np.array(rows), 1, 2)
        return found.reshape(3, self.elements * POINTS, -1)

    @cached_property
    def free(self) -> tuple[list[int], list[int]]:
        """Unknowns of w and of u that are not fixed."""
        last = 2 * self.elements
        w, u = ({0, 1}, {0, 1}) if self.hole else ({1}, {0})
        w = w | {"clamped": {last, last + 1}, "free": set[int]()}.get(self.edge, {last})
        u = u | {"clamped": {last}}.get(self.edge, set())
        every = range(last + 2)
        return [i for i in every if i not in w], [i for i in every if i not in u]

    @cached_property
    def stiffnesses(self) -> tuple[float, float]:
        """Stiffness of the middle plane [N/m], and of bending [N m]."""
        plane = self.young * self.thickness / (1.0 - self.nu**2)
        return plane, plane * self.thickness**2 / 12.0

    @cached_property
    def linear(self) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """Stiffness and mass matrices of w and of u."""
        (r, weights), (value, first, second) = self.points, self.cubics
        nu, (C, D), (of_w, of_u) = self.nu, self.stiffnesses, self.free

        def matrix(radial: Array, around: Array, factor: float) -> Array:
            mixed = radial.T @ (weights[:, None] * around)
            own = sum(x.T @ (weights[:, None] * x) for x in (radial, around))
            return np.asarray(factor * (own + nu * (mixed + mixed.T)))

        mass = self.density * self.thickness * value.T @ (weights[:, None] * value)
        bending = matrix(second, first / r[:, None], D)
        plane = matrix(first, value / r[:, None], C)
        if self.edge == "paper":
            bending[-1, -1] += 2.0 * np.pi * (1.0 - nu) * D
            plane[-2, -2] += 2.0 * np.pi * (1.0 - nu) * C
        w, u = np.ix_(of_w, of_w), np.ix_(of_u, of_u)
        return (bending[w], mass[w]), (plane[u], mass[u])

    def in_modes(self, modes: int, in_plane: int) -> "Reduced":
        """Return the plate in its lowest linear modes across it and in its plane, 0 for all."""
        (value, first, second), (r, _), (of_w, of_u) = self.cubics, self.points, self.free
        (square, w), (plane, u) = (eigh(*pair) for pair in self.linear)  # with masses of 1
        w, u = w[:, : modes or None], u[:, : in_plane or None]
        of_edge = [np.zeros((value.shape[1], x.shape[1])) for x in (w, u)]
        of_edge[0][of_w], of_edge[1][of_u] = w, u
        return Reduced(
            self,
            np.concatenate([first[:, of_w] @ w, second[:, of_w] @ w]).T.copy(),
            np.concatenate([x[:, of_u] @ u for x in (value / r[:, None], first, second)]).T.copy(),
            square[: w.shape[1]],
            plane[: u.shape[1]],
            w[-2] if self.edge == "free" else w[0],
            (of_edge[0][-1], of_edge[1][-2], of_edge[1][-1]),
            value[:, of_w] @ w,
        )


@dataclass(frozen=True)
class Reduced:
    """A plate in coordinates q of w and p of u, each a linear mode with a mass of 1 kg.

    Attributes
    ----------
    of_w, of_u
        w' and w'', and u/r, u' and u'' at all points, one row for each mode.
    stiffness, in_plane
        Stiffness of each mode of w and of u [N/m].
    loaded
        Deflection of each mode on the axis, or at a free edge.
    at_edge
        w', u and u' of each mode at the edge, of which the paper's has springs.
    deflection
        Deflection of each mode at the points.
    """

    shell: Shell
    of_w: Array
    of_u: Array
    stiffness: Array
    in_plane: Array
    loaded: Array
    at_edge: tuple[Array, Array, Array]
    deflection: Array

    def forces(self, theory: Theory, q: Array, p: Array) -> tuple[Array, Array, Array]:
        """Return the derivatives of the energy by q and by p, and the energy."""
        (r, weights), nu, (C, D) = self.shell.points, self.shell.nu, self.shell.stiffnesses
        w, u, n = q @ self.of_w, p @ self.of_u, r.size
        at = strains(
            theory, r, (w[..., :n], w[..., n:]), (u[..., :n], u[..., n : 2 * n], u[..., 2 * n :])
        )
        radial, around, bent, turned = at.values
        plane, bending = C * weights, D * weights
        held = (
            plane * (radial + nu * around),
            plane * (around + nu * radial),
            bending * (bent + nu * turned),
            bending * (turned + nu * bent),
        )
        by = at.work(*held)
        by_q = np.concatenate(by[:2], axis=-1) @ self.of_w.T
        by_p = np.concatenate(by[2:], axis=-1) @ self.of_u.T
        products = [one * value for one, value in zip(held, at.values, strict=True)]
        energy = 0.5 * np.sum(np.stack(products), axis=(0, -1))
        if self.shell.edge != "paper":
            return by_q, by_p, energy
        slope, moved, X = q @ self.at_edge[0], p @ self.at_edge[1], 1.0 + p @ self.at_edge[2]
        angle, by_slope, by_X = slope, 1.0, 0.0
        if theory != "von Karman":
            square = X * X + slope * slope
            angle, by_slope, by_X = np.arctan(slope / X), X / square, -slope / square
        spring = 2.0 * np.pi * (1.0 - nu)
        by_q = by_q + np.multiply.outer(spring * D * angle * by_slope, self.at_edge[0])
        by_p = by_p + np.multiply.outer(spring * D * angle * by_X, self.at_edge[2])
        by_p = by_p + np.multiply.outer(spring * C * moved, self.at_edge[1])
        return by_q, by_p, energy + spring / 2.0 * (D * angle**2 + C * moved**2)

    def at_rest(self, theory: Theory, q: Array, p: Array, inverse: Array) -> tuple[Array, Array]:
        """Return p of a middle plane in equilibrium for q, and the inverse of a near stiffness.

        Both are improved from a guess. The stiffness is renewed if the iteration is slow.
        """
        for turn in range(1, TURNS):
            step = inverse @ self.forces(theory, q, p)[1]
            p = p - step
            if self.in_plane @ step**2 <= 1e-13 * self.in_plane @ p**2:
                return p, inverse
            if turn % SLOW == 0:
                moved = p + 1j * TINY * np.eye(p.size)
                by_p = self.forces(theory, np.broadcast_to(q, (p.size, q.size)), moved)[1]
                inverse = np.linalg.inv(np.imag(by_p) / TINY)
        raise ArithmeticError("the middle plane has not converged")

    def static(self, theory: Theory, load: Array, steps: int = 4) -> tuple[Array, Array]:
        """Return q and p under modal forces, by Newton's method in load steps."""
        scale = 1.0 / np.sqrt(np.append(self.stiffness, self.in_plane))
        n = self.stiffness.size
        z, push = 0.0 * scale, np.append(load, 0.0 * self.in_plane)
        moved = 1j * TINY * np.diag(scale)
        for part in np.arange(1, steps + 1) / steps:
            for _ in range(TURNS):
                by = self.forces(theory, (z + moved)[:, :n], (z + moved)[:, n:])
                tangent = np.imag(np.hstack(by[:2])) / TINY * scale
                left = part * push - np.hstack(self.forces(theory, z[:n], z[n:])[:2])
                step = np.linalg.solve(tangent, scale * left)
                z = z + scale * step
                if np.linalg.norm(step) <= 1e-6 * np.linalg.norm(z / scale):
                    break
            else:
                raise ArithmeticError("the static deflection has not converged")
        return z[:n], z[n:]


def impact(
    plate: Reduced,
    theory: Theory | None,
    mass: float,
    contact: Hertz,
    speed: float,
    linear: tuple[Array, Array],
    in_plane: bool = False,
) -> dict[str, float]:
    """Simulate the impact of a sphere on the axis; a plate without a theory is linear.

    The modes move exactly between impulses of the contact force and of all other forces.

    Parameters
    ----------
    linear
        Angular frequencies of the modes, and their masses for a deflection of 1 on the axis.
    in_plane
        Whether the middle plane has inertia in its plane; otherwise it is in equilibrium.
    """
    share = 1.0 / (np.sqrt(linear[1]) * np.abs(plate.loaded))  # the masses are 1 for q of the shell
    n, plane, held = plate.stiffness.size, plate.in_plane, plate.stiffness
    omega = np.append(linear[0], np.sqrt(plane) if in_plane else [])
    centre = np.append(share * plate.loaded, np.zeros(omega.size - n))
    duration = 2.9 * (mass**2 / (contact.stiffness**2 * speed)) ** 0.2
    dt = min(duration / 100.0, 0.25 / float(np.max(omega)))
    cosine, sine, still = np.cos(omega * dt), np.sin(omega * dt), Motion(0.0, 0.0, dt)
    q, rate, push = np.zeros((3, omega.size))
    p, before, earlier = np.zeros((3, plane.size))
    inverse = np.diag(1.0 / plane)
    y, v, t, y_push, first, last = 0.0, speed, 0.0, 0.0, 0.0, duration
    peak = depth = deflected = widest = stored = 0.0
    while v > 0.0 or y > -1.2 * deflected or t < 1.2 * last:
        rate, v = rate + dt / 2.0 * push, v + dt / 2.0 * y_push
        q, rate = q * cosine + rate / omega * sine, rate * cosine - q * omega * sine
        y, t = y + v * dt, t + dt
        pull = np.zeros(omega.size)
        if theory is not None:
            w = share * q[:n]
            if in_plane:
                p = q[n:]
            else:
                guess = 3.0 * (p - before) + earlier
                before, earlier = p, before
                p, inverse = plate.at_rest(theory, w, guess, inverse)
            by_w, by_p, energy = plate.forces(theory, w, p)
            pull[:n] = share * (held * w - by_w)
            if in_plane:
                pull[n:] = plane * p - by_p
            stored = float(energy - 0.5 * held @ w**2 - 0.5 * plane[: omega.size - n] @ q[n:] ** 2)
        force, radius = contact.press(y - float(centre @ q), still)
        push, y_push = force * centre + pull, -force / mass
        rate, v = rate + dt / 2.0 * push, v + dt / 2.0 * y_push
        peak, depth, widest = max(peak, force), max(depth, y), max(widest, radius)
        deflected = max(deflected, abs(float(centre @ q)))
        last = t if force else last
        first = t if not first and not force else first
    energies = stored + 0.5 * float(np.sum(rate**2 + (omega * q) ** 2)) + 0.5 * mass * v**2
    return {
        "contact_time": first, "max_indentation": depth, "max_force": peak,
        "max_contact_radius": widest, "restitution": -v / speed, "deflection": deflected,
        "gain_of_energy": energies / (0.5 * mass * speed**2) - 1.0,
    }  # fmt: skip
