"""Many scenes at once: each row is what `simulate` returns for its scene."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from shared_scenes import PAPER

from derivation.scene import SceneError, load, read, simulate
from derivation.scene.contact_law.law_errors import law_errors
from derivation.scene.result import UNITS, Result
from derivation.scene.rows import rows as many
from derivation.scene.rows.columns import row_of
from derivation.scene.rows.rows import Rows, solve
from derivation.scene.scene import Scene
from generated import simple_impact
from generated.arrays import Double as Array

STEEL_ON_GLASS: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.01, "material": "steel"},
    "plate": {"radius": 0.3, "thickness": 0.05, "material": "glass"},
    "impact": {"speed": 0.5, "gravity": 9.81},
    "effects": {"inertia": False},
}


def scene_with(**tables: Mapping[str, Any]) -> Scene:
    """Return the scene of steel on glass with some keys changed."""
    return read({n: {**STEEL_ON_GLASS.get(n, {}), **tables.get(n, {})} for n in
                 STEEL_ON_GLASS.keys() | tables.keys()})  # fmt: skip


def check(scene: Scene, columns: Mapping[str, Array], rtol: float | None = None) -> Rows:
    """Solve rows, and assert that each is the simulation of its scene, to the last bit."""
    solution = solve(scene, columns, rtol)
    for row in range(len(solution.bound)):
        one, reason = simulated(row_of(scene, columns, row), rtol)
        if one is None:
            assert (solution.status[row], solution.reason[row]) == ("rejected", reason)
            assert solution.effects[row] == ""
            columns_of_row = (*solution.results.values(), *solution.errors.values())
            assert all(np.isnan(values[row]) for values in columns_of_row)
            continue
        assert solution.effects[row] == " ".join(one.effects.included)
        assert solution.status[row] == "finished"
        assert solution.reason[row] == "; ".join(one.warnings)
        assert solution.model_error[row] == one.model_error
        assert solution.bound[row] == one.accuracy.bound
        for name in UNITS:
            np.testing.assert_array_equal(solution.results[name][row], getattr(one, name), name)
            np.testing.assert_array_equal(solution.errors[name][row], one.error_of(name), name)
    return solution


def simulated(tables: Mapping[str, Any], rtol: float | None) -> tuple[Result | None, str]:
    """Return the simulation of a scene, or the message of its error."""
    try:
        return simulate(read(tables), rtol=rtol), ""
    except SceneError as error:
        return None, str(error)


def test_rows_of_a_plate_that_only_bends() -> None:
    """With a rigid and an elastic sphere, from a nearly linear spring to a half-space."""
    only = dict.fromkeys(("non_hertzian_pressure", "finite_thickness", "finite_radius"), False)
    columns = {"plate.thickness": np.geomspace(1e-3, 1.0, 7), "impact.speed": np.full(7, 1e-3)}
    for sphere in {"radius": 0.01, "mass": 0.03, "material": None}, {}:
        tables = scene_with(
            sphere=sphere, impact={"gravity": 0.0},
            effects={"inertia": False, "spherical_profile": False, **only},
        )  # fmt: skip
        solution = check(tables, columns)
        assert {"hertz bending", "hertz sphere_elasticity bending"} & set(solution.effects)


def never(*_: object, **__: object) -> None:
    """Fail if a single scene is simulated."""
    raise AssertionError("a row was not solved in arrays")


def in_arrays(monkeypatch: pytest.MonkeyPatch, *given: Any) -> None:
    """Assert that no row is simulated separately."""
    monkeypatch.setattr(many, "simulate", never)
    assert set(solve(*given).status) == {"finished"}


def test_rows_of_supported_plates_do_not_depend_on_rounding_errors_of_their_radius() -> None:
    """NumPy computes powers of arrays and of numbers with other rounding errors."""
    softest, stiffest = 2955104292.8682976, 6420821915.79457
    tables = scene_with(
        sphere={"radius": 1e-3, "mass": 3e-5, "material": None},
        plate={"radius": 0.01, "half_thickness": 0.00031622776601683794, "thickness": None,
               "material": None, "youngs_modulus": stiffest, "poissons_ratio": 0.0,
               "edge": "simply-supported"},
        impact={"speed": 0.1, "gravity": 0.0},
        effects={"inertia": False, "non_hertzian_pressure": False},
    )  # fmt: skip
    check(tables, {"plate.youngs_modulus": np.array([stiffest, stiffest, softest])})


@pytest.mark.one_version
@pytest.mark.parametrize(
    ("key", "values"),
    [
        ("plate.thickness", [0.03, 0.08]),
        ("plate.yield_stress", [3e8, 1e9, 1e12]),
        ("impact.speed", [1e-3, 0.1, 3.0]),
    ],
)
@pytest.mark.parametrize("rtol", [None, 0.3])
def test_rows_that_may_yield_on_a_plate_with_inertia_are_simulations(
    key: str, values: list[float], rtol: float | None
) -> None:
    scene = read({
        "sphere": {"radius": 0.01, "material": "steel"},
        "plate": {"radius": 0.3, "thickness": 0.05, "material": "steel", "yield_stress": 3e8},
        "impact": {"speed": 1.0},
    })  # fmt: skip
    check(scene, {key: np.array(values)}, rtol)


def test_rows_with_a_yield_stress_may_omit_inertia(monkeypatch: pytest.MonkeyPatch) -> None:
    """In slow impacts on a thick plate neither inertia nor yield is included."""
    scene = read({
        "sphere": {"radius": 0.01, "material": "steel"},
        "plate": {"radius": 0.3, "thickness": 0.3, "material": "steel", "yield_stress": 3e9},
        "impact": {"speed": 1e-5},
    })  # fmt: skip
    columns = {"impact.speed": np.array([1e-5, 2e-5])}
    actual = check(scene, columns, 0.5)
    assert not any({"inertia", "plasticity"} & set(names.split()) for names in actual.effects)
    in_arrays(monkeypatch, scene, columns, 0.5)


@pytest.mark.parametrize("rtol", [None, 1e-1, 1e-2, 1e-6, 1e-13])
def test_rows_of_the_paper_are_simulations(
    rtol: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    chance = np.random.default_rng(1)
    columns = {
        "impact.speed": 10 ** chance.uniform(-2, 0.5, 5),
        "plate.half_thickness": 10 ** chance.uniform(-1, 0, 5),
    }
    check(load(PAPER), columns, rtol)
    in_arrays(monkeypatch, load(PAPER), columns, rtol)


@pytest.mark.parametrize(
    ("edge", "rtol"), [("paper", 3e-2), ("clamped", 0.3), ("simply-supported", 3e-2)]
)
def test_rows_of_any_law_are_simulations(
    edge: str, rtol: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    chance = np.random.default_rng(2)
    scene = scene_with(plate={"edge": edge})
    columns = {
        "impact.speed": chance.uniform(0.05, 0.5, 6),
        "plate.thickness": chance.uniform(0.02, 0.05, 6),
        "sphere.radius": chance.uniform(0.005, 0.015, 6),
    }
    check(scene, columns, rtol)
    if edge != "clamped":  # its bound needs the non-Hertzian pressure
        in_arrays(monkeypatch, scene, columns, rtol)


def test_rows_with_omitted_inertia_are_computed_in_arrays(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    scene = scene_with(plate={"thickness": 0.5, "radius": 0.5}, effects={"inertia": "auto"})
    columns = {"impact.speed": np.linspace(0.05, 0.1, 3)}
    actual = check(scene, columns, 0.1)
    assert not any("inertia" in names for names in actual.effects)
    in_arrays(monkeypatch, scene, columns, 0.1)


def test_rows_without_a_required_density_are_rejected_in_arrays(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tables = {name: table for name, table in STEEL_ON_GLASS.items() if name != "effects"}
    plate = {"radius": 0.3, "thickness": 0.05, "youngs_modulus": 7e10, "poissons_ratio": 0.22}
    columns = {"impact.speed": np.array([0.05, 0.5, 2.0]), "plate.thickness": np.full(3, 0.01)}
    scene = read({**tables, "plate": plate})
    assert "plate.density" in check(scene, columns).reason[0]
    monkeypatch.setattr(many, "simulate", never)
    assert set(solve(scene, columns).status) == {"rejected"}


def test_rejected_and_separately_solved_rows_are_simulations() -> None:
    scene = scene_with()
    speeds = np.array([0.2, -1.0, np.nan, 0.0, 1e4, 0.3])
    actual = check(scene, {"impact.speed": speeds}, 1e-1)
    assert actual.status.tolist() == ["finished", *["rejected"] * 4, "finished"]
    thin = {"plate.thickness": np.array([0.004, 0.05]), "impact.speed": np.array([2.0, 0.2])}
    assert "non_hertzian_pressure" in check(scene, thin, 1e-4).effects[0]


def test_rows_with_and_without_weight_are_separated() -> None:
    columns = {"impact.gravity": np.array([0.0, 9.81, 1e4, 0.0])}
    actual = check(scene_with(), columns, 1e-2)
    assert "gravity" in actual.effects[2]
    assert "gravity" not in actual.effects[0]


def test_columns_of_materials_and_alternative_keys() -> None:
    own = {"youngs_modulus": 6e10, "poissons_ratio": 0.2, "density": 2400.0}
    scene = scene_with(plate={"material": "pane"}, materials={"pane": own})
    columns = {
        "materials.pane.youngs_modulus": np.array([5e10, 7e10, -1.0]),
        "materials.pane.poissons_ratio": np.array([0.1, 0.3, 0.3]),
        "sphere.mass": np.array([0.03, 0.02, 0.01]),
        "plate.half_thickness": np.array([0.02, 0.03, 0.03]),
    }
    check(scene, columns, 1e-1)


def test_each_row_may_have_its_own_strength() -> None:
    columns = {"plate.tensile_strength": np.array([1e3, 1e12])}
    weak, strong = check(scene_with(), columns, 1e-1).reason
    assert "predicted to fail" in weak
    assert "predicted to fail" not in strong


def test_rows_do_not_depend_on_their_number(monkeypatch: pytest.MonkeyPatch) -> None:
    columns = {"impact.speed": np.linspace(0.1, 0.5, 7)}
    whole = solve(scene_with(), columns, 1e-1)
    monkeypatch.setattr(many, "BLOCK", 2)
    parts = solve(scene_with(), columns, 1e-1)
    for name in UNITS:
        np.testing.assert_array_equal(parts.results[name], whole.results[name])
    assert list(parts.effects) == list(whole.effects)


def test_rows_in_arrays_end_after_the_given_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """A batch of a study ends if its rows take far longer than those before."""
    columns = {"impact.speed": np.linspace(0.1, 0.5, 7)}
    monkeypatch.setattr(many, "FIRST", 3)
    some = solve(scene_with(), columns, 1e-1, seconds=0.0)
    assert set(some.status) == {"finished"}
    assert len(some) == 3
    assert len(solve(scene_with(), columns, 1e-1)) == 7


def test_errors_of_rows_on_supported_plates_do_not_depend_on_their_number() -> None:
    """NumPy rounds powers of one Poisson's ratio and of many differently."""
    soft = {"radius": 0.1, "half_thickness": 1e-3, "youngs_modulus": 1e8, "poissons_ratio": 0.3,
            "edge": "simply-supported"}  # fmt: skip
    scene = read({"sphere": {"radius": 0.01, "material": "steel"}, "plate": soft,
                  "impact": {"speed": 1.0}, "effects": {"inertia": False}})  # fmt: skip
    check(scene, {"plate.poissons_ratio": np.linspace(0.2, 0.4, 41)})


