"""Proofs: identities that are true, or almost true, in one range only are rejected."""

from collections.abc import Callable

import pytest
import sympy as sp

from derivation.engine.formula.proof import (
    BY_BALLS,
    SYMBOLIC,
    ProofError,
    decide_zero,
    far_points,
    prove,
)

T = sp.Symbol("T", positive=True)
x = sp.Symbol("x", real=True)
y = sp.Symbol("y")


@pytest.mark.parametrize(
    ("residual", "where"),
    [
        (sp.Abs(x) - x, "x = -"),
        (sp.sqrt(y**2) - y, "y = -"),
        (sp.atan(x) + sp.atan(1 / x) - sp.pi / 2, "x = -"),
        (sp.asin(sp.sin(T / 2)) - T / 2, "T = "),
        (sp.sqrt((T - 3) ** 2) - (3 - T), "T = "),
        (sp.tanh(2000 * T) - 1, "T = "),
        (sp.erf(100 * T) - 1, "T = "),
        (sp.tanh(10**15 * T) - 1, "T = "),
        (sp.Integral(sp.tanh(x), (x, 0, T)) - T, "T = "),
        (sp.Integral(sp.exp(-x), (x, 0, sp.oo)) - 1 + sp.exp(-300 * T), "T = "),
    ],
    ids=str,
)
def test_identities_that_are_false_in_a_part_of_their_domain_are_rejected(
    residual: sp.Expr, where: str
) -> None:
    with pytest.raises(ProofError, match=rf"step: part leaves the residual .* not 0 at {where}"):
        prove("step", "argument", {"part": residual})


def test_identities_that_hold_for_every_sign_and_magnitude_are_accepted() -> None:
    assert decide_zero(sp.sqrt(x**2) - sp.Abs(x)) == SYMBOLIC
    assert decide_zero(sp.sin(x + y) - sp.sin(x) * sp.cos(y) - sp.cos(x) * sp.sin(y)) == BY_BALLS
    assert decide_zero(sp.atan(T) + sp.atan(1 / T) - sp.pi / 2) == BY_BALLS
    assert decide_zero(sp.Integral(sp.cos(x), (x, 0, T)) - sp.sin(T)) == BY_BALLS


def test_an_identity_may_hold_where_given_expressions_are_positive() -> None:
    quotient = sp.atan((x - y) / (1 + x * y))
    difference = sp.atan(x) - sp.atan(y) - quotient
    assert decide_zero(difference) is None  # it fails for x y < -1
    assert decide_zero(difference, (x, y)) == BY_BALLS
    assert decide_zero(difference, (-x, -y)) == BY_BALLS
    assert decide_zero(sp.sqrt(x**2) - sp.Abs(x) + sp.sin(y) * 0, (y,)) == SYMBOLIC
    assert decide_zero(sp.atan(x) + sp.atan(1 / x) - sp.pi / 2, (x, y)) == BY_BALLS


def test_far_points_have_the_signs_of_the_assumptions_and_many_magnitudes() -> None:
    negative = sp.Symbol("n", nonpositive=True)
    points = far_points({T, x, negative}, 36, 30)
    assert all(point[T] > 0 and point[negative] < 0 for point in points)
    assert {point[x] > 0 for point in points} == {True, False}
    assert min(point[T] for point in points) < 1e-6
    assert max(point[T] for point in points) > 1e6
    assert points == far_points({negative, x, T}, 36, 30)


def test_a_proof_without_residuals_is_rejected() -> None:
    with pytest.raises(ValueError, match="step: expected residuals"):
        prove("step", "argument", {})


@pytest.mark.parametrize("residual", [True, sp.Eq(x, x), 0.0, None, sp.zeros(2, 1)], ids=repr)
def test_a_residual_that_is_no_expression_is_rejected(residual: object) -> None:
    with pytest.raises(TypeError, match=r"part, got a .*write the difference of both sides"):
        prove("step", "argument", {"part": residual})


def test_an_integer_is_a_residual() -> None:
    assert prove("step", "argument", {"part": 0}).method == SYMBOLIC
    with pytest.raises(ProofError, match=r"part leaves the residual 1$"):
        prove("step", "argument", {"part": 1})


# --- claims: the expressions that residuals determine


def test_a_proof_states_the_expressions_that_its_residuals_determine() -> None:
    proof = prove("step", "argument", lambda f: {"slope": sp.diff(f, T) - 2 * T}, T**2)
    assert proof.determines
    assert proof.claims == (T**2,)
    assert not prove("step", "argument", {"slope": sp.diff(T**2, T) - 2 * T}).determines


@pytest.mark.parametrize(
    ("residuals", "where"),
    [
        (
            lambda f: {"other": sp.sin(T) ** 2 + sp.cos(T) ** 2 - 1 + 0 * f},
            r"T\*\*2, but .* by 998/997",
        ),
        (lambda f: {"homogeneous": T * sp.diff(f, T) - 2 * f}, r"T\*\*2, but .* by 998/997"),
        (lambda f: {"at one point": f.subs(T, 3) - 9}, r"T\*\*2 at every T, but .* by T/997 \+ 1"),
        (lambda f: {"limit": sp.limit(f, T, 0)}, r"T\*\*2, but .* by 998/997"),
    ],
    ids=["unrelated", "homogeneous", "one point", "limit"],
)
def test_residuals_that_do_not_determine_a_claim_are_rejected(
    residuals: Callable[[sp.Expr], dict[str, sp.Expr]], where: str
) -> None:
    with pytest.raises(ProofError, match=rf"step: expected residuals that determine {where}"):
        prove("step", "argument", residuals, T**2)


def test_every_claim_of_several_must_be_determined() -> None:
    with pytest.raises(ProofError, match=r"determine T, but"):
        prove("step", "argument", lambda *claims: {"square": claims[0] - T**2}, T**2, T)


def test_a_substituted_symbol_and_an_integrand_are_determined() -> None:
    prove("step", "argument", lambda f: {"at y": f.subs(T, sp.exp(x)) - sp.exp(2 * x)}, T**2)
    integral = sp.Integral(sp.exp(-x * T), (x, 0, sp.oo))
    prove("step", "argument", lambda f: {"of x": f.function - sp.exp(-x * T)}, integral)
    with pytest.raises(ProofError, match="at every x"):
        prove("step", "argument", lambda f: {"at 0": f.function.subs(x, 0) - 1}, integral)
