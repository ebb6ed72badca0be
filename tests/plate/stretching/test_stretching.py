"""The stiffening of plates by stretching, against published values and a numerical solution."""

from collections.abc import Callable

import numpy as np
import pytest

from generated import stretching_kernels as kernels
from generated.arrays import Double
from tests.scene.von_karman import ThinPlate

STIFFENING: dict[str, Callable[[Double], Double]] = {
    "clamped": kernels.stiffening_clamped,
    "simply-supported": kernels.stiffening_supported,
    "paper": kernels.stiffening_paper,
}


@pytest.mark.parametrize(("edge", "published"), [("clamped", 0.443), ("simply-supported", 0.272)])
def test_published_values(edge: str, published: float) -> None:
    """Timoshenko and Woinowsky-Krieger (1959), table 82, nu = 0.3, concentrated load."""
    assert float(STIFFENING[edge](np.array(0.3))) == pytest.approx(published, rel=0.006)


@pytest.mark.parametrize("edge", STIFFENING)
@pytest.mark.parametrize("nu", [-0.9, 0.0, 0.3, 0.49])
def test_equals_the_stiffness_of_a_numerical_solution(edge: str, nu: float) -> None:
    """Modes, and the middle plane by numerical integration: no step of the derivation is used."""
    plate = ThinPlate(70e9, nu, 2500.0, 2e-3, 0.1, edge, modes=60, points=1000)
    assert plate.stiffening() == pytest.approx(float(STIFFENING[edge](np.array(nu))), rel=1e-3)


def test_middle_plane_of_a_clamped_plate_has_the_published_stress() -> None:
    """1.232 E (w/b)^2 on the axis: Timoshenko and Woinowsky-Krieger (1959), table 82."""
    plate = ThinPlate(70e9, 0.3, 2500.0, 2e-3, 0.1, "clamped", modes=60, points=1000)
    centre = plate.shapes[-1]
    q = centre / (plate.masses * plate.frequencies**2)
    stress = plate.stretched(q)[0][0] / plate.thickness
    assert stress / (plate.young * (centre @ q / plate.radius) ** 2) == pytest.approx(
        1.232, rel=2e-3
    )
