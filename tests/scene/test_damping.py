"""Impacts on a damped plate: limits, causality, energy, rejected scenes and the error bound."""

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from derivation.scene import SceneError, explain, indent, read, simulate
from derivation.scene.dynamic.history_at import deflections
from derivation.scene.result import Result
from derivation.scene.scene import OUTPUTS

GLASS = {
    "sphere": {"radius": 0.01, "density": 7850.0},
    "plate": {
        "radius": 0.1,
        "thickness": 0.006,
        "youngs_modulus": 70e9,
        "poissons_ratio": 0.22,
        "density": 2500.0,
    },
    "impact": {"speed": 1.0},
    "effects": {"non_hertzian_pressure": False, "spherical_profile": False},
    "inertia": {"branches": "A0", "modes": 16},
}
MEMBRANE = {"radius": 0.05, "thickness": 0.001}


def scene(loss_factor: float | None, **changes: dict[str, Any]) -> dict[str, Any]:
    tables = {name: keys | changes.get(name, {}) for name, keys in GLASS.items()}
    if loss_factor is not None:
        tables["plate"]["loss_factor"] = loss_factor
    return tables


def struck(loss_factor: float | None, **changes: dict[str, Any]) -> Result:
    return simulate(read(scene(loss_factor, **changes)))


def values(result: Result) -> np.ndarray:
    return np.array([getattr(result, name) for name in OUTPUTS])


# --- limits


def test_loss_factor_of_zero_equals_no_loss_factor() -> None:
    assert values(struck(None)).tolist() == values(struck(0.0)).tolist()


@pytest.mark.one_version
@pytest.mark.parametrize("plate", [{}, {"edge": "clamped"}, MEMBRANE])
def test_undamped_plate_is_the_limit_of_small_damping(plate: dict[str, Any]) -> None:
    given = {"plate": plate, "inertia": {"modes": 8}, "effects": {"stretching": False}}
    elastic = values(struck(None, **given))
    first, second, third = (
        (values(struck(eta, **given)) / elastic - 1) / eta for eta in (1e-6, 1e-5, 2e-5)
    )
    assert np.all(np.isfinite(first))
    # Extrapolating two finite differences removes the term of second order.
    assert 2 * second - third == pytest.approx(first, rel=1e-3, abs=1e-3)


@pytest.mark.one_version
def test_damping_loss_agrees_with_perturbation_theory() -> None:
    """To first order it is the integral of 2 zeta omega q'^2 times modal mass, without damping."""
    eta, wide = 1e-6, {"radius": 0.15}
    elastic = struck(None, plate=wide)
    assert elastic.dynamics is not None
    history, balance = elastic.dynamics.impact_history, elastic.dynamics.energy_balance
    problem, [touching] = history.problem, history.contacts
    # The times are denser at the onset, where the force is a power of time.
    t = touching.end * np.linspace(0.0, 1.0, 2001) ** 2
    q = CubicSpline(t, [deflections(history, float(x)) for x in t])
    rate = q(t, 1)
    power = CubicSpline(t, (rate**2 / problem.inverse_modal_mass) @ problem.omega)
    lost = eta * float(power.integrate(0.0, touching.end)) * 2 * balance.initial_kinetic
    damped = struck(eta, plate=wide).dynamics
    assert damped is not None
    assert damped.energy_balance.damping_loss == pytest.approx(lost, rel=1e-4)


def test_static_contacts_are_not_damped() -> None:
    compliance = [indent(read(scene(eta)), force=10.0)[0].indentation for eta in (None, 0.5)]
    assert compliance[0] == compliance[1]


# --- causality


def test_only_local_damping_acts_before_the_first_echo() -> None:
    """Before a wave returns from the edge, the results do not depend on radius and support.

    Equal damping ratios of all modes act as a local damping (of the rate of curvature) for the
    paper's edge. For the other supports they also act at a distance, by less than 0.5 % of the
    change that damping makes.
    """

    def wide(eta: float | None, edge: str, b: float) -> np.ndarray:
        settings = {"modes": int(240 * b)}
        return values(struck(eta, plate={"radius": b, "edge": edge}, inertia=settings))

    elastic, damped = (wide(eta, "paper", 0.25) for eta in (None, 0.2))
    assert wide(0.2, "paper", 0.35) == pytest.approx(damped, rel=1e-4)
    effect = np.abs(damped / elastic - 1)
    assert effect[0] > 0.02 < 0.1 < effect[-1]
    for edge in ("simply-supported", "clamped"):
        apart = np.abs(wide(0.2, edge, 0.25) / damped - 1)
        assert np.all(apart < 5e-3 * effect + 1e-5)


