"""The rewriting rules, one at a time and together, against interval arithmetic."""

import importlib
import math
import random
from collections.abc import Callable
from typing import Any

import flint
import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from derivation.engine.emit.printer import to_numpy
from derivation.engine.emit.standalone import standalone
from derivation.engine.formula.ball import PrecisionError, enclose, evaluate
from derivation.engine.formula.ulp import from_ordinal, ordinal, overflows, ulp_error
from derivation.engine.rewrite import rules
from derivation.engine.rewrite.automatic import automatic
from derivation.engine.rewrite.doubles import rounded_value
from derivation.engine.rewrite.form import Switch
from derivation.engine.rewrite.rules import RULES, Rewritten
from derivation.engine.rewrite.series import POLYNOMIAL, truncated_taylor
from derivation.engine.rewrite.shape import Shape, assembled_form
from derivation.engine.rewrite.stabilise import stabilise
from derivation.engine.rewrite.terms import UnreachableError, taylor, terms_of, truncation_bound
from derivation.plate.blocks import DEFINITIONS, blocks
from derivation.plate.derived import formulas
from derivation.plate.forms import AUTOMATIC, SCALES
from generated import ranges

x = sp.Symbol("x", positive=True)
E = sp.exp(-x)

# Formulas that a rule must leave unchanged, with the reason.
UNCHANGED = (
    (rules.conjugate, sp.sqrt(x) + sp.sqrt(x + 1), "a sum of positive terms does not cancel"),
    (rules.conjugate, x - sp.sin(x), "there is no root"),
    (rules.logarithm, sp.log(x), "the argument is not near 1 at x = 0"),
    (rules.logarithm, sp.log(2 + x), "likewise"),
    (rules.fraction, (x - sp.sin(x)) / x**3, "it is already one quotient"),
    (rules.half_angle, 2 - sp.cos(x), "it does not vanish"),
    (rules.half_angle, 1 + sp.cosh(x), "a sum of positive terms does not cancel"),
    (rules.half_angle, x - x * sp.sin(x), "sin 0 is not 1"),
    (rules.difference, sp.sinh(x), "the rule applies only after `decay`"),
    (rules.series, x - sp.sin(x), "likewise"),
)

# Every rule with formulas that it changes.
CHANGED: tuple[tuple[str, sp.Expr], ...] = (
    ("conjugate", sp.sqrt(x + 1) - sp.sqrt(x)),
    ("conjugate", 2 * sp.sqrt(x**2 + 4) - 4),
    ("logarithm", sp.log(1 + x) / x),
    ("fraction", sp.coth(x) - 1 / x),
    ("fraction", 1 / (1 + x) - 1 / (2 + x)),
    ("half angle", 1 - sp.cos(x)),
    ("half angle", (3 - 3 * sp.cosh(2 * x)) / x),
    ("half angle", sp.sin(3 * x) - sp.sin(x)),
    ("half angle", x * sp.cos(x) + x),
    ("half angle", sp.log(sp.cosh(x) - sp.cosh(x / 3) + sp.sinh(x) - sp.sinh(x / 5))),
    ("decay", (sp.sinh(x) * sp.cosh(x) + x) / (sp.sinh(x) - x)),
    ("decay", x * sp.cos(x) - sp.sin(x)),
    ("decay", sp.sqrt(1 + x) * sp.sinh(x)),
    ("difference", (x * sp.sinh(x) + 2 * sp.sinh(2 * x)) / sp.cosh(x)),
    ("balance", (x - sp.sin(x)) / x**3),
    ("reuse", (sp.sinh(x) - x) * sp.exp(-x)),
)
UP_TO = {rule.name: RULES[: index + 1] for index, rule in enumerate(RULES)}
UP_TO["reuse"] = (*RULES, rules.REUSE)

