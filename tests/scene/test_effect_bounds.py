"""Error bounds of omitted effects: they cover the change of each effect and are close to it."""

import math
import random
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shared_scenes import ALL, AT_REST, model

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.effects import BY_NAME, EFFECTS
from derivation.scene.effects.effect import BoundContext, PlateEffect
from derivation.scene.model import Model
from derivation.scene.quasi_static import motion
from derivation.scene.quasi_static.motion import Motion
from derivation.scene.selection.effect_selection import OUTPUTS, decide
from derivation.scene.selection.method_selection import moved

TINY = 1e-12
"""Rounding error of bounds and contributions."""


def applicable(m: Model) -> frozenset[str]:
    """Return the effects that apply to a quasi-static plate."""
    return frozenset(name for name in ALL if not BY_NAME[name].not_applicable_reason(m))


def impact(m: Model, effects: frozenset[str]) -> Motion:
    with np.errstate(all="ignore"):
        return motion.impact(ContactLaw(m, effects))


def largest_difference(one: Motion, other: Motion) -> float:
    """Return the largest difference of the results, relative to the second impact."""
    return max(abs(x / y - 1) for x, y in zip(one.numbers, other.numbers, strict=True))


# --- single effects


@pytest.mark.parametrize("name", sorted(n for n in ALL if isinstance(BY_NAME[n], PlateEffect)))
def test_contribution_to_the_slope_is_within_its_bound_at_every_radius(name: str) -> None:
    """The bounds never decrease with the radius, so they cover all smaller radii too."""
    generator, effect = random.Random(name), BY_NAME[name]
    assert isinstance(effect, PlateEffect)
    nearest = math.inf
    for number in range(40):
        h, nu = 10 ** generator.uniform(-2.5, 1), generator.uniform(-0.6, 0.48)
        edge = ("simply-supported", "clamped")[number % 2]
        m = model(b=1.0, h=h, lam=2 * 3e9 * nu / (1 - 2 * nu), edge=edge)
        a = np.geomspace(1e-4, 0.89, 60) * min(1.0, 6 * h)
        bound, slope = effect.bound(m, BoundContext(a)), effect.contribution(m, a).slope
        # Contributions are differences of larger terms, whose rounding errors they inherit.
        room = TINY * (1 + np.abs(slope) + BY_NAME["bending"].bound(m, BoundContext(a)).up)
        assert (slope <= bound.up + room).all()
        assert (-slope <= bound.low + room).all()
        assert (bound.up[1:] >= bound.up[:-1]).all()
        assert (bound.low[1:] >= bound.low[:-1]).all()
        within = np.abs(slope) > 1e-3
        larger = np.maximum(bound.up, bound.low)[within] / np.abs(slope)[within]
        nearest = min(nearest, float(np.min(larger, initial=math.inf)))
    assert nearest < 1.3


CLOSE: list[tuple[str, float, dict[str, Any]]] = [
    ("spherical_profile", 0.95, {}),
    ("spherical_profile", 0.9, {"h": 5.0, "b": 0.3, "v0": 3.0, "m": 10.0}),
    ("gravity", 0.99, {"h": 5.0, "b": 0.3, "v0": 3.0, "m": 10.0}),
    ("gravity", 0.8, {}),
    ("sphere_elasticity", 0.75, {"m": 300.0, "v0": 0.02, "h": 0.1}),
    ("sphere_elasticity", 0.85, {"sphere_modulus": 1e13, "v0": 0.1, "h": 0.1}),
    ("finite_radius", 0.9, {"h": 0.005, "v0": 0.05}),
    ("finite_radius", 0.8, {"h": 5.0, "b": 0.3, "v0": 3.0, "m": 10.0}),
    ("finite_thickness", 0.9, {"h": 0.005, "v0": 0.05}),
    ("bending", 0.8, {"h": 5.0, "b": 5.0, "v0": 0.3}),
    ("edge", 0.65, {"h": 0.005, "v0": 0.05}),
    ("non_hertzian_pressure", 0.5, {"h": 0.01, "b": 1.0}),
    ("non_hertzian_pressure", 0.5, {}),
]
"""An effect, the least ratio of change to bound for some output, and a scene."""