def test_a_yielding_contact_on_a_damped_plate_ends_before_the_first_echo() -> None:
    """Its results do not depend on radius and support either, up to 1 % of what damping changes."""

    def wide(eta: float | None, edge: str, b: float, yields: bool = True) -> np.ndarray:
        plate: dict[str, Any] = {"radius": b, "edge": edge}
        plate |= {"yield_stress": 3e8} if yields else {}
        result = struck(eta, plate=plate, inertia={"modes": int(240 * b)})
        assert (result.dent > 1e-6) is yields
        return values(result)

    damped, undamped = wide(0.2, "paper", 0.25), wide(None, "paper", 0.25)
    assert wide(0.2, "paper", 0.35) == pytest.approx(damped, rel=1e-4)
    effect = np.abs(undamped / damped - 1)
    assert min(effect[-1], np.abs(wide(0.2, "paper", 0.25, yields=False) / damped - 1)[-1]) > 0.05
    for edge in ("simply-supported", "clamped"):
        apart = np.abs(wide(0.2, edge, 0.25) / damped - 1)
        assert np.all(apart < 1e-2 * effect + 1e-5)


def test_infinite_plate_agrees_with_a_large_one() -> None:
    wide = struck(0.2, plate={"radius": 0.25}, inertia={"modes": 60})
    infinite = struck(0.2, inertia={"modes": "auto", "extent": "infinite"})
    assert values(infinite) == pytest.approx(values(wide), rel=1e-3)


# --- energy

EVERYWHERE: dict[str, dict[str, Any]] = {
    "plate": {},
    "clamped": {"plate": {"edge": "clamped"}},
    "simply supported": {"plate": {"edge": "simply-supported"}},
    "every branch": {"inertia": {"branches": "all"}},
    "pointwise": {"inertia": {"coupling": "pointwise"}},
    "viscoelastic": {"plate": {"retardation_time": 3e-6}},
    "viscoelastic, several contacts": {
        "plate": MEMBRANE | {"retardation_time": 3e-6},
        "inertia": {"modes": 8},
    },
    "heavy": {"impact": {"speed": 0.05, "gravity": 9.81}},
    "several contacts": {"plate": MEMBRANE, "inertia": {"modes": 8}},
}


@pytest.mark.parametrize("name", EVERYWHERE)
@pytest.mark.parametrize("eta", [0.01, 1.0])
def test_energy_balance_closes(name: str, eta: float) -> None:
    """The energy balance closes; the damping loss is a separate integral, so this is a test."""
    result = struck(eta, **EVERYWHERE[name], effects={"stretching": False})
    assert result.complete
    assert result.dynamics is not None
    balance = result.dynamics.energy_balance
    assert abs(balance.residual) < 1e-10
    assert balance.damping_loss > 1e-4 * eta * balance.initial_kinetic
    assert result.dynamics.to_json()["energy_balance"]["damping_loss"] == balance.damping_loss
    assert "damping of the plate" in balance.in_words(1e-3)


def test_plate_only_loses_energy_without_contact() -> None:
    result = struck(0.05, plate=MEMBRANE, inertia={"modes": 8})
    assert result.dynamics is not None
    contacts = result.dynamics.inertia.contacts
    assert len(contacts) > 1
    for one, other in pairwise(contacts):
        energy = result.dynamics.rows(np.linspace(one.end, other.start, 50)[1:-1])[5]
        assert np.all(np.diff(energy) < 0)


def test_plate_energy_decreases_with_damping() -> None:
    left = [struck(eta).dynamics for eta in (None, 0.01, 0.1, 1.0)]
    energies = [impact.energy_balance.plate for impact in left if impact is not None]
    assert all(later < earlier for earlier, later in pairwise(energies))


# --- scene keys


def row(tables: dict[str, Any]) -> Any:
    return {row.name: row for row in explain(read(tables)).effects.rows}["damping"]


@pytest.mark.parametrize("value", [-0.01, 2.0, 3.0])
def test_loss_factor_must_be_below_critical_damping(value: float) -> None:
    with pytest.raises(SceneError, match=r"plate\.loss_factor: .*0 to below 2"):
        read(scene(value))


def test_table_states_why_damping_does_not_apply() -> None:
    assert row(scene(None)).reason == "plate.loss_factor is not given"
    still = {"inertia": False}
    assert row(scene(0.1, effects=still)).reason == "effects.inertia = false"
    light = scene(0.1, effects=still)
    del light["plate"]["density"]
    assert row(light).reason == "the density of the plate is unknown"
    with pytest.raises(SceneError, match=r"^effects\.damping .*effects\.inertia"):
        explain(read(scene(0.1, effects=still | {"damping": True})))


