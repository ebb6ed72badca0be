"""Reads a scene file: what is allowed in it, and one clear message for whatever is wrong."""

import tomllib
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, cast

from pydantic import Field, ValidationError

from derivation.engine.files import read_file
from derivation.engine.printable import one_line
from derivation.scene import old_names
from derivation.scene.bodies import Material as Material
from derivation.scene.bodies import Plate as Plate
from derivation.scene.bodies import Positive
from derivation.scene.bodies import Sphere as Sphere
from derivation.scene.body_materials import material_problems
from derivation.scene.errors import IncompleteError as IncompleteError
from derivation.scene.errors import SceneError as SceneError
from derivation.scene.html import html_table
from derivation.scene.messages import OWN_MATERIALS, shown
from derivation.scene.table import (
    Problem,
    Problems,
    Table,
    found_by,
    in_words,
    plain_keys,
    problems,
)

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


class Impact(Table):
    """How the sphere arrives."""

    speed: Positive = Field(description="impact speed [m/s]", examples=[1.0])
    gravity: Annotated[float, Field(ge=0)] | None = Field(
        default=None, description="acceleration that presses the sphere on [m/s^2]", examples=[9.81]
    )


class Effects(Table):
    """Which effects are included: "auto" selects by the tolerance; and what to compare."""

    sphere_elasticity: Wanted = Field(
        default="auto", description="elastic sphere", examples=[False]
    )
    spherical_profile: Wanted = Field(
        default="auto", description="profile of a sphere, not a paraboloid", examples=[False]
    )
    bending: Wanted = Field(default="auto", description="the plate's deflection", examples=[True])
    finite_thickness: Wanted = Field(
        default="auto", description="shear, compression", examples=[True]
    )
    finite_radius: Wanted = Field(
        default="auto", description="the plate's finite radius", examples=[True]
    )
    edge: Wanted = Field(default="auto", description="the plate's support", examples=[True])
    non_hertzian_pressure: Wanted = Field(
        default="auto", description="contact pressure from the integral equation", examples=[False]
    )
    plasticity: Wanted = Field(default="auto", description="yielding contact", examples=[True])
    viscosity: Wanted = Field(default="auto", description="viscous contact", examples=[True])
    gravity: Wanted = Field(default="auto", description="weight during contact", examples=[False])
    inertia: Wanted = Field(default="auto", description="the plate's own motion", examples=[False])
    damping: Wanted = Field(
        default="auto", description="damping of the plate's modes", examples=[True]
    )
    compare_paper_motion: bool = Field(
        default=False,
        description="the paper's perturbation motion beside the result, which it does not change",
        examples=[True],
    )


class Accuracy(Table):
    """How exact the result is to be."""

    rtol: Annotated[float, Field(ge=TIGHTEST, le=1)] = Field(
        description="relative tolerance of the results [1]", examples=[1e-6]
    )
    outputs: tuple[Output, ...] = Field(
        default=OUTPUTS,
        description="results it applies to",
        examples=[["max_force"]],
        min_length=1,
        strict=False,  # TOML has arrays, no tuples
    )


class Inertia(Table):
    """How the plate's inertia is computed, where it is."""

    modes: Literal["auto"] | Annotated[int, Field(ge=2, le=6000)] = Field(
        default="auto",
        description="number of dynamic bending modes; higher modes respond quasi-statically",
        examples=[40],
    )
    branches: Literal["auto", "A0", "all"] = Field(
        default="auto",
        description="wave branches of the plate: the lowest (A0), all, or all where the tolerance "
        "needs them",
        examples=["all"],
    )
    coupling: Literal["variational", "pointwise"] = Field(
        default="variational",
        description="definition of the indentation: the weighted mean of the gap, which conserves "
        "energy, or its value at the axis",
        examples=["pointwise"],
    )
    extent: Literal["finite", "infinite"] = Field(
        default="finite",
        description="a plate with its edge, or one so large that no wave returns from the edge",
        examples=["infinite"],
    )


class Measured(Table):
    """A measured restitution, which tells the yield stress or retardation time of the plate."""

    restitution: Annotated[float, Field(gt=0, lt=1)] = Field(
        description="measured rebound speed over impact speed [1]", examples=[0.6]
    )
    solve_for: Literal["yield_stress", "retardation_time"] = Field(
        description="the plate's quantity that it tells", examples=["yield_stress"]
    )
    target: Literal["block", "plate"] = Field(
        default="block",
        description="what was struck: a thick block of the plate's material, or the plate",
        examples=["plate"],
    )
    tested_at: Positive | None = Field(
        default=None, description="impact speed of the measurement [m/s]", examples=[1.0]
    )


