"""Effects table: the effects that a scene requires, as `selection` finds them, and the reasons."""

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
from derivation.scene.omission_bounds import error_of, price_of
from derivation.scene.scene import OUTPUTS
from derivation.scene.selection import Selection, select

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
    radius = state.law.limit if math.isnan(state.a) else float(state.a)
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
