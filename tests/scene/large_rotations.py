"""Independent simulation of impacts on a thin plate with large rotations, by finite elements.

The plate is a shell of revolution without shear (Reissner, 1949). A point at r moves to r + u in
its plane and by w across it. With X = 1 + u' and the length ratio L^2 = X^2 + w'^2, its normal
turns by the angle b with sin b = w'/L, and the strains and curvatures are, by theory,

    von Karman   u' + w'^2/2,    u/r,               w'',    w'/r
    angle        L - 1,          u/r,               b',     sin b/r
    Green        (L^2 - 1)/2,    u/r + u^2/(2 r^2), L b',   (1 + u/r) sin b/r

Both exact theories have linear material, for different measures of strain: the St. Venant-Kirchhoff
material is that of Green's. They differ by terms as large as the strain. Rotary inertia is
neglected; that in the plane is optional.
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
"""Largest number of iterations of the middle plane."""


class Strains(NamedTuple):
    """Strains and curvatures, radial ones first, and the work of forces and moments.

    `work` returns the forces that do work by w', w'', u/r, u' and u'', of the two forces and two
    moments that do work by strains and curvatures.
    """

    values: tuple[Array, Array, Array, Array]
    work: Callable[[Array, Array, Array, Array], tuple[Array, ...]]


def strains(theory: Theory, r: Array, w: tuple[Array, Array], u: tuple[Array, ...]) -> Strains:
    """Return strains and curvatures at points r for w', w'' and u/r, u', u''."""
    Y, bent, hoop, long, longer = *w, *u
    if theory == "von Karman":
        return Strains(
            (long + Y * Y / 2.0, hoop, bent, Y / r),
            lambda N, around, M, M_around: (N * Y + M_around / r, M, around, N, 0.0 * M),
        )
    X = 1.0 + long
    strain = long + (long * long + Y * Y) / 2.0  # (L^2 - 1)/2
    square = 1.0 + 2.0 * strain
    L = np.sqrt(square)
    sine, turned = Y / L, (X * bent - Y * longer) / square

    def angle(
        N: Array, around: Array, M: Array, M_around: Array
    ) -> tuple[Array, Array, Array, Array, Array]:
        M, tilt = M / square, M_around / (r * square * L)
        both = N / L - 2.0 * turned * M
        return (
            both * Y - M * longer + tilt * X * X,
            M * X,
            around,
            both * X + M * bent - tilt * X * Y,
            -M * Y,
        )

    if theory == "angle":
        return Strains((2.0 * strain / (L + 1.0), hoop, turned, sine / r), angle)
    wider = 1.0 + hoop
    return Strains(
        (strain, hoop + hoop * hoop / 2.0, L * turned, wider * sine / r),
        lambda N, around, M, M_around: angle(
            L * N + turned * M, wider * around + sine / r * M_around, L * M, wider * M_around
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
        the plane), or `free` with a hole whose edge is clamped.
    elements
        Number of elements on the radius.
    hole
        Radius of the hole [m].
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
    def cubics(self) -> tuple[Array, Array, Array]:
        """Values, first and second derivatives of the cubics at the points, for each unknown.

        The unknowns are value and slope at each node.
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
        value, first, second = found.reshape(3, self.elements * POINTS, -1)
        return value, first, second

    @cached_property
    def free(self) -> tuple[list[int], list[int]]:
        """Unknowns of w and of u that are not fixed."""
        last = 2 * self.elements
        held = {"clamped": ({last, last + 1}, {last}), "free": (set[int](), set[int]())}
        w, u = held.get(self.edge, ({last}, set[int]()))
        first = ({0, 1}, {0, 1}) if self.hole else ({1}, {0})
        every = range(last + 2)
        free = ([i for i in every if i not in a | b] for a, b in zip(first, (w, u), strict=True))
        return next(free), next(free)

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
            return factor * (own + nu * (mixed + mixed.T))

        mass = self.density * self.thickness * value.T @ (weights[:, None] * value)
        bending = matrix(second, first / r[:, None], D)
        plane = matrix(first, value / r[:, None], C)
        if self.edge == "paper":
            bending[-1, -1] += 2.0 * np.pi * (1.0 - nu) * D
            plane[-2, -2] += 2.0 * np.pi * (1.0 - nu) * C
        w, u = np.ix_(of_w, of_w), np.ix_(of_u, of_u)
        return (bending[w], mass[w]), (plane[u], mass[u])

    def in_modes(self, modes: int, in_plane: int) -> "Reduced":
        """Return the plate in its lowest linear modes, 0 for all."""
        (value, first, second), (r, _), (of_w, of_u) = self.cubics, self.points, self.free
        (square, w), (plane, u) = (eigh(*pair) for pair in self.linear)  # masses of 1
        w, u = w[:, : modes or None], u[:, : in_plane or None]
        if self.hole or self.edge == "free":
            centre = w[-2]  # the outer edge
        else:
            centre = w[0]
        return Reduced(
            self,
            (first[:, of_w] @ w, second[:, of_w] @ w),
            (value[:, of_u] @ u / r[:, None], first[:, of_u] @ u, second[:, of_u] @ u),
            square[: w.shape[1]],
            plane[: u.shape[1]],
            centre,
            (w[-1], u[-2], u[-1]),
            value[:, of_w] @ w,
        )


