"""Proofs of stated forms: limits and absolute values in a form are not ignored."""

import pytest
import sympy as sp

from derivation.engine.formula.proof import SYMBOLIC, ProofError
from derivation.engine.rewrite.form import FAR, TINY, Step, form, limited

T, X, z = sp.symbols("T X z", positive=True)
x = sp.Symbol("x", real=True)


def prove_form(formula: sp.Expr, steps: tuple[Step, ...], value: sp.Expr) -> str:
    """Return the method by which the form is proved."""
    return form("f", "module", formula, steps, value, {}).proof.method


def test_the_absolute_value_of_an_argument_is_accepted_in_even_functions_only() -> None:
    even = sp.cosh(x) / (1 + x**2)
    assert prove_form(even, (Step(z, sp.Abs(x)),), sp.cosh(z) / (1 + z**2)) == SYMBOLIC
    for formula in (x, sp.sinh(x), x**3 + x**2):
        with pytest.raises(ProofError, match="everywhere, x < 0 leaves the residual"):
            prove_form(formula, (), formula.xreplace({x: sp.Abs(x)}))


def test_limits_of_the_range_of_doubles_are_ignored() -> None:
    assert prove_form(sp.exp(-T), (Step(X, limited(T, FAR)),), sp.exp(-X)) == SYMBOLIC
    assert prove_form(T, (), sp.Max(TINY, T)) == SYMBOLIC
    assert prove_form(3 * T, (), sp.Max(TINY, 3 * T)) == SYMBOLIC


@pytest.mark.parametrize(
    ("formula", "value"),
    [
        (sp.Integer(1), sp.Max(TINY, T)),
        (3 * T, sp.Max(TINY, sp.Min(T, 3))),
        (T, sp.Max(TINY, sp.Min(T, 3))),
        (T, sp.Min(T, 3)),
    ],
    ids=str,
)
def test_other_limits_are_not_ignored(formula: sp.Expr, value: sp.Expr) -> None:
    with pytest.raises(ProofError, match="everywhere leaves the residual"):
        prove_form(formula, (), value)
