"""One static contact of a law, and the contact radius at a force, an indentation or a radius.

Radii follow by Newton's iteration in logarithms.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from derivation.scene.contact_law.flatter_plate import FlatterPlate, flatter_plate
from derivation.scene.contact_law.law import ContactLaw, Shape
from derivation.scene.contact_law.limits import check_numbers, last_radius
from derivation.scene.contact_law.yielding import yielding_of
from derivation.scene.dynamic.static_stretching import Change, change_by_stretching
from derivation.scene.errors import SceneError
from derivation.scene.numerics.crossing import last_true

UNITS = {"contact_radius": "m", "force": "N", "indentation": "m"}
_STEPS, _CLOSE, _FOUND, _HALVINGS, _NEAR = 60, 4e-16, 1e-12, 60, 1e-4
"""Largest number of Newton's steps; relative step that ends the iteration; largest relative step of
an accepted result; number of halvings of an interval; relative step of a numerical derivative."""
_FOUND_STRETCHED = 1e-9
"""The same as `_FOUND` if the plate stretches: a deep indentation is a small difference between the
one without stretching and its change."""


class Loaded(NamedTuple):
    """Contact radius [m], force [N], indentation [m] and stiffness [N/m] of a static contact.

    `radius_a`, `force_a` and `depth_a` are derivatives with respect to the contact radius of the
    elastic law without stretching, `elastic_radius`. `change` and `flatter` are those by
    stretching, if it is included; `radius_a` is then unknown.
    """

    elastic_radius: float
    change: Change | None
    flatter: FlatterPlate | None
    radius: float
    force: float
    depth: float
    stiffness: float
    radius_a: float
    force_a: float
    depth_a: float


def loaded(law: ContactLaw, a: float) -> Loaded:
    """Return the contact at a radius [m] of the elastic law; if it yields, its radius is larger."""
    radii = np.array([a])
    shape: Shape = law.at(radii)
    stiffness, depth_a = law.stiffness(radii, shape), 2.0 * shape.slope * (radii / law.model.R)
    force, depth = law.force(radii, shape), law.indentation(radii, shape)
    force_a, radius, radius_a = stiffness * depth_a, radii, np.ones(1)
    change = change_by_stretching(law, float(force[0]), a)
    branch = yielding_of(law)
    if branch is not None and a > branch.end:
        branch = branch.begun()
        more, more_a = branch.added(force, force_a)
        depth, depth_a, radius = depth + more, depth_a + more_a, branch.widened(radii, force)
        radius_a = branch.widening(radii, force, force_a)
        stiffness = force_a / depth_a
    flatter = None
    if change is not None:
        flatter = flatter_plate(law, a, change.flattening)
        depth = depth + change.depth + flatter.depth
        depth_a = depth_a + (change.compliance + flatter.compliance) * force_a
        radius, radius_a = flatter.radius * radius, math.nan * radius
        stiffness = force_a / depth_a
    numbers = radius, force, depth, stiffness, radius_a, force_a, depth_a
    return Loaded(a, change, flatter, *(float(number[0]) for number in numbers))


def radius_of(law: ContactLaw, name: str, value: float) -> float:
    """Return the contact radius [m] of the elastic law for a force, indentation or radius.

    Raises
    ------
    SceneError
        If the value exceeds the range of the law, or the law gives no finite number.
    """
    R, (last, end) = law.model.R, _range_end(law, name)
    largest, _ = _with_slope(law, name, last)
    if not value < largest:
        where = ", the largest one of the law of this plate"
        if name != "contact_radius":
            where = f", where the contact radius reaches {end}"
        raise SceneError(
            f"{name}: expected less than {largest:.6g} {UNITS[name]}{where}, got {value:.6g} "
            f"{UNITS[name]}; reduce the {in_words(name)}"
        )
    a = value if name == "contact_radius" else math.sqrt(R) * math.sqrt(value)
    if name == "force":
        a = float(law.hertz_radius(np.array(value)))
    return radius_from(law, name, value, min(a, last), last)


def radius_from(law: ContactLaw, name: str, value: float, a: float, last: float) -> float:
    """Return the radius of `radius_of` from a first guess `a`, at most `last` [m].

    Raises
    ------
    SceneError
        If it is not found.
    """
    step, found = math.inf, _FOUND_STRETCHED if law.stretches else _FOUND
    for _ in range(_STEPS):
        reached, slope = _with_slope(law, name, a)
        check_numbers(law.model, reached, slope)
        before, step = step, math.log(value / reached) / slope
        if not abs(step) > _CLOSE or (law.stretches and 0.5 * abs(before) < abs(step) < found):
            break
        a = min(a * math.exp(max(-1.0, min(1.0, step))), last)
    if not abs(step) < found:
        raise SceneError(
            f"{name}: expected a value whose contact can be computed, got {value:.6g} "
            f"{UNITS[name]}; use less extreme values"
        )
    return a


@lru_cache(maxsize=64)
def _range_end(law: ContactLaw, name: str) -> tuple[float, str]:
    """Return the largest radius [m] up to which a quantity grows with it, and the radius in words.

    Near the edge of a thick plate, the law may have no value or decrease before its limit.
    """
    last = last_radius(law)
    if _grows(law, name, last):
        return last, law.limit_in_words
    low = last_true(lambda a: _grows(law, name, a), 0.0, last, _HALVINGS)
    radius = loaded(law, low).radius
    return low, f"{radius:.6g} m, beyond which the law of this plate is not valid"


def _grows(law: ContactLaw, name: str, a: float) -> bool:
    """Return whether a quantity is positive and grows with the radius."""
    value, slope = _with_slope(law, name, a)
    return value > 0.0 and slope > 0.0


def _with_slope(law: ContactLaw, name: str, a: float) -> tuple[float, float]:
    """Return a quantity at a radius [m] of the elastic law, and d log(quantity)/d log(a) [1]."""
    at = loaded(law, a)
    if name == "contact_radius" and at.change is not None:
        narrower = (1.0 - _NEAR) * a
        at = at._replace(radius_a=(at.radius - loaded(law, narrower).radius) / (a - narrower))
    if math.isnan(at.radius):
        return math.nan, math.nan
    value, slope = {
        "indentation": (at.depth, at.depth_a),
        "force": (at.force, at.force_a),
        "contact_radius": (at.radius, at.radius_a),
    }[name]
    return value, slope * a / value if value else math.nan  # 0 by underflow


def in_words(name: str) -> str:
    """Return the name of a quantity in words."""
    return name.replace("_", " ")
