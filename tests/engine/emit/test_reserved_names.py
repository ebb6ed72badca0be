"""Names that the generated code uses itself are rejected."""

from dataclasses import replace

import pytest
import sympy as sp

from derivation.engine.emit.names import expect_free_names
from derivation.engine.formula.proof import prove
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Argument, Vocabulary


def formula(name: str, argument: str) -> Record:
    """Return the formula that a quantity is equal to its argument."""
    symbol = sp.Symbol(argument, positive=True)

    class Formula(Record):
        vocabulary = Vocabulary((Argument(symbol, "1", "x", "", ()),))

    return Formula(name, "f", "value", symbol, "1", "", (), prove("step", "same", {"zero": 0}))


@pytest.mark.parametrize(
    ("name", "argument", "used"),
    [("np", "x", "np"), ("times", "x", "times"), ("f", "kind", "kind"), ("f", "sinh", "sinh")],
)
def test_names_of_the_generated_code_are_rejected(name: str, argument: str, used: str) -> None:
    with pytest.raises(ValueError, match=rf"{name}: expected another name than {used}, .* rename"):
        expect_free_names(["one"], [formula(name, argument)], ["sinh"])


def test_other_names_are_accepted() -> None:
    expect_free_names(["one", "two"], [formula("kind", "x"), formula("f", "numerator")], ["sinh"])


def test_a_constant_is_rejected() -> None:
    constant = replace(formula("f", "x"), expression=sp.sqrt(sp.pi))
    with pytest.raises(ValueError, match="f: expected a formula with arguments, got a constant"):
        expect_free_names(["one"], [constant], [])


@pytest.mark.parametrize("modules", [["blocks"], ["one", "one"], ["a b"]])
def test_modules_have_names_of_their_own(modules: list[str]) -> None:
    with pytest.raises(ValueError, match=rf"other than arrays, .* got '{modules[-1]}'; rename it"):
        expect_free_names(modules, [], [])
