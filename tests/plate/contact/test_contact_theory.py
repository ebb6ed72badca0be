"""Test the contact law from its sums: divergence, split, coefficients, inversion."""

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from itertools import pairwise

import flint
import mpmath as mp
import pytest
import sympy as sp

from derivation.engine.formula.proof import ProofError, prove
from derivation.plate.contact.theory import divergence, plate_series, reversion, thin_plate
from derivation.plate.contact.theory import split as contact_split
from derivation.plate.vocabulary import (
    J1,
    Formula,
    M,
    R,
    a,
    a_ratio,
    alpha,
    b,
    c_A,
    eta,
    h,
    j_n,
    kappa,
    phi,
)

ETAS = ("0.1", "0.35", "1.2")


@cache
def zeros(count: int) -> tuple[tuple[mp.mpf, mp.mpf], ...]:
    """Return (j_n, J1(j_n)) to 40 digits by Newton's iteration from McMahon's first terms."""
    actual = []
    with flint.ctx.workprec(160), mp.workdps(40):
        for n in range(1, count + 1):
            start = (n - flint.arb(1) / 4) * flint.arb.pi()
            j = start + 1 / (8 * start)
            for _ in range(6):
                j = (j + j.bessel_j(0) / j.bessel_j(1)).mid()
            actual.append(tuple(mp.mpf(x.str(40, radius=False)) for x in (j, j.bessel_j(1))))
    return tuple(actual)


def G(T: mp.mpf) -> mp.mpf:
    return (mp.sinh(T) * mp.cosh(T) + T) / (mp.sinh(T) ** 2 - T**2)


@cache
def lateral_moment(n: int) -> mp.mpf:
    """Return kappa_n by quadrature; y = u^3 weakens the logarithmic singularity at 0."""
    with mp.workdps(20):
        return lateral_integral(lambda y: y**n, "1e-6")


def lateral_integral(density: Callable[[mp.mpf], mp.mpf], start: str = "1e-3") -> mp.mpf:
    """Return int density(y) K0(y)/I0(y) dy from y = start^3 to infinity, to 20 digits."""

    def spread(u: mp.mpf) -> mp.mpf:
        y = u**3
        return 3 * u**2 * density(y) * mp.besselk(0, y) / mp.besseli(0, y)

    with mp.workdps(20):
        return mp.quad(spread, [mp.mpf(start), 1, 2, 3, 3.5])


def count_for(ratio: mp.mpf) -> int:
    """Return the number of modes after which G(2 eta j) - 1 is below 1e-18."""
    return int(mp.mpf("3.5") / ratio) + 12


def c_by_sum(k: int, ratio: mp.mpf) -> mp.mpf:
    """Return c_(2k-3) from its sum and integral, written here independently."""
    total = mp.fsum(
        j ** (2 * k - 5) * (G(2 * ratio * j) - 1) / J**2 for j, J in zeros(count_for(ratio))
    )
    size = mp.mpf(2 * k - 2) / mp.factorial(2 * k - 1)
    inner = (-1) ** k * 8 / mp.pi * total - 8 / mp.pi**2 * lateral_moment(2 * k - 4)
    return ratio ** (2 * k - 3) * size * inner


def recorded(formulas: Mapping[str, Formula], k: int, ratio: str) -> mp.mpf:
    """Return c_(2k-3) from the two derived parts, with the sum evaluated by mpmath."""
    order = 2 * k - 3
    mode = sp.lambdify((eta, j_n, J1), formulas[f"c_{order}_modes"].expression, "mpmath")
    side = sp.lambdify((eta, kappa[2 * k - 4]), formulas[f"c_{order}_lateral"].expression, "mpmath")
    number = mp.mpf(ratio)
    with mp.workdps(60):
        total = mp.fsum(mode(number, j, J) for j, J in zeros(count_for(number)))
    return total + side(number, lateral_moment(2 * k - 4))


def ball(value: flint.arb, digits: int = 25) -> mp.mpf:
    return mp.mpf(value.str(digits, radius=False))


