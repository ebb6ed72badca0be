"""Test the search for larger errors: repeatable, finds a planted defect, writes valid cases."""

import dataclasses
import json
import math
import random
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from interrupted import interrupted

from derivation.cli import main
from derivation.engine.files import ROOT
from derivation.engine.measure.case import HardCase, read_cases
from derivation.engine.measure.point import Point
from derivation.engine.measure.search import Search, search
from derivation.engine.measure.search_record import (
    SearchRecord,
    all_within_allowance,
    as_data,
    case_of,
    measured_case,
    read,
    recorded,
    seconds_of,
    to_toml,
)
from derivation.engine.measure.target import Target
from derivation.plate.judge import generated_kernels
from derivation.plate.search.draw import domain_of
from derivation.plate.search.targets import closed_target, targets

NOWHERE = Path("/nonexistent")
FAST = ("p", "sonine", "delta", "bessel_j0", "bessel_j1", "bessel_j0_zeros")


@pytest.fixture(scope="module")
def fast() -> tuple[Target, ...]:
    return targets(FAST)


@pytest.fixture(scope="module")
def planted() -> Target:
    """Return the target J0 with an added error of 20 ULP for 1 < x < 1.001."""
    kernel = next(k for k in generated_kernels() if k.name == "bessel_j0")

    def wrong(x: Any) -> Any:
        value = kernel.call(x)
        inside = (np.asarray(x) > 1) & (np.asarray(x) < 1.001)
        return np.where(inside, value + 20 * np.spacing(value), value)

    domain = domain_of("bessel_j0", ("x",), False, ())
    return closed_target(domain, dataclasses.replace(kernel, call=wrong))


@pytest.fixture(scope="module")
def caught(planted: Target) -> Search:
    return search([planted], seed=10, evaluations=3000)


def test_search_is_reproducible(fast: tuple[Target, ...]) -> None:
    one, two = (search(fast, seed=7, evaluations=800) for _ in range(2))
    assert one.evaluations == 800
    assert as_data(one) == as_data(two)
    assert all(state.worst is not None for state in one.states.values())
    assert as_data(search(fast, seed=8, evaluations=800))["rows"] != as_data(one)["rows"]


def test_search_of_a_single_function_takes_the_same_steps(fast: tuple[Target, ...]) -> None:
    together = search(fast, seed=3, evaluations=500).states["sonine"]
    alone = search(targets(["sonine"]), seed=3, evaluations=together.evaluations)
    assert alone.states["sonine"] == together


def test_every_function_is_searched(fast: tuple[Target, ...]) -> None:
    search_result = search(fast, seed=1, evaluations=sum(t.turn_size for t in fast))
    assert [s.evaluations for s in search_result.states.values()] == [t.turn_size for t in fast]


def test_search_ends_at_its_time_limit(fast: tuple[Target, ...]) -> None:
    assert search(fast, seed=1, seconds=0.0).evaluations == 0
    with pytest.raises(ValueError, match="no end"):
        search(fast, seed=1)


def test_random_points_are_inside_the_domain() -> None:
    generator = random.Random(1)
    for target in targets():
        if target.name in ("contact_radius", "impact"):  # their arguments need the reference
            continue
        for _ in range(20):
            point = target.draw(target.domain, generator)
            assert target.domain.holds(point)
            assert tuple(point.values) == target.domain.arguments
            assert (point.modes is not None) == target.domain.modes


def test_known_defect_is_found_and_refined(caught: Search) -> None:
    state = caught.states["bessel_j0"]
    assert state.evaluations == 3000
    assert state.worst is not None
    assert 1.0 < state.worst.point.values["x"] < 1.001
    # The local search also adds the error of the function to the planted 20 ULP.
    assert state.worst.error.ulp > 20.5
    assert not all_within_allowance(caught)


def test_written_case_reproduces_the_error(caught: Search, planted: Target, tmp_path: Path) -> None:
    path = tmp_path / "cases.toml"
    book = SearchRecord(path, [planted], {}, {})
    book.keep(caught)
    [case] = read(path)
    assert (case.kernel, case.group) == ("bessel_j0", "search")
    assert "seed 10" in case.cause
    assert measured_case(case, {"bessel_j0": planted}) == caught.states["bessel_j0"].worst
    again = SearchRecord(path, [planted], {}, {})
    assert not again.is_new("bessel_j0", caught.states["bessel_j0"].worst)
    before = path.read_text()
    again.keep(caught)
    assert path.read_text() == before


def test_only_larger_errors_are_new_cases(caught: Search, planted: Target) -> None:
    known = ROOT / "reports" / "data" / "check.json"
    worst = caught.states["bessel_j0"].worst
    assert worst is not None
    book = SearchRecord(NOWHERE, [planted], *recorded(known, NOWHERE))
    assert book.is_new("bessel_j0", worst)
    row = next(r for r in json.loads(known.read_text())["rows"] if r["kernel"] == "bessel_j0")
    smaller = dataclasses.replace(worst.error, ulp=0.99 * row["double"]["ratio"], allowed=1.0)
    assert not book.is_new("bessel_j0", dataclasses.replace(worst, error=smaller))


