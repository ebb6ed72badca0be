"""Reads a scene file: what is allowed in it, and one clear message for whatever is wrong."""

import sys
import tomllib
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Annotated, Any, Literal, TypeGuard

from pydantic import Field, ValidationError

from derivation.engine.files import read_file
from derivation.engine.printable import one_line
from derivation.scene import old_names
from derivation.scene.html import html_table
from derivation.scene.materials import MATERIALS
from derivation.scene.messages import explain, listed, shown
from derivation.scene.table import CONFLICT, Table

Positive = Annotated[float, Field(gt=0)]
MaterialName = Literal["steel", "glass", "aluminium", "concrete", "PMMA", "paper"]
Edge = Literal["paper", "simply-supported", "clamped"]
Output = Literal[
    "contact_time", "max_indentation", "max_force", "max_contact_radius", "restitution"
]
Wanted = Literal["auto"] | bool
OUTPUTS: tuple[Output, ...] = (
    "contact_time", "max_indentation", "max_force", "max_contact_radius", "restitution",
)  # fmt: skip
LARGEST = 2**20
"""Bytes of a scene file at most."""
TIGHTEST = 1e-13
"""Smallest relative tolerance: doubles promise no more."""


class SceneError(ValueError):
    """A scene that cannot be computed: the one way in which `scene` fails.

    The message gives the key, what was expected, the value, and the remedy.
    """


class IncompleteError(SceneError):
    """An impact with plate inertia that could not be followed to its end: why, and the remedy."""

    def __init__(self, why: str, remedy: str) -> None:
        super().__init__(why, remedy)  # as pickle makes it anew
        self.why, self.remedy = why, remedy

    def __str__(self) -> str:
        return f"effects.inertia: {self.why}; {self.remedy}"


class Sphere(Table):
    """The sphere that strikes: rigid, unless its material is given."""

    choices = ((("mass",), ("density",)),)
    stand_in = "material"
    radius: Positive = Field(description="sphere radius [m]", examples=[0.13])
    mass: Positive | None = Field(None, description="sphere mass [kg]", examples=[72.0])
    density: Positive | None = Field(None, description="sphere density [kg/m^3]", examples=[7850.0])
    material: MaterialName | None = Field(
        None, description="sphere material, which makes it elastic", examples=["steel"]
    )

    @classmethod
    def conflicts(cls, given: Mapping[str, Any]) -> list[str]:
        """Also a material without density where it is to give the mass."""
        problems = super().conflicts(given)
        name = given.get("material")
        known = MATERIALS.get(name) if isinstance(name, str) else None
        alone = given.get("mass") is None and given.get("density") is None
        if known and known.density is None and alone:
            problems.append(
                f"sphere.material: expected a material of known density, got {shown(name)}; "
                "add for instance `mass = 72` to [sphere]"
            )
        return problems


class Plate(Table):
    """The elastic plate that is struck in its middle."""

    choices = (
        (("half_thickness",), ("thickness",)),
        (("lame_lambda", "lame_mu"), ("youngs_modulus", "poissons_ratio"), ("material",)),
    )
    radius: Positive = Field(description="plate radius [m]", examples=[1.0])
    half_thickness: Positive | None = Field(
        None, description="half of the plate's thickness [m]", examples=[0.1]
    )
    thickness: Positive | None = Field(
        None, description="full thickness of the plate [m]", examples=[0.2]
    )
    lame_lambda: float | None = Field(
        None, description="first Lame constant [Pa]", examples=[0.36e9]
    )
    lame_mu: Positive | None = Field(
        None, description="second Lame constant (shear modulus) [Pa]", examples=[0.43e9]
    )
    youngs_modulus: Positive | None = Field(
        None, description="Young's modulus [Pa]", examples=[1.056e9]
    )
    poissons_ratio: Annotated[float, Field(gt=-1, lt=0.5)] | None = Field(
        None, description="Poisson's ratio [1]", examples=[0.228]
    )
    material: MaterialName | None = Field(None, description="plate material", examples=["glass"])
    edge: Edge = Field(
        "paper",
        description="how the plate's edge is held; paper: the paper's edge, elastically restrained",
        examples=["clamped"],
    )
    density: Positive | None = Field(None, description="plate density [kg/m^3]", examples=[2500.0])
    retardation_time: Positive | None = Field(
        None, description="retardation time A_v of a viscoelastic contact [s]", examples=[1e-4]
    )
    yield_stress: Positive | None = Field(
        None, description="yield stress of the plate [Pa]", examples=[235e6]
    )
    tensile_strength: Positive | None = Field(
        None, description="tensile strength of the plate [Pa]", examples=[45e6]
    )

    @classmethod
    def conflicts(cls, given: Mapping[str, Any]) -> list[str]:
        """Also what makes the material unstable: no bulk modulus above zero."""
        problems = super().conflicts(given)
        lam, mu = given.get("lame_lambda"), given.get("lame_mu")
        if is_number(lam) and is_number(mu) and mu > 0 and 3 * lam + 2 * mu <= 0:
            problems.append(
                "plate.lame_lambda: expected 3 lame_lambda + 2 lame_mu above zero "
                f"(a positive bulk modulus), got lame_lambda = {shown(lam)} and "
                f"lame_mu = {shown(mu)}; raise lame_lambda above {-2 * mu / 3:.6g}"
            )
        return problems


