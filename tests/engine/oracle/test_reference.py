"""Reference values against known numbers and each other; rejected arguments."""

import itertools
import math
import random
from dataclasses import replace

import flint
import mpmath
import pytest
import sympy as sp
from mpmath import mp, mpf

from derivation.engine.formula.ball import PrecisionError
from derivation.engine.formula.operations import FUNCTIONS
from derivation.engine.formula.tape import record
from derivation.engine.oracle import agreement, oracle
from derivation.engine.oracle.agreement import OracleError, RouteError
from derivation.mathematics.bessel.oracle import first_zero_is_first, j0_zero, j1_at_zero
from derivation.plate.modes.route import routes
from derivation.plate.modes.route.routes import agree
from derivation.plate.oracle import arguments, certified_value, is_summed, names, reference

# Abramowitz & Stegun, table 9.5, and its continuation to more digits.
FIRST_ZERO = "2.4048255576957727686216318793264546431242449091459671"
PLATE = {
    "r": 0.3, "z": 0.05, "h": 0.1, "b": 1.0, "R": 0.5, "a": 0.02, "lam": 1.2e11, "mu": 8e10,
}  # fmt: skip
MODE = {"z": 0.03, "phi": 11.0, "h": 0.1, "lam": 1.2e11, "mu": 8e10, "A_j": -2e7}
X, Y = sp.Symbol("x", real=True), sp.Symbol("y", positive=True)


def close(ball: flint.arb, expected: mpf | str, digits: int) -> bool:
    """Return whether an Arb ball agrees with a number to `digits` digits."""
    with flint.ctx.workprec(700):
        known = flint.arb(str(expected))
        return bool(abs(ball - known) < abs(known) * flint.arb(10) ** -digits)


# --- zeros of J0


def test_first_zero_agrees_with_the_published_one() -> None:
    assert first_zero_is_first()
    assert close(j0_zero(1, 180), FIRST_ZERO, 50)


@pytest.mark.parametrize("index", [2, 3, 10, 77, 1000, 10**6])
def test_zeros_agree_with_mpmath(index: int) -> None:
    with mp.workdps(60):
        assert close(j0_zero(index, 180), mp.nstr(mp.besseljzero(0, index), 58), 50)
        assert close(
            j1_at_zero(index, 180), mp.nstr(mp.besselj(1, mp.besseljzero(0, index)), 58), 50
        )


def test_no_zero_is_skipped_or_counted_twice() -> None:
    """J0 has one sign between neighbouring zeros, and the signs alternate.

    The sign is checked at points so close that, because of |J0'| <= 1, it cannot change between
    them. The first and the last hundredth of each interval are too close to a zero for this, and
    too narrow to contain two further zeros.
    """
    zeros = [j0_zero(n, 80) for n in range(1, 13)]
    with flint.ctx.workprec(100):
        for n, (left, right) in enumerate(itertools.pairwise(zeros), start=1):
            step = (right - left) / 1000
            for k in range(10, 990):
                value = (left + k * step).bessel_j(0)
                assert bool(value < 0) == (n % 2 == 1)
                assert abs(value) > step


def test_zero_has_the_requested_precision() -> None:
    assert j0_zero(5, 300).rel_accuracy_bits() >= 300


def test_zeros_are_counted_from_one() -> None:
    with pytest.raises(ValueError, match="at least 1"):
        j0_zero(0, 100)


# --- tapes


def test_tape_gradient_equals_the_sympy_derivative() -> None:
    x, y = sp.symbols("x y", positive=True)
    expression = (
        sp.sin(x * y) * sp.besselj(1, x) / (1 + sp.sqrt(y)) ** 3
        + sp.exp(-x) * sp.cosh(y) * sp.sinh(x / y)
        - sp.pi * sp.cos(y) * sp.besselj(0, x * y)
    )
    tape = record(expression, (x, y))
    point = {x: sp.Rational(7, 5), y: sp.Rational(3, 11)}
    with flint.ctx.workprec(200):
        inputs = [flint.arb(7) / 5, flint.arb(3) / 11]
        slots = tape.run(inputs)
        gradient = tape.gradient(slots)
    assert close(slots[-1], expression.subs(point).evalf(55), 45)
    for symbol, slope in zip((x, y), gradient, strict=True):
        assert close(slope, sp.diff(expression, symbol).subs(point).evalf(55), 45)


