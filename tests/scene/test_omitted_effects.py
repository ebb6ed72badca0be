"""Omitted effects cause no calls of kernels, no zeros of J0 and no imports."""

import math
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from types import FunctionType
from typing import Any

import numpy as np
import pytest
from shared_scenes import ALL, EXAMPLES, model, scene

import derivation
from derivation.scene import kernels, simulate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.effects import WHOLE_PLATE
from derivation.scene.quasi_static import motion
from derivation.scene.selection.method_selection import moved
from generated import contact_series, edge_sums, non_hertzian_pressure

BOUNDS = {
    "bending", "sphere_contact", "supported_edge_bound", "clamped_edge_bound",
    "supported_edge_curvature", "clamped_edge_curvature", "law_errors",
}  # fmt: skip
"""Kernels that the bounds call, also those of omitted effects in the table."""
HERTZ = {"hertz_force", "hertz_stiffness", "hertz_pressure"}
"""Kernels of Hertz's law, which is never omitted: their calls are not recorded."""
MODEL_ERRORS = {"face_motion"}
"""Kernels of the model errors of every contact."""
WHOLE = {"contact_plates", "plate_contribution"}
ZEROS = {"bessel_j0_zeros", "bessel_j1_at_j0_zeros"}
ALONE: dict[str, set[str]] = {
    "hertz": set(),
    "sphere_elasticity": set(),
    "gravity": set(),
    "viscosity": set(),
    "spherical_profile": {"sphere_contact"},
    "bending": {"bending"},
    "finite_radius": {"finite_radius"},
    "finite_thickness": WHOLE | {"bending", "finite_radius"},
    # A series up to the largest radius by Hertz's law, from which the slope follows.
    "edge": ZEROS | {"supported_edge", "hertz_constant", "hertz_depth"},
    "non_hertzian_pressure": ZEROS | {"contact", "plate"},
}
"""Functions that an impact calls for Hertz's contact and one more effect."""


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> set[str]:
    """Record the names of called kernels of effects, and of functions that return zeros of J0."""
    actual: set[str] = set()

    def count(home: Any, name: str) -> None:
        run = getattr(home, name)

        def counted(*given: Any, **named: Any) -> Any:
            actual.add(name)
            return run(*given, **named)

        monkeypatch.setattr(home, name, counted)

    for name in set(kernels.__all__) - HERTZ:
        if isinstance(getattr(kernels, name), FunctionType):
            count(kernels, name)
    for home in (edge_sums, contact_series):
        for name in ZEROS:
            count(home, name)
    count(non_hertzian_pressure, "contact")
    count(non_hertzian_pressure, "plate")
    return actual


@pytest.mark.parametrize("name", sorted(ALL))
def test_single_effect_calls_only_its_own_functions(name: str, calls: set[str]) -> None:
    law = ContactLaw(model(b=0.51, h=0.123, retardation_time=1e-6), frozenset({"hertz", name}))
    moved(law)
    assert calls == ALONE[name]


@pytest.mark.parametrize("name", ["spherical_profile", "edge", "non_hertzian_pressure"])
def test_other_effects_do_not_call_its_functions(name: str, calls: set[str]) -> None:
    motion.impact(ContactLaw(model(b=0.52, h=0.124), ALL - {name, "non_hertzian_pressure"}))
    assert calls.isdisjoint(ALONE[name] - ZEROS)
    assert name != "edge" or calls.isdisjoint(ZEROS)
    assert calls >= WHOLE


def test_parts_of_the_plate_need_one_function_or_none(calls: set[str]) -> None:
    m = model(b=0.53, h=0.125)
    motion.impact(ContactLaw(m, WHOLE_PLATE | {"hertz"}))
    assert calls == WHOLE
    calls.clear()
    motion.impact(ContactLaw(m, ALL - WHOLE_PLATE - {"non_hertzian_pressure"}))
    assert calls == ALONE["edge"] | ALONE["spherical_profile"]


