"""Test the effect selection on random scenes: omitted effects against every applicable effect."""

from collections.abc import Sequence
from pathlib import Path

from derivation.checks import effects_judged as effects
from derivation.checks.random_scenes import Scene, Tell
from derivation.engine.files import measurements, write_file
from derivation.engine.outputs import expect_recordable
from derivation.scene.effects import EFFECTS
from derivation.scene.impact import selected_effects
from derivation.scene.law import ContactLaw
from derivation.scene.method_selection import moved, solve_selected
from derivation.scene.model import model_of
from derivation.scene.scene import SceneError, read

MEASURED: Path = measurements() / "effects.json"


def check_effects(
    count: int, update: bool = False, tell: Tell | None = None
) -> tuple[effects.EffectCheckRow, ...]:
    """Random scenes at several tolerances against everything on; keep the rows if asked."""
    if update:
        expect_recordable(MEASURED)
    rows = effects.judge(count, gated, everything, tell=tell)
    if update:
        write_file(MEASURED, effects.to_json(rows, count))
    return rows


def gated(data: Scene, rtol: float) -> tuple[Sequence[float], Sequence[str], float] | None:
    """A scene as `simulate` computes it at a tolerance; model errors stand apart."""
    _, selected = selected_effects(read(data), rtol)
    try:
        values, accuracy = solve_selected(selected, rtol)
    except SceneError:
        return None
    return values, sorted(selected.law.effects), accuracy.bound


def everything(data: Scene) -> tuple[Sequence[float], Sequence[str]] | None:
    """The same scene with every effect that applies, on a plate at rest.

    None beyond the range of the models.
    """
    model = model_of(read(data))
    present = sorted(
        e.name for e in EFFECTS if not e.not_applicable_reason(model) and e.name != "inertia"
    )
    try:
        found = moved(ContactLaw(model, frozenset(present)))
    except SceneError:
        return None
    return found.numbers, present
