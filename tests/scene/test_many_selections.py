"""Selections of many scenes together are those of each scene, to the last bit."""

import random
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
import shared_scenes

from derivation.scene.effects import EFFECTS
from derivation.scene.errors import SceneError
from derivation.scene.model import InertiaSettings, Model
from derivation.scene.scene import OUTPUTS
from derivation.scene.selection import selection as module
from derivation.scene.selection.candidates import candidates_of
from derivation.scene.selection.selection import select, selections
from generated.arrays import Double as Array

COUNT = 12
CHOICES = ("auto",) * 8 + (True, False)


def random_scenes(seed: int) -> tuple[Model, dict[str, Any], float, tuple[str, ...]]:
    """Return scenes with the same effects as columns, the choice of effects, rtol and outputs."""
    chance = random.Random(seed)
    thick = 10.0 ** np.array([chance.uniform(-3.0, 0.5) for _ in range(COUNT)])
    fast = 10.0 ** np.array([chance.uniform(-3.0, 1.0) for _ in range(COUNT)])
    columns: dict[str, Any] = {"h": 0.5 * thick[:, None], "v0": fast[:, None]}
    for name, value in (("R", 0.1), ("m", 3.0), ("b", 0.5), ("mu", 3e9)):
        if chance.random() < 0.3:
            spread = [value * chance.uniform(0.5, 2.0) for _ in range(COUNT)]
            columns[name] = np.array(spread)[:, None]
    model = shared_scenes.model(
        **columns,
        edge=chance.choice(["paper", "simply-supported", "clamped"]),
        gravity=chance.choice([0.0, 9.81]),
        density=chance.choice([0.0, 2500.0, 2500.0]),
        retardation_time=chance.choice([0.0, 0.0, 1e-5, 1e-3]),
        yield_stress=chance.choice([np.inf, 1e8, 3e6]),
        loss_factor=chance.choice([0.0, 0.02]),
        inertia=InertiaSettings(
            infinite_plate=chance.random() < 0.2, stretching=chance.random() < 0.3
        ),
    )
    wanted = {effect.name: chance.choice(CHOICES) for effect in EFFECTS if effect.selectable}
    outputs = OUTPUTS if chance.random() < 0.7 else ("max_force", "restitution")
    return model, wanted, 10.0 ** chance.uniform(-5.0, -1.0), outputs


def by_row(
    model: Model, wanted: Mapping[str, Any], rtol: float, outputs: tuple[str, ...], **margin: float
) -> dict[int, Any]:
    """Select the effects together; for each scene, return needed effects and sizes, or an error."""
    given, found = candidates_of(model.take(0), wanted), dict[int, Any]()
    for branch, decided in selections(given, model, np.full(COUNT, rtol), outputs, **margin):
        if decided is None or isinstance(decided, SceneError):
            found |= dict.fromkeys(branch.rows.tolist(), decided and str(decided))
            continue
        sizes: dict[str, Array] = decided.sizes(given, branch, outputs)
        for row, index in enumerate(branch.rows.tolist()):
            numbers = {name: size[row].item() for name, size in sizes.items()}
            error = 0.0 if given.whole else decided.error[row].item()
            found[index] = branch.included, error, dict(branch.required), numbers
    return found


def alone(model: Model, wanted: Mapping[str, Any], rtol: float, outputs: tuple[str, ...]) -> Any:
    """Select the effects of a scene, with the result of `by_row`."""
    try:
        one = select(model, wanted, rtol, outputs)
    except SceneError as error:
        return str(error)
    return one.needed, one.error, dict(one.required), one.sizes


@pytest.mark.parametrize("seed", range(20))
def test_each_selection_of_many_is_that_of_the_scene(seed: int) -> None:
    model, wanted, rtol, outputs = random_scenes(seed)
    expected = [alone(model.take(index), wanted, rtol, outputs) for index in range(COUNT)]
    try:
        together = by_row(model, wanted, rtol, outputs)
    except SceneError as rejected:  # the choice of effects
        together = dict.fromkeys(range(COUNT), str(rejected))
    np.testing.assert_equal([together[index] for index in range(COUNT)], expected)


def test_random_scenes_have_all_effects() -> None:
    """Each effect is added in some scenes; most are omitted in others."""
    added, omitted, rejected = set[str](), set[str](), 0
    for seed in range(20):
        model, wanted, rtol, outputs = random_scenes(seed)
        found = alone(model.take(0), wanted, rtol, outputs)
        if isinstance(found, str):
            rejected += 1
            continue
        added |= found[0]
        omitted |= found[3].keys() - found[0]
    assert added >= {effect.name for effect in EFFECTS if effect.selectable}
    assert omitted >= {"inertia", "damping", "viscosity", "plasticity", "edge", "gravity"}
    assert "non_hertzian_pressure" in omitted
    assert 0 < rejected < 10


def test_only_scenes_that_rounding_could_decide_are_undecided() -> None:
    """The tolerance is the bound of one scene, or almost."""
    model, outputs = shared_scenes.model(v0=10.0 ** np.linspace(-3.0, 0.0, COUNT)[:, None]), OUTPUTS
    rtol = by_row(model, shared_scenes.AT_REST, 1e-3, outputs)[0][1]
    assert rtol > 0.0
    for factor, undecided in ((1.0, True), (1.0 + 1e-12, True), (1.0 + 1e-6, False)):
        tolerance = factor * rtol
        found = by_row(model, shared_scenes.AT_REST, tolerance, outputs, clear=1.0 + 1e-9)
        assert (found.pop(0) is None) == undecided
        assert None not in found.values()
        assert None not in by_row(model, shared_scenes.AT_REST, tolerance, outputs).values()


def test_many_scenes_share_their_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """The largest contacts of scenes with the same effects are computed together."""
    model, wanted, rtol, outputs = random_scenes(0)
    original, calls = module.state_of, list[int]()

    def counted(law: Any) -> Any:
        calls.append(np.size(law.model.v0))
        return original(law)

    monkeypatch.setattr(module, "state_of", counted)
    by_row(model, dict.fromkeys(wanted, "auto"), rtol, outputs)
    assert len(calls) < sum(calls) / 2
