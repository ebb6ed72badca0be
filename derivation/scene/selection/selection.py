"""Effect selection by bounds on the change of the results if an effect is omitted.

The selection starts with the effects that are always included. It includes the effect with the
largest bound until the bound on all omitted effects together is within the tolerance. Each included
effect changes S_1 and the largest radius, so that the bounds are evaluated again each time. The
order does not depend on the tolerance; a larger tolerance therefore never includes more effects.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.effects import PAPER
from derivation.scene.effects.effect import Effect
from derivation.scene.errors import SceneError
from derivation.scene.model import Model
from derivation.scene.scene import OUTPUTS
from derivation.scene.selection.candidates import Candidates, candidates_of
from derivation.scene.selection.omission_bounds import (
    LargestContact,
    errors_of,
    sizes_of,
    state_of,
)
from generated.arrays import Double as Array

TOGETHER = 2048
"""Number of scenes whose bounds are computed together, so that they fit into the cache."""
Rows = NDArray[np.intp]


@dataclass(frozen=True)
class Selection:
    """The result of an effect selection.

    Attributes
    ----------
    state
        The law with the included effects, at its largest contact radius.
    omitted
        The effects that the selection omitted.
    error
        Bound on the change of the outputs by all of them [1].
    sizes
        For each applicable effect, the bound on the change if it is omitted [1]: of an included
        effect when it was included, of an omitted one at the end.
    choice
        "auto", True or False for each applicable effect.
    reasons
        Why an effect does not apply; empty if it applies.
    required
        For each effect that is included only because another one requires it, the name of that
        one.
    blocked
        For each effect that cannot be included, the disabled effect that it requires.
    needed
        Names of the included effects without which the tolerance is not met. The others are
        included because one function computes them all in less time.
    """

    state: LargestContact
    omitted: tuple[Effect, ...]
    error: float
    sizes: Mapping[str, float]
    choice: Mapping[str, Any]
    reasons: Mapping[str, str]
    required: Mapping[str, str]
    blocked: Mapping[str, str]
    needed: frozenset[str]

    @property
    def included(self) -> frozenset[str]:
        """Names of the included effects."""
        return self.state.law.effects


@dataclass(frozen=True)
class Branch:
    """Scenes that include the same effects.

    Attributes
    ----------
    rows
        Indices of the scenes.
    included, required
        As in `Candidates`.
    sizes
        Bounds on the change if an effect is omitted, of each scene, by name; of an included effect
        when it was included [1].
    """

    rows: Rows
    included: frozenset[str]
    required: Mapping[str, str]
    sizes: Mapping[str, Array] = field(default_factory=dict)

    def take(self, index: Any) -> "Branch":
        """Return some of the scenes by their indices among these."""
        sizes = {name: size[index] for name, size in self.sizes.items()}
        return replace(self, rows=self.rows[index], sizes=sizes)

    def adding(self, effect: Effect, given: Candidates) -> "Branch":
        """Return the scenes with an effect and those that are included with it."""
        along = given.along[effect.name]
        required = {**self.required, **dict.fromkeys(along - self.included, effect.name)}
        return replace(self, included=self.included | {effect.name} | along, required=required)


def joined(branches: Sequence[Branch]) -> Branch:
    """Return scenes with the same effects together, in the order of their indices."""
    first, rows = branches[0], np.concatenate([branch.rows for branch in branches])
    sizes = {name: np.concatenate([x.sizes[name] for x in branches]) for name in first.sizes}
    return replace(first, rows=rows, sizes=sizes).take(np.argsort(rows))


@dataclass(frozen=True)
class Decided:
    """The selection of some scenes.

    Attributes
    ----------
    law
        Law with the included effects of these scenes, perhaps among others.
    omitted, error
        The effects that the selection omitted, and the bound on the change by all of them [1].
    places
        Indices of the scenes among those of the law.
    """

    law: ContactLaw
    omitted: tuple[Effect, ...]
    error: Array
    places: Rows

    @cached_property
    def state(self) -> LargestContact:
        """The largest contacts by the law."""
        return state_of(self.law)

    @cached_property
    def by_paper(self) -> LargestContact:
        """The largest contacts by the paper's law."""
        return state_of(replace(self.law, effects=PAPER))

    def sizes(self, given: Candidates, branch: Branch, outputs: Sequence[str]) -> dict[str, Array]:
        """Return the sizes of all effects of these scenes, as in `Selection`."""
        sizes = dict(branch.sizes)
        for effect in given.present:
            if effect.name not in branch.included:
                state = self.by_paper if given.whole and effect.name not in PAPER else self.state
                sizes[effect.name] = errors_of(state, [effect], outputs).ravel()[self.places]
        return sizes


def select(
    model: Model, wanted: Mapping[str, Any], rtol: float, outputs: Sequence[str] = OUTPUTS
) -> Selection:
    """Include effects until the tolerance is met.

    Parameters
    ----------
    wanted
        "auto", True or False by effect; "auto" if missing.
    rtol
        Largest relative change of the outputs by the omitted effects [1].
    outputs
        The results that the tolerance applies to.

    Raises
    ------
    SceneError
        If the scene disables an effect that is required by an effect which it enables or must not
        omit; or if a key that an included effect needs is missing.
    """
    given = candidates_of(model, wanted)
    [(branch, decided)] = selections(given, model, np.array([rtol]), outputs)
    if isinstance(decided, SceneError):
        raise decided
    assert decided is not None  # any difference between two bounds decides
    sizes = decided.sizes(given, branch, outputs)
    return Selection(
        decided.by_paper if given.whole else decided.state,
        () if given.whole else decided.omitted,
        0.0 if given.whole else decided.error.item(),
        {name: size.item() for name, size in sizes.items()},
        given.choice, given.reasons, branch.required, given.blocked, branch.included,
    )  # fmt: skip


