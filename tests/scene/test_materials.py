"""Materials of sphere and plate: the catalogue, own materials, and the contact of two bodies."""

import json
import math
import re
from collections.abc import Mapping
from typing import Any

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st

from derivation.cli import main
from derivation.scene import SceneError, read, schema, simulate, sweep
from derivation.scene.dynamic import contact_sequence, time_in_contact
from derivation.scene.dynamic.contact_sequence import ContactRun
from derivation.scene.input.body_materials import lightest_density
from derivation.scene.input.materials import MATERIALS, find, plain
from derivation.scene.model import Model, model_of
from generated.viscous_bodies import retardation_of_two

Tables = dict[str, dict[str, Any]]
RUBBER = {"youngs_modulus": 4e6, "poissons_ratio": 0.45, "density": 1150.0}
OWN = {"my ice": {"youngs_modulus": 9e9, "poissons_ratio": 0.3, "density": 900.0}}


def tables(sphere: Mapping[str, Any], plate: Mapping[str, Any], **others: Any) -> Tables:
    base: Tables = {
        "sphere": {"radius": 0.01} | dict(sphere),
        "plate": {"radius": 0.2, "thickness": 0.05} | dict(plate),
        "impact": {"speed": 1.0},
    }
    return base | others


def model(sphere: Mapping[str, Any], plate: Mapping[str, Any], **others: Any) -> Model:
    return model_of(read(tables(sphere, plate, **others)))


def test_materials_are_admissible_and_have_sources() -> None:
    names = [plain(name) for m in MATERIALS.values() for name in (m.name, *m.also)]
    assert len(names) == len(set(names))
    for material in MATERIALS.values():
        assert material.youngs_modulus > 0
        assert -1 < material.poissons_ratio < 0.5
        assert len(material.source) > 20
        if material.name != "paper":
            assert material.density is not None
            # Speed of longitudinal waves in a thin bar: 36 m/s in rubber, 9.8 km/s in alumina.
            assert 30 < math.sqrt(material.youngs_modulus / material.density) < 1.1e4


@pytest.mark.parametrize(
    ("name", "shear"),
    [
        ("Gorilla Glass 3", 28.5e9), ("Gorilla Glass 5", 31.7e9), ("fused silica", 31.4e9),
        ("ice", 3.52e9), ("brass", 37.3e9), ("copper", 48.3e9), ("titanium", 42.7e9),
    ],
)  # fmt: skip
def test_shear_moduli_agree_with_the_sources(name: str, shear: float) -> None:
    material = find(name)
    assert material is not None
    assert material.mu == pytest.approx(shear, rel=0.02)


@pytest.mark.parametrize("name", ["Bearing-Steel", "100cr6", "AISI 52100", "bearing_steel"])
def test_names_are_matched_without_case_spaces_and_hyphens(name: str) -> None:
    assert find(name) is MATERIALS["bearing steel"]


def test_constants_and_name_of_a_material_are_equivalent() -> None:
    named = model({"material": "steel"}, {"material": "glass"})
    steel = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850}
    glass = {"youngs_modulus": 70e9, "poissons_ratio": 0.2, "density": 2500}
    given = model(steel, glass)
    own = model({"material": "a"}, {"material": "b"}, materials={"a": steel, "b": glass})
    assert given == Model(**(vars(named) | {"solid_density": 0.0}))
    assert own == named


def test_values_of_a_table_replace_those_of_its_material() -> None:
    keys = {"density": 1000.0, "yield_stress": 1e8, "retardation_time": 1e-6}
    actual = model({"material": "steel"} | keys, {"material": "steel S355"} | keys)
    assert actual.density == 1000.0
    assert actual.yield_stress == actual.plate_yield_stress == 1e8
    assert actual.retardation_time == 1e-6
    assert actual.m == pytest.approx(1000 * math.pi * 0.02**3 / 6, rel=1e-14)
    assert model({"material": "steel"}, {"material": "S355"}).yield_stress == 355e6
    assert model({"material": "steel"}, {"material": "steel"}).yield_stress == math.inf


def test_material_of_the_scene_overrides_the_catalogue() -> None:
    actual = model({"material": "ice"}, {"material": "ICE"}, materials={"Ice": OWN["my ice"]})
    assert actual.density == 900.0
    assert actual.softness == 1.0


