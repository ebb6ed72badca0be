"""Test points of a paper's functions lie within the conditions of each formula."""

from pathlib import Path

import pytest
import sympy as sp

from derivation.engine.emit.found_form import cached_form, found_form
from derivation.engine.formula.chain import Chain, DerivationStep
from derivation.engine.formula.proof import prove
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Argument, Vocabulary
from derivation.engine.measure import domain_grid
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
def judge(monkeypatch: pytest.MonkeyPatch) -> domain_grid.Judge:
    """Return references and points of a formula with a pole at an end of the common domain."""
    formula = pole("n < 1", "n + q <= 2")
    chain = Chain("poles", WORDS, (DerivationStep("pole", lambda: (formula,)),), (), (Number,))
    rows = type("Manifest", (), {"KERNELS": [{"name": "f", "decades": 100}]})
    monkeypatch.setattr(domain_grid.importlib, "import_module", lambda _: rows)
    return domain_grid.domain_judge(chain, {}, "poles", (), lambda _: True)


def test_points_satisfy_the_conditions_of_the_formula(judge: domain_grid.Judge) -> None:
    points = [point.values for point in judge.grid("f", ["n", "q"], False)]
    assert len(points) > 100
    assert all(point["n"] < 1 and point["n"] + point["q"] <= 2 for point in points)
    assert max(point["n"] for point in points) > 1 - 1e-12
    assert judge.inside("f", Point({"n": 0.5, "q": 1.0}))
    assert not judge.inside("f", Point({"n": 1.0, "q": 1.0}))
    assert judge.inside("another function", Point({"n": 1.0, "q": 1.0}))


def test_a_domain_is_narrowed_for_one_formula_only() -> None:
    narrowed = WORDS.with_conditions(("n < 1",))
    assert narrowed.by_name["n"].domain == ("n >= 0", "n <= 1", "n < 1")
    assert WORDS.by_name["n"].domain == ("n >= 0", "n <= 1")
    assert WORDS.with_conditions(()) is WORDS


def test_the_form_is_tested_within_the_conditions() -> None:
    """The distance to the end of the domain, 1 - n, is exact; without the condition as well."""
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
