"""The contact law of a scene: force and indentation by the contact radius, of chosen effects.

With the contact radius a itself as the variable, p the force over Hertz's at that radius and
a_H = a p^(1/3) the radius at which Hertz's law has the same force,

    P = (4/3) E* a^3/R p,   delta = (a^2/R) D,   d delta/da = (2a/R) S
    D = D_sphere + k p^(2/3) sum F(a_H),   S = S_sphere (1 + k p^(-1/3) sum S_plate(a_H))

the sums over the plate's effects, whose parts F and S are those of a rigid sphere, and k the
modulus of the contact over the plate's. A paraboloid has p = D_sphere = S_sphere = 1.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from derivation.scene import kernels
from derivation.scene.effects import BY_NAME
from derivation.scene.effects.effect import Array, PlateEffect, Share
from derivation.scene.effects.finite_thickness import plate_share
from derivation.scene.model import Model
from derivation.scene.quadrature import NODES, gauss

if TYPE_CHECKING:
    from generated.true_pressure import Contact, Plate

WHOLE_PLATE = frozenset({"bending", "finite_thickness", "side_wall"})
"""Effects that one kernel holds together."""

HELD = 0.9
"""Largest contact radius over plate radius for an edge that is no soft hinge, or true pressure."""
THICK = 1.0
"""h/b up to which the supports' model is measured."""
_HALVINGS = 30
OPEN = 6.0
"""Contact radius over half-thickness at which the contact is about to open in its middle."""
CURVED = 0.99
"""Largest contact radius over sphere radius where the sphere is no paraboloid."""


class Shape(NamedTuple):
    """Force, indentation and slope over Hertz's at contact radii [1]: p, D and S.

    `additive` is the slope over that of Hertz's at equal force, p^(1/3) S/S_sphere, to which
    every effect adds its part.
    """

    force: Array
    depth: Array
    slope: Array
    additive: Array