STEEL = {"material": "steel"}
BAD: list[tuple[Tables, str]] = [
    (tables({"material": "stel"}, STEEL), "sphere.material|steel?"),
    (tables({"material": "my-ise"}, STEEL, materials=OWN), "my ice?"),
    (tables({"material": "tennis ball"}, STEEL), "sphere.material|hollow"),
    (tables({"material": "Table tennis"}, STEEL), "sphere.material|hollow"),
    (tables({"material": "hollow steel ball"}, STEEL), "sphere.material|hollow"),
    (tables(STEEL, {"material": 3}), "plate.material: |3"),
    (tables({"material": "paper"}, STEEL), "sphere.material|density = 7850"),
    (tables({"density": 1, "youngs_modulus": 1e9}, STEEL), "sphere.poissons_ratio"),
    (tables(STEEL | {"youngs_modulus": 1e9, "poissons_ratio": 0.3}, STEEL), "youngs_modulus"),
    (tables({"youngs_modulus": 1e9, "poissons_ratio": 0.3}, STEEL), "sphere.density"),
    (tables({"mass": 1, "retardation_time": 1.0}, STEEL), "sphere.retardation_time"),
    (tables({"mass": 1, "yield_stress": 1.0}, STEEL), "sphere.yield_stress"),
    (tables(STEEL | {"wall_thickness": 1e-3}, STEEL), "sphere.wall_thickness: |hollow"),
    (tables(STEEL | {"thickness": 1e-3}, STEEL), "sphere.thickness: |hollow"),
    (tables(STEEL, STEEL, materials=3), "materials: |[materials.NAME]"),  # type: ignore[arg-type]
    (tables(STEEL, STEEL, materials={"a": 3}), "materials.a: |[materials.a]"),
    (tables(STEEL, STEEL, materials={"a": {}}), "3 problems|materials.a.density"),
    (
        tables(STEEL, STEEL, materials={"a": RUBBER | {"densty": 1.0}}),
        "materials.a.densty: |density?",
    ),
    (
        tables(STEEL, STEEL, materials={"a.b": RUBBER | {"E": 1e9, "rho": 900.0}}),
        "[Pa] is materials.a.b.youngs_modulus; rename|.rho: |is materials.a.b.density; rename",
    ),
    (
        tables(STEEL, STEEL, materials={"a": RUBBER | {"poissons_ratio": 0.5}}),
        "materials.a.poissons_ratio: |0.5",
    ),
    (tables(STEEL, STEEL, materials={"a-b": RUBBER, "A B": RUBBER}), "materials: |a-b|A B"),
    (tables(STEEL, STEEL, materials={" ": RUBBER}), "materials: "),
    (tables(STEEL, STEEL, material={"a": RUBBER}), "material: |materials?"),
]  # fmt: skip


@pytest.mark.parametrize(("scene", "message"), BAD)
def test_invalid_material_gives_one_message(scene: Tables, message: str) -> None:
    with pytest.raises(SceneError) as caught:
        read(scene)
    for words in message.split("|"):
        assert words in str(caught.value)


def test_unused_material_is_accepted_and_scene_is_unchanged() -> None:
    scene = read(tables(STEEL, STEEL, materials=OWN))
    assert read(scene.to_json()) == scene
    assert scene.to_json()["materials"] == OWN
    assert "materials.my ice" in scene._repr_html_()


def test_warning_of_a_light_sphere_mentions_a_hollow_one() -> None:
    solid = 7850 * math.pi * 0.02**3 / 6
    for fraction, warned in ((0.32, True), (0.34, False), (2.0, False)):
        result = simulate(read(tables({"material": "steel", "mass": fraction * solid}, STEEL)))
        assert any("hollow" in text for text in result.warnings) == warned


@pytest.mark.parametrize(
    ("radius", "mass", "modulus", "ratio", "warned"),
    [
        (0.020, 2.7e-3, 2.2e9, 0.4, True),  # table tennis ball
        (0.020, 2.7e-3, 2.2e9, 0.3, True),
        (0.033, 57.7e-3, 3e6, 0.49, True),  # tennis ball
        (0.120, 0.62, 3e6, 0.49, True),  # basketball
        (0.02135, 45.9e-3, 80e6, 0.45, False),  # golf ball
        (0.03, 160 * 1.131e-4, 3.4e9, 0.3, False),  # balsa
        (0.03, 120 * 1.131e-4, 4e6, 0.1, False),  # cork
        (0.03, 25 * 1.131e-4, 8e6, 0.12, False),  # expanded polystyrene
        (0.03, 100 * 1.131e-4, 1e6, 0.2, False),  # aerogel
        (0.03, 1850 * 1.131e-4, 303e9, 0.07, False),  # beryllium
    ],
)
def test_a_sphere_lighter_than_any_solid_is_called_hollow(
    radius: float, mass: float, modulus: float, ratio: float, warned: bool
) -> None:
    sphere = {"radius": radius, "mass": mass, "youngs_modulus": modulus, "poissons_ratio": ratio}
    result = simulate(read(tables(sphere, STEEL)), rtol=0.1)
    assert any("hollow" in text for text in result.warnings) == warned