class Impact(Table):
    """How the sphere arrives."""

    speed: Positive = Field(description="impact speed [m/s]", examples=[1.0])
    gravity: Annotated[float, Field(ge=0)] | None = Field(
        None, description="acceleration that presses the sphere on [m/s^2]", examples=[9.81]
    )


class Effects(Table):
    """Which effects are included: "auto" selects by the tolerance; and what to compare."""

    sphere_elasticity: Wanted = Field("auto", description="elastic sphere", examples=[False])
    spherical_profile: Wanted = Field(
        "auto", description="profile of a sphere, not a paraboloid", examples=[False]
    )
    bending: Wanted = Field("auto", description="the plate's deflection", examples=[True])
    finite_thickness: Wanted = Field("auto", description="shear, compression", examples=[True])
    finite_radius: Wanted = Field("auto", description="the plate's finite radius", examples=[True])
    edge: Wanted = Field("auto", description="the plate's support", examples=[True])
    non_hertzian_pressure: Wanted = Field(
        "auto", description="contact pressure from the integral equation", examples=[False]
    )
    viscosity: Wanted = Field("auto", description="viscous contact", examples=[True])
    gravity: Wanted = Field("auto", description="weight during contact", examples=[False])
    inertia: Wanted = Field("auto", description="the plate's own motion", examples=[False])
    compare_paper_motion: bool = Field(
        False,
        description="the paper's perturbation motion beside the result, which it does not change",
        examples=[True],
    )


class Accuracy(Table):
    """How exact the result is to be."""

    rtol: Annotated[float, Field(ge=TIGHTEST, le=1)] = Field(
        description="relative tolerance of the results [1]", examples=[1e-6]
    )
    outputs: tuple[Output, ...] = Field(
        OUTPUTS,
        description="results it applies to",
        examples=[["max_force"]],
        min_length=1,
        strict=False,  # TOML has arrays, no tuples
    )


class Inertia(Table):
    """How the plate's inertia is computed, where it is."""

    modes: Literal["auto"] | Annotated[int, Field(ge=2, le=6000)] = Field(
        "auto",
        description="number of dynamic bending modes; higher modes respond quasi-statically",
        examples=[40],
    )
    branches: Literal["auto", "A0", "all"] = Field(
        "auto",
        description="wave branches of the plate: the lowest (A0), all, or all where the tolerance "
        "needs them",
        examples=["all"],
    )
    coupling: Literal["variational", "pointwise"] = Field(
        "variational",
        description="definition of the indentation: the weighted mean of the gap, which conserves "
        "energy, or its value at the axis",
        examples=["pointwise"],
    )
    extent: Literal["finite", "infinite"] = Field(
        "finite",
        description="a plate with its edge, or one so large that no wave returns from the edge",
        examples=["infinite"],
    )


class Scene(Table):
    """A sphere striking a plate."""

    sphere: Sphere = Field(description="the sphere that strikes")
    plate: Plate = Field(description="the elastic plate that is struck in its middle")
    impact: Impact = Field(description="how the sphere arrives")
    effects: Effects = Field(
        default_factory=lambda: Effects.model_validate({}),
        description="which effects are computed",
    )
    inertia: Inertia | None = Field(None, description="how the plate's inertia is computed")
    accuracy: Accuracy | None = Field(None, description="how exact the result is to be")

    @classmethod
    def conflicts(cls, given: Mapping[str, Any]) -> list[str]:  # noqa: ARG003
        """Nothing: each table has looked at its own keys."""
        return []

    def to_json(self) -> dict[str, dict[str, Any]]:
        """The scene as it was given."""
        return self.model_dump(mode="json", exclude_none=True, exclude_unset=True)

    def _repr_html_(self) -> str:
        """The keys given, for a notebook."""
        given = self.to_json().items()
        rows = ((table, key, value) for table, keys in given for key, value in keys.items())
        return html_table(("table", "key", "value in SI"), rows)


