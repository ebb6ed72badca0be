"""Test points of a paper's functions lie within the conditions of each formula."""

import math
from pathlib import Path

import pytest
import sympy as sp

from derivation.engine.emit.found_form import cached_form, found_form
from derivation.engine.formula.chain import Chain, DerivationStep
from derivation.engine.formula.grid import plain_grid
from derivation.engine.formula.proof import prove
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Argument, Vocabulary
from derivation.engine.measure import domain_grid
from derivation.engine.measure.check import reference_values
from derivation.engine.measure.judge import judge
from derivation.engine.measure.point import Point
from derivation.engine.rewrite.doubles import run
from derivation.engine.rewrite.products import GivenFormula
from derivation.engine.rewrite.scales import Scales

n, q = sp.symbols("n q", real=True)
WORDS = Vocabulary(
    (
        Argument(n, "1", "n", "a number", ("n >= 0", "n <= 1")),
        Argument(q, "1", "q", "another number", ("q >= 0.5", "q <= 2")),
    )
)


class Number(Record):
    """A formula of two numbers."""

    vocabulary = WORDS


def pole(*where: str) -> Number:
    proof = prove("Given", "Given.", {"nothing": sp.Integer(0)})
    return Number("f", "f", "a number", q / (1 - n), "1", "", (), proof, where=where)


@pytest.fixture(autouse=True)
def empty_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))


@pytest.fixture
def by(monkeypatch: pytest.MonkeyPatch) -> domain_grid.Judge:
    """Return references and points of a formula with a pole at an end of the common domain."""
    return judge_of(pole("n < 1", "n + q <= 2"), monkeypatch, decades=100)


def test_points_satisfy_the_conditions_of_the_formula(by: domain_grid.Judge) -> None:
    points = [point.values for point in by.grid("f", ["n", "q"], False)]
    assert len(points) > 100
    assert all(point["n"] < 1 and point["n"] + point["q"] <= 2 for point in points)
    assert max(point["n"] for point in points) > 1 - 1e-12
    assert by.inside("f", Point({"n": 0.5, "q": 1.0}))
    assert not by.inside("f", Point({"n": 1.0, "q": 1.0}))
    assert by.inside("another function", Point({"n": 1.0, "q": 1.0}))


def test_a_domain_is_narrowed_for_one_formula_only() -> None:
    narrowed = WORDS.with_conditions(("n < 1",))
    assert narrowed.by_name["n"].domain == ("n >= 0", "n <= 1", "n < 1")
    assert WORDS.by_name["n"].domain == ("n >= 0", "n <= 1")
    assert WORDS.with_conditions(()) is WORDS


def test_the_form_is_tested_within_the_conditions() -> None:
    """The distance to the end of the domain, 1 - n, is exact, with and without the condition."""
    for given in (pole("n < 1"), pole()):
        made, decades = cached_form(given, {}, Scales(), 0.5)
        assert decades == 100
        assert not made.blocks


def test_parts_of_a_form_do_not_overflow_before_the_value() -> None:
    """E h^3 overflows before E h^3/12 does."""
    stiff, thick = sp.symbols("E h", positive=True)
    arguments = (Argument(x, "1", str(x), "", (f"{x} >= 1e-100",)) for x in (stiff, thick))
    given = GivenFormula("D", stiff * thick**3 / 12, Vocabulary(tuple(arguments)))
    made, decades = found_form(given, {}, Scales(), 0.5)
    assert decades == 100
    at = {stiff: 1.2e53, thick: 2.6e85}
    exact = sp.Rational(at[stiff]) * sp.Rational(at[thick]) ** 3 / 12
    assert run(made.steps, made.value, at, {}) == pytest.approx(float(exact), rel=1e-15)


