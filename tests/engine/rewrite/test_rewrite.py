"""The rewriting rules: each on its own against balls, and what they make of formulas together."""

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
from derivation.engine.rewrite.doubles import rounded
from derivation.engine.rewrite.form import Switch
from derivation.engine.rewrite.rules import RULES, Rewritten
from derivation.engine.rewrite.series import POLYNOMIAL, taylor_section
from derivation.engine.rewrite.shape import Shape, assembled
from derivation.engine.rewrite.stabilise import stabilise
from derivation.engine.rewrite.terms import UnreachableError, left_out, taylor, terms_of
from derivation.plate.blocks import DEFINITIONS, blocks
from derivation.plate.derived import formulas
from derivation.plate.forms import AUTOMATIC, SCALES
from generated import ranges

x = sp.Symbol("x", positive=True)
E = sp.exp(-x)

# What a rule must leave alone, and why.
LEFT_ALONE = (
    (rules.conjugate, sp.sqrt(x) + sp.sqrt(x + 1), "a sum does not cancel"),
    (rules.conjugate, x - sp.sin(x), "there is no root"),
    (rules.logarithm, sp.log(x), "the argument is not near 1 at x = 0"),
    (rules.logarithm, sp.log(2 + x), "nor here"),
    (rules.fraction, (x - sp.sin(x)) / x**3, "it is one quotient already"),
    (rules.difference, sp.sinh(x), "only what is taken apart has differences to cancel"),
    (rules.section, x - sp.sin(x), "likewise"),
)

# Every rule with formulas on which it acts.
ACTED_ON: tuple[tuple[str, sp.Expr], ...] = (
    ("conjugate", sp.sqrt(x + 1) - sp.sqrt(x)),
    ("conjugate", 2 * sp.sqrt(x**2 + 4) - 4),
    ("logarithm", sp.log(1 + x) / x),
    ("fraction", sp.coth(x) - 1 / x),
    ("fraction", 1 / (1 + x) - 1 / (2 + x)),
    ("decay", (sp.sinh(x) * sp.cosh(x) + x) / (sp.sinh(x) - x)),
    ("decay", x * sp.cos(x) - sp.sin(x)),
    ("decay", sp.sqrt(1 + x) * sp.sinh(x)),
    ("difference", (x * sp.sinh(x) + 2 * sp.sinh(2 * x)) / sp.cosh(x)),
    ("balance", (x - sp.sin(x)) / x**3),
    ("share", (sp.sinh(x) - x) * sp.exp(-x)),
)
UP_TO = {rule.name: RULES[: index + 1] for index, rule in enumerate(RULES)}
UP_TO["share"] = (*RULES, rules.SHARE)

