"""Test the contact-plate coupling with modes: proofs, energy of a motion, static law."""

from collections.abc import Callable

import numpy as np
import pytest
import sympy as sp
from mpmath import mp, mpf
from numpy.polynomial.legendre import leggauss
from scipy.integrate import solve_ivp

import generated
from derivation.engine.formula.proof import ProofError, prove
from derivation.plate import derived
from derivation.plate.vocabulary import P as force
from derivation.plate.vocabulary import a as radius
from derivation.plate.vocabulary import k, phi
from derivation.plate.waves.theory import coupling
from generated import contact_law, non_hertzian_pressure
from generated.contact_series import plate_coefficients

PHI = np.array([0.7, 2.3, 9.1])
OMEGA = np.array([1.3, 6.0, 21.0])
COMPLIANCE = np.array([0.4, 0.1, 0.03])
MASS = 1.7


def test_wrong_energy_or_weight_is_rejected() -> None:
    """The proof fails without the energy of the gap, and with it for pointwise indentation."""
    none = sp.Integer(0)
    stored = sp.Add(
        *(
            q * (coupling._P * s - f)
            for q, s, f in zip(
                coupling._q, coupling._modal_weights, coupling._modal_forces, strict=True
            )
        )
    )
    for weights, energy in (
        (coupling._modal_weights, none),
        ([sp.Integer(1)] * coupling.MODES, stored),
    ):
        rate = coupling._plain(coupling._loss(weights, energy, none, none))
        with pytest.raises(ProofError, match="conserved energy"):
            prove("Energy", "", {"conserved energy": rate})


@pytest.mark.parametrize("y", ["0.3", "2", "11"])
def test_means_under_punch_and_sphere_agree_with_quadrature(y: str) -> None:
    """The closed forms are weighted means of J0(y r) under a flat punch and a sphere.

    With r = sin t the weights are sin t dt (flat punch) and 3 sin t cos^2 t dt (Hertz).
    """
    with mp.workdps(25):
        for weight, name in ((mp.sin, "mode_mean"), (_hertz, "mode_force")):

            def mean(t: mpf, weight: Callable[[mpf], mpf] = weight) -> mpf:
                return weight(t) * mp.besselj(0, mpf(y) * mp.sin(t))

            closed = derived.formulas()[name].expression.subs(
                {radius: 1, force: 1, phi: sp.Rational(y)}
            )
            assert abs(mp.quad(mean, [0, mp.pi / 2]) - mpf(sp.N(closed, 25))) < 1e-20


def _hertz(t: mpf) -> mpf:
    return 3 * mp.sin(t) * mp.cos(t) ** 2


# --- the energy along a motion


def sinc(y: np.ndarray) -> np.ndarray:
    return np.sinc(y / np.pi)


def of_sphere(y: np.ndarray) -> np.ndarray:
    return 3.0 * (np.sin(y) - y * np.cos(y)) / y**3


class EnergyBalance:
    """Contact with P = a^3 and an arbitrary law delta = a^2 + a^4 sin(a)/2, and three modes."""

    def __init__(self, axis: bool, lag: float) -> None:
        self.axis, self.lag = axis, lag

    def at(self, a: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, float, float]:
        """Return modal forces, modal weights and their derivatives, and D and its derivative."""
        y = a * PHI
        felt, own = a**3 * of_sphere(y), sinc(y)
        tilt = PHI * (np.cos(y) - own) / y
        modal_weights = np.ones(3) if self.axis else own
        bend = np.zeros(3) if self.axis else tilt
        depth = a**2 + a**4 * np.sin(a) / 2 - COMPLIANCE @ (felt * modal_weights)
        rise = 2 * a + 2 * a**3 * np.sin(a) + a**4 * np.cos(a) / 2
        rise -= COMPLIANCE @ (3 * a**2 * own * modal_weights + felt * bend)
        return felt, modal_weights, bend, float(depth), float(rise)

    def growth(self, y: np.ndarray) -> float:
        """Return da/dt."""
        a, v, q, rate = y[0], y[1], y[2:5], y[5:8]
        _, modal_weights, bend, _, rise = self.at(a)
        return float((v - modal_weights @ rate) / (rise + bend @ q))

    def rates(self, _: float, y: np.ndarray) -> np.ndarray:
        """Return the rates of a, v, q, q', the work int P dD, and the loss of the coupling."""
        a, q, rate = y[0], y[2:5], y[5:8]
        felt, _, bend, _, rise = self.at(a)
        own, grown = sinc(a * PHI), self.growth(y)
        load = a**3 + self.lag * 3 * a**2 * grown
        driven = felt + self.lag * 3 * a**2 * own * grown
        lost = self.lag * 3 * a**2 * (rise + bend @ q) * grown**2
        if self.axis:
            lost += (a**3 - felt) @ rate
        acceleration = OMEGA**2 * (COMPLIANCE * driven - q)
        return np.array([grown, -load / MASS, *rate, *acceleration, a**3 * rise * grown, lost])

    def energy(self, y: np.ndarray) -> float:
        """Return the energy of sphere, contact and modes."""
        a, v, q, rate, work = y[0], y[1], y[2:5], y[5:8], y[8]
        felt, modal_weights, *_ = self.at(a)
        gap = 0.0 if self.axis else q @ (a**3 * modal_weights - felt)
        modes = (rate**2 + OMEGA**2 * q**2) / (2 * OMEGA**2 * COMPLIANCE)
        return float(MASS * v**2 / 2 + work + gap + modes.sum())


