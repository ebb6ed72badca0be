"""Complete results: all warnings are given, no NaN is written, failed drawings lose nothing."""

import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shared_scenes

from derivation.cli import main
from derivation.engine.console import json_text
from derivation.scene import SceneError, read, simulate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import (
    STRETCH_LIMIT,
    check_energy,
    local_indentation,
)
from derivation.scene.contact_law.stress_limits import stress_warnings
from derivation.scene.dynamic.modal import Modes, plate_of
from derivation.scene.effects import WHOLE_PLATE
from derivation.scene.kernels import YIELD_LIMIT
from derivation.scene.model import model_of
from derivation.scene.output import animation
from derivation.scene.output import plot as plots
from derivation.scene.result import History, Result
from generated import edge_modes

Captured = pytest.CaptureFixture[str]
DROP: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.01, "material": "steel"},
    "plate": {
        "radius": 0.05, "thickness": 0.002, "material": "aluminium", "yield_stress": 1e8,
        "tensile_strength": 1e7,
    },
    "impact": {"speed": 2.0},
    "effects": {"inertia": True, "non_hertzian_pressure": "auto"},
    "inertia": {"modes": 24},
}  # fmt: skip


def scene(**tables: Any) -> Any:
    return read({name: {**DROP[name], **tables.get(name, {})} for name in DROP})


# --- warnings of plates with inertia


@pytest.mark.one_version
def test_deflection_of_a_plate_with_inertia_is_that_of_its_history() -> None:
    """The largest deflection is found at any time, during contacts and after the last one."""
    result = simulate(scene())
    assert result.dynamics is not None
    history = result.history(4001)
    local = local_indentation(result.effects.law, history.contact_radius)
    touching = history.force > 0.0
    seen = np.max(np.abs(history.indentation - local)[touching])
    deflection = result.dynamics.largest_deflection(result.effects.law)
    assert deflection >= (1 - 1e-6) * seen
    assert deflection >= 0.98 * np.max(np.abs(history.deflection))
    problem = result.dynamics.impact_history.problem
    later = np.linspace(1.0, 1.2, 200) * result.total_time
    assert deflection >= 0.98 * np.max(np.abs(result.dynamics.profiles(later, np.zeros(1))))
    assert problem.contact.modes.phi.size == 24  # wave numbers; some have two branches


def test_plates_with_inertia_keep_every_warning() -> None:
    fast = {"impact": {"speed": 6.0}}
    for effects in ({"inertia": False}, {"inertia": True}):
        linear = effects | {"plasticity": False, "stretching": False}
        result = simulate(scene(**fast, effects=linear))
        output = " ".join(result.warnings)
        assert f"exceeds {STRETCH_LIMIT}" in output
        assert f"exceeds {YIELD_LIMIT}" in output
        assert "times the strength" in output
        assert "times the yield stress" in output


def test_warning_of_the_largest_deflection_at_any_time() -> None:
    """The warning applies to the largest deflection at any time of the impact."""
    plate = {"radius": 0.08, "yield_stress": 3e8, "tensile_strength": None}
    linear = {"stretching": False}
    result = simulate(scene(plate=plate, impact={"speed": 3.0}, effects=linear))
    assert result.dynamics is not None
    times = np.linspace(0.0, result.total_time, 400)
    seen = np.abs(result.dynamics.profiles(times, np.zeros(1))).max()
    assert seen > STRETCH_LIMIT * 2.0 * result.model.h
    assert f"exceeds {STRETCH_LIMIT}" in " ".join(result.warnings)


def test_tensile_stress_is_compared_with_the_strength() -> None:
    assert stress_warnings(3e8, None, None) == stress_warnings(1e8, 2e8, 2e8) == ()
    [failure] = stress_warnings(3e8, 2e8, 4e8)
    assert re.search("back face .* 1.5 times .*strength", failure)
    [yielding] = stress_warnings(3e8, None, 2e8)
    assert re.search("1.5 times the yield stress.* bending", yielding)


# --- drawings


def test_shapes_of_modes_with_many_nodes_are_finite() -> None:
    """The shapes are finite and vanish at the edge, although I_0 alone would overflow."""
    with np.errstate(all="raise", under="ignore"):
        waves = edge_modes.clamped_waves(400, 1e-4, 0.3)
        actual = edge_modes.shape(waves, np.linspace(0.0, 1.0, 11))
    assert waves.k2[-1] > 1200.0
    assert np.isfinite(actual).all()
    assert actual[:, 0] == pytest.approx(1.0, rel=1e-12)
    assert np.abs(actual).max() <= 1.0 + 1e-12
    assert np.abs(actual[:, -1]).max() < 1e-4


