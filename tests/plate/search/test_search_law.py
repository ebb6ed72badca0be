"""Test the search in the contact law: points, references, error limits, missing references."""

import dataclasses
import json
import math
import random
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import pytest

from derivation import pipeline
from derivation.cli import main
from derivation.engine.measure import search
from derivation.engine.measure.case import HardCase, read_cases
from derivation.engine.measure.judge import Error
from derivation.engine.measure.point import Point
from derivation.engine.measure.search import LargeError, TargetSearch
from derivation.engine.measure.search_record import (
    SearchRecord,
    as_data,
    case_of,
    recorded,
    to_toml,
)
from derivation.engine.measure.target import Numbers, Target
from derivation.plate.contact.cases import judge as contact_judge
from derivation.plate.contact.cases.reference_values import reference_value
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.search.draw import domain_of, draw
from derivation.plate.search.targets import targets
from generated.contact_law import indentation
from generated.impact import impact

NOWHERE = Path("/nonexistent")
NAMES = "contact_radius", "force_of_radius", "impact", "indentation"


@pytest.fixture(scope="module")
def law() -> dict[str, Target]:
    return {target.name: target for target in targets(NAMES)}


@pytest.fixture(autouse=True)
def _quiet() -> Iterator[None]:
    """Ignore floating-point warnings, as the search does."""
    with np.errstate(all="ignore"):
        yield


# --- points, reference value, error limit


@pytest.mark.parametrize("name", NAMES)
def test_law_is_tested_for_single_points_and_arrays(name: str, law: dict[str, Target]) -> None:
    """A correct value is within its error limit, also in an array; an error of 1e-10 is not."""
    target, generator = law[name], random.Random(4)
    points = [draw(target.domain, generator) for _ in range(2)]
    assert all(target.domain.holds(point) for point in points)
    together = target.call(points)
    for point, among in zip(points, together, strict=True):
        [alone] = target.call([point])
        assert len(alone) == (4 if name == "impact" else 1)
        assert among == pytest.approx(alone, rel=1e-12)
        right, wrong = (
            target.measure(point, tuple(factor * x for x in alone)) for factor in (1.0, 1 + 1e-10)
        )
        assert right is not None
        assert wrong is not None
        assert right.ratio < 1.0 < wrong.ratio
        nothing = target.measure(point, (math.nan,) * len(alone))
        assert nothing is not None
        assert nothing.ratio == math.inf


def test_random_arguments_give_contacts_within_the_law(law: dict[str, Target]) -> None:
    """The generated law maps each drawn argument to a contact radius within its range."""
    generator = random.Random(9)
    for _ in range(3):
        values = draw(law["contact_radius"].domain, generator).values
        R, h, b = (values[key] for key in ("R", "h", "b"))
        [(a,)] = law["contact_radius"].call([Point(values)])
        assert 0.0 < a < min(b, R)
        assert indentation(a, R, h, b) == pytest.approx(values["delta"], rel=1e-11)
        motion = draw(law["impact"].domain, generator).values
        result = impact(**motion)
        assert 0.0 < result.max_contact_radius < min(motion["b"], motion["R"])


def test_contacts_outside_the_law_are_not_evaluated(law: dict[str, Target]) -> None:
    """A contact beyond the plate edge and an overflowing force are not evaluated."""
    beyond = Point({"delta": 2.0, "R": 1.0, "h": 0.5, "b": 1.0})
    assert law["contact_radius"].measure(beyond, (1.0,)) is None
    huge = Point({"a": 1e100, "R": 1e-200, "lam": 1e100, "mu": 1e100})
    assert law["force_of_radius"].measure(huge, (math.inf,)) is None


@pytest.mark.parametrize(
    ("a", "R", "judged"), [(0.55, 100.0, True), (0.8, 100.0, False), (0.55, 0.5, False)]
)
def test_contact_wider_than_stated_has_no_reference(
    a: float, R: float, judged: bool, law: dict[str, Target]
) -> None:
    """References exist up to a = 6 h (here 0.6) and up to the radius of the sphere."""
    delta = float(contact_balls.indentation(a, R, 0.1, 1.0, 20))
    point = Point({"delta": delta, "R": R, "h": 0.1, "b": 1.0})
    actual = law["contact_radius"].measure(point, (a,))
    assert (actual is not None) is judged
    assert actual is None or actual.ratio < 1.0


def test_function_with_too_many_results_is_rejected() -> None:
    exact = reference_value(("max_pressure", (0.1, 1.0, 1e9, 1e9)))
    with pytest.raises(ValueError, match="2 results at "):
        contact_judge.judge(lambda *_: (1.0, 2.0), [exact], 1.0)


