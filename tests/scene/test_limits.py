"""Warnings, on both sides of each limit, and the numbers that they state."""

import math
import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq
from shared_scenes import changed, scene, thick

from derivation.scene import indent, kernels, read, simulate
from derivation.scene.contact_law import corrections, limits
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.effects import PAPER
from derivation.scene.model import InertiaSettings, model_of
from derivation.scene.result import Result
from derivation.scene.rows.rows import solve

Tables = dict[str, dict[str, Any]]


def either_side(
    make: Callable[[float], Tables], words: str, silent: float, loud: float
) -> tuple[Result, Result, str]:
    """Return results just below and just above a warning's limit, and the text of the warning."""

    def run(x: float) -> tuple[Result, str]:
        result = simulate(read(make(x)))
        # Densities that no solid has are probably given in another unit.
        texts = [text for text in result.warnings if not text.startswith("plate.density")]
        assert all(words in text for text in texts)  # no other warning is printed
        return result, "".join(texts)

    (below, nothing), (above, text) = run(silent), run(loud)
    assert not nothing
    assert text
    while abs(loud / silent - 1) > 1e-6:
        middle = math.sqrt(silent * loud)
        outcome, warning = run(middle)
        if warning:
            loud, above, text = middle, outcome, warning
        else:
            silent, below = middle, outcome
    return below, above, text


def test_warning_of_hertz_pressure_above_0_15_thicknesses() -> None:
    thin = {"radius": 0.2, "thickness": 0.02}
    below, above, text = either_side(
        lambda v: changed(plate=thin, impact={"speed": v}), "a/H", 0.05, 0.3
    )
    for result in (below, above):
        largest = result.max_contact_radius * (1 + result.bound_of("max_contact_radius"))
        assert largest / 0.02 == pytest.approx(0.15, rel=3e-6)
    assert "a/H = 0.15" in text
    solved = changed(plate=thin, impact={"speed": 0.3}, effects={"non_hertzian_pressure": True})
    assert simulate(read(solved)).warnings == ()


@pytest.mark.parametrize(
    ("edge", "rtol"),
    [
        ("paper", 1e-9),
        ("paper", 1e-3),
        ("simply-supported", 1e-9),
        ("clamped", 1e-9),
    ],
)
def test_stated_error_of_hertz_pressure_is_the_difference_to_the_exact_one(
    edge: str, rtol: float
) -> None:
    """The stated error is that of the indentation at the same force, for each set of effects."""
    tables = changed(plate={"radius": 0.2, "thickness": 0.02, "edge": edge}, impact={"speed": 0.12})
    result = simulate(read(tables), rtol=rtol)
    stated = float(re.findall(r"about (\S+) %", result.warnings[0])[0]) / 100
    solved = tables | {"effects": {"spherical_profile": False, "non_hertzian_pressure": True}}
    one, exact = (
        indent(read(data), force=result.max_force)[0].indentation for data in (tables, solved)
    )
    assert stated == pytest.approx(exact / one - 1, rel=0.2)


def test_no_warning_of_deflection_on_a_half_space() -> None:
    """What the spherical profile adds to a^2/R is not counted as deflection of the plate."""
    block = {"radius": 50.0, "thickness": 100.0, "density": 2000.0}
    tables = changed(plate=block, impact={"speed": 20.0}, effects={"spherical_profile": True})
    assert "inertia" not in "".join(simulate(read(tables)).warnings)


def test_warning_of_the_paraboloid_above_0_3_sphere_radii() -> None:
    """The stated error is the change of the indentation at equal force by the spherical profile."""
    block = {"radius": 1e6, "thickness": 2e6}

    def at(v: float, curved: bool = False) -> Tables:
        return changed(plate=block, impact={"speed": v}, effects={"spherical_profile": curved})

    below, above, text = either_side(at, "a/R", 1.0, 50.0)
    for result in (below, above):
        assert result.max_contact_radius / 0.13 == pytest.approx(0.3, rel=3e-6)
    assert "a/R = 0.3 " in text
    stated = float(re.findall(r"about (\S+) %", text)[0]) / 100
    [exact] = indent(read(at(1.0, True)), force=above.max_force)
    assert stated == pytest.approx(exact.indentation / above.max_indentation - 1, rel=0.1)
    assert simulate(read(at(50.0, True))).warnings == ()


