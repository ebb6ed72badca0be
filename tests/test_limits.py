"""Where the law is refused or warned of: each limit from both sides, with its number."""

import math

import hertz_double as hertz
import numpy as np
import pytest
from given import ALL, changed, model, scene, thick

from derivation.scene import (
    SceneError,
    kernels,
    limits,
    read,
    simulate,
)
from derivation.scene.law import CURVED, HELD, WHOLE_PLATE, Law
from derivation.scene.model import model_of


def test_the_edges_model_error_is_said_and_refused() -> None:
    held = {"edge": "clamped", "half_thickness": 0.01}
    result = simulate(scene(plate=held))
    assert 0 < result.model_error < 0.01
    assert "beside this bound" in result.model_note
    assert result.to_json()["model_error"] == result.model_error
    with pytest.raises(SceneError, match="expected a clamped edge whose model is right to 1 %"):
        simulate(
            scene(
                plate={
                    "edge": "clamped",
                    "half_thickness": 0.1,
                    "poissons_ratio": 0.45,
                    "youngs_modulus": 1e8,
                    "lame_lambda": None,
                    "lame_mu": None,
                }
            )
        )
    with pytest.raises(SceneError, match="h/b up to 1"):
        simulate(scene(plate={"half_thickness": 0.6}, effects={"edge": True}))
    assert simulate(scene(plate={"edge": "soft-hinge"})).model_note == ""


def test_beyond_the_law_is_refused_with_its_limit() -> None:
    fast = {"speed": 1e7}
    with pytest.raises(SceneError, match=r"or the contact opens, at 0\.059.* m.*lower the speed"):
        simulate(scene(impact=fast))
    with pytest.raises(SceneError, match=rf"min\({HELD} b, {CURVED} R\) = 0\.099 m"):
        simulate(scene(impact=fast, effects={"pressure": False}))
    flat = {"curvature": False, "edge": False, "pressure": False}
    with pytest.raises(SceneError, match=r"min\(b, R\) = 0\.1 m"):
        simulate(scene(impact=fast, effects=flat))


def test_the_contact_opens_near_three_thicknesses() -> None:
    """Of a rigid paraboloid on a thin plate; a sphere's pressure is steeper and opens before."""
    m = model(sphere_modulus=math.inf, h=0.001, R=10.0, edge="soft-hinge")
    limit = Law(m, ALL - {"curvature", "edge", "gravity"}).limit
    assert limit == 6 * m.h  # 3.01 thicknesses are beyond the law's own limit
    steep = Law(model(h=0.02), ALL).limit
    assert 0.04 < steep < 0.12
    shape = Law(model(h=0.02), ALL).at(np.array([0.999 * steep]))
    assert np.isfinite(shape.force).all()


def test_inertia_is_warned_of_by_its_numbers() -> None:
    pane = {"material": "glass", "lame_lambda": None, "lame_mu": None, "half_thickness": 0.002}
    texts = simulate(scene(plate=pane, impact={"speed": 0.01, "gravity": None})).warnings
    assert "Zener's number lambda" in texts[-1]
    assert "first bending period" in texts[-1]
    slab = pane | {"half_thickness": 0.5, "edge": "soft-hinge"}
    small = {"radius": 0.005, "mass": None}
    texts = simulate(scene(plate=slab, sphere=small, impact={"speed": 1.0})).warnings
    assert len(texts) == 1
    assert "echoes through the thickness" in texts[0]


def test_yield_is_warned_of_on_one_side_only() -> None:
    pressure = simulate(scene()).max_pressure
    for factor, warned in ((0.999, True), (1.001, False)):
        plate = {"yield_stress": factor * pressure / 1.6}
        assert any("yields" in text for text in simulate(scene(plate=plate)).warnings) is warned


@pytest.mark.parametrize("plate", [{}, {"radius": 0.05, "thickness": 0.02}])
def test_impact_beyond_the_law_is_refused_at_the_speed_named(plate: dict[str, float]) -> None:
    with pytest.raises(SceneError, match=r"impact\.speed: expected less than") as caught:
        simulate(read(changed(plate=plate, impact={"speed": 1e9})))
    limit = min(0.13, plate.get("radius", 1.0))
    assert f"min(b, R) = {limit} m" in str(caught.value)
    fastest = float(str(caught.value).split("less than ")[1].split()[0])
    with pytest.raises(SceneError, match=r"impact\.speed"):
        simulate(read(changed(plate=plate, impact={"speed": 1.0001 * fastest})))
    below = simulate(read(changed(plate=plate, impact={"speed": 0.9999 * fastest})))
    assert 0.999 * limit < below.max_contact_radius < limit


def test_warning_where_the_pressure_is_not_hertz(monkeypatch: pytest.MonkeyPatch) -> None:
    """The cost is (5/3) c3 (a/h)^3 of a^2/R, here in a made-up law with c1 and c3."""
    m = model_of(read(changed()))
    c3 = -0.09

    def law(a: float, R: float, h: float, _b: float) -> float:
        return a**2 / R * (1 + 8 * (a / h) + c3 * (a / h) ** 3)

    monkeypatch.setattr(kernels, "indentation", law)
    assert limits.warnings_at(m, 0.0299, law(0.0299, m.R, m.h, m.b)) == ()
    delta = law(0.0301, m.R, m.h, m.b)
    cost = 5 / 3 * c3 * 0.301**3 * 0.0301**2 / 0.13 / delta
    assert limits.hertz_cost(m, 0.0301, delta) == pytest.approx(cost, rel=1e-10)
    [text] = limits.warnings_at(m, 0.0301, delta)
    assert "a/H = 0.15" in text
    assert f"{100 * cost:+.2g} %" in text
    c3 = -90.0
    [loud] = limits.warnings_at(m, 0.035, law(0.035, m.R, m.h, m.b))
    assert "too large to estimate" in loud


def test_warning_reaches_the_result() -> None:
    result = simulate(read(changed(plate={"thickness": 0.02}, impact={"speed": 0.4})))
    assert result.max_contact_radius / 0.02 > 0.15
    assert any("a/H" in warning for warning in result.warnings)
    assert result.to_json()["warnings"] == list(result.warnings)
    assert "a/H" in result._repr_html_()


def test_curvature_cost_is_that_of_the_exact_profile() -> None:
    """Sneddon's sphere and the paraboloid pressed by the same force into a half-space."""
    m = model_of(thick())
    t = 0.2
    log = math.log((1 + t) / (1 - t))
    a = m.R * (0.75 * ((1 + t * t) / 2 * log - t)) ** (1 / 3)
    change = (t / 2 * log) / (a / m.R) ** 2 - 1
    assert limits.curvature_cost(m, a, a * a / m.R) == pytest.approx(change, rel=0.1)
    texts = limits.warnings_at(m, 0.31 * m.R, 0.31**2 * m.R)
    assert [("a/R" in text) for text in texts] == [True]


def test_deflection_beyond_half_the_thickness_is_said() -> None:
    m = model_of(read(changed()))
    assert limits.warnings_at(m, 0.01, 0.1) == ()
    [text] = limits.warnings_at(m, 0.01, 0.102)
    assert "w/H" in text


def test_energy_is_the_integral_of_the_force() -> None:
    m = model_of(thick())
    a = 0.1
    P = float(hertz.force_of_radius(a, m.R, m.lam, m.mu))
    assert limits.energy_of(Law(m, WHOLE_PLATE), a) == pytest.approx(0.4 * P * a**2 / m.R, rel=1e-5)