# --- no reference, or no neighbour


def plain(name: str, arguments: tuple[str, ...], conditions: tuple[str, ...]) -> Target:
    """Return a target with result 0 and an error equal to the size of its first argument."""

    def call(points: Sequence[Point]) -> list[Numbers]:
        return [(0.0,)] * len(points)

    def measure(point: Point, _: Numbers) -> Error | None:
        return Error(abs(point.values[arguments[0]]), 1.0)

    return Target(domain_of(name, arguments, False, conditions), draw, call, measure, None, 48, 1)


def test_points_without_reference_are_counted() -> None:
    target = dataclasses.replace(plain("blind", ("x",), ()), measure=lambda *_: None)
    state = search.search([target], 1, evaluations=600).states["blind"]
    assert (state.evaluations, state.unjudged) == (600, 600)
    assert state.worst is None
    assert state.ratio == -1.0


def test_local_search_keeps_zeros_and_stays_in_the_domain() -> None:
    """The local search does not move an argument that is 0, nor leave the domain."""
    seen = list[Point]()
    target = plain("zero", ("x", "y"), ("y == 1.0 or y > 4.0",))
    target = dataclasses.replace(
        target, call=lambda points: seen.extend(points) or [(0.0,)] * len(points)
    )
    start = Point({"x": 0.0, "y": 1.0})
    here = TargetSearch(worst=LargeError(start, None, Error(0.5, 1.0)))
    steps = search._local_search(target, random.Random(1), here, TargetSearch())
    assert list(steps) == []
    assert seen == []
    wide = dataclasses.replace(target, domain=domain_of("zero", ("x", "y"), False, ()))
    assert len(list(search._local_search(wide, random.Random(1), here, TargetSearch()))) > 10
    assert {point.values["x"] for point in seen} == {0.0}


def test_contradictory_conditions_are_reported() -> None:
    with pytest.raises(ValueError, match="no point found in the domain of never"):
        draw(domain_of("never", ("x",), False, ("x > 1.0", "x < 1.0")), random.Random(1))


# --- the file of cases


def test_cases_of_other_functions_stay_in_the_file(tmp_path: Path) -> None:
    path, target = tmp_path / "cases.toml", plain("size", ("x",), ())
    other = HardCase("search", "other", "Found by search, seed 3.", {"x": ((1.0).hex(),)})
    path.write_text(to_toml([(other, None)]))
    book = SearchRecord(path, [target], {}, {})
    search_result = search.search([target], 1, evaluations=50)
    book.keep(search_result)
    first, second = read_cases(path)
    assert first == other
    worst = search_result.states["size"].worst
    assert worst is not None
    assert second == case_of("size", worst, 1)


def test_recorded_worst_error_is_not_a_new_case(law: dict[str, Target]) -> None:
    """The committed worst error is measured again, and only a larger one is a new case."""
    target = law["force_of_radius"]
    rows = json.loads(pipeline.MEASURED_CONTACT.read_text())["rows"]
    [texts] = [row["worst"] for row in rows if row["kernel"] == target.name]
    point = Point(dict(zip(target.domain.arguments, map(float.fromhex, texts), strict=True)))
    error = target.measure(point, target.call([point])[0])
    assert error is not None
    book = SearchRecord(NOWHERE, [target], *recorded(NOWHERE, pipeline.MEASURED_CONTACT))
    elsewhere = Point({**point.values, "R": 2.0 * point.values["R"]})
    same = LargeError(elsewhere, None, error)
    assert not book.is_new(target.name, same)
    worse = LargeError(elsewhere, None, Error(1.001 * error.ulp, error.allowed))
    assert book.is_new(target.name, worse)
    assert SearchRecord(NOWHERE, [target], {}, {}).is_new(target.name, same)


@pytest.mark.parametrize(("off", "status"), [(0.5, 0), (2.0, 1)])
def test_json_output_of_the_search_is_pure(
    off: float, status: int, tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    """Standard output is JSON only, messages go to standard error.

    The exit status is 1 if an error exceeds its limit.
    """
    target = dataclasses.replace(plain("size", ("x",), ()), measure=lambda *_: Error(off, 1.0))
    search_result = search.search([target], 1, evaluations=20)
    book = SearchRecord(tmp_path / "cases.toml", [target], {}, {})
    book.keep(search_result)
    monkeypatch.setattr(pipeline, "search_worse", lambda *_: (search_result, book))
    assert main(["check", "search", "--time", "1s", "--json", "-"]) == status
    shown = capsys.readouterr()
    assert json.loads(shown.out) == as_data(search_result)
    assert "worst cases" in shown.err
    assert len(read_cases(book.path)) == 1
