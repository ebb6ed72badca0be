"""The gate: which effects a scene calls for, by bounds of what leaving them out changes.

Begun with what is always in, the effect with the largest bound is taken in until the bounds
of all that is left out, together, stay within the tolerance. As S_1 grows with each effect
taken in and radii shrink, bounds are taken anew each time. The order does not depend on the
tolerance, so that a looser one never takes in more.
"""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from derivation.scene.effects import EFFECTS
from derivation.scene.effects.effect import Effect
from derivation.scene.html import html_table
from derivation.scene.law import WHOLE_PLATE, Law
from derivation.scene.left_out import MOVED_WITH, State, error_of, price_of, size_of, state_of
from derivation.scene.model import Model
from derivation.scene.scene import OUTPUTS, SceneError

SOLVED_WITH = WHOLE_PLATE | {"curvature", "sphere_elasticity"}
"""Effects that the true pressure's equation holds in itself."""
WHOLES = {"pressure": SOLVED_WITH, "inertia": MOVED_WITH}
"""Effects that hold the whole plate, and what comes in with them."""
SAYS_NOTHING = 10.0
"""A bound so far above what it bounds is shown as none."""
FORCED_OUT = "false in the scene"
HEADS = ("effect", "number", "value", "if left out", "", "why")
"""Heads of the effects table."""


@dataclass(frozen=True)
class Row:
    """An effect's line of the effects table.

    Attributes
    ----------
    name, adds
        The effect, and what it adds.
    number, value
        Its dimensionless number: what it is, and how large here [1].
    bound
        Relative change of the results, the worst of them, if it is left out [1]; infinite
        where no bound is shown.
    included
        Whether it is computed.
    why
        The reason.
    """

    name: str
    adds: str
    number: str
    value: float
    bound: float
    included: bool
    why: str

    def to_json(self) -> dict[str, Any]:
        """The row under fixed keys; a number or bound that there is not is null."""
        return {
            name: None if isinstance(value, float) and not math.isfinite(value) else value
            for name, value in vars(self).items()
        }

    def cells(self) -> tuple[str, str, str, str, str, str]:
        """The row as it is shown."""
        applies = not math.isnan(self.value)
        value = f"{self.value:.3g}" if applies else "-"
        bound = f"{self.bound:.1e}" if self.bound < SAYS_NOTHING else "none"
        decided = "in" if self.included else "out"
        return self.name, self.number, value, bound if applies else "-", decided, self.why


@dataclass(frozen=True)
class Gate:
    """What the gate decided.

    Attributes
    ----------
    law
        The contact law of the effects included.
    rtol
        The tolerance it was decided for [1].
    error
        Bound of what the effects left out by the gate change together, the worst of the
        outputs [1].
    rows
        The effects table.
    outputs
        The results that the tolerance and the bounds apply to.
    """

    law: Law
    rtol: float
    error: float
    rows: tuple[Row, ...]
    outputs: tuple[str, ...] = OUTPUTS

    @property
    def forced_out(self) -> tuple[str, ...]:
        """Effects that the scene has and leaves out by itself."""
        return tuple(row.name for row in self.rows if row.why.startswith(FORCED_OUT))

    def lines(self) -> list[tuple[str, str, str, str, str, str]]:
        """Effect, number, value, bound, in or out, and why, to be read by people."""
        return [row.cells() for row in self.rows]

    def to_html(self) -> str:
        """The effects table for a notebook."""
        return html_table(HEADS, self.lines())

    _repr_html_ = to_html


