"""Converts a scene into the quantities of the contact law, and into dimensionless parameters."""

import math
from dataclasses import dataclass, fields, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from derivation.scene import kernels, scales
from derivation.scene.contact_law.support_series import Supports, supports_of
from derivation.scene.errors import SceneError
from derivation.scene.input.bodies import Sphere
from derivation.scene.input.body_materials import Body, body_of, first_given, own_materials
from derivation.scene.input.materials import (
    engineering_constants,
    plane_strain_modulus,
    poissons_ratio,
)
from derivation.scene.input.units import unusual_density
from derivation.scene.quasi_static.simple_laws import plates_of
from derivation.scene.scene import Scene
from generated.simple_impact import PLATES

_CURVATURES = {
    "simply-supported": kernels.supported_edge_curvature,
    "clamped": kernels.clamped_edge_curvature,
}
NUMBERS = ("R", "m", "v0", "h", "b", "lam", "mu")
HERTZ_TIME, TIME_BY_ZENER = 3.3, 5.0
"""Contact time over (m^2/(K^2 v0))^(1/5), which is 3.22 by Hertz's law and more on a plate, and its
increase with the Zener parameter: used for a first guess of the radius of an infinite plate."""


@dataclass(frozen=True)
class InertiaSettings:
    """Settings of the computation with plate inertia.

    Attributes
    ----------
    modes
        Number of dynamic bending modes; 0 for an automatic choice.
    branches
        Lamb-wave branches: "A0", "all", or "auto" (all if the tolerance requires them).
    pointwise
        Whether the indentation is defined at the axis, which causes a spurious energy loss.
    infinite_plate
        Whether the plate is so large that no wave returns from its edge.
    stretching
        Whether the middle plane stretches.
    shapes
        Largest number of shapes that stretch the middle plane.
    """

    modes: int = 0
    branches: str = "auto"
    pointwise: bool = False
    infinite_plate: bool = False
    stretching: bool = False
    shapes: int = 48