def test_warning_of_membrane_stretching_above_half_a_thickness() -> None:
    below, above, text = either_side(
        lambda v: changed(
            plate={"thickness": 0.002}, impact={"speed": v}, sphere={"mass": 0.1},
            effects={"spherical_profile": "auto"},
        ),
        "w/H", 0.001, 0.1,
    )  # fmt: skip
    for result in (below, above):
        largest = result.max_indentation * (1 + result.bound_of("max_indentation"))
        local = (
            (1 - 2 * result.bound_of("max_contact_radius")) * result.max_contact_radius**2 / 0.13
        )
        assert (largest - local) / 0.002 == pytest.approx(0.5, rel=3e-6)
    assert "w/H = 0.5, within its error up to 0.5, may exceed 0.5" in text


def test_warning_of_yield_above_1_6_yield_stresses() -> None:
    """The warning appears where the pressure may exceed the limit within its error."""
    below, above, text = either_side(
        lambda s: changed(
            plate={
                "radius": 1e6, "thickness": 2e6, "yield_stress": s, "lame_lambda": 1e16
            },
            effects={"plasticity": False},
        ),
        "yield stress", 1e8, 1e7,
    )  # fmt: skip
    for result in (below, above):
        area = math.pi * result.max_contact_radius**2
        ratio = 1.5 * result.max_force / area / result.scene.plate.yield_stress
        error = result.accuracy.pressure_bound + result.model_errors["max_pressure"]
        assert ratio * (1.0 + error) == pytest.approx(1.6, rel=3e-6)
    assert f"yield stress = {ratio:.3g} " in text


def steel_on_glass(thickness: float, density: float) -> Tables:
    """Return a scene: a rigid sphere with the mass of steel on a plate as stiff as glass."""
    plate = {
        "radius": 0.5, "thickness": thickness, "lame_lambda": None, "lame_mu": None,
        "youngs_modulus": 70e9, "poissons_ratio": 0.2, "density": density,
    }  # fmt: skip
    return changed(sphere={"radius": 0.02, "mass": 0.263}, plate=plate)


def motion_numbers(result: Result) -> tuple[float, float, float]:
    """Return Zener's number, shortest contact time / first period, and fraction of deflection."""
    R, m, v0, h, b, _, _ = result.model.numbers
    E, H, rho = 70e9 / (1 - 0.2**2), 2 * h, result.model.density
    D = E * H**3 / 12
    That = (m**2 / ((4 / 3 * E * math.sqrt(R)) ** 2 * v0)) ** 0.2
    omega = 5.783185962946785 / b**2 * math.sqrt(D / (rho * H))  # for the paper's edge
    deflection_fraction = 1 - result.max_contact_radius**2 / R / result.max_indentation
    zener = m / (8 * That * math.sqrt(D * rho * H))
    shortest = result.contact_time / (1 + result.bound_of("contact_time"))
    return zener, shortest * omega / (2 * math.pi), deflection_fraction


@pytest.mark.parametrize(
    ("make", "silent", "loud", "limits"),
    [
        (lambda rho: steel_on_glass(0.6, rho), 20.0, 11.0, (0.006, None, None)),
        (lambda rho: steel_on_glass(0.2, rho), 0.5, 2.0, (None, 10.0, None)),
        (lambda H: steel_on_glass(H, 1000.0), 0.3, 0.21, (None, None, 0.01)),
    ],
    ids=["Zener parameter", "contact time", "deflection"],
)
def test_warning_of_inertia_on_one_side_of_each_limit(
    make: Any, silent: float, loud: float, limits: tuple[float | None, ...]
) -> None:
    """The limits are lambda = 0.006, ten bending periods and a deflection of 1 %."""
    below, above, text = either_side(make, "inertia", silent, loud)
    numbers = re.findall(r"Zener parameter (\S+) .* period (\S+) .* deflection (\S+) %", text)
    for result in (below, above):
        for actual, limit in zip(motion_numbers(result), limits, strict=True):
            assert limit is None or actual == pytest.approx(limit, rel=3e-6)
    zener, slow, deflection_fraction = motion_numbers(above)
    shown = [float(x) for x in numbers[0]]
    assert shown == [pytest.approx(x, rel=0.06) for x in (zener, slow, 100 * deflection_fraction)]


