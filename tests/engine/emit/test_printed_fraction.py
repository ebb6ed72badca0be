"""The count of arithmetic operations, and the fraction printed from proved expressions."""

import pytest

from derivation.engine.emit.printed_fraction import (
    arithmetic_of_modules,
    expect_printed_fraction,
    expect_reason,
    operations,
    printed_fraction,
)
from derivation.plate.budgets import counted_modules, read_printed_fraction
from derivation.plate.paper import PAPER

BY_HAND = '''"""A sum.

Arithmetic: one product
and one sum.

More.
"""

def f(x):
    return 2 * x + 1
'''


def test_operations_are_counted() -> None:
    assert operations("y = -a * b + np.exp(c)\ny += 2\nz: int | None = -1\n") == 5
    assert operations("third = -1 / 3\n") == 0, "a constant is not an operation"


def test_hand_written_module_is_recognised_by_its_docstring() -> None:
    actual = arithmetic_of_modules(
        {"by_hand": BY_HAND, "printed": "y = a * b\n", "none": "y = 1\n"}
    )
    assert [(module.module, module.operations, module.printed) for module in actual] == [
        ("by_hand", 2, False), ("printed", 1, True),
    ]  # fmt: skip
    assert actual[0].reason == "one product and one sum."
    assert printed_fraction(actual) == 1 / 3
    expect_printed_fraction(actual, 1 / 3)
    with pytest.raises(ValueError, match=r"at least 40\.0 % .*, got 33\.3 %"):
        expect_printed_fraction(actual, 0.4)


def test_module_with_arithmetic_must_give_a_reason() -> None:
    expect_reason("sums", BY_HAND)
    expect_reason("names", '"""No arithmetic."""\n')
    with pytest.raises(ValueError, match=r"sums: expected a docstring paragraph .* 'Arithmetic:'"):
        expect_reason("sums", BY_HAND.replace("Arithmetic", "Sums"))


def test_committed_fraction_agrees_with_the_package() -> None:
    files = PAPER.package_folder.glob("*.py")
    sources = {path.stem: path.read_text() for path in files}
    fraction = printed_fraction(arithmetic_of_modules(counted_modules(sources)))
    assert read_printed_fraction() <= fraction < read_printed_fraction() + 0.01, (
        "raise `[package] printed` in budgets.toml"
    )
