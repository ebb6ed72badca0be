"""Viscoelastic contacts in arrays: each row is the simulation of its scene, to the last bit."""

import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from test_rows import check, in_arrays

from derivation.scene import read
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.model import model_of
from derivation.scene.quasi_static import viscous, viscous_law
from derivation.scene.result import UNITS
from derivation.scene.rows import rows as many
from derivation.scene.rows.rows import solve
from derivation.scene.scene import OUTPUTS, Scene
from generated.arrays import Double as Array

STATIC = ("bending", "finite_thickness", "finite_radius", "sphere_elasticity", "spherical_profile")
POLYMER = {"youngs_modulus": 3e9, "poissons_ratio": 0.37, "density": 1190.0}


def pane(effects: dict[str, Any] | None = None, **changed: dict[str, Any]) -> Scene:
    """Return a steel ball on a polymer plate, with some keys changed."""
    tables: dict[str, dict[str, Any]] = {
        "sphere": {"radius": 0.005, "material": "steel"},
        "plate": {"radius": 0.05, "thickness": 0.004, "retardation_time": 1e-5, **POLYMER},
        "impact": {"speed": 0.3},
    }
    wanted = {"inertia": False, "viscosity": True, "non_hertzian_pressure": False}
    tables = {name: table | changed.get(name, {}) for name, table in tables.items()}
    return read(tables | {"effects": wanted | (effects or {})})


def random_columns(count: int, seed: int = 1) -> dict[str, Array]:
    """Return columns of random speeds and retardation times."""
    chance = np.random.default_rng(seed)
    return {
        "impact.speed": 10 ** chance.uniform(-1.5, 0.0, count),
        "plate.retardation_time": 10 ** chance.uniform(-6.5, -4.0, count),
    }


SCENES = {
    "hertz": pane(dict.fromkeys(STATIC, False)),
    "bending": pane(dict.fromkeys(STATIC, False) | {"bending": True}),
    "all static effects": pane(dict.fromkeys(STATIC, True) | {"non_hertzian_pressure": True}),
    "edge and weight": pane(
        dict.fromkeys(STATIC, True), plate={"edge": "clamped"}, impact={"gravity": 200.0}
    ),
}


