"""The effects table: the effects selected for a scene, with parameters, bounds and reasons."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from operator import itemgetter
from typing import Any

from derivation.engine.text import aligned, paragraph
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.effects import BY_NAME, EFFECTS
from derivation.scene.effects.effect import NO_BOUND, Effect, Results
from derivation.scene.model import Model
from derivation.scene.output.html import html_table
from derivation.scene.quantity import percent, rounded_up, upwards
from derivation.scene.scene import OUTPUTS
from derivation.scene.selection.omission_bounds import (
    each_change_of,
    each_error_of,
    error_of,
)
from derivation.scene.selection.selection import Selection, select

HEADS = (
    "effect", "parameter", "parameter value", "max. change if omitted", "status", "reason",
)  # fmt: skip
"""Column heads of the effects table."""


SYMBOLS = (
    "a contact radius; R radius, m mass and v0 impact speed of the sphere; b radius, H = 2 h "
    "thickness, rho density and D bending stiffness of the plate; E Young's modulus, nu Poisson's "
    "ratio, E* contact modulus, A_v retardation time; K = (4/3) E* sqrt(R), "
    "That = (m^2/(K^2 v0))^(1/5); 1 + c_1 a/h indentation over a^2/R in a small contact; g gravity"
)
"""Symbols of the parameters."""


NO_GROWTH: Results = (1.0, 1.0, 1.0, 1.0, 1.0)
"""Factors on the bounds on each result that a simulated impact does not increase [1]."""


@dataclass(frozen=True)
class EffectRow:
    """A row of the effects table.

    Attributes
    ----------
    name, adds
        Name of the effect, and its contribution to the model.
    parameter, parameter_value
        Its dimensionless parameter, and the value in this scene [1]; NaN if it does not apply.
    bound
        Bound on the largest relative change of a result if the effect is omitted, with the effects
        that are a part of it [1]; infinite if there is no bound.
    included
        Whether the effect is included.
    reason
        Why it is included or omitted.
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
        """Return the row under fixed keys; null for no value and for no bound."""
        return {
            name: None if isinstance(value, float) and not math.isfinite(value) else value
            for name, value in vars(self).items()
        }

    def cells(self) -> tuple[str, str, str, str, str, str]:
        """Return the cells of the row."""
        unknown = math.isnan(self.parameter_value)
        value = "n/a" if unknown else f"{self.parameter_value:.3g}"
        bound = rounded_up(self.bound) if self.bound < NO_BOUND else "no bound"
        status = "included" if self.included else "omitted"
        if unknown and not self.bound:  # the effect does not apply
            bound = status = "n/a"
        return self.name, self.parameter, value, bound, status, self.reason


