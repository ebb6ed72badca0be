"""Scenes outside the range of the models are rejected before the slow part of a simulation."""

import re
from typing import Any

import pytest

from derivation.scene import SceneError, read, simulate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import contact_errors, contact_sequence, waves
from derivation.scene.dynamic.time_element import A, C
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.impact import selected_effects
from derivation.scene.measured import measured

HAIL: dict[str, Any] = {
    "sphere": {"radius": 0.0125, "material": "ice", "yield_stress": 10e6},
    "plate": {"radius": 0.5, "thickness": 0.0008, "material": "steel", "edge": "clamped"},
    "impact": {"speed": 22.0},
    "inertia": {"modes": 60, "branches": "A0"},
}
"""Hail of 25 mm on the sheet of a bonnet: it yields, and the contact is wider than 6 h."""
CURVED: dict[str, Any] = {
    "sphere": {"radius": 0.0158, "mass": 0.13},
    "plate": {"radius": 0.05, "thickness": 0.00055, "material": "glass", "edge": "clamped"},
    "impact": {"speed": 20.0},
    "inertia": {"modes": 24},
}
"""A ball that bends phone glass more than the ball is curved."""


def rejection(scene: dict[str, Any]) -> str:
    with pytest.raises(SceneError) as caught:
        simulate(read(scene))
    return str(caught.value)


def law_of(scene: dict[str, Any]) -> ContactLaw:
    return selected_effects(read(scene))[1].law


def test_wide_plastic_contact_is_rejected_before_it_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """The whole contact, without the check, is at least as wide as the rejection states."""
    text = rejection(HAIL)
    assert re.match(r"impact\.speed: expected a contact radius below .* = 0\.0024 m", text)
    assert "or use a lighter sphere" in text
    stated = re.search(r"got at least (\S+) m", text)
    assert stated
    law = law_of(HAIL)
    assert float(stated[1]) > contact_errors.TOO_WIDE * law.limit
    monkeypatch.setattr(contact_errors, "TOO_WIDE", float("inf"))
    waves.impact.cache_clear()
    problem = problem_of(law, 30)
    whole = contact_sequence.contact(problem, 14, problem.begin(), 0.0, 0.0)
    assert whole.yielding is not None
    radius = max(piece.element.largest(A) for piece in whole.pieces)
    widest = problem.a * radius / whole.yielding.flattening
    assert widest >= float(stated[1])


@pytest.mark.parametrize("yield_stress", [10e6, 40e6])
def test_speed_in_the_message_is_low_enough(yield_stress: float) -> None:
    """The contact at this speed is within the limit, and not far below it."""
    scene = HAIL | {"sphere": HAIL["sphere"] | {"yield_stress": yield_stress}}
    stated = re.search(r"speed \((\S+) m/s is low enough for this limit\)", rejection(scene))
    assert stated
    slower = scene | {"impact": {"speed": float(stated[1])}}
    assert 0.4 < simulate(read(slower)).max_contact_radius / law_of(scene).limit < 1.0


def test_speed_in_the_message_is_low_enough_only_for_the_width() -> None:
    """An earlier message called it low enough, although the slower contact has no solution."""
    scene: dict[str, Any] = {
        "sphere": {"radius": 0.00116, "density": 13320.0},
        "plate": {
            "radius": 7.42e-4, "thickness": 1.686e-4, "youngs_modulus": 2.566e9,
            "poissons_ratio": 0.3, "density": 1069.0, "edge": "clamped", "loss_factor": 0.1,
            "yield_stress": 5.766e5,
        },
        "impact": {"speed": 2.46},
    }  # fmt: skip
    stated = re.search(r"speed \((\S+) m/s is low enough for this limit\)", rejection(scene))
    assert stated
    slower = rejection(scene | {"impact": {"speed": float(stated[1])}})
    assert "unloads more stiffly" in slower


