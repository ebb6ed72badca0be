"""Test stiffening and membrane stress against published values and numerical solutions."""

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
TENSION: dict[str, Callable[[Double], Double]] = {
    "clamped": kernels.tension_clamped,
    "simply-supported": kernels.tension_supported,
    "paper": kernels.tension_paper,
}


def tension_on_axis(edge: str, nu: float) -> float:
    """Return the stress of the middle plane over E (w/b)^2, from the bending stiffness k."""
    softer = {"clamped": 1.0, "simply-supported": 1.0 + 2.0 / (1.0 + nu), "paper": 2.0}[edge]
    return 2.0 * float(TENSION[edge](np.array(nu))) / ((1.0 - nu) * softer)


@pytest.mark.parametrize(("edge", "published"), [("clamped", 0.443), ("simply-supported", 0.272)])
def test_stiffening_agrees_with_published_values(edge: str, published: float) -> None:
    """Timoshenko and Woinowsky-Krieger (1959), table 82, nu = 0.3, concentrated load."""
    assert float(STIFFENING[edge](np.array(0.3))) == pytest.approx(published, rel=0.006)


@pytest.mark.parametrize("edge", STIFFENING)
@pytest.mark.parametrize("nu", [-0.9, 0.0, 0.3, 0.49])
def test_stiffening_agrees_with_a_numerical_solution(edge: str, nu: float) -> None:
    """The solution uses modes and numerical integration, but no step of the derivation."""
    plate = ThinPlate(70e9, nu, 2500.0, 2e-3, 0.1, edge, modes=60, points=1000)
    assert plate.stiffening() == pytest.approx(float(STIFFENING[edge](np.array(nu))), rel=1e-3)


@pytest.mark.parametrize(("edge", "published"), [("clamped", 1.232), ("simply-supported", 0.407)])
def test_stress_on_the_axis_agrees_with_published_values(edge: str, published: float) -> None:
    """Stress over E (w/b)^2: Timoshenko and Woinowsky-Krieger (1959), table 82, nu = 0.3."""
    assert tension_on_axis(edge, 0.3) == pytest.approx(published, abs=6e-4)


@pytest.mark.parametrize("edge", TENSION)
@pytest.mark.parametrize("nu", [-0.9, 0.0, 0.3, 0.49])
def test_stress_on_the_axis_agrees_with_a_numerical_solution(edge: str, nu: float) -> None:
    plate = ThinPlate(70e9, nu, 2500.0, 2e-3, 0.1, edge, modes=60, points=1000)
    centre = plate.shapes[-1]
    q = centre / (plate.masses * plate.frequencies**2)
    stress = plate.stretched(q)[0][0] / plate.thickness
    over = plate.young * (centre @ q / plate.radius) ** 2
    assert stress / over == pytest.approx(tension_on_axis(edge, nu), rel=3e-3)


@pytest.mark.parametrize(
    ("edge", "g"), [("clamped", 0.0), ("simply-supported", 1 / 1.3), ("paper", 0.5)]
)
def test_bending_stress_of_a_narrow_contact_is_proportional_to_a_logarithm(
    edge: str, g: float
) -> None:
    """The logarithm is the mean of log(b/r) - 1/2 + g under Hertz pressure, for nu = 0.3."""
    logarithm = np.log(50.0) + 5.0 / 6.0 - np.log(2.0) + g
    expected = float(TENSION[edge](np.array(0.3)))
    assert tension_over_bending(edge, 0.3, 1 / 50) * logarithm == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("edge", TENSION)
@pytest.mark.parametrize("nu", [-0.5, 0.0, 0.3, 0.49])
@pytest.mark.parametrize("width", [0.05, 0.4])
def test_tension_is_below_its_bound_in_narrow_contacts(edge: str, nu: float, width: float) -> None:
    assert tension_over_bending(edge, nu, width) < float(TENSION[edge](np.array(nu)))


def tension_over_bending(edge: str, nu: float, width: float) -> float:
    """Return the membrane stress over bending stress and w/H; the contact radius is width b."""
    plate = ThinPlate(70e9, nu, 2500.0, 2e-3, 0.1, edge, modes=200, points=1500)
    x = plate.wave_numbers * width
    q = 3.0 * (np.sin(x) - x * np.cos(x)) / x**3 / (plate.masses * plate.frequencies**2)
    q *= plate.shapes[-1]
    ratio = plate.stretched(q)[0][0] / plate.thickness / (plate.bending_stresses @ q)
    return float(ratio / (plate.shapes[-1] @ q / plate.thickness))
