"""A scene that enables an effect must give what the effect needs."""

from typing import Any

import numpy as np
import pytest

from derivation.scene import SceneError, explain, indent, read, simulate
from derivation.scene.rows import rows

Tables = dict[str, dict[str, Any]]
STILL: Tables = {
    "sphere": {"radius": 0.01, "density": 7800.0},
    "plate": {"radius": 0.3, "thickness": 0.05, "youngs_modulus": 7e10, "poissons_ratio": 0.23},
    "impact": {"speed": 1.0},
    "effects": {"inertia": False},
}
KEYS = {
    "sphere_elasticity": (
        {"sphere": {"youngs_modulus": 2e11, "poissons_ratio": 0.3}},
        "sphere.material",
    ),
    "edge": ({"plate": {"edge": "clamped"}}, "plate.edge"),
    "plasticity": ({"plate": {"yield_stress": 5e7}}, "plate.yield_stress"),
    "viscosity": ({"plate": {"retardation_time": 1e-6}}, "plate.retardation_time"),
    "gravity": ({"impact": {"gravity": 9.81}}, "impact.gravity"),
    "damping": ({"plate": {"loss_factor": 0.1, "density": 2500.0}}, "plate.loss_factor"),
}


def with_(*changes: Tables) -> Any:
    """Return the scene with changed tables."""
    tables = {name: dict(keys) for name, keys in STILL.items()}
    for change in changes:
        for name, keys in change.items():
            tables[name] |= keys
    return read(tables)


def enabled(name: str) -> Tables:
    """Return the change that enables an effect, with plate inertia if it needs that."""
    return {"effects": {name: True} | ({"inertia": True} if name == "damping" else {})}


@pytest.mark.parametrize("name", KEYS)
def test_an_enabled_effect_without_its_key_is_rejected(name: str) -> None:
    more: Tables = {"plate": {"density": 2500.0}} if name == "damping" else {}
    lacking = with_(enabled(name), more)
    for call in (simulate, explain, lambda scene: indent(scene, force=1.0)):
        with pytest.raises(SceneError) as caught:
            call(lacking)
        text = str(caught.value)
        assert text.startswith(f"effects.{name} = true does not apply: ")
        assert KEYS[name][1] in text.partition("; ")[2]
        assert text.endswith(f"or remove effects.{name}")


@pytest.mark.parametrize("name", KEYS)
def test_with_its_key_it_is_included(name: str) -> None:
    assert name in explain(with_(enabled(name), KEYS[name][0])).effects.included


def test_all_of_them_are_listed_at_once() -> None:
    with pytest.raises(SceneError) as caught:
        simulate(with_({"effects": {"gravity": True, "edge": True}}))
    assert "effects.gravity" in str(caught.value)
    assert "effects.edge" in str(caught.value)


@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("gravity", {"impact": {"gravity": 0.0}}),
        ("damping", {"plate": {"loss_factor": 0.0, "density": 2500.0}}),
    ],
)
def test_a_key_of_0_changes_nothing(name: str, given: Tables) -> None:
    still = {table: keys for table, keys in given.items() if table != "impact"}
    rtol = 0.03
    without = simulate(with_(still, {"effects": {"inertia": name == "damping"}}), rtol=rtol)
    result = simulate(with_(enabled(name), given), rtol=rtol)
    assert result.contact_time == without.contact_time
    assert result.restitution == without.restitution


def test_an_infinite_plate_has_no_edge() -> None:
    tables: Tables = {
        "plate": {"edge": "clamped", "density": 2500.0},
        "effects": {"inertia": True, "edge": True},
    }
    endless = {name: dict(keys) for name, keys in STILL.items()} | {"inertia": {}}
    for table, keys in (*tables.items(), ("inertia", {"extent": "infinite"})):
        endless[table] |= keys
    assert "edge" not in explain(read(endless)).effects.included


def test_rows_are_as_single_scenes() -> None:
    speeds = {"impact.speed": np.array([0.5, 1.0])}
    lacking = rows.solve(with_({"effects": {"gravity": True}}), speeds)
    assert lacking.status.tolist() == ["rejected", "rejected"]
    assert all("give impact.gravity" in reason for reason in lacking.reason)
    given = {"impact.gravity": np.array([0.0, 9.81])}
    both = rows.solve(with_({"effects": {"gravity": True}}), given)
    assert both.status.tolist() == ["finished", "finished"]
    assert "gravity" not in both.effects[0]
    assert "gravity" in both.effects[1].split()
