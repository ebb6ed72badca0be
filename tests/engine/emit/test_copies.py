"""Copies of modules written by hand: the lines of the original, and what its functions promise."""

import ast
import difflib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from derivation.engine.emit.budgets import Budget
from derivation.engine.emit.copies import copied, listed_functions
from derivation.engine.emit.package import RUNTIME
from derivation.engine.emit.tables import literal
from derivation.engine.files import ROOT
from derivation.plate.modules import runtime_files

ORIGINALS = {path.stem: path for path in RUNTIME.glob("[a-z]*.py")} | runtime_files()
MODULE = '''"""A module.

Arithmetic: one product.
"""

from generated.arrays import Double, in_manifest
from generated import blocks


@in_manifest(r"2\\,x", domain="x > 0")
def twice(x: Double) -> Double:
    """Twice a length.

    Parameters
    ----------
    x : array_like
        A length [m].

    Returns
    -------
    ndarray
        Twice as much [m].
    """
    return 2.0 * x
'''


@pytest.mark.parametrize("name", ORIGINALS)
def test_a_copy_has_the_lines_of_its_original(name: str) -> None:
    """But for the header, imports from the package, and notes in docstrings."""
    original = ORIGINALS[name].read_text().splitlines()
    copy = (ROOT / "generated" / f"{name}.py").read_text().splitlines()
    changes = [line for line in difflib.ndiff(original, copy) if line[0] in "+-"]
    gone = [line[2:] for line in changes if line[0] == "-"]
    assert all(line.startswith("from ") for line in gone)
    text, source = (ROOT / "generated" / f"{name}.py").read_text(), ORIGINALS[name].read_text()
    assert _code(text) == _code(source)


def _code(text: str) -> str:
    """The syntax tree without docstrings and imports."""
    tree = ast.parse(text)
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            node.body = node.body[ast.get_docstring(node) is not None :]
        if isinstance(node, ast.Module):
            node.body = [part for part in node.body if not isinstance(part, ast.ImportFrom)]
    return ast.dump(tree)


def test_a_copy_promises_the_budget_and_the_domain(tmp_path: Path) -> None:
    file = tmp_path / "double.py"
    file.write_text(MODULE)
    text = copied(file, "generated", "# From here.", {"twice": Budget(2.0, "the value")})
    assert "from .arrays import" in text
    assert "from . import blocks" in text
    docstring = ast.get_docstring(ast.parse(text).body[-1]) or ""  # type: ignore[arg-type]
    assert "2 units in the last place (ULP) of the value." in docstring
    assert "Domain: x > 0." in docstring


def test_a_copy_says_of_other_functions_what_it_is_told(tmp_path: Path) -> None:
    file = tmp_path / "double.py"
    file.write_text(MODULE.replace('@in_manifest(r"2\\,x", domain="x > 0")\n', ""))
    text = copied(file, "generated", "# From here.", {}, {"twice": ("Exact.",)})
    docstring = ast.get_docstring(ast.parse(text).body[-1]) or ""  # type: ignore[arg-type]
    assert docstring.endswith("Notes\n-----\nExact.")


def test_what_the_manifest_says_comes_from_the_function(tmp_path: Path) -> None:
    file = tmp_path / "double.py"
    file.write_text(MODULE)
    (found,) = listed_functions(file)
    (x,) = found.arguments
    assert (x.name, x.unit, x.meaning) == ("x", "m", "A length")
    assert (found.symbol, found.unit, found.meaning) == (r"2\,x", "m", "twice a length")
    for gone, message in (("A length [m].", "unit in brackets for the argument x"),
                          ("Twice as much [m].", "units of its results")):  # fmt: skip
        file.write_text(MODULE.replace(gone, gone.partition(" [")[0]))
        with pytest.raises(ValueError, match=message):
            listed_functions(file)


NUMBERS = st.one_of(st.integers(-9, 9), st.floats(allow_nan=False, allow_infinity=False))


@given(st.recursive(NUMBERS, lambda part: st.lists(part, max_size=30).map(tuple), max_leaves=60))
def test_tables_read_back_as_they_were(value: object) -> None:
    assert ast.literal_eval(literal(value)) == value
