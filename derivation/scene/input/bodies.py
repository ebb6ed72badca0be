"""Tables of a scene for sphere, plate and own materials."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field

from derivation.scene.input.materials import MATERIALS
from derivation.scene.input.messages import LARGEST_NUMBER, SMALLEST_NUMBER, shown
from derivation.scene.input.table import Table, is_number

Positive = Annotated[float, Field(gt=0, ge=SMALLEST_NUMBER, le=LARGEST_NUMBER)]
Ratio = Annotated[float, Field(gt=-1, lt=0.5)]
Edge = Literal["paper", "simply-supported", "clamped"]
ELASTIC = ("material", "youngs_modulus", "poissons_ratio")
"""The keys of a sphere without which it is rigid."""


class Sphere(Table):
    """The solid sphere; it is rigid unless a material or elastic constants are given.

    Give `mass` or `density`, or a material of known density. Density, yield stress and retardation
    time replace those of the material.

    Examples
    --------
    >>> import platecontact as pc
    >>> pc.Sphere(radius=0.0125, material="ice", density=900.0).to_json()
    {'radius': 0.0125, 'density': 900.0, 'material': 'ice'}
    """

    choices = ((("density",), ("mass",)),)
    options = ((("youngs_modulus", "poissons_ratio"), ("material",)),)
    stand_in = "material"
    radius: Positive = Field(description="sphere radius [m]", examples=[0.13])
    mass: Positive | None = Field(default=None, description="sphere mass [kg]", examples=[72.0])
    density: Positive | None = Field(
        default=None, description="sphere density [kg/m^3]", examples=[7850.0]
    )
    youngs_modulus: Positive | None = Field(
        default=None, description="Young's modulus of the sphere [Pa]", examples=[210e9]
    )
    poissons_ratio: Ratio | None = Field(
        default=None, description="Poisson's ratio of the sphere [1]", examples=[0.3]
    )
    material: str | None = Field(
        default=None,
        description="name of the sphere material; the sphere is rigid without elastic constants",
        examples=list(MATERIALS),
    )
    retardation_time: Positive | None = Field(
        default=None, description="retardation time of the sphere's material [s]", examples=[1e-4]
    )
    yield_stress: Positive | None = Field(
        default=None, description="yield stress of the sphere [Pa]", examples=[235e6]
    )

    @classmethod
    def conflicts(cls, given: Mapping[str, Any]) -> list[str]:
        """Return the problems of the keys, among them yield or retardation of a rigid sphere."""
        problems = super().conflicts(given)
        if all(given.get(key) is None for key in ELASTIC):
            problems += [
                f"sphere.{key}: expected an elastic sphere, got a rigid sphere; add "
                f"sphere.material or the pair sphere.youngs_modulus, sphere.poissons_ratio, or "
                f"remove sphere.{key}"
                for key in ("retardation_time", "yield_stress")
                if given.get(key) is not None
            ]
        return problems


class Plate(Table):
    """The elastic circular plate, struck at its centre.

    Give `thickness` or `half_thickness`, and a material or one pair of elastic constants. Density,
    yield stress and retardation time replace those of the material.

    Examples
    --------
    >>> import platecontact as pc
    >>> pc.Plate(radius=0.3, thickness=0.008, material="glass").edge
    'paper'
    >>> pc.Plate(radius=-0.3, thickness=0.008, material="glass")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    derivation.scene.errors.SceneError: plate.radius: expected a positive number ...
    """

    choices = (
        (("half_thickness",), ("thickness",)),
        (("youngs_modulus", "poissons_ratio"), ("material",), ("lame_lambda", "lame_mu")),
    )
    radius: Positive = Field(description="plate radius [m]", examples=[1.0])
    half_thickness: Positive | None = Field(
        default=None, description="half of the plate thickness [m]", examples=[0.1]
    )
    thickness: Positive | None = Field(
        default=None, description="plate thickness [m]", examples=[0.2]
    )
    lame_lambda: Annotated[float, Field(ge=-LARGEST_NUMBER, le=LARGEST_NUMBER)] | None = Field(
        default=None, description="first Lame constant of the plate [Pa]", examples=[0.36e9]
    )
    lame_mu: Positive | None = Field(
        default=None,
        description="shear modulus (second Lame constant) of the plate [Pa]",
        examples=[0.43e9],
    )
    youngs_modulus: Positive | None = Field(
        default=None, description="Young's modulus of the plate [Pa]", examples=[1.056e9]
    )
    poissons_ratio: Ratio | None = Field(
        default=None, description="Poisson's ratio of the plate [1]", examples=[0.228]
    )
    material: str | None = Field(
        default=None, description="name of the plate material", examples=["glass", *MATERIALS]
    )
    edge: Edge = Field(
        default="paper",
        description='support of the edge: "paper", elastically restrained as in the paper; '
        '"simply-supported"; or "clamped"',
        examples=["clamped"],
    )
    density: Positive | None = Field(
        default=None, description="plate density [kg/m^3]", examples=[2500.0]
    )
    retardation_time: Positive | None = Field(
        default=None, description="retardation time of the plate's material [s]", examples=[1e-4]
    )
    loss_factor: Annotated[float, Field(ge=0, lt=2)] | None = Field(
        default=None,
        description="loss factor of the plate vibration [1]; twice the damping ratio of each mode",
        examples=[0.01],
    )
    yield_stress: Positive | None = Field(
        default=None, description="yield stress of the plate [Pa]", examples=[235e6]
    )
    tensile_strength: Positive | None = Field(
        default=None, description="tensile strength of the plate [Pa]", examples=[45e6]
    )

    @classmethod
    def conflicts(cls, given: Mapping[str, Any]) -> list[str]:
        """Return the problems of the keys, among them a bulk modulus that is not positive."""
        problems = super().conflicts(given)
        lam, mu = given.get("lame_lambda"), given.get("lame_mu")
        if is_number(lam) and is_number(mu) and mu > 0 and 3 * lam + 2 * mu <= 0:
            problems.append(
                "plate.lame_lambda: expected 3 lame_lambda + 2 lame_mu > 0 (a positive bulk "
                f"modulus), got lame_lambda = {shown(lam)} and "
                f"lame_mu = {shown(mu)}; increase lame_lambda above {-2 * mu / 3:.6g}"
            )
        return problems


class Material(Table):
    """A material of your own, to which `material` of sphere and plate refers by name.

    Examples
    --------
    >>> import platecontact as pc
    >>> hail = pc.Material(youngs_modulus=9.3e9, poissons_ratio=0.33, density=900.0)
    >>> scene = pc.Scene(
    ...     sphere=pc.Sphere(radius=0.0125, material="hailstone"),
    ...     plate=pc.Plate(radius=0.3, thickness=0.05, material="steel"),
    ...     impact=pc.Impact(speed=20.0),
    ...     materials={"hailstone": hail},
    ... )
    >>> scene.materials["hailstone"].density
    900.0
    """

    youngs_modulus: Positive = Field(
        description="Young's modulus of the material [Pa]", examples=[9.33e9]
    )
    poissons_ratio: Ratio = Field(
        description="Poisson's ratio of the material [1]", examples=[0.325]
    )
    density: Positive = Field(description="density of the material [kg/m^3]", examples=[917.0])
    yield_stress: Positive | None = Field(
        default=None, description="yield stress of the material [Pa]", examples=[235e6]
    )
    retardation_time: Positive | None = Field(
        default=None, description="retardation time of the material [s]", examples=[1e-4]
    )
    source: str | None = Field(
        default=None,
        description="source of the constants",
        examples=["data sheet of the manufacturer"],
    )