# Formulas that do not occur in the paper.
OTHER_FORMULAS = (
    (x - sp.sin(x)) / x**3,
    sp.log(1 + x) / x,
    sp.sqrt(x + 1) - sp.sqrt(x),
    sp.coth(x) - 1 / x,
    (sp.sinh(x) - x) / (sp.cosh(x) - 1),
    1 / (sp.exp(x) - 1) - 1 / x,
    (x - sp.log(1 + x)) / x**2,
    (sp.cosh(x) - sp.cos(x)) / (x * sp.sinh(x)),
    x - sp.tanh(x),
    sp.sqrt(x**2 + 1) - 1,
)

REJECTED = (
    (sp.exp(x**2) - 1, "not a function of a rational multiple of x"),
    (sp.besselj(0, x) - 1, "no rule applies to the function besselj"),
    (sp.exp(sp.sin(x)) - 1, r"exp\(sin\(x\)\)"),
    (sp.sqrt(1 + x) - 1 - x / 2, "sqrt"),
)


def value_of(form: Rewritten) -> sp.Expr:
    """Return a form as one expression, without its truncated series."""
    if not isinstance(form, Shape):
        return form
    steps, value = assembled_form(form)
    branch = value.above if isinstance(value, Switch) else None
    expression = branch.value if branch else value
    for step in reversed((*steps, *(branch.steps if branch else ()))):
        expression = expression.subs(step.symbol, step.expression)
    return expression


@pytest.mark.parametrize(("rule", "expression", "why"), UNCHANGED)
def test_rule_leaves_expression_unchanged(
    rule: Callable[..., Any], expression: sp.Expr, why: str
) -> None:
    assert not list(rule(x, expression)), why


@pytest.mark.parametrize(("name", "expression"), CHANGED)
@settings(max_examples=25)
@given(point=st.floats(1e-3, 30.0))
def test_rule_is_exact(name: str, expression: sp.Expr, point: float) -> None:
    """Expressions before and after a rule agree, except where a truncated series is used."""
    form: Rewritten = expression
    for rule in UP_TO[name]:
        before, form = form, next(rule.apply(x, form), form)
    assert form != before, f"{name} does nothing to {expression}"
    with flint.ctx.workprec(300):
        at = {x: flint.arb(point)}
        difference = enclose(expression, at) - enclose(value_of(form), at)
        assert difference.contains(0)
        assert difference.rad() < 1e-60


def test_difference_of_roots_in_equation_18_does_not_cancel() -> None:
    """At small times the source term of the perturbation loses all digits as published."""
    source = formulas()["G_1"].expression
    at = dict.fromkeys(source.free_symbols, 1.0) | {_delta(source): 1e-7}
    (corrected,) = rules.conjugate(x, source)
    exact = float(evaluate(source, at, 20))
    assert abs(rounded_value(source, at) / exact - 1) >= 1
    assert rounded_value(corrected, at) == pytest.approx(exact, rel=1e-15)


def _delta(source: sp.Expr) -> sp.Symbol:
    return next(symbol for symbol in source.free_symbols if str(symbol) == "delta_0")


@settings(max_examples=60)
@given(fraction=st.floats(0.0, 1.0), switch=st.sampled_from((0.25, 0.5, 1.0, 1.5)))
@pytest.mark.parametrize(
    "core",
    [sp.sinh(x) - x, sp.sin(x) - x * sp.cos(x), sp.exp(x) - 1 - x, sp.exp(-x) * sp.sin(x) - x]
    + [function(x / 2) - x / 2 for function in (sp.asin, sp.atan, sp.asinh, sp.atanh)],
)
def test_truncated_series_is_within_its_bound(
    core: sp.Expr, fraction: float, switch: float
) -> None:
    section = truncated_taylor(terms_of(core, x), sp.Rational(switch))
    point = flint.arb(switch * max(fraction, 1e-6))
    with flint.ctx.workprec(600):
        total = sum(
            (
                flint.arb(flint.fmpq(int(c.p), int(c.q))) * point ** (section.stride * k)
                for k, c in enumerate(section.coefficients)
            ),
            flint.arb(0),
        )
        exact = enclose(core, {x: point}) / point**section.lead
        assert abs(total / exact - 1) < flint.arb(float(section.bound)) * (1 + 1e-9)
    assert section.bound < sp.Rational(1, 2**55)


