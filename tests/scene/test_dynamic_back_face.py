"""Tensile stress on the back face of a plate with inertia, against limits and other routes."""

import math
from dataclasses import replace

import numpy as np
import platecontact as pc
import pytest
from scipy.integrate import quad

from derivation.scene.dynamic import back_face as stresses
from derivation.scene.dynamic.mode_count import branching
from derivation.scene.impact import selected_effects

pytestmark = pytest.mark.one_version


def scene(edge: str = "paper", inertia: bool = True, **given: float) -> pc.Scene:
    keys = {"radius": 0.01, "b": 0.3, "H": 0.008, "speed": 2.0, "loss": 0.0} | given
    return pc.Scene(
        sphere=pc.Sphere(radius=keys["radius"], material="steel"),
        plate=pc.Plate(
            radius=keys["b"], thickness=keys["H"], material="glass", edge=edge,
            loss_factor=keys["loss"],
        ),
        impact=pc.Impact(speed=keys["speed"]),
        effects=pc.Effects(inertia=inertia),
    )  # fmt: skip


def impact(edge: str = "paper", inertia: bool = True, **given: float) -> pc.Result:
    return pc.simulate(scene(edge, inertia, **given))


def waves_of(loss: float = 0.0) -> stresses._Waves:
    """Return the waves of a plate with 8 bending modes and those of all other branches."""
    law = branching(selected_effects(scene(loss=loss))[1].law, "all")
    return stresses._Waves.of(law, 8, 1e-3)


def test_the_edge_has_no_effect_before_a_wave_has_returned() -> None:
    found = [impact(edge).max_tensile_stress for edge in ("paper", "clamped", "simply-supported")]
    assert found == pytest.approx([found[0]] * 3, rel=5e-4)
    static = impact().effects.law.max_tensile_stress(impact().max_contact_radius, 1.0)
    assert found[0] < 0.6 * static * impact().max_force


def test_stress_of_a_thin_plate_is_that_of_an_integral_over_wave_numbers() -> None:
    """The integral is over the bending waves of an infinite thin plate under Hertz's pressure."""
    result = impact(H=0.002, b=0.3, radius=0.004, speed=0.5)
    law, motion = result.effects.law, result.dynamics
    assert motion is not None
    m = law.model
    H, E, nu = 2.0 * m.h, 2.0 * m.mu * (1.0 + m.poissons_ratio), m.poissons_ratio
    stiff = E * H**3 / (12.0 * (1.0 - nu**2))
    peak = float(motion.histories[0][3].argmax()) / (motion.histories[0].shape[1] - 1)
    now = peak * result.contact_time
    times = np.linspace(0.0, now, 2001)
    force = motion.rows(times)[3]
    a = result.max_contact_radius
    static = law.max_tensile_stress(a, float(force[-1]), on_edge=False)

    def dynamic_part(k: float) -> float:
        """Return the moment of one wave number minus its static value."""
        omega = k * k * math.sqrt(stiff / (m.density * H))
        answer = np.trapezoid(np.gradient(force, times) * np.cos(omega * (now - times)), times)
        y = k * a
        hertz = 3.0 * (math.sin(y) - y * math.cos(y)) / y**3
        return -float(answer) * hertz / k

    # sigma = E H k^2/(4 (1 - nu)) w, and w = P k dk/(2 pi rho H omega^2).
    factor = E * H / (4.0 * (1.0 - nu)) / (2.0 * math.pi * stiff)
    first = 2.404825557695773 / m.b
    moved = factor * quad(dynamic_part, 0.5 * first, 12.0 / m.h, limit=2000)[0]
    course = stresses._stress_history(motion, law, 400)
    found = float(np.interp(now, *course))
    assert moved < -0.2 * static  # the response is far from static
    assert found == pytest.approx(static + moved, rel=0.03)


def test_slow_impact_has_the_static_stress() -> None:
    for edge in ("paper", "clamped", "simply-supported"):
        result = impact(edge, b=0.02, H=0.006, radius=0.05, speed=0.01)
        static = result.effects.law.max_tensile_stress(result.max_contact_radius, result.max_force)
        assert result.max_tensile_stress == pytest.approx(static, rel=0.006), edge
        assert not result.tensile_stress.static


def test_no_stress_before_a_pressure_wave_has_crossed_the_thickness() -> None:
    result = impact(b=0.25, H=0.1, radius=0.008, speed=3.0)
    m, motion = result.model, result.dynamics
    assert motion is not None
    crossed = 2.0 * m.h / math.sqrt((m.lam + 2.0 * m.mu) / m.density)
    inertia = replace(motion.law.model.inertia, branches="all", modes=0)
    law = replace(motion.law, model=replace(motion.law.model, inertia=inertia))
    course = stresses._stress_history(motion, law, 160)
    before = course.times < 0.9 * crossed
    assert before.sum() > 100
    peak = float(np.max(np.abs(course.stress)))
    assert np.max(np.abs(course.stress[before])) < 0.01 * peak


