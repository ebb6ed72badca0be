"""The table [effects] of a scene: which effects are included."""

from typing import Any, Literal

from pydantic import Field

from derivation.scene.input.table import Table

Wanted = Literal["auto"] | bool


def _switch(description: str, example: bool = True) -> Any:
    """Return the field of an effect, "auto" by default."""
    return Field(default="auto", description=description, examples=[example])


class Effects(Table):
    """Selection of the effects; with "auto", the tolerance decides.

    Parameters
    ----------
    sphere_elasticity, spherical_profile, non_hertzian_pressure, plasticity, viscosity, gravity
        Effects of sphere and contact: "auto", the default, to include the effect if the tolerance
        requires it; True to include it, which requires its key; False to disable it.
    bending, finite_thickness, finite_radius, edge, inertia, damping
        Effects of the plate, with the same values.
    stretching
        Whether the middle plane of the plate stretches, with the same values. In an impact it
        requires inertia, and a plate with a density and of finite extent. With "auto" it is
        included if, without it, the model error of a result would be about 30 % or more. Static
        contacts include it unless it is False.
    compare_paper_motion
        Whether to print the paper's perturbation motion, too; by default False.

    Examples
    --------
    >>> import platecontact as pc
    >>> scene = pc.Scene(
    ...     sphere=pc.Sphere(radius=0.01, material="steel"),
    ...     plate=pc.Plate(radius=0.3, thickness=0.05, material="glass"),
    ...     impact=pc.Impact(speed=1.0),
    ...     effects=pc.Effects(inertia=False, spherical_profile=True),
    ... )
    >>> included = pc.explain(scene).effects.included
    >>> "inertia" in included, "spherical_profile" in included
    (False, True)
    """

    sphere_elasticity: Wanted = _switch("elastic deformation of the sphere", False)
    spherical_profile: Wanted = _switch("spherical profile instead of a paraboloid", False)
    bending: Wanted = _switch("bending of the plate")
    finite_thickness: Wanted = _switch("shear and compression of the plate")
    finite_radius: Wanted = _switch("finite radius of the plate")
    edge: Wanted = _switch("simply supported or clamped edge")
    non_hertzian_pressure: Wanted = _switch("contact pressure from the integral equation", False)
    plasticity: Wanted = _switch("plastic deformation in the contact")
    viscosity: Wanted = _switch("viscoelastic contact")
    gravity: Wanted = _switch("weight of the sphere during contact", False)
    inertia: Wanted = _switch("inertia of the plate", False)
    stretching: Wanted = _switch("stretching of the plate's middle plane, for large deflections")
    damping: Wanted = _switch("damping of the plate vibration")
    compare_paper_motion: bool = Field(
        default=False,
        description="also print the paper's perturbation motion; the results do not change",
        examples=[True],
    )

    @property
    def quasi_static(self) -> bool:
        """Whether the inertia of the plate is disabled."""
        return self.inertia is False

    @property
    def disabled(self) -> tuple[str, ...]:
        """Names of the effects that the selection may include, but that are disabled."""
        fields = type(self).model_fields.items()
        names = (name for name, field in fields if field.default == "auto")
        return tuple(name for name in names if getattr(self, name) is False)

    @property
    def stretches(self) -> bool:
        """Whether the scene enables stretching of the middle plane."""
        return self.stretching is True

    @property
    def never_stretches(self) -> bool:
        """Whether the scene disables stretching of the middle plane."""
        return self.stretching is False

    @property
    def may_stretch(self) -> bool:
        """Whether the middle plane stretches if the results require it."""
        return self.stretching == "auto"