@pytest.mark.parametrize(
    "expression",
    [
        *(function(1 / X if function is sp.acosh else X) for function in FUNCTIONS),
        X**Y,
        X ** sp.Rational(-3, 2),
        sp.besseli(2, X),
        sp.besselj(sp.Rational(1, 2), X),
        sp.beta(X, Y),
    ],
    ids=str,
)
def test_derivatives_of_each_operation_equal_the_sympy_derivatives(expression: sp.Expr) -> None:
    tape = record(expression, (X, Y))
    with flint.ctx.workprec(200):
        slots = tape.run([flint.arb(2) / 5, flint.arb(3) / 11])
        gradient = tape.gradient(slots)
    point = {X: sp.Rational(2, 5), Y: sp.Rational(3, 11)}
    assert close(slots[-1], expression.subs(point).evalf(55), 45)
    for symbol, slope in zip((X, Y), gradient, strict=True):
        expected = sp.diff(expression, symbol).subs(point).evalf(55)
        assert close(slope, expected, 45) if expected else slope == 0


def test_tape_of_an_input_alone() -> None:
    x, y = sp.symbols("x y")
    tape = record(x, (x, y))
    slots = tape.run([flint.arb(3), flint.arb(5)])
    assert slots[-1] == 3
    assert [float(g) for g in tape.gradient(slots)] == [1.0, 0.0]


def test_tape_rejects_functions_without_enclosure_and_unknown_symbols() -> None:
    x, y = sp.symbols("x y")
    with pytest.raises(NotImplementedError, match="zeta"):
        record(sp.zeta(x), (x,))
    with pytest.raises(ValueError, match="depends on y"):
        record(x + y, (x,))


# --- Arb reference


def test_plate_factor_of_a_thick_plate_is_one() -> None:
    """G(T) - 1 = (4 T^2 + 4 T + 2) e^(-2T) to first order in e^(-2T)."""
    T = 60.0
    with mp.workdps(60):
        leading = (4 * mpf(T) ** 2 + 4 * T + 2) * mp.exp(-2 * mpf(T))
        assert close(certified_value("G_minus_1", {"T": T}), mp.nstr(leading, 55), 45)
    assert close(certified_value("G", {"T": 200.0}), "1", 50)


def test_plate_factors_of_a_thin_plate_agree_with_plate_theory() -> None:
    """On both faces the factor tends to 6/T^3, the deflection in Kirchhoff plate theory."""
    for name in ("G", "G_m"):
        with flint.ctx.workprec(300):
            scaled = certified_value(name, {"T": 2.0**-100}) * flint.arb(2) ** -300
        assert close(scaled, "6", 50)


def test_hertz_force_of_a_known_case() -> None:
    """P = (4/3) E* a^3/R; E = 1, nu = 0 have lam = 0, mu = 1/2, E* = 1."""
    force = certified_value("P", {"R": 2.0, "a": 0.5, "lam": 0.0, "mu": 0.5})
    with flint.ctx.workprec(300):
        assert close(12 * force, "1", 50)


def test_sonine_integral_of_a_long_wave_is_the_resultant_of_the_pressure() -> None:
    """int_0^a r sqrt(1 - r^2/a^2) dr = a^2/3."""
    with flint.ctx.workprec(300):
        assert close(12 * certified_value("sonine", {"phi": 1e-150, "a": 0.5}), "1", 50)


def test_stresses_on_the_faces_equal_the_load() -> None:
    above, below = MODE | {"z": MODE["h"]}, MODE | {"z": -MODE["h"]}
    assert close(certified_value("mode_zz", above), str(int(MODE["A_j"])), 50)
    assert certified_value("mode_zz", below) == 0
    assert certified_value("mode_rz", above) == 0
    assert certified_value("mode_rz", below) == 0


