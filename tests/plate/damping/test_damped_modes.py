"""Test the functions of damped modes against exact numbers and known properties."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mp, mpf

from derivation.scene.dynamic.oscillators import FreeMotion, Response, response_at
from generated.damping_kernels import free_loss, free_motion, power_lost, response

RATIOS = [0.0, 1e-12, 1e-3, 0.05, 0.5, 0.99]
PHASES = np.array([1e-9, 1e-4, 0.01, 0.3, 0.4999, 0.5001, 2.0, 20.0])
ulp = 2.0**-52


def exactly(phase: float, zeta: float) -> tuple[mpf, mpf, mpf, mpf, mpf]:
    """Return zeta, root, exp(-zeta phase), and the cosine and sine of the damped phase."""
    ratio, turn = mpf(zeta), mpf(phase)
    root = mp.sqrt((1 - ratio) * (1 + ratio))
    return ratio, root, mp.exp(-ratio * turn), mp.cos(root * turn), mp.sin(root * turn)


@pytest.mark.parametrize("zeta", RATIOS)
def test_free_motion_loses_no_digits(zeta: float) -> None:
    """No digits are lost, even if the motion is nearly uniform."""
    by_q, by_rate, sine, cosine = free_motion(PHASES, np.asarray(zeta))
    with mp.workdps(50):
        for k, phase in enumerate(PHASES):
            ratio, root, decay, c, s = exactly(phase, zeta)
            moved = decay * (c + ratio / root * s) - 1, decay * s / root / mpf(phase) - 1
            assert by_q[k] == pytest.approx(float(moved[0]), rel=32 * ulp)
            assert by_rate[k] == pytest.approx(float(moved[1]), rel=32 * ulp)
            size = float(decay / root)
            assert sine[k] == pytest.approx(float(-decay * s / root), abs=16 * ulp * size)
            rate = float(decay * (c - ratio / root * s))
            assert cosine[k] == pytest.approx(rate, abs=16 * ulp * size)


@pytest.mark.parametrize("zeta", [ratio for ratio in RATIOS if ratio])
def test_free_motion_by_the_response_loses_no_digits(zeta: float) -> None:
    """Both ways to compute the free motion agree at small and at large phases."""
    into = Response.empty((PHASES.size, 1), zeta)
    by_q, by_rate = response_at(PHASES, np.array([1.0]), zeta, into, slice(1))
    other = FreeMotion(PHASES[:, None], zeta)
    assert by_q == pytest.approx(other.by_q, rel=128 * ulp, abs=8 * ulp / math.sqrt(1 - zeta))
    assert by_rate == pytest.approx(other.by_rate, rel=128 * ulp)


@given(
    st.floats(0.0, 7.0), st.floats(0.0, 7.0), st.floats(0.0, 0.95), st.floats(0.1, 1e6)
)  # fmt: skip
def test_factors_give_the_impulse_response(
    late: float, early: float, zeta: float, omega: float
) -> None:
    """The factors give the impulse response, also at the earlier times that collocation needs."""
    sine, cosine, rate_c, rate_s, _, _ = response(np.array([late]), np.asarray(zeta))
    *_, first, second = response(np.array([early]), np.asarray(zeta))
    moved, rate = sine * first - cosine * second, rate_c * first + rate_s * second
    root = math.sqrt((1 - zeta) * (1 + zeta))
    phase, size = late - early, math.exp(zeta * abs(late - early)) / root
    decay = math.exp(-zeta * phase)
    impulse = decay * math.sin(root * phase) / root
    slope = decay * (math.cos(root * phase) - zeta / root * math.sin(root * phase))
    scale = 200 * ulp * max(size, math.exp(zeta * late)) * math.exp(zeta * early)
    assert moved[0] == pytest.approx(impulse, abs=scale)
    assert rate[0] == pytest.approx(slope, abs=scale)
    assert power_lost(np.array(omega), np.asarray(zeta), rate) == pytest.approx(
        2 * zeta * omega * rate**2
    )


@given(
    st.floats(1e-6, 50.0), st.floats(0.0, 0.95), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0)
)  # fmt: skip
def test_loss_equals_the_decrease_of_energy(
    phase: float, zeta: float, swing: float, speed: float
) -> None:
    """The loss equals the decrease of energy, is never negative, and is zero without damping."""
    at, ratio = np.array([phase]), np.asarray(zeta)
    by_q, by_rate, sine, cosine = free_motion(at, ratio)
    q = swing * (1 + by_q) + speed * phase * (1 + by_rate)
    rate = swing * sine + speed * cosine
    lost = free_loss(at, ratio, np.array([swing]), np.array([speed]))
    before = (swing**2 + speed**2) / 2
    assert lost[0] == pytest.approx(before - float(q[0] ** 2 + rate[0] ** 2) / 2, abs=1e-14)
    assert lost[0] >= -4 * ulp * before
    if not zeta:
        assert lost[0] == 0.0


def test_logarithmic_decrement_and_loss_in_a_cycle() -> None:
    """A cycle reduces the amplitude by exp(-2 pi zeta/root).

    For a small loss factor the energy lost per cycle is 2 pi times that factor.
    """
    zeta = 0.02
    root = math.sqrt(1 - zeta**2)
    cycle = np.array([2 * math.pi / root])
    left = 1 + float(free_motion(cycle, np.asarray(zeta))[0][0])
    assert -math.log(left) == pytest.approx(2 * math.pi * zeta / root, rel=1e-13)
    small = 1e-6
    cycle = np.array([2 * math.pi])
    lost = float(free_loss(cycle, np.asarray(small), np.array([1.0]), np.array([0.0]))[0])
    assert lost / 0.5 == pytest.approx(2 * math.pi * (2 * small), rel=1e-5)
