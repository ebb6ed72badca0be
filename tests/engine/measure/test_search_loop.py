"""The search for large errors in a test function: reproducible, effective, and recorded."""

import dataclasses
import math
from collections.abc import Sequence
from pathlib import Path
from random import Random

import pytest

from derivation.engine.measure.judge import Error
from derivation.engine.measure.point import Point
from derivation.engine.measure.search import Search, search
from derivation.engine.measure.search_record import (
    SearchRecord,
    all_within_allowance,
    as_data,
    read,
)
from derivation.engine.measure.target import Domain, Numbers, Target

DOMAIN = Domain("square", ("x", "y"), False, ("0 < x <= 8", "y >= x", "z > 0"))


EVALUATIONS = 20_000


def drawn(_: Domain, generator: Random) -> Point:
    x = 8.0 - 8.0 * generator.random()
    return Point({"x": x, "y": x + generator.random()})


def squares(points: Sequence[Point]) -> list[Numbers]:
    """Return x squared, with an error from 0.5 (y = x + 1) to 1 (y = x) for 3 < x < 3.01."""
    rows = []
    for point in points:
        x, y = point.values["x"], point.values["y"]
        rows.append((x * x + ((1.0 - (y - x) / 2) if 3 < x < 3.01 else 0.0),))
    return rows


def error(point: Point, results: Numbers) -> Error:
    return Error(abs(results[0] - point.values["x"] ** 2), 0.5)


@pytest.fixture
def target() -> Target:
    return Target(DOMAIN, drawn, squares, error, None, 48, 1)


@pytest.fixture
def search_result(target: Target) -> Search:
    return search([target], seed=2, evaluations=EVALUATIONS)


def test_defect_is_found_refined_and_reproduced(search_result: Search, target: Target) -> None:
    worst = search_result.states["square"].worst
    assert worst is not None
    assert 3 < worst.point.values["x"] < 3.01
    assert worst.ratio > 1.999  # the largest value is 2, at y = x
    assert not all_within_allowance(search_result)
    assert as_data(search([target], seed=2, evaluations=EVALUATIONS)) == as_data(search_result)


def test_found_case_is_written_and_then_known(
    search_result: Search, target: Target, tmp_path: Path
) -> None:
    path = tmp_path / "cases.toml"
    book = SearchRecord(path, [target], {"square": 1.5}, {})
    book.keep(search_result)
    [case] = read(path)
    worst = search_result.states["square"].worst
    assert worst is not None
    assert case.points == [worst.point.values]
    assert not SearchRecord(path, [target], {}, {}).is_new("square", worst)


def test_recorded_arguments_are_compared_with_the_new_error(target: Target) -> None:
    known = {"square": [(3.005).hex(), (3.105).hex()]}
    book = SearchRecord(Path("/nonexistent"), [target], {}, known)
    [(result,)] = squares([Point({"x": 3.005, "y": 3.105})])
    same = error(Point({"x": 3.005, "y": 3.105}), (result,))
    worst = search([target], seed=2, evaluations=EVALUATIONS).states["square"].worst
    assert worst is not None
    assert book.is_new("square", worst)
    within = dataclasses.replace(worst, error=Error(0.9, 1.0))
    assert not book.is_new("square", within)
    assert same.ratio == pytest.approx(1.9)


def test_domain_follows_from_the_conditions_on_its_arguments() -> None:
    assert DOMAIN.holds(Point({"x": 8.0, "y": 8.0}))
    assert not DOMAIN.holds(Point({"x": 8.5, "y": 9.0}))
    assert not DOMAIN.holds(Point({"x": 2.0, "y": 1.0}))
    assert not DOMAIN.holds(Point({"x": 2.0, "y": math.inf}))


def test_steps_are_in_floats_or_integers() -> None:
    whole, point = dataclasses.replace(DOMAIN, whole=True), Point({"x": 1.0, "y": 5.0})
    assert DOMAIN.moved(point, "x", 1).values["x"] == math.nextafter(1.0, 2.0)
    assert DOMAIN.moved(point, "x", -(2**64)).values["x"] == -math.nextafter(math.inf, 0.0)
    assert whole.moved(point, "y", -3).values == {"x": 1.0, "y": 2.0}
