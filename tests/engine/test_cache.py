"""The cache stores plain data, verifies it before use, and never executes it."""

import json
import os
import pickle
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
import sympy as sp

from derivation.engine import build, cache, files
from derivation.engine.cache import cache_folder, cached, from_plain, in_file, to_plain
from derivation.engine.formula.proof import Proof
from derivation.engine.rewrite.form import Block, Branch, Form, Step, Switch
from derivation.plate import derived
from derivation.plate.blocks import blocks
from derivation.plate.paper import PAPER
from derivation.plate.vocabulary import Formula

x = sp.Symbol("x", positive=True)
VALUE = {"first": (1, None, True, "text"), "second": (x**2 + sp.Rational(1, 3), sp.Float("5e-324"))}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Use an empty cache in a temporary folder."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "platecontact"


def counting(value: object) -> tuple[Callable[[], Any], list[int]]:
    """Return a function that returns `value`, and a list with one entry for each call."""
    calls = list[int]()

    def compute() -> object:
        calls.append(1)
        return value

    return compute, calls


def restored(value: object, *kinds: type) -> Any:
    """Convert a value to JSON and back."""
    known = {kind.__name__: kind for kind in kinds}
    return from_plain(json.loads(json.dumps(to_plain(value, known))), known)


def test_cached_value_is_computed_once(folder: Path) -> None:
    compute, calls = counting(VALUE)
    assert cached("x", (), compute) == cached("x", (), compute) == VALUE
    assert len(calls) == 1
    [path] = folder.iterdir()
    json.loads(path.read_bytes().partition(b"\n")[2])


