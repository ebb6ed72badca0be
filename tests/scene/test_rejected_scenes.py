"""Rejected scenes, on both sides of each limit: radii, speeds, materials, tolerances, edges."""

import json
import math
import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from shared_scenes import ALL, changed, model, scene, thick

from derivation.engine.files import measurements
from derivation.scene import SceneError, indent, read, simulate
from derivation.scene.contact_law import limits
from derivation.scene.contact_law.edge_remainder import edge_remainder
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import waves
from derivation.scene.effects import PAPER, WHOLE_PLATE
from derivation.scene.effects.edge import MAX_A_OVER_B
from derivation.scene.effects.spherical_profile import MAX_A_OVER_R
from derivation.scene.model import model_of
from derivation.scene.output.answer import model_note
from derivation.scene.quasi_static import motion, viscous
from derivation.scene.result import Result

Tables = dict[str, dict[str, Any]]


def rejected_from(make: Callable[[float], Any], fine: float, bad: float) -> tuple[float, str]:
    """Return the limit value from which a scene is rejected (within 1e-6), and the message."""
    make(fine)
    text = ""
    while abs(bad / fine - 1) > 1e-6 or not text:
        middle = math.sqrt(fine * bad) if text else bad
        try:
            make(middle)
        except SceneError as error:
            bad, text = middle, str(error)
        else:
            assert text, "expected a rejection"
            fine = middle
    return bad, text


@pytest.mark.parametrize(
    ("tables", "limit"),
    [
        ({}, 0.13),
        ({"plate": {"radius": 0.05}}, 0.05),
        ({"effects": {"spherical_profile": True}}, 0.99 * 0.13),
        ({"plate": {"radius": 0.1, "edge": "clamped"}}, 0.9 * 0.1),
        (
            {
                "plate": {"radius": 0.1, "thickness": 0.2},
                "effects": {"non_hertzian_pressure": True},
            },
            0.9 * 0.1,
        ),
        (
            {
                "plate": {"radius": 0.5, "thickness": 0.005},
                "effects": {"non_hertzian_pressure": True, "stretching": False},
            },
            0.015,
        ),
    ],
    ids=["sphere", "plate", "steep", "supported", "integral equation", "annulus"],
)
def test_contact_radii_above_the_limit_are_rejected(tables: Tables, limit: float) -> None:
    """The limit is min(b, R) or a little less; three thicknesses for non-Hertzian pressure."""
    given = read(changed(**tables))
    actual, text = rejected_from(lambda a: indent(given, contact_radius=a), 0.5 * limit, 2 * limit)
    assert actual == pytest.approx(limit, rel=3e-6)
    assert f"{limit:.6g} m" in text
    assert f"{actual:.6g} m" in text


def test_contact_without_central_pressure_is_rejected() -> None:
    """A contact is rejected where the central pressure vanishes, for a sphere before a/H = 3."""
    tables = {
        "plate": {"thickness": 0.02},
        "effects": {
            "spherical_profile": True, "non_hertzian_pressure": True, "stretching": False
        },
    }  # fmt: skip
    given = read(changed(**tables))
    a, text = rejected_from(lambda a: indent(given, contact_radius=a), 0.02, 0.07)
    assert 1.5 < a / 0.02 < 3.0
    assert f"{a:.6g} m" in text
    rows = indent(given, contact_radius=[0.01, 0.999 * a, (1 - 2e-6) * a])
    ratio = [row.max_pressure * math.pi * row.contact_radius**2 / row.force for row in rows]
    assert 1 < ratio[0] < 1.5
    assert 0 < ratio[2] < 0.01 < 20 * ratio[1]


@pytest.mark.parametrize(
    ("gravity", "solved"),
    [(None, False), (9.81, False), (9.81, True)],
)
def test_impacts_above_the_stated_speed_are_rejected(gravity: float | None, solved: bool) -> None:
    """The limit of the speed takes the work of a heavy sphere's weight into account."""

    def run(v: float) -> Result:
        return simulate(
            read(
                changed(
                    sphere={"mass": 3e4},
                    plate={"thickness": 0.4},
                    impact={"speed": v, "gravity": gravity},
                    effects={
                        "non_hertzian_pressure": solved,
                        "spherical_profile": solved,
                        "gravity": gravity is not None,
                    },
                )
            )
        )

    v, text = rejected_from(run, 12.0, 45.0)
    assert text.startswith("impact.speed: ")
    assert float(text.split("less than ")[1].split()[0]) == pytest.approx(v, rel=2e-5)
    limit = 0.95 * 0.13 if solved else 0.13
    assert f"= {limit:.6g} m" in text or f"at {limit:.6g} m" in text
    assert run((1 - 2e-6) * v).max_contact_radius == pytest.approx(limit, rel=1e-3)