def test_in_plane_stresses_are_equal_on_the_axis() -> None:
    values = PLATE | {"r": 0.0}
    rr, tt = (certified_value(f"sigma_{name}", values, 50, 12) for name in ("rr", "tt"))
    assert rr.overlaps(tt)
    near = certified_value("sigma_rr", PLATE | {"r": 1e-40}, 50, 12)
    assert bool(abs(near - rr) < abs(rr) * flint.arb(10) ** -45)
    assert certified_value("u", values, 50, 12) == 0


def test_deflection_at_the_edge_is_zero() -> None:
    assert certified_value("w", PLATE | {"r": 1.0}, 50, 5) == 0


def test_first_mode_of_the_indentation_against_mpmath() -> None:
    """Compare with one mode of the contact law, written out in mpmath."""
    with mp.workdps(60):
        j = mp.besseljzero(0, 1)
        T, y = 2 * j * mpf(PLATE["h"]), j * mpf(PLATE["a"])
        factor = (mp.sinh(T) * mp.cosh(T) + T) / (mp.sinh(T) ** 2 - T**2)
        K = 8 * factor / (mp.pi * mpf(PLATE["R"]) * j**4 * mp.besselj(1, j) ** 2)
        expected = mp.nstr(K * (mp.sin(y) - y * mp.cos(y)), 55)
    values = {key: PLATE[key] for key in ("h", "b", "R", "a")}
    assert close(certified_value("delta", values, 50, 1), expected, 45)


def test_only_values_below_the_floor_are_set_to_zero() -> None:
    assert certified_value("G_minus_1", {"T": 1e6}) == 0
    small = certified_value("G_minus_1", {"T": 400.0})
    assert bool(0 < small < flint.arb(2) ** -1074)
    assert small.rel_accuracy_bits() > 166


@pytest.mark.parametrize("digits", [20, 50, 200])
def test_value_has_the_requested_number_of_digits(digits: int) -> None:
    ball = certified_value("G", {"T": 1e-60}, digits)
    assert ball.rel_accuracy_bits() > digits * math.log2(10)


def test_condition_numbers_are_logarithmic_derivatives() -> None:
    with mp.workdps(40):
        expected = mp.diff(
            lambda T: mp.log((mp.sinh(T) * mp.cosh(T) + T) / (mp.sinh(T) ** 2 - T**2)), 1.3
        ) * mpf(1.3)
    assert reference("G", {"T": 1.3}).condition["T"] == pytest.approx(
        abs(float(expected)), rel=1e-12
    )
    assert reference("P", {"R": 2.0, "a": 0.5, "lam": 0.0, "mu": 0.5}).condition == pytest.approx(
        {"R": 1.0, "a": 3.0, "lam": 0.0, "mu": 1.0}
    )


def test_condition_of_a_modal_sum_includes_the_change_of_the_wave_numbers() -> None:
    """The condition number for b equals a finite difference of the sum, here of one mode."""
    values = {key: PLATE[key] for key in ("h", "b", "R", "a")}
    step = 1e-6
    up, down = (
        certified_value("delta", values | {"b": values["b"] * (1 + s)}, 50, 1)
        for s in (step, -step)
    )
    slope = float((up - down) / (2 * step) / certified_value("delta", values, 50, 1))
    assert reference("delta", values, 50, 1).condition["b"] == pytest.approx(abs(slope), rel=1e-6)


def test_condition_numbers_where_the_value_is_zero() -> None:
    reference_result = reference("mode_rz", MODE | {"z": MODE["h"]})
    assert reference_result.condition["z"] == math.inf
    assert math.isnan(reference_result.condition["A_j"])
    assert reference_result.sensitivity["z"] > 0


def test_singular_point_is_rejected() -> None:
    with pytest.raises(PrecisionError):
        certified_value("G", {"T": 0.0})
    with pytest.raises(PrecisionError):
        certified_value("G", {"T": math.nan})


def test_invalid_arguments_are_rejected() -> None:
    with pytest.raises(KeyError, match="missing: \\['T'\\]"):
        certified_value("G", {})
    with pytest.raises(KeyError, match="unknown: \\['q'\\]"):
        certified_value("G", {"T": 1.0, "q": 1.0})
    with pytest.raises(KeyError, match="no formula 'F'"):
        certified_value("F", {"T": 1.0})
    with pytest.raises(ValueError, match="not a modal sum"):
        certified_value("G", {"T": 1.0}, 50, 3)
    with pytest.raises(ValueError, match="number of modes"):
        certified_value("w", PLATE)