def test_case_with_an_array_of_two_points(fast: tuple[Target, ...], tmp_path: Path) -> None:
    """The case of a function that is wrong only for arrays contains both points, as an array."""
    kernel = next(k for k in generated_kernels() if k.name == "bessel_j1")

    def wrong(*arguments: Any) -> Any:
        value = kernel.call(*arguments)
        return value * 2.0 if np.size(value) == 2 else value

    domain = next(t.domain for t in fast if t.name == "bessel_j1")
    target = closed_target(domain, dataclasses.replace(kernel, call=wrong))
    target = dataclasses.replace(target, bound=None)
    worst = search([target], 1, evaluations=20).states["bessel_j1"].worst
    assert worst is not None
    assert worst.second is not None
    case = case_of("bessel_j1", worst, 1)
    assert case.form == "array"
    path = tmp_path / "cases.toml"
    path.write_text(to_toml([(case, worst)]))
    (read_back,) = read_cases(path)
    assert read_back == case
    assert measured_case(read_back, {"bessel_j1": target}) == worst


def test_result_that_is_not_finite_is_the_largest_error(planted: Target, tmp_path: Path) -> None:
    broken = dataclasses.replace(planted, call=lambda points: [(math.nan,)] * len(points))
    search_result = search([broken], 1, evaluations=10)
    assert search_result.states["bessel_j0"].ratio == math.inf
    assert as_data(search_result)["rows"][0]["ratio"] == "inf"
    json.dumps(as_data(search_result), allow_nan=False)
    SearchRecord(tmp_path / "x.toml", [broken], {}, {}).keep(search_result)
    assert read(tmp_path / "x.toml")


def test_steps_are_floats_or_integers() -> None:
    point = Point({"phi": 1.0, "n": 5.0})
    real, whole = domain_of("G", ("phi",), False, ()), domain_of("kappa", ("n",), False, ())
    assert real.moved(point, "phi", 1).values["phi"] == math.nextafter(1.0, 2.0)
    assert real.moved(point, "phi", -(2**52)).values["phi"] == 0.5
    assert whole.moved(point, "n", -3).values["n"] == 2.0


def test_durations_are_read_in_seconds() -> None:
    assert [seconds_of(text) for text in ("30s", "5m", "1h")] == [30, 300, 3600]
    for text in ("", "5", "0s", "-5s", "1.5h", "5 m", "5d", "m", "1h30m", "99999999s", "\uff15s"):
        with pytest.raises(ValueError, match="30s, 5m or 1h"):
            seconds_of(text)


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["search", "--time", "soon"], "30s, 5m or 1h"),
        (["search", "--function", "bessel_j11"], "did you mean bessel_j1"),
        (["search", "--function", "G", "--out", str(ROOT / "pyproject.toml")], "--out"),
    ],
)
def test_invalid_input_is_rejected(
    arguments: list[str], expected: str, capsys: pytest.CaptureFixture[str]
) -> None:
    before = (ROOT / "pyproject.toml").read_bytes()
    assert main(["check", *arguments]) == 2
    assert expected in capsys.readouterr().err
    assert (ROOT / "pyproject.toml").read_bytes() == before


def test_case_with_other_arguments_is_rejected(fast: Sequence[Target], tmp_path: Path) -> None:
    path = tmp_path / "cases.toml"
    case = HardCase("search", "p", "By hand.", {"x": ("0x1p+0",)})
    path.write_text(to_toml([(case, None)]))
    with pytest.raises(ValueError, match="p takes r, a, P"):
        SearchRecord(path, fast, {}, {})
    path.write_text(to_toml([(dataclasses.replace(case, group="seams"), None)]))
    with pytest.raises(ValueError, match="--out FILE"):  # a file written by the user
        SearchRecord(path, fast, {}, {})


def test_command_lists_the_chosen_functions(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, data = tmp_path / "cases.toml", tmp_path / "found.json"
    chosen = [
        "--function",
        "kappa_ratio",
        "--function",
        "bessel_j1",
        "--out",
        str(path),
        "--json",
        str(data),
    ]
    status = main(["check", "search", "--time", "1s", "--seed", "5", *chosen])
    actual = json.loads(data.read_text())
    shown = capsys.readouterr().out
    assert [row["kernel"] for row in actual["rows"]] == ["bessel_j1", "kappa_ratio"]
    assert status == int(any(float(row["ratio"] or 0) > 1 for row in actual["rows"]))
    assert actual["seed"] == 5
    exact = actual["rows"][0]["inputs"]["x"]
    assert f"bessel_j1: x={float.fromhex(exact)!r} ({exact})\n" in shown


def test_interrupted_search_keeps_its_cases(tmp_path: Path) -> None:
    program = """
import dataclasses, pathlib, sys
from derivation import cli, pipeline
from derivation.engine import console as screen
from derivation.engine.measure import search
nothing = pathlib.Path(sys.argv[1] + ".none")  # nothing on record: any case is new
pipeline.PAPER = dataclasses.replace(pipeline.PAPER, records=nothing)
evaluate = search._evaluate_points
def with_output(*arguments):
    yield from evaluate(*arguments)
    print("evaluated", flush=True)
search._evaluate_points = with_output
command = "check search --time 1h --function bessel_j0 --out"
sys.exit(cli.main([*command.split(), sys.argv[1]]))
"""
    path = tmp_path / "cases.toml"
    shown, _ = interrupted(program, path, "evaluated")
    assert "bessel_j0: x=" in shown
    (case,) = read(path)
    assert case.kernel == "bessel_j0"
    assert [p.name for p in tmp_path.iterdir()] == ["cases.toml"]