def judge_of(formula: Number, monkeypatch: pytest.MonkeyPatch, **row: object) -> domain_grid.Judge:
    """Return references and points of a formula with a row of the manifest."""
    chain = Chain("one", WORDS, (DerivationStep("one", lambda: (formula,)),), (), (Number,))
    arguments = [argument.name for argument in formula.arguments]
    one = {"name": "f", "arguments": arguments, "domain": ", ".join(formula.domain), **row}
    rows = type("Manifest", (), {"KERNELS": [one]})
    monkeypatch.setattr(domain_grid.importlib, "import_module", lambda _: rows)
    return domain_grid.domain_judge(chain, {}, "one", (), lambda _: True)


def test_points_lie_in_the_range_in_which_a_form_was_tested(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    by = judge_of(pole("n < 1"), monkeypatch, decades=30)
    sizes = [point.values["n"] for point in by.grid("f", ["n", "q"], False)]
    assert min(size for size in sizes if size) == pytest.approx(1e-30)
    by = judge_of(pole("n < 1"), monkeypatch, decades=0)  # a stated form has no tested range
    sizes = [point.values["n"] for point in by.grid("f", ["n", "q"], False)]
    assert min(size for size in sizes if size) < 1e-300


def test_conditions_are_compared_as_in_the_function(monkeypatch: pytest.MonkeyPatch) -> None:
    """3 n < 2 q + 0.1 holds exactly at points at which the rounded sides are equal."""
    condition = "3 * n < 2 * q + 0.1"
    by = judge_of(pole("n < 1", condition), monkeypatch, decades=100)
    points = by.grid("f", ["n", "q"], False)
    assert points
    assert all(3 * p.values["n"] < 2 * p.values["q"] + 0.1 for p in points)


def test_a_root_at_the_end_of_its_domain_has_a_value(monkeypatch: pytest.MonkeyPatch) -> None:
    """The slope of q - sqrt(1 - n) is infinite where n = 1, and any finite result is allowed."""
    proof = prove("Given", "Given.", {"nothing": sp.Integer(0)})
    root = Number("f", "f", "a root", q - sp.sqrt(1 - n), "1", "", (), proof)
    by = judge_of(root, monkeypatch, decades=100)
    end = Point({"n": 1.0, "q": 2.0})
    [found] = reference_values(by.routes.balls, "f", [end], 50)
    assert found.references[0].value == 2
    assert judge(2.5, found.references[0], 1.0).ratio == 0
    assert judge(math.nan, found.references[0], 1.0).ulp == math.inf
    with pytest.raises(ValueError, match="expected a value in the whole domain"):
        reference_values(by.routes.balls, "f", [Point({"n": 1.5, "q": 2.0})], 50)


def test_error_at_a_kink_is_evaluated_with_the_slope_next_to_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Arb has no slope of sqrt((1 - n)^2) at n = 1, where it is finite on both sides."""
    proof = prove("Given", "Given.", {"nothing": sp.Integer(0)})
    kink = Number("f", "f", "a kink", q + sp.sqrt((1 - n) ** 2), "1", "", (), proof)
    by = judge_of(kink, monkeypatch, decades=100)
    [found] = reference_values(by.routes.balls, "f", [Point({"n": 1.0, "q": 2.0})], 50)
    assert found.references[0].value == 2
    assert judge(2.0, found.references[0], 1.0).ratio == 0
    assert judge(2.0 + 1e-14, found.references[0], 1.0).ratio > 1


def test_domains_of_large_and_small_numbers_have_points() -> None:
    """A Reynolds number above 2,000 is larger than the numbers that are drawn first."""
    large, small = sp.symbols("Re k", positive=True)
    words = Vocabulary(
        (
            Argument(large, "1", "Re", "", ("Re > 2000", "Re < 1e9")),
            Argument(small, "1", "k", "", ("k > 0", "k < 1e-20")),
        )
    )
    points = plain_grid("f", ("Re", "k"), words)
    assert len(points) > 40
    assert all(2000 < point["Re"] < 1e9 and 0 < point["k"] <= 1e-20 for point in points)
    assert len({point["Re"] for point in points}) > 20
