"""Scenes: what is read, what is refused and in which words, and what an impact gives."""

import json
import math
import random
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import hertz_double as hertz
import numpy as np
import pytest

import derivation.scene
from derivation.scene import SceneError, indent, kernels, limits, load, read, schema, simulate
from derivation.scene.law import WHOLE_PLATE, Law
from derivation.scene.model import model_of

EXAMPLES = Path(derivation.scene.__file__).parent / "examples"

GOOD = """[sphere]
radius = 0.13
mass = 72
[plate]
radius = 1.0
thickness = 0.2
lame_lambda = 0.36e9
lame_mu = 0.43e9
[impact]
speed = 1
"""
LAME = "lame_lambda = 0.36e9\nlame_mu = 0.43e9"
ALL = "sphere: expected a table|plate: expected a table|impact: expected a table"

# What stands in the good scene, what stands there instead, and words of the message.
BAD = [
    ("thickness = 0.2", "thicknes = 0.2", "plate.thicknes: unknown key|did you mean thickness?"),
    ("thickness = 0.2", "half-thickness = 0.1", "did you mean half_thickness?"),
    ("thickness = 0.2", "thickness = 0.2\ncolour = 1", "plate.colour|lame_lambda|remove it"),
    ("radius = 1.0", "radius = 1.0\nspeed = 1", "plate.speed: unknown key|move it to [impact]"),
    ("[sphere]", "speed = 1\n[sphere]", "speed: unknown table|move it to [impact]"),
    ("[impact]", "[imapct]", "imapct: unknown table|did you mean impact?|table [impact], got none"),
    ("speed = 1", "", "impact.speed: expected a positive number|[m/s]|got nothing|`speed = 1`"),
    ("[impact]\nspeed = 1", "", "impact: expected a table [impact], got none|add [impact]"),
    ("[impact]\nspeed = 1", "[[impact]]\nspeed = 1", "impact: expected a table|got an array"),
    ("[sphere]\nradius = 0.13\nmass = 72", "sphere = 3", "sphere: expected a table|got 3"),
    (GOOD, "", ALL),
    ("radius = 1.0", "radius = -1.0", "plate.radius|a positive number, the plate radius|got -1"),
    ("radius = 1.0", "radius = 0", "plate.radius|got 0"),
    ("radius = 1.0", "radius = -0.0", "plate.radius|got -0"),
    ("radius = 1.0", "radius = nan", "plate.radius|got nan"),
    ("radius = 1.0", "radius = inf", "plate.radius|got inf"),
    ("radius = 1.0", 'radius = "1.0"', 'plate.radius|got the string "1.0"|without quotes'),
    ("radius = 1.0", "radius = true", "plate.radius|got true"),
    ("radius = 1.0", "radius = [1.0]", "plate.radius|got an array"),
    ("radius = 1.0", "radius = { m = 1.0 }", "plate.radius|got a table"),
    ("radius = 1.0", "radius = 2026-01-01", "plate.radius|got 2026-01-01"),
    ("radius = 1.0", "radius = 1" + "0" * 400, "plate.radius|got 1000"),
    ("radius = 1.0", "radius = 1" + "0" * 5000, "numbers too long"),
    ("radius = 1.0", "radius = " + "[" * 5000, "brackets too deep"),
    ("speed = 1", "speed = 0", "impact.speed|got 0"),
    ("mass = 72", "", "[sphere]: expected either sphere.mass or sphere.density|neither|add"),
    ("mass = 72", "mass = 72\ndensity = 7850", "sphere.mass or sphere.density, got both|remove"),
    ("mass = 72", "mass = -72", "sphere.mass: expected a positive number|[kg]|got -72"),
    ("thickness = 0.2", "", "plate.half_thickness or plate.thickness, got neither"),
    ("thickness = 0.2", "thickness = 0.2\nhalf_thickness = 0.1", "thickness|got both"),
    (LAME, "", "lame_lambda, plate.lame_mu or the pair|got neither"),
    (LAME, "lame_mu = 1e9", "got only plate.lame_mu|add plate.lame_lambda"),
    (LAME, "youngs_modulus = 1e9", "got only plate.youngs_modulus|add plate.poissons_ratio"),
    (LAME, "lame_mu = 1e9\npoissons_ratio = 0.3", "only plate.lame_mu and plate.poissons_ratio"),
    (LAME, LAME + "\npoissons_ratio = 0.3", "remove plate.poissons_ratio"),
    (LAME, LAME + "\nyoungs_modulus = 1e9\npoissons_ratio = 0.3", "got both"),
    (LAME, "youngs_modulus = 1e9\npoissons_ratio = 0.5", "poissons_ratio|below 0.5|got 0.5"),
    (LAME, "youngs_modulus = 1e9\npoissons_ratio = -1", "poissons_ratio|above -1|got -1"),
    (LAME, "youngs_modulus = 0\npoissons_ratio = 0.3", "plate.youngs_modulus|got 0"),
    ("[impact]", "[accuracy]\n[impact]", "accuracy.rtol|got nothing|`rtol = 1e-06`"),
    ("[impact]", "[accuracy]\ntol = 1\n[impact]", "accuracy.tol: unknown key|did you mean rtol?"),
    ("[impact]", "[accuracy]\nrtol = 1e-14\n[impact]", "from 1e-13 to 1|got 1e-14|reference"),
    ("lame_mu = 0.43e9", "lame_mu = 0.0", "plate.lame_mu: expected a positive number|got 0"),
    ("lame_lambda = 0.36e9", "lame_lambda = -0.3e9", "3 lame_lambda + 2 lame_mu|got|raise"),
    ("lame_lambda = 0.36e9", "lame_lambda = -inf", "plate.lame_lambda: expected a finite number"),
    ("lame_lambda = 0.36e9", "lame_lambda = 0,36e9", "not valid TOML|line 7"),
    ("radius = 1.0", "radius = 1.0\nradius = 2.0", "not valid TOML|line 6"),
]  # fmt: skip


