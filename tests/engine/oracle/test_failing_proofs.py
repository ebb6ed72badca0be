"""Proofs, bounds and printers raise an error if one of their inputs is made wrong."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import flint
import pytest
import sympy as sp
from flint import acb, arb

from derivation.engine.emit import printer, source
from derivation.engine.formula import hyperbolic
from derivation.engine.formula.ball import enclose
from derivation.engine.formula.dimension import LENGTH, DimensionError, dimension
from derivation.engine.formula.parse import FormulaError, parse
from derivation.engine.formula.proof import ProofError, lower_bessel
from derivation.plate.contact.theory import (
    divergence,
    moments,
    reversion,
    spherical_profile,
    thin_plate,
    thin_roots,
)
from derivation.plate.contact.theory import split as contact_split
from derivation.plate.impact.oracle import quantities as contact_quantities
from derivation.plate.impact.theory import substitution
from derivation.plate.pressure.theory import bound as pressure_bound
from derivation.plate.vocabulary import PLATE, phi

x = sp.Symbol("x", positive=True)


class ZeroNewtonSteps(int):
    """A precision that makes Newton's iteration end before its first step."""

    def bit_length(self) -> int:
        return -4


# --- theory


def test_sum_identity_fails_for_a_wrong_integral(monkeypatch: pytest.MonkeyPatch) -> None:
    wrong = replace(contact_split._TEST_FUNCTIONS[0], integral=2)  # int_0^oo e^(-x) dx is 1
    monkeypatch.setattr(contact_split, "_TEST_FUNCTIONS", (wrong,))
    with pytest.raises(ProofError, match=r"Sum identity: exp\(-x\) gives"):
        contact_split.identity_in_balls.__wrapped__()


def test_roots_without_newton_steps_are_not_certified() -> None:
    with pytest.raises(ProofError, match="zero 1 of J0 is not in"):
        contact_split.zero_of_j0.__wrapped__(1, ZeroNewtonSteps(60))
    with pytest.raises(ArithmeticError, match=r"root 1 of sinh T = \+-T is not shown"):
        thin_roots.root.__wrapped__(1, ZeroNewtonSteps(60))


def changed(module: Any, **names: Any) -> Any:
    """Return a copy of the namespace of a module with some names replaced."""
    return SimpleNamespace(**vars(module) | names)


def test_profile_that_is_not_spherical_is_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    spherical_profile._powers()
    monkeypatch.setattr(
        spherical_profile,
        "sp",
        changed(sp, log=lambda u: sp.log(u) * (1 + spherical_profile._x**2)),
    )
    with pytest.raises(ProofError, match="delta' of the sphere: power 3 differs"):
        spherical_profile._powers()


