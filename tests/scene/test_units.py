"""Values in other units than SI are named in warnings, and those of real materials are not."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from derivation.scene import SceneError, indent, read, simulate
from derivation.scene.input.materials import MATERIALS
from derivation.scene.input.quoted import in_unit
from derivation.scene.input.units import unit_warnings, unit_warnings_of_rows
from derivation.scene.rows.rows import solve

TILE = {"radius": 0.15, "thickness": 0.009, "youngs_modulus": 65e9, "poissons_ratio": 0.2}
SCENE: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.008, "material": "glass"},
    "plate": TILE | {"density": 2350.0, "yield_stress": 3e9, "tensile_strength": 40e6},
    "impact": {"speed": 2.0},
}


def with_value(place: str, value: float) -> dict[str, Any]:
    table, key = place.split(".")
    return SCENE | {table: SCENE[table] | {key: value}}


@pytest.mark.parametrize(
    ("place", "unit"),
    [
        ("plate.youngs_modulus", 1e9),
        ("plate.youngs_modulus", 1e6),
        ("plate.density", 1e3),
        ("plate.density", 1e12),
        ("plate.yield_stress", 1e6),
        ("plate.yield_stress", 1e9),
        ("plate.tensile_strength", 1e6),
        ("plate.thickness", 1e-3),
        ("plate.radius", 1e-3),
        ("sphere.radius", 1e-3),
        ("impact.speed", 1e-3),
    ],
)
def test_each_value_in_another_unit_is_named_with_its_value_in_si_units(
    place: str, unit: float
) -> None:
    table, key = place.split(".")
    value = SCENE[table][key]
    [text] = unit_warnings(read(with_value(place, value / unit)))
    assert text.startswith(f"{place} = ")
    assert f"write {value:.6g}" in text


@pytest.mark.parametrize(("key", "unit"), [("yield_stress", "MPa"), ("tensile_strength", "MPa")])
def test_strength_is_compared_with_the_modulus_of_a_named_material(key: str, unit: str) -> None:
    plate = {"radius": 0.15, "thickness": 0.009, "material": "glass"}
    assert not unit_warnings(read(SCENE | {"plate": plate | {key: 45e6}}))
    [text] = unit_warnings(read(SCENE | {"plate": plate | {key: 45.0}}))
    assert f"plate.{key} = 45 Pa" in text
    assert f"in {unit}, write 4.5e+07" in text
    gel = {"youngs_modulus": 1e6, "poissons_ratio": 0.2, "density": 1000.0}
    soft = {"plate": plate | {"material": "gel", key: 45.0}, "materials": {"gel": gel}}
    assert not unit_warnings(read(SCENE | soft))


def test_grams_are_distinguished_from_a_mass_larger_than_that_of_the_sphere() -> None:
    solid = 4.0 / 3.0 * np.pi * 0.008**3 * 2500.0
    [text] = unit_warnings(read(with_value("sphere.mass", 1000.0 * solid)))
    assert f"write {solid:.6g}" in text
    assert not unit_warnings(read(with_value("sphere.mass", 150.0 * solid)))


@pytest.mark.parametrize("name", [name for name, one in MATERIALS.items() if one.density])
def test_no_value_of_a_real_material_gets_a_warning(name: str) -> None:
    one = MATERIALS[name]
    keys = ("youngs_modulus", "poissons_ratio", "density", "yield_stress")
    own = {key: getattr(one, key) for key in keys if getattr(one, key) is not None}
    plate = {"radius": 0.1, "thickness": 0.01} | own
    scene = {"sphere": {"radius": 0.01} | own, "plate": plate, "impact": {"speed": 1.0}}
    assert not unit_warnings(read(scene))


@pytest.mark.parametrize(
    ("modulus", "density"), [(1e7, 25.0), (1.1e5, 1060.0), (1.05e12, 3515.0), (16e9, 11340.0)]
)
def test_foam_gel_diamond_and_lead_get_no_warning(modulus: float, density: float) -> None:
    plate = {"radius": 0.1, "thickness": 0.01, "youngs_modulus": modulus, "poissons_ratio": 0.3}
    scene = SCENE | {"plate": plate | {"density": density}}
    assert not unit_warnings(read(scene))


def test_a_rejection_begins_with_the_warning() -> None:
    wrong = read(with_value("plate.youngs_modulus", 65.0))
    for run in (lambda: simulate(wrong), lambda: indent(wrong, force=10.0)):
        with pytest.raises(SceneError, match=r"^plate\.youngs_modulus = 65 Pa"):
            run()


def test_each_warning_before_an_error_has_a_line() -> None:
    plate = {"radius": 150.0, "thickness": 8.0, "youngs_modulus": 70.0, "poissons_ratio": 0.2}
    sphere, impact = {"radius": 8.0, "material": "glass"}, {"speed": 4.4}
    tables = {"sphere": sphere, "plate": plate | {"density": 2.5}, "impact": impact}
    with pytest.raises(SceneError) as error:
        simulate(read(tables | {"effects": {"stretching": False}}))
    lines = str(error.value).split("\n")
    assert [line.split()[0] for line in lines] == [
        "plate.youngs_modulus",
        "plate.density",
        "sphere.radius",
        "plate.radius",
        "effects.inertia:",
    ]


@pytest.mark.parametrize(
    ("rtol", "remedy"),
    [
        (5, "for 5 % write 0.05"),
        (2.5, "for 2.5 % write 0.025"),
        (1e-14, "`platecontact reference SCENE.toml --digits N`"),
        (np.float32(1e-14), "`platecontact reference SCENE.toml --digits N`"),
        (0.0, "`platecontact reference SCENE.toml --digits N`"),
        (-1e-3, "write for example 0.01"),
        (float("nan"), "write for example 0.01"),
        (True, "write for example 0.01"),
    ],
)
def test_remedy_of_a_tolerance_fits_its_value(rtol: float, remedy: str) -> None:
    with pytest.raises(SceneError) as error:
        simulate(read(SCENE), rtol=rtol)
    assert str(error.value).endswith(remedy)
    if rtol == 5:
        with pytest.raises(SceneError, match=r"accuracy\.rtol.*for 5 % write 0\.05"):
            read(SCENE | {"accuracy": {"rtol": 5}})


def test_rows_have_the_warnings_of_single_scenes() -> None:
    scene = read(SCENE | {"effects": {"inertia": False}, "accuracy": {"rtol": 0.01}})
    columns = {
        "plate.youngs_modulus": np.array([65e9, 65e6, 65e3, 65.0, 65e9]),
        "plate.density": np.array([2350.0, 2350.0, 2350.0, 2350.0, 2.35]),
        "impact.speed": np.array([0.1, 0.1, 1e-4, 1e-4, 0.1]),
    }
    rows = solve(scene, columns)
    for row in range(5):
        values = {key: float(column[row]) for key, column in columns.items()}
        tables = {**SCENE, "effects": {"inertia": False}, "accuracy": {"rtol": 0.01}}
        for place, value in values.items():
            table, key = place.split(".")
            tables[table] = tables[table] | {key: value}
        try:
            expected = "; ".join(simulate(read(tables)).warnings)
        except SceneError as error:
            expected = str(error)
        assert rows.reason[row] == expected


@given(st.lists(st.sampled_from([1e-30, 1e-15, 1.0, 1e15, 1e30]), min_size=7, max_size=7))
def test_extreme_values_are_compared_without_overflow(values: list[float]) -> None:
    """NumPy's warnings are errors in tests, and powers of Python's floats raise one."""
    modulus, density, radius, mass, wide, thickness, speed = values
    extreme = read(
        {
            "materials": {
                "pane": {"youngs_modulus": modulus, "poissons_ratio": 0.2, "density": density}
            },
            "sphere": {"radius": radius, "mass": mass, "material": "pane"},
            "plate": {"radius": wide, "thickness": thickness, "material": "pane"},
            "impact": {"speed": speed},
        }
    )
    column = np.array([1e-300, 1.0, 1e300])
    rows = unit_warnings_of_rows(extreme, {"plate.radius": column, "sphere.radius": column})
    assert set(rows) <= {0, 1, 2}
    assert isinstance(unit_warnings(extreme), tuple)


def test_a_density_in_grams_per_cubic_centimetre_is_named_once() -> None:
    sphere = {"radius": 0.01, "youngs_modulus": 210e9, "poissons_ratio": 0.3}
    plate = SCENE["plate"] | {"thickness": 0.018}
    scene = SCENE | {"sphere": sphere | {"density": 7.85}, "plate": plate}
    scene |= {"effects": {"inertia": False}}
    [text] = [text for text in simulate(read(scene)).warnings if "density" in text]
    assert "write 7850" in text
    table = solve(read(scene), {"impact.speed": np.array([1.0, 2.0])})
    assert [reason.count("density") for reason in table.reason] == [1, 1]


@pytest.mark.parametrize(
    ("text", "unit", "number"),
    [
        ("10 mm", "m", 0.01),
        ("2.5in", "m", 0.0635),
        ("70 GPa", "Pa", 7e10),
        ("240 N/mm²", "Pa", 2.4e8),
        ("1e3 psi", "Pa", 6.894757e6),
        ("2.7 g", "kg", 2.7e-3),
        ("30 mg", "kg", 30e-6),
        ("5 kg", "kg", 5.0),
        ("2.7 g/cm3", "kg/m^3", 2700.0),
        ("36 km/h", "m/s", 10.0),
        ("300 mm/s", "m/s", 0.3),
        ("12 us", "s", 12e-6),
        ("1 g", "m/s^2", 9.80665),
        ("2 %", "1", 0.02),
        ("1.5", "m", 1.5),
        ("10 kg", "m", None),
        ("-10 mm", "m", None),
        ("1.2.3 mm", "m", None),
        ("0 mm", "m", None),
        ("nan", "m", None),
        ("", "m", None),
        ("clamped", "", None),
    ],
)
def test_a_quoted_number_is_suggested_in_the_unit_of_its_key(
    text: str, unit: str, number: float | None
) -> None:
    assert in_unit(text, unit) == (None if number is None else pytest.approx(number, rel=1e-7))


@given(st.text(max_size=20), st.sampled_from(["m", "s", "Pa", "kg", "kg/m^3", "m/s", "1", ""]))
def test_any_quoted_text_is_read(text: str, unit: str) -> None:
    number = in_unit(text, unit)
    assert number is None or 0.0 < number < np.inf
