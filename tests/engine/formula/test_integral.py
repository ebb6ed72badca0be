"""Integrals in interval arithmetic: closed forms, mpmath, and integrals without a value."""

import random
from fractions import Fraction

import flint
import mpmath
import pytest
import sympy as sp

from derivation.engine.formula.ball import PrecisionError, enclosable, enclose, evaluate, to_ball
from derivation.engine.formula.integral import HINT
from derivation.engine.formula.proof import ProofError, prove
from derivation.engine.formula.tape import record

x, y, t = sp.symbols("x y t", real=True)
a, k, r = sp.symbols("a k r", positive=True)
I = sp.Integral  # noqa: E741
OO = sp.oo
VALUES = {a: Fraction(7, 3), k: Fraction(3, 5), r: Fraction(1, 2)}
HALF, THIRD = sp.Rational(1, 2), sp.Rational(1, 3)

KNOWN = {
    "elliptic K": (
        I(1 / sp.sqrt(1 - k**2 * sp.sin(t) ** 2), (t, 0, sp.pi / 2)),
        sp.elliptic_k(k**2),
    ),
    "elliptic E": (I(sp.sqrt(1 - k**2 * sp.sin(t) ** 2), (t, 0, sp.pi / 2)), sp.elliptic_e(k**2)),
    "K, singular at both ends": (
        I(1 / sp.sqrt((1 - x**2) * (1 - k**2 * x**2)), (x, -1, 1)),
        2 * sp.elliptic_k(k**2),
    ),
    "force of a Hertz pressure": (
        I(2 * sp.pi * x * sp.sqrt(1 - x**2 / a**2), (x, 0, a)),
        2 * sp.pi * a**2 / 3,
    ),
    "Abel transform": (I(x / sp.sqrt(x**2 - r**2), (x, r, a)), sp.sqrt(a**2 - r**2)),
    "Abel transform back": (
        I(2 * x * sp.acosh(a / x) / sp.sqrt(x**2 - r**2), (x, r, a)),
        sp.pi * (a - r),
    ),
    "J0": (I(sp.cos(a * sp.sin(t)), (t, 0, sp.pi)) / sp.pi, sp.besselj(0, a)),
    "K1": (I(sp.exp(-a * sp.cosh(t)) * sp.cosh(t), (t, 0, OO)), sp.besselk(1, a)),
    "Laplace of J0": (
        I(sp.exp(-k * x) * sp.besselj(0, r * x), (x, 0, OO)),
        1 / sp.sqrt(k**2 + r**2),
    ),
    "gamma": (I(x ** (THIRD - 1) * sp.exp(-x), (x, 0, OO)), sp.gamma(THIRD)),
    "beta": (I(x ** (-HALF) * (1 - x) ** (THIRD - 1), (x, 0, 1)), sp.beta(HALF, THIRD)),
    "logarithm": (I(sp.log(x / a), (x, 0, a)), -a),
    "logarithm and root": (I(-sp.log(x) / sp.sqrt(1 - x), (x, 0, 1)), 4 - 4 * sp.log(2)),
    "Gauss": (I(sp.exp(-k * x**2), (x, -OO, OO)), sp.sqrt(sp.pi / k)),
    "Lorentz": (I(1 / (x**2 + a**2), (x, -OO, OO)), sp.pi / a),
    "algebraic": (I((x**2 + a**2) ** sp.Rational(-3, 2), (x, 0, OO)), 1 / a**2),
    "Planck": (I(x**3 / (sp.exp(x) - 1), (x, 0, OO)), sp.pi**4 / 15),
    "hyperbolic": (I(x / sp.sinh(k * x), (x, 0, OO)), sp.pi**2 / (4 * k**2)),
    "tanh": (I(1 - sp.tanh(k * x), (x, 0, OO)), sp.log(2) / k),
    "coth": (I(x * (sp.coth(k * x) - 1), (x, 0, OO)), sp.pi**2 / (12 * k**2)),
    "backwards": (I(sp.exp(-x), (x, OO, a)), -sp.exp(-a)),
    "absolute value": (I(sp.Abs(x - k), (x, 0, 1)), k**2 - k + HALF),
    "half sphere": (
        I(sp.sqrt(a**2 - x**2 - y**2), (y, 0, sp.sqrt(a**2 - x**2)), (x, -a, a)) * 2,
        2 * sp.pi * a**3 / 3,
    ),
    "Hankel, twice": (
        I(y * sp.exp(-k * x) * sp.besselj(0, y * x), (x, 0, OO), (y, 0, a)),
        sp.sqrt(a**2 + k**2) - k,
    ),
}  # fmt: skip