@pytest.mark.parametrize("limit", [0.5, -1.0])
def test_limits_of_poissons_ratio_are_rejected(limit: float) -> None:
    def run(nu: float) -> Result:
        keys = {"lame_lambda": None, "lame_mu": None, "youngs_modulus": 1e9, "poissons_ratio": nu}
        return simulate(read(changed(plate={"radius": 1e6, "thickness": 2e6} | keys)))

    for bad in (limit, math.nextafter(limit, 2 * limit)):
        with pytest.raises(
            SceneError, match=rf"poissons_ratio: .*above -1 and below 0.5.*{bad:.6g}"
        ):
            run(bad)
    nu = limit * (1 - 1e-7)
    inside, middle = run(nu), run(0.0)
    # Hertz: force and modulus go as P ~ E*^(2/5).
    ratio = (inside.max_force / middle.max_force) ** 2.5
    assert ratio == pytest.approx(1 / (1 - nu * nu), rel=1e-6)


def test_an_incompressible_solid_is_rejected_with_a_ratio_that_is_nearly_the_same() -> None:
    plate = {"radius": 0.3, "thickness": 0.01, "youngs_modulus": 1e6, "poissons_ratio": 0.5}
    scene = {"sphere": {"radius": 0.01, "material": "steel"}, "plate": plate,
             "impact": {"speed": 1.0}}  # fmt: skip
    with pytest.raises(SceneError) as error:
        read(scene)
    [ratio] = re.findall(r"`poissons_ratio = (.+?)`", str(error.value))
    assert 0.48 <= float(ratio) < 0.5
    read(scene | {"plate": plate | {"poissons_ratio": float(ratio)}})


def test_bulk_modulus_of_zero_is_rejected() -> None:
    mu, limit = 3.0, -2.0
    for lam, fine in ((limit, False), (limit * (1 + 1e-15), False), (limit * (1 - 1e-9), True)):
        data = changed(plate={"lame_lambda": lam, "lame_mu": mu})
        if fine:
            assert read(data).plate.lame_lambda == lam
        else:
            with pytest.raises(SceneError, match="bulk modulus"):
                read(data)


@pytest.mark.parametrize(("limit", "beyond"), [(1e-13, 0.0), (1.0, 2.0)])
def test_tolerances_outside_their_range_are_rejected(limit: float, beyond: float) -> None:
    outside = math.nextafter(limit, beyond)
    thick_plate = {"radius": 1e6, "thickness": 2e6}
    given = read(changed(plate=thick_plate) | {"accuracy": {"rtol": limit}})
    for result in (simulate(given), simulate(read(changed(plate=thick_plate)), rtol=limit)):
        assert result.accuracy.bound <= limit
    for call in (
        lambda: read(changed() | {"accuracy": {"rtol": outside}}),
        lambda: simulate(read(changed()), rtol=outside),
    ):
        with pytest.raises(SceneError, match=r"rtol: .*1e-13"):
            call()


REMAINDER = json.loads((measurements() / "edge_remainder.json").read_text())["rows"]
EDGES = {"supported": "simply-supported", "clamped": "clamped"}


def test_remainder_of_the_edge_is_the_measured_one_or_rejected() -> None:
    rejected = 0
    for row in REMAINDER:
        parts = ("relative_error", "lower_degree", "fewer_layers")
        nu, size = row["nu"], sum(abs(row[part]) for part in parts)
        m = model(
            b=1.0, h=row["h_over_b"], lam=2 * 3e9 * nu / (1 - 2 * nu), edge=EDGES[row["support"]]
        )
        # A ratio with a rounding error is treated as lying between two points of the table.
        if size < 0.0099:
            assert edge_remainder(m, row["a_over_b"]) == pytest.approx(size, rel=0.9)
        elif size > 0.01:
            rejected += 1
            with pytest.raises(SceneError, match=r"^plate\.edge: ") as error:
                edge_remainder(m, row["a_over_b"])
            stated = float(str(error.value).split("got ")[1].split(" %")[0])
            assert 100 * size <= stated * (1 + 1e-12) <= 101 * size
    assert rejected > 5


def test_model_error_of_the_edge_is_stated_or_rejected() -> None:
    held = {"edge": "clamped", "half_thickness": 0.01}
    result = simulate(scene(plate=held))
    assert 0 < result.model_error < 0.01
    assert "of the clamped edge (measured" in model_note(result)
    assert result.to_json()["model_error"] == result.model_error
    with pytest.raises(SceneError, match=r"^plate\.edge: .*clamped edge.*1 %"):
        simulate(
            scene(
                plate={
                    "edge": "clamped",
                    "half_thickness": 0.45,
                    "poissons_ratio": 0.45,
                    "youngs_modulus": 1e8,
                    "lame_lambda": None,
                    "lame_mu": None,
                },
                sphere={"radius": 0.4},
                impact={"speed": 30.0},
            )
        )
    with pytest.raises(SceneError, match="h/b up to 1"):
        simulate(scene(plate={"half_thickness": 0.6}, effects={"edge": True}))
    assert "edge" not in model_note(simulate(scene(plate={"edge": "paper"})))