def test_warning_of_reflections_below_four_transit_times() -> None:
    below, above, text = either_side(lambda rho: steel_on_glass(0.6, rho), "4 H/c_P", 200.0, 500.0)
    for result in (below, above):
        sound = math.sqrt(70e9 * 0.8 / (1.2 * 0.6) / result.model.density)
        shortest = result.contact_time / (1 + result.bound_of("contact_time"))
        assert shortest == pytest.approx(4 * 0.6 / sound, rel=3e-6)
    assert f"4 H/c_P = {above.contact_time:.3g} s" in text


def test_no_warning_of_reflections_if_branches_include_them() -> None:
    slab = model_of(read(steel_on_glass(0.6, 2500.0)))
    for inertia, is_warned in (
        (InertiaSettings(), True),
        (InertiaSettings(branches="all"), False),
        (InertiaSettings(branches="all", infinite_plate=True), False),
    ):
        texts = limits.motion_warnings(replace(slab, inertia=inertia), 1e-5, 0.0, dynamic=True)
        assert any("4 H/c_P" in text for text in texts) is is_warned
    held = replace(slab, inertia=InertiaSettings(branches="all"))
    assert any("4 H/c_P" in text for text in limits.motion_warnings(held, 1e-5, 0.0))


@pytest.mark.parametrize(("transits", "text"), [(1.9, "ends before"), (2.1, "return during")])
def test_warning_of_reflections_says_whether_they_return(transits: float, text: str) -> None:
    """A pressure wave returns from the back face after two transits of the thickness."""
    slab = model_of(read(steel_on_glass(0.6, 2500.0)))
    transit = 0.6 / math.sqrt((slab.lam + 2.0 * slab.mu) / slab.density)
    warnings = limits.motion_warnings(slab, transits * transit, 0.0, dynamic=True)
    assert text in warnings[0]


def test_no_warning_of_reflections_if_the_simulation_chose_all_branches() -> None:
    """An earlier warning stated that the reflections are neglected, which the branches include."""
    tables = {
        "sphere": {"radius": 0.004, "material": "steel"},
        "plate": {"radius": 0.3, "thickness": 0.2, "material": "concrete"},
        "impact": {"speed": 2.0},
        "effects": {"inertia": True},
    }
    result = simulate(read(tables))
    assert result.dynamics is not None
    assert result.dynamics.law.model.inertia.branches == "all"
    assert not [text for text in result.warnings if "4 H/c_P" in text]


def test_warning_of_inertia_states_its_parameters() -> None:
    pane = {"material": "glass", "lame_lambda": None, "lame_mu": None, "half_thickness": 0.002}
    texts = simulate(scene(plate=pane, impact={"speed": 0.01, "gravity": None})).warnings
    assert "Zener" in texts[-1]
    assert "first bending period" in texts[-1]
    slab = pane | {"half_thickness": 0.5, "edge": "paper"}
    small = {"radius": 0.005, "mass": None}
    texts = simulate(scene(plate=slab, sphere=small, impact={"speed": 1.0})).warnings
    assert len(texts) == 1
    assert "4 H/c_P" in texts[0]


def test_warning_of_yield_on_one_side_of_the_limit() -> None:
    found = simulate(scene())
    pressure = found.max_pressure * (1.0 + found.model_errors["max_pressure"])
    for factor, warned in ((0.999, True), (1.001, False)):
        plate = {"yield_stress": factor * pressure / 1.6}
        result = simulate(scene(plate=plate, effects={"plasticity": False}))
        assert any("may yield" in text for text in result.warnings) is warned


