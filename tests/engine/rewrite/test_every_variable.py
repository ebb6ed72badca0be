"""Forms that the rules find are measured in every variable, and refused where one loses digits."""

import math

import pytest
import sympy as sp

from derivation.engine.formula.proof import prove
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Argument, Vocabulary
from derivation.engine.rewrite.automatic import automatic
from derivation.engine.rewrite.blocks import HYPERBOLIC, built
from derivation.engine.rewrite.every_variable import accurate, measured
from derivation.engine.rewrite.scales import Scale, Scales
from derivation.engine.rewrite.terms import UnreachableError
from derivation.engine.rewrite.useful_range import ENOUGH
from derivation.engine.skeleton.kernels import COSH_MINUS

T, s = sp.symbols("T s", positive=True)
nu = sp.Symbol("nu", real=True)
SOLID = Vocabulary(
    (
        Argument(T, "1", "T", "twice the wave number times the thickness", ("T >= 1e-100",)),
        Argument(nu, "1", r"\nu", "Poisson's ratio", ("nu > -1", "nu < 0.5")),
        Argument(s, "1", "s", "1 - 2 nu", ("s >= 1e-100", "s < 3")),
    )
)
BLOCKS = built(HYPERBOLIC)
SCALES = Scales((Scale(T, T, T),))


class SolidFormula(Record):
    """A formula of two solids on each other."""

    vocabulary = SOLID


def formula(name: str, value: sp.Expr) -> SolidFormula:
    proof = prove("Given", "Given.", {"nothing": sp.Integer(0)})
    return SolidFormula(name, "F", "a deflection", value, "1", "", (), proof)


def bonded(kappa: sp.Expr) -> sp.Expr:
    """Deflection of a bonded film over that of a half-space (kappa = 3 - 4 nu)."""
    above = 2 * kappa * sp.sinh(T) - 2 * T
    return above / (2 * kappa * sp.cosh(T) + 1 + kappa**2 + T**2)


def test_a_form_that_loses_digits_in_another_variable_is_refused() -> None:
    """A thin film that is nearly incompressible: the form is accurate in T for ordinary ones."""
    film = formula("F_bonded", bonded(1 + 2 * s))
    shape = automatic(film.expression, BLOCKS, SCALES)
    message = r"F_bonded has an error of .* ULP at T = .*, s = .*use a variable that is small there"
    with pytest.raises(UnreachableError, match=message):
        accurate(film, *shape, BLOCKS)


def test_what_the_rounding_of_an_argument_does_is_excused() -> None:
    """By Poisson's ratio such a film's compressibility 1 - 2 nu is known to fewer digits itself."""
    film = formula("F_bonded", bonded(3 - 4 * nu))
    shape = automatic(film.expression, BLOCKS, SCALES)
    assert measured(film, *shape, BLOCKS).error <= ENOUGH


def test_a_form_that_is_accurate_in_all_is_given_as_it_is() -> None:
    slipping = formula("F_slipping", (sp.cosh(T) - 1) / (sp.sinh(T) + T))
    known = built((*HYPERBOLIC, COSH_MINUS))
    shape = automatic(slipping.expression, known, SCALES)
    assert accurate(slipping, *shape, known) == shape
    worst = measured(slipping, *shape, known)
    assert worst.error <= ENOUGH
    assert worst.points > 30


def test_a_naive_form_is_noticed() -> None:
    """1 - cos T as it stands, for small T."""
    naive = formula("versine", 1 - sp.cos(T))
    assert measured(naive, (), 1 - sp.cos(T), BLOCKS).error > 1e8
    close = 2 * sp.sin(T / 2) ** 2
    assert measured(naive, (), close, BLOCKS).error <= 4.0


def test_a_form_without_values_is_refused() -> None:
    nowhere = formula("nowhere", sp.sqrt(-1 - T))
    with pytest.raises(UnreachableError, match="has values at 0 test points"):
        measured(nowhere, (), sp.sqrt(-1 - T), BLOCKS)


def test_a_value_that_leaves_the_doubles_counts_as_an_error() -> None:
    """cosh T over sinh T overflows in both for large T."""
    quotient = formula("coth", sp.cosh(T) / sp.sinh(T))
    assert measured(quotient, (), sp.cosh(T) / sp.sinh(T), BLOCKS).error == math.inf
