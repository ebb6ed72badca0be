"""Plate inertia in viscoelastic contacts: its omission never changes more than is stated."""

from typing import Any

import pytest

from derivation.scene import read, simulate
from derivation.scene.scene import OUTPUTS

SOFT_BLOCK: dict[str, Any] = {
    "sphere": {"radius": 0.529, "density": 2378.0, "material": "steel"},
    "plate": {"radius": 1.258, "half_thickness": 0.366, "youngs_modulus": 1.387e6,
              "poissons_ratio": 0.314, "density": 1032.0, "edge": "simply-supported"},
    "impact": {"speed": 8.65e-4},
}  # fmt: skip


@pytest.mark.parametrize("retardation_time", [0.01, 0.1, 0.92])
@pytest.mark.parametrize("rtol", [0.3, 0.1, 0.05])
def test_results_at_a_loose_tolerance_are_within_their_bound(
    retardation_time: float, rtol: float
) -> None:
    """Strongly viscoelastic: the vibration of the plate doubles the rest of the sphere's speed."""
    plate = SOFT_BLOCK["plate"] | {"retardation_time": retardation_time}
    scene = SOFT_BLOCK | {"plate": plate, "effects": {"inertia": "auto"}}
    with_inertia = scene | {"effects": {"inertia": True}}
    found, reference = simulate(read(scene), rtol=rtol), simulate(read(with_inertia), rtol=0.02)
    for name in OUTPUTS:
        off = abs(getattr(found, name) / getattr(reference, name) - 1.0)
        assert off <= found.accuracy.bound + reference.accuracy.bound