def test_remainder_of_the_taylor_series_is_bounded() -> None:
    terms = terms_of(x * sp.exp(-2 * x) * sp.sin(3 * x) + sp.cosh(x) - sp.cos(x / 2), x)
    coefficients = [c for c, _ in zip(taylor(terms), range(60), strict=False)]
    for n in (3, 6, 11, 20):
        end = sp.Rational(3, 4)
        rest = sum(abs(c) * end**power for power, c in enumerate(coefficients) if power >= n)
        assert rest <= truncation_bound(terms, n, end) * (1 + sp.Rational(1, 10**9))


def test_terms_add_up_to_the_expression() -> None:
    expression = (x * sp.cosh(2 * x) - sp.sinh(x)) * (x**2 + sp.exp(-x)) + 3 * sp.sin(x)
    expression += sp.sin(x) ** 3 * sp.cos(x / 2) - sp.sin(x) * sp.sin(3 * x)
    terms = terms_of(expression, x)
    back = rules.expression_of(terms, x)
    assert sp.expand((back - expression).rewrite(sp.exp)) == 0
    for unsupported in (1 / x, sp.sin(x) * sp.atan(x), sp.exp(x**2), sp.gamma(x)):
        with pytest.raises(UnreachableError):
            terms_of(unsupported, x)


def compiled(source: str) -> Callable[[Any], Any]:
    namespace: dict[str, Any] = {}
    exec(compile(source, "f.py", "exec"), namespace)
    return namespace["f"]  # type: ignore[no-any-return]


def hard_points(seed: str, count: int = 160) -> list[float]:
    """Return points uniform over the doubles of [1e-150, 1e150], and more in [1e-3, 800]."""
    generator = random.Random(seed)
    first, last = ordinal(1e-150), ordinal(1e150)
    spread = [from_ordinal(generator.randint(first, last)) for _ in range(count)]
    return [1e-150, 1e150, *spread, *(10 ** generator.uniform(-3, 2.9) for _ in range(count))]


@pytest.mark.parametrize("expression", OTHER_FORMULAS, ids=str)
def test_other_formulas_are_accurate_to_eight_ulp(expression: sp.Expr) -> None:
    """Run the printed NumPy code at random points that the rules do not use."""
    stable = stabilise(expression, x)
    f = compiled(standalone(stable)[0])
    points = hard_points(str(expression))
    with np.errstate(all="raise", under="ignore"):
        got = f(np.array(points))
    compared = 0
    for point, value in zip(points, got.tolist(), strict=True):
        try:
            exact = evaluate(expression, {x: point}, 25)
        except PrecisionError:
            continue  # above 1e30 the exponentials of the formula cannot be enclosed
        if overflows(exact) or abs(exact) < 1e-300:
            continue
        try:
            slope = evaluate(expression.diff(x), {x: point}, 3)
            condition = float(abs(slope * point / exact).abs_upper())
        except PrecisionError:
            condition = 0.0  # x is exact, so its rounding causes no error
        assert ulp_error(value, exact) <= 8 + condition / 2, (point.hex(), value)
        compared += 1
    assert compared > 150
    assert np.isnan(f([0.0, -1.0, math.nan, math.inf])).all()
    assert f(np.zeros(0)).shape == (0,)
    assert np.ndim(f(0.7)) == 0


def test_limits_at_arguments_too_large_for_interval_arithmetic() -> None:
    """Two quotients tend to 1; x/(e^x - 1) underflows and is NaN outside its tested range."""
    for expression, limit in (
        (sp.coth(x) - 1 / x, 1.0),
        ((sp.sinh(x) - x) / (sp.cosh(x) - 1), 1.0),
        (x / (sp.exp(x) - 1), math.nan),
    ):
        source, tested = standalone(stabilise(expression, x))
        got = compiled(source)([1e30, 1e77, 1e150])
        np.testing.assert_array_equal(got, [limit] * 3)
        assert (tested.high >= 1e150) == (limit == 1.0)


