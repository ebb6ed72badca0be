"""Presses the sphere into the plate by a given contact radius, force or indentation.

Every effect that applies to a static contact is included, unless the scene says false: there
none of them costs time worth saving. Force and indentation are turned into radii by Newton's
iteration in logarithms.
"""

import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from html import escape
from typing import Any, NamedTuple

import numpy as np

from derivation.engine.text import aligned
from derivation.scene.effects import EFFECTS
from derivation.scene.html import html_table
from derivation.scene.law import ContactLaw, Shape
from derivation.scene.limits import (
    check_numbers,
    check_radius,
    last_radius,
    warnings_at,
)
from derivation.scene.messages import shown
from derivation.scene.model import model_of
from derivation.scene.scene import Scene, SceneError
from derivation.scene.yield_warnings import static_warnings
from derivation.scene.yielding import yielding_of

UNITS = {"contact_radius": "m", "force": "N", "indentation": "m"}
HEADS = (
    "#radius [m]", "#indentation [m]", "#force [N]", "#stiffness [N/m]", "#max. pressure [Pa]",
)  # fmt: skip
"""Heads of the table of contacts."""
_STEPS, _CLOSE = 60, 4e-16
Values = float | Iterable[float]


@dataclass(frozen=True)
class StaticContact:
    """A static contact of sphere and plate.

    Attributes
    ----------
    contact_radius, indentation
        In m.
    force
        Contact force [N].
    stiffness
        Growth of the force with the indentation [N/m].
    max_pressure
        Pressure in the middle of the contact [Pa].
    warnings
        What to know about the row.
    """

    contact_radius: float
    indentation: float
    force: float
    stiffness: float
    max_pressure: float
    warnings: tuple[str, ...] = ()

    def to_json(self) -> dict[str, Any]:
        """The row as it stands in JSON."""
        return asdict(self) | {"warnings": list(self.warnings)}


class StaticContacts(tuple[StaticContact, ...]):
    """Contacts in the order asked for."""

    __slots__ = ()

    def rows(self) -> list[list[str]]:
        """The contacts as they are shown, under `HEADS`, in SI."""
        return [[f"{x:.6g}" for x in list(asdict(c).values())[: len(HEADS)]] for c in self]

    def __str__(self) -> str:
        """Table for a screen."""
        return aligned(HEADS, self.rows())

    def _repr_html_(self) -> str:
        """Table for a notebook, warnings below it."""
        texts = dict.fromkeys(text for contact in self for text in contact.warnings)
        return html_table(HEADS, self.rows()) + "".join(
            f"<p><b>Warning:</b> {escape(text)}</p>" for text in texts
        )


def indent(
    scene: Scene,
    *,
    contact_radius: Values | None = None,
    force: Values | None = None,
    indentation: Values | None = None,
) -> StaticContacts:
    """Press the sphere in statically; exactly one of the three is to be given.

    Parameters
    ----------
    scene
        The scene, as `load` returns it; its speed and mass play no part.
    contact_radius
        Contact radii [m].
    force
        Contact forces [N].
    indentation
        Indentations [m].

    Returns
    -------
    Contacts
        A tuple: one row for each value, in the order given.

    Raises
    ------
    SceneError
        If not exactly one is given, or a value is none the contact law covers.
    """
    choices = {"contact_radius": contact_radius, "force": force, "indentation": indentation}
    given = [(name, values) for name, values in choices.items() if values is not None]
    if len(given) != 1:
        got = " and ".join(name for name, _ in given) or "none"
        raise SceneError(
            "indent: expected exactly one of contact_radius, force and indentation, "
            f"got {got}; give one"
        )
    [(name, values)] = given
    law = law_at_rest(scene)
    numbers = _numbers(name, values)
    with np.errstate(all="ignore"):  # extreme scenes end in NaN, which is looked for
        return StaticContacts(_contact(law, name, value) for value in numbers)


def law_at_rest(scene: Scene) -> ContactLaw:
    """The law of every effect that applies to a static contact and is not false."""
    model, wanted = model_of(scene), scene.effects.model_dump()
    present = (
        effect.name
        for effect in EFFECTS
        if effect.static and not effect.not_applicable_reason(model)
    )
    return ContactLaw(model, frozenset(name for name in present if wanted.get(name) is not False))


