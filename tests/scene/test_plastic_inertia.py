"""Plate inertia in plastic contacts: omissions change results by no more than their bound."""

import math
import re
from dataclasses import replace
from random import Random
from typing import Any

import pytest

from derivation.checks import inertia as inertia_check
from derivation.scene import Inertia, read, simulate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import contact_errors, waves
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.effects import PAPER
from derivation.scene.errors import ToleranceError
from derivation.scene.model import InertiaSettings, Model
from derivation.scene.result import Result
from derivation.scene.scene import OUTPUTS, SceneError

pytestmark = pytest.mark.one_version

DISC: dict[str, Any] = {
    "sphere": {"radius": 1.681, "density": 100.3, "material": "aluminium"},
    "plate": {"radius": 1.569, "half_thickness": 0.1618, "youngs_modulus": 4.952e11,
              "poissons_ratio": -0.4777, "density": 183.5, "edge": "simply-supported",
              "yield_stress": 6.389e6},
    "impact": {"speed": 7.221e-4},
}  # fmt: skip
"""The plate vibrates little, but the plastic contact loses 58 % of the speed."""

BLOCK: dict[str, Any] = {
    "sphere": {"radius": 0.1969, "density": 15543.0, "material": "glass"},
    "plate": {"radius": 0.2484, "half_thickness": 0.0981, "youngs_modulus": 2.74e10,
              "poissons_ratio": -0.4912, "density": 306.5, "yield_stress": 1.174e7},
    "impact": {"speed": 8.58e-3},
}  # fmt: skip
"""Waves cross the thickness much faster than the contact lasts."""


def largest_difference(result: Result, reference: Result) -> float:
    return max(abs(getattr(result, name) / getattr(reference, name) - 1.0) for name in OUTPUTS)


def test_bound_on_omitted_inertia_covers_the_plastic_loss() -> None:
    """Without the plastic loss, the bound would be 5.7e-4 for a change of 6.1e-4."""
    others = dict.fromkeys(("bending", "finite_thickness", "edge", "non_hertzian_pressure"), True)
    result = simulate(read(DISC | {"effects": others | {"inertia": "auto"}}), rtol=0.01)
    assert result.energy_balance is not None
    assert result.energy_balance.plate == 0.0
    reference = simulate(read(DISC | {"effects": others | {"inertia": True}}), rtol=1e-4)
    assert 1e-4 < largest_difference(result, reference) <= 0.5 * result.accuracy.bound


def test_bound_on_omitted_branches_covers_the_plastic_loss() -> None:
    """Without the plastic loss, the bound would be 1.3e-6 for a change of 2.0e-6."""
    result, reference = (
        simulate(read(BLOCK | {"effects": {"inertia": True}, "inertia": {"branches": branches}}))
        for branches in ("A0", "all")
    )
    assert 1e-6 < largest_difference(result, reference) <= 0.5 * result.accuracy.bound


ENDED_EARLY = (210, 213, 224, 243, 336, 395, 409, 452)
"""Scenes of `plastic_model` in which loading ended before the largest radius by 1e-7 of a step."""


def plastic_model(number: int) -> Model:
    """Return a random steel plate under a sphere that yields strongly."""
    generator = Random(f"rob {number}")

    def spread(low: float, high: float) -> float:
        return low * (high / low) ** generator.random()

    h, E = 0.05, 2e11
    b, nu = h * spread(1.5, 8.0), generator.uniform(0.0, 0.45)
    mu = E / 2.0 / (1.0 + nu)
    R, density, speed = h * spread(0.05, 3.0), 7800.0 * spread(0.3, 3.0), spread(1e-2, 10.0)
    stress = E * (density * speed**2 / E) ** 0.2 * spread(0.01, 0.3)
    branches = generator.choice(["A0", "all"])
    settings = InertiaSettings(modes=generator.choice([6, 12, 20]), branches=branches)
    return Model(
        R=R, m=density * 4.0 / 3.0 * math.pi * R**3, v0=speed, h=h, b=b,
        lam=2.0 * mu * nu / (1.0 - 2.0 * nu), mu=mu, density=7800.0, edge="paper",
        yield_stress=stress, inertia=settings,
    )  # fmt: skip


