"""Reads and validates a scene file; one message lists all problems of its tables and keys."""

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

from pydantic import Field, ValidationError

from derivation.scene.errors import IncompleteError as IncompleteError
from derivation.scene.errors import SceneError as SceneError
from derivation.scene.input import old_names
from derivation.scene.input.bodies import ELASTIC, Positive
from derivation.scene.input.bodies import Material as Material
from derivation.scene.input.bodies import Plate as Plate
from derivation.scene.input.bodies import Sphere as Sphere
from derivation.scene.input.body_materials import material_problems
from derivation.scene.input.example_scenes import remedy
from derivation.scene.input.included import Effects as Effects
from derivation.scene.input.messages import LARGEST_NUMBER, OWN_MATERIALS, shown
from derivation.scene.input.settings import BODIES
from derivation.scene.input.settings import OUTPUTS as OUTPUTS
from derivation.scene.input.settings import TIGHTEST as TIGHTEST
from derivation.scene.input.settings import Accuracy as Accuracy
from derivation.scene.input.settings import Inertia as Inertia
from derivation.scene.input.settings import Measured as Measured
from derivation.scene.input.settings import Output as Output
from derivation.scene.input.table import (
    Problem,
    Problems,
    Table,
    in_words,
    plain_keys,
    problems,
    problems_of,
)
from derivation.scene.input.toml_file import name_of, path_of, read_toml
from derivation.scene.output.html import html_table

VARY = "vary"
"""Table of a scene file with the distributions of a sample, for `platecontact sweep`."""


class Impact(Table):
    """Speed of the sphere at first contact, and gravity.

    Parameters
    ----------
    speed
        Impact speed [m/s].
    gravity
        Gravitational acceleration during contact [m/s^2]; by default none.

    Examples
    --------
    >>> import platecontact as pc
    >>> pc.Impact(speed=1.0, gravity=9.81).to_json()
    {'speed': 1.0, 'gravity': 9.81}
    """

    speed: Positive = Field(description="impact speed [m/s]", examples=[1.0])
    gravity: Annotated[float, Field(ge=0, le=LARGEST_NUMBER)] | None = Field(
        default=None,
        description="gravitational acceleration during contact [m/s^2]",
        examples=[9.81],
    )


