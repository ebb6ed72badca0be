"""Selection: which effects are included, by bounds on the change if they are omitted.

Starting from the effects that are always included, the effect with the largest bound is included
until the bound on all omitted effects together is within the tolerance. As S_1 grows with each
included effect and radii shrink, bounds are evaluated anew each time. The order does not depend on
the tolerance, so that a looser tolerance never includes more effects.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from derivation.scene.effects import EFFECTS
from derivation.scene.effects.effect import Effect
from derivation.scene.law import ContactLaw
from derivation.scene.model import Model
from derivation.scene.omission_bounds import LargestContact, error_of, size_of, state_of
from derivation.scene.scene import OUTPUTS, SceneError


@dataclass(frozen=True)
class Selection:
    """Which effects are included, before anything is said about them.

    Attributes
    ----------
    state
        The law of the effects included, at its largest radius.
    error
        Bound on what the effects omitted by the selection change together [1].
    sizes
        Of every effect that applies, how much it matters: where it was included how much it
        did then, else what omitting it alone changes at most [1].
    choice
        "auto", True or False of every effect that applies.
    reasons
        Why an effect does not apply; empty if it does.
    required
        Of effects included only because another one needs them, the name of that one.
    blocked
        Of effects that cannot be included, the part of them that the scene disables.
    """

    state: LargestContact
    error: float
    sizes: Mapping[str, float]
    choice: Mapping[str, Any]
    reasons: Mapping[str, str]
    required: Mapping[str, str]
    blocked: Mapping[str, str]

    @property
    def included(self) -> frozenset[str]:
        """Names of the effects included."""
        return self.state.law.effects


@dataclass(frozen=True)
class Candidates:
    """What a scene leaves to the selection, and what it decides itself.

    Attributes
    ----------
    model
        The scene's numbers.
    present
        The effects that apply and may be included.
    along
        Of every effect, the names of those that come in with it.
    included, required
        Names of the effects that are included from the start, and of those among them that only
        come in with another the name of that one.
    open_
        The effects that the selection decides on.
    choice, reasons, blocked
        As of `Selection`.
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

    def left(self, included: frozenset[str]) -> list[Effect]:
        """Effects that the selection decides on, less those included."""
        return [effect for effect in self.open_ if effect.name not in included]


def candidates_of(model: Model, wanted: Mapping[str, Any]) -> Candidates:
    """What the selection may include.

    Parameters
    ----------
    wanted
        "auto", True or False by effect; "auto" if left out.

    Raises
    ------
    SceneError
        If the scene includes an effect and disables a part of it.
    """
    without = {e.name: f"effects.{e.within} = false" for e in EFFECTS if _disabled(e, wanted)}
    asked = {e.name for e in EFFECTS if not e.selectable and wanted.get(e.name) is True}
    reasons = {e.name: "" if e.name in asked else e.not_applicable_reason(model) for e in EFFECTS}
    reasons = {name: reason or without.get(name, "") for name, reason in reasons.items()}
    blocked = _blocked(wanted)
    present = [effect for effect in EFFECTS if not reasons[effect.name]]
    choice = {effect.name: wanted.get(effect.name, "auto") for effect in present}
    present = [effect for effect in present if effect.selectable]
    free = {effect.name for effect in present if choice[effect.name] is not False}
    # What comes in with an effect costs nothing there; of pressure the bounds are Hertz's.
    along = {effect.name: effect.contains & free for effect in EFFECTS}
    included = {e.name for e in present if e.always_included or choice[e.name] is True}
    required: dict[str, str] = {}
    for name in sorted(included):
        required |= dict.fromkeys(along[name] - included, name)
        included |= along[name]
    open_ = [e for e in present if e.name not in included and choice[e.name] is not False]
    return Candidates(
        model, tuple(present), along, frozenset(included), required, tuple(open_), choice, reasons,
        blocked,
    )  # fmt: skip


def select(
    model: Model, wanted: Mapping[str, Any], rtol: float, outputs: Sequence[str] = OUTPUTS
) -> Selection:
    """Include effects until the tolerance is met.

    Parameters
    ----------
    wanted
        "auto", True or False by effect; "auto" if left out.
    rtol
        What the effects left out may change at most, relative [1].
    outputs
        The results it applies to.

    Raises
    ------
    SceneError
        If the scene includes an effect and disables a part of it, or disables a part of one that
        it must not omit.
    """
    given = candidates_of(model, wanted)
    included, required, blocked = given.included, dict(given.required), given.blocked
    sizes: dict[str, float] = {}
    while True:
        open_ = given.left(included)
        state = state_of(ContactLaw(given.model, included))
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
    left = (effect for effect in given.present if effect.name not in included)
    sizes |= {effect.name: error_of(state, [effect], outputs) for effect in left}
    return Selection(state, error, sizes, given.choice, given.reasons, required, blocked)


def _disabled(effect: Effect, wanted: Mapping[str, Any]) -> bool:
    """Whether a scene disables what an effect is a part of, and does not ask for the effect."""
    parted = bool(effect.within) and wanted.get(effect.within) is False
    return parted and wanted.get(effect.name) is not True


def _blocked(wanted: Mapping[str, Any]) -> Mapping[str, str]:
    """Effects that cannot be included, each with a part of it that the scene disables.

    Raises
    ------
    SceneError
        If the scene asks for one of them.
    """
    found = dict[str, str]()
    for effect in EFFECTS:
        name = effect.name
        without = sorted(part for part in effect.requires if wanted.get(part) is False)
        if without and wanted.get(name) is True:
            raise SceneError(
                f"effects.{name}: expected effects.{without[0]} to be included with it, got "
                f"effects.{without[0]} = false; leave out effects.{without[0]} or effects.{name}"
            )
        if without:
            found[name] = without[0]
    return found
