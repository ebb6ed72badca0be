"""Static contacts on a plate whose middle plane stretches, by the modes of the plate.

With c_j the static compliance of shape j, P_j the force that drives it and N_j(Q) the force of
stretching (see `modal` and `middle_plane`), the deflections of the shapes satisfy

    Q_j = c_j (P_j + N_j(Q)).

They minimise a convex energy, so that they are unique. At a given force, stretching changes the
indentation by sum s_j (Q_j - c_j P_j), as in an impact on a plate with inertia.
"""

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple, Self

import numpy as np

from derivation.scene.contact_law.corrections import stretching
from derivation.scene.contact_law.flatter_plate import Flattening
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import last_radius
from derivation.scene.dynamic.contact_tables import ContactTables, contact_of
from derivation.scene.dynamic.middle_plane import MiddlePlane
from derivation.scene.dynamic.modal import ModalPlate, plate_of
from derivation.scene.dynamic.stretched_shapes import LEFT, with_shapes
from derivation.scene.errors import SceneError
from derivation.scene.input.materials import engineering_constants
from generated.arrays import Double as Array
from generated.effect_kernels import hertz_force
from generated.pressure_kernels import force_of_waves

NEGLIGIBLE = 1e-4
"""Relative stiffening below which stretching is neglected; the model error then includes it."""
THIN = 0.05
"""Half-thickness over plate radius up to which stretching is included: thicker plates were not
compared with other solutions."""
ACCURATE, MOST_SHAPES = 1e-4, 192
"""Error by the shapes that do not stretch, over the indentation, above which more shapes are used,
and largest number of shapes."""
LEFT_OF_CURVATURE = 2.0
"""Estimated error of the curvature by the shapes that do not stretch, over the change since half as
many: it decreases slowly, because that by a point force is infinite."""
STEPS, CLOSE = 60, 1e-13
"""Largest number of Newton's steps; relative step that ends the iteration."""


class Change(NamedTuple):
    """Changes of a static contact by stretching, at a given force.

    Attributes
    ----------
    depth
        Change of the indentation [m].
    compliance
        Its derivative with respect to the force [m/N].
    flattening
        Change of the curvature under the sphere.
    steepness
        Mean square of the slope, weighted with the energy of stretching [1].
    thinner
        Decrease of half the thickness on the axis by the tension of the middle plane [m].
    error, flatter_error
        Estimated errors of `depth` [m] and of `flattening.change` [1] by the shapes that do not
        stretch the plate.
    """

    depth: float
    compliance: float
    flattening: Flattening
    steepness: float
    thinner: float
    error: float = 0.0
    flatter_error: float = 0.0


