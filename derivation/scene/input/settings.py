"""Tables of a scene for accuracy, plate inertia and a measured restitution."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal, get_args

from pydantic import Field

from derivation.scene.input.bodies import Positive
from derivation.scene.input.messages import FEWEST_MODES as FEWEST_MODES
from derivation.scene.input.messages import MOST_MODES
from derivation.scene.input.table import Table

Output = Literal[
    "contact_time", "max_indentation", "max_force", "max_contact_radius", "restitution"
]
OUTPUTS: tuple[Output, ...] = get_args(Output)
TIGHTEST = 1e-13
"""Smallest relative tolerance that double precision allows."""


class Accuracy(Table):
    """The requested accuracy of the results.

    Parameters
    ----------
    rtol
        Relative tolerance of the results [1], from 1e-13 to 1; by default there is none.
    outputs
        Names of the results that count: tolerance and error bound apply to them. By default all
        five: contact_time, max_indentation, max_force, max_contact_radius and restitution.

    Examples
    --------
    >>> import platecontact as pc
    >>> scene = pc.Scene(
    ...     sphere=pc.Sphere(radius=0.01, material="steel"),
    ...     plate=pc.Plate(radius=0.3, thickness=0.05, material="glass"),
    ...     impact=pc.Impact(speed=1.0),
    ...     accuracy=pc.Accuracy(rtol=0.01, outputs=["max_force"]),
    ... )
    >>> pc.simulate(scene).accuracy.bound < 0.01
    True
    """

    rtol: Annotated[float, Field(ge=TIGHTEST, le=1)] | None = Field(
        default=None, description="relative tolerance of the results [1]", examples=[0.01]
    )
    outputs: tuple[Output, ...] = Field(
        default=OUTPUTS,
        description="results that the tolerance and the error bound apply to",
        examples=[["max_force"]],
        min_length=1,
        strict=False,  # TOML has arrays, no tuples
    )

    @classmethod
    def conflicts(cls, given: Mapping[str, Any]) -> list[str]:
        """Return the problems of the keys, among them a table that changes nothing."""
        problems = super().conflicts(given)
        if given.get("rtol") is None and tuple(given.get("outputs", OUTPUTS)) == OUTPUTS:
            problems.append(
                f"accuracy.rtol: expected a number from {TIGHTEST:g} to 1, or some of the results "
                "as accuracy.outputs, got neither; add `rtol = 0.01` to [accuracy]"
            )
        return problems


class Inertia(Table):
    """Settings for the inertia of the plate, used if it is included.

    Parameters
    ----------
    modes
        Number of dynamic bending modes, from 2 to 6000; higher modes respond quasi-statically. By
        default "auto": the number follows from scene and tolerance.
    branches
        "A0" for the lowest Lamb-wave branch, "all", or by default "auto": all if the tolerance
        requires them.
    coupling
        "variational", the default: the indentation is a weighted mean of the gap, and energy is
        conserved; or "pointwise": the indentation is the gap at the axis. Its results do not
        converge with the number of modes, so that no error bound is stated.
    extent
        "finite", the default: a plate with an edge; or "infinite": no wave returns from the edge,
        and radius and edge of the plate have no effect. An infinite plate needs a density. A static
        contact, and a plate whose inertia is disabled, have the radius and edge of the scene.

    Examples
    --------
    >>> import platecontact as pc
    >>> scene = pc.Scene(
    ...     sphere=pc.Sphere(radius=0.01, material="steel"),
    ...     plate=pc.Plate(radius=0.3, thickness=0.05, material="glass"),
    ...     impact=pc.Impact(speed=1.0),
    ...     inertia=pc.Inertia(modes=40, branches="A0"),
    ... )
    >>> pc.simulate(scene).dynamics.inertia.modes
    40
    """

    modes: Literal["auto"] | Annotated[int, Field(ge=FEWEST_MODES, le=MOST_MODES)] = Field(
        default="auto",
        description="number of dynamic bending modes; higher modes respond quasi-statically",
        examples=[40],
    )
    branches: Literal["auto", "A0", "all"] = Field(
        default="auto",
        description='Lamb-wave branches: "A0" (the lowest), "all", or "auto" (all if the tolerance '
        "requires them)",
        examples=["all"],
    )
    coupling: Literal["variational", "pointwise"] = Field(
        default="variational",
        description='definition of the indentation: "variational" (weighted mean of the gap, '
        'conserves energy) or "pointwise" (at the axis; does not converge with the modes)',
        examples=["pointwise"],
    )
    extent: Literal["finite", "infinite"] = Field(
        default="finite",
        description='extent of the plate: "finite" (with an edge) or "infinite" (no wave returns '
        "from the edge)",
        examples=["infinite"],
    )


BODIES = {"plate": ("plate",), "sphere": ("sphere",), "both": ("sphere", "plate")}
"""The tables with the constant that a measurement determines, by its key `body`."""


class Measured(Table):
    """A measured restitution, from which a material constant of a body is determined.

    Parameters
    ----------
    restitution
        Measured rebound speed over impact speed [1], above 0 and below 1.
    solve_for
        Constant to determine: "yield_stress" or "retardation_time".
    body
        Body whose constant is determined: "plate", the default; "sphere", for example of a golf
        ball; or "both", if both have the same constant.
    target
        Test specimen: "block", the default, for a thick block of the plate material; "plate" for
        the plate itself. The weight of the sphere acts on either, if the scene has gravity.
    tested_at
        Impact speed of the measurement [m/s]; by default that of the scene.

    Examples
    --------
    >>> import platecontact as pc
    >>> scene = pc.Scene(
    ...     sphere=pc.Sphere(radius=0.01, material="steel"),
    ...     plate=pc.Plate(radius=0.3, thickness=0.05, material="glass"),
    ...     impact=pc.Impact(speed=1.0),
    ...     measured=pc.Measured(restitution=0.8, solve_for="retardation_time", tested_at=0.5),
    ... )
    >>> pc.simulate(scene).measured_note.partition(",")[0]
    'plate.retardation_time = 5.8 µs'
    """

    restitution: Annotated[float, Field(gt=0, lt=1)] = Field(
        description="measured rebound speed over impact speed [1]", examples=[0.6]
    )
    solve_for: Literal["yield_stress", "retardation_time"] = Field(
        description="material constant to determine", examples=["yield_stress"]
    )
    body: Literal["plate", "sphere", "both"] = Field(
        default="plate",
        description="body whose constant is determined; both: the same constant of both bodies",
        examples=["sphere"],
    )
    target: Literal["block", "plate"] = Field(
        default="block",
        description="test specimen: a thick block of the plate material, or the plate itself",
        examples=["plate"],
    )
    tested_at: Positive | None = Field(
        default=None, description="impact speed of the measurement [m/s]", examples=[1.0]
    )
