"""The estimated error of the shapes that do not stretch the plate, against more of them."""

from typing import Any

import numpy as np
import pytest

from derivation.scene import Result, explain, read, simulate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import stretched_shapes, waves
from derivation.scene.dynamic.mode_count import branching
from derivation.scene.dynamic.runs import WORK, Budget, run_with
from derivation.scene.dynamic.stretched_shapes import with_shape_error, with_shapes
from derivation.scene.dynamic.time_in_contact import FEWER
from derivation.scene.dynamic.wave_motion import DynamicImpact
from derivation.scene.scene import OUTPUTS
from tests.scene.stretching_scenes import SCENES

pytestmark = pytest.mark.one_version
MODES = 96
SCENE: dict[str, Any] = {
    "sphere": {"radius": 0.0064, "mass": 0.135, "material": "steel"},
    "plate": {
        "radius": 0.05,
        "thickness": 5.68e-3,
        "youngs_modulus": 7e10,
        "poissons_ratio": 0.2,
        "density": 2500.0,
        "edge": "paper",
    },
    "impact": {"speed": 19.8},
    "effects": {"inertia": True, "stretching": True},
}


def test_estimate_covers_the_change_by_twice_as_many_shapes() -> None:
    """An earlier version stated a quarter of the last change: too little for force and radius."""
    law = branching(explain(read(SCENE)).effects.law, "A0")

    def run(shapes: int) -> DynamicImpact:
        with np.errstate(all="ignore"):
            return run_with(with_shapes(law, shapes), MODES, Budget(WORK), 1e-8, FEWER)

    few, many = run(48), run(MODES)
    assert few.inertia.complete
    changes = [abs(getattr(few, name) / getattr(many, name) - 1.0) for name in OUTPUTS]
    both = [
        with_shape_error(with_shapes(law, 48), few, 1e-3, rough).inertia.shape_error
        for rough in (None, few)  # 48 modes, and those of the run
    ]
    for stated in both:
        for name, change, error in zip(OUTPUTS, changes, stated, strict=True):
            assert change <= error, name
        assert max(stated) < 3e-3
        assert max(np.divide(changes, stated)) > 0.02
    assert both[0] != both[1]
    assert both[0] == pytest.approx(both[1], rel=0.5)


def test_run_with_few_modes_is_not_repeated(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the impact and of a run with half as many shapes, only the latter is simulated."""
    law = branching(explain(read(SCENE)).effects.law, "A0")
    with np.errstate(all="ignore"):
        run = run_with(law, MODES, Budget(WORK), 1e-8, FEWER)
    assert law.model.inertia.shapes == MODES / 2
    counted = list[tuple[int, int]]()

    def simulated(law: ContactLaw, count: int, *rest: Any) -> DynamicImpact:
        """Return an impact, and count it."""
        counted.append((law.model.inertia.shapes, count))
        return run_with(law, count, *rest)

    monkeypatch.setattr(stretched_shapes, "run_with", simulated)
    with_shape_error(law, run, 1e-3, run)
    assert counted == [(MODES // 4, MODES)]
    more_shapes = with_shapes(law, 64)  # of another law
    with_shape_error(more_shapes, run, 1e-3, run)
    assert counted[1:] == [(32, 64), (64, 64)]


HAIL: dict[str, Any] = {
    "sphere": {"radius": 0.0125, "material": "ice"},
    "plate": {"radius": 0.3, "thickness": 0.0008, "material": "steel"},
    "impact": {"speed": 20.0},
    "accuracy": {"rtol": 1e-3},
}


def shapes_and_modes(result: Result) -> tuple[int, int]:
    """Return how many shapes stretch the plate, and how many it has."""
    assert result.dynamics is not None
    problem = result.dynamics.impact_history.problem
    assert problem.middle_plane is not None
    return problem.middle_plane.slopes.shape[0], problem.contact.modes.phi.size


def test_more_shapes_stretch_the_plate_if_the_tolerance_requires(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """With 96 shapes the contact time has an error of 0.8 %, and the scene was rejected."""
    found = simulate(read(HAIL))
    assert found.accuracy.bound <= 1e-3
    shapes, modes = shapes_and_modes(found)
    assert stretched_shapes.MORE < shapes < modes
    monkeypatch.setattr(stretched_shapes, "MORE", modes)
    waves.impact.cache_clear()
    reference = simulate(read(HAIL))
    waves.impact.cache_clear()
    assert shapes_and_modes(reference) == (modes, modes)
    for name in OUTPUTS:
        change = abs(getattr(found, name) / getattr(reference, name) - 1.0)
        assert change <= found.accuracy.bound, name


def test_all_shapes_stretch_a_plate_with_few_modes() -> None:
    """No error of other shapes has then to be estimated by further simulations."""
    scene = SCENES["yielding contacts, of which a later one becomes the strongest"]
    found = simulate(read(scene), rtol=1e-2)
    shapes, modes = shapes_and_modes(found)
    assert shapes == modes > stretched_shapes.MORE
    assert found.dynamics is not None
    assert max(found.dynamics.inertia.shape_error) == 0.0
