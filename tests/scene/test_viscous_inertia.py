"""Plate inertia in viscoelastic contacts: omitting it changes no result beyond the bound."""

from dataclasses import replace
from typing import Any

import pytest

from derivation.checks import inertia as inertia_check
from derivation.checks import inertia_rows as random_scenes
from derivation.scene import read, simulate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import waves
from derivation.scene.model import InertiaSettings, model_of
from derivation.scene.scene import OUTPUTS

pytestmark = pytest.mark.one_version

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
    """The bound also covers strongly viscoelastic contacts, where inertia changes much."""
    plate = SOFT_BLOCK["plate"] | {"retardation_time": retardation_time}
    scene = SOFT_BLOCK | {"plate": plate, "effects": {"inertia": "auto"}}
    with_inertia = scene | {"effects": {"inertia": True}}
    result, reference = simulate(read(scene), rtol=rtol), simulate(read(with_inertia), rtol=0.02)
    for name in OUTPUTS:
        off = abs(getattr(result, name) / getattr(reference, name) - 1.0)
        assert off <= result.accuracy.bound + reference.accuracy.bound


@pytest.mark.parametrize(("number", "modes"), [(183, 8), (1017, 32)])
def test_error_of_the_force_at_the_onset_causes_no_separation(number: int, modes: int) -> None:
    """There is one contact; an earlier version stated a separate first one of 1e-18 s."""
    data, _ = random_scenes.scene(number, seed=3)
    model = replace(model_of(read(data)), inertia=InertiaSettings(modes=modes, branches="A0"))
    result = waves.impact(ContactLaw(model, inertia_check.selectable_effects(model)), 1e-4)
    assert len(result.inertia.contacts) == 1
    assert 0.5 < result.contact_time * model.v0 / result.max_indentation < 50.0


LIGHT_PLATE: dict[str, Any] = {
    "sphere": {"radius": 0.02, "density": 6400.0, "material": "glass"},
    "plate": {"radius": 0.1, "thickness": 1.2e-3, "youngs_modulus": 8.4e11, "poissons_ratio": 0.45,
              "density": 192.0, "edge": "simply-supported", "retardation_time": 3e-6},
    "impact": {"speed": 1.2e-3},
}  # fmt: skip


def test_bound_without_viscosity_covers_oscillations_within_the_contact() -> None:
    """The contact lasts while sphere and plate oscillate on its stiffness, which changes the force.

    An earlier version stated 2e-3 for a change of the force by 1.5e-2.
    """
    elastic, viscous = (
        simulate(
            read(
                LIGHT_PLATE
                | {"effects": {"inertia": True, "viscosity": viscosity}}
                | {"inertia": {"branches": "A0"}}
            )
        )
        for viscosity in (False, True)
    )
    assert elastic.dynamics is not None
    assert len(elastic.dynamics.inertia.contacts) == 1
    [row] = [row for row in elastic.effects.rows if row.name == "viscosity"]
    changes = [abs(getattr(elastic, name) / getattr(viscous, name) - 1.0) for name in OUTPUTS]
    assert 5e-3 < max(changes) < row.bound + elastic.accuracy.bound + viscous.accuracy.bound
