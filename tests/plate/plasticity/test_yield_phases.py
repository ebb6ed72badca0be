"""Test quadratures of plastic impacts against time elements, and rows against single scenes."""

import math
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from derivation.scene import SceneError, read, simulate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.impact import selected_effects
from derivation.scene.model import Model
from derivation.scene.quasi_static import plastic, yield_phases
from derivation.scene.result import UNITS
from derivation.scene.rows import rows as many
from derivation.scene.selection.method_selection import moved
from generated.arrays import Double as Array
from generated.plasticity import yield_speed

BALL: dict[str, Any] = {"radius": 0.01, "material": "steel", "yield_stress": 1e9}
FORCED = {"inertia": False, "plasticity": True}


def scene_on(plate: dict[str, Any], speed: float, **effects: Any) -> dict[str, Any]:
    """Return the tables of a scene with plasticity."""
    table = {"material": "steel", "yield_stress": 1e9} | plate
    return {"sphere": BALL, "plate": table, "impact": {"speed": speed}, "effects": FORCED | effects}


def law_of(tables: dict[str, Any]) -> ContactLaw:
    """Return the contact law of a scene."""
    return selected_effects(read(tables))[1].law


def log_uniform(low: float, high: float) -> st.SearchStrategy[float]:
    """Draw numbers whose logarithms are uniform."""
    return st.floats(math.log(low), math.log(high)).map(math.exp)


@st.composite
def scenes(draw: st.DrawFn) -> dict[str, Any]:
    """Draw an impact whose contact may yield."""
    R = draw(log_uniform(1e-3, 5e-2))
    b = R * draw(log_uniform(2.0, 100.0))
    E = draw(log_uniform(1e8, 3e11))
    sphere = {"radius": R, "density": draw(log_uniform(500.0, 1e4))}
    if draw(st.booleans()):
        sphere |= {"youngs_modulus": draw(log_uniform(1e8, 3e11)), "poissons_ratio": 0.3}
    plate = {
        "radius": b,
        "half_thickness": b * draw(log_uniform(3e-3, 1.0)),
        "youngs_modulus": E,
        "poissons_ratio": draw(st.floats(-0.2, 0.49)),
        "yield_stress": E * draw(log_uniform(1e-4, 3e-2)),
        "edge": draw(st.sampled_from(["paper", "clamped", "simply-supported"])),
    }
    impact = {"speed": draw(log_uniform(1e-4, 30.0))}
    return {"sphere": sphere, "plate": plate, "impact": impact, "effects": FORCED}


@pytest.mark.one_version
@settings(max_examples=25)
@given(scenes())
def test_quadratures_agree_with_time_elements(tables: dict[str, Any]) -> None:
    law = law_of(tables)
    try:
        with np.errstate(all="ignore"):
            actual, expected = moved(law), plastic.by_time_elements(law)
    except SceneError:
        assume(False)
        raise
    allowed = actual.quadrature + expected.quadrature + yield_phases.ROUNDING
    np.testing.assert_allclose(actual.numbers, expected.numbers, rtol=allowed)
    assert actual.dent == pytest.approx(expected.dent, rel=1e-8)
    assert actual.energy_balance is not None
    assert abs(actual.energy_balance.residual) <= actual.quadrature + 1e-15


def exact(model: Model) -> tuple[mp.mpf, ...]:
    """Return the results of an impact on a half-space that yields, by exact integrals.

    In units of the radius a_y at the onset of yield, with a paraboloid for which P = s^3 and
    delta = s^2, the energy is 2/5 at the onset and grows by 2 s^5 ds (Thornton 1997).
    """
    R, m, v0, lam, mu, Y = map(mp.mpf, (model.R, model.m, model.v0, model.lam, model.mu,
                                       model.yield_stress))  # fmt: skip
    modulus = 4 * mu * (lam + mu) / (lam + 2 * mu)
    a_y = mp.pi * 8 * Y * R / 5 / (2 * modulus)
    energy = 3 * m * v0**2 * R**2 / (8 * modulus * a_y**5)
    elastic = (5 * energy / 2) ** (mp.mpf(1) / 5)
    top = (1 + 3 * (energy - mp.mpf(2) / 5)) ** (mp.mpf(1) / 6)
    flat = mp.sqrt(3) * top / mp.sqrt(2 * top**3 + 1)

    def mean(power: int, last: mp.mpf, s: mp.mpf) -> mp.mpf:
        """Return (last^n - s^n)/(last - s)."""
        return mp.fsum(last**k * s ** (power - 1 - k) for k in range(power))

    def duration(slope: mp.mpf, power: int, last: mp.mpf, first: mp.mpf) -> mp.mpf:
        """Return int ds 2 slope s^(power - 4)/sqrt(1 - w/energy) from `first` to `last`."""
        length = last - first

        def rate(u: mp.mpf) -> mp.mpf:
            s = last - length * u * u
            left = 2 * slope * mean(power, last, s) / power / energy
            return 4 * slope * s ** (power - 4) * mp.sqrt(length) / mp.sqrt(left)

        return mp.quad(rate, [0, mp.mpf(1) / 2, 1])

    before = duration(mp.mpf(1), 5, elastic, mp.mpf(0)) - duration(mp.mpf(1), 5, elastic, mp.mpf(1))
    after = duration(mp.mpf(1), 6, top, mp.mpf(1)) + duration(flat, 5, top, mp.mpf(0))
    depth = top**2 + (top - 1) ** 2 * (2 * top + 1) / 3
    return (
        a_y**2 / R / v0 * (before + after),
        a_y**2 / R * depth,
        4 * modulus * (a_y * top) ** 3 / R / 3,
        a_y * top / flat,
        mp.sqrt(2 * flat * top**5 / 5 / energy),
    )


