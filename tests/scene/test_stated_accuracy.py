"""The stated accuracy of results: tolerances, digits, rounding errors and time steps."""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pytest

from derivation.engine import activity
from derivation.scene import SceneError, read, simulate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import contact_sequence, flight
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.effects import PAPER
from derivation.scene.effects.effect import NO_BOUND
from derivation.scene.model import model_of
from derivation.scene.output.answer import plain, quantities
from derivation.scene.quantity import MOST_DIGITS
from derivation.scene.result import Result
from derivation.scene.scene import OUTPUTS
from derivation.scene.selection.achieved_accuracy import PROVED, Part

BALL = {"radius": 0.01, "material": "steel"}
PANE = {"radius": 0.1, "thickness": 0.01, "material": "glass"}


def scene(**tables: Mapping[str, Any]) -> Any:
    return read({"sphere": BALL, "plate": PANE, "impact": {"speed": 1.0}} | tables)


@pytest.mark.parametrize("rtol", [1e-1, 1e-2, 1e-3])
def test_tolerance_is_met(rtol: float) -> None:
    fine, result = simulate(scene()), simulate(scene(), rtol=rtol)
    assert result.accuracy.bound <= rtol
    for name in OUTPUTS:
        off = abs(getattr(result, name) / getattr(fine, name) - 1.0)
        assert off <= result.accuracy.bound + fine.accuracy.bound


def test_outputs_without_a_tolerance_have_the_error_of_these_alone() -> None:
    every, fine = (simulate(scene(inertia={"modes": modes})) for modes in (40, 320))
    bounds = []
    for name in OUTPUTS:
        one = simulate(scene(inertia={"modes": 40}, accuracy={"outputs": [name]}))
        assert getattr(one, name) == getattr(every, name)
        assert getattr(fine, name) == pytest.approx(getattr(one, name), rel=one.accuracy.bound)
        bounds.append(one.accuracy.bound)
    assert min(bounds) < 0.5 * max(bounds)
    assert 0.9 * every.accuracy.bound < max(bounds) <= every.accuracy.bound


def test_unattainable_tolerance_is_rejected() -> None:
    few = {"modes": 8, "branches": "A0"}
    with pytest.raises(SceneError, match=r"^rtol: .*at least"):
        simulate(scene(inertia=few), rtol=1e-6)
    assert simulate(scene(inertia=few)).accuracy.bound > 1e-6


def test_number_of_digits_follows_from_bound_and_model_error() -> None:
    result = simulate(scene())
    error = result.accuracy.bound + result.model_error
    rows = {name: float(value) for name, value, _ in map(str.split, plain(result).splitlines())}
    # Rounding to the shown digits changes the value by at most ten times the error.
    shown = rows["max_force"]
    assert abs(shown / result.max_force - 1.0) <= 10.0 * error
    exact = replace(result, accuracy=replace(result.accuracy, law=result.accuracy.rounding))
    assert replace(exact, model_error=0.0).digits > result.digits
    assert replace(exact, model_error=0.0).digits <= MOST_DIGITS
    assert replace(result, model_error=0.05).digits == 2
    assert replace(result, model_errors={"max_force": 0.05}).digits_of_result("max_force") == 2
    # A number of the model is shown, however large the model error.
    assert replace(result, model_errors={"max_force": 5.0}).digits_of_result("max_force") == 1


def test_results_with_an_error_of_their_size_are_not_shown() -> None:
    known = simulate(scene())
    lost = replace(known, accuracy=replace(known.accuracy, quadrature=Part(1.0, PROVED)))
    assert {line.split()[1] for line in plain(lost).splitlines()} == {"unknown"}
    for name, value, unit in quantities(lost):
        assert (value, unit) == ("unknown", ""), name


def test_disabled_effects_are_stated_with_their_bound() -> None:
    result = simulate(scene(effects={"sphere_elasticity": False}))
    row = next(row for row in result.effects.rows if row.disabled)
    assert row.name == "sphere_elasticity"
    known = row.bound < NO_BOUND
    assert ("at most" if known else "no bound") in result.disabled_note
    assert not simulate(scene()).disabled_note