# --- mpmath reference, and agreement of both


def draw(name: str, generator: random.Random) -> dict[str, float]:
    """Return random arguments in the domain of a formula."""
    size = generator.uniform(0.5, 2.0)
    values = {
        "h": size,
        "phi": 10 ** generator.uniform(-3.0, 1.3) / size,
        "T": 10 ** generator.uniform(-3.0, 1.6),
        "z": size * generator.uniform(-1.0, 1.0),
        "b": size * generator.uniform(2.0, 9.0),
        "R": generator.uniform(3.0, 9.0),
        "a": size * generator.uniform(0.1, 0.9),
        "lam": generator.uniform(-0.5, 9.0),
        "mu": generator.uniform(1.0, 3.0),
        "P": generator.uniform(1.0, 9.0),
        "A_j": generator.uniform(-9.0, -1.0),
        "J1": generator.uniform(0.1, 0.5),
        "x": generator.uniform(0.0, 50.0),
        "count": float(generator.randrange(1, 200)),
        "n": float(generator.randrange(60)),
        "k": float(generator.randrange(2, 60)),
        **{f"C{k}": generator.uniform(-1.0, 1.0) for k in range(1, 5)},
    }
    values["r"] = values["a" if name == "p" else "b"] * generator.uniform(0.0, 1.0)
    return {key: values[key] for key in arguments(name)}


@pytest.mark.parametrize("name", names())
def test_references_agree_to_fifty_digits(name: str) -> None:
    generator = random.Random(name)
    modes = 2 if is_summed(name) else None
    slow = is_summed(name) or set(arguments(name)) <= {"n", "k"}
    for _ in range(1 if slow else 3):
        agree(name, draw(name, generator), 50, modes)


def test_formulas_and_routes_have_the_same_names() -> None:
    assert set(names()) == set(routes.ROUTES)


@pytest.mark.parametrize("x", [1e-30, 1e-8, 200.0])
def test_references_agree_for_very_small_and_large_arguments(x: float) -> None:
    for name in ("mode_f", "mode_rr", "mode_zz", "C_bottom", "Omega_1_scaled"):
        values = MODE | {"phi": 8 * x, "h": 0.125, "z": 0.0625}
        agree(name, {key: values[key] for key in arguments(name)}, 50)


def test_references_agree_on_an_exact_zero() -> None:
    assert agree("mode_rz", MODE | {"z": -MODE["h"]}, 50) == 0


def test_disagreement_of_the_references_is_an_error() -> None:
    flipped = {**routes.ROUTES, "G": lambda v: -routes.ROUTES["G_m"](v)}
    with pytest.raises(OracleError, match="against"):
        replace(routes.ORACLE, routes=flipped).agree("G", {"T": 1.3})


def test_route_rejects_oscillating_integrals_and_unknown_names() -> None:
    with pytest.raises(RouteError, match="oscillates"):
        routes.value("sonine", {"phi": 1e6, "a": 1.0})
    with pytest.raises(KeyError, match="no route"):
        routes.value("F", {})


def test_integral_over_point_loads_gives_the_hertz_force() -> None:
    """Quadrature over Boussinesq point loads gives (4/3) E* a^3/R; here E* = 1."""
    force = routes.value("P", {"R": 1.0, "a": 0.5, "lam": 0.0, "mu": 0.5}, 40)
    with mp.workdps(45):
        assert abs(force * 6 - 1) < mpf(10) ** -38


def test_mpmath_numbers_convert_exactly_to_arb() -> None:
    with mp.workdps(80):
        number = -mp.pi * mpf(10) ** -500
        ball = agreement.to_ball(number)
    assert ball.is_exact()
    with mp.workdps(80):
        man, exp = ball.man_exp()
        assert mpmath.ldexp(mpf(int(man)), int(exp)) == number
    assert agreement.to_ball(mpf(0)) == 0


def test_floor_of_both_references_is_below_every_double() -> None:
    assert bool(flint.arb(2) ** -1180 > oracle.FLOOR)
    assert -agreement.FLOOR_DIGITS * math.log2(10) < -1180