@pytest.mark.one_version
@given(
    log_uniform(1e-4, 1.0), log_uniform(1e-6, 10.0), log_uniform(1e7, 1e12),
    log_uniform(1e7, 1e12), log_uniform(1e-5, 1e-2), log_uniform(1e-6, 1e4),
)  # fmt: skip
@settings(max_examples=15)
def test_impacts_on_a_half_space_agree_with_exact_integrals(
    R: float, m: float, lam: float, mu: float, stress: float, excess: float
) -> None:
    speed = float(yield_speed(R, m, lam, mu, mu * stress)) * (1.0 + excess)
    model = Model(R=R, m=m, v0=speed, h=1e9 * R, b=2e9 * R, lam=lam, mu=mu,
                  yield_stress=mu * stress)  # fmt: skip
    actual = moved(ContactLaw(model, frozenset({"hertz", "plasticity"})))
    with mp.workdps(30):
        errors = [float(abs(x / y - 1)) for x, y in zip(actual.numbers, exact(model), strict=True)]
    assert max(errors) <= yield_phases.ROUNDING


def speed_of_yield(plate: dict[str, Any]) -> float:
    """Return the lowest speed at which the quadratures of an impact find yield."""
    low, high = 1e-3, 20.0
    while (speed := 0.5 * (low + high)) not in (low, high):
        law = law_of(scene_on(plate, speed))
        with np.errstate(all="ignore"):
            yields = np.isfinite(yield_phases.yielded(law, 24).ratio.item())
        low, high = (low, speed) if yields else (speed, high)
    return high


PLATES = [
    {"radius": 0.3, "thickness": 0.3},
    {"radius": 0.3, "thickness": 0.01, "edge": "clamped"},
    {"radius": 0.3, "thickness": 0.01},
]


@pytest.mark.parametrize("plate", PLATES)
def test_impacts_that_just_yield_are_insensitive_to_rounding(plate: dict[str, Any]) -> None:
    """The times up to the onset of yield and after it change as the root of the excess energy."""
    onset = speed_of_yield(plate)
    below = moved(law_of(scene_on(plate, onset * (1.0 - 1e-13))))
    assert below.dent == 0.0
    for excess in 1e-13, 1e-12, 1e-10, 1e-8:
        above = moved(law_of(scene_on(plate, onset * (1.0 + excess))))
        assert above.quadrature <= 1e-13
        np.testing.assert_allclose(above.numbers, below.numbers, rtol=3e-13 + 4.0 * excess)


def test_yield_beyond_the_range_of_the_law_leaves_an_elastic_contact() -> None:
    hard = scene_on(PLATES[1] | {"yield_stress": 1e15}, 1.0, non_hertzian_pressure=False)
    hard["sphere"] = BALL | {"yield_stress": 1e15}
    law = law_of(hard)
    assert yield_phases.onset_in(law).a.item() == math.inf
    elastic = read(hard | {"effects": hard["effects"] | {"plasticity": False}})
    assert moved(law).max_force == pytest.approx(simulate(elastic).max_force, rel=1e-14)


def never(*_: object, **__: object) -> None:
    """Fail if a single scene is simulated."""
    raise AssertionError("a row was not computed in arrays")


@pytest.mark.parametrize("plate", [*PLATES, {"radius": 0.3, "thickness": 0.02,
                                             "edge": "simply-supported"}])  # fmt: skip
@pytest.mark.parametrize("rtol", [None, 0.1, 1e-6])
def test_rows_with_yield_are_computed_in_arrays_and_equal_simulations(
    plate: dict[str, Any], rtol: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    tables = scene_on(plate, 1.0, plasticity="auto")
    speeds: Array = np.geomspace(2e-3, 30.0, 9)
    columns = {"impact.speed": speeds, "plate.yield_stress": np.geomspace(2e9, 4e8, 9)}
    with monkeypatch.context() as patched:
        patched.setattr(many, "simulate", never)
        found = many.solve(read(tables), columns, rtol)
    assert any("plasticity" in effects for effects in found.effects)
    assert any(found.results["restitution"] < 0.9)
    for row, (speed, stress) in enumerate(zip(*columns.values(), strict=True)):
        one_plate = tables["plate"] | {"yield_stress": float(stress)}
        given_scene = tables | {"plate": one_plate, "impact": {"speed": float(speed)}}
        one = simulate(read(given_scene), rtol=rtol)
        assert found.effects[row] == " ".join(one.effects.included)
        assert found.reason[row] == "; ".join(one.warnings)
        assert (found.bound[row], found.model_error[row]) == (one.accuracy.bound, one.model_error)
        for name in UNITS:
            assert found.results[name][row] == getattr(one, name), name
