"""Selection of effects for many scenes: the steps of `selection`, in groups of rows.

All rows start with the same effects. In each step, the bounds of all rows with the same effects are
computed together. Each row then includes the effect with its largest bound, and the rows are
grouped again by their effects. For rows with almost equal numbers, one of them decides the first
steps, as long as its bounds are far from the tolerance and from each other. The step that gives the
error bound of the omitted effects is computed for each row.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
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
from derivation.scene.selection.omission_bounds import errors_of, sizes_of, state_of
from derivation.scene.selection.selection import Candidates, candidates_of
from generated.arrays import Double as Array

NEAR = 1e-9
"""Relative distance from a tolerance at which the row is simulated singly."""
TOGETHER = 2048
"""Number of rows whose bounds are computed together, so that they fit into the cache."""
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
        part = model.take(rows)
        try:
            given = candidates_of(part.take(0), wanted)
        except SceneError:
            continue
        waiting = _certain_effects(given, part, rtol[rows], outputs)
        if any(given.left(included) for included in waiting):
            _cache(given, part)
        while waiting:
            included, parts = waiting.popitem()
            indices = np.sort(np.concatenate(parts))
            try:
                given.check(ContactLaw(part.take(0), included))
            except SceneError as error:
                groups.append(Rejected(rows[indices], str(error)))
                continue
            group, others = _step(given, part, included, indices, rtol[rows], outputs)
            if group is not None:
                groups.append(replace(group, rows=rows[group.rows]))
            for names, more in others.items():
                waiting.setdefault(names, []).append(more)
    return groups


def _cache(given: Candidates, model: Model) -> None:
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
) -> dict[frozenset[str], list[Rows]]:
    """Return the rows by the effects that they certainly include."""
    rows = np.arange(len(rtol))
    if given.whole:
        return {PAPER: [rows]}
    groups = groups_of(model, len(rtol)) if rtol.min() == rtol.max() else None
    if groups is None:
        return {given.included: [rows]}
    first, group, clear = groups
    one_of_each = model.take(first)
    _cache(given, one_of_each)

    def step(included: frozenset[str], here: Rows) -> dict[frozenset[str], Rows]:
        return _certain(given, one_of_each, included, here, rtol, outputs, clear)

    reached = np.empty(len(first), dtype=np.intp)
    sets: list[frozenset[str]] = []
    waiting = {given.included: [np.arange(len(first))]}
    while waiting:
        included, parts = waiting.popitem()
        here = np.concatenate(parts)
        reached[here] = len(sets)
        sets.append(included)
        for names, more in step(included, here).items():
            waiting.setdefault(names, []).append(more)
    of_row = reached[group]
    begun: dict[frozenset[str], list[Rows]] = {}
    for number in np.unique(of_row).tolist():
        begun.setdefault(sets[number], []).append(rows[of_row == number])
    return begun


def _certain(
    given: Candidates,
    model: Model,
    included: frozenset[str],
    rows: Rows,
    rtol: Array,
    outputs: Sequence[str],
    clear: float,
) -> dict[frozenset[str], Rows]:
    """Return the rows that clearly continue, by the effects that they then include."""
    law = ContactLaw(model.take(0), included)
    open_ = given.left(included)
    candidates = [effect for effect in open_ if effect.name not in given.blocked]
    if not candidates or _own_solution(law):
        return {}
    try:
        given.check(law)
    except SceneError:
        return {}
    error, _, sizes = _evaluated(given, model, included, rows, rtol, outputs)
    going_on = np.isfinite(error) & (error > clear * rtol[rows])
    return _next(given, candidates, included, going_on, rows, sizes, 1.0 - 1.0 / clear)


def _evaluated(
    given: Candidates,
    model: Model,
    included: frozenset[str],
    rows: Rows,
    rtol: Array,
    outputs: Sequence[str],
) -> tuple[Array, Array, Array]:
    """Return the results of `_errors` for all rows, with the sizes as columns."""
    parts = [rows[start : start + TOGETHER] for start in range(0, len(rows), TOGETHER)]
    laws = (ContactLaw(model.take(part), included) for part in parts)
    groups = [
        _errors(given, law, rtol[part], outputs) for law, part in zip(laws, parts, strict=True)
    ]
    error, fine, *sizes = (np.concatenate(column) for column in zip(*groups, strict=True))
    return error, fine, np.column_stack(sizes) if sizes else np.empty((len(rows), 0))


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
    return law.viscous or law.plastic or law.dynamic


def _step(
    given: Candidates,
    model: Model,
    included: frozenset[str],
    rows: Rows,
    rtol: Array,
    outputs: Sequence[str],
) -> tuple[Group | None, dict[frozenset[str], Rows]]:
    """Return the rows whose selection is complete, and the effect that each other row adds."""
    if _own_solution(ContactLaw(model, included)):
        return None, {}
    open_ = given.left(included)
    if not open_:
        none = np.zeros(len(rows))
        return Group(rows, ContactLaw(model.take(rows), included), _held(given), none, ()), {}
    error, fine, sizes = _evaluated(given, model, included, rows, rtol, outputs)
    limit = rtol[rows]
    near = (np.abs(error - limit) <= NEAR * limit) & (limit > 0.0)
    candidates = [effect for effect in open_ if effect.name not in given.blocked]
    done = (error <= limit) if candidates else np.ones(len(rows), dtype=bool)
    others = {}
    if not done.all():
        others = _next(given, candidates, included, ~done & ~near, rows, sizes, NEAR)
    kept = done & ~near & (fine > 0.0)
    if not kept.any():
        return None, others
    law = ContactLaw(model.take(rows[kept]), included)
    return Group(rows[kept], law, _held(given), error[kept], tuple(open_)), others


def _errors(
    given: Candidates, law: ContactLaw, rtol: Array, outputs: Sequence[str]
) -> tuple[Array, ...]:
    """Return the error if all open effects are omitted, and whether blocked ones may be omitted.

    The sizes of the other open effects follow; they are not computed if no row continues.
    """
    state, open_ = state_of(law), given.left(law.effects)
    error, fine = errors_of(state, open_, outputs)[:, 0], np.ones(len(rtol))
    for effect in open_:
        if effect.name in given.blocked:  # `check_omitted` may reject such a row
            fine *= errors_of(state, [effect], outputs)[:, 0] <= rtol
    candidates = [effect for effect in open_ if effect.name not in given.blocked]
    if len(candidates) < 2 or (error <= rtol).all():
        return (error, fine, *len(candidates) * (error,))
    return (error, fine, *(sizes_of(state, effect, outputs)[:, 0] for effect in candidates))


def _held(given: Candidates) -> bool:
    """Return whether the stress is computed with the edge of the scene."""
    disabled = (e for e in given.present if given.choice[e.name] is False)
    return not any(effect.other_edge for effect in disabled)


def _next(
    given: Candidates,
    candidates: Sequence[Effect],
    included: frozenset[str],
    going_on: NDArray[np.bool_],
    rows: Rows,
    sizes: Array,
    apart: float,
) -> dict[frozenset[str], Rows]:
    """Return the rows that continue, by the effects that they then include.

    The largest size of a row must exceed the second by the fraction `apart` of itself.
    """
    worst = np.argmax(sizes, axis=1)
    if len(candidates) > 1:  # rounding might decide which is larger
        second = np.partition(sizes, -2, axis=1)[:, -2:]
        with np.errstate(invalid="ignore"):  # two infinite sizes are not distinguished
            going_on = going_on & (second[:, 1] - second[:, 0] > apart * second[:, 1])
    rows_by_effects: dict[frozenset[str], Rows] = {}
    for number, effect in enumerate(candidates):
        mine = rows[going_on & (worst == number)]
        if len(mine):
            names = included | {effect.name} | given.along[effect.name]
            rows_by_effects[names] = np.concatenate((rows_by_effects.get(names, mine[:0]), mine))
    return rows_by_effects
