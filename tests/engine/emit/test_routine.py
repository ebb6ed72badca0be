"""The printed code of a routine computes its claim; a routine without proof is rejected."""

import math
from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st
from mutants import of_expression

from derivation.engine.emit.modules import Routines, module_files
from derivation.engine.emit.routine import (
    QUIET_SCALARS,
    SCALARS,
    Choice,
    Let,
    Routine,
    Several,
    Sums,
    routine,
    text,
)
from derivation.engine.formula.proof import ProofError

x, y = sp.symbols("x y", positive=True)
t, u, v = sp.symbols("t u v", real=True)
CLAIM = (sp.exp(x) - 1) / x
EXACT = Several((t,), "np.expm1", (x,), (sp.exp(x) - 1,))


def growth(**changes: object) -> Routine:
    """Return the routine for (e^x - 1)/x, which calls `numpy.expm1`."""
    given = {"statements": (EXACT,), "results": (t / x,), "claims": (CLAIM,)} | changes
    return routine("growth", (x,), summary="Growth.", meaning={}, **given)  # type: ignore[arg-type]


def run(built: Routine, *values: float) -> np.ndarray:
    """Run the printed code."""
    namespace = {"np": np, "Double": np.ndarray}
    exec(text(built), namespace)
    return np.asarray(namespace[built.name](*map(np.asarray, values)))  # type: ignore[operator]


@given(st.floats(1e-3, 50))
def test_printed_code_computes_the_claim(value: float) -> None:
    assert run(growth(), value) == pytest.approx(float(CLAIM.subs(x, value)), rel=1e-12)


@pytest.mark.parametrize("mutant", of_expression(t / x), ids=lambda m: m.name)
def test_wrong_result_is_rejected(mutant: SimpleNamespace) -> None:
    with pytest.raises(ProofError, match=r"growth\[0\]"):
        growth(results=(mutant.expression,))


def test_wrong_intermediate_value_is_rejected() -> None:
    half = Let(u, t / 2, means=(sp.exp(x) - 1) / 2)
    assert growth(statements=(EXACT, half), results=(2 * u / x,)).proof.residuals == (
        "u",
        "growth[0]",
    )
    with pytest.raises(ProofError, match="u leaves"):
        growth(statements=(EXACT, replace(half, expression=t / 3)), results=(2 * u / x,))


def larger(yes: sp.Expr, no: sp.Expr, **more: str) -> Routine:
    """Return the routine for |x - y|, with one expression for x > y and one for x <= y."""
    sides = {sp.Abs(x - y): x - y}, {sp.Abs(x - y): y - x}
    choice = Choice(u, x > y, yes, no, *sides, **more)
    return routine("distance", (x, y), (choice,), (u,), (sp.Abs(x - y),), "Distance.", {})


@given(st.floats(0.1, 9), st.floats(0.1, 9))
def test_each_side_of_a_choice_is_verified_under_its_condition(one: float, two: float) -> None:
    built = larger(x - y, y - x)
    assert len(built.proof.residuals) == 2
    assert run(built, one, two) == abs(one - two)


@pytest.mark.parametrize(
    ("yes", "no", "side"), [(y - x, y - x, "x > y"), (x - y, x - y, "x <= y"), (x, y, "x > y")]
)
def test_wrong_side_is_named(yes: sp.Expr, no: sp.Expr, side: str) -> None:
    with pytest.raises(ProofError, match=side):
        larger(yes, no)


def test_side_without_a_claim_needs_a_reason() -> None:
    assert larger(x - y, sp.Integer(0), unclaimed="no", reason="not for these").proof
    for more in ({"unclaimed": "no"}, {"reason": "no side"}, {"unclaimed": "left", "reason": "?"}):
        with pytest.raises(ValueError, match="expected the side"):
            larger(x - y, y - x, **more)


def test_choices_with_one_condition_share_a_mask() -> None:
    """Only the two combinations that can occur are proved; the other two violate the claim."""
    first, second = (Choice(k, x > y, a, b) for k, a, b in ((u, x, y), (v, y, x)))
    built = routine("product", (x, y), (first, second), (u * v,), (x * y,), "Product.", {})
    assert text(built).count("np.greater") == 1
    assert len(built.proof.residuals) == 2


def test_unused_side_is_evaluated_at_a_safe_value() -> None:
    safe = {v: sp.Integer(1)}
    reason = "has no inverse"
    choice = Choice(u, v > 0, 1 / v, sp.Integer(0), safe_yes=safe, unclaimed="no", reason=reason)
    built = routine("inverse", (v,), (choice,), (u,), (1 / v,), "Inverse.", {})
    with np.errstate(divide="raise"):
        assert run(built, 0.0) == 0.0
    assert run(built, 4.0) == 0.25


