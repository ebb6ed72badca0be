"""The generated code of a scene needs only NumPy and reproduces its law and impact."""

import ast
import json
import math
import re
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from shared_scenes import AT_REST, EXAMPLES, PAPER, changed

from derivation.checks.effects import scene as random_scene
from derivation.cli import main
from derivation.engine.files import ROOT
from derivation.scene import SceneError, indent, load, read, simulate
from derivation.scene.code.code import Recipe, recipe
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.selection.method_selection import moved
from derivation.scene_code import scene_code

RANDOM = {f"random {n}": (n, rtol) for n, rtol in ((0, 1e-2), (3, 1e-4), (15, 1e-6), (11, 1e-9))}
PAD = {
    "sphere": {"radius": 0.01, "mass": 0.03}, "impact": {"speed": 1.0},
    "plate": {
        "radius": 0.5, "thickness": 0.4, "youngs_modulus": 5e6, "poissons_ratio": 0.4,
        "retardation_time": 1e-4,
    },
}  # fmt: skip
VISCOUS: dict[str, dict[str, dict[str, Any]]] = {
    "viscous": {
        "effects": {"bending": False, "finite_thickness": False, "spherical_profile": False},
        "accuracy": {"rtol": 1e-2},
    },
    "viscous, heavy": {
        "plate": {"retardation_time": 1e-3}, "impact": {"gravity": 9.81},
        "effects": {"bending": False, "non_hertzian_pressure": False, "gravity": True},
        "accuracy": {"rtol": 1e-3},
    },
    "viscous, bent": {"plate": {"thickness": 0.02, "retardation_time": 1e-3}},
    "viscous, stiff": {
        "plate": {"thickness": 0.04, "retardation_time": 1e-6}, "accuracy": {"rtol": 1e-9},
    },
}  # fmt: skip
CASES = [*sorted(path.stem for path in EXAMPLES.glob("*.toml")), *RANDOM, *VISCOUS]
ALONE = """
import importlib.util, json, sys, warnings
import numpy as np
warnings.simplefilter("error")
spec = importlib.util.spec_from_file_location("alone", sys.argv[1])
module = importlib.util.module_from_spec(spec)
spec.loader.exec_module(module)
asked = json.load(sys.stdin)
delta = np.array(asked["delta"])
static = getattr(module, "elastic_force", module.force)
results = {f.__name__: f(delta).tolist() for f in (module.stiffness, module.contact_radius)}
results["force"] = static(delta).tolist()
results["impact"] = list(module.impact()) if hasattr(module, "impact") else None
foreign = {"generated", "derivation", "scipy", "sympy"} & set(sys.modules)
assert not foreign, foreign
print(json.dumps(results))
"""

COMMAND = """
import sys
from derivation.cli import main
assert main(sys.argv[1:]) == 0
assert not {"sympy", "flint", "mpmath", "scipy"} & set(sys.modules)
"""


@cache
def scene_of(case: str) -> Any:
    """Return a scene with a quasi-static plate."""
    if case in RANDOM:
        number, rtol = RANDOM[case]
        data = random_scene(number) | {"accuracy": {"rtol": rtol}}
    elif case in VISCOUS:
        data = PAD | {t: PAD.get(t, {}) | keys for t, keys in VISCOUS[case].items()}
    else:
        data = load(EXAMPLES / f"{case}.toml").to_json()
    still = AT_REST | ({"plasticity": False} if case == "ball_drop" else {})
    return read(data | {"effects": data.get("effects", {}) | still})


@cache
def recipe_of(case: str) -> Recipe:
    return recipe(scene_of(case))


@cache
def code_of(case: str) -> str:
    return scene_code(scene_of(case))


@cache
def names_of(case: str) -> dict[str, Any]:
    names: dict[str, Any] = {"__name__": "alone"}
    exec(compile(code_of(case), "alone.py", "exec"), names)
    return names


def static_of(case: str) -> Callable[..., Any]:
    """Return the function of the relaxed (elastic) force."""
    names = names_of(case)
    return names.get("elastic_force", names["force"])


def radii(case: str) -> np.ndarray:
    """Return contact radii up to the largest one of the code."""
    fractions = np.concatenate((np.geomspace(1e-5, 1e-2, 20), np.linspace(0.02, 1.0, 50)))
    return fractions * names_of(case)["LIMIT"]