@dataclass(frozen=True)
class Model:
    """The quantities of a scene, named as in the paper.

    For many scenes at once, each number may be an array of shape (n, 1), see
    `rows.columns.models_of`. Effects and contact law accept such models like those of one scene.

    Attributes
    ----------
    R, m, v0
        Sphere radius [m], mass [kg] and impact speed [m/s].
    h, b
        Half-thickness and radius of the plate [m].
    lam, mu
        Lame constants of the plate [Pa].
    sphere_modulus
        E/(1 - nu^2) of the sphere [Pa]; infinite for a rigid sphere.
    sphere_poissons_ratio
        Poisson's ratio of the sphere [1]; 0 for a rigid sphere.
    gravity
        Gravitational acceleration during contact [m/s^2].
    density
        Density of the plate [kg/m^3]; 0 if unknown.
    retardation_time
        Retardation time A_v of the viscoelastic contact [s], the mean of those of both bodies
        weighted with their compliances.
    retardation_spread
        Standard deviation of the retardation times of both bodies, with the same weights [s].
    yield_stress
        The smaller yield stress of both bodies [Pa]; infinite if none is known.
    plate_yield_stress
        Yield stress of the plate [Pa]; infinite if unknown.
    solid_density
        Density of the sphere's material [kg/m^3], even if another mass is given; 0 if unknown.
    lightest_density
        Density below which no solid has the elastic constants of the sphere [kg/m^3].
    loss_factor
        Loss factor of the plate [1].
    edge
        Support of the edge of the plate.
    inertia
        Settings of the computation with plate inertia.
    """

    R: float
    m: float
    v0: float
    h: float
    b: float
    lam: float
    mu: float
    sphere_modulus: float = math.inf
    sphere_poissons_ratio: float = 0.0
    gravity: float = 0.0
    density: float = 0.0
    retardation_time: float = 0.0
    retardation_spread: float = 0.0
    yield_stress: float = math.inf
    plate_yield_stress: float = math.inf
    solid_density: float = 0.0
    lightest_density: float = 0.0
    loss_factor: float = 0.0
    edge: str = "paper"
    inertia: InertiaSettings = InertiaSettings()

    @cached_property
    def plates(self) -> kernels.Plates:
        """Polynomials of the contact law for the plate, or for all plates."""
        return kernels.contact_plates(self.h, self.b)

    @cached_property
    def correction(self) -> kernels.Plate:
        """c_1, its error bound and K_3 of the plate; infinite where h/b is out of their range."""
        low, high = PLATES
        if not isinstance(self.eta, np.ndarray):
            inside = low < self.eta < high
            return _plate_of(self.eta) if inside else kernels.Plate(*3 * (math.inf,))
        within = (low < self.eta) & (self.eta < high)
        plates = plates_of(np.where(within, self.eta, 1.0))
        return kernels.Plate(*(np.where(within, x, np.inf) for x in plates))

    @cached_property
    def edge_curvature(self) -> float:
        """Coefficient of (t^2 + s^2)/h^3 in the contact kernel by the edge of the scene [1]."""
        if self.edge not in _CURVATURES:
            return 0.0
        curvature: Any = _CURVATURES[self.edge](self.h, self.b, self.lam, self.mu)
        return curvature  # type: ignore[no-any-return]

    @cached_property
    def supports(self) -> Supports:
        """Contribution of simple supports, up to about Hertz's largest radius, in columns."""
        plate = (self.h, self.b, self.lam, self.mu)
        with np.errstate(all="ignore"):  # extreme scenes give NaN, which is checked
            radius = np.sqrt(self.R * scales.largest_depth(self))
            columns = np.broadcast_arrays(radius, *plate)
            return supports_of(*map(np.atleast_2d, columns))

    def take(self, index: Any) -> "Model":
        """Return some of many scenes by their indices; an int gives a single scene."""
        columns = {
            field.name: value[index].item() if isinstance(index, int) else value[index]
            for field in fields(self)
            if isinstance(value := getattr(self, field.name), np.ndarray)
        }
        columns_of_rows = replace(self, **columns)
        if isinstance(index, int):
            return columns_of_rows
        known, many = vars(self), isinstance(self.eta, np.ndarray)  # values computed before
        if "plates" in known:
            vars(columns_of_rows)["plates"] = (
                kernels.plates_at(self.plates, index) if many else self.plates
            )
        if "correction" in known:
            rows: Any = self.correction  # columns, if there are many plates
            vars(columns_of_rows)["correction"] = kernels.Plate(
                *(x[index] if many else x for x in rows)
            )
        if "supports" in known:
            vars(columns_of_rows)["supports"] = self.supports.take(index)
        return columns_of_rows

    @property
    def poissons_ratio(self) -> float:
        """Poisson's ratio of the plate [1]."""
        return poissons_ratio(self.lam, self.mu)

    @property
    def modulus(self) -> float:
        """E* of the plate, 4 mu (lam + mu)/(lam + 2 mu) [Pa]."""
        return plane_strain_modulus(self.lam, self.mu)

    @property
    def shear_speed(self) -> float:
        """Speed of shear waves in the plate [m/s]."""
        speed: float = np.sqrt(self.mu / self.density)
        return speed

    @property
    def softness(self) -> float:
        """E* of the plate over that of the sphere [1]; 0 for a rigid sphere."""
        return self.modulus / self.sphere_modulus

    @property
    def numbers(self) -> tuple[float, float, float, float, float, float, float]:
        """R, m, v0, h, b, lam and mu, the arguments of the generated functions of an impact."""
        return self.R, self.m, self.v0, self.h, self.b, self.lam, self.mu

    @property
    def eta(self) -> float:
        """Half-thickness over plate radius, h/b [1]."""
        return self.h / self.b

    @property
    def sphere_ratio(self) -> float:
        """Sphere radius over plate radius, R/b [1]."""
        return self.R / self.b

    @property
    def lame_ratio(self) -> float:
        """First over second Lame constant, lam/mu [1]."""
        return self.lam / self.mu

    @property
    def energy_ratio(self) -> float:
        """Energy number m v0^2/(mu R^3) [1]."""
        return (self.m / self.R) * (self.v0 / self.R) * (self.v0 / self.mu) / self.R

    def dimensionless(self) -> dict[str, float]:
        """Return the four dimensionless parameters of a quasi-static elastic impact."""
        return {
            "h/b": self.eta,
            "R/b": self.sphere_ratio,
            "lam/mu": self.lame_ratio,
            "m v0^2/(mu R^3)": self.energy_ratio,
        }


def model_of(scene: Scene, quasi_static: bool = False) -> Model:
    """Return the quantities of a scene.

    Parameters
    ----------
    scene
        The scene.
    quasi_static
        Whether the plate has no inertia. It then has the radius and edge in the scene even if its
        extent is infinite: without inertia an infinite plate would deflect without limit.

    Raises
    ------
    SceneError
        If a derived quantity, such as the mass, is outside the range of double precision, or no
        constant gives the measured restitution.
    """
    if scene.measured is not None:
        from derivation.scene.measured.measured import fitted

        scene = fitted(scene)
    model = numbers_of(scene)
    if model.inertia.infinite_plate and model.density and not quasi_static:
        model = replace(model, b=infinite_plate_radius(model), edge="paper")
    for name, value in zip(NUMBERS, model.numbers, strict=True):
        if not math.isfinite(value) or (value <= 0 and name != "lam"):
            raise SceneError(
                f"scene: expected quantities within the range of double precision, got {name} = "
                f"{value}, computed from the scene; use less extreme values"
            )
    if not 3 * model.lam > -2 * model.mu:
        raise SceneError(
            "plate.poissons_ratio: expected a number above -1 by more than rounding, "
            f"got {scene.plate.poissons_ratio!r}; give plate.lame_lambda and plate.lame_mu instead"
        )
    return model


