"""Copied modules have the lines of the original; budget and domain are added to docstrings."""

import ast
import difflib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from derivation.engine.emit.budgets import Budget
from derivation.engine.emit.copies import copy_text, listed_functions
from derivation.engine.emit.handwritten import expect_imports, manifest_rows
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
def test_copy_has_the_lines_of_its_original(name: str) -> None:
    """Only the header, imports from the package, and notes in docstrings differ."""
    original = ORIGINALS[name].read_text().splitlines()
    copy = (ROOT / "generated" / f"{name}.py").read_text().splitlines()
    removed = [line[2:] for line in difflib.ndiff(original, copy) if line[0] == "-"]
    assert all(line.startswith("from ") for line in removed)
    text, source = (ROOT / "generated" / f"{name}.py").read_text(), ORIGINALS[name].read_text()
    assert _code(text) == _code(source)


def _code(text: str) -> str:
    """Return the syntax tree without docstrings and `from` imports."""
    tree = ast.parse(text)
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            node.body = node.body[ast.get_docstring(node) is not None :]
        if isinstance(node, ast.Module):
            node.body = [part for part in node.body if not isinstance(part, ast.ImportFrom)]
    return ast.dump(tree)


def test_docstring_of_a_copy_states_budget_and_domain(tmp_path: Path) -> None:
    file = tmp_path / "double.py"
    file.write_text(MODULE)
    text = copy_text(file, "generated", "# From here.", {"twice": Budget(2.0, "the value")})
    assert "from .arrays import" in text
    assert "from . import blocks" in text
    docstring = ast.get_docstring(ast.parse(text).body[-1]) or ""  # type: ignore[arg-type]
    assert "2 units in the last place (ULP) of the value." in docstring
    assert "Domain: x > 0." in docstring


def test_notes_are_added_to_functions_without_a_budget(tmp_path: Path) -> None:
    file = tmp_path / "double.py"
    file.write_text(MODULE.replace('@in_manifest(r"2\\,x", domain="x > 0")\n', ""))
    text = copy_text(file, "generated", "# From here.", {}, {"twice": ("Exact.",)})
    docstring = ast.get_docstring(ast.parse(text).body[-1]) or ""  # type: ignore[arg-type]
    assert docstring.endswith("Notes\n-----\nExact.")


def test_manifest_is_read_from_the_docstring(tmp_path: Path) -> None:
    file = tmp_path / "double.py"
    file.write_text(MODULE)
    (actual,) = listed_functions(file)
    (x,) = actual.arguments
    assert (x.name, x.unit, x.meaning) == ("x", "m", "A length")
    assert (actual.symbol, actual.unit, actual.meaning) == (r"2\,x", "m", "twice a length")
    for removed, message in (("A length [m].", "unit in brackets for the argument x"),
                          ("Twice as much [m].", "units of its results")):  # fmt: skip
        file.write_text(MODULE.replace(removed, removed.partition(" [")[0]))
        with pytest.raises(ValueError, match=message):
            listed_functions(file)


NUMBERS = st.one_of(st.integers(-9, 9), st.floats(allow_nan=False, allow_infinity=False))


@given(st.recursive(NUMBERS, lambda part: st.lists(part, max_size=30).map(tuple), max_leaves=60))
def test_printed_tables_evaluate_to_the_original(value: object) -> None:
    assert ast.literal_eval(literal(value)) == value


def test_a_marked_function_computes_a_formula_and_has_a_budget(tmp_path: Path) -> None:
    """Otherwise nothing could be compared with it, and its budget would not be tested."""
    file = tmp_path / "module.py"
    file.write_text(MODULE.replace('domain="x > 0"', 'domain="x > 0", kernel=True'))
    budgets = {"twice": Budget(2.0, "the value")}
    (row,) = manifest_rows("module", file, budgets, {"twice"})
    assert (row["name"], row["arguments"], row["argument_units"]) == ("twice", ("x",), ["m"])
    for known, formulas in ((budgets, set[str]()), ({}, {"twice"})):
        with pytest.raises(ValueError, match=r"got 'twice'; remove the mark"):
            manifest_rows("module", file, known, formulas)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("import scipy.special", "got 'scipy'"),
        ("from .generated.other import f", "got 'other'"),
        ("def (", r"module\.py, line 26: invalid syntax"),
    ],
)
def test_a_copied_module_imports_only_what_the_package_has(
    line: str, message: str, tmp_path: Path
) -> None:
    file = tmp_path / "module.py"
    file.write_text(f"{MODULE}\n{line}\n")
    with pytest.raises(ValueError, match=message):
        expect_imports(file, "generated", {"arrays", "blocks"})
    file.write_text(MODULE)
    expect_imports(file, "generated", {"arrays", "blocks"})