def test_contacts_beyond_the_law_are_rejected_with_its_limit() -> None:
    fast = {"speed": 1e7}
    with pytest.raises(SceneError, match=r"impact\.speed: .*0\.058\d* m, where contact is lost"):
        simulate(scene(impact=fast))
    with pytest.raises(SceneError, match=rf"min\({MAX_A_OVER_B} b, {MAX_A_OVER_R} R\) = 0\.099 m"):
        simulate(scene(impact=fast, effects={"non_hertzian_pressure": False}))
    flat = {"spherical_profile": False, "edge": False, "non_hertzian_pressure": False}
    with pytest.raises(SceneError, match=r"min\(b, R\) = 0\.1 m"):
        simulate(scene(impact=fast, effects=flat))


def test_contact_is_lost_at_the_centre_near_three_thicknesses() -> None:
    """A paraboloid does not lose contact at the centre up to a/H = 3; a sphere does before."""
    m = model(sphere_modulus=math.inf, h=0.001, R=10.0, edge="paper")
    limit = ContactLaw(m, ALL - {"spherical_profile", "edge", "gravity"}).limit
    assert limit == 6 * m.h  # three thicknesses, the limit of the law
    steep = ContactLaw(model(h=0.02), ALL).limit
    assert 0.04 < steep < 0.12
    shape = ContactLaw(model(h=0.02), ALL).at(np.array([0.999 * steep]))
    assert np.isfinite(shape.force).all()


@pytest.mark.parametrize("plate", [{}, {"radius": 0.05, "thickness": 0.02}])
def test_impact_beyond_the_law_is_rejected_with_the_largest_speed(plate: dict[str, float]) -> None:
    with pytest.raises(SceneError, match=r"impact\.speed: ") as caught:
        simulate(read(changed(plate=plate, impact={"speed": 1e9})))
    limit = min(0.13, plate.get("radius", 1.0))
    assert f"min(b, R) = {limit} m" in str(caught.value)
    fastest = float(str(caught.value).split("less than ")[1].split()[0])
    with pytest.raises(SceneError, match=r"impact\.speed"):
        simulate(read(changed(plate=plate, impact={"speed": 1.0001 * fastest})))
    below = simulate(read(changed(plate=plate, impact={"speed": 0.9999 * fastest})))
    assert 0.999 * limit < below.max_contact_radius < limit


def test_energy_of_a_sphere_close_to_its_limit_agrees_with_scipy() -> None:
    """The energy is that of Sneddon's law, integrated by SciPy up to the largest radius."""
    m = model(sphere_modulus=math.inf, h=1e3, b=1e4)
    law = ContactLaw(m, frozenset({"hertz", "spherical_profile"}))
    E, R, last = m.modulus, m.R, limits.last_radius(law)

    def power(a: float) -> float:
        log = math.log((R + a) / (R - a))
        return E * ((a * a + R * R) / 2 * log - a * R) * (log / 2 + a * R / (R * R - a * a))

    exact, _ = quad(power, 0.0, last, epsrel=1e-12, limit=200)
    assert limits.energy_of(law, last) == pytest.approx(exact, rel=1e-9)


def test_energy_is_the_integral_of_the_force() -> None:
    m = model_of(thick())
    a = 0.1
    P = 16 * m.mu * (m.lam + m.mu) / (3 * (m.lam + 2 * m.mu)) * a**3 / m.R
    assert limits.energy_of(ContactLaw(m, WHOLE_PLATE), a) == pytest.approx(
        0.4 * P * a**2 / m.R, rel=1e-5
    )


@pytest.mark.parametrize(
    ("run", "effects"),
    [
        (motion.impact, PAPER),
        (motion.largest_radius, PAPER),
        (viscous.impact, PAPER | {"viscosity"}),
        (waves.impact, PAPER | {"inertia"}),
    ],
)
def test_impact_beyond_the_law_is_an_error_of_the_speed(
    run: Callable[[ContactLaw], object], effects: frozenset[str]
) -> None:
    """Each solver raises the same error."""
    m = replace(model_of(read(changed())), v0=1e6, retardation_time=1e-6, density=2700.0)
    with pytest.raises(SceneError, match=r"impact\.speed: "):
        run(ContactLaw(m, effects))