@dataclass(frozen=True)
class Law:
    """Contact law of a scene.

    Attributes
    ----------
    model
        The scene's numbers.
    effects
        Names of the effects in it.
    """

    model: Model
    effects: frozenset[str]

    @cached_property
    def softness(self) -> float:
        """E* of the plate over that of the sphere in this law, 0 for a rigid one [1]."""
        return self.model.softness if "sphere_elasticity" in self.effects else 0.0

    @property
    def modulus(self) -> float:
        """E* of the contact [Pa]."""
        return self.model.modulus / (1.0 + self.softness)

    @cached_property
    def limit(self) -> float:
        """Contact radius [m] at which the law ends: min(b, R), but a sphere grows too steep.

        Where the pressure is solved for, the contact may open in its middle before that.
        """
        R = self.model.R * (CURVED if "curvature" in self.effects else 1.0)
        b = self.model.b * (HELD if self.effects & {"edge", "pressure"} else 1.0)
        if "pressure" not in self.effects:
            return min(b, R)
        low, high = 0.0, min(b, R, OPEN * self.model.h)
        if np.isfinite(self._contact(np.array([high])).force[0]):
            return high
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            closed = np.isfinite(self._contact(np.array([middle])).force[0])
            low, high = (middle, high) if closed else (low, middle)
        return low

    @property
    def limit_in_words(self) -> str:
        """What the limit is, and how large."""
        sphere = f"{CURVED} R" if "curvature" in self.effects else "R"
        plate = f"{HELD} b" if self.effects & {"edge", "pressure"} else "b"
        if "pressure" not in self.effects:
            return f"min({plate}, {sphere}) = {self.limit:.6g} m"
        thick = f"{OPEN:g} h"
        return f"min({plate}, {sphere}, {thick}), or the contact opens, at {self.limit:.6g} m"

    @property
    def gravity(self) -> float:
        """What presses the sphere on in this law [m/s^2]."""
        return self.model.gravity if "gravity" in self.effects else 0.0

    @property
    def plate_effects(self) -> tuple[PlateEffect, ...]:
        """Those that add to the plate's deflection."""
        chosen = (BY_NAME[name] for name in sorted(self.effects))
        return tuple(effect for effect in chosen if isinstance(effect, PlateEffect))

    def force(self, a: Array, shape: Shape) -> Array:
        """Contact force [N] at radii [m]."""
        return 4.0 / 3.0 * self.modulus * (a * a * (a / self.model.R)) * shape.force

    def indentation(self, a: Array, shape: Shape) -> Array:
        """Indentation [m] at radii [m]."""
        return a * (a / self.model.R) * shape.depth

    def stiffness(self, a: Array, shape: Shape) -> Array:
        """dP/d delta [N/m] at radii [m]: 2 E* times Hertz's radius over the additive slope."""
        return 2.0 * self.modulus * a * np.cbrt(shape.force) / shape.additive

    def max_pressure(self, a: float) -> float:
        """Pressure in the middle [Pa]: (E*/pi) int_0^a delta'(c)/c dc of the half-space's delta.

        Each step of the growing contact adds the pressure of a flat punch of radius c. For a
        paraboloid that is Hertz's (2/pi) E* a/R. Solved for, it is part of the solution.
        """
        if "pressure" in self.effects:
            return float(self._contact(np.array([a])).centre_pressure[0])
        x, weights = gauss(NODES[2])
        mean = float(np.sum(weights * self._sphere(x * a).slope))
        return 2.0 / np.pi * self.modulus * (a / self.model.R) * mean

    def pressure(self, r: Array, a: float) -> Array:
        """Contact pressure [Pa] at distances r [m] from the axis, 0 <= r <= a.

        (E*/pi) int_r^a delta'(c)/sqrt(c^2 - r^2) dc of the half-space's delta, with
        c^2 = r^2 + (a^2 - r^2) x^2; or solved for.
        """
        R = self.model.R
        if "pressure" in self.effects:
            from generated import true_pressure

            curved, own = "curvature" in self.effects, self.model.modulus
            found: Array = true_pressure.pressure(
                r, self._solved_plate, a, R, self.modulus, own, sphere=curved
            )
            return found
        x, weights = gauss(NODES[2])
        width = np.sqrt((a - r) * (a + r))
        slopes = self._sphere(np.hypot(r[:, None], width[:, None] * x)).slope
        mean: Array = slopes @ weights
        return 2.0 / np.pi * self.modulus * (width / R) * mean

    def max_tension(self, a: float, force: float, held: bool = True) -> float:
        """Stress on the far face under the axis [Pa], of a force [N] spread as Hertz's over a.

        Of the whole plate, whatever effects are in the law; on the paper's edge unless `held`,
        or where contact or plate are wider or thicker than the support's model reaches.
        """
        of = {
            "simply-supported": kernels.supported_far_stress,
            "clamped": kernels.clamped_far_stress,
        }
        model = self.model
        reached = a <= HELD * model.b and model.eta <= THICK
        edge = model.edge if held and reached else "soft-hinge"
        stress = of.get(edge, kernels.far_stress)
        return float(stress(force, a, model.h, model.b, model.lam, model.mu))

    def hertz_radius(self, force: Array) -> Array:
        """Radius [m] at which Hertz's law has a force [N]."""
        return np.cbrt(0.75 * (force / self.modulus) * self.model.R)

    def at(self, a: Array) -> Shape:
        """Force, indentation and slope at contact radii [m], which grow."""
        if "pressure" in self.effects:
            return self._solved(a)
        sphere = self._sphere(a)
        root = np.cbrt(sphere.force)
        if not self.plate_effects:
            return Shape(*sphere, root)
        share = self.deflection(a * root)
        part = 1.0 / (1.0 + self.softness)
        depth = sphere.depth + part * root * root * share.depth
        slope = sphere.slope * (1.0 + part * share.slope / root)
        return Shape(sphere.force, depth, slope, root + part * share.slope)

    def _solved(self, a: Array) -> Shape:
        """By the pressure that is solved for; the edge adds what it does under Hertz's."""
        # Next to a = 0 it is Hertz's.
        a = np.maximum(a, 1e-12 * min(self.model.h, self.model.b, self.model.R))
        found = self._contact(a)
        R, scale = self.model.R, 4.0 / 3.0 * self.modulus * a * a * (a / self.model.R)
        force = found.force / scale
        equal = a * np.cbrt(force)
        depth = found.indentation / a * (R / a)
        additive = 2.0 * self.modulus * equal / found.stiffness
        # Growth of Hertz's radius of the force with the radius itself.
        growth = found.stiffness * found.slope / (4.0 * self.modulus * equal) * (R / equal)
        if "edge" in self.effects:
            part, held = 1.0 / (1.0 + self.softness), BY_NAME["edge"]
            assert isinstance(held, PlateEffect)
            share = held.share(self.model, equal)
            depth = depth + part * (equal / a) ** 2 * share.depth
            additive = additive + part * share.slope
        return Shape(force, depth, additive * growth * (equal / a), additive)

    def _contact(self, a: Array) -> "Contact":
        """The contact with its true pressure."""
        from generated import true_pressure

        model = self.model
        curved = "curvature" in self.effects
        return true_pressure.contact(
            self._solved_plate, a, model.R, self.modulus, model.modulus, sphere=curved
        )

    @cached_property
    def _solved_plate(self) -> "Plate":
        """The plate as the true pressure's equation takes it."""
        from generated import true_pressure

        return true_pressure.plate(self.model.h, self.model.b)

    def _sphere(self, a: Array) -> kernels.Sphere:
        """Force, indentation and slope on a half-space."""
        if "curvature" in self.effects:
            return kernels.sphere_contact(a / self.model.R)
        return kernels.Sphere(*(np.ones_like(a),) * 3)

    def deflection(self, a: Array) -> Share:
        """The plate's parts of F and S at Hertz's radii [m], of a rigid sphere."""
        if self.effects >= WHOLE_PLATE:
            found = [plate_share(self.model, a)]
            others = [e for e in self.plate_effects if e.name not in WHOLE_PLATE]
        else:
            found, others = [], list(self.plate_effects)
        found += [effect.share(self.model, a) for effect in others]
        depth, slope = found[0]
        for other in found[1:]:
            depth, slope = depth + other.depth, slope + other.slope
        return Share(depth, slope)
