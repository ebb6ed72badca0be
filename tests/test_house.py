"""Rules of the code: layers, modules, imports, packaging, names of classes, and version."""

import ast
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from importlinter.cli import lint_imports

from derivation.engine.files import ROOT

HAND_WRITTEN = sorted(
    path for folder in ("derivation", "tests") for path in (ROOT / folder).rglob("*.py")
)


def test_modules_import_only_lower_layers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    assert lint_imports(config_filename=str(ROOT / "pyproject.toml"), no_cache=True) == 0


def test_modules_have_docstrings_and_at_most_400_lines() -> None:
    texts = {str(path.relative_to(ROOT)): path.read_text() for path in HAND_WRITTEN}
    assert not [name for name, text in texts.items() if not ast.get_docstring(ast.parse(text))]
    assert not [name for name, text in texts.items() if len(text.splitlines()) > 400]


def test_command_line_imports_no_slow_package() -> None:
    program = """
import sys
import tomllib
import derivation, derivation.cli
heavy = {"sympy", "numpy", "flint", "mpmath", "jinja2"} & set(sys.modules)
assert not heavy, heavy
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def test_every_package_is_installed() -> None:
    with (ROOT / "pyproject.toml").open("rb") as stream:
        listed = set(tomllib.load(stream)["tool"]["setuptools"]["packages"])
    actual = {
        ".".join(path.parent.relative_to(ROOT).parts)
        for folder in ("derivation", "generated")
        for path in (ROOT / folder).rglob("__init__.py")
    }
    # The public API is installed under the distribution's name.
    assert listed == actual - {"derivation.api"} | {"derivation.data", "platecontact"}


def test_every_imported_package_is_a_dependency() -> None:
    """Other programs with which `plate/benchmark` compares are optional."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    names = {re.split(r"[<>=!]", text)[0].lower() for text in project["dependencies"]}
    allowed = (
        names | sys.stdlib_module_names | {"derivation", "generated", "flint", "pydantic_core"}
    )
    assert {"python-flint", "pydantic"} <= names
    for path in (ROOT / "derivation").rglob("*.py"):
        if "benchmark" in path.parts:
            continue
        for node in ast.walk(ast.parse(path.read_text())):
            actual = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom) and not node.level:
                actual = [node.module or ""]
            assert {name.partition(".")[0] for name in actual} <= allowed, path


SHARED = {"Formula": "each paper names the class of its formulas like this"}
"""Names that several classes may have, with the reason."""


def test_class_names_are_unique() -> None:
    """Public names in `scene` and names in the copied modules are excluded."""
    actual: dict[str, list[Path]] = {}
    for path in sorted((ROOT / "derivation").rglob("*.py")):
        if not {"scene", "runtime"} & set(path.parts):
            for node in ast.parse(path.read_text()).body:
                if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                    actual.setdefault(node.name, []).append(path)
    assert {name for name, paths in actual.items() if len(paths) > 1} == set(SHARED)


def test_citation_states_the_version() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    lines = (ROOT / "CITATION.cff").read_text().splitlines()
    assert f"title: {project['name']}" in lines
    assert f"version: {project['version']}" in lines
