"""Computes static contacts from given contact radii, forces or indentations.

Every effect that applies to a static contact is included unless the scene disables it; there is no
selection by a tolerance. Radii follow from forces and indentations by Newton's iteration in
logarithms.
"""

import math
import sys
from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from html import escape
from numbers import Real
from typing import Any, NamedTuple

import numpy as np

from derivation.engine.text import aligned, paragraph
from derivation.scene.contact_law.corrections import stretching
from derivation.scene.contact_law.edge_curvature import edge_curvature_errors
from derivation.scene.contact_law.edge_remainder import edge_warnings, largest_neighbours
from derivation.scene.contact_law.finite_sphere import finite_sphere_error
from derivation.scene.contact_law.law import ContactLaw, Shape
from derivation.scene.contact_law.limits import (
    check_numbers,
    check_radius,
    last_radius,
    local_indentation,
    warnings_at,
)
from derivation.scene.contact_law.yield_warnings import static_warnings
from derivation.scene.contact_law.yielding import yielding_of
from derivation.scene.effects import EFFECTS
from derivation.scene.errors import SceneError
from derivation.scene.input.messages import shown
from derivation.scene.input.units import unit_warnings, with_unit_warnings
from derivation.scene.model import model_of
from derivation.scene.numerics.crossing import last_true
from derivation.scene.output.html import html_table
from derivation.scene.quantity import up_to
from derivation.scene.scene import Scene
from derivation.scene.selection.selection import check_enabled

UNITS = {"contact_radius": "m", "force": "N", "indentation": "m"}
STIFFNESS = 4.0 / 3.0
"""Relative change of the stiffness over that of the force, at equal indentation, if the relative
change of the indentation at equal force is proportional to a/R."""
HEADS = (
    "#radius [m]", "#indentation [m]", "#force [N]", "#stiffness [N/m]", "#max. pressure [Pa]",
)  # fmt: skip
"""Column heads of the table of contacts."""
MOST_SHOWN, UNLIKE = 20, 0.5
"""Largest number of contacts whose model errors are all shown, and smallest over largest model
error below which they are."""
_STEPS, _CLOSE, _FOUND, _HALVINGS = 60, 4e-16, 1e-12, 60
"""Largest number of Newton's steps; relative step that ends the iteration; largest relative step of
an accepted result; number of halvings of an interval."""
Values = float | Iterable[float]


@dataclass(frozen=True)
class StaticContact:
    """A static contact of sphere and plate.

    Attributes
    ----------
    contact_radius, indentation
        Contact radius and indentation [m].
    force
        Contact force [N].
    stiffness
        Derivative of the force with respect to the indentation, on loading [N/m].
    max_pressure
        Pressure at the centre of the contact [Pa]; where the contact yields, the limit 1.6 Y.
    model_error
        Largest relative error of any of these by the model [1], by the edge of the plate and by its
        stretching; infinite if that of the edge is unknown.
    warnings
        Warnings about validity.
    """

    contact_radius: float
    indentation: float
    force: float
    stiffness: float
    max_pressure: float
    model_error: float = 0.0
    warnings: tuple[str, ...] = ()

    def to_json(self) -> dict[str, Any]:
        """Return the attributes as a dictionary, in SI units; an unknown model error is None."""
        error = self.model_error if math.isfinite(self.model_error) else None
        return asdict(self) | {"model_error": error, "warnings": list(self.warnings)}


class StaticContacts(tuple[StaticContact, ...]):
    """Static contacts, in the order of the given values."""

    __slots__ = ()

    def rows(self) -> list[list[str]]:
        """Return the cells of the table, under `HEADS`, in SI units."""
        return [[f"{x:.6g}" for x in list(asdict(c).values())[: len(HEADS)]] for c in self]

    @property
    def model_note(self) -> str:
        """The largest model error, or those of a few contacts if they differ; empty without one."""
        errors = [contact.model_error for contact in self]
        if not any(errors):
            return ""
        sizes = [up_to(error) if math.isfinite(error) else "unknown" for error in errors]
        if len(set(sizes)) == 1 or len(sizes) > MOST_SHOWN or min(errors) > UNLIKE * max(errors):
            return f"Model error: {sizes[errors.index(max(errors))]}"
        plain = ", ".join(size.removeprefix("up to ") for size in sizes)
        return paragraph(f"Model error of each row, at most: {plain}")

    def __str__(self) -> str:
        """Return the table as text, with model error and warnings."""
        return "\n\n".join([self.to_text(), *(paragraph(f"Warning: {x}") for x in self.warnings)])

    def to_text(self) -> str:
        """Return the table as text, with the model error."""
        table = aligned(HEADS, self.rows())
        return f"{table}\n\n{self.model_note}" if self.model_note else table

    @property
    def warnings(self) -> tuple[str, ...]:
        """The warnings of all contacts, each once."""
        return tuple(dict.fromkeys(text for contact in self for text in contact.warnings))

    def _repr_html_(self) -> str:
        """Return the table for a notebook, with model error and warnings below it."""
        error = f"<p>{self.model_note}</p>" if self.model_note else ""
        return (
            html_table(HEADS, self.rows())
            + error
            + "".join(f"<p><b>Warning:</b> {escape(text)}</p>" for text in self.warnings)
        )


