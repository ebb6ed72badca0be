"""`import platecontact`: public names, their documentation and examples, and imported modules."""

import doctest
import importlib
import importlib.metadata
import math
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import platecontact
import pytest
import sympy as sp

from derivation.engine.files import ROOT
from derivation.scene.input.example_scenes import copy


def test_package_does_not_import_itself_as_derivation_api() -> None:
    """In an installed copy the folder is named `platecontact`, not `derivation/api`."""
    folder = Path(platecontact.__file__).parent
    for path in folder.glob("*.py"):
        assert "derivation.api" not in path.read_text(), path


def test_public_names_are_listed_and_documented() -> None:
    assert dir(platecontact) == sorted(platecontact.__all__)
    for name in platecontact.__all__:
        assert getattr(platecontact, name).__doc__, name


def test_package_has_its_version() -> None:
    assert platecontact.__version__ == importlib.metadata.version("platecontact")


def test_docstrings_of_tables_describe_every_key() -> None:
    for name in platecontact.__all__:
        table = getattr(platecontact, name)
        section = (table.__doc__ or "").partition("Parameters\n")[2].partition("Examples\n")[0]
        for key in getattr(table, "model_fields", ()):
            assert re.search(rf"^ *([\w, ]+, )?{key}(,|$)", section, re.MULTILINE), f"{name}.{key}"


def test_formulas_and_digits_show_themselves_as_text_and_in_notebooks() -> None:
    findings = platecontact.misprints()
    assert f"\n{findings[1]}\n" in str(findings)
    assert findings._repr_html_().count("<tr>") == len(findings) + 1
    assert "import numpy" in platecontact.rewrite("exp(x) - 1")._repr_html_()
    scene = platecontact.load(ROOT / "derivation" / "scene" / "examples" / "paper.toml")
    digits = platecontact.reference(scene, digits=20)
    assert str(digits).startswith("contact time [s]\n  0.00880816")
    assert str(digits) in digits._repr_html_()


def test_formulas_may_be_sympy_expressions() -> None:
    x = sp.Symbol("x")
    stable = platecontact.rewrite((x - sp.sin(x)) / x**3, where="x < 1")
    assert stable.source == platecontact.rewrite("(x - sin(x))/x**3", where=["x < 1"]).source
    force = platecontact.formula("P").expression
    assert platecontact.diagnose("P", force).verdict == "equal"
    assert platecontact.diagnose("P", 2 * force).verdict == "different"


def test_a_point_may_be_a_mapping() -> None:
    text = "16*mu*(lam + mu)*a**3/(3*R*(lam + 2*mu))"
    given = platecontact.diagnose("P", text, at={"a": 0.001, "R": "0.2"})
    assert given == platecontact.diagnose("P", text, at="a=0.001,R=0.2")
    assert dict(given.point)["a"] == "0.001"


@pytest.mark.parametrize(
    ("call", "expected"),
    [
        (lambda: platecontact.formula(3), "no formula 3"),
        (lambda: platecontact.load(3), "expected the path of a file, got 3"),
        (lambda: platecontact.explain(3), "expected a Scene, got 3"),
        (lambda: platecontact.reference(3), "expected a Scene, got 3"),
        (lambda: platecontact.diagnose(3, "a"), "no formula '3'"),
        (lambda: platecontact.diagnose("P", "a**3", at=3), "expected a point like"),
        (lambda: platecontact.diagnose("P", "a**3", at={1: 2}), "unknown symbol"),
        (lambda: platecontact.diagnose("P", "a**3", at={"a": math.nan}), "expected a decimal"),
    ],
)
def test_arguments_of_a_wrong_type_are_rejected(call: Any, expected: str) -> None:
    with pytest.raises((KeyError, ValueError), match=expected):
        call()


def test_unknown_name_raises_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="'platecontact' has no attribute 'simulat'"):
        platecontact.simulat  # noqa: B018


@pytest.mark.parametrize("module", ["platecontact", "derivation.scene.output.export"])
def test_examples_of_modules_pass(module: str) -> None:
    outcome = doctest.testmod(importlib.import_module(module))
    assert outcome.attempted > 0
    assert outcome.failed == 0


@pytest.mark.parametrize("name", platecontact.__all__)
def test_each_public_name_has_an_example_that_passes(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The examples of a class include those of its methods; some read `glass_pane.toml`."""
    copy(["glass_pane"], tmp_path)
    monkeypatch.chdir(tmp_path)
    public = getattr(platecontact, name)
    module = importlib.import_module(public.__module__)
    runner = doctest.DocTestRunner()
    for test in doctest.DocTestFinder().find(public, name, module=module, globs=dict(vars(module))):
        runner.run(test)
    assert runner.tries > 0
    assert runner.failures == 0


def test_schema_describes_each_table_in_one_line() -> None:
    """The description is the first line of the class docstring."""
    schema = platecontact.schema()
    texts = {name: entry["description"] for name, entry in schema["$defs"].items()}
    texts["Scene"] = schema["description"]
    assert {"Scene", "Sphere", "Plate", "Measured"} <= texts.keys()
    for name, text in texts.items():
        assert text == getattr(platecontact, name).__doc__.partition("\n")[0]
        assert text.endswith(".")


def test_simulation_does_not_import_slow_packages(tmp_path: Path) -> None:
    """The program runs in a folder outside the checkout."""
    program = (
        "import sys, platecontact as pc\n"
        "scene = pc.read({'sphere': {'radius': 0.01, 'material': 'steel'},\n"
        "    'plate': {'radius': 0.3, 'thickness': 0.05, 'material': 'glass'},\n"
        "    'impact': {'speed': 1.0}})\n"
        "assert 0 < pc.simulate(scene).restitution < 1\n"
        "heavy = {'sympy', 'flint', 'mpmath', 'pandas', 'xarray', 'matplotlib'}\n"
        "assert not heavy & set(sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", program], cwd=tmp_path, check=True)
