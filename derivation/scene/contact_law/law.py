"""The contact law of a scene: force and indentation as functions of the contact radius.

With contact radius a, p the force over that of Hertz's law at a, and a_H = a p^(1/3) the radius at
which Hertz's law has the same force,

    P = (4/3) E* a^3/R p,   delta = (a^2/R) D,   d delta/da = (2a/R) S
    D = D_sphere + k p^(2/3) sum F(a_H),   S = S_sphere (1 + k p^(-1/3) sum S_plate(a_H))

with sums over the plate effects, whose contributions F and S are those of a rigid sphere, and k the
modulus E* of the contact over that of the plate. For a paraboloid p = D_sphere = S_sphere = 1.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from typing import Any, NamedTuple

import numpy as np

from derivation.scene import kernels
from derivation.scene.contact_law import solved_law
from derivation.scene.contact_law.solved_contact import SolvedCase, pressure_at
from derivation.scene.effects import BY_NAME, PAPER, WHOLE_PLATE, edge
from derivation.scene.effects.effect import Contribution, Effect, PlateEffect, Reach
from derivation.scene.effects.finite_thickness import plate_contribution
from derivation.scene.model import Model
from derivation.scene.numerics.quadrature import NODES, gauss
from generated.arrays import Double as Array

THICK = 1.0
"""Largest h/b for which the model of simply supported and clamped edges was measured."""
HALVINGS = 60
"""Number of halvings of an interval, after which it contains no other double."""
CANCELLED = 8 * np.finfo(np.float64).eps
"""Relative rounding error of the contribution of the plate, tested."""


class Shape(NamedTuple):
    """Force, indentation and slope over those of Hertz's law at contact radii [1]: p, D and S.

    `additive` is the slope over that of Hertz's law at equal force, p^(1/3) S/S_sphere, to which
    each effect adds its contribution.
    """

    force: Array
    depth: Array
    slope: Array
    additive: Array


@dataclass(frozen=True)
class ContactLaw:
    """Contact law of a scene.

    Attributes
    ----------
    model
        The quantities of the scene.
    effects
        Names of the included effects.
    """

    model: Model
    effects: frozenset[str]

    @cached_property
    def chosen(self) -> tuple[Effect, ...]:
        """The included effects, in the order of their names."""
        return tuple(BY_NAME[name] for name in sorted(self.effects))

    @cached_property
    def plate_effects(self) -> tuple[PlateEffect, ...]:
        """The included effects that add to the deflection of the plate."""
        return tuple(effect for effect in self.chosen if isinstance(effect, PlateEffect))

    def take(self, index: Any) -> "ContactLaw":
        """Return the law of some of many scenes (see `Model.take`)."""
        taken, limit = replace(self, model=self.model.take(index)), vars(self).get("limit")
        if isinstance(limit, np.ndarray) and not isinstance(index, int):
            vars(taken)["limit"] = limit[index]
        return taken

    def only(self, wanted: Callable[[Effect], bool]) -> "ContactLaw":
        """Return the law with only those effects that meet a condition."""
        return replace(self, effects=frozenset(e.name for e in self.chosen if wanted(e)))

    @property
    def half_space(self) -> "ContactLaw":
        """The law of an elastic contact on a half-space, without plate deflection or inertia."""
        still = self.only(lambda e: not (e.dynamic or e.stretches or isinstance(e, PlateEffect)))
        return still.only(lambda e: not (e.solved or e.viscous or e.plastic))

    @property
    def of_paper(self) -> bool:
        """Whether this is the paper's law."""
        return self.effects == PAPER

    @cached_property
    def hertzian(self) -> bool:
        """Whether the elastic contact has the form of Hertz's law."""
        return all(effect.hertzian for effect in self.chosen)

    @cached_property
    def spherical(self) -> bool:
        """Whether the profile is a sphere's, not a paraboloid's."""
        return any(effect.spherical for effect in self.chosen)

    @cached_property
    def bends(self) -> bool:
        """Whether the plate deflects in proportion to the force."""
        return any(effect.bends for effect in self.chosen)

    @cached_property
    def other_edge(self) -> bool:
        """Whether the edge of the plate differs from the paper's."""
        return any(effect.other_edge for effect in self.chosen)

    @cached_property
    def solved(self) -> bool:
        """Whether the pressure is non-Hertzian, from the integral equation."""
        return any(effect.solved for effect in self.chosen)

    @cached_property
    def viscous(self) -> bool:
        """Whether the contact is viscoelastic."""
        return any(effect.viscous for effect in self.chosen)

    @cached_property
    def plastic(self) -> bool:
        """Whether the contact deforms plastically."""
        return any(effect.plastic for effect in self.chosen)

    @cached_property
    def dynamic(self) -> bool:
        """Whether the plate has inertia."""
        return any(effect.dynamic for effect in self.chosen)

    @cached_property
    def stretches(self) -> bool:
        """Whether the middle plane of the plate stretches."""
        return any(effect.stretches for effect in self.chosen)

    @cached_property
    def damping_ratio(self) -> float:
        """Damping ratio of the plate modes [1]: half the loss factor, as at resonance."""
        damped = any(effect.damps for effect in self.chosen)
        return 0.5 * self.model.loss_factor if damped else 0.0

    @cached_property
    def softness(self) -> float:
        """E* of the plate over that of the sphere in this law [1]; 0 for a rigid sphere."""
        return sum((effect.softness(self.model) for effect in self.chosen), 0.0)

    @cached_property
    def edge_curvature(self) -> kernels.Numbers:
        """Coefficient of (t^2 + s^2)/h^3 in the contact kernel by another edge [1].

        It is 0 with plate inertia: the modes of the plate contain the curvature by its edge.
        """
        return self.model.edge_curvature if self.other_edge and not self.dynamic else 0.0

    @property
    def modulus(self) -> float:
        """E* of the contact [Pa]."""
        return self.model.modulus / (1.0 + self.softness)

    @cached_property
    def _bodies(self) -> tuple[Array, Array]:
        """Sphere radius [m] and E* of the contact [Pa], for functions of the generated package."""
        return np.asarray(self.model.R), np.asarray(self.modulus)

    @cached_property
    def limit(self) -> float:
        """Largest contact radius [m] of the law, at most where contact is lost at the centre."""
        return solved_law.limit(self, self._widest) if self.solved else self._widest

    @cached_property
    def _widest(self) -> float:
        """Largest contact radius [m] for which all included effects can be computed.

        The deflection is evaluated at Hertz's radius of the force, which is on the plate too.
        """
        high: float = self._reach.shortest(self.model)  # type: ignore[assignment]
        if not (self.spherical and self.plate_effects) or self.solved:
            return high

        def within(a: Any) -> Any:
            on_plate = (1.0 - CANCELLED) * self._reach.plate * self.model.b
            return a * np.cbrt(self._sphere(a).force) < on_plate

        whole = within(high)
        if np.all(whole):
            return high
        widest, low = high, 0.0 * high
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            low, high = np.where(within(middle), [middle, high], [low, middle])
        # The bisection would change scenes that are within in their last digit.
        radii: Any = np.where(whole, widest, low)
        return radii if np.ndim(radii) else float(radii)

    @property
    def limit_in_words(self) -> str:
        """The limit in words, with its value."""
        if self.limit < self._widest:
            return f"{self.limit:.6g} m, where contact is lost at the centre"
        if self._widest < self._reach.shortest(self.model):
            return f"{self.limit:.6g} m, where Hertz's radius of the force reaches the edge"
        return self._reach.in_words(self.limit)

    @property
    def _reach(self) -> Reach:
        """The contacts for which all included effects can be computed."""
        each = zip(Reach(), *(effect.reach for effect in self.chosen), strict=True)
        return Reach(*map(min, each))

    @cached_property
    def gravity(self) -> float:
        """Gravitational acceleration during the contact in this law [m/s^2]."""
        return sum((effect.gravity(self.model) for effect in self.chosen), 0.0)

    def force(self, a: Array, shape: Shape) -> Array:
        """Return the contact force [N] at contact radii [m]."""
        return kernels.hertz_force(a, *self._bodies) * shape.force

    def indentation(self, a: Array, shape: Shape) -> Array:
        """Return the indentation [m] at contact radii [m]."""
        return a * (a / self.model.R) * shape.depth

    def stiffness(self, a: Array, shape: Shape) -> Array:
        """Return dP/d delta [N/m] at radii [m]: that at Hertz's radius over the additive slope."""
        return kernels.hertz_stiffness(a * np.cbrt(shape.force), self._bodies[1]) / shape.additive

    def max_pressure(self, a: float) -> float:
        """Return the pressure at the centre [Pa], see `centre_pressure`."""
        return float(self.centre_pressure(np.array([a]))[0])

    def centre_pressure(self, a: Array) -> Array:
        """Return the pressure at the centre [Pa], at one or many radii [m].

        It is (E*/pi) int_0^a delta'(c)/c dc on a half-space: each increment of the contact adds the
        pressure of a flat punch of radius c. For a paraboloid the result is Hertz's (2/pi) E* a/R.
        Non-Hertzian pressure is part of the solution of the integral equation.
        """
        pressure = kernels.hertz_pressure(a, *self._bodies)
        if self.solved:
            return pressure * solved_law.solution(self, a).centre
        if not self.spherical:
            return pressure
        x, weights = gauss(NODES[2])
        slope = self._sphere(x * a).slope
        return np.asarray(pressure * np.sum(weights * slope, axis=-1, keepdims=True))

    @property
    def pressure_limit(self) -> float:
        """Largest pressure [Pa] of a plastic contact; infinite for an elastic one."""
        return kernels.YIELD_LIMIT * self.model.yield_stress if self.plastic else math.inf

    def pressure(self, r: Array, a: float) -> Array:
        """Return the contact pressure [Pa] at distances r [m] from the axis, 0 <= r <= a.

        It is (E*/pi) int_r^a delta'(c)/sqrt(c^2 - r^2) dc on a half-space, with
        c^2 = r^2 + (a^2 - r^2) x^2, or the solution of the integral equation.
        """
        if self.solved:
            return pressure_at(r, a, self.case)
        x, weights = gauss(NODES[2])
        width = np.sqrt((a - r) * (a + r))
        mean: Array = self._sphere(np.hypot(r[:, None], width[:, None] * x)).slope @ weights
        return kernels.hertz_pressure(width, *self._bodies) * mean

    def max_tensile_stress(self, a: float, force: float, on_edge: bool = True) -> float:
        """Return the largest tensile stress on the back face [Pa].

        It includes all plate effects, even those that are omitted from the law.

        Parameters
        ----------
        a
            Contact radius [m]; the force is distributed over it as in Hertz's law.
        force
            Contact force [N].
        on_edge
            Whether to use the edge of the scene; if not, or if the contact or the plate is outside
            the range of the edge model, the paper's edge is used.
        """
        return float(self.tensile_stresses(np.array([a]), np.array([force]), on_edge)[0])

    def tensile_stresses(self, a: Array, force: Array, on_edge: bool = True) -> Array:
        """Return `max_tensile_stress` [Pa] for one radius [m] and force [N], or columns of them."""
        stresses = {
            edge.SUPPORTED: kernels.supported_back_face_stress,
            edge.CLAMPED: kernels.clamped_back_face_stress,
        }
        model = self.model
        plate = model.h, model.b, model.lam, model.mu
        stress = stresses.get(model.edge if on_edge else "", kernels.back_face_stress)
        reached = (a <= edge.MAX_A_OVER_B * model.b) & (model.eta <= THICK)
        if reached.all() or stress is kernels.back_face_stress:
            return np.asarray(stress(force, a, *plate))
        inside = stress(force, np.where(reached, a, np.nan), *plate)
        return np.where(reached, inside, kernels.back_face_stress(force, a, *plate))

    def hertz_radius(self, force: Array) -> Array:
        """Return the radius [m] at which Hertz's law has a force [N]."""
        return kernels.hertz_radius(force, *self._bodies)

    def at(self, a: Array) -> Shape:
        """Return force, indentation and slope at increasing contact radii [m]."""
        if self.solved:
            return Shape(*solved_law.shape(self, a))
        if not self.spherical:
            return self._paraboloid(a)
        sphere = self._sphere(a)
        root = np.cbrt(sphere.force)
        if not self.plate_effects:
            return Shape(*sphere, root)
        plate = self.deflection(a * root)
        part = 1.0 / (1.0 + self.softness)
        depth = sphere.depth + part * root * root * plate.depth
        slope = sphere.slope * (1.0 + part * plate.slope / root)
        return Shape(sphere.force, depth, slope, root + part * plate.slope)

    def _paraboloid(self, a: Array) -> Shape:
        """Return the shape of a contact with a paraboloid, whose force is Hertz's."""
        one = np.ones_like(a)
        if not self.plate_effects:
            return Shape(one, one, one, one)
        part, deflection = 1.0 / (1.0 + self.softness), self.deflection(a)
        slope = 1.0 + part * deflection.slope
        return Shape(one, 1.0 + part * deflection.depth, slope, slope)

    @property
    def case(self) -> SolvedCase:
        """The quantities that determine a contact with non-Hertzian pressure."""
        [case] = solved_law.cases(self)
        return case

    def _sphere(self, a: Array) -> kernels.Sphere:
        """Return force, indentation and slope on a half-space."""
        if self.spherical:
            return kernels.sphere_contact(a / self.model.R)
        return kernels.Sphere(*(np.ones_like(a),) * 3)

    def cancellation(self, a: Array) -> Array:
        """Return the relative rounding error of the slope by cancellation [1] at radii [m].

        Unless all plate effects are included, the contribution of an effect may be computed as that
        of the whole plate minus those of omitted effects, which may be much larger.
        """
        differs = any(effect.difference for effect in self.plate_effects)
        if not differs or self.effects >= WHOLE_PLATE:
            return np.zeros_like(a)
        full, slope = plate_contribution(self.model, a), self.at(a).additive
        return np.asarray(CANCELLED * np.abs(full.slope) / slope)

    def deflection(self, a: Array) -> Contribution:
        """Return the contributions of the plate to F and S at Hertz's radii [m] (rigid sphere)."""
        others = self.plate_effects
        parts = []
        if any(effect.difference for effect in others):
            parts, others = [self._plate(a)], self.beyond_whole_plate
        parts += [effect.contribution(self.model, a) for effect in others]
        return Contribution(*(reduce(np.add, each) for each in zip(*parts, strict=True)))

    def _plate(self, a: Array) -> Contribution:
        """Return the contribution of the whole plate minus that of its omitted effects."""
        depth, slope = plate_contribution(self.model, a)
        for effect in (BY_NAME[name] for name in sorted(WHOLE_PLATE - self.effects)):
            assert isinstance(effect, PlateEffect)
            part = effect.contribution(self.model, a)
            depth, slope = depth - part.depth, slope - part.slope
        return Contribution(depth, slope)

    @property
    def beyond_whole_plate(self) -> tuple[PlateEffect, ...]:
        """Effects that add to the deflection of the whole plate with the paper's edge."""
        return tuple(e for e in self.plate_effects if e.name not in WHOLE_PLATE)