class Scene(Table):
    """A sphere that strikes a plate: the input of a simulation.

    Each table is an object such as `Sphere`, or a mapping from key to value. All values are in SI
    units.

    Raises
    ------
    SceneError
        If a key is missing, unknown or invalid; the message lists all problems.

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

    sphere: Sphere = Field(description="the sphere")
    plate: Plate = Field(description="the elastic circular plate, struck at its centre")
    impact: Impact = Field(description="speed of the sphere at first contact, and gravity")
    effects: Effects = Field(
        default_factory=lambda: Effects.model_validate({}),
        description="which effects are included",
    )
    inertia: Inertia | None = Field(default=None, description="how the plate's inertia is computed")
    accuracy: Accuracy | None = Field(
        default=None, description="the requested accuracy of the results"
    )
    measured: Measured | None = Field(
        default=None,
        description="a measured restitution, to determine a material constant of the plate",
    )
    materials: dict[str, Material] = Field(
        default_factory=dict,
        description="your own materials, by name; they take precedence over the built-in materials "
        "of the same name",
    )

    @classmethod
    def conflicts(cls, given: Mapping[str, Any]) -> list[str]:
        """Return the problems of materials and measurement; each table checks its own keys."""
        return [*material_problems(given), *_solved_twice(given)]

    def __hash__(self) -> int:
        """Return the same number for equal scenes, so that results can be kept by scene."""
        tables = (getattr(self, name) for name in TABLES)
        return hash((*tables, frozenset(self.materials.items())))

    def _repr_html_(self) -> str:
        """Return the given keys as a table for a notebook."""
        given = self.to_json()
        own = given.pop(OWN_MATERIALS, {})
        given |= {f"{OWN_MATERIALS}.{name}": keys for name, keys in own.items()}
        rows = ((table, key, value) for table, keys in given.items() for key, value in keys.items())
        return html_table(("table", "key", "value (SI units)"), rows)


def _solved_twice(given: Mapping[str, Any]) -> list[str]:
    """Return a problem if the constant to be determined is given, or of a rigid sphere."""
    measured = given.get("measured")
    key = measured.get("solve_for") if isinstance(measured, Mapping) else None
    if not isinstance(measured, Mapping) or not isinstance(key, str):
        return []
    found, body = [], str(measured.get("body", "plate"))
    for one in BODIES.get(body, ()):
        table = given.get(one)
        if isinstance(table, Mapping) and table.get(key) is not None:
            expected = (
                f"expected a constant that is not given, got {key}, which is given in [{one}]"
            )
            found.append(f"measured.solve_for: {expected}; remove {one}.{key}, or [measured]")
    sphere = given.get("sphere")
    rigid = isinstance(sphere, Mapping) and all(sphere.get(name) is None for name in ELASTIC)
    if rigid and "sphere" in BODIES.get(body, ()):
        found.append(
            f'measured.body: expected "plate", because the sphere is rigid, got "{body}"; change '
            "it, or add sphere.material or the pair sphere.youngs_modulus, sphere.poissons_ratio"
        )
    return found


TABLES: dict[str, type[Table]] = {
    "sphere": Sphere,
    "plate": Plate,
    "impact": Impact,
    "effects": Effects,
    "inertia": Inertia,
    "accuracy": Accuracy,
    "measured": Measured,
}


def check_scene(scene: object) -> None:
    """Raise an error unless an object is a scene."""
    if not isinstance(scene, Scene):
        raise SceneError(
            f"expected a Scene, got {shown(scene)}; read a file with load(path), and tables with "
            "read(tables)"
        )


def load(path: str | Path) -> Scene:
    """Read a scene file.

    Parameters
    ----------
    path
        TOML file with the tables ``sphere``, ``plate`` and ``impact``, in SI units, and
        optionally ``accuracy``, ``effects``, ``inertia``, ``measured`` and ``materials``; "-" for
        standard input. Distributions for `platecontact sweep` in a table ``vary`` are ignored.

    Returns
    -------
    Scene
        The scene.

    Raises
    ------
    SceneError
        If the file cannot be read or is not TOML, or a key is missing, unknown or invalid.

    Examples
    --------
    The file is a copy of an example, which ``platecontact examples glass_pane`` writes.

    >>> import platecontact as pc
    >>> pc.load("glass_pane.toml").plate.edge
    'simply-supported'
    """
    data, _ = _tables(path)
    return _scene(data, name_of(path))


def load_with_distributions(path: str | Path) -> tuple[Scene, Mapping[str, Any]]:
    """Return the scene of a file, and its table `[vary]` of distributions for a sample.

    Raises
    ------
    SceneError
        As for `load`.
    """
    data, given = _tables(path)
    return _scene(data, name_of(path)), given


def _tables(path: str | Path) -> tuple[dict[str, Any], Mapping[str, Any]]:
    """Return the tables of a scene in a file, and its distributions."""
    data = read_toml(path, "the scene file", remedy(path_of(path)), "`radius = 0.13`")
    given = data.pop(VARY, {}) if isinstance(data.get(VARY, {}), Mapping) else {}
    return data, given


def read(data: Mapping[str, Any], source: str = "scene") -> Scene:
    """Return a scene from nested mappings with the tables and keys of a scene file.

    Parameters
    ----------
    data
        Tables ``sphere``, ``plate`` and ``impact``, and optionally the other tables of a scene
        file; each is a mapping from key to value, in SI units.
    source
        Name of the scene in error messages, for example the file name.

    Returns
    -------
    Scene
        The scene.

    Raises
    ------
    SceneError
        If a key is missing, unknown or invalid; the message lists all problems.

    Examples
    --------
    >>> import platecontact as pc
    >>> scene = pc.read({
    ...     "sphere": {"radius": 0.01, "material": "steel"},
    ...     "plate": {"radius": 0.3, "thickness": 0.05, "material": "glass"},
    ...     "impact": {"speed": 1.0},
    ... })
    >>> scene.plate.edge
    'paper'
    """
    if not isinstance(data, Mapping):
        raise SceneError(
            f"{source}: expected a mapping with the tables of a scene file, got {shown(data)}; "
            "to read a file, use `load`"
        )
    return _scene(data, source)


def _scene(data: Mapping[str, Any], source: str, scene: Scene | None = None) -> Scene:
    """Return a scene, or initialise a given one; warn of each old name."""
    tables, notices, twice = old_names.renewed(_plain(data))
    for notice in notices:
        old_names.notify(notice)
    texts: Problems = [partial(str, text) for text in twice]
    try:
        made = Scene.__pydantic_validator__.validate_python(tables, self_instance=scene)
    except ValidationError as error:
        texts += _problems(error, tables)
    else:
        if not texts:
            return cast(Scene, made)
    raise SceneError(f"{source}: {in_words(texts)}")


def _plain(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the tables as plain mappings with plain numbers."""
    plain = dict[str, Any]()
    for name, table in data.items():
        keys = table.to_json() if isinstance(table, Table) else table
        if name == OWN_MATERIALS and isinstance(keys, Mapping):
            plain[name] = _plain(keys)
        elif isinstance(keys, Mapping):
            plain[name] = plain_keys(keys)
        elif keys is not None:
            plain[name] = keys
    return plain


def schema() -> dict[str, Any]:
    """Return the JSON schema of scene files, with which editors check and complete TOML.

    The schema covers single keys and choices between keys. `load` and `read` also check the names
    of materials and combinations of values.

    Returns
    -------
    dict
        The schema, of the draft 2020-12 of JSON Schema.

    Examples
    --------
    >>> import platecontact as pc
    >>> pc.schema()["required"]
    ['sphere', 'plate', 'impact']
    """
    dialect = {"$schema": "https://json-schema.org/draft/2020-12/schema"}
    return dialect | Scene.model_json_schema()


def _problems(error: ValidationError, data: Mapping[str, Any]) -> Problems:
    """Return all problems of a scene, each as a function that returns the message."""
    materials = data.get(OWN_MATERIALS)
    names = materials if isinstance(materials, Mapping) else ()
    known = TABLES | {f"{OWN_MATERIALS}.{name}": Material for name in names}
    texts = problems(map(_by_table, problems_of(error)), data, known)
    return texts + [partial(str, text) for text in Scene.conflicts(data)]


def _by_table(problem: Problem) -> Problem:
    """Return the problem with a scene's own material as a separate table."""
    place = problem.place
    if len(place) > 1 and place[0] == OWN_MATERIALS:
        place = (f"{OWN_MATERIALS}.{place[1]}", *place[2:])
    return problem._replace(place=place)


def outputs_of(scene: Scene) -> tuple[str, ...]:
    """Return the results that the tolerance and the error bound of a scene apply to."""
    return OUTPUTS if scene.accuracy is None else scene.accuracy.outputs