@pytest.mark.parametrize("eta_text", ETAS)
def test_limit_of_the_influence_for_high_modes(
    formulas: Mapping[str, Formula], eta_text: str
) -> None:
    """phi^3 K_j from its closed form at the 300th mode agrees with the limit."""
    b_v, R_v = mp.mpf("1.7"), mp.mpf("0.4")
    j = mp.besseljzero(0, 300)
    K = 8 * G(2 * mp.mpf(eta_text) * j) / (mp.pi * R_v * b_v**2 * (j / b_v) ** 4)
    K /= mp.besselj(1, j) ** 2
    expected = formulas["K_j_limit"].expression.subs({R: sp.Rational("0.4"), b: sp.Rational("1.7")})
    assert abs((j / b_v) ** 3 * K / mp.mpf(expected.evalf(20)) - 1) < mp.mpf("1e-6")


@pytest.mark.parametrize("k", [2, 3])
def test_truncated_gamma_has_the_derived_growth(formulas: Mapping[str, Formula], k: int) -> None:
    """The partial sum of 400 modes has the derived leading growth, for h = 0.3 and the rest 1."""
    point = {"a": 1, "P": 1, "R": 1, "b": 1}
    formula = formulas[f"gamma_{k}_truncated"].expression
    modes = {str(s): s for s in formula.free_symbols}
    size = formula.subs({modes[name]: value for name, value in point.items() if name in modes})
    term = 8 * (-1) ** k * mp.mpf(2 * k - 2) / mp.factorial(2 * k - 1) / mp.pi
    partial = mp.fsum(term * j ** (2 * k - 5) * G(mp.mpf("0.6") * j) / J**2 for j, J in zeros(400))
    expected = mp.mpf(size.subs(modes["N"], 400).evalf(20))
    assert abs(partial / expected - 1) < mp.mpf("2e-2")


def test_divergence_follows_from_the_terms() -> None:
    K = sp.Symbol("unused", positive=True)
    assert divergence.tail(phi**-2).kind == divergence.CONVERGENT
    assert divergence.tail(1 / phi).kind == divergence.DIVERGENT
    assert divergence.tail(phi ** sp.Rational(-101, 100)).kind == divergence.CONVERGENT
    assert divergence.tail(sp.sin(a * phi) / phi).kind == divergence.UNDECIDED
    assert divergence.tail(phi**9 * sp.exp(-h * phi)).kind == divergence.CONVERGENT
    assert divergence.tail(sp.sinh(h * phi) / phi**9).kind == divergence.DIVERGENT
    assert divergence.tail(J1 / (phi * K)).exponent == sp.Rational(-3, 2)
    for k in range(2, 7):
        assert divergence.tail(divergence.printed_term(k)).kind == divergence.DIVERGENT
    term = divergence.printed_term(2) / phi**3 * sp.sin(a * phi)
    assert divergence.tail(term).kind == divergence.CONVERGENT


