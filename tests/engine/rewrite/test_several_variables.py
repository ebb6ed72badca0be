"""`rewrite` of formulas in several variables: the stated error against mpmath at other points."""

import math
import random
from collections.abc import Callable
from typing import Any

import flint
import numpy as np
import pytest
import sympy as sp
from exact_errors import check_errors
from mpmath import mp, mpf

from derivation.engine.emit import own_formula
from derivation.engine.emit import several_variables as standalone_module
from derivation.engine.emit.own_formula import rewrite_text
from derivation.engine.emit.printer import to_numpy
from derivation.engine.formula.tape import Tape
from derivation.engine.rewrite import several_variables as tested_module
from derivation.engine.rewrite.identities import prove_identity
from derivation.engine.rewrite.several_variables import Point, SeveralCheck, check_several
from derivation.engine.rewrite.terms import UnreachableError

FORMULAS = {
    "R - sqrt(R**2 - a**2)": lambda R, a: R - mp.sqrt(R * R - a * a),
    "(1 - exp(-k*h))/k": lambda k, h: -mp.expm1(-k * h) / k,
    "P/(2*pi*a*sqrt(a**2 - r**2))": lambda P, a, r: P / (2 * mp.pi * a * mp.sqrt(a * a - r * r)),
    "4*E*a**3/(3*R) - sqrt(8*pi*gam*E*a**3)": lambda E, a, R, gam: (
        4 * E * a**3 / (3 * R) - mp.sqrt(8 * mp.pi * gam * E * a**3)
    ),
    "(sin(a*b) - a*b)/a**3": lambda a, b: (mp.sin(a * b) - a * b) / a**3,
    "(exp(a*t) - 1 - a*t)/t**2": lambda a, t: (mp.exp(a * t) - 1 - a * t) / t**2,
    "exp(-E/(k*T))": lambda E, k, T: mp.exp(-E / (k * T)),
    "1/f - 1/v": lambda f, v: 1 / f - 1 / v,
    "sqrt(a**2 + b**2 + c**2)": lambda a, b, c: mp.sqrt(a**2 + b**2 + c**2),
    "tan(a*b)": lambda a, b: mp.tan(a * b),
    "abs(a - b)*c": lambda a, b, c: abs(a - b) * c,
    "exp(-a**2*b)/sqrt(a)": lambda a, b: mp.exp(-a * a * b) / mp.sqrt(a),
    "cbrt(a**3 + b**3) - a": lambda a, b: mp.cbrt(a**3 + b**3) - a,
    "1 - cos(a*b)": lambda a, b: 2 * mp.sin(a * b / 2) ** 2,
    "exp(-a) - exp(-b)": lambda a, b: mp.exp(-a) - mp.exp(-b),
    "cosh(k*(h - z))/sinh(k*h)": lambda k, h, z: mp.cosh(k * (h - z)) / mp.sinh(k * h),
    "sinh(k*(h - z))*exp(-k*h)": lambda k, h, z: mp.sinh(k * (h - z)) * mp.exp(-k * h),
    "log(1 + exp(a - b))": lambda a, b: mp.log1p(mp.exp(a - b)),
    "(4*k*h - 2*c*sinh(2*k*h))/(k*(2*c*cosh(2*k*h) + 1 + c**2 + (2*k*h)**2))": lambda k, h, c: (
        (4 * k * h - 2 * c * mp.sinh(2 * k * h))
        / (k * (2 * c * mp.cosh(2 * k * h) + 1 + c * c + (2 * k * h) ** 2))
    ),
    "cos(a) - cos(b)": lambda a, b: mp.cos(a) - mp.cos(b),
    "(sin(total_1) - sin(a))/b": lambda total_1, a, b: (mp.sin(total_1) - mp.sin(a)) / b,
    "exp(a) + exp(b) - 2": lambda a, b: mp.expm1(a) + mp.expm1(b),
    "sinh(a) - a*cos(b)": lambda a, b: mp.sinh(a) - a * mp.cos(b),
    "2*(1 + 2*s)*sinh(t) - 2*t": lambda s, t: 2 * (1 + 2 * s) * mp.sinh(t) - 2 * t,
    "(1 + s - exp(-t)*(1 + s*cosh(t)))/(1 + s)": lambda s, t: (
        (1 + s - mp.exp(-t) * (1 + s * mp.cosh(t))) / (1 + s)
    ),
    "atan(a) - atan(b)": lambda a, b: mp.atan(a) - mp.atan(b),
    "(b - sqrt(b**2 - 4*a*c))/(2*a)": lambda b, a, c: 2 * c / (b + mp.sqrt(b * b - 4 * a * c)),
}
POINTS = 300