def changed(**tables: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """The good scene, Hertz' pressure under a paraboloid, keys replaced or removed by None."""
    made: dict[str, dict[str, Any]] = {
        "sphere": {"radius": 0.13, "mass": 72.0},
        "plate": {"radius": 1.0, "thickness": 0.2, "lame_lambda": 0.36e9, "lame_mu": 0.43e9},
        "impact": {"speed": 1.0},
        "effects": {"curvature": False, "pressure": False},
    }
    for name, keys in tables.items():
        made[name] = {k: v for k, v in (made[name] | dict(keys)).items() if v is not None}
    return made


@pytest.mark.parametrize(("old", "new", "says"), BAD)
def test_bad_scene_is_one_clear_message(old: str, new: str, says: str, tmp_path: Path) -> None:
    assert GOOD.count(old) == 1
    path = tmp_path / "scene.toml"
    path.write_text(GOOD.replace(old, new))
    with pytest.raises(SceneError) as caught:
        load(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    for words in says.split("|"):
        assert words in message
    assert len(message) < 1200
    assert "pydantic" not in message


def test_several_problems_are_listed_together(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    bad = GOOD.replace("radius = 1.0", "radius = -1.0").replace("thickness = 0.2", "thik = 1")
    path.write_text(bad.replace("mass = 72", "").replace("speed = 1", "speed = '1'"))
    with pytest.raises(SceneError, match="5 problems") as caught:
        load(path)
    lines = str(caught.value).splitlines()[1:]
    for key in ("plate.radius", "plate.thik", "[plate]", "[sphere]", "impact.speed"):
        assert sum(line.startswith(f"  - {key}: ") for line in lines) == 1


def test_file_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="No such file"):
        load(tmp_path / "absent.toml")
    with pytest.raises(SceneError, match="not a file"):
        load(tmp_path)
    (tmp_path / "bytes.toml").write_bytes(b"[sphere]\n# \xff\n")
    with pytest.raises(SceneError, match="UTF-8"):
        load(tmp_path / "bytes.toml")


def test_unreadable_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(GOOD)

    def refuse(self: Path) -> bytes:
        raise PermissionError(13, "Permission denied", str(self))

    monkeypatch.setattr(Path, "read_bytes", refuse)
    with pytest.raises(SceneError, match=r"Permission denied.*check its name and permissions"):
        load(path)


def test_good_scenes_are_read_alike(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text("\ufeff" + GOOD, encoding="utf-8")
    scene = load(path)
    assert scene.to_json() | {"effects": changed()["effects"]} == changed()
    assert model_of(scene).h == 0.1
    same = read(changed(plate={"thickness": None, "half_thickness": 0.1}))
    assert model_of(same) == model_of(scene)
    density = 72 / (4 / 3 * math.pi * 0.13**3)
    by_density = read(changed(sphere={"mass": None, "density": density}))
    assert model_of(by_density).m == pytest.approx(72, rel=1e-15)
    lam, mu = 0.36e9, 0.43e9
    by_young = read(changed(plate={
        "lame_lambda": None, "lame_mu": None,
        "youngs_modulus": mu * (3 * lam + 2 * mu) / (lam + mu),
        "poissons_ratio": lam / (2 * (lam + mu)),
    }))  # fmt: skip
    assert model_of(by_young).lam == pytest.approx(lam, rel=1e-14)
    assert model_of(by_young).mu == pytest.approx(mu, rel=1e-14)


def test_negative_lame_lambda_of_a_stable_material_is_allowed() -> None:
    model = model_of(read(changed(plate={"lame_lambda": -0.28e9})))
    assert model.lam == -0.28e9


def test_scene_is_frozen() -> None:
    scene = read(changed())
    with pytest.raises(ValueError, match="frozen"):
        scene.plate.radius = 2.0  # type: ignore[misc]


def test_direct_construction_is_validated_too() -> None:
    from derivation.scene.scene import Plate

    with pytest.raises(ValueError, match=r"\[plate\]: expected either .* got neither"):
        Plate(radius=1.0)


@pytest.mark.parametrize("data", [[1], {"sphere": {1: 2}}, {3: 4}])
def test_data_that_are_no_tables(data: Any) -> None:
    with pytest.raises(SceneError, match="expected"):
        read(data)


def test_any_damage_is_a_scene_error(tmp_path: Path) -> None:
    """Random edits of a good scene either load or are refused in words; nothing else happens."""
    chance = random.Random(7)
    text, refused = GOOD, 0
    path = tmp_path / "scene.toml"
    for _ in range(400):
        place = chance.randrange(len(text))
        path.write_text(text[:place] + chance.choice('[]=."-0\nx{}') + text[place + 1 :])
        try:
            load(path)
        except SceneError:
            refused += 1
    assert 200 < refused < 400


def test_schema_describes_every_key_and_choice() -> None:
    made = schema()
    json.dumps(made)
    assert made["required"] == ["sphere", "plate", "impact"]
    plate = made["$defs"]["Plate"]
    assert plate["additionalProperties"] is False
    assert plate["required"] == ["radius"]
    assert plate["properties"]["lame_mu"]["exclusiveMinimum"] == 0
    assert plate["properties"]["poissons_ratio"]["exclusiveMaximum"] == 0.5
    assert [len(choice["oneOf"]) for choice in plate["allOf"]] == [2, 3]
    for table in made["$defs"].values():
        for key in table["properties"].values():
            assert key["description"]
            if key.get("type") == "number":
                assert "[" in key["description"]
    assert made["$defs"]["Effects"]["properties"]["bending"]["anyOf"] == [
        {"const": "auto", "type": "string"}, {"type": "boolean"},
    ]  # fmt: skip


def thick(speed: float = 1.0, size: float = 1e6) -> Any:
    """A plate so large that it is Hertz's half-space."""
    return read(changed(plate={"radius": size, "thickness": 2 * size}, impact={"speed": speed}))


def test_thick_plate_gives_hertz() -> None:
    scene = thick()
    m = model_of(scene)
    found = simulate(scene)
    truth = hertz.impact(m.R, m.m, m.v0, m.h, m.b, m.lam, m.mu)
    ours = (
        found.contact_time, found.max_indentation, found.max_force, found.max_contact_radius,
    )  # fmt: skip
    np.testing.assert_allclose(ours, truth, rtol=1e-6)
    assert found.warnings == ()


def test_history_starts_and_ends_free_and_keeps_the_energy() -> None:
    result = simulate(load(EXAMPLES / "paper.toml"))
    history = result.history(101)
    assert len(history.time) == 101
    assert history.time[-1] == result.contact_time
    assert history.indentation[0] == history.force[0] == 0
    assert history.velocity[0] == 1
    assert history.velocity[-1] == pytest.approx(-1, rel=1e-9)
    assert history.indentation[-1] == pytest.approx(0, abs=1e-9 * result.max_indentation)
    assert history.indentation[50] == pytest.approx(result.max_indentation, rel=1e-9)
    assert history.force[50] == pytest.approx(result.max_force, rel=1e-9)
    assert (history.force[1:-1] > 0).all()
    taken = np.trapezoid(history.force, history.time)
    assert taken == pytest.approx(2 * result.model.m * result.model.v0, rel=1e-3)


def test_history_at_times_asked_for() -> None:
    scene = read(changed())
    whole = simulate(scene)
    times = [0.0, whole.contact_time / 3, whole.contact_time]
    found = simulate(scene, times=times)
    assert found.history().time.tolist() == times
    assert found.history(5).time.shape == (5,)
    assert whole.history().time.shape == (201,)
    for bad in ([-1e-9], [2 * whole.contact_time], [math.nan], [math.inf]):
        with pytest.raises(SceneError, match="times: expected times from 0 to the contact time"):
            simulate(scene, times=bad)
    with pytest.raises(SceneError, match="at least 2"):
        whole.history(1)


def test_json_keys_and_notebook_table() -> None:
    scene = read(changed())
    result = simulate(scene)
    made = result.to_json()
    assert list(made) == [
        "contact_time", "max_indentation", "max_force", "max_contact_radius", "max_pressure",
        "accuracy", "model_error", "effects", "warnings", "scene",
    ]  # fmt: skip
    again = json.loads(json.dumps(made))
    assert again["contact_time"] == result.contact_time
    assert read(again["scene"]) == scene
    shown = result._repr_html_()
    assert shown.startswith("<table>")
    assert f"{result.max_force:.6g}" in shown


def test_units_do_not_matter() -> None:
    """Millimetre, tonne, second: stress in MPa, force in N; dimensionless results agree."""
    metre = simulate(read(changed()))
    millimetre = simulate(read({
        "sphere": {"radius": 130.0, "mass": 0.072},
        "plate": {"radius": 1000.0, "thickness": 200.0, "lame_lambda": 360.0, "lame_mu": 430.0},
        "impact": {"speed": 1000.0},
        "effects": {"curvature": False, "pressure": False},
    }))  # fmt: skip
    assert millimetre.contact_time == pytest.approx(metre.contact_time, rel=1e-13)
    assert millimetre.max_indentation == pytest.approx(1e3 * metre.max_indentation, rel=1e-13)
    assert millimetre.max_contact_radius == pytest.approx(1e3 * metre.max_contact_radius, rel=1e-13)
    assert millimetre.max_force == pytest.approx(metre.max_force, rel=1e-13)
    numbers = metre.model.dimensionless()
    for name, number in millimetre.model.dimensionless().items():
        assert number == pytest.approx(numbers[name], rel=1e-14)


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


@pytest.mark.parametrize(
    "tables",
    [
        {"impact": {"speed": 1e-300}},
        {"impact": {"speed": 1e300}},
        {"sphere": {"radius": 1e150, "mass": None, "density": 7850.0}},
        {"sphere": {"mass": 1e-320}},
        {"plate": {"lame_lambda": 1e308, "lame_mu": 1e308}},
        {"plate": {"radius": 1e-300}},
        {
            "plate": {
                "lame_lambda": None, "lame_mu": None,
                "youngs_modulus": 1e9, "poissons_ratio": -0.9999999999999999,
            }
        },
    ],
)  # fmt: skip
@pytest.mark.filterwarnings("error")
def test_extreme_scene_gives_numbers_or_words(tables: dict[str, dict[str, float]]) -> None:
    try:
        found = simulate(read(changed(**tables)))
    except SceneError as error:
        found, words = None, str(error)
    if found is None:
        assert "expected" in words or "less extreme" in words
    else:
        numbers = (found.contact_time, found.max_indentation, found.max_force)
        assert all(0 < number < math.inf for number in numbers)


def test_kernel_without_a_number_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    nothing = hertz.Impact(*(np.array(math.nan) for _ in range(4)))
    monkeypatch.setattr(kernels, "impact", lambda *_, **__: nothing)
    with pytest.raises(SceneError, match=r"no number for h/b = 0\.1"):
        simulate(read(changed()))


def test_kernel_beyond_the_radius_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kernels, "impact", lambda *_, **__: hertz.Impact(1.0, 1.0, 1.0, 0.14))
    with pytest.raises(SceneError, match=r"below min\(b, R\) = 0\.13 m, got 0\.14 m"):
        simulate(read(changed()))


def test_energy_is_the_integral_of_the_force() -> None:
    m = model_of(thick())
    a = 0.1
    P = float(hertz.force_of_radius(a, m.R, m.lam, m.mu))
    assert limits.energy_of(Law(m, WHOLE_PLATE), a) == pytest.approx(0.4 * P * a**2 / m.R, rel=1e-5)


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


def test_indent_by_each_of_the_three_agrees() -> None:
    scene = read(changed())
    rows = indent(scene, contact_radius=[1e-3, 5e-3, 2e-2])
    assert [row.contact_radius for row in rows] == [1e-3, 5e-3, 2e-2]
    by_force = indent(scene, force=np.array([row.force for row in rows]))
    by_depth = indent(scene, indentation=tuple(row.indentation for row in rows))
    for row, other, third in zip(rows, by_force, by_depth, strict=True):
        for found in (other, third):
            assert found.contact_radius == pytest.approx(row.contact_radius, rel=1e-12)
            assert found.stiffness == pytest.approx(row.stiffness, rel=1e-12)
            assert found.max_pressure == pytest.approx(row.max_pressure, rel=1e-12)
        assert other.force == row.force
        assert third.indentation == row.indentation
    step = 1e-4
    lower, upper = indent(scene, indentation=[rows[1].indentation * (1 + s) for s in (-step, step)])
    slope = (upper.force - lower.force) / (upper.indentation - lower.indentation)
    assert rows[1].stiffness == pytest.approx(slope, rel=1e-6)
    assert rows[1].max_pressure == pytest.approx(
        1.5 * rows[1].force / (math.pi * rows[1].contact_radius ** 2), rel=1e-12
    )


def test_indent_takes_a_single_number() -> None:
    [row] = indent(read(changed()), force=10.0)
    assert row.force == 10.0
    assert row.to_json().keys() == {
        "contact_radius", "indentation", "force", "stiffness", "max_pressure", "warnings",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({}, "exactly one of contact_radius, force and indentation, got none"),
        ({"force": 1.0, "indentation": 1e-3}, "got force and indentation"),
        ({"force": []}, "force: expected one or more positive numbers"),
        ({"force": "10"}, "got a string"),
        ({"force": [1.0, -1.0]}, "got -1"),
        ({"force": [0.0]}, "got 0"),
        ({"force": [math.nan]}, "got nan"),
        ({"force": [math.inf]}, "got inf"),
        ({"force": [True]}, "got true"),
        ({"force": ["1"]}, "got the string"),
        ({"force": 1e30}, "force: expected less than .* got 1e\\+30 N; give a smaller force"),
        ({"contact_radius": 0.13}, "contact_radius = 0.13 m: .* min\\(b, R\\) = 0.13 m"),
        ({"indentation": 1e3}, "indentation: expected less than .* got 1000 m"),
        ({"contact_radius": 1e-300}, "no number"),
    ],
)
@pytest.mark.filterwarnings("error")
def test_indent_refuses(given: dict[str, Any], says: str) -> None:
    with pytest.raises(SceneError, match=says):
        indent(read(changed()), **given)


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_examples_run(path: Path) -> None:
    result = simulate(load(path))
    assert (result.warnings == ()) == (path.stem == "paper")  # each other is near some limit
    assert result.contact_time > 0


def test_paper_example_holds_what_the_paper_gives() -> None:
    model = model_of(load(EXAMPLES / "paper.toml"))
    assert (model.R, model.v0, model.lam, model.mu) == (0.13, 1.0, 0.36e9, 0.43e9)
    assert model.eta == 0.1
    assert simulate(load(EXAMPLES / "paper.toml")).max_contact_radius / (2 * model.h) < 0.1


def test_public_names() -> None:
    for name in derivation.scene.__all__:
        assert callable(getattr(derivation.scene, name))
    with pytest.raises(AttributeError, match="nonsense"):
        _ = derivation.scene.nonsense