def selections(
    given: Candidates,
    model: Model,
    rtol: Array,
    outputs: Sequence[str],
    *,
    clear: float = 1.0,
    largest: float = math.inf,
    begun: Sequence[Branch] = (),
    stops: Callable[[ContactLaw], bool] = lambda _: False,
) -> Iterator[tuple[Branch, Decided | SceneError | None]]:
    """Select the effects of one scene, or of many to all of which the same effects apply.

    Parameters
    ----------
    given
        The effects before the selection.
    model
        Quantities of the scene, or of the scenes as columns.
    rtol
        Tolerance of each scene [1].
    outputs
        The results that the tolerance applies to.
    clear
        Least factor between a bound and the tolerance, and between two bounds, that decides.
    largest
        Largest bound with which effects are added [1].
    begun
        Scenes with effects that are certainly included; by default all, with those of `given`.
    stops
        Condition of a law to which no effect is added.

    Yields
    ------
    tuple
        Scenes with the same effects. Then their selection, or the error by
        which they are rejected, or None if they are not decided.
    """
    waiting: dict[frozenset[Any], list[Branch]] = {}

    def add(branch: Branch) -> None:
        waiting.setdefault(branch.included.union(branch.required.items()), []).append(branch)

    for branch in begun or [Branch(np.arange(len(rtol)), given.included, given.required)]:
        add(branch)
    while waiting:  # the fewest effects first, so that scenes with equal effects are together
        together = joined(waiting.pop(min(waiting, key=len)))
        for start in range(0, len(together.rows), TOGETHER):
            branch = together.take(slice(start, start + TOGETHER))
            count = len(branch.rows)
            part = model if count == len(rtol) else model.take(branch.rows)
            law, open_ = ContactLaw(part, branch.included), given.left(branch.included)
            try:  # before the largest contact, which may take much longer
                given.check(replace(law, model=part.take(0)))
            except SceneError as error:
                yield branch, error
                continue
            if stops(law):
                yield branch, None
                continue
            if not open_:
                yield branch, Decided(law, (), np.zeros(count), np.arange(count))
                continue
            state, limit = state_of(law), rtol[branch.rows]
            bound = errors_of(state, open_, outputs).ravel()
            # With plate inertia, half of the tolerance is left to omitted modes and branches.
            goal = 0.5 * limit if law.dynamic else limit
            candidates = [effect for effect in open_ if effect.name not in given.blocked]
            done = (clear * bound <= goal) | (not candidates)
            going_on = ~done & (bound > clear * goal) & (bound <= largest)
            if going_on.any():
                sizes = {e.name: sizes_of(state, e, outputs).ravel() for e in candidates}
                worst = np.where(going_on, _largest([*sizes.values()], clear), -1)
                branch, going_on = replace(branch, sizes={**branch.sizes, **sizes}), worst >= 0
                for number in sorted(set(worst[going_on].tolist())):
                    add(branch.take(worst == number).adding(candidates[number], given))
            lost = ~(done | going_on)
            if done.any():
                for row, refusal in _refusals(given, state, outputs, limit, clear).items():
                    if done[row] and refusal is not None:
                        yield branch.take([row]), refusal
                    lost[row] |= done[row] and refusal is None
                    done[row] = False
            if done.any():
                which = np.flatnonzero(done)
                decided = Decided(law, tuple(open_), bound[which], which)
                vars(decided)["state"] = state  # known already
                yield branch.take(which), decided
            if lost.any():
                yield branch.take(lost), None


def _largest(sizes: Sequence[Array], clear: float) -> Rows:
    """Return the number of the first largest size of each scene; -1 if rounding may decide.

    Sizes that are infinite or unknown are so whatever the rounding.
    """
    largest, *others = sizes
    worst: Rows = np.zeros(len(largest), dtype=np.intp)
    second = np.full(len(largest), -np.inf)
    for number, size in enumerate(others, 1):
        larger = size > largest
        second = np.fmax(second, np.where(larger, largest, size))
        worst, largest = np.where(larger, number, worst), np.where(larger, size, largest)
    known = np.isfinite(second) & np.isfinite(largest)
    close = known & (clear > 1.0) & (clear * second >= largest)
    return np.where(close, -1, worst)


def _refusals(
    given: Candidates, state: LargestContact, outputs: Sequence[str], rtol: Array, clear: float
) -> dict[int, SceneError | None]:
    """Return the scenes that must not omit an effect, each with the error; None if not clear."""
    refusals: dict[int, SceneError | None] = {}
    for effect in given.left(state.law.effects):
        if effect.name not in given.blocked:
            continue
        bound = errors_of(state, [effect], outputs).ravel()
        for row in np.flatnonzero(clear * bound > rtol).tolist():
            try:
                effect.check_omitted(
                    given.blocked[effect.name], bound[row].item(), rtol[row].item()
                )
            except SceneError as error:
                refusals.setdefault(row, error)
            if not bound[row] > clear * rtol[row]:
                refusals[row] = None
    return refusals
