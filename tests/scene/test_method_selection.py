"""Selection of a method by tolerance: bounds, switches, monotonicity and messages."""

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shared_scenes import PAPER

from derivation.checks import bounds
from derivation.cli import main
from derivation.plate import budgets
from derivation.plate.benchmark.speed import scenes
from derivation.scene import SceneError, kernels, load, quantity, read, simulate
from derivation.scene.model import Model, model_of
from derivation.scene.selection import method_selection
from derivation.scene.selection.achieved_accuracy import METHODS
from generated import simple_impact
from generated import simple_impact_numbers as numbers
from generated.impact import impact
from generated.sensitivity import impact_sensitivities

TOLERANCES = [10.0**-n for n in range(13)] + [1e-13, 9e-9, 3e-4]
COST = {name: rank for rank, name in enumerate(METHODS)}
Captured = pytest.CaptureFixture[str]


def paper(**changes: float) -> Model:
    values = {**vars(model_of(load(PAPER))), **changes}
    return Model(**values)


# --- bounds


def test_bounds_hold_in_a_hundred_scenes() -> None:
    known = bounds.committed_references()
    assert len(known) >= 100
    chosen = known[:: len(known) // 100][:100]
    rows = bounds.judge(chosen)
    assert {row.method for row in rows} == set(METHODS)
    assert [row for row in rows if not row.passed] == []
    assert {row.method: row.ratio > 0.1 for row in rows}["leading"]  # the bound is tight


def test_recorded_rows_follow_from_the_recorded_references() -> None:
    data = json.loads(bounds.MEASURED.read_text())
    assert sum(row["runs"] for row in data["rows"]) == len(data["references"]) * len(
        bounds.TOLERANCES
    )
    assert all(row["ratio"] <= 1 for row in data["rows"])


def test_recorded_references_belong_to_the_random_scenes() -> None:
    known = bounds.committed_references()
    for number in (0, 1, 17, len(known) - 1):
        np.testing.assert_allclose(bounds.scene(number), known[number].point, rtol=1e-12)


def test_violated_bound_is_detected(monkeypatch: pytest.MonkeyPatch) -> None:
    [reference] = bounds.committed_references()[:1]
    exact = [float(text) for text in reference.values]
    off = [exact[0], exact[1], 1.01 * exact[2], exact[3]]
    monkeypatch.setattr(bounds, "simulated", lambda _, rtol: (off, "hertz", rtol / 2))
    [row] = bounds.judge([reference], [1e-3])
    assert (row.passed, row.quantity) == (False, "max_force")
    assert row.ratio == pytest.approx(20, rel=1e-3)
    monkeypatch.setattr(bounds, "simulated", lambda _, rtol: ([math.nan] * 4, "hertz", rtol))
    [row] = bounds.judge([reference], [1e-3])
    assert not row.passed
    monkeypatch.setattr(bounds, "simulated", lambda *_: (exact, "hertz", 2e-3))
    with pytest.raises(ValueError, match="states"):
        bounds.judge([reference], [1e-3])


def test_error_is_at_least_the_uncertainty_of_the_reference() -> None:
    """The error of a result includes the uncertainty of the reference value."""
    reference = bounds.SceneReference((), ("1", "1"))
    exact, off = bounds.errors((1.0, 1.0 + 2.0**-52), reference)
    assert exact >= 10.0**-bounds.DIGITS
    assert off >= 2.0**-52 + 10.0**-bounds.DIGITS
    assert exact < 1.001 * 10.0**-bounds.DIGITS


def test_references_are_computed_once(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    computed: list[bounds.Point] = []

    def oracle(point: bounds.Point) -> bounds.SceneReference:
        computed.append(point)
        return bounds.SceneReference(point, ("1", "1", "1", "1"))

    monkeypatch.setattr(bounds, "reference", oracle)
    first = list(bounds.reference_values(3))
    monkeypatch.setattr(bounds, "MEASURED", tmp_path / "bounds.json")
    bounds.MEASURED.write_text(bounds.to_json(first, ()))
    again = bounds.committed_references()
    assert list(bounds.reference_values(4, again))[:3] == first == again
    assert computed == [bounds.scene(number) for number in range(4)]


@pytest.mark.one_version
@pytest.mark.parametrize("eta", [1e-3, 0.1, 0.1666, 0.1667, 0.3, 0.53, 0.6, 1.0, 4.0, 50.0])
def test_slope_of_the_law_is_within_its_bounds(eta: float) -> None:
    from derivation.plate.contact.oracle import balls as contact_balls

    plate = simple_impact.plate_of(eta)
    c_1 = float(contact_balls.coefficient(1, eta, 1.0, 20))
    assert abs(c_1 - plate.bend) <= plate.bend_error + 1e-15 * abs(c_1)
    for a in (1e-4, 0.1, 0.5, 0.97):
        A = min(a, 5.9 * eta) / eta
        S = float(contact_balls.slope(A * eta, 1.0, eta, 1.0, 20)) / (2 * A * eta)
        most = 1 + 1.5 * plate.bend * A
        assert most - plate.rest * A**3 - 1.5 * plate.bend_error * A <= S * (1 + 1e-12)
        assert most + 1.5 * plate.bend_error * A >= S * (1 - 1e-12)


@pytest.mark.parametrize("factor", [0.93, 0.99, 1.01, 1.5])
def test_lemma_holds_for_a_multiple_of_the_law(factor: float) -> None:
    """If the slope is c times Hertz's, each result changes by a known power of c."""
    low, up = max(0.0, 1 - factor), max(0.0, factor - 1)
    bound = simple_impact.law_error(low, up, 0.0, 0.0)
    for power in (-1 / 5, -3 / 5, 3 / 5, 3 / 5):
        assert abs(factor**-power - 1) <= bound


def test_exponents_of_the_lemma_agree_with_the_theory() -> None:
    import sympy as sp

    from derivation.plate.impact.theory.substitution import exponents

    loss, fall, rise = 1e-9, 0.25, 0.5
    actual = {name: float(x) for name, x in exponents(sp.Float(fall), sp.Float(rise)).items()}
    wider = loss / actual["energy"]
    changes = 3 * wider, actual["depth"] * wider, loss, loss + actual["shorter"] * wider
    assert simple_impact.law_error(loss, 0.0, fall, rise) == pytest.approx(max(changes), rel=1e-6)


def test_no_bound_is_stated_where_none_is_proved() -> None:
    assert simple_impact.law_error(1.0, 0.0, 0.0, 0.0) == math.inf
    assert simple_impact.law_error(0.1, 0.0, 0.0, 0.0) == math.inf  # radius error above 2 %
    assert simple_impact.law_error(math.nan, 0.0, 0.0, 0.0) == math.inf
    run: Callable[..., Any]
    for run in (simple_impact.hertz, simple_impact.leading):
        for changes in ({"v0": 1e4}, {"v0": 1e-120}, {"m": 1e200}, {"h": 1e-60}, {"R": 1e-3}):
            assert run(*paper(**changes).numbers) is None


@pytest.mark.parametrize("x", [-0.499, -0.1, 1e-9, 1.0, 1e3, 1e10])
def test_quadrature_of_the_first_correction_is_accurate(x: float) -> None:
    """The quadrature for S_1 = 1 + x q agrees with that of more nodes."""
    u, weights = np.polynomial.legendre.leggauss(60)
    q = 1 - ((1 + u) / 2) ** 2
    fifth = 1 + q * (1 + q * (1 + q * (1 + q)))
    root = np.sqrt((6 + 5 * x) / (6 * fifth + 5 * x * (1 + q * fifth)))
    fine = float(4 * np.sum(weights * q * (1 + x * q) * root))
    ours = sum(
        weight * (1 + x * q) * math.sqrt((6 + 5 * x) / (fifth + x * sixth))
        for q, fifth, sixth, weight in numbers.RULE
    )
    assert ours == pytest.approx(fine, rel=1e-13)


def test_measured_rounding_covers_the_budget_with_its_conditioning() -> None:
    """The rounding bound covers the budget of `impact` and half the sum of condition numbers."""
    points = np.array([reference.point for reference in bounds.committed_references()])
    slopes = impact_sensitivities(*points.T)
    ulp = budgets.read_budgets()["impact"].ulp + 0.5 * np.abs(slopes).sum(axis=1)
    assert np.isfinite(ulp).all()
    for method in ("coarse", "full"):
        assert ulp.max() * 2.0**-52 < method_selection.whole_law(method, None).rounding.bound


def test_error_of_half_the_nodes_is_a_fifth_of_its_limit() -> None:
    """Half the nodes use a fifth of the stated limit at most, also for thin plates."""
    arguments = scenes(0.01, 5.9, 5000)
    coarse, full = (impact(**arguments, coarse=flag).contact_time for flag in (True, False))
    assert np.nanmax(np.abs(coarse / full - 1)) < kernels.COARSE_QUADRATURE / 5


# --- selection


def methods(model: Model) -> list[str]:
    return [method_selection.solve(model, rtol)[1].method for rtol in sorted(TOLERANCES)]


def test_smaller_tolerance_selects_no_faster_method() -> None:
    models = [Model(*reference.point) for reference in bounds.committed_references()[:40]]
    for model in [paper(), *models]:
        ranks = [COST[name] for name in methods(model)]
        assert ranks == sorted(ranks, reverse=True)


def test_bound_is_within_the_tolerance_down_to_the_smallest() -> None:
    for rtol in TOLERANCES:
        solution = method_selection.solve(paper(), rtol)[1]
        assert 0 < solution.bound <= rtol
        assert solution.rtol == rtol
    assert method_selection.solve(paper(), 1e-13)[1].method == "full"


@pytest.mark.parametrize("v0", [1e-9, 1e-5, 1e-3, 0.1, 1.0])
def test_method_changes_at_its_bound(v0: float) -> None:
    model = paper(v0=v0)
    stated = {"coarse": method_selection.whole_law("coarse", None).bound}
    for method in ("hertz", "leading"):
        actual = getattr(simple_impact, method)(*model.numbers)
        stated[method] = method_selection.estimated(method, actual, None).bound
    for method, bound in stated.items():
        above, below = (
            method_selection.solve(model, bound * side) for side in (1 + 1e-9, 1 - 1e-9)
        )
        assert COST[above[1].method] <= COST[method]
        assert COST[below[1].method] >= COST[above[1].method]
        assert below[1].method != method
        for one, other in zip(above[0], below[0], strict=True):
            assert one == pytest.approx(other, rel=above[1].bound + below[1].bound)


def test_example_of_the_paper_uses_each_method() -> None:
    slow = paper(v0=1e-4)
    assert list(dict.fromkeys(reversed(methods(slow)))) == ["hertz", "leading", "coarse", "full"]
    assert "hertz" not in methods(paper())


# --- messages


def test_full_method_is_used_without_a_tolerance() -> None:
    result = simulate(load(PAPER))
    assert (result.accuracy.method, result.accuracy.rtol) == ("full", None)
    assert result.accuracy.bound < 1e-13
    outcome = kernels.impact(*result.model.numbers)
    assert result.contact_time == outcome.contact_time
    assert result.max_force == outcome.max_force


def test_argument_overrides_the_tolerance_of_the_scene() -> None:
    data = load(PAPER).to_json() | {"accuracy": {"rtol": 1e-3}}
    scene = read(data)
    assert scene.to_json()["accuracy"] == {"rtol": 1e-3}
    assert simulate(scene).accuracy.method == "leading"
    assert simulate(scene, rtol=1e-12).accuracy.method == "full"


@pytest.mark.parametrize(
    ("rtol", "is_too_small"),
    [
        (9e-14, True),
        (0.0, True),
        *((x, False) for x in (-1e-3, 1.1, math.nan, math.inf, True, "1e-3")),
    ],
)
def test_unattainable_tolerance_is_rejected_with_one_message(rtol: Any, is_too_small: bool) -> None:
    """Only one that is too small asks for more digits than double precision has."""
    with pytest.raises(SceneError) as caught:
        simulate(load(PAPER), rtol=rtol)
    digits = "platecontact reference SCENE.toml --digits N"
    assert (digits in str(caught.value)) is is_too_small
    with pytest.raises(SceneError) as caught:
        read(load(PAPER).to_json() | {"accuracy": {"rtol": rtol}})
    message = str(caught.value)
    assert "accuracy.rtol: " in message
    assert (digits in message) is is_too_small
    assert "\n" not in message


def test_excessive_speed_is_rejected_at_every_tolerance() -> None:
    fast = read(load(PAPER).to_json() | {"impact": {"speed": 1e9}})
    for rtol in (None, 1e-2, 1e-13):
        with pytest.raises(SceneError, match=r"impact\.speed: "):
            simulate(fast, rtol=rtol)


def test_every_output_states_method_and_bound(tmp_path: Path, capsys: Captured) -> None:
    wanted = ["simulate", str(PAPER), "--rtol", "1e-3", "--json", f"{tmp_path}/r.json"]
    assert main([*wanted, "--details"]) == 0
    output = " ".join(capsys.readouterr().out.split())
    data = json.loads((tmp_path / "r.json").read_text())["accuracy"]
    assert data["method"] == "leading"
    assert data["rtol"] == 1e-3
    assert data["bound"] <= 1e-3
    assert {name: part["basis"] for name, part in data["parts"].items()} == {
        "effects": "proved", "law": "proved", "quadrature": "proved",
        "rounding": "rounding_analysis",
    }  # fmt: skip
    result = simulate(load(PAPER), rtol=1e-3)
    assert str(result.accuracy) in output
    assert str(result.accuracy).replace("'", "&#x27;") in result._repr_html_()
    for words in (
        "Method: leading",
        "relative error at most",
        "law",
        "(proved)",
        "rounding analysis",
    ):
        assert words in output
    full = simulate(load(PAPER)).accuracy.to_json()["parts"]
    assert full["quadrature"]["basis"] == full["rounding"]["basis"] == "tested"


@pytest.mark.parametrize(
    ("bound", "printed"),
    [
        (2.53e-4, "2.6e-04"), (9.99e-9, "1.0e-08"), (1e-13, "1.0e-13"), (5.0001e-14, "5.1e-14"),
        (0.95, "9.5e-01"), (8.101e-3, "8.2e-03"), (0.0, "0.0e+00"), (math.inf, "inf"),
    ],
)  # fmt: skip
def test_printed_bound_is_rounded_up(bound: float, printed: str) -> None:
    assert quantity.rounded_up(bound) == printed


def test_history_uses_the_full_method() -> None:
    result = simulate(load(PAPER), rtol=1e-3)
    assert result.accuracy.method != "full"
    history = result.history(51)
    assert history.velocity[-1] == pytest.approx(-1, rel=1e-9)
    np.testing.assert_array_equal(history, simulate(load(PAPER)).history(51))


def test_command_check_error_bounds(capsys: Captured, monkeypatch: pytest.MonkeyPatch) -> None:
    assert main(["check", "error-bounds", "-n", "3", "--json", "-"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert sum(row["runs"] for row in rows) == 3 * len(bounds.TOLERANCES)
    monkeypatch.setattr(bounds, "simulated", lambda _, rtol: ([1.0] * 4, "hertz", rtol))
    assert main(["check", "error-bounds", "-n", "1"]) == 1
