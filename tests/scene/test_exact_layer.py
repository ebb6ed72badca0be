"""Stress on the back face of an impact, against the exact solution of an infinite elastic layer.

The layer is loaded by the computed contact force, as Hertz pressure. Its equations are solved by
transforms, Hankel over the radius and Laplace over time; there are no modes.
"""

import itertools
import math

import numpy as np
import platecontact as pc
import pytest
from numpy.polynomial.legendre import leggauss

from derivation.checks.finite_elements.cases import HERTZ
from derivation.scene.dynamic.time_element import A, P
from generated.arrays import Double as Array

pytestmark = pytest.mark.one_version

H, DENSITY, MODULUS = 0.01, 2500.0, 70e9
TIMES = 1024


def impact(nu: float, width: float, echoes: float, ratio: float = 0.05) -> pc.Result:
    """Return an impact on a plate so wide that the edge has no effect on the stress.

    Parameters
    ----------
    width, echoes, ratio
        Contact radius over thickness, contact time over the time of a pressure wave to the back
        face and back, both on a half-space, and thickness over radius [1].
    """
    fastest = math.sqrt(MODULUS / DENSITY * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)))
    R, depth = 10.0 * width * H, width * H / 10.0
    speed = HERTZ * depth / (echoes * 2.0 * H / fastest)
    mass = 16.0 / 15.0 * MODULUS / (1.0 - nu * nu) * math.sqrt(R) * depth**2.5 / speed**2
    plate = {
        "radius": H / ratio, "thickness": H, "youngs_modulus": MODULUS, "poissons_ratio": nu,
        "density": DENSITY,
    }  # fmt: skip
    tables = {
        "sphere": {"radius": R, "mass": mass}, "plate": plate, "impact": {"speed": speed},
        "effects": {"inertia": True, "spherical_profile": False},
    }  # fmt: skip
    return pc.simulate(pc.read(tables))


def back_face_radial(k: float, s: Array, h: float, slowness: tuple[float, float]) -> Array:
    """Return mu u of the back face under the pressure J0(k r) exp(s t), u J1(k r) outwards.

    Waves that are symmetric and antisymmetric in z carry half of the pressure each.
    """
    p, q = (np.sqrt(k * k + (s * slow) ** 2) for slow in slowness)
    both, p_h, q_h = k * k + q * q, np.tanh(p * h), np.tanh(q * h)
    even = (both * q_h - 2 * p * q * p_h) / (both**2 * q_h - 4 * k * k * p * q * p_h)
    odd = (both / q_h - 2 * p * q / p_h) / (both**2 / q_h - 4 * k * k * p * q / p_h)
    return np.asarray(k * (even - odd) / 2)


def layer_stress(result: pc.Result) -> tuple[Array, Array]:
    """Return times [s], and the stress on the axis of the back face of the layer [Pa]."""
    m, motion, T = result.model, result.dynamics, result.contact_time
    assert motion is not None
    assert len(motion.inertia.contacts) == 1
    last = T + 2.0 * m.h / m.shear_speed
    t = np.arange(TIMES) * (1.5 * last / TIMES)
    rows = motion.rows(np.minimum(t, T))
    force, a = np.where(t < T, rows[P], 0.0), np.maximum(rows[A], 1e-9)
    shift = 10.0 / t[-1]  # of the Laplace variable, so that the periodic extension is negligible
    s = shift + 2j * np.pi * np.fft.rfftfreq(TIMES, t[1])
    slowness = math.sqrt(m.density / (m.lam + 2 * m.mu)), 1.0 / m.shear_speed
    # Waves much shorter than contact radius and thickness have gradually smaller weights.
    shortest = max(25.0, 12.0 * m.h / result.max_contact_radius)
    x, weights = leggauss(16)
    ends = np.linspace(0.0, shortest, 2 + math.ceil(shortest / 2.0))
    total = np.zeros(s.size, dtype=complex)
    for begin, end in itertools.pairwise(ends):
        for place, weight in zip(x, weights, strict=True):
            wave = begin + (end - begin) * (1 + place) / 2
            fading = math.cos(math.pi / 2 * max(0.0, (wave / shortest - 0.4) / 0.6)) ** 2
            k, y = wave / m.h, np.maximum(wave / m.h * a, 1e-3)
            hertz = 3 * (np.sin(y) - y * np.cos(y)) / y**3
            pressure = np.fft.rfft(force * hertz * np.exp(-shift * t)) / (2 * np.pi)
            part = weight * (end - begin) / 2 / m.h * fading
            total += part * k * k * back_face_radial(k, s, m.h, slowness) * pressure
    of_strain = (3 * m.lam + 2 * m.mu) / (m.lam + 2 * m.mu)
    stress = of_strain * np.fft.irfft(total, TIMES) * np.exp(shift * t)
    return t[t < last], stress[t < last]


@pytest.mark.parametrize(
    ("nu", "width", "echoes"), [(0.3, 0.1, 5.0), (0.489, 0.1, 8.0), (0.489, 0.02, 5.0)]
)
def test_stress_is_that_of_the_exact_layer(nu: float, width: float, echoes: float) -> None:
    """Finite elements give 5 to 10 % more for nu = 0.489.

    Their stress oscillates by 10 % as nodes come into contact, and smoothing does not remove this.
    Under their contact force, the exact layer also has the stress of this program.
    """
    result = impact(nu, width, echoes)
    t, stress = layer_stress(result)
    change = result.max_tensile_stress / float(stress.max()) - 1.0
    assert abs(change) < min(result.tensile_stress.error, 0.015)
    assert t[stress.argmax()] < result.contact_time


@pytest.mark.parametrize(("nu", "echoes", "factor"), [(0.489, 3.0, 1.4), (0.489, 2.0, 3.0)])
def test_largest_stress_may_occur_after_the_last_separation(
    nu: float, echoes: float, factor: float
) -> None:
    """An earlier version stopped at separation, at as little as 1/20 of the largest stress."""
    result = impact(nu, 0.02, echoes)
    t, stress = layer_stress(result)
    before = float(stress[t < result.contact_time].max())
    assert result.max_tensile_stress > 0.99 * factor * before
    change = result.max_tensile_stress / float(stress.max()) - 1.0
    assert abs(change) < min(result.tensile_stress.error, 0.015)
