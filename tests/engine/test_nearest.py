"""Names that are suggested for an unknown name: only similar ones."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from derivation.engine.nearest import _differences, did_you_mean, nearest
from derivation.plate.derived import formulas

WORD = st.text("abc_", min_size=1, max_size=7)


@pytest.mark.parametrize(
    ("name", "known"),
    [
        ("nope", ["G_slope", "K_j", "slope"]),
        ("Max", ["gamma", "cos", "tan"]),
        ("wave", ["w", "v", "save_all"]),
        ("hello", ["help_me", "cell"]),
    ],
)
def test_a_name_that_only_shares_letters_is_not_suggested(name: str, known: list[str]) -> None:
    assert nearest(name, known) == []
    assert did_you_mean(name, known) == ""


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("Kj", "K_j"),
        ("k_J", "K_j"),
        ("G_slop", "G_slope"),
        ("Gslope", "G_slope"),
        ("Gsolpe", "G_slope"),
        ("omega3", "Omega_3"),
        ("Omega_3_scale", "Omega_3_scaled"),
        ("slope", "G_slope"),
        ("delta_varational", "delta_variational"),
    ],
)
def test_a_misspelt_formula_is_suggested(name: str, meant: str) -> None:
    assert nearest(name, formulas(), most=3)[0] == meant


@given(WORD, WORD, WORD)
def test_differences_are_a_distance(one: str, other: str, third: str) -> None:
    """The number is zero for equal words only, and symmetric.

    Because neighbouring letters may be swapped, the triangle inequality has a factor of 2.
    """
    between = _differences(one, other)
    assert (between == 0) == (one == other)
    assert between == _differences(other, one)
    assert abs(len(one) - len(other)) <= between <= max(len(one), len(other))
    assert between <= 2 * (_differences(one, third) + _differences(third, other))


@given(WORD, st.data())
def test_one_wrong_letter_is_one_difference(word: str, data: st.DataObject) -> None:
    index = data.draw(st.integers(0, len(word) - 1))
    assert _differences(word, word[:index] + word[index + 1 :]) == 1
    assert _differences(word, word[:index] + "x" + word[index + 1 :]) == 1
    assert _differences(word, word[:index] + "x" + word[index:]) == 1
    swapped = word[:index] + word[index : index + 2][::-1] + word[index + 2 :]
    assert _differences(word, swapped) == (swapped != word)
