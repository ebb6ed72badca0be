"""The pressure at many distances from the axis."""

from typing import Any

import numpy as np
import pytest

from derivation.scene import read, simulate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.output.pressure_profile import DIRECT
from generated.arrays import Double as Array

POINTS = 50_001


@pytest.mark.parametrize(
    ("speed", "effects"),
    [
        (0.1, {"non_hertzian_pressure": True}),
        (20.0, {"non_hertzian_pressure": True, "spherical_profile": True}),
        (5.0, {"non_hertzian_pressure": False, "spherical_profile": True}),
    ],
)
def test_many_pressures_agree_with_those_of_few_points(
    speed: float, effects: dict[str, bool], monkeypatch: pytest.MonkeyPatch
) -> None:
    """An earlier version computed each of them from all wave numbers, 0.03 ms each."""
    scene: dict[str, Any] = {
        "sphere": {"radius": 0.05, "youngs_modulus": 2e9, "poissons_ratio": 0.3, "density": 1200.0},
        "plate": {"radius": 0.1, "thickness": 0.015, "youngs_modulus": 1e9, "poissons_ratio": 0.3},
        "impact": {"speed": speed},
        "effects": effects | {"inertia": False},
    }
    result = simulate(read(scene))
    computed, direct = list[int](), ContactLaw.pressure

    def counted(law: ContactLaw, r: Array, a: float) -> Array:
        computed.append(r.size)
        return direct(law, r, a)

    monkeypatch.setattr(ContactLaw, "pressure", counted)
    many = result.pressures(POINTS)
    assert 0 < sum(computed) <= DIRECT
    few = result.pressures(1 + (POINTS - 1) // 50)
    np.testing.assert_allclose(many.distance[::50], few.distance, rtol=1e-14, atol=1e-16)
    np.testing.assert_allclose(
        many.pressure[::50], few.pressure, rtol=1e-11, atol=1e-11 * float(np.max(few.pressure))
    )