def indent(
    scene: Scene,
    *,
    contact_radius: Values | None = None,
    force: Values | None = None,
    indentation: Values | None = None,
) -> StaticContacts:
    """Compute static contacts from contact radii, forces or indentations.

    Parameters
    ----------
    scene
        The scene, as `load` returns it. Speed, mass, gravity and tolerance have no effect.
    contact_radius, force, indentation
        Contact radii [m], forces [N] or indentations [m], exactly one of the three: a positive
        number or an iterable of positive numbers. The indentation includes plate deflection.

    Returns
    -------
    StaticContacts
        A tuple with a `StaticContact` for each value, in the given order.

    Raises
    ------
    SceneError
        If not exactly one of the three is given, or a value is not a positive number or is outside
        the range of the contact law.

    Examples
    --------
    >>> import platecontact as pc
    >>> scene = pc.Scene(
    ...     sphere=pc.Sphere(radius=0.01, material="steel"),
    ...     plate=pc.Plate(radius=0.3, thickness=0.05, material="glass"),
    ...     impact=pc.Impact(speed=1.0),
    ... )
    >>> [contact] = pc.indent(scene, force=100.0)
    >>> print(f"{contact.indentation:.2g} m")
    6.2e-06 m
    """
    choices = {"contact_radius": contact_radius, "force": force, "indentation": indentation}
    given = [(name, values) for name, values in choices.items() if values is not None]
    if len(given) != 1:
        got = " and ".join(name for name, _ in given) or "none"
        raise SceneError(
            "indent: expected exactly one of contact_radius, force and indentation, "
            f"got {got}; {'remove all but one' if given else 'add one of them'}"
        )
    [(name, values)] = given
    numbers, on_units = _numbers(name, values), unit_warnings(scene)
    try:
        law = static_law(scene)
        with np.errstate(all="ignore"):  # extreme scenes give NaN, which is checked
            contacts = [_contact(law, name, value) for value in numbers]
    except SceneError as error:
        if not on_units:
            raise
        raise with_unit_warnings(error, on_units) from error
    return StaticContacts(
        replace(contact, warnings=(*on_units, *contact.warnings)) for contact in contacts
    )


def static_law(scene: Scene) -> ContactLaw:
    """Return the law with every effect that applies to a static contact and is not disabled."""
    model, wanted = model_of(scene, quasi_static=True), scene.effects.model_dump()
    check_enabled(scene, model)
    present = (
        effect.name
        for effect in EFFECTS
        if effect.static and not effect.not_applicable_reason(model)
    )
    return ContactLaw(model, frozenset(name for name in present if wanted.get(name) is not False))


def _numbers(name: str, values: Values) -> list[float]:
    """Return the given values after checking that each is a positive number."""
    if isinstance(values, np.ndarray) and values.ndim == 0:
        values = values[()]
    listed = list(values) if isinstance(values, Iterable) else [values]
    if isinstance(values, np.ndarray) and values.ndim > 1:
        raise SceneError(f"{name}: expected a sequence of numbers, got {values.ndim} dimensions")
    if not listed or isinstance(values, str):
        got = "a string" if isinstance(values, str) else "none"
        raise SceneError(
            f"{name}: expected one or more positive numbers [{UNITS[name]}], got {got}; "
            f"write for example {name} = [0.001]"
        )
    for value in listed:
        number = isinstance(value, Real) and not isinstance(value, bool)
        if not number or not 0 < value <= sys.float_info.max:
            raise SceneError(
                f"{name}: expected positive numbers [{UNITS[name]}], got {shown(value)}; "
                "correct or remove it"
            )
    return [float(value) for value in listed]


def _in_words(name: str) -> str:
    return name.replace("_", " ")


def _contact(law: ContactLaw, name: str, value: float) -> StaticContact:
    model = law.model
    given = name == "contact_radius" and not law.plastic
    a = value if given else _radius(law, name, value)
    key, remedy = f"{name} = {value:.6g} {UNITS[name]}", f"reduce the {_in_words(name)}"
    check_radius(law, a, key, remedy)
    at = _loaded(law, a)
    check_radius(law, at.radius, key, remedy)
    pressure = min(law.max_pressure(a), law.pressure_limit)
    check_numbers(model, *at, pressure)
    # The given value is returned unchanged, without the rounding errors of the inversion.
    values = {"contact_radius": at.radius, "indentation": at.depth, "force": at.force} | {
        name: value
    }
    return StaticContact(
        **values,
        stiffness=at.stiffness,
        max_pressure=pressure,
        model_error=_model_error(law, at),
        warnings=(
            *warnings_at(law, at.radius, at.depth),
            *(edge_warnings(model, at.radius) if law.other_edge else ()),
            *static_warnings(law, at.radius),
        ),
    )


