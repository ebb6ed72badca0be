"""The error of a stable form is measured in every variable; inaccurate forms are rejected."""

import math
import random

import numpy as np
import pytest
import sympy as sp

from derivation.engine.emit.printer import to_numpy
from derivation.engine.formula.proof import prove
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Argument, Vocabulary
from derivation.engine.rewrite.automatic import automatic
from derivation.engine.rewrite.blocks import HYPERBOLIC, Definition, build_blocks
from derivation.engine.rewrite.doubles import rounded_value
from derivation.engine.rewrite.every_variable import accurate, measured_error
from derivation.engine.rewrite.scales import Scale, Scales
from derivation.engine.rewrite.terms import UnreachableError
from derivation.engine.rewrite.useful_range import ENOUGH

T, s = sp.symbols("T s", positive=True)
nu = sp.Symbol("nu", real=True)
SOLID = Vocabulary(
    (
        Argument(T, "1", "T", "twice the wave number times the thickness", ("T >= 1e-100",)),
        Argument(nu, "1", r"\nu", "Poisson's ratio", ("nu > -1", "nu < 0.5")),
        Argument(s, "1", "s", "1 - 2 nu", ("s >= 1e-100", "s < 3")),
    )
)
BLOCKS = build_blocks(HYPERBOLIC)
COSH_MINUS = Definition("cosh_minus", T, 2 * sp.exp(-T) * (sp.cosh(T) - 1), 2, 2, "a difference")
SCALES = Scales((Scale(T, T, T),))


class SolidFormula(Record):
    """A formula with the arguments T, nu and s."""

    vocabulary = SOLID


def formula(name: str, value: sp.Expr) -> SolidFormula:
    proof = prove("Given", "Given.", {"nothing": sp.Integer(0)})
    return SolidFormula(name, "F", "a deflection", value, "1", "", (), proof)


def bonded(kappa: sp.Expr) -> sp.Expr:
    """Return the deflection of a bonded film relative to a half-space (kappa = 3 - 4 nu)."""
    numerator = 2 * kappa * sp.sinh(T) - 2 * T
    return numerator / (2 * kappa * sp.cosh(T) + 1 + kappa**2 + T**2)


def test_form_that_loses_digits_in_another_variable_is_rejected() -> None:
    """The form is accurate in T for most values of s, but not for a nearly incompressible film."""
    film = formula("F_bonded", bonded(1 + 2 * s))
    steps_and_value = automatic(film.expression, BLOCKS, SCALES)
    message = (
        r"F_bonded has an error of .* ULP at T = .*, s = .*narrow the domains of its arguments"
    )
    with pytest.raises(UnreachableError, match=message):
        accurate(film, *steps_and_value, BLOCKS)


def test_error_from_rounding_of_an_argument_is_allowed() -> None:
    """If nu is the argument, 1 - 2 nu of such a film has few correct digits in any form."""
    film = formula("F_bonded", bonded(3 - 4 * nu))
    steps_and_value = automatic(film.expression, BLOCKS, SCALES)
    assert measured_error(film, *steps_and_value, BLOCKS).error <= ENOUGH


def test_form_that_is_accurate_in_all_variables_is_accepted() -> None:
    slipping = formula("F_slipping", (sp.cosh(T) - 1) / (sp.sinh(T) + T))
    known = build_blocks((*HYPERBOLIC, COSH_MINUS))
    steps_and_value = automatic(slipping.expression, known, SCALES)
    worst = measured_error(slipping, *steps_and_value, known)
    assert accurate(slipping, *steps_and_value, known) == worst.error <= ENOUGH
    assert worst.points > 30


def test_error_of_an_unstable_form_is_measured() -> None:
    """1 - cos T cancels for small T; 2 sin^2(T/2) does not."""
    naive = formula("versine", 1 - sp.cos(T))
    assert measured_error(naive, (), 1 - sp.cos(T), BLOCKS).error > 1e8
    stable = 2 * sp.sin(T / 2) ** 2
    assert measured_error(naive, (), stable, BLOCKS).error <= 4.0


def test_form_without_real_values_is_rejected() -> None:
    nowhere = formula("nowhere", sp.sqrt(-1 - T))
    with pytest.raises(UnreachableError, match="has values at 0 test points"):
        measured_error(nowhere, (), sp.sqrt(-1 - T), BLOCKS)


def test_overflow_counts_as_an_infinite_error() -> None:
    """Both cosh T and sinh T overflow for large T, but their quotient does not."""
    quotient = formula("coth", sp.cosh(T) / sp.sinh(T))
    assert measured_error(quotient, (), sp.cosh(T) / sp.sinh(T), BLOCKS).error == math.inf


@pytest.mark.parametrize(
    "expression",
    [
        -T * s**3 / (12 * (nu - 1) * (nu + 1)),
        5 * s * T / (7 * nu),
        sp.Rational(3, 8) * s**2 * sp.exp(-T) / sp.sqrt(T),
        T * s / 5040,
        -(T**2) * (s + 1) / 3,
    ],
)
def test_forms_are_tested_in_the_order_of_the_code(expression: sp.Expr) -> None:
    draw = random.Random(str(expression))
    for _ in range(200):
        at = {T: 10 ** draw.uniform(-2, 2), s: 10 ** draw.uniform(0, 100), nu: draw.uniform(-1, 1)}
        numbers = {str(symbol): np.float64(x) for symbol, x in at.items()}
        with np.errstate(over="ignore"):
            printed = eval(to_numpy(expression), {"np": np, **numbers})
        assert float(printed) == pytest.approx(rounded_value(expression, at), rel=5e-16)