def test_condition_that_is_always_true_is_rejected() -> None:
    with pytest.raises(ValueError, match="expected a condition that may fail, got True"):
        Choice(u, x > 0, x, y)


def test_unused_arguments_and_unknown_functions_are_rejected() -> None:
    with pytest.raises(ValueError, match="got y"):
        routine("same", (x, y), (), (x,), (x,), "x.", {})
    called = routine("called", (x,), (Several((t,), "other", (x,), (x,)),), (t,), (x,), "x.", {})
    with pytest.raises(ValueError, match="expected modules for other"):
        module_files([Routines("part", "A part.", (called,), {})])
    built = module_files([Routines("part", "A part.", (called,), {"beside": ("other", "idle")})])
    assert "from .beside import other\n" in built["part.py"]


def test_scale_that_does_not_cancel_is_rejected() -> None:
    scale = Let(u, sp.Max(x, y), opaque=True)
    result = (x / u) / (y / u)
    assert routine("ratio", (x, y), (scale,), (result,), (x / y,), "Ratio.", {}).proof
    with pytest.raises(ProofError):
        routine("ratio", (x, y), (scale,), (x / u / y,), (x / y,), "Ratio.", {})


def mean(result: sp.Expr, claim: sp.Expr = 2 * x * y * t) -> Routine:
    """Return the routine for 2 x times the sum of y t over the rows."""
    total, rows, step = sp.symbols("total rows step")
    sums = Sums((total,), (step * t,), rows, (y, t), (Let(step, x * y),))
    return routine("mean", (x, rows), (sums,), (result,), (claim,), "Sum.", {})


def test_sum_over_rows_is_proved_for_one_row() -> None:
    total = sp.Symbol("total")
    built, namespace = mean(2 * total), {"exp": math.exp, "Sequence": Sequence}
    exec(text(built, SCALARS), namespace)
    assert namespace["mean"](1.5, ((1.0, 3.0), (2.0, 1.0))) == 15.0  # type: ignore[operator]
    with pytest.raises(ProofError, match=r"mean\[0\]"):
        mean(3 * total)
    with pytest.raises(ValueError, match="linear in the totals"):
        mean(total**2)


def test_functions_of_floats_are_printed_without_numpy() -> None:
    built = growth(
        statements=(), results=(sp.sqrt(x + 1) * x**3 / 4 / sp.exp(x),),
        claims=(sp.sqrt(1 + x) * x**3 * sp.exp(-x) / 4,),
    )  # fmt: skip
    namespace: dict[str, object] = {"sqrt": math.sqrt, "exp": math.exp}
    exec(text(built, SCALARS), namespace)
    assert namespace["growth"](4.0) == pytest.approx(16 * 5**0.5 * math.exp(-4))  # type: ignore[operator]
    assert math.isnan(namespace["growth"](1e200))  # type: ignore[operator]


def test_inlined_expression_is_put_in_parentheses() -> None:
    """u = x/3 - 1 is inserted into a product and a function, and has no line of its own."""
    inner = Let(u, x / 3 - 1, within=True)
    result = 2 * u - sp.sin(u) * u
    claim = result.subs(u, x / 3 - 1)
    built = routine("inner", (x,), (inner,), (result,), (claim,), "Inner.", {})
    assert "u" not in text(built).replace("Double", "").replace("value", "").split()
    value = 5.0 / 3 - 1
    assert run(built, 5.0) == pytest.approx(2 * value - np.sin(value) * value, rel=1e-15)


def test_functions_of_floats_raise_or_return_nan_outside_the_domain() -> None:
    built = growth(statements=(), results=(sp.sqrt(x + 1),), claims=(sp.sqrt(1 + x),))
    strict, quiet = ({"sqrt": math.sqrt}, {"np": np})
    exec(text(built, SCALARS), strict)
    exec(text(built, QUIET_SCALARS), quiet)
    assert quiet["growth"](3.0) == strict["growth"](3.0) == 2.0  # type: ignore[operator]
    with pytest.raises(ValueError, match=r"domain|nonnegative"):
        strict["growth"](-2.0)  # type: ignore[operator]
    with np.errstate(invalid="ignore"):
        assert np.isnan(quiet["growth"](-2.0))  # type: ignore[operator]
