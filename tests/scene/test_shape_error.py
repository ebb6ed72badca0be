"""The estimated error of the shapes that do not stretch the plate, against more of them."""

from typing import Any

import numpy as np
import pytest

from derivation.scene import explain, read
from derivation.scene.dynamic.mode_count import branching
from derivation.scene.dynamic.runs import WORK, Budget, run_with
from derivation.scene.dynamic.stretched_shapes import with_shape_error, with_shapes
from derivation.scene.dynamic.time_in_contact import FEWER
from derivation.scene.dynamic.wave_motion import DynamicImpact
from derivation.scene.scene import OUTPUTS

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
    stated = with_shape_error(with_shapes(law, 48), few, 1e-3).inertia.shape_error
    assert few.inertia.complete
    changes = [abs(getattr(few, name) / getattr(many, name) - 1.0) for name in OUTPUTS]
    for name, change, error in zip(OUTPUTS, changes, stated, strict=True):
        assert change <= error, name
    assert max(stated) < 3e-3
    assert max(np.divide(changes, stated)) > 0.02