@pytest.mark.parametrize(("name", "used", "changes"), CLOSE)
def test_change_by_an_effect_is_within_its_bound_and_close_to_it(
    name: str, used: float, changes: dict[str, Any]
) -> None:
    """Compare impacts with all effects and with all but one; the change is within the bound."""
    m = model(**changes)
    every = applicable(m) - (
        set() if name == "non_hertzian_pressure" else {"non_hertzian_pressure"}
    )
    wanted = {effect.name: effect.name in every - {name} for effect in EFFECTS}
    one, other = impact(m, every - {name}).numbers, impact(m, every).numbers
    used_fractions = []
    for output, x, y in zip(OUTPUTS, one, other, strict=True):
        selected = decide(m, AT_REST | wanted, 1.0, (output,))
        assert selected.law.effects == every - {name}
        bound = {row.name: row.bound for row in selected.rows}[name]
        if output == "restitution":  # it is 1 without viscosity
            assert (x, y, bound) == (1.0, 1.0, 0.0)
        else:
            used_fractions.append(abs(x / y - 1) / bound)
    assert used < max(used_fractions)
    assert all(fraction <= 1 for fraction in used_fractions)


@pytest.mark.parametrize("name", ["sphere_elasticity", "gravity", "edge"])
def test_bounds_hold_with_non_hertzian_pressure(name: str) -> None:
    """With non-Hertzian pressure the contact radius grows faster than Hertz's at equal force."""
    b = 1.76595204337641
    m = model(
        R=1.8971866830973843, m=41077.25867811576, v0=0.42665213036895394, b=b,
        h=0.16332349537168003, lam=-167666559.7545434, mu=390994467.72373784,
        sphere_modulus=1e10, gravity=0.05,
    )  # fmt: skip
    wanted = {other: other != name for other in ALL} | AT_REST
    selected = decide(m, AT_REST | wanted, 1.0)
    bound = {row.name: row.bound for row in selected.rows}[name]
    assert 0.2 < largest_difference(impact(m, ALL - {name}), impact(m, ALL)) / bound <= 1
    # The bound of the spherical profile is known for Hertz's pressure only.
    flat = decide(m, AT_REST | wanted | {"spherical_profile": False}, 1.0)
    assert {row.name: row.bound for row in flat.rows}["spherical_profile"] == math.inf


@pytest.mark.parametrize("weight", [0.0, 0.2, 0.38])
def test_bound_of_plasticity_holds_under_the_weight(weight: float) -> None:
    """The work of the weight also deforms the contact; the restitution follows from energies."""
    m = model(h=50.0, b=50.0)
    xi = 1.05  # Hertz's radius of the force over that at the onset of yield
    depth = (2 * xi**3 + 1) / 3  # in units of the indentation at the onset
    recovered = xi**3 / math.sqrt(depth)
    # In units of the energy at the onset; force times indentation there is 5/2 of it.
    reached, lost = 1 + 5 / 6 * (xi**6 - 1), 1 + 5 / 6 * (xi**6 - 1) - xi**3 * recovered
    kinetic = reached - 2.5 * weight * depth
    speed = 1e-3
    onset = 0.5 * m.m * speed**2 / kinetic
    a = (15 / 8 * onset * m.R**2 / m.modulus) ** 0.2
    m = replace(
        m, v0=speed, gravity=weight * 4 / 3 * m.modulus * a**3 / m.R / m.m,
        yield_stress=2 * m.modulus * a / (math.pi * m.R) / 1.6,
    )  # fmt: skip
    e = math.sqrt(1 - (lost - 2.5 * weight * (depth - recovered)) / kinetic)
    law = ContactLaw(m, frozenset({"hertz", "plasticity", "gravity"}))
    assert moved(law).numbers[-1] == pytest.approx(e, rel=1e-9)
    wanted = {e.name: e.name in ("hertz", "gravity") for e in EFFECTS}
    rows = decide(m, wanted, 1.0, ("restitution",)).rows
    [row] = [row for row in rows if row.name == "plasticity"]
    assert 1 - e <= row.bound < math.inf


