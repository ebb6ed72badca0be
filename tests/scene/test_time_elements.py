"""Impacts by time elements of any number of nodes: their stated error, and where contacts end."""

import math
from typing import Any

import numpy as np
import pytest

from derivation.scene import read
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import (
    contact_sequence,
    modal_response,
    next_element,
    time_element,
    time_in_contact,
    waves,
)
from derivation.scene.dynamic.contact_sequence import ImpactHistory
from derivation.scene.dynamic.integration_error import integration_error
from derivation.scene.dynamic.problem import DynamicProblem, ImpactState
from derivation.scene.dynamic.results import dynamic_impact_of
from derivation.scene.dynamic.stretching_needed import stretched
from derivation.scene.dynamic.time_element import P, TimeElement
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.effects import PAPER
from derivation.scene.model import model_of
from derivation.scene.numerics.collocation import Element

pytestmark = pytest.mark.one_version

RADIUS = 0.01
PANE = {"radius": 0.1, "thickness": 0.01, "material": "glass"}
MEMBRANE = {"radius": 0.1, "thickness": 0.001, "material": "glass"}
SOFT = {"radius": 0.1, "thickness": 0.004, "youngs_modulus": 5e9, "poissons_ratio": 0.3,
        "density": 1500.0}  # fmt: skip
MAT = {"radius": 0.1, "thickness": 0.01, "youngs_modulus": 5e6, "poissons_ratio": 0.4,
       "density": 1100.0}  # fmt: skip
THIN = {"radius": 0.016179186329803086, "thickness": 9.9429452933747e-05,
        "youngs_modulus": 21327341609.0786, "poissons_ratio": 0.20670167013477606,
        "density": 7742.978564834313}  # fmt: skip


def scene(plate: dict[str, Any], radius: float = RADIUS, speed: float = 1.0) -> dict[str, Any]:
    sphere = {"radius": radius, "material": "steel"}
    return {"sphere": sphere, "plate": plate, "impact": {"speed": speed}}


CASES: dict[str, tuple[dict[str, Any], int, frozenset[str]]] = {
    "one contact": (scene(PANE), 40, frozenset()),
    "all branches": (scene(PANE) | {"inertia": {"branches": "all"}}, 40, frozenset()),
    "several contacts": (scene(MEMBRANE), 8, frozenset()),
    "many contacts": (scene(THIN, 0.003544217561371153, 2.803275095569586), 6, frozenset()),
    "damped": (scene(MEMBRANE | {"loss_factor": 0.04}), 12, frozenset({"damping"})),
    "yielding": (scene(SOFT | {"yield_stress": 5e7}), 20, frozenset({"plasticity"})),
    "viscoelastic": (scene(SOFT | {"retardation_time": 5e-6}), 20, frozenset({"viscosity"})),
    "viscoelastic, several contacts": (
        scene(SOFT | {"thickness": 0.0015, "retardation_time": 5e-5}), 20, frozenset({"viscosity"})
    ),
}  # fmt: skip


def case(name: str) -> tuple[ContactLaw, DynamicProblem]:
    given, modes, effects = CASES[name]
    law = ContactLaw(model_of(read(given)), PAPER | {"inertia"} | effects)
    return law, problem_of(law, modes)


def numbers(law: ContactLaw, history: ImpactHistory) -> np.ndarray:
    assert history.complete
    return np.array(dynamic_impact_of(law, history).numbers)


