"""Computes static contacts from given contact radii, forces or indentations.

Every effect that applies to a static contact is included unless the scene disables it; there is no
selection by a tolerance. If the plate deflects so far that its middle plane stretches, this is
included as well.
"""

import math
import sys
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from html import escape
from numbers import Real
from typing import Any

import numpy as np

from derivation.engine.text import aligned, paragraph
from derivation.scene.contact_law.corrections import stretching
from derivation.scene.contact_law.edge_curvature import CurvatureErrors, edge_curvature_errors
from derivation.scene.contact_law.edge_remainder import edge_warnings, largest_neighbours
from derivation.scene.contact_law.finite_sphere import finite_sphere_error
from derivation.scene.contact_law.finite_strains import more_than_radius, radius_error
from derivation.scene.contact_law.flatter_plate import flatter_plate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import (
    check_numbers,
    check_radius,
    last_radius,
    local_indentation,
    warnings_at,
)
from derivation.scene.contact_law.yield_warnings import static_warnings
from derivation.scene.dynamic.static_stretching import counts, more_shapes
from derivation.scene.dynamic.stretching_error import ROTATION
from derivation.scene.effects import EFFECTS
from derivation.scene.errors import SceneError
from derivation.scene.input.messages import shown
from derivation.scene.input.units import unit_warnings, with_unit_warnings
from derivation.scene.model import model_of
from derivation.scene.output.html import html_table
from derivation.scene.quantity import up_to
from derivation.scene.scene import Scene
from derivation.scene.selection.candidates import check_enabled
from derivation.scene.static_contact import (
    UNITS,
    Loaded,
    in_words,
    loaded,
    radius_from,
    radius_of,
)

STIFFNESS = 4.0 / 3.0
"""Relative change of the stiffness over that of the force, at equal indentation, if the relative
change of the indentation at equal force is proportional to a/R."""
CURVATURE, WEIGHTS = 0.05, 1.0
"""Relative errors of the change of curvature under the sphere of a plate that stretches, and of the
change of the indentation that the modes omit.

In 173 contacts with finite elements of finite strains, force and stiffness differed by at most 0.7
of the stated error: contact radii of 0.05 to 2.1 thicknesses, deflections of 0.2 to 10, three
edges, Poisson's ratios of 0 to 0.48. Radius and pressure differed by at most 0.8 of it for a/R
below 0.1, apart from the change by finite strains, which has an error of its own."""
THINNING = 8.0
"""Relative error of the force over the relative change of the indentation, because tension makes
the plate thinner under the sphere. The contact pressure also widens the tensed middle plane, which
deflects the plate by twice as much; the stiffness changes by twice the sum. That is 6, and was
measured as at most 7."""
HEADS = (
    "#radius [m]", "#indentation [m]", "#force [N]", "#stiffness [N/m]", "#max. pressure [Pa]",
)  # fmt: skip
"""Column heads of the table of contacts."""
MOST_SHOWN, UNLIKE = 20, 0.5
"""Largest number of contacts whose model errors are all shown, and smallest over largest model
error below which they are."""
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
        Largest relative error of any of these by the model [1]; infinite if that by the edge of the
        plate is unknown.
    warnings
        Warnings about validity.
    force_error
        The model error of force, indentation and stiffness alone, without radius and pressure [1].
    stretched
        Whether stretching of the plate's middle plane is included; it is negligible otherwise,
        unless the scene disables it.
    """

    contact_radius: float
    indentation: float
    force: float
    stiffness: float
    max_pressure: float
    model_error: float = 0.0
    warnings: tuple[str, ...] = ()
    force_error: float = 0.0
    stretched: bool = False

    def to_json(self) -> dict[str, Any]:
        """Return the attributes as a dictionary, in SI units; an unknown model error is None."""
        errors = {name: getattr(self, name) for name in ("model_error", "force_error")}
        known = {name: x if math.isfinite(x) else None for name, x in errors.items()}
        return asdict(self) | known | {"warnings": list(self.warnings)}


class StaticContacts(tuple[StaticContact, ...]):
    """Static contacts, in the order of the given values."""

    __slots__ = ()

    def rows(self) -> list[list[str]]:
        """Return the cells of the table, under `HEADS`, in SI units."""
        return [[f"{x:.6g}" for x in list(asdict(c).values())[: len(HEADS)]] for c in self]

    @property
    def model_note(self) -> str:
        """The largest model error, or those of a few contacts if they differ; empty without one.

        That of force, indentation and stiffness is added if it is much smaller.
        """
        errors = [contact.model_error for contact in self]
        if not any(errors):
            return ""
        of_force = [contact.force_error for contact in self]
        smaller = any(
            one < UNLIKE * all_of_them for one, all_of_them in zip(of_force, errors, strict=True)
        )
        alone = f"; of force, indentation and stiffness: {_sizes(of_force)}" if smaller else ""
        return paragraph(f"Model error: {_sizes(errors)}{alone}")

    def __str__(self) -> str:
        """Return the table as text, with model error and warnings."""
        return "\n\n".join([self.to_text(), *(paragraph(f"Warning: {x}") for x in self.warnings)])

    def to_text(self) -> str:
        """Return the table as text, with the model error."""
        return "\n\n".join((aligned(HEADS, self.rows()), *self.notes))

    @property
    def notes(self) -> tuple[str, ...]:
        """The model error, and in how many contacts the plate stretches, if there is any."""
        count = sum(contact.stretched for contact in self)
        rows = "" if count == len(self) else f" in {count} of {len(self)} rows"
        stretched = f"Stretching of the plate is included{rows}." if count else ""
        return tuple(note for note in (self.model_note, stretched) if note)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The warnings of all contacts, each once."""
        return tuple(dict.fromkeys(text for contact in self for text in contact.warnings))

    def _repr_html_(self) -> str:
        """Return the table for a notebook, with model error and warnings below it."""
        return (
            html_table(HEADS, self.rows())
            + "".join(f"<p>{note}</p>" for note in self.notes)
            + "".join(f"<p><b>Warning:</b> {escape(text)}</p>" for text in self.warnings)
        )


