"""Test modes of clamped or supported plates of finite thickness: theory, functions, limits."""

import math
from collections.abc import Callable
from fractions import Fraction
from functools import cache
from itertools import pairwise
from typing import Any

import flint
import numpy as np
import pytest
import sympy as sp
from flint import arb
from mpmath import mp, mpf
from numpy.polynomial.legendre import leggauss
from scipy.optimize import brentq
from scipy.special import i0e, i1e, iv, j0, j1

from derivation.engine.formula.proof import ProofError
from derivation.engine.oracle.agreement import RouteError
from derivation.mathematics.bessel.theory import modified as modified_bessel
from derivation.plate import derived
from derivation.plate.edge_modes.oracle import modes as mode_balls
from derivation.plate.edge_modes.oracle import waves as wave_balls
from derivation.plate.edge_modes.route import waves as wave_routes
from derivation.plate.edge_modes.theory import mindlin
from derivation.plate.edge_modes.theory import waves as theory
from derivation.plate.vocabulary import eta as thickness
from derivation.plate.vocabulary import nu as poisson
from generated import edge_modes
from generated.bessel import bessel_j0_zeros, bessel_j1_at_j0_zeros
from generated.edge_mode_numbers import START
from generated.edge_modes import (
    Waves,
    clamped_waves,
    cutoff,
    modal_weights_less_one,
    shape,
    supported_waves,
)
from generated.inertia import bending_frequency, bending_residue

BITS = 200
WAVES_OF: dict[str, Callable[..., Waves]] = {
    "clamped": clamped_waves,
    "supported": supported_waves,
}
RATIOS = (-0.9, -0.3, 0.0, 0.3, 0.499)

pytestmark = pytest.mark.usefixtures("silent")


# --- theory


def test_shear_coefficient_agrees_with_the_known_one() -> None:
    assert sp.cancel(mindlin.shear_coefficient().expression - 5 / (6 - poisson)) == 0


@pytest.mark.parametrize(
    ("module", "name", "wrong", "step"),
    [
        (theory, "SUPPORTED", 1 / (1 + poisson), theory.edges),
        (theory, "CLAMPED", 2 * theory.CLAMPED, theory.edges),
        (theory, "NORM", theory.NORM + theory.J1**2 / 7, theory.norm),
        (theory, "SUPPORTED_REST", -theory.SUPPORTED_REST, theory.static_changes),
        (mindlin, "u_2", lambda: 1 + mindlin.ROTARY * mindlin.xi, mindlin.waves),
    ],
)
def test_wrong_step_is_rejected(
    monkeypatch: pytest.MonkeyPatch, module: Any, name: str, wrong: Any, step: Any
) -> None:
    monkeypatch.setattr(module, name, wrong)
    with pytest.raises(ProofError):
        step.__wrapped__()


@pytest.mark.parametrize(("steps", "largest"), [(16, 3), (40, 16)])
def test_bound_of_the_bessel_integral_of_order_two(steps: int, largest: int) -> None:
    with flint.ctx.workprec(BITS):
        k = arb(largest)
        turns = [2 * arb.pi() * i / steps for i in range(steps)]
        fourth = sum((t.sin() ** 4 * (k * t.cos()).exp() for t in turns), arb(0)) / steps
        error = abs(k**2 / 3 * fourth / k.bessel_i(2) - 1)
        bound = modified_bessel.fourth_bound(steps, Fraction(largest))
        assert 0 < error <= arb(flint.fmpq(bound.numerator, bound.denominator))
    with pytest.raises(ProofError, match="too few"):
        modified_bessel.fourth_bound(12, Fraction(9))


# --- references


@pytest.mark.parametrize(
    ("edge", "n", "eta", "nu"),
    [("clamped", 1, 0.3, 0.4), ("supported", 2, 0.1, 0.3), ("supported", 1, 0.2, -0.9)],
)
def test_references_agree(edge: mode_balls.Edge, n: int, eta: float, nu: float) -> None:
    balls = wave_balls.wave(edge, n, eta, nu, 25)
    routes = wave_routes.wave(edge, eta, nu, round(float(balls.k), 4), 14)
    with flint.ctx.workprec(BITS), mp.workdps(50):
        for ball, route in zip(balls, routes, strict=True):
            assert abs(ball / arb(mp.nstr(route, 40)) - 1) < 1e-14


def test_references_reject_invalid_arguments() -> None:
    for given in ((0, 0.1, 0.3), (1, 0.0, 0.3), (1, 0.1, 0.5), (1, 0.1, -1.0)):
        with pytest.raises(ValueError, match="n >= 1"):
            wave_balls.wave("clamped", *given)
    with pytest.raises(mode_balls.RootError, match="beyond the cut-off"):
        wave_balls.wave("clamped", 3, 0.3, 0.3, 10)


