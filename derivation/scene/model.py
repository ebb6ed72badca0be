"""Turns a scene into the numbers the kernels take, and into dimensionless ones."""

import math
from dataclasses import dataclass, fields

from derivation.scene.scene import Plate, Scene, SceneError, Sphere


@dataclass(frozen=True)
class Model:
    """A scene in the quantities of the paper.

    Attributes
    ----------
    R, m, v0
        Sphere radius [m], mass [kg] and impact speed [m/s].
    h, b
        Half-thickness and radius of the plate [m].
    lam, mu
        Lame constants of the plate [Pa].
    """

    R: float
    m: float
    v0: float
    h: float
    b: float
    lam: float
    mu: float

    @property
    def numbers(self) -> tuple[float, float, float, float, float, float, float]:
        """R, m, v0, h, b, lam and mu, as the kernels of an impact take them."""
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
        """Energy of the sphere over that of its size in the plate, m v0^2/(mu R^3) [1]."""
        return (self.m / self.R) * (self.v0 / self.R) * (self.v0 / self.mu) / self.R

    @property
    def radius_limit(self) -> float:
        """Contact radius at which the contact law ends, min(b, R) [m]."""
        return min(self.b, self.R)

    def dimensionless(self) -> dict[str, float]:
        """The four numbers on which everything dimensionless depends."""
        return {
            "h/b": self.eta,
            "R/b": self.sphere_ratio,
            "lam/mu": self.lame_ratio,
            "m v0^2/(mu R^3)": self.energy_ratio,
        }


def model_of(scene: Scene) -> Model:
    """The numbers of a scene.

    Raises
    ------
    SceneError
        If what follows from the scene, such as the mass, is no double above zero.
    """
    lam, mu = _lame_constants(scene.plate)
    model = Model(
        R=scene.sphere.radius,
        m=_mass(scene.sphere),
        v0=scene.impact.speed,
        h=scene.plate.half_thickness or (scene.plate.thickness or 0.0) / 2,
        b=scene.plate.radius,
        lam=lam,
        mu=mu,
    )
    for field in fields(model):
        value = getattr(model, field.name)
        if not math.isfinite(value) or (value <= 0 and field.name != "lam"):
            raise SceneError(
                f"scene: expected numbers a double can hold, got {field.name} = {value}, "
                "computed from the scene; give less extreme numbers"
            )
    if not 3 * lam > -2 * mu:
        raise SceneError(
            "plate.poissons_ratio: expected a ratio above -1 by more than rounding, "
            f"got {scene.plate.poissons_ratio!r}; give the Lame constants instead"
        )
    return model


def _mass(sphere: Sphere) -> float:
    if sphere.mass is not None:
        return sphere.mass
    R = sphere.radius
    return 4 / 3 * math.pi * (R * R * R) * (sphere.density or 0.0)


def _lame_constants(plate: Plate) -> tuple[float, float]:
    """First and second Lame constant [Pa], as given or from Young's modulus and Poisson's ratio."""
    if plate.lame_lambda is not None and plate.lame_mu is not None:
        return plate.lame_lambda, plate.lame_mu
    E, nu = plate.youngs_modulus or 0.0, plate.poissons_ratio or 0.0
    mu = E / (2 * (1 + nu))
    return 2 * mu * nu / (1 - 2 * nu), mu
