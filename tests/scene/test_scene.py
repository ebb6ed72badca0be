"""Scene files: valid and rejected files, and the messages on errors."""

import json
import math
import random
from pathlib import Path
from typing import Any

import platecontact as pc
import pytest
from shared_scenes import changed

from derivation.scene import SceneError, load, read, schema
from derivation.scene.effects import EFFECTS
from derivation.scene.model import model_of

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
ALL = "sphere: |plate: |impact: "

# Text of the valid scene, its replacement, and words of the message.
BAD = [
    ("thickness = 0.2", "thicknes = 0.2", "plate.thicknes: |thickness?"),
    ("thickness = 0.2", "half-thickness = 0.1", "half_thickness?"),
    ("thickness = 0.2", "thickness = 0.2\ncolour = 1", "plate.colour|lame_lambda"),
    ("radius = 1.0", "radius = 1.0\nspeed = 1", "plate.speed: |[impact]"),
    ("[sphere]", "speed = 1\n[sphere]", "speed: |[impact]"),
    ("[impact]", "[imapct]", "imapct: |impact?|[impact]"),
    ("speed = 1", "", "impact.speed: |[m/s]|`speed = 1`"),
    ("[impact]\nspeed = 1", "", "impact: |[impact]"),
    ("[impact]\nspeed = 1", "[[impact]]\nspeed = 1", "impact: |array"),
    ("[sphere]\nradius = 0.13\nmass = 72", "sphere = 3", "sphere: |3"),
    (GOOD, "", ALL),
    ("radius = 1.0", "radius = -1.0", "plate.radius|[m]|-1"),
    ("radius = 1.0", "radius = 0", "plate.radius|got 0"),
    ("radius = 1.0", "radius = -0.0", "plate.radius|got -0"),
    ("radius = 1.0", "radius = nan", "plate.radius|got nan"),
    ("radius = 1.0", "radius = inf", "plate.radius|got inf"),
    ("radius = 1.0", 'radius = "1.0"', 'plate.radius|"1.0"|quotes'),
    ("radius = 1.0", 'radius = "250 mm"', 'plate.radius|"250 mm"|in m|`radius = 0.25`'),
    ("radius = 1.0", "radius = true", "plate.radius|got true"),
    ("radius = 1.0", "radius = [1.0]", "plate.radius|array"),
    ("radius = 1.0", "radius = { m = 1.0 }", "plate.radius|table"),
    ("radius = 1.0", "radius = 2026-01-01", "plate.radius|2026-01-01"),
    ("radius = 1.0", "radius = 1" + "0" * 400, "plate.radius|got 1000"),
    ("radius = 1.0", "radius = 1" + "0" * 5000, "TOML"),
    ("radius = 1.0", "radius = " + "[" * 5000, "TOML"),
    ("speed = 1", "speed = 0", "impact.speed|got 0"),
    ("mass = 72", "", "[sphere]: |sphere.mass|sphere.density"),
    ("mass = 72", "mass = 72\ndensity = 7850", "sphere.mass|sphere.density|remove"),
    ("mass = 72", "mass = -72", "sphere.mass: |[kg]|-72"),
    ("thickness = 0.2", "", "plate.half_thickness|plate.thickness"),
    ("thickness = 0.2", "thickness = 0.2\nhalf_thickness = 0.1", "thickness|half_thickness"),
    (LAME, "", "plate.lame_mu|plate.material|add for example `youngs_modulus"),
    (LAME, "lame_mu = 1e9", "plate.lame_mu|add plate.lame_lambda"),
    (LAME, "youngs_modulus = 1e9", "plate.youngs_modulus|add plate.poissons_ratio"),
    (LAME, "lame_mu = 1e9\npoissons_ratio = 0.3", "plate.lame_mu|plate.poissons_ratio"),
    (LAME, LAME + "\npoissons_ratio = 0.3", "remove plate.poissons_ratio"),
    (LAME, LAME + "\nyoungs_modulus = 1e9\npoissons_ratio = 0.3", "plate.youngs_modulus|remove"),
    (LAME, "youngs_modulus = 1e9\npoissons_ratio = 0.5", "poissons_ratio|0.5"),
    (LAME, "youngs_modulus = 1e9\npoissons_ratio = -1", "poissons_ratio|-1"),
    (LAME, "youngs_modulus = 0\npoissons_ratio = 0.3", "plate.youngs_modulus|got 0"),
    ("[impact]", "[accuracy]\n[impact]", "accuracy.rtol|`rtol = 0.01`"),
    ("[impact]", "[accuracy]\ntol = 1\n[impact]", "accuracy.tol: |accuracy.rtol; rename"),
    (LAME, "E = 1e9\nnu = 0.3", "E: |is plate.youngs_modulus; rename|is plate.poissons_ratio"),
    ("[impact]", "[accuracy]\nrtol = 0.1\noutputs = ['force']\n[impact]", "the string \"force\""),
    ("radius = 1.0", "radius = inf", "plate.radius: |got inf|extent = \"infinite\" in [inertia]"),
    ("radius = 1.0", "radius = 'infinite'", "plate.radius: |extent = \"infinite\" in [inertia]"),
    ("radius = 1.0", "diameter = 2.0", "plate.diameter: |plate.radius|half"),
    ("radius = 1.0", "radius = 1.0\nwidth = 1.0", "plate.width: |circular|infinite"),
    ("radius = 1.0", "radius = 1.0\nsupport = 'clamped'", "plate.support: |plate.edge"),
    ("radius = 1.0", "radius = 1.0\nedge = 'free'", "plate.edge: |free|infinite"),
    ("radius = 1.0", "radius = 1.0\nrestitution = 0.5", "restitution: |[measured]|solve_for"),
    ("speed = 1", "speed = 1\nangle = 30", "impact.angle: |right angle"),
    ("speed = 1", "speed = 1\ndrop_height = 1", "impact.drop_height: |sqrt(2 g height)"),
    ("[impact]", "[accuracy]\nrtol = 1e-14\n[impact]", "1e-13|1e-14|reference"),
    ("[impact]", "[inertia]\nmodes = 2.5\n[impact]", "inertia.modes|2.5"),
    ("[impact]", "[inertia]\nmodes = 'all'\n[impact]", '"auto"|quotes|`modes = 40`'),
    ("[impact]", "[inertia]\nbranches = 'A1'\n[impact]", '"A0"|"all"|`branches = "A0"`'),
    ("[impact]", "[inertia]\ncoupling = 1\n[impact]", '"variational"|"pointwise"|1'),
    ("[impact]", "[inertia]\nextent = 'x'\n[impact]", '"finite"|(extent of the plate)'),
    ("[impact]", "[inertia]\nmode = 3\n[impact]", "inertia.mode: |modes?"),
    ("[impact]", "[effects]\ninertia = 1\n[impact]", 'effects.inertia: |"auto"|1'),
    ("lame_mu = 0.43e9", "lame_mu = 0.0", "plate.lame_mu: |0"),
    ("lame_lambda = 0.36e9", "lame_lambda = -0.3e9", "3 lame_lambda + 2 lame_mu|-3e+08"),
    ("lame_lambda = 0.36e9", "lame_lambda = -inf", "plate.lame_lambda: |-inf"),
    ("lame_lambda = 0.36e9", "lame_lambda = 0,36e9", "TOML|line 7|decimal point"),
    ("lame_lambda = 0.36e9", "lame_lambda = 0.36 GPa", "TOML|line 7|0.36 GPa|SI units"),
    ("lame_lambda = 0.36e9", "material = steel", 'TOML|line 7|quotes|material = "steel"'),
    ("lame_lambda = 0.36e9", "material = \"steel", 'TOML|line 7|end text with a quote'),
    ("radius = 1.0", "radius = 1.0\nradius = 2.0", "TOML|line 6|give each key and table once"),
    ("[impact]", "[plate]", "TOML|give each key and table once"),
    ("[impact]", "[impact", "TOML|as `[sphere]`"),
    ("[impact]", "impact]", "TOML|as `[sphere]`"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "expected"), BAD)
