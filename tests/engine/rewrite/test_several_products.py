"""Code for formulas of several dimensionless arguments, against mpmath at other points."""

import importlib
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import mpmath
import numpy as np
import pytest
import sympy as sp

from derivation.engine.emit import found_form
from derivation.engine.emit.package import FormulaModule, PackageSettings
from derivation.engine.formula.grid import inside, joint_points
from derivation.engine.formula.proof import prove
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Argument, Vocabulary
from derivation.engine.rewrite import products
from derivation.engine.rewrite.dimensionless import reduced
from derivation.engine.rewrite.scales import Scales
from derivation.engine.rewrite.terms import UnreachableError

T, s, a, b, k, h, x, t = sp.symbols("T s a b k h x t", positive=True)
nu, nu_2 = sp.symbols("nu nu_2", real=True)
r = sp.Symbol("r", nonnegative=True)
DOMAINS = {
    T: ("T >= 1e-100",),
    s: ("s >= 1e-100", "s < 3"),
    a: ("a >= 1e-100", "a < 1"),
    b: ("b >= 1e-100", "b < 1"),
    k: ("k >= 1e-100",),
    h: ("h >= 1e-100",),
    x: ("x >= 1e-100", "x < h"),
    nu: ("nu > -1", "nu < 0.5"),
    nu_2: ("nu_2 > -1", "nu_2 <= 0.5"),
    t: ("t >= 1e-12", "t <= 1e3"),
    r: ("r >= 0", "r <= h"),
}
WORDS = Vocabulary(tuple(Argument(v, "1", str(v), "a number", d) for v, d in DOMAINS.items()))
FAR = sp.exp(-2 * T)
kappa = 1 + 2 * s
FORMULAS = {
    "bonded": (2 * kappa * sp.sinh(T) - 2 * T) / (2 * kappa * sp.cosh(T) + 1 + kappa**2 + T**2),
    "layers": (1 + 4 * b * T * FAR - a * b * FAR**2)
    / (1 - (a + b + 4 * b * T**2) * FAR + a * b * FAR**2),
    "bending": k * ((3 + nu) / (1 + nu) * (h**2 - x**2) + 2 * x**2 * sp.log(x / h)),
    "two ends": sp.expand(
        (1 - 2 * nu) * (1 + sp.exp(-t)) + b * (1 - 2 * nu_2) * (1 + 3 * sp.exp(-t))
    ),
    "squares": (h**2 - r**2) * ((5 + nu) / (1 + nu) * h**2 - r**2),
}


class GivenFormula(Record):
    """A formula of the numbers."""

    vocabulary = WORDS


def formula(name: str, value: sp.Expr) -> GivenFormula:
    proof = prove("Given", "Given.", {"nothing": sp.Integer(0)})
    return GivenFormula(name, "f", "a number", value, "1", "", (), proof)


