"""The search for misprints: equal factors, rejected candidates, and limits of its effort."""

import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

import flint
import pytest
import sympy as sp

from derivation.engine.errata import compare, position, repairs, sample
from derivation.engine.errata.dimensions import unit_name
from derivation.engine.errata.edit import factor_pool, single_edits, term_pool
from derivation.engine.errata.position import FACTOR, TERM, TERMS, Position, inner_positions
from derivation.engine.errata.variant import TWICE, VariantSearch
from derivation.engine.formula.dimension import Dimension
from derivation.engine.formula.parse import FormulaError
from derivation.engine.formula.proof import SYMBOLIC
from derivation.plate import misprints
from derivation.plate.elastic import diagnose, diagnose_text
from derivation.plate.modes import balance
from derivation.plate.printed.contact import PRINTED
from derivation.plate.vocabulary import A_j, Formula, P, R, T, a, b, h, lam, mu, phi

Formulas = Mapping[str, Formula]


def search_for(given: sp.Expr, reference: sp.Expr) -> VariantSearch:
    """Return the search for corrections that turn `given` into `reference`."""
    points = sample.sample([given, reference], {}, {})
    for expression in (given, reference, *factor_pool((given, reference))):
        points.learn(expression)
    return VariantSearch(points, factor_pool((given, reference)), term_pool(reference))


def corrected(given: sp.Expr, reference: sp.Expr) -> Iterable[repairs.Repair]:
    """Yield the corrections that turn `given` into `reference`."""
    with flint.ctx.workprec(300):
        search = search_for(given, reference)
        yield from repairs.repairs(given, search.points.values(reference), search)


# --- comparison


def test_long_expressions_are_compared_in_interval_arithmetic(formulas: Formulas) -> None:
    one = (sp.cosh(T) ** 2 - sp.sinh(T) ** 2) ** 12
    diagnosis = diagnose("G", formulas["G"].expression * one, formulas)
    assert (diagnosis.verdict, diagnosis.method) == (compare.EQUAL, compare.BY_BALLS)
    short = diagnose("G", formulas["G"].expression, formulas)
    assert (short.verdict, short.method) == (compare.EQUAL, SYMBOLIC)


def test_unknown_symbols_and_functions_are_rejected(formulas: Formulas) -> None:
    with pytest.raises(FormulaError, match="unknown symbols height, width: expected some of r, z"):
        diagnose("G", sp.Symbol("height") * sp.Symbol("width"), formulas)
    with pytest.raises(FormulaError, match=r"airyai.*: write it with other functions"):
        diagnose("G", sp.airyai(T), formulas)