def test_result_of_sources_that_were_edited_since_their_import_is_not_kept(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is that of the code before, and must not be found under the hash of the new code."""
    source = Path(cache.__file__)
    monkeypatch.setattr(cache, "BEGIN", source.stat().st_mtime - 1.0)
    compute, calls = counting(VALUE)
    assert cached("x", (source,), compute) == cached("x", (source,), compute) == VALUE
    assert len(calls) == 2
    assert not list(folder.iterdir())


def test_compiled_modules_are_no_sources(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files, "PACKAGE", tmp_path)
    for name in ("plate/contact/oracle.py", "plate/__pycache__/oracle.cpython-311.pyc"):
        (tmp_path / name).parent.mkdir(parents=True)
        (tmp_path / name).touch()
    assert [path.name for path in files.sources("plate/*/oracle*")] == ["oracle.py"]


def test_results_of_a_function_are_computed_once_for_each_argument(folder: Path) -> None:
    calls = list[int]()

    def square(n: int) -> sp.Expr:
        calls.append(n)
        return x**n

    for _ in range(2):  # the second finds the files of the first
        decorated = in_file(())(square)
        assert [decorated(2), decorated(3), decorated(2)] == [x**2, x**3, x**2]
    assert calls == [2, 3]
    assert len([*folder.iterdir()]) == 2


def test_results_of_the_project_are_restored(formulas: Mapping[str, Formula]) -> None:
    kinds = (*derived.CHAIN.kinds, Proof, Form, Step, Branch, Switch, Block)
    for value in (formulas, build.rewrite(PAPER), blocks()):
        actual = restored(value, *kinds)
        assert actual == value
        assert repr(actual) == repr(value)


@pytest.mark.parametrize(
    "value",
    [
        sp.Symbol("x", real=True, nonzero=True), sp.Function("f", real=True)(x),
        sp.Integral(sp.besselj(0, x) / x, (x, 0, sp.oo)), sp.Sum(x**-2, (x, 1, sp.oo)), -sp.oo,
        sp.Derivative(sp.Function("f")(x), (x, 2)), sp.Max(x, sp.Float("1e308")), sp.I * sp.pi,
        sp.E, sp.EulerGamma, sp.Rational(-7, 10**40), sp.exp(-x), sp.Function("f")(x),
    ],
)  # fmt: skip
def test_expressions_are_restored(value: sp.Basic) -> None:
    assert restored(value) == value
    assert sp.srepr(restored(value)) == sp.srepr(value)


@pytest.mark.parametrize("value", [{1}, 0.5, b"x", [1], {1: 2}, object(), Step(x, x), x > 1])
def test_values_that_cannot_be_stored_are_rejected(value: object, folder: Path) -> None:
    with pytest.raises(TypeError, match="expected"):
        cached("x", (), lambda: value)
    assert not list(folder.glob("*"))


def test_damaged_file_is_not_used(folder: Path) -> None:
    compute, calls = counting(VALUE)
    cached("x", (), compute)
    [path] = folder.iterdir()
    whole = path.read_bytes()
    changed = [whole[:k] + bytes([whole[k] ^ 1]) + whole[k + 1 :] for k in range(0, len(whole), 7)]
    for number, damaged in enumerate([*changed, b"", whole[:-1], whole[65:]], start=1):
        path.write_bytes(damaged)
        assert cached("x", (), compute) == VALUE
        assert len(calls) == number + 1, "the damaged file was used"
        assert path.read_bytes() == whole


def test_file_of_another_key_is_not_used(folder: Path) -> None:
    cached("x", (), lambda: 1)
    [one] = folder.iterdir()
    cached("y", (), lambda: 2)
    [other] = set(folder.iterdir()) - {one}
    other.write_bytes(one.read_bytes())
    assert cached("y", (), lambda: 2) == 2


class CreatesFile:
    """An object that creates a file when it is unpickled."""

    def __init__(self, trace: Path) -> None:
        self.trace = trace

    def __reduce__(self) -> tuple[Any, ...]:
        return Path.touch, (self.trace,)


def test_pickle_in_the_cache_is_not_executed(folder: Path, tmp_path: Path) -> None:
    trace = tmp_path / "ran"
    cached("x", (), lambda: 1)
    [path] = folder.iterdir()
    for name in (path, path.with_suffix(".pickle")):
        name.write_bytes(pickle.dumps(CreatesFile(trace)))
    assert cached("x", (), lambda: 1) == 1
    assert not trace.exists()


@pytest.mark.parametrize(
    "plain",
    [
        {"eval": ["1"]}, {"Lambda": [{"Symbol": ["x", {}]}]}, {"sympify": ["1"]}, {"lambdify": []},
        {"Add": ["__import__('os')", 1]}, {"Path": ["/"]}, {"Formula": []}, {"a": [], "b": []},
        {"Symbol": [1, {}]}, {"Function": [["f"], {}, []]}, {"__loader__": []}, 1.5, {},
    ],
)  # fmt: skip
def test_other_names_than_those_of_expressions_are_rejected(plain: Any) -> None:
    with pytest.raises((TypeError, ValueError)):
        from_plain(plain, {})


def test_relative_cache_folder_is_ignored(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    home = tmp_path / "home"
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(home))
    monkeypatch.setenv("XDG_CACHE_HOME", "relative")
    assert cached("x", (), lambda: 1) == 1
    assert not Path("relative").exists()
    assert cache_folder() == home / ".cache" / "platecontact"
    monkeypatch.setenv("HOME", "relative")
    assert cache_folder() is None
    assert cached("x", (), lambda: 2) == 2
    assert not Path("relative").exists()


def test_folder_writable_by_others_is_not_used(folder: Path) -> None:
    folder.mkdir()
    folder.chmod(0o777)
    assert cached("x", (), lambda: 1) == 1
    assert list(folder.iterdir()) == []


def test_pipe_or_large_file_is_not_read(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cached("x", (), lambda: 1)
    [path] = folder.iterdir()
    path.unlink()
    os.mkfifo(path)
    assert cached("x", (), lambda: 1) == 1
    monkeypatch.setattr(cache, "LARGEST", 10)
    assert cached("x", (), lambda: 1) == 1