def test_no_named_material_is_called_hollow() -> None:
    known = [m for m in MATERIALS.values() if m.density is not None]
    assert all((m.density or 0.0) > lightest_density(m.lam, m.mu) for m in known)


def test_body_that_yields_first_is_named() -> None:
    weak, strong = {"material": "steel", "yield_stress": 1e8}, {"material": "S355"}
    for sphere, plate, body in ((weak, strong, "sphere"), (strong, weak, "plate")):
        scene = read(tables(sphere, plate, effects={"plasticity": False}))
        [text] = [t for t in simulate(scene).warnings if "yields" in t]
        assert f"the {body} yields" in text


TIME = st.floats(1e-9, 1e-1)
SOFTNESS = st.floats(1e-6, 1e6)


@given(TIME, TIME, SOFTNESS)
def test_retardation_time_of_the_contact_is_between_those_of_the_bodies(
    plate: float, sphere: float, softness: float
) -> None:
    retardation_time = retardation_of_two(plate, sphere, softness)
    low, high = sorted((plate, sphere))
    assert low * (1 - 1e-15) <= retardation_time <= high * (1 + 1e-15)
    assert retardation_time == pytest.approx(
        retardation_of_two(sphere, plate, 1 / softness), rel=1e-14
    )
    assert retardation_of_two(plate, sphere, 0.0) == plate


@given(TIME, TIME, SOFTNESS)
def test_retardation_time_of_two_bodies_is_accurate_to_first_order(
    plate: float, sphere: float, softness: float
) -> None:
    """The complex stiffness at frequency w differs from the exact one by a term of order w^2."""
    mean = retardation_of_two(plate, sphere, softness)
    for w in (1e-2 / max(plate, sphere), 1e-3 / max(plate, sphere)):
        series = (1 + softness) / (1 / (1 + 1j * w * plate) + softness / (1 + 1j * w * sphere))
        assert abs(series - (1 + 1j * w * mean)) <= (w * (plate - sphere)) ** 2 + 1e-15


def test_either_of_two_equal_bodies_may_be_viscoelastic() -> None:
    steel, lossy = {"material": "steel"}, {"material": "steel", "retardation_time": 1e-6}
    one, other, both = (
        simulate(read(tables(s, p, effects={"inertia": False})), rtol=1e-3)
        for s, p in ((steel, lossy), (lossy, steel), (lossy, lossy))
    )
    assert one.restitution == other.restitution
    assert both.restitution < one.restitution < 1.0
    # To first order the loss of two viscous bodies is twice that of one.
    assert math.log(both.restitution) == pytest.approx(2 * math.log(one.restitution), rel=0.05)


SCENES: dict[str, Tables] = {
    "hail of 25 mm on a bonnet, 20 m/s": tables(
        {"radius": 0.0125, "material": "ice"},
        {"radius": 0.3, "thickness": 0.0008, "material": "steel"},
        impact={"speed": 20.0},
    ),
    "glass marble on an alumina tile": tables(
        {"radius": 0.008, "material": "glass"},
        {"radius": 0.15, "thickness": 0.01, "material": "alumina"},
    ),
    "bearing ball on a steel plate": tables(
        {"radius": 0.005, "material": "bearing steel"},
        {"radius": 0.1, "thickness": 0.02, "material": "steel S355"},
    ),
    "impact-echo on concrete": tables(
        {"radius": 0.004, "material": "bearing steel"},
        {"radius": 1.0, "thickness": 0.2, "material": "concrete"},
        impact={"speed": 2.0},
    ),
    "steel on PMMA": tables(
        {"material": "steel"}, {"radius": 0.15, "thickness": 0.01, "material": "PMMA"}
    ),
    "130 g of steel on phone glass": tables(
        {"radius": 0.0158, "mass": 0.13, "material": "steel"},
        {"radius": 0.01, "thickness": 0.0007, "material": "phone glass",
         "edge": "simply-supported"},
    ),
    # Mass and radius are from the Rules of Golf. With this modulus Hertz's law gives the contact
    # time of a drive, 0.5 ms (Cochran and Stobbs, The Search for the Perfect Swing, 1968).
    "golf ball on a titanium face, 15 m/s": tables(
        {"radius": 0.02134, "mass": 0.04593, "youngs_modulus": 97e6, "poissons_ratio": 0.45},
        {"radius": 0.04, "thickness": 0.003, "material": "Ti-6Al-4V", "edge": "clamped"},
        impact={"speed": 15.0},
    ),
}  # fmt: skip


