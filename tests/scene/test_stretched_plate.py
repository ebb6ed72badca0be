"""Impacts on a plate that stretches, against an independent simulation and general properties."""

import math
from typing import Any

import numpy as np
import pytest

from derivation.scene import Result, SceneError, explain, read, simulate
from derivation.scene.dynamic.middle_plane import MiddlePlane
from derivation.scene.dynamic.modal import free_modes
from derivation.scene.dynamic.stretching_error import deflections_of, stretching_error
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.sweep import parse, run
from generated import stretching_kernels
from tests.scene.stretching_scenes import SCENES, moving, simulations
from tests.scene.test_materials import SCENES as MATERIALS

pytestmark = pytest.mark.one_version
NAMES = (
    "contact_time", "max_indentation", "max_force", "max_contact_radius", "restitution",
)  # fmt: skip
OWN = 5e-3
"""Error of the independent simulation, in addition to that without stretching [1]."""
HAIL = MATERIALS["hail of 25 mm on a bonnet, 20 m/s"]
STRETCHED: dict[str, Any] = {"effects": {"inertia": True, "stretching": True}}
LINEAR: dict[str, Any] = {"effects": {"stretching": False}}
SMALL = {
    "sphere": {"radius": 0.0104, "material": "steel"},
    "plate": {"radius": 0.0365, "thickness": 1.6e-3, "edge": "clamped", "material": "glass"},
    "impact": {"speed": 2.5},
}


@pytest.mark.parametrize("name", SCENES)
def test_impact_is_that_of_an_independent_simulation(name: str) -> None:
    """Only its frequencies and masses of modes are those of the program.

    It has few modes, so that without stretching it differs by up to 12 % in the force of a later
    contact, and by about 1 % otherwise.
    """
    stretched, linear = moving(name, stretching=True), moving(name)
    before, after = simulations(name, thick=True)
    assert stretched.complete
    assert stretched.dynamics is not None
    law = stretched.effects.law
    errors = stretching_error(law, stretched.dynamics, deflections_of(law, stretched.dynamics))
    for key in ("contact_time", "max_indentation", "max_force", "restitution"):
        own, off = (
            abs(getattr(result, key) / other[key] - 1.0)
            for result, other in ((linear, before), (stretched, after))
        )
        assert off <= stretched.accuracy.bound + errors[key] + own + OWN, key
    # Without stretching the indentation is as much larger in both simulations.
    deeper = linear.max_indentation / stretched.max_indentation
    assert deeper == pytest.approx(before["max_indentation"] / after["max_indentation"], abs=1e-3)
    assert deeper > 1.009


@pytest.mark.parametrize("name", ["several contacts with a clamped plate", "damped plate"])
def test_tensile_stress_includes_the_tension(name: str) -> None:
    linear, stretched = moving(name), moving(name, stretching=True)
    before, after = (one["max_tensile_stress"] for one in simulations(name))
    change = stretched.max_tensile_stress / linear.max_tensile_stress
    assert change == pytest.approx(after / before, rel=stretched.tensile_stress.error)
    assert after / before > 1.02


@pytest.mark.parametrize("name", SCENES)
def test_energy_balance_closes_with_stretching(name: str) -> None:
    """With damping, yield and viscosity; the plate keeps energy of bending and stretching."""
    balance = moving(name, stretching=True).energy_balance
    assert balance is not None
    assert abs(balance.residual) < 1e-6


@pytest.mark.parametrize("edge", ["clamped", "simply-supported", "paper"])
def test_slow_impacts_have_the_limit_of_a_linear_plate(edge: str) -> None:
    """The effect decreases as the square of the deflection."""
    plate, changes = SMALL["plate"] | {"edge": edge}, []
    for speed in (0.02, 0.01):
        scene = SMALL | {"plate": plate, "impact": {"speed": speed}, "inertia": {"modes": 24}}
        linear, stretched = (
            simulate(read(scene | {"effects": {"inertia": True, "stretching": on}})).max_indentation
            for on in (False, True)
        )
        changes.append(1.0 - stretched / linear)
    assert 0.0 < changes[0] < 1e-4
    assert changes[1] < 0.5 * changes[0]


