"""Every public function of the generated package has an example, and all examples pass."""

import doctest
import importlib
import inspect

import pytest

import generated
from generated import as_printed

MODULE = as_printed.__name__
MODULES = {name: module for module, names in generated._MODULES.items() for name in names}
WITH_EXAMPLES = sorted(
    {*MODULES.values(), "as_printed", "edge_modes", "impact", "non_hertzian_pressure",
     "perturbation", "plate_waves", "prepared_plate", "simple_impact"}
)  # fmt: skip


@pytest.mark.parametrize("name", sorted(generated.__all__))
def test_every_public_function_has_an_example(name: str) -> None:
    assert "Examples\n" in (getattr(generated, name).__doc__ or "")


def test_published_formulas_are_described_like_the_derived_ones() -> None:
    functions = [f for f in vars(as_printed).values() if getattr(f, "__module__", "") == MODULE]
    assert functions
    for function in functions:
        text = inspect.getdoc(function) or ""  # Python 3.13 strips the indentation itself
        for section in ("Parameters", "Returns", "Notes", "Examples"):
            assert f"\n{section}\n---" in text, function.__name__


@pytest.mark.parametrize("module", WITH_EXAMPLES)
def test_examples_pass(module: str) -> None:
    outcome = doctest.testmod(importlib.import_module(f"generated.{module}"))
    assert outcome.attempted
    assert not outcome.failed