@dataclass(frozen=True)
class Reduced:
    """A plate in coordinates q of w and p of u, each a linear mode with a mass of 1 kg.

    Attributes
    ----------
    of_w, of_u
        w' and w'', and u/r, u' and u'' of each mode at the points.
    stiffness, in_plane
        Stiffness of each mode of w and of u [N/m].
    centre
        Deflection of each mode on the axis.
    at_edge
        w', u and u' of each mode at the edge, for an edge with springs.
    deflection
        Deflection of each mode at the points.
    """

    shell: Shell
    of_w: tuple[Array, Array]
    of_u: tuple[Array, Array, Array]
    stiffness: Array
    in_plane: Array
    centre: Array
    at_edge: tuple[Array, Array, Array]
    deflection: Array

    @cached_property
    def stacked(self) -> tuple[Array, Array]:
        """Derivatives of w and of u at all points, for each mode."""
        return np.concatenate(self.of_w).T.copy(), np.concatenate(self.of_u).T.copy()

    def forces(self, theory: Theory, q: Array, p: Array) -> tuple[Array, Array, Array]:
        """Return the derivatives of the energy by q and p (along the last axis), and the energy."""
        (r, weights), nu, (C, D) = self.shell.points, self.shell.nu, self.shell.stiffnesses
        size, (of_w, of_u) = r.size, self.stacked
        bending, plane = q @ of_w, p @ of_u
        w = bending[..., :size], bending[..., size:]
        u = plane[..., :size], plane[..., size : 2 * size], plane[..., 2 * size :]
        at = strains(theory, r, w, u)
        radial, around, bent, turned = at.values
        C, D = C * weights, D * weights
        held = (
            C * (radial + nu * around),
            C * (around + nu * radial),
            D * (bent + nu * turned),
            D * (turned + nu * bent),
        )
        by = at.work(*held)
        by_q = of_w @ np.concatenate(by[:2], axis=-1)[..., None]
        by_p = of_u @ np.concatenate(by[2:], axis=-1)[..., None]
        by_q, by_p = by_q[..., 0], by_p[..., 0]
        energy = 0.5 * sum(np.sum(one * value, axis=-1) for one, value in zip(held, at.values))
        if self.shell.edge != "paper":
            return by_q, by_p, energy
        slope, moved, X = (
            x @ each for x, each in zip((q, p, p), self.at_edge, strict=True)
        )
        spring, (C, D) = 2.0 * np.pi * (1.0 - nu), self.shell.stiffnesses
        angle, by_slope, by_X = slope, 1.0, 0.0
        if theory != "von Karman":
            square = (1.0 + X) ** 2 + slope**2
            angle, by_slope, by_X = np.arctan(slope / (1.0 + X)), (1.0 + X) / square, -slope / square
        turning = spring * D * angle
        by_q = by_q + np.multiply.outer(turning * by_slope, self.at_edge[0])
        by_p = by_p + np.multiply.outer(spring * C * moved, self.at_edge[1])
        by_p = by_p + np.multiply.outer(turning * by_X, self.at_edge[2])
        return by_q, by_p, energy + spring / 2.0 * (D * angle**2 + C * moved**2)

    def at_rest(self, theory: Theory, q: Array, p: Array) -> Array:
        """Return p of a middle plane in equilibrium for q, by iteration from a guess."""
        unit = float(np.sqrt(np.max(self.in_plane)))
        for _ in range(TURNS):
            step = self.forces(theory, q, p)[1] / self.in_plane
            p = p - step
            if np.sum(self.in_plane * step**2) <= 1e-13 * np.sum(self.in_plane * p**2):
                return p
        raise ArithmeticError(f"the middle plane has not converged: {unit}")

    def static(self, theory: Theory, load: Array, steps: int = 4) -> tuple[Array, Array]:
        """Return q and p under modal forces, by Newton's method in load steps."""
        scale = 1.0 / np.sqrt(np.append(self.stiffness, self.in_plane))
        n, m = self.stiffness.size, scale.size
        z, tiny = np.zeros(m), 1e-30j * np.diag(scale)
        push = np.append(load, np.zeros(m - n))

        def residual(z: Array) -> Array:
            by_q, by_p, _ = self.forces(theory, z[..., :n], z[..., n:])
            return np.concatenate([by_q, by_p], axis=-1)

        for part in np.arange(1, steps + 1) / steps:
            for _ in range(TURNS):
                tangent = np.imag(residual(z + tiny)) / 1e-30 * scale
                step = scale * np.linalg.solve(tangent, scale * (part * push - residual(z)))
                z = z + step
                if np.linalg.norm(step / scale) <= 1e-6 * np.linalg.norm(z / scale):
                    break
            else:
                raise ArithmeticError("the static deflection has not converged")
        return z[:n], z[n:]