@pytest.mark.one_version
@pytest.mark.parametrize("name", SCENES)
def test_each_row_equals_its_simulation(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    scene, columns = SCENES[name], random_columns(5)
    solution = check(scene, columns)
    assert all("viscosity" in names for names in solution.effects)
    in_arrays(monkeypatch, scene, columns)


@pytest.mark.one_version
@pytest.mark.parametrize("name", SCENES)
def test_rows_do_not_depend_on_their_number(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    columns = random_columns(300, 2)
    whole = solve(SCENES[name], columns)
    assert set(whole.status) == {"finished"}
    monkeypatch.setattr(viscous, "TOGETHER", 64)
    for start, stop in (0, 1), (1, 3), (60, 67), (100, 300):
        part = solve(SCENES[name], {key: x[start:stop] for key, x in columns.items()})
        for of_part, of_all in (part.results, whole.results), (part.errors, whole.errors):
            for unit in UNITS:
                np.testing.assert_array_equal(of_part[unit], of_all[unit][start:stop])


@pytest.mark.one_version
@pytest.mark.parametrize("rtol", [None, 0.3, 1e-2, 1e-4])
def test_rows_with_selected_effects_and_unlike_bodies(rtol: float | None) -> None:
    """Effects are selected for each row, and each has the model error of its two bodies."""
    scene = pane(
        {"non_hertzian_pressure": "auto", "viscosity": "auto"},
        sphere={"retardation_time": 3e-6, "yield_stress": 1e9},
        plate={"tensile_strength": 1e6, "edge": "simply-supported"},
    )
    chance = np.random.default_rng(3)
    columns = random_columns(6) | {
        "plate.thickness": 10 ** chance.uniform(-3.0, -1.3, 6),
        "sphere.radius": chance.uniform(0.002, 0.006, 6),
    }
    columns["plate.retardation_time"][[0, 1]] = 0.0, 3e-6
    check(scene, columns, rtol)


def test_rows_that_fail_have_the_messages_of_their_simulations() -> None:
    """A contact that is too wide, and a sphere that its weight holds on the plate."""
    scene = pane(dict.fromkeys(STATIC, False) | {"bending": True})
    columns = {
        "impact.speed": np.array([0.3, 1e4, 0.2, 1e-3, 0.1]),
        "plate.retardation_time": np.array([1e-5, 1e-5, 2e-5, 1e-3, 1e-6]),
        "impact.gravity": np.full(5, 9.81),
    }
    solution = check(scene, columns)
    assert solution.status.tolist() == ["finished", "rejected", "finished", "rejected", "finished"]
    assert "impact.speed: expected less than" in solution.reason[1]
    assert "its weight holds it" in solution.reason[3]


def test_rows_without_converging_elements_do_not_change_others(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    scene, columns = SCENES["bending"], random_columns(4)
    solution = solve(scene, columns)
    monkeypatch.setattr(viscous, "MOST", 70)
    some = check(scene, columns)
    finished = some.status == "finished"
    assert 0 < finished.sum() < 4
    assert all("the time integration failed" in reason for reason in some.reason[~finished])
    for name in UNITS:
        np.testing.assert_array_equal(
            some.results[name][finished], solution.results[name][finished]
        )


@pytest.mark.one_version
def test_laws_without_accurate_tables_are_computed_directly(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    scene, columns = SCENES["all static effects"], random_columns(3)
    tabulated = solve(scene, columns)
    monkeypatch.setattr(viscous_law, "FITTED", 0.0)
    direct = check(scene, columns)
    in_arrays(monkeypatch, scene, columns)
    for name in OUTPUTS:
        np.testing.assert_allclose(direct.results[name], tabulated.results[name], rtol=1e-11)


def test_tables_of_any_degree_have_the_results_of_the_largest(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for scene in SCENES.values():
        columns = random_columns(3)
        here = solve(scene, columns)
        with monkeypatch.context() as patch:
            patch.setattr(viscous_law, "NEGLIGIBLE", 0.0)
            largest = solve(scene, columns)
        for name in OUTPUTS:
            np.testing.assert_allclose(here.results[name], largest.results[name], rtol=1e-11)


def test_stated_errors_cover_the_change_by_more_nodes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for scene in SCENES.values():
        columns = random_columns(10, 4)
        here = solve(scene, columns)
        with monkeypatch.context() as patch:
            patch.setattr(viscous, "STAGES", (11, 13))
            fine = solve(scene, columns)
        for name in OUTPUTS:
            change = np.abs(fine.results[name] / here.results[name] - 1.0)
            assert np.all(change <= here.bound + fine.bound)


def test_stated_errors_cover_impacts_that_the_weight_accelerates(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The sphere becomes 400 times faster, so that a small speed of rebound has a larger error."""
    scene = read({
        "sphere": {"radius": 0.0425195, "material": "steel"},
        "plate": {"radius": 1.18988, "half_thickness": 0.00496429, "youngs_modulus": 1.0351499e8,
                  "poissons_ratio": 0.436818, "retardation_time": 5.82436e-6},
        "impact": {"speed": 0.014, "gravity": 53.1},
        "effects": {"spherical_profile": False, "non_hertzian_pressure": False,
                    "viscosity": True, "inertia": False},
    })  # fmt: skip
    speeds = {"impact.speed": np.linspace(0.012, 0.016, 12)}
    here, changes = solve(scene, speeds), []
    for stages in (9, 13), (9, 14):
        monkeypatch.setattr(viscous, "STAGES", stages)
        changes.append(solve(scene, speeds).results["restitution"] / here.results["restitution"])
    change = np.abs(np.array(changes) - 1.0)
    assert change.max() > 1e-10
    assert np.all(change <= 2.0 * here.bound)


def test_elastic_bending_is_that_of_the_law_at_the_radius_of_the_force() -> None:
    """An earlier table was looked up at Hertz's radius with a rigid sphere."""
    scene = pane(
        {"bending": True}, sphere={"material": None, "mass": 4e-3, **POLYMER, "density": None},
        plate={"thickness": 0.02, "edge": "clamped"},
    )  # fmt: skip
    law = ContactLaw(model_of(scene), frozenset({"hertz", "sphere_elasticity", "bending", "edge"}))
    a = np.geomspace(1e-5, 2e-3, 20)
    force = law.force(a, law.at(a))
    bent = law.only(lambda effect: effect.bends or effect.other_edge)
    expected = a * a / law.model.R * bent.deflection(a).depth / (1.0 + law.softness)
    assert law.softness == pytest.approx(1.0)
    deflection, slope = viscous_law.bending_of(law, 2e-3).at(force)
    assert deflection == pytest.approx(expected, rel=1e-12)
    steps = np.array([0.999, 1.001])
    near, _ = viscous_law.bending_of(law, 2e-3).at(force[:, None] * steps)
    assert slope == pytest.approx((near[:, 1] - near[:, 0]) / (0.002 * force), rel=1e-6)


def test_batch_ends_after_its_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Further rows are computed together as far as the time is expected to suffice."""
    now, groups = 0.0, many._groups

    def slow(scene: Scene, columns: dict[str, Array], *others: Any) -> Iterator[Any]:
        nonlocal now
        now += 0.1 * len(columns["impact.speed"])
        return groups(scene, columns, *others)

    monkeypatch.setattr(time, "perf_counter", lambda: now)
    monkeypatch.setattr(many, "_groups", slow)
    monkeypatch.setattr(many, "FIRST", 3)
    some = solve(SCENES["hertz"], random_columns(40), seconds=1.05)
    assert set(some.status) == {"finished"}
    assert 10 <= len(some) <= 12
