"""Presses the sphere into the plate by a given contact radius, force or indentation."""

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from derivation.scene import kernels
from derivation.scene.explain import shown
from derivation.scene.limits import check_numbers, check_radius, check_range, warnings_at
from derivation.scene.model import Model, model_of
from derivation.scene.scene import Scene, SceneError

UNITS = {"contact_radius": "m", "force": "N", "indentation": "m"}
Values = float | Iterable[float]


@dataclass(frozen=True)
class Contact:
    """The sphere at rest in the plate.

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


def indent(
    scene: Scene,
    *,
    contact_radius: Values | None = None,
    force: Values | None = None,
    indentation: Values | None = None,
) -> tuple[Contact, ...]:
    """Press the sphere in, at rest; exactly one of the three is to be given.

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
    tuple of Contact
        One row for each value, in the order given.

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
    model = model_of(scene)
    numbers = _numbers(name, values)
    with np.errstate(all="ignore"):  # extreme scenes end in NaN, which is looked for
        return tuple(_contact(model, name, value) for value in numbers)


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


def _contact(model: Model, name: str, value: float) -> Contact:
    a = _radius(model, name, value)
    check_radius(model, a, f"{name} = {value:.6g} {UNITS[name]}", f"give a smaller {name}")
    delta = float(kernels.indentation(a, model.R, model.h, model.b))
    P = float(kernels.force_of_radius(a, model.R, model.lam, model.mu))
    slope = float(kernels.stiffness(a, model.R, model.h, model.b, model.lam, model.mu))
    pressure = float(kernels.max_pressure(a, model.R, model.lam, model.mu))
    check_numbers(model, a, delta, P, slope, pressure)
    # What was given is returned as it was given, not after a trip through its inverse.
    delta, P = (value if name == "indentation" else delta, value if name == "force" else P)
    return Contact(a, delta, P, slope, pressure, warnings_at(model, a, delta))


def _radius(model: Model, name: str, value: float) -> float:
    if name == "contact_radius":
        return value
    if name == "force":
        found = float(kernels.radius_of_force(value, model.R, model.lam, model.mu))
        return found if found == found else _radius_beyond(model, value)
    check_range(model, value)
    return float(kernels.contact_radius(value, model.R, model.h, model.b))


def _radius_beyond(model: Model, force: float) -> float:
    """Contact radius of a force too large for the sphere: for the message that refuses it."""
    inside = model.R / 2
    ratio = force / float(kernels.force_of_radius(inside, model.R, model.lam, model.mu))
    return inside * float(np.cbrt(ratio))