def test_rounding_of_a_small_difference_is_within_the_bound() -> None:
    """Other units change only rounding, here of a small difference of large terms."""

    def run(f: float) -> Result:
        return simulate(
            read(
                {
                    "sphere": {"radius": 0.01 * f, "mass": 0.01},
                    "plate": {"radius": 1.0 * f, "half_thickness": 0.002 * f,
                              "lame_lambda": 0.36e9 / f, "lame_mu": 0.43e9 / f},
                    "impact": {"speed": f},
                    "effects": {"bending": False, "finite_radius": True, "finite_thickness": True,
                                "inertia": False, "non_hertzian_pressure": False},
                }
            ), rtol=1e-9,
        )  # fmt: skip

    one = run(1.0)
    for f in (2.0**5, 2.0**-7, 2.0**20):
        other = run(f)
        stated = one.accuracy.bound + other.accuracy.bound
        pairs = ((one.contact_time, other.contact_time), (one.max_force * f, other.max_force))
        assert all(abs(b / a - 1.0) <= stated for a, b in pairs)


def test_recontact_does_not_depend_on_the_recovery_threshold(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Results do not depend on the threshold from which the surface counts as recovered."""
    given = read(
        {
            "sphere": {"radius": 0.02, "mass": 1.0},
            "plate": {"radius": 0.15, "thickness": 0.01, "material": "steel",
                      "retardation_time": 1e-5},
            "impact": {"speed": 1.0},
        }
    )  # fmt: skip
    law = ContactLaw(model_of(given), PAPER | {"viscosity", "inertia"})
    problem = problem_of(law, 8)
    actual = []
    for recovered in (15.0, 20.0):
        monkeypatch.setattr(flight, "RECOVERED", recovered)
        actual.append(contact_sequence.impact_history(problem, 16))
    one, other = actual
    assert one.complete
    assert len(one.contacts) == len(other.contacts) > 1
    assert one.contacts[-1].after.velocity == pytest.approx(
        other.contacts[-1].after.velocity, rel=1e-9
    )


def test_long_run_reports_progress(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contact_sequence, "PROGRESS", 1)
    law = ContactLaw(model_of(scene()), PAPER | {"inertia"})
    problem, reported = problem_of(law, 4), list[str]()
    with activity.listening(reported.append):
        contact_sequence.impact_history(problem, 10)
    assert reported
    count = len(reported)
    assert all("after first contact" in text for text in reported)
    contact_sequence.impact_history(problem, 10)
    assert len(reported) == count


def test_slow_modes_exclude_contact_for_a_time() -> None:
    """No contact occurs within the time for which the slow modes exclude it."""
    law = ContactLaw(replace(model_of(scene()), h=0.001, m=0.05), frozenset(
        {"hertz", "bending", "finite_thickness", "finite_radius", "inertia"}))  # fmt: skip
    problem = problem_of(law, 40)
    history = contact_sequence.impact_history(problem, 14)
    for one, two in zip(history.contacts, history.contacts[1:], strict=False):
        wait = two.start - one.end
        clear = flight._time_apart(problem, one.after)
        assert clear <= wait
        for fraction in (0.25, 0.5, 1.0):
            assert problem.flown(one.after, fraction * clear).approach <= 1e-12
    assert len(history.contacts) > 1


def test_tolerance_is_rejected_if_omitted_effects_have_no_bound() -> None:
    scene = read(
        {
            "sphere": {"radius": 0.05, "material": "steel"},
            "plate": {"radius": 0.2, "thickness": 0.004, "material": "aluminium"},
            "impact": {"speed": 20.0},
            "effects": {"finite_radius": False, "inertia": False},
        }
    )
    assert math.isinf(simulate(scene).accuracy.effects.bound)
    with pytest.raises(SceneError, match=r"^rtol: .*\[effects\]"):
        simulate(scene, rtol=0.5)


@pytest.mark.parametrize(
    ("sphere", "plate", "speed"),
    [
        (0.0078, {"radius": 0.14, "thickness": 0.0037, "edge": "simply-supported"}, 0.28),
        (0.006, {"radius": 0.0257, "thickness": 7.54e-4, "edge": "paper"}, 0.06),
    ],
)
def test_omitted_effects_change_the_pressure_more_than_the_bound(
    sphere: float, plate: dict[str, Any], speed: float
) -> None:
    """The reason is the curvature of the plate under the contact; the difference is up to 27 %."""
    elastic = {"youngs_modulus": 4.5e8, "poissons_ratio": 0.25}
    tables = {"sphere": BALL | {"radius": sphere}, "plate": plate | elastic}
    given = scene(**tables, impact={"speed": speed}, effects={"inertia": False})
    loose, whole = (simulate(given, rtol=rtol) for rtol in (0.03, 1e-9))
    change = abs(loose.max_pressure / whole.max_pressure - 1.0)
    assert loose.accuracy.bound < change < 0.5 * loose.accuracy.pressure_bound
    assert abs(loose.max_contact_radius / whole.max_contact_radius - 1.0) < loose.accuracy.bound