@dataclass(frozen=True)
class StretchedPlate:
    """A plate whose middle plane stretches, under the forces of a static contact.

    Attributes
    ----------
    contact
        Forces on the shapes by contact radius, for the paper's edge.
    plane
        The middle plane, in units of `depth` and `force`.
    compliance
        Static deflection of each shape by a unit force on it, in these units.
    depth, force
        Thickness of the plate [m], and force that would deflect it by as much without stretching
        [N].
    youngs_modulus, poissons_ratio
        Elastic constants [Pa, 1].
    """

    contact: ContactTables
    plane: MiddlePlane
    compliance: Array
    depth: float
    force: float
    youngs_modulus: float
    poissons_ratio: float

    @classmethod
    def of(cls, law: ContactLaw, shapes: int) -> Self:
        """Return the plate of a static law in a number of shapes."""
        model = law.model
        law = replace(law, model=replace(model, inertia=replace(model.inertia, branches="A0")))
        law = with_shapes(law, shapes)
        modes, rest = plate_of(law, shapes).modes, law.only(lambda e: not e.other_edge)
        top = min(last_radius(law), last_radius(rest))
        compliance, depth = modes.compliance, 2.0 * float(law.model.h)
        force = depth / float(np.sum(compliance))
        plane = MiddlePlane.of(law.model, modes, depth, force)
        tables = contact_of(rest, ModalPlate(modes, modes, None), top, pointwise=False)
        constants = engineering_constants(model.lam, model.mu)
        return cls(tables, plane, compliance * (force / depth), depth, force, *constants)

    def change(self, force: float, a: float) -> Change:
        """Return the changes at a force [N], whose contact radius without stretching is a [m]."""
        a = self._radius(force, a)
        at = self.contact.at(np.array([a]))
        if not at.force_a[0] > 0.0:  # beyond the tables, or by underflow
            nan = math.nan
            return Change(nan, nan, Flattening(*4 * (nan,)), nan, nan)
        load, weights = at.modal_forces[0] / self.force, 1.0 + at.weights_less_one[0]
        linear = self.compliance * load
        q, system = self._deflections(load)
        less, faster = q - linear, np.linalg.solve(system, weights) - self.compliance * weights
        curved = self.depth * float(at.less_a[0] @ less)
        second, fourth = self.plane.steepness(q)
        return Change(
            self.depth * float(weights @ less),
            curved / float(at.force_a[0]) + self.depth * float(weights @ faster) / self.force,
            Flattening(
                self._flatter(a, curved),
                self._flatter(a, self.depth * float(at.less_a[0] @ faster)) / self.force,
                a,
                1.0 / float(at.force_a[0]),
            ),
            (fourth / second if second else 0.0) * (self.depth / self.contact.modes.b) ** 2,
            float(self.poissons_ratio / self.youngs_modulus * self.plane.axis_tension(q)),
        )

    def _flatter(self, a: float, curved: float) -> float:
        """Return the relative change of the force at a contact radius [m] by a curvature."""
        if self.contact.static_change is None:
            return 0.0
        modulus, R, radius = np.array(self.contact.modulus), np.array(self.contact.R), np.array(a)
        waves = force_of_waves(modulus, radius, np.array(curved))
        return float(waves / hertz_force(radius, R, modulus))

    def _radius(self, force: float, a: float) -> float:
        """Return the radius [m] at which the tables have a force [N]; NaN beyond their end.

        They are for the paper's edge, whose curvature differs from that of the edge of the scene.
        """
        for _ in range(STEPS):
            at = self.contact.at(np.array([a]))
            step = float((at.force[0] - force) / at.force_a[0])
            if not abs(step) > CLOSE * a:
                return a
            a = min(a - step, self.contact.top)
        return math.nan

    def _deflections(self, load: Array) -> tuple[Array, Array]:
        """Return the deflections under forces on the shapes, and their stiffness matrix."""
        stiffness, q = np.diag(1.0 / self.compliance), self._guess(load)
        for _ in range(STEPS):
            system = stiffness - self.plane.slope_of_forces(q)
            step = np.linalg.solve(system, load + self.plane.forces(q) - q / self.compliance)
            q = q + step
            if not np.max(np.abs(step)) > CLOSE * np.max(np.abs(q)):
                break
        return q, system

    def _guess(self, load: Array) -> Array:
        """Return the deflections without stretching times a factor, with the least energy."""
        linear = self.compliance * load
        cubic, part = float(4.0 * self.plane.energy(linear) / (load @ linear)), 1.0
        for _ in range(STEPS):
            part -= (part + cubic * part**3 - 1.0) / (1.0 + 3.0 * cubic * part * part)
        return part * linear


@lru_cache(maxsize=8)
def _plate_of(law: ContactLaw, shapes: int) -> StretchedPlate | None:
    """Return the plate of a law; None if it is too thick."""
    if law.model.eta > THIN:
        return None
    try:
        return StretchedPlate.of(law, shapes)
    except SceneError:  # its edge has no modes, or too many
        return None


def counts(law: ContactLaw, deflection: float) -> bool:
    """Return whether stretching changes a static contact.

    Parameters
    ----------
    deflection
        Deflection of the plate on the axis without stretching [m].
    """
    if not law.stretches or not stretching(law.model, deflection) > NEGLIGIBLE:
        return False
    return _plate_of(law, law.model.inertia.shapes) is not None


def change_by_stretching(law: ContactLaw, force: float, a: float) -> Change | None:
    """Return the changes of a static contact by stretching; None if the law neglects it.

    Parameters
    ----------
    force, a
        Contact force [N], and contact radius without stretching [m].
    """
    shapes = law.model.inertia.shapes
    plate, fewer = (_plate_of(law, n) if law.stretches else None for n in (shapes, shapes // 2))
    if plate is None or fewer is None:
        return None
    change, rough = plate.change(force, a), fewer.change(force, a)
    return change._replace(
        error=LEFT * abs(change.depth - rough.depth),
        flatter_error=LEFT_OF_CURVATURE * abs(change.flattening.change - rough.flattening.change),
    )


def more_shapes(law: ContactLaw, change: Change | None, depth: float) -> ContactLaw | None:
    """Return the law in which twice as many shapes stretch the plate; None if that is not needed.

    Parameters
    ----------
    change, depth
        The changes by stretching, and the indentation [m].
    """
    shapes = 2 * law.model.inertia.shapes
    if change is None or change.error <= ACCURATE * depth or shapes > MOST_SHAPES:
        return None
    return with_shapes(law, shapes)