def generated(
    given: GivenFormula, share: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> tuple[Callable[..., np.ndarray], int]:
    """Return the generated function, and the decades of arguments in which its form was tested."""
    budgets = folder / "budgets.toml"
    rule = f'[rule.value]\ntext = "the value"\n[rule.zeros]\nshare = {share}\nkernels = ["f"]\n'
    budgets.write_text(f"[ulp]\nf = 8\n{rule}")
    settings = PackageSettings("Numbers.", "Numbers", (FormulaModule("m", "M.", ("f",)),), budgets)
    forms = settings.forms({"f": given})
    package = folder / f"package_{folder.name}"
    package.mkdir()
    for file, text in settings.files({"f": given}, forms).items():
        (package / file).write_text(text)
    monkeypatch.syspath_prepend(str(folder))
    return importlib.import_module(package.name).f, forms[0].decades


@pytest.mark.parametrize("name", FORMULAS)
def test_code_is_accurate_in_all_arguments_together(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = formula("f", FORMULAS[name])
    function, decades = generated(given, "0.5", tmp_path, monkeypatch)
    assert decades >= 30
    names = [argument.name for argument in given.arguments]
    points = joint_points("another seed", names, WORDS, decades, 300)
    got = function(*(np.array([point[key] for point in points]) for key in names))
    symbols = [argument.symbol for argument in given.arguments]
    exact = sp.lambdify(symbols, given.expression, "mpmath")
    slopes = [sp.lambdify(symbols, given.expression.diff(v), "mpmath") for v in symbols]
    compared = 0
    for point, value in zip(points, got.tolist(), strict=True):
        with mpmath.workdps(700):
            at = [mpmath.mpf(point[key]) for key in names]
            true = exact(*at)
            if not 1e-280 < abs(true) < 1e290:
                continue
            effects = (abs(f(*at) * u / true) for f, u in zip(slopes, at, strict=True))
            allowed = 8 + float(mpmath.fsum(effects)) / 2
            assert abs(value - true) <= allowed * math.ulp(abs(float(true))), point
        compared += 1
    assert compared > 100


def test_an_inner_zero_is_rejected_with_the_share_that_allows_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = formula("f", k * ((1 + nu) * sp.log(h / x) - 1))
    with pytest.raises(UnreachableError, match=r"\[rule.zeros\].*`share = 1.[05]`"):
        generated(given, "0.5", tmp_path, monkeypatch)
    function, _ = generated(given, "1.5", tmp_path, monkeypatch)
    assert float(function(2.0, math.e, 1.0, 0.0)) == pytest.approx(0.0, abs=1e-15)


def test_small_parts_do_not_underflow_before_the_value(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """e^(-2 T) is subnormal where T^2 e^(-2 T) is a normal number."""
    value = (1 + T**2 * (1 + s)) * sp.exp(-2 * T)
    function, _ = generated(formula("f", value), "0.5", tmp_path, monkeypatch)
    for at in (354.5, 356.25, 358.0, 360.125):
        with mpmath.workdps(400):
            true = sp.lambdify((T, s), value, "mpmath")(mpmath.mpf(at), mpmath.mpf(0.5))
            allowed = 8 + at  # the condition number of T is 2 T - 2
            assert true > 2.3e-308
            assert abs(float(function(at, 0.5)) - true) <= allowed * math.ulp(float(true))
        assert float(function(1e3, 0.5)) == 0


def test_a_form_is_searched_once_until_the_formula_or_its_domain_changes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    searched: list[str] = []

    def counted(given: products.GivenFormula, *others: object) -> object:
        searched.append(given.name)
        return found(given, *others)

    found: Callable[..., object] = found_form.found_form
    monkeypatch.setattr(found_form, "found_form", counted)
    given = formula("f", 1 - sp.exp(-T * s))
    narrower = replace(given, where=("s < 2",))
    rejected = formula("g", k * sp.besselj(0, s))
    for one in (given, narrower, given, narrower, formula("f", 1 - sp.exp(-2 * T * s))):
        made, _ = found_form.cached_form(one, {}, Scales(), 0.5)
        assert made.value.has(sp.Function("expm1")) or made.steps
    for _ in range(2):
        with pytest.raises(UnreachableError, match="besselj"):
            found_form.cached_form(rejected, {}, Scales(), 0.5)
    assert searched == ["f", "f", "f", "g"]


def test_several_rejections_are_reported_together(tmp_path: Path) -> None:
    value = k * sp.besselj(0, s)
    named = {name: formula(name, value) for name in ("f", "g")}
    budgets = tmp_path / "budgets.toml"
    budgets.write_text('[ulp]\n[rule.value]\ntext = "the value"\n')
    settings = PackageSettings("A.", "A", (FormulaModule("m", "M.", ("f", "g")),), budgets)
    with pytest.raises(UnreachableError, match=r"f: .*besselj.*\ng: .*besselj"):
        settings.forms(named)


def test_products_follow_from_the_structure_of_a_formula() -> None:
    given = k**2 * (sp.exp(-k * h) + nu * r / h + nu) / s
    actual = reduced(given, [r], iter(("p", "q")))
    products = {str(p.variable): dict(p.powers) for p in actual.products}
    assert products == {"p": {h: 1, k: 1}, "q": {h: -1, r: 1}, "nu": {nu: 1}}
    assert dict(actual.front) == {k: 2, s: -1}
    p, q = (product.variable for product in actual.products if str(product.variable) in "pq")
    assert sp.simplify(actual.expression - (sp.exp(-p) + nu * q + nu)) == 0


def test_points_cover_all_magnitudes_of_a_domain_together() -> None:
    """Between 1e-12 and 1e3, most numbers are above 1; half of all magnitudes are not."""
    words = Vocabulary(
        (
            Argument(a, "1", "a", "one", ("a >= 1e-12", "a <= 1e3")),
            Argument(b, "1", "b", "other", ("b >= 1e-9", "b <= 1e9")),
            Argument(nu, "1", "nu", "number", ("nu > -1", "nu <= 0.5")),
        )
    )
    points = joint_points("wide", ["a", "b", "nu"], words, 100, 1500)
    assert all(inside(words, point) for point in points)
    small = [p for p in points if p["a"] < 0.1 and p["b"] < 1e-3]
    assert len(small) > 200
    assert sum(0.5 - point["nu"] < 1e-3 for point in small) > 10


def test_points_in_a_narrow_domain_are_found() -> None:
    words = Vocabulary(
        (
            Argument(a, "1", "a", "inner", ("a >= 1e-100",)),
            Argument(b, "1", "b", "outer", ("b > a", "b < 1.001 * a")),
        )
    )
    points = joint_points("ring", ["a", "b"], words, 12, 200)
    assert len(points) > 50
    assert all(inside(words, point) for point in points)
