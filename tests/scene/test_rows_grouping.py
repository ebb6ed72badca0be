"""Groups of almost equal rows: they change neither the effects nor the results of any row."""

import numpy as np
import pytest
from shared_scenes import PAPER

from derivation.scene import load, read
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.rows import grouping
from derivation.scene.rows import selection as of_rows
from derivation.scene.rows.columns import models_of
from derivation.scene.rows.rows import Rows, solve
from derivation.scene.scene import OUTPUTS, Scene
from derivation.scene.selection import selection
from derivation.scene.selection.omission_bounds import LargestContact

COUNT = 4000
STEEL = {"radius": 0.3, "thickness": 0.2, "material": "steel", "yield_stress": 5e8}
"""A thick plate that yields from 0.0117 m/s on."""


def on_glass(edge: str) -> Scene:
    """Return a steel sphere on a glass plate with an edge."""
    return read({
        "sphere": {"radius": 0.01, "material": "steel"},
        "plate": {"radius": 0.1, "thickness": 0.05, "material": "glass", "edge": edge},
        "impact": {"speed": 0.1},
        "effects": {"inertia": False, "non_hertzian_pressure": False},
    })  # fmt: skip


@pytest.mark.one_version
@pytest.mark.parametrize("rtol", [None, 0.2, 1e-2, 1e-6])
@pytest.mark.parametrize("scene", [load(PAPER), on_glass("simply-supported"), on_glass("clamped")])
def test_groups_change_no_row(
    scene: Scene, rtol: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The rows cross the tolerance, where the effects change."""
    chance = np.random.default_rng(3)
    columns = {
        "impact.speed": 10 ** chance.uniform(-1.3, -1.0, COUNT),
        "plate.half_thickness": 10 ** chance.uniform(-1.4, -1.2, COUNT),
    }
    with_groups = solve(scene, columns, rtol)
    monkeypatch.setattr(grouping, "SHARE", 0.0)
    equal(with_groups, solve(scene, columns, rtol))


def equal(left: Rows, right: Rows) -> None:
    """Assert that rows are equal to the last bit."""
    for name in ("bound", "model_error", "status", "reason", "effects"):
        np.testing.assert_array_equal(getattr(left, name), getattr(right, name), name)
    for name, values in left.results.items():
        np.testing.assert_array_equal(values, right.results[name], name)


@pytest.mark.one_version
def test_groups_are_divided_at_the_onset_of_yield(monkeypatch: pytest.MonkeyPatch) -> None:
    """The row that decides for a group may yield while others do not, and the reverse."""
    tables = on_glass("paper").to_json() | {"plate": STEEL}
    scene = read(tables)
    rtol = np.full(COUNT, 1e-6)

    def effects(order: int = 1) -> list[str]:
        speeds = np.linspace(0.011, 0.0125, COUNT)[::order]
        model, _ = models_of(scene, {"impact.speed": speeds})
        found = ["simulated singly"] * COUNT
        for group in of_rows.selected(model, scene.effects.model_dump(), rtol, OUTPUTS):
            assert isinstance(group, of_rows.Group)
            for row in group.rows:
                found[row] = " ".join(sorted(group.law.effects))
        return found

    rising, falling = effects(), effects(-1)
    monkeypatch.setattr(grouping, "SHARE", 0.0)
    singly = effects()
    assert len(set(singly)) > 1
    assert rising == singly
    assert falling == singly[::-1]


def test_groups_save_bounds(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without groups, the largest contact of each row is computed at each step."""
    original = selection.state_of

    def solved() -> int:
        counts: list[int] = []

        def counted(law: ContactLaw) -> LargestContact:
            counts.append(np.size(law.model.v0))
            return original(law)

        monkeypatch.setattr(selection, "state_of", counted)
        solve(on_glass("paper"), {"impact.speed": np.linspace(0.05, 0.1, COUNT)}, 1e-2)
        return sum(counts)

    with_groups = solved()
    monkeypatch.setattr(grouping, "SHARE", 0.0)
    assert with_groups < 0.7 * solved()


@pytest.mark.parametrize("numbers", [[-1.0, 1.0], [0.0, 1.0]])
def test_numbers_that_are_not_positive_are_not_grouped(numbers: list[float]) -> None:
    """The elastic constant lambda may be negative."""
    scene = load(PAPER)
    lam = np.repeat(numbers, COUNT) * 1e8
    model, _ = models_of(scene, {"plate.lame_lambda": lam})
    assert grouping.groups_of(model, len(lam)) is None