def test_invalid_scene_gives_one_message(old: str, new: str, expected: str, tmp_path: Path) -> None:
    assert GOOD.count(old) == 1
    path = tmp_path / "scene.toml"
    path.write_text(GOOD.replace(old, new))
    with pytest.raises(SceneError) as caught:
        load(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    for words in expected.split("|"):
        assert words in message
    assert len(message) < 1200
    assert "pydantic" not in message


def test_invalid_items_of_a_list_are_one_problem(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(f"{GOOD}\n[accuracy]\nrtol = 0.1\noutputs = ['force']\n")
    with pytest.raises(SceneError, match="outputs: expected a list") as caught:
        load(path)
    assert "problems" not in str(caught.value)


def test_several_problems_are_listed_together(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    bad = GOOD.replace("radius = 1.0", "radius = -1.0").replace("thickness = 0.2", "thik = 1")
    path.write_text(bad.replace("mass = 72", "").replace("speed = 1", "speed = '1'"))
    with pytest.raises(SceneError, match="5 problems") as caught:
        load(path)
    lines = str(caught.value).splitlines()[1:]
    for key in ("plate.radius", "plate.thik", "[plate]", "[sphere]", "impact.speed"):
        assert sum(line.startswith(f"  - {key}: ") for line in lines) == 1


def test_file_that_cannot_be_decoded_gives_a_message(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="No such file"):
        load(tmp_path / "absent.toml")
    with pytest.raises(SceneError, match="not a file"):
        load(tmp_path)
    (tmp_path / "bytes.toml").write_bytes(b"[sphere]\n# \xff\n")
    with pytest.raises(SceneError, match="UTF-8"):
        load(tmp_path / "bytes.toml")


def test_unreadable_file_gives_a_message(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(GOOD)

    def reject(path: Path, *_: object) -> bytes:
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr("derivation.scene.input.toml_file.read_file", reject)
    with pytest.raises(SceneError, match=r"Permission denied"):
        load(path)


def test_equivalent_files_give_the_same_scene(tmp_path: Path) -> None:
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


@pytest.mark.parametrize(
    ("name", "E", "nu", "density"),
    [
        ("steel", 210e9, 0.3, 7850.0),
        ("glass", 70e9, 0.2, 2500.0),
        ("aluminium", 70e9, 0.3, 2700.0),
        ("concrete", 33e9, 0.2, 2400.0),
        ("PMMA", 3.3e9, 0.37, 1190.0),
    ],
)
def test_named_materials_have_the_constants_of_their_standards(
    name: str, E: float, nu: float, density: float
) -> None:
    """A material gives the constants of plate and sphere, and the mass of the sphere."""
    keys = {"lame_lambda": None, "lame_mu": None, "material": name}
    model = model_of(read(changed(plate=keys, sphere={"mass": None, "material": name})))
    shear, bulk = E / (2 * (1 + nu)), E / (3 * (1 - 2 * nu))
    assert model.mu == pytest.approx(shear, rel=1e-14)
    assert model.lam + 2 / 3 * model.mu == pytest.approx(bulk, rel=1e-14)
    assert model.modulus == pytest.approx(E / (1 - nu**2), rel=1e-14)
    assert model.sphere_modulus == pytest.approx(E / (1 - nu**2), rel=1e-14)
    assert model.density == density
    assert model.m == pytest.approx(density * math.pi * 0.26**3 / 6, rel=1e-14)


def test_poissons_ratio_next_to_minus_one_is_rejected() -> None:
    keys = {"lame_lambda": None, "lame_mu": None, "youngs_modulus": 1e9}
    scene = read(changed(plate=keys | {"poissons_ratio": math.nextafter(-1.0, 0.0)}))
    with pytest.raises(SceneError, match=r"plate\.poissons_ratio: .*lame_mu"):
        model_of(scene)


def test_negative_lame_lambda_of_a_stable_material_is_allowed() -> None:
    model = model_of(read(changed(plate={"lame_lambda": -0.28e9})))
    assert model.lam == -0.28e9


def test_scene_is_frozen() -> None:
    scene = read(changed())
    with pytest.raises(ValueError, match="cannot be changed"):
        scene.plate.radius = 2.0  # type: ignore[misc]


def test_equal_scenes_are_one_key_of_a_dictionary() -> None:
    """The order of materials and of keys does not matter; any other value does."""
    own = {"youngs_modulus": 1e9, "poissons_ratio": 0.3, "density": 900.0}
    more = {"materials": {"one": own, "two": own}, "accuracy": {"rtol": 0.1}}
    turned = {"materials": {"two": own, "one": own}, "accuracy": {"rtol": 0.1}}
    kept = {read(changed() | more): "first"}
    assert kept[read(dict(reversed((changed() | turned).items())))] == "first"
    for other in ({"accuracy": {"rtol": 0.2}}, {"materials": {"one": own}}):
        assert read(changed() | more | other) not in kept


def test_direct_construction_is_validated_too() -> None:
    from derivation.scene.scene import Plate

    with pytest.raises(ValueError, match=r"\[plate\]: "):
        Plate(radius=1.0)


@pytest.mark.parametrize("data", [[1], {"sphere": {1: 2}}, {3: 4}])
def test_data_without_tables_are_rejected(data: Any) -> None:
    with pytest.raises(SceneError, match=r"^\w+: "):
        read(data)


def test_damaged_scene_raises_a_scene_error(tmp_path: Path) -> None:
    """A randomly edited scene either loads or raises a SceneError."""
    chance = random.Random(7)
    text, rejected = GOOD, 0
    path = tmp_path / "scene.toml"
    for _ in range(400):
        index = chance.randrange(len(text))
        path.write_text(text[:index] + chance.choice('[]=."-0\nx{}') + text[index + 1 :])
        try:
            load(path)
        except SceneError:
            rejected += 1
    assert 200 < rejected < 400


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
    assert list(made["$defs"]["Effects"]["properties"]) == [
        *(effect.name for effect in EFFECTS if not effect.always_included),
        "compare_paper_motion",
    ]
    modes = made["$defs"]["Inertia"]["properties"]["modes"]["anyOf"]
    assert modes[1] == {"maximum": 6000, "minimum": 2, "type": "integer"}


def test_a_scene_is_shown_with_the_given_keys_only_and_can_be_typed_again() -> None:
    scene = pc.Scene(
        sphere=pc.Sphere(radius=0.01, material="steel"),
        plate=pc.Plate(radius=0.3, thickness=0.008, material="glass", loss_factor=0.01),
        impact=pc.Impact(speed=2.0),
    )
    assert "None" not in repr(scene)
    names = {kind.__name__: kind for kind in (pc.Scene, pc.Sphere, pc.Plate, pc.Impact)}
    assert eval(repr(scene), names) == scene
