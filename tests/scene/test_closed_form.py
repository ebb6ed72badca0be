"""Impacts in closed form on a plate that only bends, against time integrals and two limits."""

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from derivation.scene import read
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.impact import selected_effects
from derivation.scene.quasi_static.closed_form import bend_of, closed_form
from derivation.scene.selection.method_selection import moved

OMITTED = "inertia", "non_hertzian_pressure", "spherical_profile"
ONLY = dict.fromkeys((*OMITTED, "finite_thickness", "finite_radius"), False)


def law_of(thickness: float, speed: float = 1e-3, material: str | None = None) -> ContactLaw:
    """Return the law of a sphere, rigid without a material, on a plate that only bends."""
    sphere: dict[str, Any] = {"radius": 0.01, "mass": 0.03}
    scene = {
        "sphere": sphere | ({"material": material} if material else {}),
        "plate": {"radius": 0.3, "thickness": thickness, "material": "glass"},
        "impact": {"speed": speed},
        "effects": ONLY,
    }
    return selected_effects(read(scene))[1].law


@given(st.floats(-3.0, 0.0), st.floats(-4.0, -2.0), st.sampled_from([None, "steel", "rubber"]))
def test_results_are_those_of_integrals_over_the_motion(
    thickness: float, speed: float, material: str | None
) -> None:
    law = law_of(10.0**thickness, 10.0**speed, material)
    found = closed_form(law)
    assert found is not None
    assert found[:4] == pytest.approx(moved(law).numbers[:4], rel=1e-12)
    assert found.quadrature + found.rounding < 1e-13


def test_a_thin_plate_is_a_linear_spring_and_a_thick_one_a_half_space() -> None:
    thin, thick = law_of(2e-4), law_of(20.0)
    model, found = thin.model, closed_form(thin)
    assert found is not None
    # Bending alone: delta = bend a^3/(R h) and P = (4/3) E* a^3/R.
    stiffness = 4.0 / 3.0 * thin.modulus * model.h / float(bend_of(thin)[0])
    assert found.contact_time == pytest.approx(math.pi * math.sqrt(model.m / stiffness), rel=1e-3)
    assert found.max_force == pytest.approx(1e-3 * math.sqrt(model.m * stiffness), rel=1e-3)
    half_space, hertz = closed_form(thick), closed_form(thick.half_space)
    assert half_space is not None
    assert hertz is not None
    assert half_space[:4] == pytest.approx(hertz[:4], rel=1e-6)
