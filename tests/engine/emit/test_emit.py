"""The generated package: deterministic, fresh, standalone, and well-behaved with arrays."""

import importlib
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
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
ARRAYS = [row for row in KERNELS if row["arguments"] not in (("count",),)]
EXAMPLE = {
    "r": 0.002, "z": 0.004, "phi": 24.0, "h": 0.01, "T": 0.48, "b": 0.1, "R": 0.13, "a": 0.004,
    "lam": 0.36e9, "mu": 0.43e9, "P": 1000.0, "A_j": -1e6, "J1": 0.52, "x": 1.3, "n": 7.0,
    "k": 4.0,
}  # fmt: skip


def function(row: dict) -> Callable[..., np.ndarray]:
    kernel = getattr(importlib.import_module(f"generated.{row['module']}"), row["name"])
    if row["modes"]:
        return lambda *arguments: kernel(*arguments, modes=5)
    return kernel


def example(row: dict) -> list[float]:
    return [EXAMPLE[name] for name in row["arguments"]]


@pytest.fixture(autouse=True)
def _no_warnings() -> Iterator[None]:
    with np.errstate(all="raise", under="ignore"):
        yield


def test_package_is_fresh() -> None:
    freshness = build.check_generated(PAPER, None, "platecontact generate")
    assert freshness.fresh, str(freshness)


@pytest.mark.parametrize("deed", ["delete", "edit", "add"])
def test_every_tampering_is_seen_and_the_remedy_named(deed: str, tmp_path: Path) -> None:
    copy = tmp_path / "generated"
    shutil.copytree(ROOT / "generated", copy, ignore=shutil.ignore_patterns("__pycache__"))
    expected = files_of(PAPER.chain, PAPER.package())
    assert compare(copy, expected, "regenerate").fresh
    if deed == "delete":
        (copy / "omega.py").unlink()
    elif deed == "edit":
        text = (copy / "omega.py").read_text()
        (copy / "omega.py").write_text(text.replace("np.exp(", "np.cos(", 1))
    else:
        (copy / "extra.py").write_text("")
    found = compare(copy, expected, "regenerate")
    assert not found.fresh
    remedy = "rm " if deed == "add" else "regenerate"
    assert f"To mend: {remedy}" in str(found)
    assert ("+" in found.diffs["omega.py"]) if deed == "edit" else not found.diffs


def test_output_does_not_depend_on_the_hash_seed(tmp_path: Path) -> None:
    """Derived and rendered from nothing in a process with a hash seed of its own."""
    out, own = tmp_path / "package", os.environ.get("PYTHONHASHSEED")
    seed = {"PYTHONHASHSEED": "1" if own == "4242" else "4242", "XDG_CACHE_HOME": str(tmp_path)}
    command = [sys.executable, "-m", "derivation.cli", "generate", "--out", str(out)]
    subprocess.run(command, env={**os.environ, **seed}, cwd=ROOT, check=True)
    committed = {
        path.name: path.read_text() for path in (ROOT / "generated").iterdir() if path.is_file()
    }
    found = compare(out, committed, "")
    assert found.fresh, str(found)


def test_package_needs_numpy_alone(tmp_path: Path) -> None:
    """A copy under another name, in a process that sees NumPy but not this project."""
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


def test_every_kernel_has_a_budget_and_every_budget_a_kernel() -> None:
    assert set(read_budgets()) == {row["name"] for row in (*KERNELS, *CONTACT)}
    contact = {row["name"] for row in CONTACT if row["module"] != "impact"}
    assert set(generated.__all__) == set(KERNEL) | contact


@pytest.mark.parametrize("row", [*KERNELS, *CONTACT], ids=lambda row: row["name"])
def test_manifest_and_docstring_show_the_whole_budget(row: dict) -> None:
    budget = read_budgets()[row["name"]]
    assert (row["budget"], row["rule"]) == (budget.ulp, budget.rule)
    kernel = getattr(importlib.import_module(f"generated.{row['module']}"), row["name"])
    shown = " ".join(kernel.__doc__.split())
    assert f"{budget.ulp:g} unit" in shown
    assert f" in the last place (ULP) of {budget.rule}." in shown
    assert f"Domain: {row['domain'] or 'all real numbers'}." in shown