class Scene(Table):
    """A sphere striking a plate.

    Tables may also be plain mappings, as a scene file holds them.

    Raises
    ------
    SceneError
        With one message that lists everything that is wrong.

    Examples
    --------
    >>> import platecontact as pc
    >>> scene = pc.Scene(
    ...     sphere=pc.Sphere(radius=0.01, material="steel"),
    ...     plate=pc.Plate(radius=0.3, thickness=0.05, material="glass"),
    ...     impact={"speed": 1.0},
    ... )
    >>> print(f"{pc.simulate(scene).restitution:.2f}")
    0.97
    """

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            sphere: Sphere | Mapping[str, Any],
            plate: Plate | Mapping[str, Any],
            impact: Impact | Mapping[str, Any],
            effects: Effects | Mapping[str, Any] | None = None,
            inertia: Inertia | Mapping[str, Any] | None = None,
            accuracy: Accuracy | Mapping[str, Any] | None = None,
            measured: Measured | Mapping[str, Any] | None = None,
            materials: Mapping[str, Material | Mapping[str, Any]] | None = None,
        ) -> None: ...

    else:

        def __init__(self, /, **tables: Any) -> None:
            _scene(tables, "scene", self)

        __init__.__pydantic_base_init__ = True  # a file is read without it

    sphere: Sphere = Field(description="the sphere that strikes")
    plate: Plate = Field(description="the elastic plate that is struck in its middle")
    impact: Impact = Field(description="how the sphere arrives")
    effects: Effects = Field(
        default_factory=lambda: Effects.model_validate({}),
        description="which effects are computed",
    )
    inertia: Inertia | None = Field(default=None, description="how the plate's inertia is computed")
    accuracy: Accuracy | None = Field(default=None, description="how exact the result is to be")
    measured: Measured | None = Field(
        default=None, description="a measured restitution that tells a quantity of the plate"
    )
    materials: dict[str, Material] = Field(
        default_factory=dict,
        description="materials of your own by name; one takes precedence over a named material "
        "of the same name",
    )

    @classmethod
    def conflicts(cls, given: Mapping[str, Any]) -> list[str]:
        """What is wrong with materials and measurement; the rest each table has looked at."""
        return [*material_problems(given), *_solved_twice(given)]

    def _repr_html_(self) -> str:
        """The keys given, for a notebook."""
        given = self.to_json()
        own = given.pop(OWN_MATERIALS, {})
        given |= {f"{OWN_MATERIALS}.{name}": keys for name, keys in own.items()}
        rows = ((table, key, value) for table, keys in given.items() for key, value in keys.items())
        return html_table(("table", "key", "value in SI"), rows)


def _solved_twice(given: Mapping[str, Any]) -> list[str]:
    """A quantity of the plate that is given and is to be found from a measurement."""
    measured, plate = given.get("measured"), given.get("plate")
    if not isinstance(measured, Mapping) or not isinstance(plate, Mapping):
        return []
    key = measured.get("solve_for")
    if not isinstance(key, str) or plate.get(key) is None:
        return []
    expected = f"expected a quantity that is not given, got {key}, which [plate] gives"
    return [f"measured.solve_for: {expected}; remove plate.{key}, or [measured]"]


TABLES: dict[str, type[Table]] = {
    "sphere": Sphere,
    "plate": Plate,
    "impact": Impact,
    "effects": Effects,
    "inertia": Inertia,
    "accuracy": Accuracy,
    "measured": Measured,
}


def load(path: str | Path) -> Scene:
    """Read a scene file.

    Parameters
    ----------
    path
        TOML file with the tables ``sphere``, ``plate`` and ``impact``, in SI units, and if
        wanted ``accuracy``, ``effects``, ``inertia``, ``measured`` and ``materials``.

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


def _scene(data: Mapping[str, Any], source: str, scene: Scene | None = None) -> Scene:
    """Make a scene, or fill one, with a notice for each old name."""
    tables, notices, twice = old_names.renewed(_plain(data))
    for notice in notices:
        old_names.tell(notice)
    found: Problems = [partial(str, text) for text in twice]
    try:
        made = Scene.__pydantic_validator__.validate_python(tables, self_instance=scene)
    except ValidationError as error:
        found += _problems(error, tables)
    else:
        if not found:
            return cast(Scene, made)
    raise SceneError(f"{source}: {in_words(found)}")


def _plain(data: Mapping[str, Any]) -> dict[str, Any]:
    """Tables as a scene file would hold them."""
    found = dict[str, Any]()
    for name, table in data.items():
        keys = table.to_json() if isinstance(table, Table) else table
        if name == OWN_MATERIALS and isinstance(keys, Mapping):
            found[name] = _plain(keys)
        elif isinstance(keys, Mapping):
            found[name] = plain_keys(keys)
        elif keys is not None:
            found[name] = keys
    return found


def schema() -> dict[str, Any]:
    """JSON schema of a scene file, for editors that check and complete TOML."""
    dialect = {"$schema": "https://json-schema.org/draft/2020-12/schema"}
    return dialect | Scene.model_json_schema()


def _problems(error: ValidationError, data: Mapping[str, Any]) -> Problems:
    """What is wrong with a scene, each still to be put into words."""
    own = data.get(OWN_MATERIALS)
    names = own if isinstance(own, Mapping) else ()
    known = TABLES | {f"{OWN_MATERIALS}.{name}": Material for name in names}
    found = problems(map(_by_table, found_by(error)), data, known)
    return found + [partial(str, text) for text in Scene.conflicts(data)]


def _by_table(problem: Problem) -> Problem:
    """The same with a material as a table of its own."""
    place = problem.place
    if len(place) > 1 and place[0] == OWN_MATERIALS:
        place = (f"{OWN_MATERIALS}.{place[1]}", *place[2:])
    return problem._replace(place=place)