def test_warning_if_the_pressure_is_not_hertzian(monkeypatch: pytest.MonkeyPatch) -> None:
    """The error is (5/3) c3 (a/h)^3 of a^2/R, here for an invented law with c1 and c3."""
    m = model_of(read(changed()))
    c3 = -0.09

    def law(a: float, R: float, h: float, _b: float) -> float:
        return a**2 / R * (1 + 8 * (a / h) + c3 * (a / h) ** 3)

    monkeypatch.setattr(kernels, "indentation", law)
    assert limits.warnings_at(ContactLaw(m, PAPER), 0.0299, law(0.0299, m.R, m.h, m.b)) == ()
    delta = law(0.0301, m.R, m.h, m.b)
    cost = 5 / 3 * c3 * 0.301**3 * 0.0301**2 / 0.13 / delta
    assert corrections.pressure_correction(m, 0.0301, delta) == pytest.approx(cost, rel=1e-10)
    [text] = limits.warnings_at(ContactLaw(m, PAPER), 0.0301, delta)
    assert "a/H = 0.15" in text
    assert f"{100 * cost:+.2g} %" in text
    # A leading term x means 5/3 c3 A^3 = x (1 + 8 A + c3 A^3).
    for leading, words in ((-0.299, "about -30 %"), (-0.301, "no reliable error estimate")):
        c3 = leading * (1 + 8 * 0.35) / 0.35**3 / (5 / 3 - leading)
        [loud] = limits.warnings_at(ContactLaw(m, PAPER), 0.035, law(0.035, m.R, m.h, m.b))
        assert words in loud


def test_warning_reaches_the_result() -> None:
    result = simulate(read(changed(plate={"thickness": 0.02}, impact={"speed": 0.4})))
    assert result.max_contact_radius / 0.02 > 0.15
    assert any("a/H" in warning for warning in result.warnings)
    assert result.to_json()["warnings"] == list(result.warnings)
    assert "a/H" in result._repr_html_()


def test_profile_correction_agrees_with_the_exact_sphere() -> None:
    """The correction is Sneddon's sphere against a paraboloid at equal force on a half-space."""
    m = model_of(thick())
    t = 0.2
    log = math.log((1 + t) / (1 - t))
    a = m.R * (0.75 * ((1 + t * t) / 2 * log - t)) ** (1 / 3)
    change = (t / 2 * log) / (a / m.R) ** 2 - 1
    assert corrections.profile_correction(m, a, a * a / m.R) == pytest.approx(change, rel=0.1)
    texts = limits.warnings_at(ContactLaw(m, PAPER), 0.31 * m.R, 0.31**2 * m.R)
    assert [("a/R" in text) for text in texts] == [True]


def test_deflection_above_half_the_thickness_is_stated() -> None:
    m = model_of(read(changed()))
    assert limits.warnings_at(ContactLaw(m, PAPER), 0.01, 0.1) == ()
    [text] = limits.warnings_at(ContactLaw(m, PAPER), 0.01, 0.102)
    assert "w/H" in text


@pytest.mark.parametrize(
    ("plate", "name", "words"),
    [
        ({"radius": 2.0, "thickness": 0.05}, "max_contact_radius", "a/H = "),
        ({"radius": 1.0, "thickness": 0.02}, "max_indentation", "w/H = "),
        ({"radius": 20.0, "thickness": 6.0, "density": 2500.0}, "contact_time", "may be below 4 H"),
    ],
)
def test_results_within_their_error_of_a_limit_have_a_warning(
    plate: dict[str, float], name: str, words: str
) -> None:
    """An earlier version ignored the error, and gave no warning where the exact result has one."""
    tables = changed(plate=plate, effects={"inertia": False, "non_hertzian_pressure": False})

    def rough(speed: float) -> Result:
        return simulate(read(tables | {"impact": {"speed": speed}}), rtol=0.2)

    def beyond(logarithm: float) -> float:
        """Return by how much a result exceeds its limit, increased by half of its error."""
        result = rough(math.exp(logarithm))
        near, H = 1.0 + 0.5 * result.bound_of(name), 2.0 * result.model.h
        if name == "contact_time":
            return near * limits.plate_times(result.model).echoes / result.contact_time - 1.0
        if name == "max_contact_radius":
            return near * result.max_contact_radius / H / limits.HERTZ_LIMIT - 1.0
        local = result.max_contact_radius**2 / result.model.R
        return (near * result.max_indentation - local) / H / limits.STRETCH_LIMIT - 1.0

    speed = math.exp(brentq(beyond, math.log(1e-6), math.log(10.0), rtol=1e-12))
    rows = solve(read(tables), {"impact.speed": np.array([0.9 * speed, speed])}, rtol=0.2)
    assert rows.reason.tolist() == [
        "; ".join(rough(value).warnings) for value in (0.9 * speed, speed)
    ]
    assert words not in rows.reason[0]
    assert words in rows.reason[1]
    assert "may" in rows.reason[1]
