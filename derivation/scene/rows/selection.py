"""Selection of effects for many scenes: the steps of `selection`, in groups of rows.

For rows with almost equal numbers, one of them decides the first steps, as long as its bounds are
far from the tolerance and from each other. The step that gives the error bound of the omitted
effects is computed for each row.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.effects import PAPER, WHOLE_PLATE
from derivation.scene.effects.edge import SUPPORTED
from derivation.scene.effects.effect import Effect
from derivation.scene.errors import SceneError
from derivation.scene.model import Model
from derivation.scene.rows.grouping import groups_of
from derivation.scene.selection.candidates import Candidates, candidates_of
from derivation.scene.selection.omission_bounds import errors_of, state_of
from derivation.scene.selection.selection import Branch, selections
from generated.arrays import Double as Array

CLEAR = 1.0 + 1e-9
"""Factor between bound and tolerance, or two bounds, below which the row is simulated singly."""
MOST = float(np.finfo(np.float64).max)
"""Largest bound of a row that decides for others."""
Rows = NDArray[np.intp]


@dataclass(frozen=True)
class Group:
    """Rows with the same effects.

    Attributes
    ----------
    rows
        Indices of the rows.
    law
        Law of the rows, with columns of numbers.
    held
        Whether the stress on the back face is computed with the edge of the scene.
    error
        Bound on the relative change by all omitted effects together, for each row.
    omitted
        These effects.
    """

    rows: Rows
    law: ContactLaw
    held: bool
    error: Array
    omitted: tuple[Effect, ...]

    def error_on(self, outputs: Sequence[str]) -> Array:
        """Return the bound on the change of other outputs than those of the tolerance."""
        if not self.omitted:
            return np.zeros(len(self.rows))
        return errors_of(state_of(self.law), self.omitted, outputs)[:, 0]


@dataclass(frozen=True)
class Rejected:
    """Rows for which an included effect cannot be computed, because a key is missing."""

    rows: Rows
    reason: str


def selected(
    model: Model, wanted: Mapping[str, Any], rtol: Array, outputs: Sequence[str]
) -> list[Group | Rejected]:
    """Group rows by their included effects; rows in no group are simulated singly.

    These are rows of laws that are not computed in arrays, invalid rows, and rows for which
    rounding could change the selection.

    Parameters
    ----------
    model
        Numbers of the rows, as columns.
    wanted
        "auto", True or False by effect.
    rtol
        Largest relative change by the omitted effects, of each row [1].
    outputs
        The results that the tolerance applies to.
    """
    groups: list[Group | Rejected] = []
    for rows in _with_equal_effects(model, len(rtol)):
        part, limits = model.take(rows), rtol[rows]
        try:
            given = candidates_of(part.take(0), wanted)
        except SceneError:
            continue
        begun = _certain_effects(given, part, limits, outputs)
        if any(given.left(branch.included) for branch in begun):
            prepare(given, part)
        found: dict[frozenset[str], list[tuple[Rows, Array]]] = {}
        omitted: dict[frozenset[str], tuple[Effect, ...]] = {}
        for branch, decided in selections(
            given, part, limits, outputs, clear=CLEAR, begun=begun, stops=_own_solution
        ):
            if isinstance(decided, SceneError):
                groups.append(Rejected(rows[branch.rows], str(decided)))
            elif decided is not None:
                found.setdefault(branch.included, []).append((branch.rows, decided.error))
                omitted[branch.included] = decided.omitted
        for included, parts in found.items():
            indices, error = (np.concatenate(values) for values in zip(*parts, strict=True))
            order = np.argsort(indices)
            law = ContactLaw(part.take(indices[order]), included)
            groups.append(
                Group(rows[indices[order]], law, _held(given), error[order], omitted[included])
            )
    return groups


def prepare(given: Candidates, model: Model) -> None:
    """Compute the values that all bounds need, once for all parts of the model."""
    present = {effect.name for effect in given.present}
    if present & WHOLE_PLATE:
        _ = model.correction
    if present & WHOLE_PLATE and not present <= PAPER:  # the paper's law has its own function
        _ = model.plates
    if any(effect.other_edge for effect in given.present) and model.edge == SUPPORTED:
        _ = model.supports


def _certain_effects(
    given: Candidates, model: Model, rtol: Array, outputs: Sequence[str]
) -> list[Branch]:
    """Return the rows by the effects that they certainly include."""
    rows = np.arange(len(rtol))
    if given.whole:
        return [Branch(rows, PAPER, {})]
    groups = groups_of(model, len(rtol)) if rtol.min() == rtol.max() else None
    if groups is None:
        return [Branch(rows, given.included, {})]
    one_of_each = model.take(groups.first)
    prepare(given, one_of_each)
    sets: list[frozenset[str]] = []
    reached = np.empty(len(groups.first), dtype=np.intp)
    for branch, _ in selections(
        given, one_of_each, rtol[groups.first], outputs,
        clear=groups.clear, largest=MOST, stops=_own_solution,
    ):  # fmt: skip
        if branch.included not in sets:
            sets.append(branch.included)
        reached[branch.rows] = sets.index(branch.included)
    of_row = reached[groups.group]
    begun = (Branch(rows[of_row == i], included, {}) for i, included in enumerate(sets))
    return [branch for branch in begun if len(branch.rows)]


def _with_equal_effects(model: Model, count: int) -> list[Rows]:
    """Group rows to which the same effects apply, because the same numbers are zero or infinite."""
    kinds = np.zeros(count, dtype=np.int64)
    for field in fields(model):
        value = getattr(model, field.name)
        if isinstance(value, np.ndarray):
            kinds = 4 * kinds + 2 * (value[:, 0] == 0.0) + np.isfinite(value[:, 0])
    return [np.flatnonzero(kinds == kind) for kind in np.unique(kinds)]


def _own_solution(law: ContactLaw) -> bool:
    """Return whether impacts by a law are computed one by one."""
    return law.dynamic or (law.plastic and (law.viscous or bool(np.any(law.gravity))))


def _held(given: Candidates) -> bool:
    """Return whether the stress is computed with the edge of the scene."""
    disabled = (e for e in given.present if given.choice[e.name] is False)
    return not any(effect.other_edge for effect in disabled)