@pytest.mark.parametrize("number", [*ENDED_EARLY, *range(12)])
def test_plastic_contact_on_a_vibrating_plate_is_complete(number: int) -> None:
    model = plastic_model(number)
    effects = inertia_check.selectable_effects(model) - {"non_hertzian_pressure"}
    result = waves.impact(ContactLaw(model, effects), 1e-4)
    assert result.inertia.complete
    assert 0.0 < result.restitution < 1.0
    assert abs(result.energy_balance.residual) < 1e-6


SHARP = Model(
    R=0.0787943, m=6.85274, v0=0.253529, h=0.05, b=0.154237, lam=1.34022e10, mu=9.41341e10,
    density=7800.0, edge="paper", yield_stress=5.28245e7,
    inertia=InertiaSettings(modes=300, branches="A0"),
)  # fmt: skip
"""Fast modes bend the plate more sharply than the dented contact: the approach becomes negative."""


def test_a_contact_ends_when_its_force_is_zero_even_if_the_approach_is_negative() -> None:
    """An earlier version ended it at its largest force, with an energy-balance error of 1.2e3."""
    result, fewer = (
        waves.impact(
            ContactLaw(model, inertia_check.selectable_effects(model) - {"non_hertzian_pressure"}),
            1e-2,
        )
        for model in (SHARP, replace(SHARP, inertia=InertiaSettings(modes=100, branches="A0")))
    )
    assert result.inertia.complete
    assert abs(result.energy_balance.residual) < 1e-9
    assert abs(result.restitution / fewer.restitution - 1.0) < 2e-5


def test_error_of_a_result_in_which_two_runs_agree_by_chance() -> None:
    """Contact times with 5 and 10 modes agree to 7e-6; with 40 modes it changes by 5e-5."""
    scene = {
        "sphere": {
            "radius": 0.004615, "density": 2097.0, "youngs_modulus": 2.029e11, "poissons_ratio": 0.3
        },
        "plate": {
            "radius": 0.0227, "half_thickness": 5.941e-4, "youngs_modulus": 3.203e10,
            "poissons_ratio": 0.3211, "density": 5686.0, "yield_stress": 2.273e7,
            "retardation_time": 4.081e-6, "loss_factor": 0.001586,
        },
        "impact": {"speed": 9.077e-4, "gravity": 0.2535},
        "effects": {"inertia": True, "non_hertzian_pressure": False},
    }  # fmt: skip
    result, finer = (
        simulate(read({**scene, "inertia": {"branches": "A0", "modes": modes}}))
        for modes in (10, 40)
    )
    assert result.dynamics is not None
    by_modes, _ = result.dynamics.inertia.left(("contact_time",))
    assert 4e-5 < abs(result.contact_time / finer.contact_time - 1.0) < by_modes < 4e-3


def test_message_on_stiff_unloading_does_not_mention_the_plate_curvature() -> None:
    scene = {
        "sphere": {"radius": 0.00378, "mass": 7.72e-4},
        "plate": {"radius": 0.00425, "thickness": 7.31e-4, "youngs_modulus": 2.58e9,
                  "poissons_ratio": 0.35, "density": 4685.0, "yield_stress": 8.257e5},
        "impact": {"speed": 0.01266},
        "inertia": {"modes": 60, "branches": "all"},
    }  # fmt: skip
    with pytest.raises(SceneError, match="unloads more stiffly") as rejected:
        simulate(read(scene))
    remedy = r"fewer modes without a tolerance, such as inertia\.modes = (\d+), "
    named = re.search(remedy + r'or inertia\.branches = "A0"$', str(rejected.value))
    assert named
    assert simulate(read(scene | {"inertia": {"modes": int(named[1]), "branches": "all"}})).complete
    mended = simulate(read(scene | {"inertia": {"modes": 60, "branches": "A0"}}))
    few = simulate(read(scene | {"inertia": {"modes": 17, "branches": "A0"}}))
    assert mended.complete
    assert largest_difference(mended, few) < 1e-3