def test_damping_is_selected_if_needed_and_can_be_disabled() -> None:
    assert row(scene(0.1)).included
    out = row(scene(0.1, effects={"damping": False}))
    assert out.disabled
    elastic = values(struck(None))
    assert values(struck(0.1, effects={"damping": False})).tolist() == elastic.tolist()
    enabled = explain(read(scene(0.1, effects={"damping": True})))
    assert {"inertia", "damping"} <= enabled.effects.law.effects


# --- the error bound


NEARLY_STATIC = [
    {"plate": {"radius": 0.02}, "impact": {"speed": 0.05}},
    {"plate": {"radius": 0.03, "thickness": 0.01}, "impact": {"speed": 0.3}},
    {"plate": {"radius": 0.02, "thickness": 0.008}, "sphere": {"density": 2e5}},
    {"plate": {"radius": 0.03, "edge": "clamped"}, "sphere": {"density": 5e5}},
    {"plate": {"radius": 0.02}, "impact": {"speed": 0.02, "gravity": 9.81}},
]


@pytest.mark.one_version
@pytest.mark.parametrize("changes", NEARLY_STATIC)
@pytest.mark.parametrize("eta", [1e-3, 1.0])
def test_change_by_omitted_damping_is_within_its_bound(
    changes: dict[str, dict[str, Any]], eta: float
) -> None:
    effects = {"inertia": True, "damping": True}
    whole = struck(eta, **changes, effects=effects)
    rest = struck(eta, **changes, effects=effects | {"damping": False})
    for result in (whole, rest):
        bound = {row.name: row.bound for row in result.effects.rows}["damping"]
        assert np.max(np.abs(values(rest) / values(whole) - 1)) <= bound < math.inf


def test_no_bound_is_stated_if_inertia_has_none() -> None:
    assert math.isinf(row(scene(1e-3, plate=MEMBRANE)).bound)


def test_damping_is_omitted_for_a_nearly_quasi_static_plate() -> None:
    """The bound of the omitted damping is then part of the stated error."""
    tables = scene(1e-4, plate={"radius": 0.02}, impact={"speed": 0.001}, sphere={"density": 1e6})
    del tables["inertia"]
    explanation = explain(read(tables), rtol=0.5)
    assert not row(tables | {"accuracy": {"rtol": 0.5}}).included
    bound = {row.name: row.bound for row in explanation.effects.rows}["damping"]
    assert 0 < bound <= explanation.effects.error


@pytest.mark.one_version
def test_bound_covers_omitted_modes_of_a_strongly_damped_plate() -> None:
    """Each doubling of the modes changes the results by the same amount; an old bound was 1e-4."""
    marble = {
        "sphere": {"radius": 0.0108, "material": "glass"},
        "plate": {"radius": 0.08, "thickness": 0.0138, "material": "alumina",
                  "edge": "clamped", "loss_factor": 0.263},
        "impact": {"speed": 0.887},
    }  # fmt: skip
    result, more = (
        simulate(read(marble | {"inertia": {"modes": modes, "branches": "all"}}))
        for modes in (10, 72)
    )
    change = np.max(np.abs(values(result) / values(more) - 1.0))
    assert 1.5e-4 < change <= result.accuracy.bound
    assert result.accuracy.bound < 4.0 * change


@pytest.mark.one_version
def test_bound_without_higher_branches_covers_a_strongly_damped_plate() -> None:
    """Strong damping increases the energy that the omitted wave branches take."""
    plate = {
        "radius": 0.378, "half_thickness": 0.202, "youngs_modulus": 12.84e9,
        "poissons_ratio": 0.499, "density": 970.0, "loss_factor": 1.5,
    }  # fmt: skip
    tables = {
        "sphere": {"radius": 0.418, "density": 1552.0, "material": "aluminium"},
        "plate": plate, "impact": {"speed": 9.37e-3}, "effects": {"inertia": True},
    }  # fmt: skip
    lowest, every = (
        simulate(read(tables | {"inertia": inertia}))
        for inertia in ({"branches": "A0"}, {"branches": "all", "modes": 40})
    )
    changes = [abs(getattr(lowest, name) / getattr(every, name) - 1.0) for name in OUTPUTS]
    assert 1e-3 < max(changes) < lowest.accuracy.bound