@pytest.mark.parametrize(
    ("name", "without"),
    [
        ("gravity", {"gravity": 0.0}),
        ("sphere_elasticity", {"sphere_modulus": float("inf")}),
        ("edge", {"edge": "paper"}),
    ],
)
def test_omitted_effect_gives_the_result_of_a_scene_without_it(name: str, without: Any) -> None:
    m = model()
    left, rest = ALL - {name}, replace(m, **without)
    one, other = (
        motion.impact(ContactLaw(of, left - {"non_hertzian_pressure"})) for of in (m, rest)
    )
    # The polynomials of a simple support reach as far as the contact, which depends on the sphere.
    rounding = 1e-14 if name == "sphere_elasticity" else 0.0
    np.testing.assert_allclose(other.numbers, one.numbers, rtol=rounding)


def test_half_space_calls_only_bounds_and_the_closed_form(calls: set[str]) -> None:
    """If all effects are omitted automatically, only bounds and Hertz's impact are evaluated."""
    block = {"half_thickness": 1e4, "radius": 1e4}
    auto = {"inertia": "auto"}
    result = simulate(scene(plate=block, sphere={"material": None}, effects=auto), rtol=0.02)
    assert result.effects.law.effects == {"hertz"}
    assert {row.name for row in result.effects.rows if row.bound > 0} >= {
        "edge",
        "non_hertzian_pressure",
        *auto,
    }
    assert calls <= BOUNDS | MODEL_ERRORS | ZEROS  # the curvature by a support needs a few modes


def test_functions_of_omitted_effects_are_not_called(monkeypatch: pytest.MonkeyPatch) -> None:
    """An impact on a half-space calls no kernel of the plate's contact law."""
    calls: list[str] = []
    for name in ("indentation", "indentation_slope", "impact", "finite_radius"):
        monkeypatch.setattr(
            kernels, name, lambda *_, name=name, **__: calls.append(name) or math.nan
        )
    thick = {"half_thickness": 1e3, "radius": 1e4}
    for name in ("supported_edge", "supported_edge_slope"):
        monkeypatch.setattr(kernels, name, lambda *_, name=name: calls.append(name) or math.nan)
    result = simulate(scene(plate=thick, effects={"spherical_profile": False, "gravity": False}))
    assert result.effects.law.effects == {"hertz", "sphere_elasticity"}
    assert calls == []
    motion.impact(ContactLaw(model(), frozenset({"hertz", "bending"})))
    assert calls == []


COUNT = """
import sys
from derivation.scene import load, simulate
result = simulate(load(sys.argv[1]))
for effect, module in (
    ("non_hertzian_pressure", "generated.non_hertzian_pressure"),
    ("viscosity", "derivation.scene.quasi_static.viscous"),
    ("inertia", "derivation.scene.dynamic.waves"), ("inertia", "generated.inertia"),
):
    print(effect in result.effects.law.effects, module in sys.modules)
"""


@pytest.mark.parametrize(
    ("name", "more", "effects"),
    [
        ("block", "", set()),
        ("soft_layer", "inertia = false", {"non_hertzian_pressure"}),
        ("pad", "inertia = false", {"non_hertzian_pressure", "viscosity"}),
        ("soft_layer", "", {"non_hertzian_pressure", "inertia"}),
    ],
)
def test_only_required_modules_are_imported(
    name: str, more: str, effects: set[str], tmp_path: Path
) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(f"{(EXAMPLES / name).with_suffix('.toml').read_text()}\n[effects]\n{more}\n")
    run = subprocess.run(
        [sys.executable, "-c", COUNT, str(path)],
        cwd=Path(derivation.__file__).parent.parent, capture_output=True, text=True, check=True,
    )  # fmt: skip
    requested = ("non_hertzian_pressure", "viscosity", "inertia", "inertia")
    assert run.stdout.split() == [str(x in effects) for x in requested for _ in range(2)]
