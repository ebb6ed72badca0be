"""The steps of the derivation have the numbers that texts state."""

import inspect
import re
import sys

import pytest

from derivation.plate import chain

ALL = [*chain.STEPS, *chain.MOTION_STEPS]
NUMBERED = [
    (number, name, step)
    for number, (name, step) in enumerate(ALL, start=1)
    if inspect.unwrap(step).__module__ != chain.__name__
]
"""Numbers, names and functions of the steps that are derived in a module of `theory`."""


def test_the_list_of_steps_is_complete_and_in_order() -> None:
    listed = re.findall(r"^ ?(\d+) (.+)$", chain.__doc__ or "", re.MULTILINE)
    assert [int(number) for number, _ in listed] == list(range(1, len(ALL) + 1))
    for (name, _), (_, line) in zip(ALL, listed, strict=True):
        assert line.startswith(f"{name} ")


@pytest.mark.parametrize(
    ("number", "name", "step"), NUMBERED, ids=[name for _, name, _ in NUMBERED]
)
def test_the_theory_of_a_step_states_its_number(number: int, name: str, step: object) -> None:
    module = sys.modules[inspect.unwrap(step).__module__]  # type: ignore[arg-type]
    stated = re.match(r"Steps? (\d+)(?: to (\d+))?", module.__doc__ or "")
    assert stated, f"{name}: expected the docstring of {module.__name__} to begin with its step"
    first, last = int(stated[1]), int(stated[2] or stated[1])
    assert first <= number <= last