def _ball(expression: sp.Expr, bits: int = 100, values: dict = VALUES) -> flint.arb:
    with flint.ctx.workprec(bits):
        return enclose(expression, {s: to_ball(v) for s, v in values.items()})


@pytest.mark.parametrize("name", KNOWN)
def test_integral_equals_its_closed_form(name: str) -> None:
    integral, closed = KNOWN[name]
    values = {s: v for s, v in VALUES.items() if s in integral.free_symbols}
    ball, known = (evaluate(side, values, 25) for side in (integral, closed))
    with flint.ctx.workprec(200):
        assert ball.overlaps(known)


@pytest.mark.parametrize("name", ["elliptic K", "Abel transform", "Laplace of J0", "algebraic"])
def test_sensitivities_are_those_of_the_closed_form(name: str) -> None:
    integral, closed = KNOWN[name]
    symbols = sorted(closed.free_symbols, key=str)
    with flint.ctx.workprec(80):
        tape = record(integral, symbols)
        gradient = tape.gradient(tape.run([to_ball(VALUES[s]) for s in symbols]))
    for symbol, slope in zip(symbols, gradient, strict=True):
        derivative = _ball(sp.diff(closed, symbol))
        assert slope.overlaps(derivative)
        assert slope.rel_accuracy_bits() > 40


@pytest.mark.parametrize(
    "integral",
    [
        I(1 / x, (x, 0, 1)),
        I(1 / (x - k), (x, 0, 1)),
        I(1 / (x - k) ** 2, (x, 0, 1)),
        I(1 / x, (x, 1, OO)),
        I(sp.sin(x), (x, 0, OO)),
        I(sp.sqrt(x - k), (x, 0, 1)),
        I(sp.log(x - k), (x, 0, 1)),
        I(sp.exp(x), (x, 0, OO)),
        I(1 / sp.sin(x), (x, 0, 1)),
        I((1 - x) ** sp.Rational(-3, 2), (x, 0, 1)),
    ],
)
def test_integral_without_value_gives_none(integral: sp.Integral) -> None:
    """Divergent integrals, poles inside the range, and roots of negative numbers."""
    values = {s: v for s, v in VALUES.items() if s in integral.free_symbols}
    with pytest.raises(PrecisionError):
        evaluate(integral, values, 15)


def test_random_integrals_contain_the_value_of_mpmath() -> None:
    """Products of powers, exponentials and logarithms that mpmath integrates reliably."""
    generator = random.Random(5)
    for _ in range(12):
        p, q = (sp.Rational(generator.randrange(-3, 8), 4) for _ in range(2))
        f = x**p * (1 - x) ** q * sp.exp(generator.randrange(-3, 4) * x) * (2 + sp.log(x))
        with mpmath.workdps(30):
            value = mpmath.quad(sp.lambdify(x, f, "mpmath"), [0, 0.5, 1])
        ball = evaluate(I(f, (x, 0, 1)), {}, 15)
        assert abs(float(ball) - float(value)) < 1e-6 * abs(
            float(value)
        )  # the accuracy of mpmath here


def test_terms_that_do_not_decay_cancel_for_large_arguments() -> None:
    """The first coefficients of contact with an elastic layer on a rigid base, against mpmath."""
    double_sine, double_cosine = sp.sinh(2 * x), sp.cosh(2 * x)
    bonded = (2 * a * double_sine - 4 * x) / (2 * a * double_cosine + 1 + a**2 + 4 * x**2)
    frictionless = (double_cosine - 1) / (double_sine + 2 * x)
    for influence in (frictionless, bonded, bonded.subs(a, 1)):
        for power in (0, 2):
            f = x**power * (influence - 1)
            values = {s: v for s, v in VALUES.items() if s in f.free_symbols}
            with mpmath.workdps(30):
                code = sp.lambdify(x, f.subs(values), "mpmath")
                value = mpmath.quad(code, [0, 1, 3, 8, 20, 40])
            ball = evaluate(I(f, (x, 0, OO)), values, 20)
            assert abs(float(ball) - float(value)) < 1e-13 * abs(float(value))


def test_wrong_integral_is_not_proved() -> None:
    integral, closed = KNOWN["Abel transform"]
    prove("Abel", "", {"x": integral - closed})
    with pytest.raises(ProofError):
        prove("Abel", "", {"x": integral - closed * (1 + sp.Rational(1, 10**9))})


def test_assumption_that_the_range_contradicts_is_rejected() -> None:
    assert not enclosable(I(a, (a, -1, 1)))
    assert not enclosable(I(x, x))
    assert "substitute" in HINT