def test_the_widest_contact_of_a_row_does_not_depend_on_other_rows() -> None:
    """Only the wide sphere may leave its plate; the law of the other one ends at its radius."""
    plate = {"radius": 0.05, "thickness": 0.03, "youngs_modulus": 3e8, "material": None}
    scene = scene_with(plate=plate | {"poissons_ratio": 0.37}, effects={"inertia": False})
    check(
        scene, {"impact.speed": np.array([107.0, 0.08]), "sphere.radius": np.array([1.6e-3, 0.056])}
    )


@pytest.mark.parametrize("length", [1e-3, 1e3])
def test_rows_in_other_units_of_length_are_the_same_impacts(length: float) -> None:
    """The results scale with the unit of length as their dimensions require."""
    paper = load(PAPER).to_json()
    speeds = np.linspace(0.2, 1.5, 4)
    here = solve(load(PAPER), {"impact.speed": speeds})
    sphere, plate = dict(paper["sphere"]), dict(paper["plate"])
    sphere |= {"radius": sphere["radius"] * length, "density": sphere["density"] / length**3}
    plate |= {key: plate[key] * length for key in ("radius", "half_thickness")}
    plate |= {key: plate[key] / length for key in ("lame_lambda", "lame_mu")}
    scene = read(paper | {"sphere": sphere, "plate": plate})
    in_other_units = solve(scene, {"impact.speed": speeds * length})
    powers = {"max_indentation": 1, "max_force": 1, "max_contact_radius": 1, "max_pressure": -1}
    for name in ("contact_time", "restitution", *powers):
        scaled = here.results[name] * length ** powers.get(name, 0)
        assert in_other_units.results[name] == pytest.approx(scaled, rel=1e-12)


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ({"plate.colour": np.ones(2)}, "takes numbers or names"),
        ({"impact.speed": np.ones(2), "plate.radius": np.ones(3)}, "of the same length"),
        ({"impact.speed": np.ones((2, 2))}, "of the same length"),
        ({}, "one or more arrays"),
    ],
)
def test_invalid_columns_are_rejected(columns: Any, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        solve(load(PAPER), columns)


def test_errors_of_many_laws_are_those_of_each() -> None:
    chance = np.random.default_rng(3)
    low, up, energy = 10 ** chance.uniform(-12, -1, (3, 200))
    fall, rise = chance.uniform(0.0, 2.1, (2, 200))
    actual = np.array(law_errors(low, up, fall, rise, energy))
    each = [simple_impact.law_errors(*numbers) for numbers in
            zip(low, up, fall, rise, energy, strict=True)]  # fmt: skip
    np.testing.assert_allclose(actual.T, each, rtol=1e-12)