@pytest.mark.parametrize("speed", [2.0, 4.0, 6.0, 7.0])
def test_check_of_the_width_stops_no_contact_within_the_limit(
    speed: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A contact is stopped only if it is wider than the limit when it is simulated to its end."""
    law = law_of(HAIL | {"impact": {"speed": speed}})
    problem = problem_of(law, 30)

    def widest() -> float:
        whole = contact_sequence.contact(problem, 14, problem.begin(), 0.0, 0.0)
        assert whole.yielding is not None
        radius = max(piece.element.largest(A) for piece in whole.pieces)
        return float(problem.a * radius / whole.yielding.flattening)

    with monkeypatch.context() as patch:
        patch.setattr(contact_errors, "TOO_WIDE", float("inf"))
        whole = widest()
    if whole <= law.limit:
        assert widest() == whole
    elif whole > 1.1 * law.limit:
        with pytest.raises(SceneError, match="got at least"):
            widest()


def test_contact_without_solution_is_rejected_for_the_same_reason_at_any_length(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Shorter time elements have no solution either, and the stated reason is the same."""
    early = rejection(CURVED)
    assert "the plate is more curved than the sphere" in early
    monkeypatch.setattr(contact_errors, "STUCK", 0.0)
    monkeypatch.setattr(contact_sequence, "STUCK", 0.0)
    waves.impact.cache_clear()
    late = rejection(CURVED)
    times = [float(re.search(r"contact at (\S+) s", text)[1]) for text in (early, late)]  # type: ignore[index]
    assert early.partition(" s ")[2] == late.partition(" s ")[2]
    assert times[0] == pytest.approx(times[1], rel=1e-4)


@pytest.mark.parametrize(
    ("sphere", "plate", "speed"),
    [
        (
            {"radius": 0.003, "material": "silicon nitride"},
            {"radius": 0.1, "thickness": 0.005, "material": "stainless steel"}
            | {"edge": "clamped", "retardation_time": 1.78e-7},
            5.0,
        ),
        (
            {"radius": 0.005, "material": "steel"},
            {"radius": 0.05, "thickness": 0.005, "material": "PMMA"}
            | {"edge": "clamped", "retardation_time": 2.44e-5},
            2.0,
        ),
    ],
    ids=["yielding", "elastic"],
)
def test_tolerance_that_omitted_branches_exceed_is_rejected_at_the_first_contact(
    sphere: dict[str, Any], plate: dict[str, Any], speed: float
) -> None:
    """The whole simulation has a larger error; the tolerance that the rejection states is met."""
    scene = {"sphere": sphere, "plate": plate, "impact": {"speed": speed}}
    whole = simulate(read(scene)).accuracy.bound
    stated = re.match(
        r"rtol: expected at least about (\S+), because",
        rejection(scene | {"accuracy": {"rtol": 0.3 * whole}}),
    )
    assert stated
    assert 0.3 * whole < float(stated[1])
    met = simulate(read(scene | {"accuracy": {"rtol": float(stated[1])}}))
    assert met.accuracy.bound <= float(stated[1])


def test_tolerance_in_an_early_message_can_be_met() -> None:
    """The contact widens after it is rejected, and the omitted branches then matter more."""
    scene: dict[str, Any] = {
        "sphere": {"radius": 0.0182607, "density": 3537.7},
        "plate": {
            "radius": 0.0306936, "thickness": 2.4454e-3, "youngs_modulus": 6.46742e9,
            "poissons_ratio": 0.37968, "density": 2841.35, "edge": "clamped",
            "retardation_time": 2.65285e-7,
        },
        "impact": {"speed": 2.72923},
        "effects": {"non_hertzian_pressure": False, "spherical_profile": False},
        "inertia": {"branches": "A0"},
    }  # fmt: skip
    text = rejection(scene | {"accuracy": {"rtol": 6.5628e-3}})
    stated = re.match(r"rtol: expected at least about (\S+), because", text)
    assert stated
    tolerance = float(stated[1])
    met = simulate(read(scene | {"accuracy": {"rtol": tolerance}}))
    assert met.accuracy.bound <= tolerance


def test_no_tolerance_above_1_is_recommended() -> None:
    """A message recommended to increase the tolerance to 42, although 1 is the largest."""
    scene: dict[str, Any] = {
        "sphere": {
            "radius": 0.043, "density": 1160.0, "youngs_modulus": 1.8e6, "poissons_ratio": 0.2,
        },
        "plate": {
            "radius": 0.057, "thickness": 0.023, "youngs_modulus": 1.5e7, "poissons_ratio": 0.4,
            "density": 6300.0, "edge": "clamped", "retardation_time": 8e-7,
        },
        "impact": {"speed": 3e-3, "gravity": 9.81},
    }  # fmt: skip
    text = rejection(scene | {"accuracy": {"rtol": 1e-4}})
    assert text.startswith("rtol: expected no tolerance, because")
    assert "; remove the tolerance, or" in text
    assert simulate(read(scene)).accuracy.bound > 1.0


def test_a_sphere_far_too_heavy_is_rejected_before_its_contact_is_tabulated(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The tables of thousands of modes would take minutes."""
    monkeypatch.setattr("derivation.scene.dynamic.time_in_contact.problem_of", pytest.fail)
    heavy = {
        "sphere": {"radius": 1e15, "material": "steel"},
        "plate": {"radius": 4.5, "thickness": 4.7, "material": "steel"},
        "impact": {"speed": 1e-20},
        "effects": {"edge": False},
    }
    assert "more than the limit of 20000" in rejection(heavy)


@pytest.mark.parametrize("edge", ["clamped", "simply-supported"])
def test_plate_with_far_too_many_modes_is_rejected_before_they_are_computed(edge: str) -> None:
    """A plate of 20 km would need hundreds of gigabytes."""
    plate = {"radius": 2e4, "thickness": 0.01, "material": "glass", "edge": edge}
    sphere = {"radius": 0.01, "material": "steel"}
    text = rejection({"sphere": sphere, "plate": plate, "impact": {"speed": 1.0}})
    assert "at most 100000 bending modes" in text
    free = {"inertia": {"extent": "infinite"}}
    assert simulate(read({"sphere": sphere, "plate": plate, "impact": {"speed": 1.0}} | free))


@pytest.mark.parametrize("modes", ["auto", 24])
def test_more_modes_are_a_remedy_only_if_the_scene_gives_their_number(modes: str | int) -> None:
    """An automatic number has already been increased as far as is useful."""
    block = {"radius": 0.1, "thickness": 0.05, "material": "steel", "edge": "simply-supported"}
    scene: dict[str, Any] = {
        "sphere": {"radius": 0.005, "material": "steel"},
        "plate": block,
        "impact": {"speed": 3.0},
        "inertia": {"modes": modes},
        "accuracy": {"rtol": 2e-5},
    }
    text = rejection(scene)
    assert "increase the tolerance" in text
    assert ("inertia.modes" in text) == (modes != "auto")


def test_early_estimate_of_omitted_branches_uses_the_radius_on_the_curved_plate() -> None:
    """A plate that is curved less than under a static load has a narrower contact."""
    law = law_of({
        "sphere": {"radius": 0.0125, "material": "ice"},
        "plate": {"radius": 0.7, "thickness": 0.0008, "material": "steel", "loss_factor": 0.05}
        | {"edge": "simply-supported", "retardation_time": 1.8e-4},
        "impact": {"speed": 18.0},
    })  # fmt: skip
    problem, radii = problem_of(law, 40, 1e-6), list[float]()
    whole = contact_sequence.contact(
        problem, 24, problem.begin(), 0.0, 0.0, 1e-6, watch=radii.append
    )
    widest, static = (max(piece.element.largest(row) for piece in whole.pieces) for row in (C, A))
    assert 0.9 * widest < max(radii) <= widest < 0.9 * static


@pytest.mark.parametrize(
    ("tables", "reason"),
    [
        ({"inertia": {"modes": 10}, "accuracy": {"rtol": 0.01}}, "inertia.modes: expected at l"),
        (
            {
                "sphere": {"radius": 0.016, "mass": 0.13, "material": "steel"},
                "effects": {"stretching": False},
            },
            "a deflection of less",
        ),
    ],
)
def test_errors_of_any_constant_are_reported_before_the_constant_is_determined(
    tables: dict[str, Any], reason: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(measured, "_fit", pytest.fail)
    scene = {
        "sphere": {"radius": 0.0125, "material": "ice"},
        "plate": {"radius": 0.04, "thickness": 0.0006, "material": "steel", "edge": "paper"},
        "impact": {"speed": 1.0},
        "measured": {"restitution": 0.76, "solve_for": "yield_stress"},
    }
    assert reason in rejection(scene | tables)
