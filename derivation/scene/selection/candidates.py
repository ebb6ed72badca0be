"""The effects of a scene before the selection: which of them apply, may be and must be included."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.effects import EFFECTS, PAPER
from derivation.scene.effects.effect import Effect
from derivation.scene.errors import SceneError
from derivation.scene.input.table import in_words
from derivation.scene.model import Model
from derivation.scene.scene import Scene


@dataclass(frozen=True)
class Candidates:
    """The effects of a scene before the selection.

    Attributes
    ----------
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
        tuple(present), along, frozenset(included), required, tuple(open_), choice, reasons,
        blocked, whole=free | included == PAPER,
    )  # fmt: skip


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