@pytest.mark.parametrize(("expression", "reason"), REJECTED)
def test_unsupported_formula_is_rejected_with_the_reason(expression: sp.Expr, reason: str) -> None:
    with pytest.raises(UnreachableError, match=reason):
        stabilise(expression, x)


def test_every_rule_is_useful() -> None:
    """Each rule is applied to some formula, and lowers the error or the number of operations.

    This excludes rules that only save time.
    """
    needed = {a.rule for e in OTHER_FORMULAS[:5] for a in stabilise(e, x).applied}
    for name in ("G_minus_1", "sonine"):
        expression = formulas()[name].expression
        variable = next(iter(expression.atoms(sp.sin, sp.sinh))).args[0].free_symbols
        if len(variable) == 1:
            needed |= {a.rule for a in stabilise(expression, variable.pop(), (1e-150, 1e6)).applied}
    assert needed >= {"conjugate", "logarithm", "fraction", "decay", "balance", "series"}
    assert "half angle" in {a.rule for a in stabilise(1 + sp.cos(x), x).applied}
    applied = [a for e in OTHER_FORMULAS[:5] for a in stabilise(e, x).applied]
    assert all(a.worst[1] <= 8 for a in applied)
    for rule in (a for a in applied if a.cause != "time"):
        shorter = rule.operations[0] > rule.operations[1]
        assert rule.worst[0] > rule.worst[1] or (rule.worst[0] == rule.worst[1] and shorter)


@pytest.mark.parametrize("name", AUTOMATIC)
def test_rules_remove_hyperbolic_functions_from_formulas_of_the_paper(name: str) -> None:
    steps, value = automatic(formulas()[name].expression, blocks(), SCALES)
    text = " ".join(map(str, (*steps, value)))
    assert "sinh(" not in text.replace("sinh_", "")
    assert "cosh(" not in text


PHI, H, LAM, MU = sp.symbols("phi h lam mu", positive=True)
X = PHI * H
GROWING = (X * (LAM + MU) * sp.sinh(X) + (LAM + 2 * MU) * sp.cosh(X)) / (PHI * (LAM + MU))
QUOTIENTS = (
    # A formula, and a part of the printed form that shows how it was rewritten.
    (sp.cosh(X) / sp.sinh(X), "1 +"),
    (sp.sinh(X) / sp.cosh(X), "expm1"),
    (sp.sinh(X) / (sp.sinh(2 * X) + X), "1/"),
    (sp.cosh(X) / (sp.sinh(X) ** 2 - X**2), "sinh_pair"),
    (GROWING * sp.exp(-X), "h*"),
)


def run(formula: sp.Expr, at: dict[sp.Symbol, float]) -> float:
    """Evaluate the stable form of a formula as printed code."""
    steps, value = automatic(formula, blocks(), SCALES)
    names = vars(importlib.import_module("generated.blocks")) | vars(ranges) | {"np": np}
    known = {str(symbol): np.asarray(number) for symbol, number in at.items()}
    for step in steps:
        known[str(step.symbol)] = eval(to_numpy(step.expression), names, known)
    return float(eval(to_numpy(value), names, known))


@pytest.mark.parametrize(("formula", "part"), QUOTIENTS)
def test_quotients_of_several_variables_are_rewritten_and_accurate(
    formula: sp.Expr, part: str
) -> None:
    """The printed form agrees with the formula in interval arithmetic."""
    symbols = sorted(formula.free_symbols, key=str)
    _, value = automatic(formula, blocks(), SCALES)
    assert part in to_numpy(value), to_numpy(value)
    for phi in (1e-70, 1e-9, 0.3, 0.9999, 1.0, 1.7, 3.4, 11.0, 300.0):
        at = {symbol: phi if symbol == PHI else 0.7 for symbol in symbols}
        got = run(formula, at)
        exact = evaluate(formula, at, 25)
        slack = sum(abs(evaluate(formula.diff(s), at, 5) * at[s] / exact) / 2 for s in symbols)
        assert ulp_error(got, exact) <= 6 + float(slack), phi


