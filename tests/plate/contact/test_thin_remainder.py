"""Test that the closed form of a thin plate plus its sum over roots is exact."""

from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import cache

import flint
import mpmath as mp
import pytest
import sympy as sp

from derivation.engine.formula.proof import ProofError
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.theory import thin_law, thin_remainder, thin_roots
from derivation.plate.vocabulary import Formula, PlateRoot, a_ratio, eta

DIGITS = 42
ETAS = ("0.05", "0.2", "1/3", "0.5302", "0.9", "2")
POINTS = (("0.1", "0.05"), ("4.5", "0.2"), ("1", "1/3"), ("0.5", "0.9"), ("0.2", "3"))
"""Values of a/h and h/b.

The second point is outside the convergence radius of Phi's series; the last plate is thick.
"""
DROPS = {"sinh T = T": lambda n: 2 * n - 1, "sinh T = -T": lambda n: 2 * n}
"""Family of roots to omit, with the indices of the remaining roots."""


@cache
def oracle(k: int, ratio: str) -> flint.arb:
    return contact_balls.coefficient(2 * k - 3, Fraction(ratio), 1, DIGITS)


@cache
def closed(k: int, ratio: str) -> flint.arb:
    return thin_law.thin_coefficient_ball(k, Fraction(ratio), DIGITS)


def number(ball: flint.arb, digits: int = DIGITS) -> mp.mpf:
    with mp.workdps(digits + 3):
        return mp.mpf(ball.str(digits, radius=False))


def agree(got: flint.arb, expected: flint.arb, digits: int) -> bool:
    with flint.ctx.workprec(400):
        return bool(abs(got - expected) < flint.arb(10) ** -digits * abs(expected))


@cache
def newton(n: int) -> mp.mpc:
    """Return T_n by mpmath from its asymptotic value, in the family given by the index."""
    with mp.workdps(50):
        height = (n + mp.mpf(1) / 2) * mp.pi
        start = mp.mpc(mp.log(2 * height), height - mp.log(2 * height) / height)
        return mp.findroot(lambda T: mp.sinh(T) - (-1) ** n * T, start)


def G(T: mp.mpc) -> mp.mpc:
    return (mp.sinh(T) * mp.cosh(T) + T) / (mp.sinh(T) ** 2 - T**2)


# --- the roots


@pytest.mark.parametrize("n", [1, 2, 3, 4, 17, 200])
def test_roots_are_enclosed(n: int) -> None:
    ball = thin_roots.root(n, 150)
    assert ball.real.rad() < 1e-44
    with flint.ctx.workprec(400):
        point = flint.acb(ball.real.mid(), ball.imag.mid())
        assert (ball.sinh() - (-1) ** n * ball).contains(0)
        assert not ((point + flint.acb("1e-30")).sinh() - (-1) ** n * point).contains(0)
    with mp.workdps(50):
        expected = newton(n)
        assert abs(mp.mpc(number(ball.real), number(ball.imag)) - expected) < mp.mpf("1e-38")


def test_roots_agree_with_those_of_a_semi_infinite_strip() -> None:
    """The first roots of both kinds are the published eigenvalues of a semi-infinite strip."""
    assert abs(complex(thin_roots.root(1)) - (2.250728611601870 + 4.212392230490660j)) < 1e-14
    assert abs(complex(thin_roots.root(2)) - (2.768678282987320 + 7.497676277776390j)) < 1e-14


@pytest.mark.parametrize("count", [1, 2, 3, 6])
def test_no_root_is_missed(count: int) -> None:
    """The argument principle in Arb counts the roots.

    The region is 1/4 < Re T < 12, 1/4 < Im T < pi count + 3 pi/4.
    """

    def density(T: flint.acb, _: bool) -> flint.acb:
        return 2 * (T.sinh() * T.cosh() - T) / (T.sinh() ** 2 - T * T)

    with flint.ctx.workprec(64):
        top = count * flint.arb.pi() + 3 * flint.arb.pi() / 4
        low, right = flint.arb("0.25"), flint.arb(12)
        corners = [flint.acb(x, y) for x, y in ((low, low), (right, low), (right, top), (low, top))]
        sides = zip(corners, corners[1:] + corners[:1], strict=True)
        turns = sum((flint.acb.integral(density, *side) for side in sides), flint.acb(0))
        turns /= flint.acb(0, 2) * flint.arb.pi()
    assert turns.real.rad() < 1e-6
    assert turns.contains(count)
    assert thin_roots.root(count).imag < top
    assert thin_roots.root(count + 1).imag > top