def averaged_sum(terms: Sequence[mp.mpf]) -> mp.mpf:
    """Return the sum of a slowly oscillating series by three running means of partial sums."""
    sums = [mp.mpf(0)]
    for term in terms:
        sums.append(sums[-1] + term)
    window = sums[len(sums) // 4 :]
    for _ in range(3):
        totals = [mp.mpf(0)]
        for value in window:
            totals.append(totals[-1] + value)
        half = len(window) // 3
        window = [(totals[i + half] - totals[i]) / half for i in range(len(window) - half)]
    return window[-1]


@pytest.mark.parametrize("ratio", ["0.2", "0.9", "1.6"])
def test_sum_identity_with_the_sonine_integral(ratio: str) -> None:
    """sum s(alpha j)/(j^4 J1^2), summed directly, equals the expression with the integral."""
    with mp.workdps(30):
        r = mp.mpf(ratio)
        terms = [(mp.sin(r * j) - r * j * mp.cos(r * j)) / (j**4 * J**2) for j, J in zeros(800)]
        side = lateral_integral(lambda y: (r * y * mp.cosh(r * y) - mp.sinh(r * y)) / y**3)
        expected = mp.pi * r**2 / 8 - side / mp.pi
        assert abs(averaged_sum(terms) - expected) < mp.mpf("1e-8")


def test_identity_holds_in_interval_arithmetic() -> None:
    assert contact_split.identity_in_balls().residuals == ("exp(-x)", "x exp(-x)")


def test_certified_zeros_agree_with_mpmath() -> None:
    for n in (1, 2, 17):
        assert abs(ball(contact_split.zero_of_j0(n, 120), 30) - mp.besseljzero(0, n)) < 1e-14


def split_of(formulas: Mapping[str, Formula], r: mp.mpf, e: mp.mpf) -> mp.mpf:
    """Return F(alpha, eta) from the two derived parts."""
    integrand, (y, *_) = formulas["F_lateral"].expression.args
    weight = sp.besselk(0, y) / sp.besseli(0, y)
    density = sp.lambdify((alpha, y), integrand / weight, "mpmath")
    mode = sp.lambdify((alpha, eta, j_n, J1), formulas["F_modes"].expression, "mpmath")
    modes = mp.fsum(mode(r, e, j, J) for j, J in zeros(count_for(e)))
    return modes + lateral_integral(lambda value: density(r, value))


@pytest.mark.parametrize(("ratio", "eta_text"), [("0.3", "0.2"), ("0.7", "0.4")])
def test_split_agrees_with_the_modal_sum(
    formulas: Mapping[str, Formula], ratio: str, eta_text: str
) -> None:
    """The averaged sum of the paper over 800 modes agrees with 1 + F."""
    with mp.workdps(30):
        r, e = mp.mpf(ratio), mp.mpf(eta_text)
        terms = [
            8
            / (mp.pi * r**2)
            * (mp.sin(r * j) - r * j * mp.cos(r * j))
            * G(2 * e * j)
            / (j**4 * J**2)
            for j, J in zeros(800)
        ]
        assert abs(averaged_sum(terms) - 1 - split_of(formulas, r, e)) < mp.mpf("1e-7")


@pytest.mark.parametrize("eta_text", ETAS)
@pytest.mark.parametrize("k", [2, 3, 4, 5])
def test_coefficients_agree_with_a_direct_sum(
    formulas: Mapping[str, Formula], k: int, eta_text: str
) -> None:
    with mp.workdps(30):
        expected = c_by_sum(k, mp.mpf(eta_text))
        got = recorded(formulas, k, eta_text)
    assert abs(got / expected - 1) < mp.mpf("1e-13")


def test_series_agrees_with_the_split(formulas: Mapping[str, Formula]) -> None:
    """c_1 A + ... + c_7 A^7 at a/h = 0.2 agrees with F from quadrature and sum."""
    with mp.workdps(30):
        r, e = mp.mpf("0.08"), mp.mpf("0.4")
        values = {c_A[2 * k - 3]: recorded(formulas, k, "0.4") for k in range(2, 6)}
        law = sp.lambdify((a_ratio, *values), formulas["delta_reduced"].expression - 1, "mpmath")
        series = law(r / e, *values.values())
        assert abs(series - split_of(formulas, r, e)) < 2e-9
        assert abs(series) > 0.01


def test_c1_vanishes_near_h_over_b_0_5302() -> None:
    with mp.workdps(20):
        root = mp.findroot(lambda e: c_by_sum(2, e), (mp.mpf("0.5"), mp.mpf("0.56")))
    assert abs(root - mp.mpf("0.5302")) < 1e-4


def test_only_the_lateral_surface_remains_for_thick_plates() -> None:
    """For h >> b only the lateral surface remains: delta R/a^2 = 1 - 0.36953 a/b + ..."""
    _, side = plate_series.coefficient(2).by_plate_radius
    value = side.subs(kappa[0], sp.Float(plate_series.kappa_ball(0, 20).str(20, radius=False)))
    assert abs(float(value) + 0.36953) < 5e-6


@pytest.mark.parametrize("n", [0, 2, 4])
def test_kappa_agrees_with_quadrature(n: int) -> None:
    got = plate_series.kappa_ball(n, 30)
    assert got.rel_accuracy_bits() > 99
    assert abs(ball(got) / lateral_moment(n) - 1) < mp.mpf("1e-10")
    assert plate_series.kappa_ball(n, 45).overlaps(got)


PUBLISHED = {
    2: "-1.12648392978257645242944",
    3: "7.72386466370692885870034",
    4: "41.9670644769000627482199",
}


@pytest.mark.parametrize("k", PUBLISHED)
def test_finite_parts_agree_with_published_values_and_quadrature(k: int) -> None:
    got = thin_plate.finite_part_ball(k, 30)
    assert got.rel_accuracy_bits() > 99
    with mp.workdps(30):
        assert abs(ball(got, 28) / mp.mpf(PUBLISHED[k]) - 1) < mp.mpf("1e-22")
        # Independent method: continue the Mellin transform by subtracting terms on (0, 2).
        cut = mp.mpf(2)
        inner = mp.quad(
            lambda T: T ** (2 * k - 4) * (G(T) - 6 / T**3 - mp.mpf(6) / 5 / T),
            [mp.mpf("1e-3"), 1, cut],
        )
        outer = mp.quad(lambda T: T ** (2 * k - 4) * (G(T) - 1), [cut, 6, 14, 40])
        ends = -(cut ** (2 * k - 3)) / (2 * k - 3)
        for power, value in ((-3, mp.mpf(6)), (-1, mp.mpf(6) / 5)):
            exponent = power + 2 * k - 3
            ends += value * (mp.log(cut) if exponent == 0 else cut**exponent / exponent)
        assert abs(inner + outer + ends - ball(got)) < mp.mpf("1e-5")


@pytest.mark.parametrize("k", [2, 3, 4])
@pytest.mark.parametrize(("eta_text", "error"), [("0.1", "1e-16"), ("0.2", "1e-8")])
def test_thin_plate_coefficients_agree_with_the_sum(
    formulas: Mapping[str, Formula], k: int, eta_text: str, error: str
) -> None:
    """The error of the thin-plate form is of order e^(-42) at eta = 0.1 and e^(-21) at 0.2."""
    with mp.workdps(30):
        exact = c_by_sum(k, mp.mpf(eta_text))
        formula = formulas[f"c_{2 * k - 3}_thin"].expression
        finite = sp.Float(thin_plate.finite_part_ball(k, 28).str(28, radius=False), 30)
        thin = mp.mpf(str(formula.subs({M[k]: finite, eta: sp.Rational(eta_text)}).evalf(28)))
        assert abs(thin - exact) < mp.mpf(error) * max(1, abs(exact))
    if eta_text == "0.2":
        assert abs(thin - exact) > mp.mpf("1e-16")


def test_bending_agrees_with_kirchhoff(formulas: Mapping[str, Formula]) -> None:
    """The first term of c_1 is Kirchhoff's deflection P b^2/(8 pi D) divided by a^3/(R h).

    Here D = E* (2h)^3/12 and P = 4 E* a^3/(3 R).
    """
    leading = sp.limit(formulas["c_1_thin"].expression * eta**2, eta, 0)
    stiffness = sp.Rational(8, 12)
    assert leading == sp.Rational(4, 3) / (8 * sp.pi * stiffness)


def test_formal_inversion_agrees_numerically(formulas: Mapping[str, Formula]) -> None:
    """For small P the series with the xi_k inverts delta(P) up to the omitted order."""
    texts = {2: "0.7", 3: "-0.3", 4: "0.2", 5: "-1", 6: "2"}
    numbers = {f"gamma_{k}": sp.Rational(text) for k, text in texts.items()}

    def error(P: mp.mpf) -> mp.mpf:
        third = mp.mpf(1) / 3
        delta = mp.fsum(mp.mpf(x) * P ** ((2 * k - 1) * third) for k, x in texts.items())
        total = mp.mpf(0)
        for k in texts:
            xi = formulas[f"xi_{k}"].expression
            exact = xi.subs({s: numbers[str(s)] for s in xi.free_symbols})
            total += mp.mpf(str(exact.evalf(70))) * delta ** ((2 * k - 1) * third)
        return total - P

    with mp.workdps(70):
        ratio = error(mp.mpf("1e-9")) / error(mp.mpf("1e-12"))
        assert abs(mp.log(ratio, 10) - mp.mpf(13)) < 0.05


def test_xi_3_has_the_power_eight_thirds(formulas: Mapping[str, Formula]) -> None:
    two, three = sp.symbols("gamma_2 gamma_3", positive=True)
    xi = formulas["xi_3"].expression
    named = {s: {"gamma_2": two, "gamma_3": three}[str(s)] for s in xi.free_symbols}
    assert sp.simplify(xi.subs(named) + three / two ** sp.Rational(8, 3)) == 0


@pytest.mark.parametrize("law", [(1.0,), (-0.3,), (8.0, -0.05, 0.002), (0.5, -0.1, 0.02)])
def test_force_series_diverges_outside_its_radius(law: tuple[float, ...]) -> None:
    """The root test on 90 coefficients gives the convergence radius."""
    values = {c_A[2 * i + 1]: sp.Rational(str(value)) for i, value in enumerate(law)}
    plain = [sp.Integer(1)] + [
        values.get(c_A.get(n, sp.Integer(0)), sp.Integer(0)) for n in range(1, 91)
    ]
    sizes = [
        abs(reversion.power_series(plain, sp.Rational(-(n + 3), 2), n + 1)[n]) * 3 / (n + 3)
        for n in (60, 61, 62, 88, 89, 90)
    ]
    # p_n ~ n^(-3/2) radius^(-n), with a bounded oscillation for complex nearest singularities.
    early, late = (max(float(sp.log(s)) for s in part) for part in (sizes[:3], sizes[3:]))
    estimate = -(late - early + 1.5 * float(mp.log(mp.mpf(90) / 62))) / 28
    assert estimate == pytest.approx(float(mp.log(reversion.radius(law))), abs=0.04)


def test_force_series_agrees_inside_its_radius() -> None:
    """P from eps by the p_n agrees with the law solved for A by mpmath's root finder."""
    law = {c_A[1]: 2, c_A[3]: sp.Rational(-1, 5), c_A[5]: sp.Rational(1, 50)}
    rest = {c_A[n]: 0 for n in (7, 9)}
    p = [value.subs(law | rest) for value in reversion.force_coefficients()]
    eps = mp.mpf("0.01")
    A = mp.findroot(lambda x: x * mp.sqrt(1 + 2 * x - x**3 / 5 + x**5 / 50) - eps, mp.mpf("0.0098"))
    total = eps**3 * mp.fsum(mp.mpf(sp.Rational(v).p) / v.q * eps**n for n, v in enumerate(p))
    assert abs(total / A**3 - 1) < mp.mpf("1e-12")
    errors = []
    for count in (2, 4, 6, 8):
        part = mp.fsum(mp.mpf(v.p) / v.q * eps**n for n, v in enumerate(p[:count]))
        errors.append(abs(part * eps**3 / A**3 - 1))
    assert all(later < earlier / 50 for earlier, later in pairwise(errors))


def test_wrong_inversion_is_rejected() -> None:
    r = sp.symbols("r_1 r_2", real=True)
    series = (sp.Integer(1), *r)
    inverse = reversion.inverted_coefficients(series, 3, 2, 3, 3)
    broken = (*inverse[:2], inverse[2] + r[1] / 7)
    with pytest.raises(ProofError, match="order 2"):
        prove("Inversion", "", reversion.composition(series, broken, 3, 2, 3))