@pytest.mark.parametrize("name", CASES)
def test_results_agree_within_the_tolerance_of_the_elements(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    law, problem = case(name)
    loose = waves.time_tolerance(waves.LOOSE)
    runs = [
        contact_sequence.impact_history(problem, n, tolerance)
        for tolerance in (loose, contact_sequence.TOLERANCE)
        for n in (time_in_contact.NODES[0], time_in_contact.NODES[-1])
    ]
    # The reference has much shorter elements with another number of nodes, and computes the
    # response of the shapes in the other way.
    with_matrices = problem.omega.size >= modal_response.SEVERAL * problem.contact.modes.phi.size
    assert with_matrices == (name == "all branches")
    monkeypatch.setattr(modal_response, "SEVERAL", math.inf if with_matrices else 0.0)
    monkeypatch.setattr(next_element, "PHASE", 0.3)
    monkeypatch.setattr(next_element, "LONGEST", 0.1)
    fine = numbers(law, contact_sequence.impact_history(problem, 20))
    for history in runs:
        off = np.abs(numbers(law, history) / fine - 1.0)
        assert np.max(off) <= integration_error(history)


@pytest.mark.parametrize("tolerance", [1e-8, 1e-11])
def test_plates_that_stretch_need_no_new_derivative_for_each_step(
    tolerance: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The response of the shapes is also computed without matrices."""
    given = scene(MAT, 0.02, 0.6) | {"inertia": {"branches": "all"}}
    law = stretched(ContactLaw(model_of(read(given)), PAPER | {"inertia"}))
    problem = problem_of(law, 12)
    systems, system = list[bool](), time_element._system
    counted = lambda *given: systems.append(True) or system(*given)  # noqa: E731
    monkeypatch.setattr(time_element, "_system", counted)
    actual = numbers(law, contact_sequence.impact_history(problem, 32, tolerance))
    kept = len(systems)
    monkeypatch.setattr(time_element, "KEPT", 0.0)
    monkeypatch.setattr(modal_response, "SEVERAL_STRETCHED", math.inf)
    expected = numbers(law, contact_sequence.impact_history(problem, 32, tolerance))
    assert kept < 0.7 * (len(systems) - kept)
    assert actual == pytest.approx(expected, rel=0.1 * tolerance)


def test_curvature_by_waves_belongs_to_the_radii_of_the_element() -> None:
    """An earlier version used the iteration before, with errors of the radius up to 5e-9."""
    foam = {
        "radius": 0.10270267447731761, "thickness": 0.023658004721378304, "edge": "clamped",
        "youngs_modulus": 635211190.9896301, "poissons_ratio": 0.23370357141830028, "density": 1200,
    }  # fmt: skip
    sphere, speed = {"radius": 0.03567724270808681, "density": 7850}, 2.571566033869026
    given = {"sphere": sphere, "plate": foam, "impact": {"speed": speed}}
    effects = PAPER | {"inertia", "edge", "non_hertzian_pressure", "spherical_profile"}
    law = ContactLaw(model_of(read(given)), effects)
    problem = problem_of(law, 8)
    fine = numbers(law, contact_sequence.impact_history(problem, 20, 3e-13))
    for n in (22, 28, 32):
        history = contact_sequence.impact_history(problem, n)
        assert np.max(np.abs(numbers(law, history) / fine - 1.0)) <= integration_error(history)


@pytest.mark.parametrize("name", [name for name in CASES if "viscoelastic" in name])
def test_viscoelastic_force_is_not_negative(name: str) -> None:
    """The force is non-negative within each element, up to 1e-6 of the unit of force."""
    _, problem = case(name)
    for n, tolerance in ((16, 1e-11), (32, 1e-8)):
        for touching in contact_sequence.impact_history(problem, n, tolerance).contacts:
            for piece in touching.pieces:
                x = piece.element.x + piece.element.length * np.linspace(0.0, 1.0, 2001)
                assert np.min(piece.element.at(x)[P]) > -1e-6


def test_contact_that_widens_behind_the_plate_has_no_remaining_time() -> None:
    """The approach of a viscoelastic contact may be negative; an earlier version then computed a
    complex length of the next element.
    """
    rows, none = np.zeros((9, 4)), np.zeros(1)
    element = Element(1.0, 0.1, rows, np.array([0.5, 0.0, 0.0, 0.0]))
    state = ImpactState(0.0, -1.0, none, none, approach=-10.0)
    last = TimeElement(element, state, 1.0, none, None)
    assert next_element.left_after(last) == math.inf


def test_elements_end_at_yield_events_for_any_number_of_nodes() -> None:
    """Elements are halved until one of them can end at the yield event."""
    sheet = {
        "radius": 0.017677098253298388, "thickness": 0.0005362909745948016,
        "youngs_modulus": 1888493742.7203, "poissons_ratio": 0.35142186843123463,
        "density": 1306.472741238041, "yield_stress": 2835942.5936718537,
    }  # fmt: skip
    given = scene(sheet, 0.005023466844465266, 0.6451670213701933)
    law = ContactLaw(model_of(read(given)), PAPER | {"inertia", "plasticity"})
    problem, loose = problem_of(law, 6), waves.time_tolerance(waves.LOOSE)
    fine = numbers(law, contact_sequence.impact_history(problem, 24))
    for n in (14, 16, 22, 32):
        history = contact_sequence.impact_history(problem, n, loose)
        off = np.abs(numbers(law, history) / fine - 1.0)
        assert np.max(off) <= integration_error(history)


@pytest.mark.parametrize("name", ["several contacts", "damped"])
def test_rows_of_flights_equal_single_flights(name: str) -> None:
    _, problem = case(name)
    after = contact_sequence.impact_history(problem, 16).contacts[0].after
    times = np.array([0.0, 1e-3, 0.7, 5.0])
    for t, row in zip(times, problem.flights(after, times, 0.0).T, strict=True):
        state = problem.flown(after, float(t))
        assert row[:2].tolist() == [state.velocity, state.displacement]
        assert row[2] == pytest.approx(np.sum(state.q), rel=1e-13)
        assert row[3] == pytest.approx(np.sum(problem.energies(state)), rel=1e-13)


@pytest.mark.parametrize("approach", [1e-3, -1e-3])
def test_contact_begins_on_a_face_that_has_not_recovered(approach: float) -> None:
    """The approach is negative if the plate is more curved than the sphere; this was an error."""
    begin = ImpactState(0.0, 1.0, np.zeros(1), np.zeros(1), approach)
    assert next_element.begun(begin, 0.1) == pytest.approx(1e-3 ** (1.0 / 6.0))