def test_number_of_examined_candidates_is_limited(
    formulas: Formulas, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Candidates that do not give the derived formula are examined, but not reported."""
    candidates = itertools.count()

    def unlimited(*_: object) -> Iterable[repairs.Repair]:
        for index in candidates:
            yield repairs.Repair("sign", "read T", T + index, 1)

    monkeypatch.setattr(compare, "repairs", unlimited)
    diagnosis = diagnose("G", T, formulas)
    assert (diagnosis.verdict, diagnosis.kind, diagnosis.repaired) == (
        "different",
        "unexplained",
        None,
    )
    assert next(candidates) <= 7


def test_factor_counted_twice_is_reported_only_for_a_factor_of_the_other(
    formulas: Formulas,
) -> None:
    """P A_j in place of K_j, and A_j G in place of sonine, do not count a factor twice."""
    for name, given in (("K_j", P * formulas["A_j"].expression), ("sonine", A_j * sp.Symbol("G"))):
        diagnosis = diagnose(name, given, formulas)
        assert diagnosis.verdict == "different"
        assert diagnosis.kind != TWICE


# --- misprints


def test_superfluous_term_is_removed(formulas: Formulas) -> None:
    correct = formulas["Omega_1"].expression
    diagnosis = diagnose("Omega_1", correct + h * phi, formulas)
    assert diagnosis.repair == "leave out the term h*phi"
    assert diagnosis.repaired == correct


def test_misprint_in_one_of_two_equal_factors_is_corrected() -> None:
    """SymPy stores (a + b) (a + b) as one power, so the factors must be separated first."""
    reference = (a + b) * (a - b) * h
    first = next(iter(corrected((a + b) ** 2 * h, reference)))
    assert first.edits == 1
    assert sp.expand(first.expression - reference) == 0


def test_misprints_in_an_equal_factor_and_in_another_are_corrected() -> None:
    reference = (a + b) * (a - b) * (lam + mu)
    actual = list(corrected((a + b) ** 2 * (lam - mu), reference))
    assert actual
    assert any(repair.edits == 2 for repair in actual)
    assert all(sp.expand(repair.expression - reference) == 0 for repair in actual)


def test_correction_must_fit_at_every_sample_point() -> None:
    given, reference, other = sp.sinh(phi * h), sp.cosh(phi * h), a * b
    with flint.ctx.workprec(300):
        search = search_for(given * a * b, reference)
        exact = search.points.values(reference)
        assert single_edits(Position(given), exact, search)
        mixed = [exact[0], *search.points.values(other)[1:]]
        assert not single_edits(Position(given), mixed, search)


def test_search_for_pairs_and_for_single_misprints_stops_at_a_length(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    reference = a**3 * sp.sinh(phi * h) * sp.cosh(phi * b) / R
    one = a**3 * sp.cosh(phi * h) * sp.cosh(phi * b) / R
    two = a**3 * sp.cosh(phi * h) * sp.sinh(phi * b) / R
    assert next(iter(corrected(one, reference))).edits == 1
    assert next(iter(corrected(two, reference))).edits == 2
    monkeypatch.setattr(repairs, "MAX_OPERATIONS_FOR_PAIRS", 3)
    assert next(iter(corrected(one, reference))).edits == 1
    assert not list(corrected(two, reference))
    monkeypatch.setattr(repairs, "MAX_OPERATIONS", 3)
    assert not list(corrected(one, reference))


def test_no_correction_is_reported_for_an_unrelated_formula() -> None:
    assert not list(corrected(a**2 + b * h + sp.sin(phi * h), sp.cosh(phi * b) * lam))


def test_groups_of_terms_are_edited_only_in_short_sums() -> None:
    short, long = (sp.Add(*(phi**k for k in range(1, n + 1))) for n in (3, position.MAX_TERMS + 1))
    roles = [[part.role for part in inner_positions(Position(total))] for total in (short, long)]
    assert (roles[0].count(TERM), roles[0].count(TERMS)) == (3, 3)
    assert roles[1] == [TERM] * (position.MAX_TERMS + 1)


def test_one_of_several_equal_factors_can_be_replaced() -> None:
    (factor,) = (
        part for part in inner_positions(Position(1 / (a + b) ** 3)) if part.role == FACTOR
    )
    assert factor.put(a - b) == 1 / ((a + b) ** 2 * (a - b))


# --- numbers


def test_constants_are_fractions_times_powers_of_pi_and_their_roots() -> None:
    with flint.ctx.workprec(200):
        pi, two = flint.acb.pi(), flint.acb(2)
        assert sample.constant([3 * pi**2 / 7] * 2) == sp.Rational(3, 7) * sp.pi**2
        assert sample.constant([-two.sqrt()] * 2) == -sp.sqrt(2)
        assert sample.constant([(3 / (4 * pi)).root(3)] * 2) == sp.cbrt(3 / (4 * sp.pi))
        assert sample.constant([two.exp()] * 2) is None
        assert sample.constant([flint.acb(0.5) + flint.acb(2) ** -45] * 2) is None
    assert sample.rational(0.75, 4) == Fraction(3, 4)
    assert sample.rational(2e6, 4) is None
    assert sample.rational(float("nan"), 4) is None


def test_unit_names_contain_pascals_or_base_units() -> None:
    assert unit_name(Dimension(mass=Fraction(1), length=Fraction(-1), time=Fraction(-2))) == "Pa"
    assert unit_name(Dimension(mass=Fraction(1), time=Fraction(-1))) == "kg s^-1"


@pytest.mark.parametrize(
    ("text", "digits", "values"),
    [("{} - 1", 5, ("0",)), ("5/2*{}", 1, ("2", "3")), ("5/2*{}", 2, ("2.5",))],
)
def test_values_of_zero_and_ties_in_rounding_are_printed(
    text: str, digits: int, values: Sequence[str], formulas: Formulas
) -> None:
    """No working precision separates cosh^2 - sinh^2 from 1, so either rounding is accepted."""
    given = text.format("(cosh(T)**2 - sinh(T)**2)")
    diagnosis = diagnose_text("G", given, formulas, at={"T": "1.5"}, digits=digits)
    assert diagnosis.given_value in values


# --- the published pair u and w


def test_displacements_in_equilibrium_need_no_change_of_sign(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    (printed,) = (record for record in PRINTED if record.name == "u")
    assert balance.signs_that_balance(["u"]) == ("u",)
    assert "if one sign is reversed" in misprints._balance_remark(printed)
    balanced = [replace(r, expression=-r.expression) if r.name == "u" else r for r in PRINTED]
    monkeypatch.setattr(balance, "PRINTED", balanced)
    assert balance.signs_that_balance(["u", "w", "f_j", "g_j"]) == ()
    assert misprints._balance_remark(printed) == ""
