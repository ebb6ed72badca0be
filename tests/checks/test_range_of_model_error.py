"""Impacts that differ from the recorded ones, against finite-element simulations of their own."""

import math
from dataclasses import asdict

import platecontact as pc
import pytest

from derivation.checks.finite_elements.cases import HERTZ, ElementCase
from derivation.checks.finite_elements.impact import Sphere
from derivation.checks.finite_elements.plate import Plate
from derivation.checks.finite_elements.record import COARSER, solve_impact

NAMES = "contact_time", "max_indentation", "max_force", "restitution"


@pytest.mark.parametrize(
    ("thickness", "nu", "width", "echoes", "edge"),
    [
        (0.194, 0.0166, 0.287, 26.7, "paper"),  # the force differs by 0.6 %
        (0.478, -0.23, 0.153, 4.15, "clamped"),  # the contact time differs by 2.4 %
        (0.75, 0.4, 0.12, 7.0, "clamped"),
        (0.7, 0.1, 0.15, 12.0, "simply-supported"),
        (0.25, -0.5, 0.18, 8.0, "clamped"),
    ],
)
def test_model_error_covers_finite_elements(
    thickness: float, nu: float, width: float, echoes: float, edge: str
) -> None:
    """Wide contacts, thick plates and a negative Poisson's ratio have larger model errors.

    Parameters
    ----------
    thickness
        Thickness of the plate over its radius [1].
    width, echoes
        Contact radius on a half-space over the thickness, and contact time there over the time of a
        pressure wave to the back face and back [1].
    """
    plate = Plate(0.01 / thickness, 0.01, 70e9, nu, 2500.0, edge)
    a, echo = width * plate.thickness, 2.0 * plate.thickness / plate.pressure_wave_speed
    R, time = 10.0 * a, echoes * echo
    speed = HERTZ * a * a / R / time
    mass = 16.0 / 15.0 * plate.modulus * math.sqrt(R) * (a * a / R) ** 2.5 / speed**2
    case = ElementCase("own", "own", plate, Sphere(R, mass, speed))
    tables = {
        "sphere": {"radius": R, "mass": mass}, "plate": asdict(plate), "impact": {"speed": speed},
        "effects": {"spherical_profile": False, "inertia": True},
    }  # fmt: skip
    result, (elements, _) = pc.simulate(pc.read(tables)), solve_impact(case, COARSER)
    for name in NAMES:
        stated = result.bound_of(name) + result.model_errors[name]
        assert abs(getattr(elements, name) / getattr(result, name) - 1.0) < stated