# Formulas outside the paper, among them two of the project's own: x - log(1+x), cosh x - cos x.
STRANGERS = (
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

REFUSED = (
    (sp.exp(x**2) - 1, "not a function of a rational multiple of x"),
    (sp.besselj(0, x) - 1, "no rule applies to the function besselj"),
    (sp.exp(sp.sin(x)) - 1, r"exp\(sin\(x\)\)"),
    (sp.sqrt(1 + x) - 1 - x / 2, "sqrt"),
)


def value_of(form: Rewritten) -> sp.Expr:
    """A form as one expression, without its sections."""
    if not isinstance(form, Shape):
        return form
    steps, value = assembled(form)
    branch = value.above if isinstance(value, Switch) else None
    expression = branch.value if branch else value
    for step in reversed((*steps, *(branch.steps if branch else ()))):
        expression = expression.subs(step.symbol, step.expression)
    return expression


@pytest.mark.parametrize(("rule", "expression", "why"), LEFT_ALONE)
def test_rule_leaves_alone(rule: Callable[..., Any], expression: sp.Expr, why: str) -> None:
    assert not list(rule(x, expression)), why


@pytest.mark.parametrize(("name", "expression"), ACTED_ON)
@settings(max_examples=25)
@given(point=st.floats(1e-3, 30.0))
def test_rule_is_exact(name: str, expression: sp.Expr, point: float) -> None:
    """Before and after are the same ball, wherever the rule is not a section."""
    form: Rewritten = expression
    for rule in UP_TO[name]:
        before, form = form, next(rule.apply(x, form), form)
    assert form != before, f"{name} does nothing to {expression}"
    with flint.ctx.workprec(300):
        at = {x: flint.arb(point)}
        difference = enclose(expression, at) - enclose(value_of(form), at)
        assert difference.contains(0)
        assert difference.rad() < 1e-60


def test_difference_of_roots_in_18_cancels_no_more() -> None:
    """The source term of the perturbation, at times so small that as printed it is noise."""
    source = formulas()["G_1"].expression
    at = dict.fromkeys(source.free_symbols, 1.0) | {_delta(source): 1e-7}
    (corrected,) = rules.conjugate(x, source)
    true = float(evaluate(source, at, 20))
    assert abs(rounded(source, at) / true - 1) >= 1
    assert rounded(corrected, at) == pytest.approx(true, rel=1e-15)


def _delta(source: sp.Expr) -> sp.Symbol:
    return next(symbol for symbol in source.free_symbols if str(symbol) == "delta_0")


@settings(max_examples=60)
@given(share=st.floats(0.0, 1.0), switch=st.sampled_from((0.25, 0.5, 1.0, 1.5)))
@pytest.mark.parametrize(
    "core",
    [sp.sinh(x) - x, sp.sin(x) - x * sp.cos(x), sp.exp(x) - 1 - x, sp.exp(-x) * sp.sin(x) - x],
)
def test_section_keeps_its_bound(core: sp.Expr, share: float, switch: float) -> None:
    section = taylor_section(terms_of(core, x), sp.Rational(switch))
    point = flint.arb(switch * max(share, 1e-6))
    with flint.ctx.workprec(600):
        total = sum(
            (
                flint.arb(flint.fmpq(int(c.p), int(c.q))) * point ** (section.stride * k)
                for k, c in enumerate(section.coefficients)
            ),
            flint.arb(0),
        )
        true = enclose(core, {x: point}) / point**section.lead
        assert abs(total / true - 1) < flint.arb(float(section.bound)) * (1 + 1e-9)
    assert section.bound < sp.Rational(1, 2**55)


def test_what_taylor_leaves_out_is_bounded() -> None:
    terms = terms_of(x * sp.exp(-2 * x) * sp.sin(3 * x) + sp.cosh(x) - sp.cos(x / 2), x)
    coefficients = [c for c, _ in zip(taylor(terms), range(60), strict=False)]
    for n in (3, 6, 11, 20):
        end = sp.Rational(3, 4)
        rest = sum(abs(c) * end**power for power, c in enumerate(coefficients) if power >= n)
        assert rest <= left_out(terms, n, end) * (1 + sp.Rational(1, 10**9))


def test_terms_are_the_expression() -> None:
    expression = (x * sp.cosh(2 * x) - sp.sinh(x)) * (x**2 + sp.exp(-x)) + 3 * sp.sin(x)
    terms = terms_of(expression, x)
    back = rules.expression_of(terms, x)
    assert sp.expand((back - expression).rewrite(sp.exp)) == 0
    for strange in (1 / x, sp.sin(x) * sp.cos(x), sp.exp(x**2), sp.gamma(x)):
        with pytest.raises(UnreachableError):
            terms_of(strange, x)


def compiled(source: str) -> Callable[[Any], Any]:
    space: dict[str, Any] = {}
    exec(compile(source, "f.py", "exec"), space)
    return space["f"]  # type: ignore[no-any-return]


def hard_points(seed: str, count: int = 160) -> list[float]:
    """Uniform over the doubles of [1e-150, 1e150], and more where functions bend."""
    generator = random.Random(seed)
    first, last = ordinal(1e-150), ordinal(1e150)
    spread = [from_ordinal(generator.randint(first, last)) for _ in range(count)]
    return [1e-150, 1e150, *spread, *(10 ** generator.uniform(-3, 2.9) for _ in range(count))]


@pytest.mark.parametrize("expression", STRANGERS, ids=str)
def test_strangers_hold_eight_ulp(expression: sp.Expr) -> None:
    """The printed NumPy code, run as it is, at points the rules never saw."""
    stable = stabilise(expression, x)
    f = compiled(standalone(stable)[0])
    points = hard_points(str(expression))
    with np.errstate(all="raise", under="ignore"):
        got = f(np.array(points))
    judged = 0
    for point, value in zip(points, got.tolist(), strict=True):
        try:
            true = evaluate(expression, {x: point}, 25)
        except PrecisionError:
            continue  # beyond 1e30 the original's own exponentials have no ball
        if overflows(true) or abs(true) < 1e-300:
            continue
        try:
            slope = evaluate(expression.diff(x), {x: point}, 3)
            condition = float(abs(slope * point / true).abs_upper())
        except PrecisionError:
            condition = 0.0  # nothing is excused
        assert ulp_error(value, true) <= 8 + condition / 2, (point.hex(), value)
        judged += 1
    assert judged > 150
    assert np.isnan(f([0.0, -1.0, math.nan, math.inf])).all()
    assert f(np.zeros(0)).shape == (0,)
    assert np.ndim(f(0.7)) == 0


def test_large_arguments_where_balls_fail() -> None:
    """coth x - 1/x -> 1 and (sinh x - x)/(cosh x - 1) -> 1; x/(e^x - 1) underflows: NaN there."""
    for expression, limit in (
        (sp.coth(x) - 1 / x, 1.0),
        ((sp.sinh(x) - x) / (sp.cosh(x) - 1), 1.0),
        (x / (sp.exp(x) - 1), math.nan),
    ):
        source, tested = standalone(stabilise(expression, x))
        got = compiled(source)([1e30, 1e77, 1e150])
        np.testing.assert_array_equal(got, [limit] * 3)
        assert (tested.high >= 1e150) == (limit == 1.0)


@pytest.mark.parametrize(("expression", "reason"), REFUSED)
def test_out_of_reach_is_refused_with_the_reason(expression: sp.Expr, reason: str) -> None:
    with pytest.raises(UnreachableError, match=reason):
        stabilise(expression, x)


def test_every_rule_earns_its_place() -> None:
    """On the paper's formulas or the strangers, each lowers an error from useless to a few ULP."""
    needed = {a.rule for e in STRANGERS[:5] for a in stabilise(e, x).applied}
    for name in ("G_minus_1", "sonine"):
        expression = formulas()[name].expression
        variable = next(iter(expression.atoms(sp.sin, sp.sinh))).args[0].free_symbols
        if len(variable) == 1:
            needed |= {a.rule for a in stabilise(expression, variable.pop(), (1e-150, 1e6)).applied}
    assert needed >= {"conjugate", "logarithm", "fraction", "decay", "balance", "section"}
    applied = [a for e in STRANGERS[:5] for a in stabilise(e, x).applied]
    assert all(a.worst[1] <= 8 for a in applied)
    for rule in (a for a in applied if a.cause != "time"):
        shorter = rule.operations[0] > rule.operations[1]
        assert rule.worst[0] > rule.worst[1] or (rule.worst[0] == rule.worst[1] and shorter)


@pytest.mark.parametrize("name", AUTOMATIC)
def test_paper_formulas_are_reached_by_rules_alone(name: str) -> None:
    steps, value = automatic(formulas()[name].expression, blocks(), SCALES)
    text = " ".join(map(str, (*steps, value)))
    assert "sinh(" not in text.replace("sinh_", "")
    assert "cosh(" not in text


PHI, H, LAM, MU = sp.symbols("phi h lam mu", positive=True)
X = PHI * H
GROWING = (X * (LAM + MU) * sp.sinh(X) + (LAM + 2 * MU) * sp.cosh(X)) / (PHI * (LAM + MU))
QUOTIENTS = (
    # a formula, and what its form must have or not have: 1 apart, or one exponential fewer
    (sp.cosh(X) / sp.sinh(X), "1 +"),
    (sp.sinh(X) / sp.cosh(X), "expm1"),
    (sp.sinh(X) / (sp.sinh(2 * X) + X), "1/"),
    (sp.cosh(X) / (sp.sinh(X) ** 2 - X**2), "sinh_pair"),
    (GROWING * sp.exp(-X), "h*"),
)


def run(formula: sp.Expr, at: dict[sp.Symbol, float]) -> float:
    """A formula's form, as it is printed."""
    steps, value = automatic(formula, blocks(), SCALES)
    names = vars(importlib.import_module("generated.blocks")) | {"times": ranges.times, "np": np}
    known = {str(symbol): np.asarray(number) for symbol, number in at.items()}
    for step in steps:
        known[str(step.symbol)] = eval(to_numpy(step.expression), names, known)
    return float(eval(to_numpy(value), names, known))


@pytest.mark.parametrize(("formula", "sign"), QUOTIENTS)
def test_quotients_of_several_variables(formula: sp.Expr, sign: str) -> None:
    """Forms run as they are printed, against balls of the formula."""
    symbols = sorted(formula.free_symbols, key=str)
    _, value = automatic(formula, blocks(), SCALES)
    assert sign in to_numpy(value), to_numpy(value)
    for phi in (1e-70, 1e-9, 0.3, 0.9999, 1.0, 1.7, 3.4, 11.0, 300.0):
        at = {symbol: phi if symbol == PHI else 0.7 for symbol in symbols}
        got = run(formula, at)
        true = evaluate(formula, at, 25)
        slack = sum(abs(evaluate(formula.diff(s), at, 5) * at[s] / true) / 2 for s in symbols)
        assert ulp_error(got, true) <= 6 + float(slack), phi


def test_a_quotient_that_tends_to_1_is_rounded_but_once_far_out() -> None:
    """1 and a small rest lose half a unit; two sums and their quotient would lose more."""
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
def test_a_product_beyond_the_doubles_gives_the_limit(
    formula: sp.Expr, limits: tuple[float, float], end: int
) -> None:
    size = (1e-200, 1e200)[end]
    with np.errstate(all="ignore"):
        assert run(formula, {PHI: size, H: size}) == pytest.approx(limits[end], rel=1e-15)


def test_unknown_core_is_refused() -> None:
    phi, h = sp.symbols("phi h", positive=True)
    with pytest.raises(UnreachableError, match="no building block"):
        automatic(1 / (sp.cosh(phi * h) - 1 - (phi * h) ** 2 / 3), blocks(), SCALES)
    with pytest.raises(UnreachableError, match="grows as"):
        automatic(GROWING, blocks(), SCALES)
    with pytest.raises(UnreachableError, match="functions of 2 products"):
        automatic(sp.sinh(phi * h) / sp.sinh(phi), blocks(), SCALES)


def test_doubles_are_those_of_this_machine_where_it_rounds_correctly() -> None:
    generator = random.Random(4)
    for _ in range(200):
        point = 10 ** generator.uniform(-6, 2)
        naive = math.sqrt(point + 1) - 1 / (point * point + 3 / point)
        assert rounded(sp.sqrt(x + 1) - 1 / (x * x + 3 / x), {x: point}) == pytest.approx(
            naive, rel=1e-9
        )
    assert rounded(sp.exp(x), {x: 800.0}) == math.inf
    assert rounded(1 / (sp.exp(-x) - 1 + 1), {x: 800.0}) == math.inf
    assert math.isnan(rounded(sp.sin(x), {x: math.inf}))


def test_blocks_have_one_section_each_or_none() -> None:
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
def test_generated_blocks_on_both_sides_of_their_switches(name: str) -> None:
    block = blocks()[name]
    (own,) = block.arguments
    call = getattr(importlib.import_module("generated.blocks"), name)
    at = float(block.value.at) if isinstance(block.value, Switch) else 1.0
    for point in (0.01, 0.3, 0.99, 1.0, 1.4999, math.nextafter(at, 0.0), at, 3.7, 20.0):
        held = sp.Integer(int(at)) if point >= at else own
        definition = block.divided / held**block.held
        true = evaluate(definition, {own: point}, 25)
        slack = abs(evaluate(definition.diff(own), {own: point}, 5) * point / true)
        got = float(call(np.array([point]))[0])
        assert ulp_error(got, true) <= 6 + float(slack) / 2, point
