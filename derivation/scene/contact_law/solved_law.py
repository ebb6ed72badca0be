"""The contact law with non-Hertzian pressure, of one scene or of many as columns."""

import itertools
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from derivation.scene import kernels
from derivation.scene.contact_law.closed_contact import closed_up_to
from derivation.scene.contact_law.solved_contact import (
    SolvedCase,
    SolvedShape,
    linear_deflection,
    shape_at,
)
from derivation.scene.effects.effect import Contribution
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from derivation.scene.contact_law.law import ContactLaw

LEAST = 1e-12
"""Smallest contact radius, over h, b and R, at which the pressure is not Hertz's [1]."""


def shape(law: "ContactLaw", a: Array) -> tuple[Array, Array, Array, Array]:
    """Return the numbers of `law.Shape` at contact radii [m].

    The curvature of the plate by its edge is a part of the solution.
    """
    model, at = law.model, solution(law, a)
    root = np.cbrt(at.force)
    equal = a * root  # Hertz's radius of the force
    linear = _column(law, [*map(linear_deflection, cases(law))]) * equal
    depth, additive = at.with_linear(linear)
    growth = at.growth / (root * root)  # d equal/da
    part = 1.0 / (1.0 + law.softness)
    others = [effect.contribution(model, equal) for effect in law.beyond_whole_plate]
    if np.any(law.edge_curvature):
        curved = kernels.law_of_square(np.asarray(law.edge_curvature), equal / model.h)
        others.append(Contribution(-curved[0], -curved[1]))
    for plate in others:
        depth = depth + part * root * root * plate.depth
        additive = additive + part * plate.slope
    return at.force, depth, additive * growth * root, additive


def solution(law: "ContactLaw", a: Array, own_edge: bool = True) -> SolvedShape:
    """Return the solution, without the linear deflection, at contact radii [m].

    Scenes with the same case are evaluated together. The plate has the edge of the law, or else
    that of the paper, with which contact may be lost at a smaller radius; the solution then is NaN.
    """
    model = law.model
    a = np.maximum(a, LEAST * np.minimum(np.minimum(model.h, model.b), model.R))
    limits = np.ravel(law.limit).tolist() if own_edge else itertools.repeat(math.inf)
    rows: dict[tuple[SolvedCase, float], list[int]] = {}
    for row, known in enumerate(zip(cases(law, own_edge), limits, strict=False)):
        rows.setdefault(known, []).append(row)
    if len(rows) == 1:
        [known] = rows
        return shape_at(a, *known)
    numbers = np.empty((len(SolvedShape._fields), *a.shape))
    for known, equal in rows.items():
        numbers[:, equal] = shape_at(a[equal], *known)
    return SolvedShape(*numbers)


def limit(law: "ContactLaw", widest: Any) -> Any:
    """Return the largest radius [m], at most `widest`, of contacts closed at the centre."""
    each = cases(law)
    tops = np.broadcast_to(np.ravel(widest), len(each)).tolist()
    return _column(law, [*map(closed_up_to, each, tops)])


def cases(law: "ContactLaw", own_edge: bool = True) -> list[SolvedCase]:
    """Return the quantities that determine the contact, of each scene."""
    columns = [np.ravel(values).tolist() for values in _numbers(law, own_edge)]
    return [SolvedCase._make((*row, law.spherical)) for row in zip(*columns, strict=True)]


def _numbers(law: "ContactLaw", own_edge: bool = True) -> tuple[Array, ...]:
    """Return the numbers of the cases: as columns, unless all are those of one case."""
    m, edge = law.model, law.edge_curvature if own_edge else 0.0
    return np.broadcast_arrays(m.h, m.b, m.R, law.modulus, m.modulus, edge)


def _column(law: "ContactLaw", values: list[float]) -> Any:
    """Return the values of all cases as a column, or that of one case."""
    return np.array(values)[:, None] if _numbers(law)[0].ndim else values[0]