def _sizes(errors: list[float]) -> str:
    """Return the largest error, or those of a few rows if they differ, in words."""
    sizes = [up_to(error) if math.isfinite(error) else "unknown" for error in errors]
    if len(set(sizes)) == 1 or len(sizes) > MOST_SHOWN or min(errors) > UNLIKE * max(errors):
        return sizes[errors.index(max(errors))]
    return "up to " + ", ".join(size.removeprefix("up to ") for size in sizes) + " (by row)"


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
        The scene, as `load` returns it. Speed, mass, gravity and tolerance have no effect. A thin
        plate stretches, unless `effects.stretching` is False.
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
    stretched = not model.inertia.infinite_plate and not scene.effects.never_stretches
    inertia = replace(model.inertia, stretching=stretched)
    # Static deflections by the modes of the plate do not depend on its density.
    model = replace(model, density=model.density or 1.0, inertia=inertia)
    check_enabled(scene, model)
    present = (
        effect.name
        for effect in EFFECTS
        if (effect.static or effect.stretches) and not effect.not_applicable_reason(model)
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


def _contact(law: ContactLaw, name: str, value: float) -> StaticContact:
    """Return the contact at a value; stretching is included if the plate deflects far enough."""
    model = law.model
    key, remedy = f"{name} = {value:.6g} {UNITS[name]}", f"reduce the {in_words(name)}"
    linear, at = law.only(lambda e: not e.stretches), None
    with suppress(SceneError):  # the error of the stretched plate states a range that it reaches
        at = _at(linear, name, value, key, remedy)
    if at is None or counts(law, _deflection(linear, at)):
        at = _at(law, name, value, key, remedy)
        while more := more_shapes(law, at.change, at.depth):
            try:
                near = radius_from(more, name, value, at.elastic_radius, last_radius(more))
            except SceneError:  # the range ends a little earlier; the error covers the shapes
                break
            law, at = more, loaded(more, near)
    else:
        law = linear
    check_radius(law, at.radius, key, remedy)
    pressure = min(_pressure(law, at), law.pressure_limit)
    check_numbers(model, at.radius, at.force, at.depth, at.stiffness, pressure)
    # The given value is returned unchanged, without the rounding errors of the inversion.
    values = {"contact_radius": at.radius, "indentation": at.depth, "force": at.force} | {
        name: value
    }
    return StaticContact(
        **values,
        stiffness=at.stiffness,
        max_pressure=pressure,
        **_model_errors(law, at),
        warnings=(
            *warnings_at(law, at.radius, at.depth),
            *(edge_warnings(model, at.radius) if law.other_edge else ()),
            *static_warnings(law, at.radius),
        ),
        stretched=at.change is not None,
    )


def _at(law: ContactLaw, name: str, value: float, key: str, remedy: str) -> Loaded:
    """Return the contact of a law at a value; `key` and `remedy` are those of `check_radius`."""
    given = name == "contact_radius"
    if given:
        check_radius(law, value, key, remedy)
    a = value if given and not (law.plastic or law.stretches) else radius_of(law, name, value)
    check_radius(law, a, key, remedy)
    return loaded(law, a)


def _deflection(law: ContactLaw, at: Loaded) -> float:
    """Return the deflection of the plate on the axis [m]."""
    return at.depth - float(local_indentation(law, at.radius))


def _pressure(law: ContactLaw, at: Loaded) -> float:
    """Return the elastic pressure at the centre [Pa]."""
    if at.flatter is None:
        return law.max_pressure(at.elastic_radius)
    return at.flatter.factor * law.max_pressure(at.flatter.radius * at.elastic_radius)


def _model_errors(law: ContactLaw, at: Loaded) -> dict[str, float]:
    """Return the largest relative model errors [1]: of all quantities, and without the pressure.

    Edge, neglected stretching, curvature, the finite size of the sphere and finite strains
    change the indentation at a given force; the force at a given indentation changes by a power of
    that. On a plate that stretches, large rotations change the force at a given deflection, and the
    omitted shapes the force of stretching. Like the stiffening S, these changes grow with the
    square of the deflection, so that the derivative of the force with respect to it changes by
    three times as much.
    """
    model, curvature, change = law.model, edge_curvature_errors(law, at.radius), at.change
    changes, rotation, pressure = curvature.results, 0.0, curvature.pressure
    if change is None:
        changes += 3.0 * float(stretching(model, _deflection(law, at)))
    else:
        changes += 3.0 * change.error / at.depth + THINNING * abs(change.thinner) / at.depth
        rotation = 3.0 * ROTATION * change.steepness
        by_curvature = _curvature_errors(law, at)
        changes += by_curvature.results
        pressure += by_curvature.pressure
    changes += STIFFNESS * float(finite_sphere_error(law, at.radius, at.depth))
    if law.other_edge:
        [edge] = largest_neighbours(model, np.array([at.radius]), model.eta)
        changes += float(edge) if np.isfinite(edge) else math.inf
    error = max(1.0, at.stiffness * at.depth / at.force) * changes + rotation
    pressure += float(radius_error(law, at.radius) + more_than_radius(law, at.radius))
    return {"model_error": error + pressure, "force_error": error}


def _curvature_errors(law: ContactLaw, at: Loaded) -> CurvatureErrors:
    """Return the errors of a plate that stretches by its curvature under the sphere.

    They follow from a plate that is a little less flat. The change of the indentation has an error
    of its own, because the stretching is that under the pressure of the wider contact.
    """
    change, flatter = at.change, at.flatter
    assert change is not None
    assert flatter is not None
    size = abs(change.flattening.change)
    if not size:
        return CurvatureErrors(0.0, 0.0)
    uncertain = CURVATURE + change.flatter_error / size
    part = min(1.0, uncertain)
    other = flatter_plate(law, at.elastic_radius, change.flattening.times(1.0 - part))
    less = at._replace(flatter=other)
    depth = abs(other.depth - flatter.depth) + WEIGHTS * abs(flatter.depth)
    slower = abs(other.compliance - flatter.compliance) + WEIGHTS * abs(flatter.compliance)
    radius = abs(other.radius / flatter.radius - 1.0)
    pressure = abs(_pressure(law, less) / _pressure(law, at) - 1.0)
    results = max(depth, slower * at.force) / at.depth
    return CurvatureErrors(results, uncertain / part * max(radius, pressure))