@pytest.mark.one_version
@pytest.mark.parametrize("name", SCENES)
def test_typical_scenes_run_at_one_percent(name: str) -> None:
    result = simulate(read(SCENES[name]), rtol=0.01)
    assert result.complete
    assert 0 < result.restitution <= 1.0
    assert result.accuracy.bound <= 0.01


def test_golf_drive_is_rejected_before_its_contact_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """At 45 m/s, above the largest speed of the law, no contact of a golf ball is completed."""
    drive = SCENES["golf ball on a titanium face, 15 m/s"] | {"impact": {"speed": 45.0}}
    calls, completed, contact = [], [], contact_sequence.contact

    def recorded(*arguments: Any) -> ContactRun:
        calls.append(arguments)
        completed.append(contact(*arguments))
        return completed[-1]

    monkeypatch.setattr(contact_sequence, "contact", recorded)
    with pytest.raises(SceneError, match=r"speed"):
        simulate(read(drive), rtol=0.01)
    assert calls
    assert not completed


def test_sphere_that_stays_on_a_light_plate_is_rejected_before_the_first_step() -> None:
    """The proposed remedy runs, and its contact time is the one that the message predicts."""
    phone = SCENES["130 g of steel on phone glass"]
    sphere, plate = phone["sphere"] | {"mass": 3.0}, phone["plate"] | {"radius": 0.07}
    linear = {"effects": {"stretching": False}}
    wide = phone | {"sphere": sphere, "plate": plate, "impact": {"speed": 0.05}}
    with pytest.raises(
        SceneError, match=r"effects\.inertia: .* set effects\.inertia = false"
    ) as error:
        simulate(read(wide | linear), rtol=0.01)
    predicted = float(re.search(r"about ([\d.e-]+) s", str(error.value))[1])
    result = simulate(read(wide | {"effects": {"inertia": False}}), rtol=0.01)
    assert result.contact_time == pytest.approx(predicted, rel=0.1)


@pytest.mark.one_version
@pytest.mark.parametrize(
    ("mass", "edge", "speed"),
    [(0.02, "paper", 1.0), (0.1, "clamped", 0.3), (0.5, "simply-supported", 0.05)],
)
def test_contact_of_a_heavy_sphere_lasts_most_of_its_half_period(
    mass: float, edge: str, speed: float
) -> None:
    """The contacts last longer than the check that rejects heavy spheres assumes."""
    plate = {"radius": 0.02, "thickness": 0.001, "material": "glass", "edge": edge}
    scene = read(tables({"radius": 0.01, "mass": mass, "material": "steel"}, plate,
                        impact={"speed": speed}, effects={"inertia": True}))  # fmt: skip
    result = simulate(scene, rtol=0.02)
    assert result.complete
    assert result.dynamics is not None
    history = result.dynamics.impact_history
    problem = history.problem
    modes = problem.contact.modes
    assert problem.m * modes.inverse_modal_mass[0] > time_in_contact.HEAVY
    touched = problem.T * sum(touching.end - touching.start for touching in history.contacts)
    assert touched > time_in_contact.IN_CONTACT * time_in_contact.half_period(problem.m, modes)


def test_material_keys_can_be_swept() -> None:
    scene = read(tables({"material": "steel"}, {"material": "PMMA"}))
    rows = sweep.run(scene, sweep.parse("sphere.retardation_time=1e-6:1e-5:2"), rtol=0.02)
    assert all(row.results for row in rows)
    scene = read(tables({"material": "my ice"}, STEEL, materials=OWN))
    rows = sweep.run(scene, sweep.parse("materials.my ice.density=900:1800:2"), rtol=0.02)
    light, heavy = (row.results["max_force"] for row in rows)
    assert light < heavy
    with pytest.raises(SceneError, match=r"my ice\.source"):
        sweep.parse("materials.my ice.source=1:2:2")


def test_schema_agrees_with_accepted_and_rejected_materials() -> None:
    validator = jsonschema.Draft202012Validator(schema())
    for scene in SCENES.values():
        validator.validate(scene)
    validator.validate(tables(STEEL, STEEL, materials=OWN))
    for sphere in (
        {"material": "steel", "youngs_modulus": 1e9, "poissons_ratio": 0.3},
        {"mass": 1.0, "youngs_modulus": 1e9},
        {"mass": 1.0, "density": 1.0},
        {},
    ):
        assert not validator.is_valid(tables(sphere, STEEL))


def test_command_lists_and_shows_materials(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["materials", "--json", "-"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert [row["name"] for row in listed] == list(MATERIALS)
    assert main(["materials", "hail"]) == 0
    assert "Gammon" in capsys.readouterr().out
    assert main(["materials"]) == 0
    assert "zirconia" in capsys.readouterr().out
    assert main(["materials", "irn"]) == 2
    assert "materials: " in capsys.readouterr().err