def impact(
    plate: Reduced,
    theory: Theory,
    mass: float,
    contact: Hertz,
    speed: float,
    in_plane: bool = False,
    linear: tuple[Array, Array] | None = None,
    phase: float = 0.25,
) -> dict[str, float]:
    """Simulate the impact of a sphere on the axis.

    The modes move exactly between impulses of the contact force and of all other forces.

    Parameters
    ----------
    in_plane
        Whether the middle plane has inertia in its plane; otherwise it is in equilibrium.
    linear
        Angular frequencies of the modes, and their masses for a deflection of 1 on the axis, if
        they are not those of the thin plate.
    """
    omega, centre = np.sqrt(plate.stiffness), plate.centre
    if linear is not None:
        # The same deflection has another mass: forces of large deflections depend on q * share.
        omega = linear[0]
        share = 1.0 / (np.sqrt(linear[1]) * np.abs(centre))
    else:
        share = np.ones(omega.size)
    n, plane = omega.size, plate.in_plane
    own, held = np.append(omega, np.sqrt(plane) if in_plane else []), plate.stiffness
    inert = own.size - n
    centre = np.append(share * centre, np.zeros(inert))
    duration = 2.9 * (mass**2 / (contact.stiffness**2 * speed)) ** 0.2
    dt = min(duration / 100.0, phase / float(np.max(own)))
    cosine, sine = np.cos(own * dt), np.sin(own * dt)
    q, rate, push = 0.0 * own, 0.0 * own, 0.0 * own
    y, v, t, y_push, first, last = 0.0, speed, 0.0, 0.0, 0.0, duration
    peak = depth = deflected = widest = energy = 0.0
    p, before, earlier = np.zeros((3, plane.size))
    still = Motion(0.0, 0.0, dt)
    while v > 0.0 or y > -1.2 * deflected or t < 1.2 * last:
        rate, v = rate + dt / 2.0 * push, v + dt / 2.0 * y_push
        q, rate = q * cosine + rate / own * sine, rate * cosine - q * own * sine
        y, t = y + v * dt, t + dt
        w = share * q[:n]
        if in_plane:
            p = q[n:]
        else:
            guess = 3.0 * (p - before) + earlier
            p, before, earlier = plate.at_rest(theory, w, guess), p, before
        by_w, by_p, _ = plate.forces(theory, w, p)
        pull = share * (held * w - by_w)
        if in_plane:
            pull = np.append(pull, plane * p - by_p)
        force, radius = contact.press(y - float(centre @ q), still)
        push, y_push = force * centre + pull, -force / mass
        rate, v = rate + dt / 2.0 * push, v + dt / 2.0 * y_push
        peak, depth, widest = max(peak, force), max(depth, y), max(widest, radius)
        deflected = max(deflected, abs(float(centre @ q)))
        last = t if force else last
        first = t if not first and not force else first
    w = share * q[:n]
    stored = float(plate.forces(theory, w, p)[2]) + 0.5 * float(
        np.sum((own[:n] * q[:n]) ** 2) - np.sum(held * w**2)
    )
    energy = stored + 0.5 * float(rate @ rate) + 0.5 * mass * v**2
    return {
        "contact_time": first, "max_indentation": depth, "max_force": peak,
        "max_contact_radius": widest, "restitution": -v / speed, "deflection": deflected,
        "energy": energy / (0.5 * mass * speed**2) - 1.0, "steps": t / dt,
    }  # fmt: skip