def test_damping_lowers_the_stress_and_vanishes_with_the_loss_factor() -> None:
    free, slightly, strongly = (
        impact(b=0.05, loss=loss).max_tensile_stress for loss in (0.0, 1e-6, 0.1)
    )
    assert slightly == pytest.approx(free, rel=1e-5)
    assert strongly < 0.995 * free


def test_response_to_a_linear_force_is_exact() -> None:
    """One mode under P = t: q = c (t - sin(omega t)/omega)."""
    waves = waves_of()
    times = np.linspace(0.0, 3.0 / float(waves.plate.modes.omega[0]), 40)
    a = np.full(times.size, 1e-6)
    found, _ = waves.driven(np.zeros(waves.decay.size, dtype=complex), times, a, times)
    modes, shares = (
        waves.plate.modes,
        waves.modal_force_ratios(waves.plate.modes, a)[0][waves.plate.modes.shape],
    )
    each = stresses.wave_stresses(waves.law.model, modes) * modes.compliances
    swing = np.sin(np.multiply.outer(times, modes.omega)) / modes.omega
    exact = times * waves.remainder(a) + (times[:, None] - swing) @ (each * shares)
    assert found == pytest.approx(exact, rel=1e-9, abs=1e-9 * float(np.max(exact)))


def test_a_plate_with_too_many_modes_is_replaced_by_a_narrower_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    motion = impact().dynamics
    assert motion is not None
    whole = stresses.back_face(motion)
    monkeypatch.setattr(stresses, "MODES", 10)
    narrow = stresses.back_face(motion)
    assert narrow.stress != whole.stress
    assert narrow.stress == pytest.approx(whole.stress, rel=2e-3)


def test_free_flight_is_the_sum_of_decaying_vibrations() -> None:
    waves = waves_of(loss=0.1)
    times = np.linspace(1e-3, 1e-3 + 5.0 / float(waves.plate.modes.omega[0]), 37)
    z = np.exp(1j * np.arange(waves.decay.size))
    found, after = waves.flown(z, times)
    each = [z * np.exp(waves.decay * (t - times[0])) for t in times]
    assert found == pytest.approx([float(x.imag @ waves.weights) for x in each], rel=1e-9)
    assert after == pytest.approx(each[-1])


def test_damped_plate_tends_to_the_static_stress_under_a_constant_force() -> None:
    waves = waves_of(loss=0.8)
    times = np.linspace(0.0, 60.0 / float(waves.plate.modes.omega[0]), 4000)
    a = np.full(times.size, 1e-6)
    found, _ = waves.driven(np.zeros(waves.decay.size, dtype=complex), times, a, 1.0 + 0.0 * times)
    static = waves.law.max_tensile_stress(1e-6, 1.0, on_edge=False)
    assert found[-1] == pytest.approx(static, rel=1e-6)
    assert found[0] < 0.5 * static


@pytest.mark.parametrize("edge", ["paper", "clamped", "simply-supported"])
def test_error_of_a_slow_impact_covers_the_vibration_that_a_static_plate_omits(edge: str) -> None:
    slow = {"b": 0.02, "H": 0.004, "radius": 0.05, "speed": 0.01}
    still, moving = impact(edge, inertia=False, **slow), impact(edge, **slow)
    assert not still.tensile_stress.static
    change = abs(still.max_tensile_stress / moving.max_tensile_stress - 1.0)
    assert 2e-4 < change < still.tensile_stress.error


@pytest.mark.parametrize(
    ("edge", "H", "difference"),
    [
        ("paper", 0.04, 0.0),
        ("clamped", 0.008, 7e-4),
        ("clamped", 0.04, 0.016),
        ("clamped", 0.08, -0.11),
    ],
)
def test_static_stress_of_all_waves_has_a_different_edge_term(
    edge: str, H: float, difference: float
) -> None:
    """Only bending modes below their cut-off depend on the edge of the scene.

    For a slow impact on a clamped plate with h/b = 0.25, an earlier version stated an error of 1 %;
    the stress was 1.5 % above the static one.
    """
    law = branching(selected_effects(scene(edge, b=0.08, H=H))[1].law, "all")
    a = np.array([0.1 * law.model.h])
    waves = stresses._Waves.of(law, 40, float(a[0]))
    [static] = law.tensile_stresses(a, np.ones(1))
    [found] = waves.static(a)
    assert found / static - 1.0 == pytest.approx(difference, rel=0.1, abs=1e-9)


def test_error_of_the_stress_includes_the_missing_edge_term() -> None:
    result = impact("clamped", b=0.04, H=0.04, speed=0.5)
    motion, [a] = result.dynamics, [np.array([result.max_contact_radius])]
    assert motion is not None
    law, echo = motion.law, stresses.echo_time(motion.law.model)
    assert motion.inertia.total_time > echo
    waves = stresses._Waves.of(branching(law, "all"), 40, float(a[0]))
    missing = float((waves.static(a) - law.tensile_stresses(a, np.ones(1)))[0]) * result.max_force
    assert motion.back_face.on_edge == pytest.approx(
        abs(missing) / result.max_tensile_stress, rel=1e-2
    )
    assert result.tensile_stress.error > motion.back_face.on_edge > 0.1