@pytest.mark.parametrize("case", CASES)
def test_code_reproduces_law_and_impact_with_only_numpy(case: str, tmp_path: Path) -> None:
    place = tmp_path / "alone.py"
    place.write_text(code_of(case))
    result = simulate(scene_of(case))
    law, a = result.effects.law, radii(case)
    shape = law.at(a)
    delta = np.minimum(law.indentation(a, shape), names_of(case)["MAX_INDENTATION"])
    run = subprocess.run(
        [sys.executable, "-I", "-c", ALONE, str(place)],
        input=json.dumps({"delta": delta.tolist()}), cwd=tmp_path,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    results = json.loads(run.stdout)
    np.testing.assert_allclose(results["force"], law.force(a, shape), rtol=1e-13)
    np.testing.assert_allclose(results["contact_radius"], a, rtol=1e-12)
    # Near the limit the law's stiffness (non-Hertzian pressure) is less accurate.
    mild = a < 0.9 * law.limit
    np.testing.assert_allclose(
        np.array(results["stiffness"])[mild], law.stiffness(a, shape)[mild], rtol=2e-11
    )
    if results["impact"] is None:
        assert case == "viscous, stiff"
        return
    assert results["impact"] == pytest.approx(list(moved(law).numbers), rel=3e-12, abs=1e-12)
    names = ("contact_time", "max_indentation", "max_force", "max_contact_radius")
    numbers = [f"{getattr(result, name):.6g}" for name in names]
    assert [f"{x:.6g}" for x in results["impact"][:4]] == numbers


def test_code_with_every_effect_agrees_with_indent() -> None:
    scene = read(changed(effects={"spherical_profile": True, "non_hertzian_pressure": True}))
    names: dict[str, Any] = {}
    exec(scene_code(scene), names)
    delta = np.geomspace(1e-5, 0.6, 12) * names["MAX_INDENTATION"]
    rows = indent(scene, indentation=delta.tolist())
    assert names["force"](delta) == pytest.approx([row.force for row in rows], rel=1e-11)
    assert names["stiffness"](delta) == pytest.approx([row.stiffness for row in rows], rel=1e-10)


@pytest.mark.parametrize("case", CASES)
def test_stiffness_is_the_derivative_of_the_force(case: str) -> None:
    names, force = names_of(case), static_of(case)
    delta = np.geomspace(1e-6, 0.99, 40) * names["MAX_INDENTATION"]
    step = 1e-3 * delta
    # Extrapolate central differences with three steps.
    once, twice, thrice = (
        (force(delta + n * step) - force(delta - n * step)) / (2 * n * step) for n in (1, 2, 3)
    )
    slope = 1.5 * once - 0.6 * twice + 0.1 * thrice
    np.testing.assert_allclose(names["stiffness"](delta), slope, rtol=1e-9)


@pytest.mark.parametrize("case", ["block", "impact_echo", "paper", "soft_layer", "viscous, bent"])
def test_code_accepts_arrays_and_does_not_change_them(case: str) -> None:
    names, force = names_of(case), static_of(case)
    end = names["MAX_INDENTATION"]
    for function in (force, names["stiffness"], names["contact_radius"]):
        delta = np.array([[-1.0, 0.0, 0.5 * end], [end, np.nan, -np.inf]])
        delta.flags.writeable = False
        actual = function(delta)
        assert actual.shape == (2, 3)
        assert np.isfinite(actual).ravel().tolist() == [True, True, True, True, False, True]
        assert actual[0, 0] == actual[0, 1] == actual[1, 2] == 0.0
        assert 0.0 < actual[0, 2] < actual[1, 0] or function is names["stiffness"]
        single = function(0.5 * end)
        assert np.shape(single) == ()
        assert single == actual[0, 2] == function(np.array(0.5 * end))
        assert function(np.empty(0)).shape == (0,)
        assert function([0, -1]).tolist() == [0.0, 0.0]
        beyond = [np.nextafter(end, np.inf), 2.0 * end, np.inf]
        assert np.isnan(function(beyond)).all()
        assert function(np.float32(-1.0)) == 0.0


@pytest.mark.parametrize("case", [c for c in CASES if c != "viscous, stiff"])
@pytest.mark.parametrize("factor", [0.05, 0.5, 1.3])
def test_code_computes_impacts_at_other_speeds(case: str, factor: float) -> None:
    made = recipe_of(case)
    model = replace(made.law.model, v0=factor * made.law.model.v0)
    reference = None
    with suppress(SceneError):  # a slow sphere may stay on a viscous plate
        reference = moved(ContactLaw(model, made.law.effects))
    if reference is None or reference.max_contact_radius > names_of(case)["LIMIT"]:
        assert math.isnan(names_of(case)["impact"](model.v0).max_force)
        return
    actual = names_of(case)["impact"](model.v0)
    assert list(actual) == pytest.approx(list(reference.numbers), rel=1e-11, abs=1e-11)


@pytest.mark.parametrize("case", ["block", "paper", "glass_pane", "viscous", "viscous, bent"])
@pytest.mark.parametrize("v0", [0.0, -1.0, math.nan, math.inf, 1e9])
def test_impact_is_nan_outside_the_range(case: str, v0: float) -> None:
    with np.errstate(all="ignore"):
        assert np.isnan(names_of(case)["impact"](v0)).all()


def test_viscoelastic_force_depends_on_indentation_and_rate() -> None:
    case = "viscous, heavy"
    names, law = names_of(case), recipe_of(case).law
    a = radii(case)[30]
    shape = law.at(np.array([a]))
    delta, P, k = (
        float(f(np.array([a]), shape)[0]) for f in (law.indentation, law.force, law.stiffness)
    )
    lag = law.model.retardation_time
    rate = np.array([-1e9, -0.1, 0.0, 0.1])
    forces = names["force"](delta, rate)
    assert forces == pytest.approx([0.0, *(P + lag * k * rate[1:])], rel=1e-12)
    assert names["force"](-delta, 1.0) == 0.0
    assert names["force"](delta) == pytest.approx(P, rel=1e-13)
    assert names["force"](np.full((2, 1), delta), rate).shape == (2, 4)
    assert np.isnan(names["force"](1e9, 0.0))

    result = simulate(scene_of(case))

    def rates(_: float, state: np.ndarray) -> list[float]:
        return [state[1], law.gravity - float(names["force"](*state)) / law.model.m]

    def pull(t: float, state: np.ndarray) -> float:
        elastic, stiffness = names["elastic_force"](state[0]), names["stiffness"](state[0])
        return float(elastic + lag * stiffness * state[1]) if t > 0.1 * result.contact_time else 1.0

    pull.terminal = True  # type: ignore[attr-defined]
    span = (0.0, 2.0 * result.contact_time)
    history = solve_ivp(rates, span, [0.0, law.model.v0], events=pull, rtol=1e-9, atol=1e-13)
    assert history.t[-1] == pytest.approx(result.contact_time, rel=1e-6)
    assert -history.y[1, -1] / law.model.v0 == pytest.approx(result.restitution, rel=1e-6)


@pytest.mark.parametrize("case", ["viscous, bent", "viscous, stiff"])
def test_integration_with_the_inner_state_gives_the_impact(case: str) -> None:
    names, made = names_of(case), recipe_of(case)
    model, T = made.law.model, made.motion.contact_time

    def rates(_: float, state: np.ndarray) -> list[float]:
        delta, v, elastic = state
        elastic = max(elastic, 1e-30)
        return [v, -float(names["force"](delta, elastic)) / model.m,
                float(names["elastic_rate"](delta, elastic))]  # fmt: skip

    def pull(t: float, state: np.ndarray) -> float:
        lag = (state[0] - state[2]) / names["COMPLIANCE"]
        return float(names["elastic_force"](state[2]) + lag) if t > 0.1 * T else 1.0

    pull.terminal = True  # type: ignore[attr-defined]
    start = 1e-9 * T
    history = solve_ivp(
        rates, (start, 2.0 * T), [model.v0 * start, model.v0, 0.5 * model.v0 * start],
        method="Radau", events=pull, rtol=1e-8, atol=[1e-14, 1e-9, 1e-14],
    )  # fmt: skip
    assert history.t[-1] == pytest.approx(T, rel=1e-5)
    assert -history.y[1, -1] / model.v0 == pytest.approx(made.motion.restitution, rel=1e-5)
    assert np.isnan(names["elastic_rate"](1.0, 0.0))
    assert names["force"](1.0, -1.0) == 0.0


def test_supported_plate_with_viscoelastic_contact_is_rejected() -> None:
    plate = PAD["plate"] | {"thickness": 0.02, "edge": "clamped"}
    held = read({**PAD, "plate": plate, "effects": dict(AT_REST)})
    with pytest.raises(SceneError, match=r"^plate\.edge: .*effects\.edge"):
        scene_code(held)


@pytest.mark.parametrize("wanted", ["auto", True])
def test_plate_with_inertia_is_rejected(wanted: Any) -> None:
    data = load(EXAMPLES / "glass_pane.toml").to_json() | {"effects": {"inertia": wanted}}
    with pytest.raises(SceneError, match=r"^effects\.inertia: .*effects\.inertia = false$"):
        scene_code(read(data))


MARKS = {
    "bending": {"BEND", "COMPLIANCE", "GROWTH", "_polynomial"},
    "gravity": {"GRAVITY"},
    "viscosity": {"RETARDATION_TIME", "elastic_force", "elastic_rate", "_extrapolated"},
    "spherical_profile": {"FORCE"},
}
"""Names in the code that occur only if an effect needs them."""


@pytest.mark.parametrize("case", CASES)
def test_code_contains_no_omitted_effects(case: str) -> None:
    tree = ast.parse(code_of(case))
    actual = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    actual |= {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}
    effects = recipe_of(case).law.effects
    also = {
        "spherical_profile": {"non_hertzian_pressure"},
        "bending": effects - {"hertz", "gravity", "viscosity"},
    }
    for effect, marks in MARKS.items():
        if not effects & ({effect} | also.get(effect, set()) - {"sphere_elasticity"}):
            assert not actual & marks, effect
    defined = {node.name for node in tree.body if isinstance(node, ast.FunctionDef | ast.ClassDef)}
    private = {name for name in defined if name.startswith("_")}
    assert private <= {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}


def test_code_of_hertz_theory_is_short() -> None:
    tree = ast.parse(code_of("block"))
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
    assert sum(len(function.body) - 1 for function in functions) <= 12
    assert not any(isinstance(node, ast.For | ast.While) for node in ast.walk(tree))


def test_header_states_the_effects_with_reasons() -> None:
    text = code_of("glass_pane")
    head = ast.get_docstring(ast.parse(text)) or ""
    selected = simulate(scene_of("glass_pane")).effects
    inside, out = head.split("Omitted effects:")
    for row in selected.rows:
        assert f"- {row.name}:" in (inside if row.included else out)
    stated = re.search(r"at most (\S+) \(tolerance 0\.001\)", " ".join(head.split()))
    assert stated
    assert selected.error <= float(stated[1]) < 1.1 * selected.error
    assert 'material = "glass"' in head
    notes = simulate(scene_of("glass_pane")).warnings
    assert any("inertia is neglected" in text for text in notes)
    assert all("".join(text.split()) in "".join(head.split()) for text in notes)
    assert str(ROOT) not in text


@pytest.mark.checkout
@pytest.mark.parametrize("case", CASES)
def test_code_is_formatted_by_ruff(case: str, tmp_path: Path) -> None:
    place = tmp_path / "alone.py"
    place.write_text(code_of(case))
    for task in (["check", "--config", str(ROOT / "pyproject.toml")],
                 ["format", "--check", "--isolated", "--line-length", "100"]):  # fmt: skip
        run = subprocess.run(
            [sys.executable, "-m", "ruff", *task, str(place)],
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert run.returncode == 0, run.stdout + run.stderr


def test_command_writes_the_same_file_without_sympy(tmp_path: Path) -> None:
    for name in ("one.py", "two.py"):
        subprocess.run(
            [sys.executable, "-c", COMMAND, "generate", "--scene", str(PAPER), "--out", name],
            cwd=tmp_path, env={"PYTHONPATH": str(ROOT), "PATH": ""}, check=True,
        )  # fmt: skip
    assert (tmp_path / "one.py").read_bytes() == (tmp_path / "two.py").read_bytes()
    assert (tmp_path / "one.py").read_text() == code_of("paper")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["one.py", "two.py"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["absent.toml", "--out", "x.py"], "absent.toml: cannot read the scene file"),
        (["fast.toml", "--out", "x.py"], "impact.speed: expected less than"),
        (["scene.toml"], "--out: expected a file"),
        (["scene.toml", "--out", "x.txt"], "--out: "),
        (["scene.toml", "--out", "."], "got a folder"),
        (["scene.toml", "--out", "scene.toml"], "scene.toml: "),
        (["scene.toml", "--out", "x.py", "--check"], "--check"),
        (["scene.toml", "--out", "/proc/nowhere/x.py"], "/proc/nowhere"),
    ],
)
def test_invalid_input_gives_one_message_and_writes_no_file(
    arguments: list[str],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("scene.toml").write_text(PAPER.read_text())
    Path("fast.toml").write_text(PAPER.read_text().replace("speed = 1.0", "speed = 1e9"))
    Path("x.py").write_text("kept")
    before = {path: path.read_bytes() for path in Path().iterdir()}
    assert main(["generate", "--scene", *arguments]) == 2
    shown = capsys.readouterr().err
    assert message in shown
    assert shown.startswith("platecontact: ")
    assert {path: path.read_bytes() for path in Path().iterdir()} == before