@pytest.mark.parametrize("edge", ["clamped", "simply-supported", "paper"])
def test_forces_of_stretching_have_a_potential(edge: str) -> None:
    plane, modes = plane_of(edge)
    q = np.random.default_rng(1).normal(size=modes) / (1.0 + np.arange(modes)) ** 2
    steps = 1e-5 * np.eye(modes)
    slopes = (plane.energy(q + steps) - plane.energy(q - steps)) / 2e-5
    assert plane.forces(q) == pytest.approx(-slopes, rel=1e-7, abs=1e-7 * np.max(np.abs(slopes)))


@pytest.mark.parametrize("edge", ["clamped", "simply-supported", "paper"])
def test_energy_of_a_small_static_deflection_is_that_of_the_stiffening(edge: str) -> None:
    """P = k w (1 + A w^2/H^2) stores k A w^4/(4 H^2); A is proved without modes."""
    thin = SMALL["plate"] | {"edge": edge, "thickness": 4e-4}
    law = explain(read(SMALL | {"plate": thin} | STRETCHED)).effects.law
    problem = problem_of(law, 120)
    compliance = problem.contact.modes.by_shape(problem.inverse_modal_mass / problem.omega**2)
    stiffness = 1.0 / float(np.sum(compliance))
    assert problem.middle_plane is not None
    energy = float(problem.middle_plane.energy(stiffness * compliance))
    kinds = {"simply-supported": "supported"}
    of_edge = getattr(stretching_kernels, f"stiffening_{kinds.get(edge, edge)}")
    A = float(of_edge(np.array(law.model.poissons_ratio)))
    expected = 0.25 * stiffness * A * (problem.depth / (2.0 * law.model.h)) ** 2
    assert energy == pytest.approx(expected, rel=0.01)  # finite thickness, 48 shapes


def test_similar_scenes_have_similar_impacts() -> None:
    """With three times the lengths, times are three and forces nine times as large."""
    large = {
        table: {
            key: 3.0 * value if key in ("radius", "thickness") else value
            for key, value in keys.items()
        }
        for table, keys in SMALL.items()
    }
    one, three = (simulate(read(scene | STRETCHED), rtol=0.05) for scene in (SMALL, large))
    assert three.restitution == pytest.approx(one.restitution, rel=1e-7)
    assert three.max_force == pytest.approx(9.0 * one.max_force, rel=1e-7)
    assert three.total_time == pytest.approx(3.0 * one.total_time, rel=1e-7)
    assert three.max_tensile_stress == pytest.approx(one.max_tensile_stress, rel=1e-6)


def test_hail_on_a_bonnet_is_usable_with_stretching() -> None:
    linear, stretched = (simulate(read(HAIL | part)) for part in (LINEAR, STRETCHED))
    text = " ".join(str(linear).split())
    assert "NOT USABLE" in text
    assert "neglects without effects.stretching = true" in text
    assert "NOT USABLE" not in str(stretched)
    assert stretched.complete
    assert stretched.max_indentation < 0.8 * linear.max_indentation
    assert not any("stretching" in warning for warning in stretched.warnings)
    assert "stretching" in stretched.effects.included


def test_tighter_tolerance_agrees_within_the_bound_of_a_looser_one() -> None:
    loose, tight = (simulate(read(HAIL | STRETCHED), rtol=rtol) for rtol in (0.1, 0.01))
    for key in NAMES:
        change = abs(getattr(loose, key) / getattr(tight, key) - 1.0)
        assert change <= loose.accuracy.bound + tight.accuracy.bound, key