@dataclass(frozen=True)
class SelectedEffects:
    """The effects of a simulation: contact law and effects table.

    Attributes
    ----------
    law
        The contact law with the included effects.
    rtol
        The tolerance of the selection [1].
    error
        Bound on the largest relative change of an output if all effects omitted by the selection
        were included together [1].
    rows
        The effects table.
    outputs
        The results that the tolerance and the bounds apply to.
    growth
        Factors by which the simulated impact increased the bounds on each result [1].
    """

    law: ContactLaw
    rtol: float
    error: float
    rows: tuple[EffectRow, ...]
    outputs: tuple[str, ...] = OUTPUTS
    growth: Results = NO_GROWTH
    _selection: Selection | None = field(default=None, repr=False, compare=False)
    _tolerance: str = field(default="", repr=False, compare=False)

    def grown(self, growth: Results) -> "SelectedEffects":
        """Return the effects with a table whose bounds on each result are multiplied by factors."""
        if growth == NO_GROWTH or self._selection is None:
            return self
        return _selected(self._selection, self.rtol, self.outputs, self._tolerance, growth)

    def omitted_at(self, rtol: float) -> float:
        """Return the bound on the change by the effects omitted with another tolerance [1]."""
        if self._selection is None:
            return self.error
        return select(self.law.model, self._selection.choice, rtol, self.outputs).error

    def on(self, outputs: tuple[str, ...]) -> "SelectedEffects":
        """Return the same effects with the bound on the change of other outputs."""
        if self._selection is None:
            return replace(self, outputs=outputs)
        error = error_of(self._selection.state, self._selection.omitted, outputs)
        return replace(self, outputs=outputs, error=error)

    @property
    def stated_error(self) -> float:
        """Bound on the change by all effects omitted by the selection, after the simulation [1]."""
        return largest_growth(self.growth, self.outputs) * self.error

    @property
    def forced_out(self) -> tuple[str, ...]:
        """Names of applicable effects that the scene disables."""
        return tuple(row.name for row in self.rows if row.disabled)

    @property
    def edge_disabled(self) -> bool:
        """Whether the edge differs from the paper's and the scene disables that effect."""
        return any(BY_NAME[name].other_edge for name in self.forced_out)

    @property
    def included(self) -> tuple[str, ...]:
        """Names of the included effects, in the order of the table."""
        return tuple(row.name for row in self.rows if row.included)

    @property
    def omits(self) -> bool:
        """Whether the selection omitted an applicable effect."""
        return any(row.bound and not (row.included or row.disabled) for row in self.rows)

    @property
    def summary(self) -> str:
        """The included effects, and the bound on the change by the omitted ones."""
        changed = f"{named(self.outputs, 'the results')} by at most {rounded_up(self.stated_error)}"
        omitted = f"; the omitted effects change {changed}" if self.omits else ""
        return ", ".join(self.included) + omitted

    def lines(self) -> list[tuple[str, str, str, str, str, str]]:
        """Return the cells of all rows, under `HEADS`."""
        return [row.cells() for row in self.rows]

    def to_text(self, run_times: Mapping[str, str] | None = None) -> str:
        """Return the effects table as text, with parameters and reasons below it.

        Parameters
        ----------
        run_times
            Run times by effect, as text; by default the table has no run times.
        """
        heads = ["effect", "#parameter value", "#change if omitted", "status"]
        cells = [[name, *known] for name, _, *known, _ in self.lines()]
        if run_times is not None:
            heads.append("#run time")
            cells = [[*row, run_times.get(row[0], "n/a")] for row in cells]
        adds = [paragraph(f"  {row.name}: {row.adds}; {row.parameter}", 4) for row in self.rows]
        reasons = _grouped((row.name, row.reason) for row in self.rows)
        legend = ["Effects and their dimensionless parameters:", *adds]
        symbols = paragraph(f"Symbols: {SYMBOLS}", 2)
        parts = [aligned(heads, cells), "", *legend, "", symbols, "", "Reasons:", *reasons]
        return "\n".join(parts)

    def to_html(self) -> str:
        """Return the effects table for a notebook."""
        return html_table(HEADS, self.lines())

    _repr_html_ = to_html


def named(outputs: Sequence[str], all_of_them: str) -> str:
    """Return some outputs in words, with other words for all of them."""
    if tuple(outputs) == OUTPUTS:
        return all_of_them
    names = [name.replace("_", " ") for name in outputs]
    return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))


def largest_growth(growth: Results, outputs: Sequence[str]) -> float:
    """Return the largest factor of some outputs [1]."""
    return max(growth[OUTPUTS.index(name)] for name in outputs)


def decide(
    model: Model,
    wanted: Mapping[str, Any],
    rtol: float,
    outputs: Sequence[str] = OUTPUTS,
    default: bool = False,
    growth: float = 1.0,
) -> SelectedEffects:
    """Include effects until the tolerance is met, and make the effects table.

    Parameters
    ----------
    model
        The quantities of the scene.
    wanted
        "auto", True or False by effect; "auto" if missing.
    rtol
        Largest relative change of the outputs by the omitted effects [1].
    outputs
        The results that the tolerance applies to.
    default
        Whether the tolerance is the default one.
    growth
        Factor by which the simulation is expected to increase the bounds [1].

    Raises
    ------
    SceneError
        As `select` does.
    """
    selection = select(model, wanted, rtol / growth, outputs)
    tolerance = f"{'the default selection' if default else 'the'} tolerance {rtol:.3g}"
    return _selected(selection, rtol, tuple(outputs), tolerance, NO_GROWTH)