def test_missing_roots_are_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, wrong, match in (
        ("_STEPS", 3, "no root found"),
        ("_illinois", lambda *_: Fraction(5, 2), "no change of sign"),
    ):
        with monkeypatch.context() as patched:
            patched.setattr(wave_balls, name, wrong)
            with pytest.raises(mode_balls.RootError, match=match):
                wave_balls.wave("clamped", 1, 0.1, 0.3, 10)
    monkeypatch.setattr(wave_routes, "_STEPS", 0)
    with pytest.raises(RouteError, match=r"no root of the determinant near k = 3\.1"):
        wave_routes.wave("clamped", 0.1, 0.3, 3.1, 5)


# --- generated functions


@pytest.mark.parametrize("nu", RATIOS)
def test_modes_end_at_the_cut_off_frequency(nu: float) -> None:
    low, high = wave_balls.cutoff(nu, 20)
    assert cutoff(nu) == pytest.approx(float((low + high) / 2), rel=1e-14)
    for edge, of in WAVES_OF.items():
        for eta in (0.07, 0.21):
            waves = of(1000, eta, nu)
            count = waves.k.size
            assert (waves.k * eta < cutoff(nu)).all()
            assert (waves.k2 > 0).all()
            assert count in (n := int(cutoff(nu) / eta / math.pi), n - 1, n + 1), edge
            with pytest.raises(mode_balls.RootError, match="beyond the cut-off"):
                wave_balls.wave(edge, count + 1, eta, nu, 10)  # type: ignore[arg-type]


def test_shorter_tables_are_the_beginning_of_longer_ones() -> None:
    for of in WAVES_OF.values():
        whole = of(40, 1e-2, 0.3)
        for count in (0, 1, 2, 9, 40, 11.0):
            for x, y in zip(of(count, 1e-2, 0.3), whole, strict=True):
                assert x.shape == (int(count),)
                np.testing.assert_allclose(x, y[: int(count)], rtol=2e-14)


@pytest.mark.parametrize("of", WAVES_OF.values())
def test_invalid_arguments_are_rejected(of: Callable[..., Waves]) -> None:
    for count in (-1, 2.5, math.nan, math.inf):
        with pytest.raises(ValueError, match="number of modes, an integer >= 0"):
            of(count, 0.1, 0.3)
    for eta in (0.0, -0.1, 0.51, math.nan, math.inf, 1e-90):
        with pytest.raises(ValueError, match=r"expected eta = h/b from 1e-80 to 0\.5"):
            of(3, eta, 0.3)
    for nu in (-1.0, 0.5, math.nan, math.inf):
        with pytest.raises(ValueError, match=r"expected Poisson's ratio nu with -1 < nu < 0\.5"):
            of(3, 0.1, nu)
        with pytest.raises(ValueError, match="Poisson's ratio"):
            cutoff(nu)


@cache
def cutoff_once(nu: float, compute: Callable[[Any], Any] = edge_modes._cutoff) -> Any:
    """Return the end of the range of both edges, which takes most of the time of a call."""
    return compute(np.asarray(nu))