@pytest.mark.parametrize("modes", [2, 3, 4, 9])
def test_message_on_stiff_unloading_names_only_numbers_of_modes_that_are_accepted(
    modes: int,
) -> None:
    """An earlier message recommended a single mode, which is not accepted."""
    law = ContactLaw(plastic_model(0), PAPER | {"inertia", "plasticity"})
    error = contact_errors._stiff_unloading(problem_of(law, modes), 0.0)
    found = re.search(r"such as inertia\.modes = (\d+)", str(error))
    assert bool(found) == (modes >= 4)
    if found:
        assert Inertia(modes=int(found[1])).modes == modes // 2


def test_plate_has_no_more_modes_than_a_stiff_unloading_allows() -> None:
    """The error is that of the modes for which there is a solution, and a finer run meets it."""
    scene = {
        "sphere": {"radius": 0.0125, "material": "ice"},
        "plate": {"radius": 0.1, "thickness": 0.002, "material": "PMMA", "edge": "clamped",
                  "yield_stress": 1e6},
        "impact": {"speed": 1.0},
        "effects": {"stretching": False},  # which multiplies the run time
    }  # fmt: skip
    result = simulate(read(scene | {"inertia": {"branches": "A0"}}))
    assert result.dynamics is not None
    count = result.dynamics.inertia.modes

    def with_modes(modes: int) -> Result:
        return simulate(read(scene | {"inertia": {"branches": "A0", "modes": modes}}))

    with pytest.raises(SceneError, match="unloads more stiffly") as rejected:
        with_modes(2 * count + 1)
    # An earlier message also recommended the branch A0, which was the only one.
    assert str(rejected.value).endswith(f"without a tolerance, such as inertia.modes = {count}")
    finer = with_modes(3 * count // 2)
    for name in ("contact_time", "max_indentation", "max_force", "restitution"):
        before, after = getattr(result, name), getattr(finer, name)
        assert abs(before / after - 1.0) <= min(result.bound_of(name), 0.01)


def test_too_many_chosen_modes_lead_to_the_automatic_number() -> None:
    """An earlier message named a number of modes only, with which there is no solution either."""
    scene = {
        "sphere": {"radius": 0.0202, "density": 4290.0},
        "plate": {"radius": 0.0296, "thickness": 0.0137, "youngs_modulus": 2.14e10,
                  "poissons_ratio": 0.3, "density": 839.0, "yield_stress": 1.08e7},
        "impact": {"speed": 0.838},
    }  # fmt: skip
    with pytest.raises(SceneError, match=r'try inertia\.modes = "auto", or fewer') as rejected:
        simulate(read(scene | {"inertia": {"modes": 63}}))
    fewer = int(str(rejected.value).rpartition(" = ")[2])
    assert simulate(read(scene | {"inertia": {"modes": fewer}})).complete
    assert simulate(read(scene)).accuracy.bound < 1e-3


def test_fewer_modes_after_a_stiff_unloading_are_tried_without_a_tolerance() -> None:
    """An earlier message named a number of modes that a tolerance does not allow."""
    scene = {
        "sphere": {"radius": 0.002263, "density": 1432.0},
        "plate": {"radius": 0.009019, "thickness": 2.769e-4, "youngs_modulus": 2.933e10,
                  "poissons_ratio": 0.2, "density": 1389.0, "edge": "simply-supported",
                  "yield_stress": 5.847e6},
        "impact": {"speed": 6.744},
        "effects": {"stretching": False},
        "inertia": {"branches": "A0"},
    }  # fmt: skip
    with pytest.raises(SceneError, match="fewer modes without a tolerance") as rejected:
        simulate(read(scene | {"accuracy": {"rtol": 0.01}}))
    fewer = {"branches": "A0", "modes": int(str(rejected.value).rpartition(" = ")[2])}
    with pytest.raises(SceneError, match="modes with a tolerance"):
        simulate(read(scene | {"accuracy": {"rtol": 0.01}, "inertia": fewer}))
    assert simulate(read(scene | {"inertia": fewer})).complete


def test_a_number_of_modes_in_a_message_on_stiff_unloading_has_a_solution() -> None:
    """An earlier message named half the modes, and that with them half of these, up to none."""
    scene: dict[str, Any] = {
        "sphere": {
            "radius": 0.02583, "mass": 0.03194, "youngs_modulus": 9.79e9, "poissons_ratio": 0.3,
        },
        "plate": {
            "radius": 0.04486, "thickness": 0.02151, "youngs_modulus": 1.568e9,
            "poissons_ratio": 0.334, "density": 5682.0, "yield_stress": 9.9e5,
        },
        "impact": {"speed": 0.8045},
    }  # fmt: skip
    with pytest.raises(SceneError, match="fewer modes without a tolerance") as rejected:
        simulate(read(scene | {"inertia": {"modes": 24}}))
    named = re.search(r"such as inertia\.modes = (\d+)", str(rejected.value))
    assert named
    assert simulate(read(scene | {"inertia": {"modes": int(named[1])}})).complete


def test_no_number_of_modes_is_recommended_if_none_has_a_solution() -> None:
    scene: dict[str, Any] = {
        "sphere": {"radius": 0.002615, "material": "glass"},
        "plate": {
            "radius": 0.003941, "thickness": 4.04e-4, "youngs_modulus": 1.1975e9,
            "poissons_ratio": 0.291, "density": 5857.0, "edge": "clamped", "yield_stress": 3.498e6,
        },
        "impact": {"speed": 4.328},
    }  # fmt: skip
    with pytest.raises(SceneError, match="unloads more stiffly") as rejected:
        simulate(read(scene | {"inertia": {"modes": 24}}))
    assert "fewer modes" not in str(rejected.value)
    assert "a lower impact.speed, or effects.plasticity = false" in str(rejected.value)
    for modes in (12, 5):
        with pytest.raises(SceneError):
            simulate(read(scene | {"inertia": {"modes": modes}}))


def test_stiff_unloading_with_the_pointwise_coupling_has_no_error_estimate() -> None:
    """Its results do not converge with the number of modes."""
    scene = {
        "sphere": {"radius": 3e-4, "material": "steel", "yield_stress": 1.2e9},
        "plate": {"radius": 0.02, "thickness": 0.005, "material": "aluminium 6061-T6"},
        "impact": {"speed": 60.0},
        "inertia": {"coupling": "pointwise"},
    }
    with pytest.raises(SceneError, match="unloads more stiffly"):
        simulate(read(scene))


def test_tolerance_that_a_stiff_unloading_prevents_names_one_that_is_met() -> None:
    scene = {
        "sphere": {"radius": 3e-4, "material": "steel", "yield_stress": 1.2e9},
        "plate": {"radius": 0.02, "thickness": 0.005, "material": "aluminium 6061-T6"},
        "impact": {"speed": 60.0},
    }
    with pytest.raises(ToleranceError) as rejected:
        simulate(read(scene | {"accuracy": {"rtol": 0.01}}))
    stated = re.search(r"such as ([-\d.e]+)", str(rejected.value))
    assert stated
    named = float(stated[1])
    assert simulate(read(scene | {"accuracy": {"rtol": named}})).accuracy.bound <= named


def test_small_first_change_of_a_yielded_contact_is_confirmed_by_another_run() -> None:
    """The restitution of 18 modes differs from that of 9 and 37 by less than from that of 72."""
    scene = {
        "sphere": {"radius": 0.005108694630247956, "material": "steel"},
        "plate": {"radius": 0.07610296701480083, "thickness": 0.0212980612791213,
                  "material": "aluminium 6082-T6", "yield_stress": 38985153.08932461},
        "impact": {"speed": 2.278894832667437},
    }  # fmt: skip
    result = simulate(read(scene))
    finer = simulate(read(scene | {"inertia": {"modes": 72, "branches": "all"}}))
    assert abs(result.restitution / finer.restitution - 1.0) <= result.bound_of("restitution")