@pytest.mark.parametrize("edge", ["simply-supported", "clamped"])
def test_included_effects_have_a_bound(edge: str) -> None:
    """The effects table also bounds the change if an included effect were omitted."""
    m = model(h=5.0, b=5.0, v0=0.3, edge=edge, sphere_modulus=1e13)
    every = applicable(m) - {"non_hertzian_pressure"}
    selected = decide(m, AT_REST | {"non_hertzian_pressure": False}, 0.0)
    assert selected.law.effects == every
    for row in selected.rows:
        if row.included and row.name != "hertz":
            change = largest_difference(impact(m, every - {row.name}), impact(m, every))
            assert 0.03 * row.bound < change <= 1.02 * row.bound


# --- several effects


SCENES: dict[str, dict[str, Any]] = {
    "soft plate": {},
    "thin": {"h": 0.005, "v0": 0.05},
    "clamped": {"h": 0.2, "edge": "clamped", "v0": 0.3},
    "block": {"h": 5.0, "b": 5.0, "v0": 0.3},
    "small": {"h": 5.0, "b": 0.3, "v0": 3.0, "m": 10.0},
    "soft sphere": {"sphere_modulus": 1e9, "h": 0.3},
    "deep": {"h": 0.3, "v0": 30.0, "lam": 2e8, "mu": 3e8},
}


@pytest.mark.parametrize("name", SCENES)
def test_error_is_within_the_bound_at_every_threshold(name: str) -> None:
    """Tighten the tolerance from no effect to all; the error stays within each bound."""
    m = model(**SCENES[name])
    whole, rtol, before = impact(m, applicable(m)), 10.0, frozenset[str]()
    while True:
        selection = decide(m, AT_REST, rtol)
        assert selection.law.effects > before
        assert selection.error <= rtol
        assert (
            largest_difference(impact(m, selection.law.effects), whole) <= selection.error + 5e-14
        )
        if not selection.error:
            break
        assert decide(m, AT_REST, selection.error).law.effects == selection.law.effects
        before, rtol = selection.law.effects, selection.error * (1 - 1e-9)
    assert selection.law.effects == applicable(m)


@pytest.mark.parametrize(
    ("one", "other", "edge"),
    [
        ("bending", "edge", "simply-supported"),
        ("bending", "spherical_profile", "simply-supported"),
        ("finite_radius", "edge", "clamped"),
        ("gravity", "bending", "clamped"),
    ],
)
def test_bounds_of_omitted_effects_add_up(one: str, other: str, edge: str) -> None:
    """To leading order the errors of two omitted effects add up, as they may have the same sign."""
    m = model(h=5.0, b=5.0, v0=0.3, gravity=0.01, edge=edge)

    def error(*out: str) -> float:
        wanted = {e.name: "auto" if e.name in out else False for e in EFFECTS}
        selection = decide(m, AT_REST | wanted, 1.0, ("max_indentation",))
        assert selection.law.effects == {"hertz"}
        return selection.error

    both, apiece = error(one, other), error(one) + error(other)
    assert both == pytest.approx(apiece, rel=0.01)


def test_every_effect_has_a_threshold() -> None:
    m = model(**SCENES["block"], retardation_time=1e-8)
    assert applicable(m) == ALL
    assert decide(m, AT_REST, 10.0).law.effects == {"hertz"}
    assert decide(m, AT_REST, 0.0).law.effects == ALL


decades = st.floats(-1.0, 1.0)


@settings(max_examples=12)
@given(
    thick=decades, fast=decades, soft=decades, heavy=decades,
    edge=st.sampled_from(["paper", "simply-supported", "clamped"]),
    tolerances=st.lists(st.floats(-10.0, 0.0), min_size=3, max_size=3),
)  # fmt: skip
def test_number_of_effects_decreases_with_the_tolerance(
    thick: float, fast: float, soft: float, heavy: float, edge: str, tolerances: list[float]
) -> None:
    m = model(
        h=0.05 * 10**thick, v0=0.1 * 10 ** (2 * fast), m=3 * 10**heavy, edge=edge,
        sphere_modulus=3e10 * 10**soft,
    )  # fmt: skip
    taken = [decide(m, AT_REST, 10**power).law.effects for power in sorted(tolerances)]
    assert taken[0] >= taken[1] >= taken[2]