def test_history_is_continuous_in_flight_and_after_it() -> None:
    result = simulate(read(SMALL | STRETCHED), rtol=0.05)
    assert result.dynamics is not None
    contacts = result.dynamics.inertia.contacts
    assert len(contacts) > 1
    for touching in contacts[:-1]:
        around = touching.end * (1.0 + 1e-9 * np.array([-1.0, 1.0]))
        before, after = result.dynamics.rows(around).T
        assert after == pytest.approx(before, rel=1e-5, abs=1e-6 * np.max(np.abs(before)))
    times = np.linspace(0.0, result.total_time, 7)
    profiles = result.dynamics.profiles(times, np.zeros(1))[:, 0]
    deflections = result.dynamics.rows(times)[4]
    assert profiles == pytest.approx(deflections, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("time", [1e-4, 3e-4])
def test_contact_with_a_face_that_has_not_recovered_is_simulated(time: float) -> None:
    """A slow impact agrees with that of a linear plate, also in the radius of a later contact."""
    scene = {
        "sphere": {"radius": 0.01, "mass": 0.3, "material": "steel"},
        "plate": {"radius": 0.1, "thickness": 0.004, "material": "PMMA", "edge": "clamped",
                  "retardation_time": time},
        "inertia": {"modes": 16},
    }  # fmt: skip

    def impact(speed: float, stretching: bool) -> Result:
        effects = {"inertia": True, "viscosity": True, "stretching": stretching}
        return simulate(read(scene | {"impact": {"speed": speed}, "effects": effects}))

    fast = impact(1.0, True)
    assert fast.complete
    assert fast.energy_balance is not None
    assert abs(fast.energy_balance.residual) < 1e-11
    assert fast.dynamics is not None
    assert fast.dynamics.impact_history.contacts[1].radius > 0.1
    one, other = (impact(0.02, stretching) for stretching in (True, False))
    assert one.restitution == pytest.approx(other.restitution, rel=1e-3)
    assert one.max_force == pytest.approx(other.max_force, rel=1e-2)


def test_recovering_face_is_moved_by_all_modes() -> None:
    """An earlier version neglected those that do not stretch the plate: five contacts, not two."""
    plate = {
        "radius": 0.1, "thickness": 0.004, "material": "PMMA", "edge": "clamped",
        "retardation_time": 1e-4,
    }  # fmt: skip
    scene = {
        "sphere": {"radius": 0.01, "mass": 0.3, "material": "steel"},
        "plate": plate,
        "impact": {"speed": 4.0},
        "effects": {"inertia": True, "viscosity": True, "stretching": True},
    }
    starts = []
    for modes in 48, 64:  # only 48 shapes stretch the plate
        result = simulate(read(scene | {"inertia": {"modes": modes}}))
        assert result.dynamics is not None
        starts.append([one.start for one in result.dynamics.inertia.contacts])
    assert starts[0] == pytest.approx(starts[1], rel=1e-2)


def test_approach_speed_of_later_contacts_is_that_of_the_history() -> None:
    """The speed of sphere and plate just before each contact, by differences of their history."""
    result = moving("paper's edge", stretching=True)
    assert result.dynamics is not None
    for touching in result.dynamics.inertia.contacts[1:]:
        step = 1e-4 * result.contact_time
        displacement, deflection = result.dynamics.rows(touching.start - step * np.arange(2))[
            [2, 4]
        ]
        speed = -np.diff(displacement - deflection)[0] / step
        expected = touching.relative_approach_speed * result.model.v0
        assert speed == pytest.approx(expected, rel=0.02)


def test_explanation_and_messages_name_the_effect() -> None:
    rows = {row.name: row for row in explain(read(SMALL | LINEAR)).effects.rows}
    assert not rows["stretching"].included
    assert "model error" in rows["stretching"].reason
    included = {row.name: row for row in explain(read(SMALL | STRETCHED)).effects.rows}
    assert included["stretching"].included
    infinite = SMALL | STRETCHED | {"inertia": {"extent": "infinite"}}
    with pytest.raises(SceneError, match=r"effects\.stretching = true does not apply: .* infinite"):
        simulate(read(infinite))
    still = SMALL | {"effects": {"inertia": False, "stretching": True}}
    with pytest.raises(SceneError, match=r"effects\.stretching = true requires effects\.inertia"):
        simulate(read(still))
    with pytest.raises(SceneError, match=r"effects\.stretching: expected"):
        read(SMALL | {"effects": {"stretching": "always"}})


def test_rows_of_a_sweep_equal_simulations() -> None:
    scene = read(SMALL | STRETCHED)
    [row, _] = run(scene, parse("impact.speed=2:2.5:2"), rtol=0.05)
    result = simulate(read(SMALL | STRETCHED | {"impact": {"speed": 2.0}}), rtol=0.05)
    for key in NAMES:
        assert row.results[key] == getattr(result, key)


def plane_of(edge: str) -> tuple[MiddlePlane, int]:
    """Return the middle plane of a plate in units of 1 m and 1 N, and its number of modes."""
    scene = read(SMALL | {"plate": SMALL["plate"] | {"edge": edge}} | STRETCHED)
    model = explain(scene).effects.law.model
    return MiddlePlane.of(model, free_modes(model, 12), 1.0, math.pi), 12