@lru_cache(maxsize=8)
def _plate_of(eta: float) -> kernels.Plate:
    """Return the plate of one scene, the same to the last bit as among others."""
    columns: Any = plates_of(np.array([eta]))
    return kernels.Plate(*(column.item() for column in columns))


def numbers_of(scene: Scene) -> Model:
    """Return the quantities of a scene without checks; arrays for a scene of arrays."""
    materials = own_materials(scene.materials)
    sphere, plate = body_of(scene.sphere, materials), body_of(scene.plate, materials)
    half, full = scene.plate.half_thickness, scene.plate.thickness
    model = Model(
        R=scene.sphere.radius,
        m=_mass(scene.sphere, sphere.density),
        v0=scene.impact.speed,
        h=half if half is not None else first_given(full, 0.0) / 2,
        b=scene.plate.radius,
        lam=plate.lam,
        mu=plate.mu,
        sphere_modulus=_modulus(sphere),
        sphere_poissons_ratio=_poissons_ratio(sphere),
        gravity=first_given(scene.impact.gravity, 0.0),
        density=plate.density,
        yield_stress=_smaller(sphere.yield_stress, plate.yield_stress),
        plate_yield_stress=plate.yield_stress,
        solid_density=sphere.solid_density,
        lightest_density=_lightest(sphere, scene.sphere.mass is None),
        loss_factor=first_given(scene.plate.loss_factor, 0.0),
        edge=scene.plate.edge,
        inertia=_inertia(scene),
    )
    times = plate.retardation_time, sphere.retardation_time
    if any(np.any(time) for time in times):
        whole = 1.0 + model.softness
        model = replace(
            model,
            retardation_time=kernels.retardation_of_two(*times, model.softness),
            retardation_spread=np.sqrt(model.softness) / whole * np.abs(times[0] - times[1]),
        )
    return model


def _smaller(one: float, other: float) -> float:
    """Return the smaller of two numbers, or of two arrays element by element."""
    lesser = np.minimum(one, other)
    return float(lesser) if np.ndim(lesser) == 0 else lesser


def infinite_plate_radius(model: Model) -> float:
    """Return a first guess of the radius [m] from which no wave returns during the contact."""
    time = scales.time_unit(model) * (HERTZ_TIME + TIME_BY_ZENER * scales.zener_number(model))
    return max(model.shear_speed * time, 4.0 * model.h)


def _inertia(scene: Scene) -> InertiaSettings:
    wanted, stretching = scene.inertia, scene.effects.stretches
    if wanted is None:
        return InertiaSettings(stretching=stretching)
    modes = 0 if wanted.modes == "auto" else wanted.modes
    pointwise = wanted.coupling == "pointwise"
    infinite = wanted.extent == "infinite" and not scene.effects.quasi_static
    return InertiaSettings(modes, wanted.branches, pointwise, infinite, stretching)


def _mass(sphere: Sphere, density: float) -> float:
    if sphere.mass is not None:
        return sphere.mass
    mass: float = scales.volume(sphere.radius) * density
    return mass


def _lightest(sphere: Body, by_density: bool) -> Any:
    """Return the density below which a sphere is called hollow [kg/m^3].

    It is 0 if the mass follows from a density that is probably given in another unit: the warning
    of its unit is enough.
    """
    if not by_density:
        return sphere.lightest
    modulus, _ = engineering_constants(sphere.lam, sphere.mu)
    least = np.where(unusual_density(sphere.density, modulus), 0.0, sphere.lightest)
    return float(least) if np.ndim(least) == 0 else least


def _modulus(body: Body) -> float:
    """Return E/(1 - nu^2) of a body [Pa]; infinite for a rigid body."""
    return plane_strain_modulus(body.lam, body.mu) if np.all(np.isfinite(body.mu)) else math.inf


def _poissons_ratio(body: Body) -> float:
    """Return Poisson's ratio of a body [1]; 0 for a rigid body."""
    if not np.all(np.isfinite(body.mu)):
        return 0.0
    return poissons_ratio(body.lam, body.mu)