def _numbers(name: str, values: Values) -> list[float]:
    """The values, each a positive number."""
    listed = list(values) if isinstance(values, Iterable) else [values]
    if not listed or isinstance(values, str):
        got = "a string" if isinstance(values, str) else "none"
        raise SceneError(
            f"{name}: expected one or more positive numbers [{UNITS[name]}], got {got}; "
            f"write for instance {name} = [0.001]"
        )
    for value in listed:
        number = isinstance(value, (int, float, np.number)) and not isinstance(value, bool)
        if not number or not 0 < value < float("inf"):
            raise SceneError(
                f"{name}: expected positive numbers [{UNITS[name]}], got {shown(value)}; "
                "leave it out or correct it"
            )
    return [float(value) for value in listed]


def _contact(law: ContactLaw, name: str, value: float) -> StaticContact:
    model = law.model
    given = name == "contact_radius" and not law.plastic
    a = value if given else _radius(law, name, value)
    check_radius(law, a, f"{name} = {value:.6g} {UNITS[name]}", f"give a smaller {name}")
    at = _loaded(law, a)
    pressure = min(law.max_pressure(a), law.pressure_limit)
    check_numbers(model, *at, pressure)
    # What was given is returned as it was given, not after a trip through its inverse.
    found = {"contact_radius": at.radius, "indentation": at.depth, "force": at.force} | {
        name: value
    }
    return StaticContact(
        **found,
        stiffness=at.stiffness,
        max_pressure=pressure,
        warnings=(*warnings_at(law, at.radius, at.depth), *static_warnings(law, at.radius)),
    )


class _Loaded(NamedTuple):
    """Contact radius [m], force [N], indentation [m] and stiffness [N/m] of a contact.

    And the slopes of the first three by the radius of the elastic law.
    """

    radius: float
    force: float
    depth: float
    stiffness: float
    radius_a: float
    force_a: float
    depth_a: float


def _loaded(law: ContactLaw, a: float) -> _Loaded:
    """The contact pressed in to a radius [m] of the elastic law; one that yields is wider."""
    radii = np.array([a])
    shape: Shape = law.at(radii)
    stiffness, depth_a = law.stiffness(radii, shape), 2.0 * shape.slope * (radii / law.model.R)
    force, depth = law.force(radii, shape), law.indentation(radii, shape)
    force_a, radius, radius_a = stiffness * depth_a, radii, np.ones(1)
    branch = yielding_of(law)
    if branch is not None and a > branch.end:
        branch = branch.begun()
        more, more_a = branch.added(force, force_a)
        depth, depth_a, radius = depth + more, depth_a + more_a, branch.widened(radii, force)
        radius_a = force_a * branch.widening(radius)
        stiffness = force_a / depth_a
    numbers = radius, force, depth, stiffness, radius_a, force_a, depth_a
    return _Loaded(*(float(number[0]) for number in numbers))


def _radius(law: ContactLaw, name: str, value: float) -> float:
    """Contact radius [m] of a force or an indentation.

    Raises
    ------
    SceneError
        If it is beyond the law's range, or the law gives no number.
    """
    R, last = law.model.R, last_radius(law)
    largest, _ = _with_slope(law, name, last)
    if not value < largest:
        raise SceneError(
            f"{name}: expected less than {largest:.6g} {UNITS[name]}, where the contact radius "
            f"reaches {law.limit_in_words}, got {value:.6g} {UNITS[name]}; give a smaller {name}"
        )
    a = value if name == "contact_radius" else math.sqrt(R) * math.sqrt(value)
    if name == "force":
        a = math.cbrt(0.75 * (value / law.modulus) * R)
    a = min(a, last)
    for _ in range(_STEPS):
        found, slope = _with_slope(law, name, a)
        check_numbers(law.model, found, slope)
        step = math.log(value / found) / slope
        if not abs(step) > _CLOSE:
            break
        a = min(a * math.exp(max(-1.0, min(1.0, step))), last)
    return a


def _with_slope(law: ContactLaw, name: str, a: float) -> tuple[float, float]:
    """A quantity at a radius [m] of the elastic law, and its elasticity d log/d log a [1]."""
    at = _loaded(law, a)
    value, slope = {
        "indentation": (at.depth, at.depth_a),
        "force": (at.force, at.force_a),
        "contact_radius": (at.radius, at.radius_a),
    }[name]
    return value, slope * a / value