TABLES: dict[str, type[Table]] = {
    "sphere": Sphere,
    "plate": Plate,
    "impact": Impact,
    "effects": Effects,
    "inertia": Inertia,
    "accuracy": Accuracy,
}


def load(path: str | Path) -> Scene:
    """Read a scene file.

    Parameters
    ----------
    path
        TOML file with the tables ``sphere``, ``plate`` and ``impact``, in SI units, and if
        wanted ``accuracy``.

    Raises
    ------
    SceneError
        If the file cannot be read, is not TOML, or describes no usable scene.
    """
    name = one_line(str(path), 200)
    try:
        # Some editors begin a file with a byte-order mark, which TOML does not know.
        data = tomllib.loads(read_file(Path(path), LARGEST).decode("utf-8-sig"))
    except OSError as error:
        reason = error.strerror or error
        raise SceneError(
            f"{name}: cannot read the scene file ({reason}); check its name and permissions"
        ) from None
    except UnicodeDecodeError as error:
        raise SceneError(
            f"{name}: expected a TOML file in UTF-8, got other bytes at {error.start}; "
            "save it as UTF-8 text"
        ) from None
    except tomllib.TOMLDecodeError as error:
        raise SceneError(
            f"{name}: not valid TOML: {error}; a line reads like `radius = 0.13`"
        ) from None
    except (ValueError, RecursionError):  # more digits or brackets than Python can read
        raise SceneError(
            f"{name}: expected a scene of a few lines, got numbers too long or brackets too deep "
            "to read; a line reads like `radius = 0.13`"
        ) from None
    return _scene(data, name)


def read(data: Mapping[str, Any], source: str = "scene") -> Scene:
    """Make a scene from tables of keys, as a scene file holds them.

    Parameters
    ----------
    data
        Tables ``sphere``, ``plate``, ``impact`` and, if wanted, ``accuracy``, each a mapping
        from key to number, in SI.
    source
        What messages call the scene, for instance its file.

    Raises
    ------
    SceneError
        With one message that lists everything that is wrong.
    """
    if not isinstance(data, Mapping):
        raise SceneError(f"{source}: expected tables of keys, got {shown(data)}; see `load`")
    return _scene(data, source)


def _scene(data: Mapping[str, Any], source: str) -> Scene:
    """Make a scene, with a notice for each old name."""
    tables, notices, twice = old_names.renewed(data)
    for notice in notices:
        old_names.tell(notice)
    problems: list[Callable[[], str]] = [partial(str, text) for text in twice]
    try:
        scene = Scene.model_validate(tables)
    except ValidationError as error:
        problems += _problems(error, tables)
    else:
        if not problems:
            return scene
    said = problems[0]() if len(problems) == 1 else listed(problems)
    raise SceneError(f"{source}: {said}")


def schema() -> dict[str, Any]:
    """JSON schema of a scene file, for editors that check and complete TOML."""
    dialect = {"$schema": "https://json-schema.org/draft/2020-12/schema"}
    return dialect | Scene.model_json_schema()


def _problems(error: ValidationError, data: Mapping[str, Any]) -> list[Callable[[], str]]:
    """What is wrong, each still to be put into words."""
    fields = {name: table.model_fields for name, table in TABLES.items()}
    found: dict[object, Callable[[], str]] = {}
    for item in error.errors(include_url=False):
        if item["type"] != CONFLICT:
            # Each alternative that a key has complains by itself.
            place, value = item["loc"], item["input"]
            told = partial(explain, item["type"], place, value, fields)
            found.setdefault((place[:2], shown(value)), told)
    # Pydantic looks at keys together only if each is right; the user wants to hear all at once.
    for name, table in TABLES.items():
        if isinstance(data.get(name), Mapping):
            found |= {text: partial(str, text) for text in table.conflicts(data[name])}
    return list(found.values())


def is_number(value: Any) -> TypeGuard[float]:
    """Whether a value is a number a double can hold."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    return abs(value) < sys.float_info.max