def test_many_modes_of_a_clamped_plate_are_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(animation, "FRAMES", 2)
    data = scene(
        sphere={"radius": 0.0025},
        plate={"edge": "clamped"},
        inertia={"modes": 300},
        effects={"plasticity": False},  # cannot be simulated with so many modes
    )
    modes = plate_of(
        ContactLaw(model_of(data), WHOLE_PLATE | {"hertz", "edge", "inertia"}), 300
    ).modes
    assert modes.held is not None
    assert np.isfinite(modes.shapes(np.linspace(0.0, 0.05, 5))).all()
    assert animation.render(simulate(data), ".gif").startswith(b"GIF")


def test_failed_drawing_does_not_lose_the_result(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    """All other results are written if a frame is not finite or a drawing raises an error."""
    file = str(shared_scenes.written(tmp_path, scene().to_json()))

    def fails(*_: Any) -> Any:
        raise RuntimeError("no canvas")

    shapes = Modes.shapes
    monkeypatch.setattr(Modes, "shapes", lambda self, r: shapes(self, r) * math.nan)
    monkeypatch.setattr(plots, "render", fails)
    outputs = ["--csv", f"{tmp_path}/a.csv", "--json", f"{tmp_path}/a.json"]
    drawings = ["--plot", f"{tmp_path}/a.svg", "--animate", f"{tmp_path}/a.gif"]
    assert main(["simulate", file, *outputs, *drawings]) == 2
    shown = capsys.readouterr()
    assert "max force" in shown.out
    assert "no canvas" in shown.err
    assert "expected finite" in shown.err
    assert json.loads((tmp_path / "a.json").read_text())["max_force"] > 0
    assert (tmp_path / "a.csv").read_text().startswith("time,")
    assert not (tmp_path / "a.svg").exists()
    assert not (tmp_path / "a.gif").exists()


# --- NaN


@pytest.mark.parametrize(
    ("radius", "edge", "speed"), [(0.008, "clamped", 0.5), (0.004, "simply-supported", 0.25)]
)
def test_history_is_finite_at_zero_rate(radius: float, edge: str, speed: float) -> None:
    """The history is finite where the derivative in Newton's iteration is exactly 0."""
    data = read(
        {
            "sphere": {"radius": radius, "material": "glass"},
            "plate": {"radius": 0.1, "thickness": 0.012, "material": "aluminium", "edge": edge},
            "impact": {"speed": speed},
            "effects": {"inertia": False},
        }
    )
    history = simulate(data).history()
    assert all(np.isfinite(column).all() for column in history)
    assert history.velocity[0] == pytest.approx(speed)
    assert history.indentation[0] == pytest.approx(0.0, abs=1e-12)


def test_history_with_nan_is_rejected(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    hole = History(*np.full((5, 3), math.nan))
    monkeypatch.setattr(Result, "_history", lambda *_: hole)
    file = shared_scenes.written(tmp_path, scene(effects={"inertia": False}).to_json())
    path = tmp_path / "a.csv"
    assert main(["simulate", str(file), "--csv", str(path)]) == 2
    assert "expected finite numbers" in capsys.readouterr().err
    assert not path.exists()


def test_json_with_nan_is_rejected() -> None:
    with pytest.raises(ValueError, match="expected finite numbers"):
        json_text({"x": math.nan})


# --- spheres that are too heavy at any speed


def test_too_heavy_sphere_is_rejected() -> None:
    heavy = {
        "sphere": {"radius": 0.01, "mass": 1000.0, "material": None},
        "plate": {"radius": 0.1, "thickness": 0.01, "youngs_modulus": 5e6, "poissons_ratio": 0.4,
                  "material": None, "yield_stress": None, "tensile_strength": None},
        "impact": {"speed": 0.1, "gravity": 9.81},
        "effects": {"inertia": False, "non_hertzian_pressure": False},
    }  # fmt: skip
    data = scene(**heavy).model_dump(exclude_none=True)
    data.pop("inertia")
    with pytest.raises(SceneError, match=r"^impact\.gravity: .*kg"):
        simulate(read(data))
    data["impact"]["speed"] = 1e-9  # the sphere is too heavy at any speed
    with pytest.raises(SceneError, match=r"^impact\.gravity: "):
        simulate(read(data))
    data["effects"]["gravity"] = False
    assert simulate(read(data)).contact_time > 0


def test_law_without_energy_is_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    from derivation.scene.contact_law import limits
    from derivation.scene.contact_law.law import ContactLaw

    monkeypatch.setattr(limits, "energy_of", lambda *_: 0.0)
    with pytest.raises(SceneError, match=r"^scene: .*\[effects\]"):
        check_energy(ContactLaw(shared_scenes.model(gravity=0.0), frozenset({"hertz"})))
