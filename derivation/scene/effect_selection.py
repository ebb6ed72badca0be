"""Effect selection: the effects that a scene requires, by bounds on the change if omitted.

Starting from the effects that are always included, the effect with the largest bound is included
until the bound on all omitted effects together is within the tolerance. As S_1 grows with each
included effect and radii shrink, bounds are evaluated anew each time. The order does not depend on
the tolerance, so that a looser tolerance never includes more effects.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from derivation.engine.text import aligned, paragraph
from derivation.scene.effects import BY_NAME, EFFECTS
from derivation.scene.effects.effect import NO_BOUND, Effect
from derivation.scene.html import html_table
from derivation.scene.law import ContactLaw
from derivation.scene.model import Model
from derivation.scene.omission_bounds import LargestContact, error_of, price_of, size_of, state_of
from derivation.scene.scene import OUTPUTS, SceneError

HEADS = (
    "effect", "parameter", "parameter value", "max. change if omitted", "status", "reason",
)  # fmt: skip
"""Heads of the effects table."""


@dataclass(frozen=True)
class EffectRow:
    """An effect's line of the effects table.

    Attributes
    ----------
    name, adds
        The effect, and what it adds.
    parameter, parameter_value
        Its dimensionless parameter, and the value in this scene [1]; NaN if it does not apply.
    bound
        Relative change of the results, the worst of them, if it is left out [1]; infinite
        where no bound is shown.
    included
        Whether it is computed.
    reason
        The reason.
    disabled
        Whether the scene disables it.
    """

    name: str
    adds: str
    parameter: str
    parameter_value: float
    bound: float
    included: bool
    reason: str
    disabled: bool = False

    def to_json(self) -> dict[str, Any]:
        """The row under fixed keys; null where there is no value or no bound."""
        return {
            name: None if isinstance(value, float) and not math.isfinite(value) else value
            for name, value in vars(self).items()
        }

    def cells(self) -> tuple[str, str, str, str, str, str]:
        """The row as it is shown."""
        unknown = math.isnan(self.parameter_value)
        value = "n/a" if unknown else f"{self.parameter_value:.3g}"
        bound = f"{self.bound:.1e}" if self.bound < NO_BOUND else "no bound"
        status = "included" if self.included else "omitted"
        if unknown and not self.bound:  # the effect does not apply
            bound = status = "n/a"
        return self.name, self.parameter, value, bound, status, self.reason


@dataclass(frozen=True)
class SelectedEffects:
    """The effects of a simulation: its contact law and the effects table.

    Attributes
    ----------
    law
        The contact law of the effects included.
    rtol
        The tolerance of the selection [1].
    error
        Bound on the change of the outputs, the worst of them, by all effects that the selection
        omitted together [1].
    rows
        The effects table.
    outputs
        The results that the tolerance and the bounds apply to.
    """

    law: ContactLaw
    rtol: float
    error: float
    rows: tuple[EffectRow, ...]
    outputs: tuple[str, ...] = OUTPUTS

    @property
    def forced_out(self) -> tuple[str, ...]:
        """Effects that apply and that the scene switches off."""
        return tuple(row.name for row in self.rows if row.disabled)

    @property
    def edge_disabled(self) -> bool:
        """Whether the scene has another edge than the paper's and switches its effect off."""
        return any(BY_NAME[name].other_edge for name in self.forced_out)

    @property
    def included(self) -> tuple[str, ...]:
        """Names of the effects included, in the order of the table."""
        return tuple(row.name for row in self.rows if row.included)

    @property
    def summary(self) -> str:
        """The effects included, and what the omitted ones may change."""
        omitted = any(row.bound and not (row.included or row.disabled) for row in self.rows)
        others = f"; the omitted ones change the results by at most {self.error:.1e}"
        return ", ".join(self.included) + (others if omitted else "")

    def lines(self) -> list[tuple[str, str, str, str, str, str]]:
        """The rows as they are shown, under `HEADS`."""
        return [row.cells() for row in self.rows]

    def to_text(self, run_times: Mapping[str, str] | None = None) -> str:
        """The effects table for a screen, with parameters and reasons in lines below it.

        Parameters
        ----------
        run_times
            Run times by effect, as they are shown; without them the table has none.
        """
        heads = ["effect", "#parameter value", "#change if omitted", "status"]
        cells = [[name, *known] for name, _, *known, _ in self.lines()]
        if run_times is not None:
            heads.append("#run time")
            cells = [[*row, run_times.get(row[0], "n/a")] for row in cells]
        parameters = _grouped((row.name, row.parameter) for row in self.rows)
        reasons = _grouped((row.name, row.reason) for row in self.rows)
        return "\n".join(
            [aligned(heads, cells), "", "Parameters:", *parameters, "", "Reasons:", *reasons]
        )

    def to_html(self) -> str:
        """The effects table for a notebook."""
        return html_table(HEADS, self.lines())

    _repr_html_ = to_html


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