def test_bounds_on_the_remainder_of_the_plate_factor_are_checked(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Neither bound holds if it is evaluated at T = 1/2 instead of T = 1."""
    half = changed(flint, arb=lambda n: arb(-1 if n == -2 else n))
    monkeypatch.setattr(moments, "flint", half)
    with pytest.raises(ProofError, match=r"d\(1\) or E\(1\) is below its bound"):
        moments.excess_beyond_first.__wrapped__()


def test_contact_wider_than_the_bound_allows_is_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pressure_bound, "WIDEST", pressure_bound.WIDTH / 2)
    with pytest.raises(ProofError, match="the actual contact may be too wide"):
        pressure_bound.lateral_ratio.__wrapped__()


def test_quadrature_bound_rejects_zeros_of_the_radicand() -> None:
    """A single interval that covers the whole ellipse contains zeros of the radicand."""
    with flint.ctx.workprec(53), pytest.raises(ArithmeticError, match="radicand may vanish"):
        substitution.time_quadrature_bound(24, arcs=1, boxes=1)


def test_power_series_has_no_value_where_its_tail_has_no_bound(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    poles = {-3: sp.Integer(6), -1: sp.Rational(6, 5)}
    monkeypatch.setattr(
        thin_plate, "plate_factor_at_zero", lambda: SimpleNamespace(at=poles.__getitem__)
    )
    with flint.ctx.workprec(64):
        assert not thin_plate.regular_part(acb(100)).is_finite()
        exact = thin_plate.plate_excess(arb(2)) + 1 - arb(6) / 8 - arb(6) / 10
        assert abs(thin_plate.regular_part(acb(2)) - acb(exact)) < 1e-15


@pytest.mark.parametrize(
    ("power", "message"), [(1, "grow like j"), (2, "grow like j^2"), (-2, "decrease like j^(-2)")]
)
def test_tail_of_a_sum_is_described_by_its_power(power: int, message: str) -> None:
    actual = divergence.tail(phi**power)
    assert actual.exponent == power
    assert actual.kind == (divergence.CONVERGENT if power < -1 else divergence.DIVERGENT)
    assert actual.finding.split(", ")[0].endswith(message)


@pytest.mark.parametrize("law", [(-3.1, 4.9), (2.4, -0.8, -2.5)])
def test_radius_of_convergence_agrees_with_the_growth_of_the_terms(law: tuple[float, ...]) -> None:
    """Closer critical values on another branch of the inverse function do not matter.

    Lagrange: A = sum_n eps^n/n [A^(n-1)] law^(-n/2), whose terms grow as radius^-n n^(-3/2).
    """
    with flint.ctx.workprec(500):
        series = [arb(1)] + [arb(0)] * 200
        series[1 : 2 * len(law) : 2] = map(arb, law)
        sizes = []
        for n in range(195, 201):
            term = contact_quantities.power(series[:n], arb(-n) / 2)[n - 1] / n
            sizes.append(float((abs(term) * arb(n) ** 1.5).log() / n))
    assert math.exp(-max(sizes)) == pytest.approx(reversion.radius(law), rel=0.02)


def test_law_without_coefficients_has_no_radius_of_convergence(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with pytest.raises(ValueError, match="expected a coefficient that is not zero, got none"):
        reversion.radius([0.0, 0.0])
    monkeypatch.setattr(reversion, "_reaches", lambda *_: False)
    assert reversion.radius([1.0]) == math.inf


# --- formula


def test_constants_e_and_euler_gamma_are_enclosed() -> None:
    with flint.ctx.workprec(100):
        assert enclose(sp.E, {}).overlaps(arb(1).exp())
        assert enclose(sp.E * sp.EulerGamma, {}).rad() < 1e-28


def test_bessel_functions_of_negative_order_are_reflected() -> None:
    """J_(-n) = (-1)^n J_n and I_(-n) = I_n, also if SymPy has not evaluated them."""
    for kind, sign in ((sp.besselj, -1), (sp.besseli, 1)):
        assert lower_bessel(kind(-1, x, evaluate=False)) == sign * kind(1, x)


def test_symbol_without_a_dimension_is_rejected() -> None:
    with pytest.raises(DimensionError, match="the dimension of x is not known"):
        dimension(phi * x, {phi: LENGTH**-1})


def test_mixed_odd_and_even_powers_are_rejected() -> None:
    E, Q = sp.symbols("E Q", positive=True)
    assert hyperbolic._in_squares(E**3 - E, E, Q) == (1, Q - 1)
    with pytest.raises(ValueError, match="odd and even powers of E are mixed in E"):
        hyperbolic._in_squares(E**3 + E**2, E, Q)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("+".join(["a"] * 300), "nested deeper than 200 levels: split it"),
        (f"sinh({','.join(['a'] * 4000)})", "more than 6000 parts: split it"),
    ],
)
def test_excessively_long_formulas_are_rejected(text: str, message: str) -> None:
    with pytest.raises(FormulaError, match=message):
        parse(text, PLATE)


# --- emit


@pytest.mark.parametrize(
    "expression", [sp.Float("0.1") * x * sp.exp(x), sp.Rational(1, 2**60) * x, 2 * x / 3, -x / 7]
)
def test_printed_expressions_have_the_value_of_the_formula(expression: sp.Expr) -> None:
    printed = eval(printer.to_numpy(expression), {"np": math, "x": 0.7})
    assert printed == pytest.approx(float(expression.subs(x, sp.Float(0.7, 30))), rel=1e-15)


def test_invalid_python_is_rejected_by_the_formatter() -> None:
    assert source.format_files({"a.py": "x=1\n"}) == {"a.py": "x = 1\n"}
    with pytest.raises(RuntimeError, match="ruff check failed"):
        source.format_files({"a.py": "def (:\n"})