def test_value_that_is_no_root_is_rejected() -> None:
    with pytest.raises(ValueError, match="counted from 1"):
        thin_roots.root(0)


@pytest.mark.parametrize("n", [1, 2, 3, 8])
def test_residue_equals_the_contour_integral(n: int) -> None:
    """The residue is the mean of G (T - T_n) over a circle without another root."""
    with mp.workdps(40):
        centre, count = newton(n), 160
        circle = [mp.mpf(1) / 2 * mp.expjpi(mp.mpf(2 * i) / count) for i in range(count)]
        mean = mp.fsum(G(centre + step) * step for step in circle) / count
        formula = thin_remainder.residue(centre, mp.sqrt(1 + centre**2))
        assert abs(mean / formula - 1) < mp.mpf("1e-20")


# --- exactness


@pytest.mark.parametrize("ratio", ETAS)
@pytest.mark.parametrize("k", [2, 3, 4])
def test_coefficients_are_exact(k: int, ratio: str) -> None:
    rest = thin_remainder.coefficient_remainder_ball(k, Fraction(ratio), DIGITS)
    with flint.ctx.workprec(400):
        assert agree(closed(k, ratio) + rest, oracle(k, ratio), 40)
        assert not agree(closed(k, ratio), oracle(k, ratio), 39)


@pytest.mark.parametrize("k", [2, 3, 4])
@pytest.mark.parametrize("ratio", ["0.05", "0.2"])
def test_error_of_the_closed_form_is_the_first_root(k: int, ratio: str) -> None:
    """The error of the closed form is the first root's term, of size exp(-4.2124 b/h)."""
    with mp.workdps(60), flint.ctx.workprec(400):
        e = mp.mpf(ratio)
        miss = number(oracle(k, ratio) - closed(k, ratio), 20)
        first, second = (root_term(k, newton(n), e) for n in (1, 2))
        assert abs(miss - first.imag) < 2 * abs(second) + mp.mpf("1e-39")
        envelope = 2 * abs(first) / abs(wave(newton(1), e)) * mp.exp(mp.mpf("-4.2124") / e)
        assert mp.mpf("0.9") < abs(first) / envelope < mp.mpf("1.1")


def root_term(k: int, T: mp.mpc, ratio: mp.mpf) -> mp.mpc:
    """Return a root's term in c_(2k-3), from the residue coth(u/2)^2/2 of G, u = asinh T."""
    size = (-1) ** k * mp.mpf(2 * k - 2) / mp.factorial(2 * k - 1)
    residue = mp.coth(mp.asinh(T) / 2) ** 2 / 2
    return 8 * size * (T / 2) ** (2 * k - 4) * residue / 2 * wave(T, ratio)


def wave(T: mp.mpc, ratio: mp.mpf) -> mp.mpc:
    z = T / (2 * ratio)
    return mp.hankel1(0, z) / mp.besselj(0, z)


def check_bounds(
    weight: Callable[[flint.acb], flint.acb],
    first: Callable[[int], flint.arb],
    quotient: Callable[[int], flint.arb],
    ratio: flint.arb,
) -> flint.arb:
    """Compare the terms of the sum over the roots with their bounds (replaces the sum)."""
    for n in range(1, 20):
        if not n * flint.arb.pi() > 8 * ratio:
            continue
        at = thin_roots.root(n, 2100)
        assert abs(weight(at) * thin_remainder.root_term(at, ratio)) < first(n)
        assert abs(at) < thin_roots.SIZE_OVER_INDEX * n
        for later in (n, n + 1, n + 9):
            assert first(later + 1) < first(later) * quotient(n) * (1 + flint.arb("1e-20"))
    return flint.arb(1)


def test_tails_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(thin_remainder, "_sum_over_roots", check_bounds)
    digits = 600  # K0 loses digits by cancellation for arguments of moderate size
    for ratio in ("0.05", "0.9", "3"):
        for k in (2, 3, 5):
            thin_remainder.coefficient_remainder_ball(k, Fraction(ratio), digits)


# --- the recorded expressions


def stated_sum(formula: Formula, values: Mapping[sp.Symbol, mp.mpf], count: int) -> mp.mpf:
    """Return the recorded SymPy sum, with its first `count` terms evaluated by mpmath."""
    (total,) = formula.expression.atoms(sp.Sum)
    function, (index, *_) = total.args
    T = sp.Symbol("T_n")
    term = sp.lambdify((T, *values), function.subs(PlateRoot(index), T), "mpmath")
    factor = sp.lambdify(tuple(values), formula.expression / sp.im(total), "mpmath")
    whole = mp.fsum(mp.im(term(newton(n), *values.values())) for n in range(1, count + 1))
    return factor(*values.values()) * whole