def decide(
    model: Model, wanted: Mapping[str, Any], rtol: float, outputs: Sequence[str] = OUTPUTS
) -> Gate:
    """Take in effects until the tolerance is met.

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
        If the pressure is to be solved for, or the plate to move, without a part of it; or if
        it has to move and its density is not known.
    """
    asked = {e.name for e in EFFECTS if not e.by_itself and wanted.get(e.name) is True}
    reasons = {e.name: "" if e.name in asked else e.absent(model) for e in EFFECTS}
    missing = sorted(name for name in WHOLE_PLATE if wanted.get(name) is False)
    for name in WHOLES if missing else ():
        if wanted.get(name) is True:
            raise SceneError(
                f"effects.{name}: expected true with the whole plate only, got {missing[0]} = "
                f"false; leave out effects.{missing[0]} or effects.{name}"
            )
        reasons[name] = f"it holds the whole plate, but {', '.join(missing)} is false"
    present = [effect for effect in EFFECTS if not reasons[effect.name]]
    choice = {effect.name: wanted.get(effect.name, "auto") for effect in present}
    present = [effect for effect in present if effect.by_itself]
    free = {effect.name for effect in present if choice[effect.name] is not False}
    # What comes in with an effect costs nothing there; of pressure the bounds are Hertz's.
    along = {name: with_it & free for name, with_it in WHOLES.items()}
    included = {e.name for e in present if e.forced or choice[e.name] is True}
    included.update(*(along[name] for name in included & WHOLES.keys()))
    open_ = [e for e in present if e.name not in included and choice[e.name] is not False]
    while True:
        state = state_of(Law(model, frozenset(included)))
        error = error_of(state, open_, outputs)
        # A plate that moves leaves modes and branches out too: half the tolerance is theirs.
        if error <= (0.5 * rtol if "inertia" in included else rtol) or not open_:
            break
        worst = max(open_, key=lambda effect: size_of(state, effect, outputs))
        included |= {worst.name} | along.get(worst.name, set())
        open_ = [effect for effect in open_ if effect.name not in included]
    if "inertia" in included:
        check_movable(model, asked, "viscosity" in included)
    rows = [_row(effect, state, choice, reasons, rtol, error, outputs) for effect in EFFECTS]
    return Gate(state.law, rtol, error, tuple(rows), tuple(outputs))


def check_movable(model: Model, asked: Collection[str], lagging: bool) -> None:
    """Refuse a plate that has to move and cannot.

    Raises
    ------
    SceneError
        If its density is not known; if branches beyond bending are to move under a contact that
        lags, where they would lag too.
    """
    if lagging and model.inertia.branches == "all":
        raise SceneError(
            'inertia.branches: expected "A0" under a viscous contact, where what is not bending '
            'lags, got "all"; write branches = "A0", or effects.viscosity = false'
        )
    if model.density:
        return
    why = "effects.inertia = true" if "inertia" in asked else "its inertia may change the results"
    raise SceneError(
        f"plate.density: expected a density, since {why}, got none; give plate.density "
        "[kg/m^3], or effects.inertia = false for a plate without inertia"
    )


def _row(
    effect: Effect,
    state: State,
    choice: Mapping[str, Any],
    reasons: Mapping[str, str],
    rtol: float,
    error: float,
    outputs: Sequence[str],
) -> Row:
    """The effect's line, at the largest radius of the law decided on."""
    model, name = state.law.model, effect.name
    radius = state.law.limit if math.isnan(state.a) else state.a
    included = name in state.law.effects or not effect.by_itself
    if reasons[name]:
        return Row(name, effect.adds, effect.number, math.nan, 0.0, False, reasons[name])
    value = effect.value(model, radius)
    bound = price_of(state, effect, outputs) if included else error_of(state, [effect], outputs)
    if effect.forced:
        why = "always"
    elif choice[name] != "auto":
        worst = max(outputs, key=lambda output: error_of(state, [effect], [output]))
        why = _forced(bool(choice[name]), bound, worst)
    elif included:
        why = f"left out it could exceed rtol = {rtol:.3g}"
    else:
        why = f"all that is left out changes {error:.1e} at most"
    return Row(name, effect.adds, effect.number, value, bound, included, why)


def _forced(included: bool, bound: float, output: str) -> str:
    """What the scene's own choice means, and in which result most."""
    if included:
        return "true in the scene"
    known = bound < SAYS_NOTHING
    price = f"up to {100 * bound:.2g} % in {output}" if known else "more than a bound can say"
    return f"{FORCED_OUT}: costs {price}"