def _model_error(law: ContactLaw, at: "_Loaded") -> float:
    """Return the largest relative model error of the quantities of a contact [1].

    Edge, stretching, curvature, the finite size of the sphere and motion of the faces change the
    indentation at a given force; the force at a given indentation changes by a power of that. The
    stiffening S of a plate grows with the square of the deflection, so that the derivative of the
    force with respect to it changes by 3 S.
    """
    model, curvature = law.model, edge_curvature_errors(law, at.radius)
    deflection = at.depth - float(local_indentation(law, at.radius))
    changes = curvature.results + 3.0 * float(stretching(model, deflection))
    changes += STIFFNESS * float(finite_sphere_error(law, at.radius, at.depth))
    if law.other_edge:
        [edge] = largest_neighbours(model, np.array([at.radius]), model.eta)
        changes += float(edge) if np.isfinite(edge) else math.inf
    return max(1.0, at.stiffness * at.depth / at.force) * changes + curvature.pressure


class _Loaded(NamedTuple):
    """Contact radius [m], force [N], indentation [m] and stiffness [N/m] of a static contact.

    `radius_a`, `force_a` and `depth_a` are derivatives with respect to the contact radius of the
    elastic law.
    """

    radius: float
    force: float
    depth: float
    stiffness: float
    radius_a: float
    force_a: float
    depth_a: float


def _loaded(law: ContactLaw, a: float) -> _Loaded:
    """Return the contact at a radius [m] of the elastic law; if it yields, its radius is larger."""
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
        radius_a = branch.widening(radii, force, force_a)
        stiffness = force_a / depth_a
    numbers = radius, force, depth, stiffness, radius_a, force_a, depth_a
    return _Loaded(*(float(number[0]) for number in numbers))


def _radius(law: ContactLaw, name: str, value: float) -> float:
    """Return the contact radius [m] of the elastic law for a force, indentation or radius.

    Raises
    ------
    SceneError
        If the value exceeds the range of the law, or the law gives no finite number.
    """
    R, (last, end) = law.model.R, _range_end(law, name)
    largest, _ = _with_slope(law, name, last)
    if not value < largest:
        raise SceneError(
            f"{name}: expected less than {largest:.6g} {UNITS[name]}, where the contact radius "
            f"reaches {end}, got {value:.6g} {UNITS[name]}; reduce the {_in_words(name)}"
        )
    a = value if name == "contact_radius" else math.sqrt(R) * math.sqrt(value)
    if name == "force":
        a = float(law.hertz_radius(np.array(value)))
    a = min(a, last)
    for _ in range(_STEPS):
        reached, slope = _with_slope(law, name, a)
        check_numbers(law.model, reached, slope)
        step = math.log(value / reached) / slope
        if not abs(step) > _CLOSE:
            break
        a = min(a * math.exp(max(-1.0, min(1.0, step))), last)
    if not abs(step) < _FOUND:
        raise SceneError(
            f"{name}: expected a value whose contact can be computed, got {value:.6g} "
            f"{UNITS[name]}; use less extreme values"
        )
    return a


def _range_end(law: ContactLaw, name: str) -> tuple[float, str]:
    """Return the largest radius [m] up to which a quantity grows with it, and the radius in words.

    Near the edge of a thick plate, the law may have no value or decrease before its limit.
    """
    last = last_radius(law)
    if _grows(law, name, last):
        return last, law.limit_in_words
    low = last_true(lambda a: _grows(law, name, a), 0.0, last, _HALVINGS)
    return low, f"{low:.6g} m, beyond which the law of this plate is not valid"


def _grows(law: ContactLaw, name: str, a: float) -> bool:
    """Return whether a quantity is positive and grows with the radius."""
    value, slope = _with_slope(law, name, a)
    return value > 0.0 and slope > 0.0


def _with_slope(law: ContactLaw, name: str, a: float) -> tuple[float, float]:
    """Return a quantity at a radius [m] of the elastic law, and d log(quantity)/d log(a) [1]."""
    at = _loaded(law, a)
    value, slope = {
        "indentation": (at.depth, at.depth_a),
        "force": (at.force, at.force_a),
        "contact_radius": (at.radius, at.radius_a),
    }[name]
    return value, slope * a / value if value else math.nan  # 0 by underflow