def test_quotient_that_tends_to_1_is_rounded_once_for_large_arguments() -> None:
    """1 plus a small remainder has an error of about 0.5 ULP; a quotient of two sums has more."""
    coth = sp.cosh(X) / sp.sinh(X)
    for phi in np.linspace(2.5, 18.0, 200).tolist():
        at = {PHI: phi, H: 1.0}
        assert ulp_error(run(coth, at), evaluate(coth, at, 25)) <= 0.6, phi


@pytest.mark.parametrize("end", [0, 1])
@pytest.mark.parametrize(
    ("formula", "limits"),
    [
        (sp.cosh(X) / sp.sinh(X), (math.inf, 1.0)),
        (sp.sinh(X) / (sp.sinh(2 * X) + X), (1 / 3, 0.0)),
        (sp.cosh(X) / (sp.sinh(X) ** 2 - X**2), (math.inf, 0.0)),
    ],
)
def test_argument_that_overflows_or_underflows_gives_the_limit(
    formula: sp.Expr, limits: tuple[float, float], end: int
) -> None:
    size = (1e-200, 1e200)[end]
    with np.errstate(all="ignore"):
        assert run(formula, {PHI: size, H: size}) == pytest.approx(limits[end], rel=1e-15)


def test_formula_without_a_building_block_is_rejected() -> None:
    phi, h = sp.symbols("phi h", positive=True)
    with pytest.raises(UnreachableError, match="cancels at 0"):
        automatic(1 / (sp.cosh(phi * h) - 1 - (phi * h) ** 2 / 3), blocks(), SCALES)
    with pytest.raises(UnreachableError, match="grows as"):
        automatic(GROWING, blocks(), SCALES)
    with pytest.raises(UnreachableError, match="got 2 products"):
        automatic(sp.sinh(phi * h) / sp.sinh(phi), blocks(), SCALES)


def test_rounded_evaluation_agrees_with_double_precision_arithmetic() -> None:
    generator = random.Random(4)
    for _ in range(200):
        point = 10 ** generator.uniform(-6, 2)
        computed = math.sqrt(point + 1) - 1 / (point * point + 3 / point)
        assert rounded_value(sp.sqrt(x + 1) - 1 / (x * x + 3 / x), {x: point}) == pytest.approx(
            computed, rel=1e-9
        )
    assert rounded_value(sp.exp(x), {x: 800.0}) == math.inf
    assert rounded_value(1 / (sp.exp(-x) - 1 + 1), {x: 800.0}) == math.inf
    assert math.isnan(rounded_value(sp.sin(x), {x: math.inf}))


def test_each_block_has_at_most_one_truncated_series() -> None:
    for name, own, total, lead, held, _ in DEFINITIONS:
        block = blocks()[name]
        assert block.total == total
        assert isinstance(block.value, Switch) == (lead > 0)
        if isinstance(block.value, Switch):
            least = sp.Min(own, block.value.at)
            assert block.definition(own) == total / own ** (lead - held) / least**held
            assert float(block.value.at).hex().startswith("0x1.0"), "not a power of two"
            below = block.value.below
            assert any(
                e.has(POLYNOMIAL) for e in (below.value, *(s.expression for s in below.steps))
            )
            assert "truncated" in block.truncation


@pytest.mark.parametrize("name", [row[0] for row in DEFINITIONS])
def test_generated_blocks_are_accurate_on_both_sides_of_their_switch_points(name: str) -> None:
    block = blocks()[name]
    (own,) = block.arguments
    call = getattr(importlib.import_module("generated.blocks"), name)
    at = float(block.value.at) if isinstance(block.value, Switch) else 1.0
    for point in (0.01, 0.3, 0.99, 1.0, 1.4999, math.nextafter(at, 0.0), at, 3.7, 20.0):
        held = sp.Integer(int(at)) if point >= at else own
        definition = block.divided / held**block.constant_power
        exact = evaluate(definition, {own: point}, 25)
        slack = abs(evaluate(definition.diff(own), {own: point}, 5) * point / exact)
        got = float(call(np.array([point]))[0])
        assert ulp_error(got, exact) <= 6 + float(slack) / 2, point
