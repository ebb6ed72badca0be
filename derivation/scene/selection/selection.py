"""Effect selection by bounds on the change of the results if an effect is omitted.

The selection starts with the effects that are always included. It includes the effect with the
largest bound until the bound on all omitted effects together is within the tolerance. Each included
effect changes S_1 and the largest radius, so that the bounds are evaluated again each time. The
order does not depend on the tolerance; a larger tolerance therefore never includes more effects.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.effects import EFFECTS, PAPER
from derivation.scene.effects.effect import Effect
from derivation.scene.errors import SceneError
from derivation.scene.input.table import in_words
from derivation.scene.model import Model
from derivation.scene.scene import OUTPUTS, Scene
from derivation.scene.selection.omission_bounds import LargestContact, error_of, size_of, state_of


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
class Candidates:
    """The effects of a scene before the selection.

    Attributes
    ----------
    model
        The quantities of the scene.
    present
        The effects that apply and may be included.
    along
        For each effect, the names of the effects that are included with it.
    included, required
        Names of the effects that are included from the start; and for those that are included only
        with another effect, the name of that one.
    open_
        The effects that the selection decides on.
    choice, reasons, blocked
        As in `Selection`.
    whole
        Whether the scene allows just the effects of the paper's law. All are included, because
        the function of this law is faster than a selection.
    """

    model: Model
    present: tuple[Effect, ...]
    along: Mapping[str, frozenset[str]]
    included: frozenset[str]
    required: Mapping[str, str]
    open_: tuple[Effect, ...]
    choice: Mapping[str, Any]
    reasons: Mapping[str, str]
    blocked: Mapping[str, str]
    whole: bool

    def left(self, included: frozenset[str]) -> list[Effect]:
        """Return the effects that the selection decides on and that are not yet included."""
        return [effect for effect in self.open_ if effect.name not in included]

    def check(self, law: ContactLaw) -> None:
        """Raise an error if a key that an included effect needs is missing."""
        for effect in law.chosen:
            effect.check(law, self.choice[effect.name] is True)


def check_enabled(scene: Scene, model: Model) -> None:
    """Reject a scene that enables an effect without the key that this effect needs.

    Raises
    ------
    SceneError
        With all such effects; a key with a value that changes nothing, such as 0, is accepted.
    """
    wanted = scene.effects.model_dump()
    without_key = [
        effect
        for effect in EFFECTS
        if effect.selectable
        and wanted.get(effect.name) is True
        and effect.not_applicable_reason(model)
        and not effect.without_change(scene)
    ]
    if without_key:
        raise SceneError(in_words([partial(_without_key, effect, model) for effect in without_key]))


def _without_key(effect: Effect, model: Model) -> str:
    """Return the message that an enabled effect does not apply, with its remedy."""
    return (
        f"effects.{effect.name} = true does not apply: {effect.not_applicable_reason(model)}; "
        f"{effect.remedy}, or remove effects.{effect.name}"
    )


def candidates_of(model: Model, wanted: Mapping[str, Any]) -> Candidates:
    """Return the effects that the selection may include.

    Parameters
    ----------
    model
        The quantities of the scene.
    wanted
        "auto", True or False by effect; "auto" if missing.

    Raises
    ------
    SceneError
        If the scene enables an effect and disables an effect that it requires.
    """
    without = {e.name: f"effects.{e.within} = false" for e in EFFECTS if _disabled(e, wanted)}
    requested = {e.name for e in EFFECTS if not e.selectable and wanted.get(e.name) is True}
    reasons = {
        e.name: "" if e.name in requested else e.not_applicable_reason(model) for e in EFFECTS
    }
    reasons = {name: reason or without.get(name, "") for name, reason in reasons.items()}
    blocked = _blocked(wanted)
    present = [effect for effect in EFFECTS if not reasons[effect.name]]
    choice = {effect.name: wanted.get(effect.name, "auto") for effect in present}
    present = [effect for effect in present if effect.selectable]
    free = {effect.name for effect in present if choice[effect.name] is not False}
    # Effects included with another one take no extra time; bounds assume Hertz's pressure.
    along = {effect.name: effect.contains & free for effect in EFFECTS}
    included = {e.name for e in present if e.always_included or choice[e.name] is True}
    required: dict[str, str] = {}
    for name in sorted(included):
        required |= dict.fromkeys(along[name] - included, name)
        included |= along[name]
    open_ = [e for e in present if e.name not in included and choice[e.name] is not False]
    return Candidates(
        model, tuple(present), along, frozenset(included), required, tuple(open_), choice, reasons,
        blocked, whole=free | included == PAPER,
    )  # fmt: skip


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
    included, required, blocked = given.included, dict(given.required), given.blocked
    sizes: dict[str, float] = {}
    while True:
        open_, law = given.left(included), ContactLaw(given.model, included)
        given.check(law)  # first, because the largest contact may take much longer
        state = state_of(law)
        error = error_of(state, open_, outputs)
        candidates = [effect for effect in open_ if effect.name not in blocked]
        # With plate inertia, half of the tolerance is left to omitted modes and branches.
        if error <= (0.5 * rtol if state.law.dynamic else rtol) or not candidates:
            break
        sizes |= {effect.name: size_of(state, effect, outputs) for effect in candidates}
        worst = max(candidates, key=lambda effect: sizes[effect.name])
        required |= dict.fromkeys(given.along[worst.name] - included, worst.name)
        included |= {worst.name} | given.along[worst.name]
    for effect in open_:
        if effect.name in blocked:
            part = blocked[effect.name]
            effect.check_omitted(part, error_of(state, [effect], outputs), rtol)
    sizes |= _sizes_of_others(given, state, outputs)
    if given.whole:
        state, open_, error = state_of(ContactLaw(given.model, PAPER)), [], 0.0
        sizes |= _sizes_of_others(given, state, outputs)
    return Selection(
        state, tuple(open_), error, sizes, given.choice, given.reasons, required, blocked, included
    )


def _sizes_of_others(
    given: Candidates, state: LargestContact, outputs: Sequence[str]
) -> dict[str, float]:
    """Return the bounds on the change if effects that are not included are omitted, by name [1]."""
    others = (effect for effect in given.present if effect.name not in state.law.effects)
    return {effect.name: error_of(state, [effect], outputs) for effect in others}


def _disabled(effect: Effect, wanted: Mapping[str, Any]) -> bool:
    """Return whether the scene disables the effect that this one is a part of."""
    parted = bool(effect.within) and wanted.get(effect.within) is False
    return parted and wanted.get(effect.name) is not True


def _blocked(wanted: Mapping[str, Any]) -> Mapping[str, str]:
    """Return the effects that cannot be included, each with the disabled effect it requires.

    Raises
    ------
    SceneError
        If the scene enables one of them.
    """
    reasons = dict[str, str]()
    for effect in EFFECTS:
        name = effect.name
        without = sorted(part for part in effect.requires if wanted.get(part) is False)
        if without and wanted.get(name) is True:
            raise SceneError(
                f"effects.{name} = true requires effects.{without[0]}, got effects.{without[0]} = "
                f"false; remove effects.{without[0]} or effects.{name}"
            )
        if without:
            reasons[name] = without[0]
    return reasons