def _selected(
    selection: Selection, rtol: float, outputs: tuple[str, ...], tolerance: str, growth: Results
) -> SelectedEffects:
    """Return the selected effects with their table, for factors on the bounds on each result."""
    rows = tuple(_row(effect, selection, tolerance, outputs, growth) for effect in EFFECTS)
    law, error = selection.state.law, selection.error
    return SelectedEffects(law, rtol, error, rows, outputs, growth, selection, tolerance)


def _grouped(texts: Iterable[tuple[str, str]]) -> list[str]:
    """Return a paragraph for each text, preceded by the names of its effects."""
    names: dict[str, list[str]] = {}
    for name, text in texts:
        names.setdefault(text, []).append(name)
    return [paragraph(f"  {', '.join(group)}: {text}", 4) for text, group in names.items()]


def _row(
    effect: Effect,
    selection: Selection,
    tolerance: str,
    outputs: Sequence[str],
    growth: Results,
) -> EffectRow:
    """Return the row of an effect, at the largest contact radius of the selected law."""
    state, choice, reasons, error = (
        selection.state,
        selection.choice,
        selection.reasons,
        selection.error,
    )
    model, name = state.law.model, effect.name
    radius = state.law.limit if math.isnan(state.a) else float(state.a)
    included = name in state.law.effects or not effect.selectable
    if reasons[name]:
        return EffectRow(name, effect.adds, effect.parameter, math.nan, 0.0, False, reasons[name])
    value, omitted = effect.value(model, radius), [effect, *_parts(effect, selection)]
    changes = (each_change_of if included else each_error_of)(state, omitted)[:, 0].tolist()
    grown = [factor * change for factor, change in zip(growth, changes, strict=True)]
    bound, worst = max(((grown[OUTPUTS.index(name)], name) for name in outputs), key=itemgetter(0))
    if effect.always_included:
        why = "always included"
    elif choice[name] != "auto":
        why = _forced(bool(choice[name]), bound, worst)
    elif name in selection.required:
        why = f"required by {selection.required[name]}"
    elif name in selection.blocked:
        why = f"cannot be included, because the scene disables {selection.blocked[name]}"
    elif included and name not in selection.needed:
        why = f"not needed to meet {tolerance}, but takes no extra time"
    elif included:
        why = effect.cause or f"needed to meet {tolerance}"
    else:
        most = largest_growth(growth, outputs) * error
        changed = named(outputs, "the results")
        why = f"all omitted effects together change {changed} by at most {rounded_up(most)}"
    disabled = choice[name] is False and effect.selectable
    return EffectRow(name, effect.adds, effect.parameter, value, bound, included, why, disabled)


def _parts(effect: Effect, selection: Selection) -> list[Effect]:
    """Return the effects that are omitted with another one, because they are a part of it.

    A part that the scene disables has its own bound, unless the scene disables the whole effect.
    """
    model, choice = selection.state.law.model, selection.choice
    disabled = choice[effect.name] is False
    return [
        part
        for part in EFFECTS
        if part.within == effect.name
        and not part.not_applicable_reason(model)
        and (disabled or choice[part.name] is not False)
    ]


def _forced(included: bool, bound: float, output: str) -> str:
    """Return the reason for a choice of the scene, with the result that changes most."""
    if included:
        return "enabled in the scene"
    if bound < NO_BOUND:
        return f"disabled in the scene: changes {output} by at most {percent(upwards(bound, 2))}"
    return "disabled in the scene: no bound available"