@pytest.mark.parametrize("row", ARRAYS, ids=lambda row: row["name"])
def test_shapes_types_and_layouts(row: dict) -> None:
    kernel, values = function(row), example(row)
    scalar = kernel(*values)
    assert np.isfinite(scalar)
    assert np.shape(scalar) == ()
    many = [np.full((2, 3), value) for value in values]
    np.testing.assert_array_equal(kernel(*many), np.full((2, 3), scalar))
    mixed = [values[0], *many[1:]] if len(values) > 1 else [many[0]]
    np.testing.assert_array_equal(kernel(*mixed), np.full((2, 3), scalar))
    assert kernel(*(np.empty(0) for _ in values)).shape == (0,)
    strided = [np.full((3, 8), value)[:, ::4] for value in values]
    for array in strided:
        array.flags.writeable = False
    np.testing.assert_array_equal(kernel(*strided), np.full((3, 2), scalar))
    assert kernel(*many).dtype == np.float64
    single = kernel(*(array.astype(np.float32) for array in many))
    assert single.dtype == np.float32
    np.testing.assert_allclose(single, np.full((2, 3), scalar), rtol=2e-5)


@pytest.mark.parametrize("row", ARRAYS, ids=lambda row: row["name"])
def test_nan_and_what_lies_outside_the_domain_give_nan(row: dict) -> None:
    kernel, values = function(row), example(row)
    names = row["arguments"]
    bad = {"phi": -1.0, "h": 0.0, "T": -0.5, "b": -1.0, "R": 0.0, "a": 0.0, "mu": -1.0, "P": -1.0}
    bad |= {"z": 1e3, "r": -1.0, "lam": -1e12, "J1": 0.0, "n": 1.5, "k": 1.0}
    for index, name in enumerate(names):
        for value in (np.nan, np.inf, *([bad[name]] if name in bad else [])):
            changed = [*values[:index], value, *values[index + 1 :]]
            assert np.isnan(kernel(*changed)), (name, value)


def test_integers_are_read_as_numbers_and_complex_is_refused() -> None:
    assert generated.G(2) == generated.G(2.0)
    assert generated.G(np.array([1, 2])).dtype == np.float64
    with pytest.raises(TypeError, match="real numbers"):
        generated.G(1j)
    with pytest.raises(ValueError, match="at least one mode"):
        generated.delta(0.01, 0.1, 0.13, 0.004, modes=0)


def test_blocks_of_modes_leave_no_seam() -> None:
    """Sums across the block boundary equal the sum of single-mode differences."""
    arguments = (0.01, 0.1, 0.13, 0.004)
    sums = [generated.delta(*arguments, modes=n) for n in (127, 128, 129, 257)]
    j, J1 = generated.bessel_j0_zeros(257), generated.bessel_j1_at_j0_zeros(257)
    h, b, R, a = arguments
    K = generated.K_j(j / b, h, b, R, J1)
    y = a * j / b
    shares = K * (np.sin(y) - y * np.cos(y))
    expected = [shares[:n].sum() for n in (127, 128, 129, 257)]
    np.testing.assert_allclose(sums, expected, rtol=1e-14)


def test_a_broken_package_can_be_written_anew(tmp_path: Path) -> None:
    """Nothing on the way to generation imports what was generated before."""
    ignore = shutil.ignore_patterns("__pycache__")
    for part in ("derivation", "generated"):
        shutil.copytree(ROOT / part, tmp_path / part, ignore=ignore)
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    for name in ("__init__.py", "omega.py"):
        (tmp_path / "generated" / name).write_text("this is not Python")
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    command = [sys.executable, "-m", "derivation.cli", "generate"]
    done = subprocess.run(
        command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert compare(tmp_path / "generated", files_of(PAPER.chain, PAPER.package()), "").fresh


def test_the_kept_package_follows_its_templates_and_budgets() -> None:
    """An edit of a template is not answered with the package as it was before."""
    plate = PACKAGE / "plate"
    needed = {*plate.rglob("*.py.j2"), *plate.rglob("budgets.toml"), *plate.rglob("runtime/*.py")}
    assert {path.name for path in needed} >= {"inertia.py", "budgets.toml"}
    assert needed <= set(sources(*PAPER.package().sources))
