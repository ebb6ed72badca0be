"""The generated package is reproducible, up to date, and needs only NumPy."""

import importlib
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import generated
from derivation.engine import build
from derivation.engine.emit.freshness import compare
from derivation.engine.files import PACKAGE, ROOT, sources
from derivation.engine.package import files_of
from derivation.plate.budgets import read_budgets
from derivation.plate.paper import PAPER
from generated.manifest import CONTACT, KERNELS

KERNEL = {row["name"]: row for row in KERNELS}


def test_package_is_up_to_date() -> None:
    freshness = build.check_generated(PAPER, None, "platecontact generate")
    assert freshness.fresh, str(freshness)


@pytest.mark.parametrize("change", ["delete", "edit", "add"])
def test_changed_files_are_reported_with_the_remedy(change: str, tmp_path: Path) -> None:
    copy = tmp_path / "generated"
    shutil.copytree(ROOT / "generated", copy, ignore=shutil.ignore_patterns("__pycache__"))
    expected = files_of(PAPER.chain, PAPER.package())
    assert compare(copy, expected, "regenerate").fresh
    if change == "delete":
        (copy / "omega.py").unlink()
    elif change == "edit":
        text = (copy / "omega.py").read_text()
        (copy / "omega.py").write_text(text.replace("np.exp(", "np.cos(", 1))
    else:
        (copy / "extra.py").write_text("")
    diagnosis = compare(copy, expected, "regenerate")
    assert not diagnosis.fresh
    remedy = "rm " if change == "add" else "regenerate"
    assert f"run: {remedy}" in str(diagnosis)
    assert ("+" in diagnosis.diffs["omega.py"]) if change == "edit" else not diagnosis.diffs


def test_package_needs_only_numpy(tmp_path: Path) -> None:
    """Import a copy under another name in a process that cannot import this project."""
    shutil.copytree(ROOT / "generated", tmp_path / "plate")
    program = """
import sys
import numpy
before = set(sys.modules)
sys.path.insert(0, sys.argv[1])
import plate
new = {name.split(".")[0] for name in set(sys.modules) - before} - set(sys.stdlib_module_names)
assert new <= {"plate", "numpy"}, new
assert not {"derivation", "generated", "sympy", "scipy"} & set(sys.modules)
print(float(plate.G(1.0)), float(plate.delta(0.01, 0.1, 0.13, 0.004, modes=50)))
"""
    done = subprocess.run(
        [sys.executable, "-I", "-c", program, tmp_path], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    values = [float(word) for word in done.stdout.split()]
    assert values == [generated.G(1.0), generated.delta(0.01, 0.1, 0.13, 0.004, modes=50)]


def test_budgets_and_functions_have_the_same_names() -> None:
    assert set(read_budgets()) == {row["name"] for row in (*KERNELS, *CONTACT)}
    contact = {row["name"] for row in CONTACT if row["module"] != "impact"}
    assert set(generated.__all__) == set(KERNEL) | contact


@pytest.mark.parametrize("row", [*KERNELS, *CONTACT], ids=lambda row: row["name"])
def test_manifest_and_docstring_state_the_budget(row: dict) -> None:
    budget = read_budgets()[row["name"]]
    assert (row["budget"], row["rule"]) == (budget.ulp, budget.rule)
    kernel = getattr(importlib.import_module(f"generated.{row['module']}"), row["name"])
    shown = " ".join(kernel.__doc__.split())
    assert f"{budget.ulp:g} unit" in shown
    assert f" in the last place (ULP) of {budget.rule}." in shown
    assert f"Domain: {row['domain'] or 'all real numbers'}." in shown


def test_sums_do_not_depend_on_the_blocks_of_modes() -> None:
    """Sums with the number of modes around the block size equal the sum of the single modes."""
    arguments = (0.01, 0.1, 0.13, 0.004)
    sums = [generated.delta(*arguments, modes=n) for n in (127, 128, 129, 257)]
    j, J1 = generated.bessel_j0_zeros(257), generated.bessel_j1_at_j0_zeros(257)
    h, b, R, a = arguments
    K = generated.K_j(j / b, h, b, R, J1)
    y = a * j / b
    terms = K * (np.sin(y) - y * np.cos(y))
    expected = [terms[:n].sum() for n in (127, 128, 129, 257)]
    np.testing.assert_allclose(sums, expected, rtol=1e-14)


def test_cached_package_depends_on_templates_and_budgets() -> None:
    """The cache is invalid after a change of a template, a budget or a copied module."""
    plate = PACKAGE / "plate"
    needed = {*plate.rglob("*.py.j2"), *plate.rglob("budgets.toml"), *plate.rglob("runtime/*.py")}
    assert {path.name for path in needed} >= {"inertia.py", "budgets.toml"}
    assert needed <= set(sources(*PAPER.package().sources))