@pytest.mark.parametrize(("axis", "lag"), [(False, 0.0), (True, 0.0), (False, 0.03)])
def test_computed_motion_conserves_energy(axis: bool, lag: float) -> None:
    balance = EnergyBalance(axis, lag)
    start = np.array([0.05, 0.9, *(0.01, -0.02, 0.0), *(0.1, 0.05, -0.2), 0.0, 0.0])

    def opened(_: float, y: np.ndarray) -> float:
        return float(y[0] - 0.04)

    opened.terminal = True  # type: ignore[attr-defined]
    solution = solve_ivp(
        balance.rates, (0, 20), start, "DOP853", events=opened, rtol=1e-12, atol=1e-14
    )
    assert solution.t_events[0].size == 1
    assert solution.y[0].max() > 0.7
    before = balance.energy(start)
    changes = [balance.energy(y) - before + y[9] for y in solution.y.T]
    assert np.abs(changes).max() < 1e-10
    if not axis and not lag:
        assert np.abs(solution.y[9]).max() == 0.0
    else:
        assert np.abs(solution.y[9]).max() > 1e-3


# --- the variational law


def variational(a: float, h: float, b: float) -> float:
    """Return the variational indentation, from the mean of the plate part over [0, 2 a]."""
    x, weights = leggauss(40)
    x = a * (1.0 + x)
    plate = contact_law.indentation(x, 1e3, h, b) - x**2 / 1e3
    return a**2 / 1e3 + float(weights @ plate) / 4.0


@pytest.mark.parametrize(("a", "h"), [(0.05, 0.1), (0.2, 0.07), (0.3, 0.8)])
def test_mean_over_twice_the_radius_equals_the_sum_over_modes(a: float, h: float) -> None:
    count = 40000
    j, J1 = generated.bessel_j0_zeros(count), generated.bessel_j1_at_j0_zeros(count)
    y = a * j
    terms = generated.K_j(j, h, 1.0, 1e3, J1) * (np.sin(y) - y * np.cos(y)) * sinc(y)
    # The omitted modes add little: K_j tends to 4/(R phi^3), the other factors to -sin(2 y)/2.
    total = float(terms.sum()) + a**2 / 3e3
    assert variational(a, h, 1.0) == pytest.approx(total, rel=2e-9)


def test_variational_law_has_the_third_coefficient_of_the_non_hertzian_law() -> None:
    """At equal force the variational law is closer to the non-Hertzian one than the axis law."""
    h, b, R = 0.2, 1.0, 1e3
    misses = []
    for A in (0.05, 0.1):
        exact = non_hertzian_pressure.contact(non_hertzian_pressure.plate(h, b), A * h, R, 2.0)
        # E* = 2 with lam = 0, mu = 1: Hertz's radius of the same force.
        a = float((0.75 * exact.force * R / 2.0) ** (1 / 3))
        laws = np.array([variational(a, h, b), contact_law.indentation(a, R, h, b)])
        misses.append(laws / float(exact.indentation) - 1.0)
    small, large = np.abs(misses)
    third = abs(float(derived_third(h, b)))
    assert small[1] == pytest.approx(5 / 3 * third * 0.05**3, rel=0.2)
    assert small[0] < 1e-4 * small[1]
    assert large[0] / small[0] > 40  # errors of order A^6 (first) and A^3
    assert 6 < large[1] / small[1] < 9


def derived_third(h: float, b: float) -> float:
    """Return c_3 from the generated coefficients, which multiply powers of A/reach."""
    reach = min(3.0, b / h)
    return float(plate_coefficients(h / b)[1]) / reach**2


def test_variational_coefficients_have_the_known_ratios() -> None:
    ratio = derived.formulas()["variational_ratio"].expression
    assert [ratio.subs(k, index) for index in (2, 3, 4)] == [1, sp.Rational(8, 3), 8]