@pytest.mark.parametrize("text", FORMULAS)
def test_stated_error_holds_at_other_points(text: str) -> None:
    _, source, tested = rewrite_text(text)
    assert isinstance(tested, SeveralCheck)
    space: dict[str, Callable[..., np.ndarray]] = {}
    exec(source, space)
    draw, checked = random.Random(f"others {text}"), list[tuple[list[float], float]]()
    count, most = len(tested.at), math.log10(tested.high)
    for number in range(POINTS):
        decades = most if number % 3 == 0 else 2.0
        point = [10 ** draw.uniform(-decades, decades) for _ in range(count)]
        if number % 2:  # two variables are nearly equal
            one, other = draw.sample(range(count), 2)
            point[one] = point[other] * (1 - 10 ** draw.uniform(-14, -1))
        checked.append((point, float(space["f"](*point))))
    check_errors(FORMULAS[text], checked, tested.limit, tested.share, POINTS / 6)
    outside = [1.0] * (count - 1) + [10 * tested.high]
    assert np.isnan(space["f"](*outside))


def test_arrays_are_broadcast() -> None:
    _, source, _ = rewrite_text("R - sqrt(R**2 - a**2)")
    space: dict[str, Callable[..., np.ndarray]] = {}
    exec(source, space)
    got = space["f"]([[1.0], [2.0]], [0.5, 1e-9, 3.0])
    assert got.shape == (2, 3)
    assert got[1, 1] == pytest.approx(1e-18 / 4, rel=1e-15)
    assert np.isnan(got[:, 2]).all()  # the radius is larger than R


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("sqrt(a**2 + b) - a + c - sin(c)", "in variables that need not be subtracted"),
        ("p*log(p/q) + q - p - sin(q)", "in variables that need not be subtracted"),
        ("np - sqrt(np**2 - a**2)", "uses; rename it"),
        ("a*e**b", "write exp"),
        ("besselj(0, a)*b", "expected functions of NumPy"),
    ],
)
def test_other_formulas_are_rejected(text: str, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        rewrite_text(text)


a, b = sp.symbols("a b", positive=True)


@pytest.mark.parametrize(
    "wrong",
    [
        sp.exp(sp.Max(a, b)) * (sp.exp(sp.Min(a - b, 0)) - sp.exp(-sp.Max(b - a, 0))),
        sp.exp(sp.Min(a, b)) * (sp.exp(sp.Min(a - b, 0)) - sp.exp(-sp.Max(a - b, 0))),
        sp.Max(a, b, 1) - sp.Min(a, b, 1),
    ],
)
def test_an_identity_that_holds_for_one_sign_only_is_rejected(wrong: sp.Expr) -> None:
    with pytest.raises(UnreachableError):
        prove_identity(wrong, sp.exp(a) - sp.exp(b))


@pytest.mark.parametrize(
    ("text", "signature"),
    [
        ("(u - sin(u))/u**3", "def f(u:"),
        ("1 - exp(-lambda*t)", "def f(lam: "),
        ("E*x", "def f(E: "),
    ],
)
def test_variables_may_have_any_names(text: str, signature: str) -> None:
    assert signature in rewrite_text(text)[1]


def test_the_inverse_of_a_product_is_used_if_it_is_more_accurate() -> None:
    """With x = R/a, sqrt(x**2 - 1) loses digits near x = 1; with a/R nothing cancels."""
    assert rewrite_text("R - sqrt(R**2 - a**2)")[2].worst < 2.0


def test_cube_roots_are_accurate_for_extreme_arguments() -> None:
    """With the double nearest to 1/3 as exponent, errors are up to 57 ULP."""
    x = sp.Symbol("x", positive=True)
    for value in (1e-150, 7e-101, 3e99, 1e150):
        root = eval(to_numpy(x ** sp.Rational(1, 3)), {"np": np, "x": np.float64(value)})
        with mp.workdps(40):
            exact = mp.cbrt(mpf(value))
            assert abs(mpf(float(root)) - exact) <= 2 * mpf(math.ulp(float(exact)))


@pytest.mark.parametrize(
    ("text", "where"),
    [("cosh(k*(h - z))/sinh(k*h)", ""), ("(3 - 4*nu)*sinh(T) - T", "-1 < nu < 0.5")],
)
def test_forms_of_a_formula_share_points_and_exact_values(
    text: str, where: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each was computed again for each form, which took half of the time."""
    values, points = list[tuple[int, Point, int]](), list[object]()
    value, joint, tapes = tested_module._value, tested_module.joint_points, list[object]()

    def recorded(tape: Tape | None, point: Point, digits: int) -> flint.arb | None:
        tapes.append(tape)  # as long as it exists, no other object has its id
        values.append((id(tape), point, digits))
        return value(tape, point, digits)

    def drawn(seed: str, *others: Any) -> list[dict[str, float]]:
        points.append((seed, others[2]))
        return joint(seed, *others)

    forms = list[object]()

    def check(*arguments: Any) -> SeveralCheck:
        forms.append(arguments)
        return check_several(*arguments)

    monkeypatch.setattr(own_formula, "run_limited", lambda work, *_: work())
    monkeypatch.setattr(standalone_module, "check_several", check)
    monkeypatch.setattr(tested_module, "_value", recorded)
    monkeypatch.setattr(tested_module, "joint_points", drawn)
    rewrite_text(text, where=[where] if where else ())
    assert len(forms) > 1
    assert len(values) > 1000
    exact = [each for each in values if each[2] > 3]
    assert len(set(exact)) == len(exact)
    assert len(set(points)) == len(points) >= bool(where)