@pytest.mark.parametrize("k", [2, 3, 4, 5])
def test_recorded_sum_of_a_coefficient(formulas: Mapping[str, Formula], k: int) -> None:
    with mp.workdps(30):
        got = stated_sum(formulas[f"c_{2 * k - 3}_roots"], {eta: mp.mpf(1) / 3}, 8)
        ball = thin_remainder.coefficient_remainder_ball(k, Fraction(1, 3), 25)
        assert abs(got / number(ball, 25) - 1) < mp.mpf("1e-22")


@pytest.mark.parametrize(("radius", "ratio"), POINTS)
def test_law_is_exact(formulas: Mapping[str, Formula], radius: str, ratio: str) -> None:
    """c_1 A + c_3 A^3 + Phi(A) misses F by the recorded sum over the roots."""
    A, e = Fraction(radius), Fraction(ratio)
    expected = number(contact_balls.relative_correction(A * e, e, 1, DIGITS))
    integrand, (T, *_) = formulas["Phi"].expression.args
    with mp.workdps(80):
        density = sp.lambdify((T, a_ratio), integrand, "mpmath")
        a, eps = (mp.mpf(x.numerator) / x.denominator for x in (A, e))
        universal = mp.quad(lambda x: density(x, a), [mp.mpf("1e-11"), 1, 3, 8, 20, 40, 80])
        low = mp.fsum(number(closed(k, ratio)) * a ** (2 * k - 3) for k in (2, 3))
        miss = expected - low - universal
        got = stated_sum(formulas["F_roots"], {eta: eps, a_ratio: a}, 70)
        assert abs(got - miss) < mp.mpf("1e-20") * abs(expected)
        assert abs(miss) > mp.mpf("1e-39") * abs(expected)


# --- errors are detected


WRONG: dict[str, Callable[[sp.Expr, sp.Expr], sp.Expr]] = {
    "factor": lambda T, c: (1 + c) ** 2 / T**2,
    "sign": lambda T, c: -((1 + c) ** 2) / (2 * T**2),
    "other family's": lambda T, c: (1 - c) ** 2 / (2 * T**2),
}


@pytest.mark.parametrize("change", WRONG)
def test_wrong_residue_is_rejected_by_the_proofs(
    monkeypatch: pytest.MonkeyPatch, change: str
) -> None:
    thin_remainder.residue_at_roots()  # fill the cache for the dependent proofs
    monkeypatch.setattr(thin_remainder, "residue", WRONG[change])
    with pytest.raises(ProofError, match="residue"):
        thin_remainder.residue_at_roots.__wrapped__()
    with pytest.raises(ProofError, match="residue"):
        thin_remainder.coefficient_remainder.__wrapped__(2)
    with pytest.raises(ProofError, match="residue"):
        thin_remainder.law_remainder.__wrapped__()


@pytest.mark.parametrize("change", WRONG)
def test_wrong_residue_is_detected_by_the_reference(change: str) -> None:
    with mp.workdps(60), flint.ctx.workprec(400):
        e = mp.mpf("0.2")
        miss = number(oracle(2, "0.2") - closed(2, "0.2"), 20)
        roots = [newton(n) for n in range(1, 6)]
        right = mp.fsum(root_term(2, T, e).imag for T in roots)
        assert abs(right / miss - 1) < mp.mpf("1e-15")
        ratios = [WRONG[change](T, c) / thin_remainder.residue(T, c) for T, c in with_cosh(roots)]
        wrong = mp.fsum((root_term(2, T, e) * r).imag for T, r in zip(roots, ratios, strict=True))
        assert abs(wrong / miss - 1) > mp.mpf("0.1")


def with_cosh(roots: list[mp.mpc]) -> list[tuple[mp.mpc, mp.mpc]]:
    return [(T, mp.sqrt(1 + T**2)) for T in roots]


@pytest.mark.parametrize("family", DROPS)
def test_missing_family_is_detected(monkeypatch: pytest.MonkeyPatch, family: str) -> None:
    whole = thin_roots.root
    monkeypatch.setattr(thin_remainder, "root", lambda n, bits: whole(DROPS[family](n), bits))
    for k in (2, 3, 4):
        rest = thin_remainder.coefficient_remainder_ball(k, Fraction("0.2"), DIGITS)
        with flint.ctx.workprec(400):
            assert not agree(closed(k, "0.2") + rest, oracle(k, "0.2"), 18)