def decide(
    model: Model,
    wanted: Mapping[str, Any],
    rtol: float,
    outputs: Sequence[str] = OUTPUTS,
    default: bool = False,
) -> SelectedEffects:
    """Include effects until the tolerance is met, and say why.

    Parameters
    ----------
    wanted
        "auto", True or False by effect; "auto" if left out.
    rtol
        What the effects omitted may change at most, relative [1].
    outputs
        The results it applies to.
    default
        Whether nobody gave the tolerance.

    Raises
    ------
    SceneError
        As `select` does; or if an effect lacks what it takes to compute it.
    """
    found = select(model, wanted, rtol, outputs)
    law = found.state.law
    for effect in law.chosen:
        effect.check(law, found.choice[effect.name] is True)
    tolerance = f"{'the default selection tolerance' if default else 'rtol ='} {rtol:.3g}"
    rows = [_row(effect, found, tolerance, outputs) for effect in EFFECTS]
    return SelectedEffects(law, rtol, found.error, tuple(rows), tuple(outputs))


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
    sizes: dict[str, float] = {}
    while True:
        state = state_of(ContactLaw(model, frozenset(included)))
        error = error_of(state, open_, outputs)
        candidates = [effect for effect in open_ if effect.name not in blocked]
        # With plate inertia, half of the tolerance is left to omitted modes and branches.
        if error <= (0.5 * rtol if state.law.dynamic else rtol) or not candidates:
            break
        sizes |= {effect.name: size_of(state, effect, outputs) for effect in candidates}
        worst = max(candidates, key=lambda effect: sizes[effect.name])
        required |= dict.fromkeys(along[worst.name] - included, worst.name)
        included |= {worst.name} | along[worst.name]
        open_ = [effect for effect in open_ if effect.name not in included]
    for effect in open_:
        if effect.name in blocked:
            part = blocked[effect.name]
            effect.check_omitted(part, error_of(state, [effect], outputs), rtol)
    left = (effect for effect in present if effect.name not in included)
    sizes |= {effect.name: error_of(state, [effect], outputs) for effect in left}
    return Selection(state, error, sizes, choice, reasons, required, blocked)


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


def _grouped(told: Iterable[tuple[str, str]]) -> list[str]:
    """Paragraphs that say the same of several effects at once."""
    names: dict[str, list[str]] = {}
    for name, text in told:
        names.setdefault(text, []).append(name)
    return [paragraph(f"  {', '.join(found)}: {text}", 4) for text, found in names.items()]


def _row(
    effect: Effect,
    found: Selection,
    tolerance: str,
    outputs: Sequence[str],
) -> EffectRow:
    """The effect's line, at the largest radius of the law decided on."""
    state, choice, reasons, error = found.state, found.choice, found.reasons, found.error
    model, name = state.law.model, effect.name
    radius = state.law.limit if math.isnan(state.a) else state.a
    included = name in state.law.effects or not effect.selectable
    if reasons[name]:
        return EffectRow(name, effect.adds, effect.parameter, math.nan, 0.0, False, reasons[name])
    value = effect.value(model, radius)
    bound = price_of(state, effect, outputs) if included else error_of(state, [effect], outputs)
    if effect.always_included:
        why = "always"
    elif choice[name] != "auto":
        worst = max(outputs, key=lambda output: error_of(state, [effect], [output]))
        why = _forced(bool(choice[name]), bound, worst)
    elif name in found.required:
        why = f"required by {found.required[name]}"
    elif name in found.blocked:
        why = f"cannot be included: {found.blocked[name]} is disabled in the scene"
    elif included:
        why = f"omitted it could exceed {tolerance}"
    else:
        why = f"all omitted effects together change the results by at most {error:.1e}"
    disabled = choice[name] is False and effect.selectable
    return EffectRow(name, effect.adds, effect.parameter, value, bound, included, why, disabled)


def _forced(included: bool, bound: float, output: str) -> str:
    """What the scene's own choice means, and in which result most."""
    if included:
        return "true in the scene"
    if bound < NO_BOUND:
        return f"disabled in the scene: changes {output} by at most {100 * bound:.2g} %"
    return "disabled in the scene: no bound available"