@pytest.mark.parametrize("edge", WAVES_OF)
def test_results_change_smoothly(edge: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Results change smoothly across the switch point of I0 at k2 = 31.7, and along nu."""
    monkeypatch.setattr(edge_modes, "_cutoff", lambda nu: cutoff_once(float(nu)))
    # The curves of a supported plate are most bent near nu = -1.
    ratios = -0.99 + 1.4899 * np.linspace(0.0, 1.0, 101) ** 2
    lines = [
        [WAVES_OF[edge](12, eta, 0.3) for eta in np.linspace(0.0125, 0.015, 51)],
        [WAVES_OF[edge](2, 0.1, nu) for nu in ratios],
    ]
    assert lines[0][0].k2[-1] > START > lines[0][-1].k2[-1]
    for line, allowed in zip(lines, (3e-3, 2e-2), strict=True):
        for name in Waves._fields:
            values = np.array([getattr(waves, name) for waves in line])
            bend = np.abs(np.diff(values, 2, axis=0)) / np.abs(values[1:-1])
            assert bend.max() < allowed, name


# --- one mode between neighbouring zeros of J0


@pytest.mark.parametrize("nu", RATIOS)
@pytest.mark.parametrize("eta", [1e-6, 0.03, 0.1, 0.2, 0.35, 0.5])
def test_ratio_of_rotation_to_moment_increases_between_zeros(eta: float, nu: float) -> None:
    """Between zeros of J0, S/Gam increases from -oo (or 1/2) to oo, so it equals beta once.

    This includes the beta of chi = 1.
    """
    ends = np.concatenate(([0.0], bessel_j0_zeros(8)))
    top = min(cutoff(nu) / eta, ends[-1])
    for low, high in pairwise(ends):
        if low >= top:
            break
        inside = np.linspace(low, min(high, top), 402)[1:-1]
        ratio = turn_over_bend(inside, eta, nu)[0]
        # Near k = 0 the increase is of order k^4, below the rounding error.
        assert (np.diff(ratio) > (0.0 if low else -1e-12)).all()
        assert ratio[0] < (-1.0 if low else 0.5 + 1e-5)
        if high <= top:
            assert ratio[-1] > 1.5


def turn_over_bend(k: Any, eta: float, nu: float, kap: Any = None) -> tuple[Any, ...]:
    """Return S/Gam, k2, g1 and g2 by SciPy, for the kap of A0 if none is given."""
    x, slack = k * eta, (6 - nu) / 5
    kap = bending_frequency(x, nu) ** 2 if kap is None else kap
    k2 = np.sqrt(k**2 - kap / eta**2 * (slack + (1 - nu) / 2))
    g1, g2 = 1 - kap * slack / x**2, 1 + kap * slack / (eta * k2) ** 2
    S = g1 * k * j1(k) / j0(k) + g2 * k2 * i1e(k2) / i0e(k2)
    return S / (g1 * k**2 + g2 * k2**2), k2, g1, g2


# --- energy and orthogonality


def mindlin_kap(x: float, nu: float) -> float:
    """Return kap of Mindlin's lower branch, the smaller root of the quadratic."""
    slack, n = (6 - nu) / 5, (1 - nu) / 2
    half = (3 * n + (slack + n) * x**2) / 2
    return 2 * half / (2 * slack * n) * (1 - math.sqrt(1 - slack * n * x**4 / half**2))


def fields(k: Any, eta: float, nu: float, r: Any, kap: Any = None) -> tuple[Any, Any]:
    """Return w and psi at the radii r."""
    _, k2, g1, g2 = (np.asarray(x)[..., None] for x in turn_over_bend(k, eta, nu, kap))
    k = np.asarray(k)[..., None]
    c = j0(k) / iv(0, k2)
    w = j0(k * r) - c * iv(0, k2 * r)
    return w, g1 * k * j1(k * r) + c * g2 * k2 * iv(1, k2 * r)


@pytest.mark.parametrize("nu", [0.0, 0.45])
@pytest.mark.parametrize("edge", WAVES_OF)
def test_modes_are_orthogonal_and_have_their_norm(edge: str, nu: float) -> None:
    """Mindlin's modes are orthogonal; modes with the frequencies of A0 are so approximately."""
    eta = 0.12
    actual = WAVES_OF[edge](4, eta, nu)
    chi = float(theory.CLAMP.subs(poisson, nu)) * eta
    beta = 1 / (1 - nu) if edge == "supported" else chi / (1 + chi)
    ends = np.concatenate(([1e-3], bessel_j0_zeros(6)))[edge == "clamped" :]

    def excess(k: float) -> float:
        return float(turn_over_bend(k, eta, nu, mindlin_kap(k * eta, nu))[0] - beta)

    own = np.array([brentq(excess, a + 1e-9, b - 1e-9) for a, b in pairwise(ends[:5])])
    kap = np.array([mindlin_kap(k * eta, nu) for k in own])
    x, weights = leggauss(60)
    r, weights = (1 + x) / 2, weights / 2
    for k, load, most in ((own, kap, 1e-12), (actual.k, None, 2e-3)):
        w, psi = fields(k, eta, nu, r, load)
        products = np.einsum("ir,jr,r->ij", w, w, weights * r)
        products += eta**2 / 3 * np.einsum("ir,jr,r->ij", psi, psi, weights * r)
        norms = np.diag(products)
        off = products / np.sqrt(np.outer(norms, norms)) - np.eye(4)
        assert np.abs(off).max() < most
    g1 = turn_over_bend(actual.k, eta, nu)[2]
    face = (1 - actual.c * actual.t) ** 2 * (1 + (eta * actual.k * g1) ** 2 / 3)
    np.testing.assert_allclose(actual.weight, face / (2 * np.pi * norms), rtol=1e-12)


# --- limits


@pytest.mark.parametrize("eta", [1e-80, 1e-20, 1e-9])
def test_modes_of_thin_plates_agree_with_plate_theory(eta: float) -> None:
    """Thin plates have the modes of derivation step 29.

    They agree with Leissa, Vibration of Plates (1969), tables 2.1 and 2.5.
    """
    for edge, nu, k_squared in (
        ("clamped", 0.3, [10.2158, 39.771, 89.104]),
        ("supported", 0.3, [4.9351, 29.7200, 74.1561]),
        ("supported", -0.6, None),
    ):
        actual = WAVES_OF[edge](3, eta, nu)
        for n in (1, 2, 3):
            exact = mode_balls.mode(edge, n, nu, 25)  # type: ignore[arg-type]
            for name in exact._fields:
                value = float(getattr(exact, name))
                assert getattr(actual, name)[n - 1] == pytest.approx(
                    value,
                    rel=1e-14 + 0.1 * eta,  # second term: compliance of the clamp
                )
        np.testing.assert_allclose(actual.k2, actual.k, rtol=1e-15)
        np.testing.assert_allclose(actual.residue, 0.5, rtol=1e-15)
        np.testing.assert_allclose(actual.t, 1.0, rtol=1e-15)
        thin = (actual.k * eta) ** 2 * math.sqrt(2 / (3 * (1 - nu)))
        np.testing.assert_allclose(actual.root, thin, rtol=1e-15)
        if k_squared:
            np.testing.assert_allclose(actual.k**2, k_squared, rtol=6e-5)


@pytest.mark.parametrize("edge", WAVES_OF)
@pytest.mark.parametrize("nu", [-0.3, 0.0, 0.3, 0.45])
@pytest.mark.parametrize(("eta", "most"), [(0.02, 5e-4), (0.05, 3e-4), (0.1, 5e-4), (0.16, 5e-3)])
def test_sums_are_the_static_differences(edge: str, nu: float, eta: float, most: float) -> None:
    """The sum over modes of the difference to the paper's edge is the static difference.

    Beyond the cut-off the modes of both edges are assumed equal.
    """
    known = derived.formulas()[f"{edge}_static_change"].expression
    value = float(known.subs({poisson: nu, thickness: eta}))
    held = WAVES_OF[edge](1000, eta, nu)
    count = held.k.size
    x = bessel_j0_zeros(count) * eta
    weight = 1 / (np.pi * bessel_j1_at_j0_zeros(count) ** 2)
    paper = bending_residue(x, nu) * weight / bending_frequency(x, nu) ** 2
    each = held.residue * held.weight / held.root**2 - paper
    rigidity = 4 / (3 * (1 - nu)) * eta**4  # D/(mu h^3) times eta^4 for the other units
    assert math.fsum(each) * rigidity == pytest.approx(value, rel=most)


# --- the contact face


def test_mode_shape_and_its_mean_under_a_flat_punch() -> None:
    x, weights = leggauss(200)
    t = (1 + x) * np.pi / 4
    for edge, of in WAVES_OF.items():
        for eta, nu in ((0.1, 0.3), (1e-3, 0.45), (0.3, -0.9)):
            waves = of(30, eta, nu)
            r = np.linspace(0, 1, 11)
            actual = shape(waves, r)
            assert actual.shape == (waves.k.size, 11)
            np.testing.assert_allclose(actual[:, 0], 1.0, rtol=1e-15)
            k, k2, c = (v[:, None] for v in (waves.k, waves.k2, waves.c * waves.t))
            plain = (j0(k * r) - c * iv(0, k2 * r)) / (1 - c)
            np.testing.assert_allclose(actual, plain, atol=2e-13)
            for a in (0.05, 0.5, 0.9):
                # With r = a sin t the punch pressure has the weight sin t dt.
                mean = shape(waves, a * np.sin(t)) @ (np.sin(t) * weights * np.pi / 4)
                less = modal_weights_less_one(waves, a)
                assert less.shape == (1, waves.k.size), edge
                np.testing.assert_allclose(less[0], mean - 1, atol=1e-12)


def test_means_for_small_punches_and_high_modes() -> None:
    waves = clamped_waves(400, 1e-4, 0.3)
    assert waves.k2[-1] > 745
    assert waves.c[-1] == 0.0
    edge = shape(waves, [0.0, 0.9, 1.0, 1.1, -0.1, math.nan])
    np.testing.assert_allclose(edge[:, 2], 0.0, atol=1e-4)  # t differs from 1 for waves this short
    assert np.isnan(edge[:, 3:]).all()
    np.testing.assert_allclose(edge[-1, 1], j0(0.9 * waves.k[-1]), atol=1e-12)
    a = 1e-6
    less = modal_weights_less_one(waves, [a])[0]
    with mp.workdps(40):
        k, k2, c = (mpf(float(v)) for v in (waves.k[0], waves.k2[0], waves.c[0] * waves.t[0]))
        near = (mp.sin(k * a) / (k * a) - c * mp.sinh(k2 * a) / (k2 * a)) / (1 - c) - 1
    assert less[0] == pytest.approx(float(near), rel=1e-14, abs=0.0)
    assert modal_weights_less_one(waves, np.zeros(0)).shape == (0, 400)
