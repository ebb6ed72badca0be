"""Test the estimated error of the pressure limit 1.6 Y far above the onset of yielding."""

import itertools
import math
import re

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from derivation.scene import indent, read, simulate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.yield_warnings import risen_pressure
from derivation.scene.model import Model
from generated.plasticity import plastic_restitution
from generated.plasticity_kernels import beyond, risen

PRESSURE = 2.0 / math.pi
"""The pressure limit 1.6 Y in units with a_y = R = E* = 1."""
YIELD = PRESSURE / 1.6
SCENE = {
    "sphere": {"radius": 0.01, "density": 7850.0},
    "plate": {"radius": 1.0, "thickness": 0.5, "youngs_modulus": 200e9, "poissons_ratio": 0.3,
              "yield_stress": 3e8},
    "effects": {"inertia": False},
}  # fmt: skip


def pressure(a: float) -> float:
    """Return the mean pressure of a plastic zone that grows like a cavity, at most 3 Y."""
    return min(3.0 * YIELD, 2.0 / 3.0 * (PRESSURE + YIELD * math.log(a)))


def depth(a: float) -> float:
    """Return the indentation: a^2/R at the onset, a^2/(2 R) in the fully plastic contact."""
    begun = 2.0 / 3.0 * PRESSURE
    return a * a / (1.0 + (pressure(a) - begun) / (3.0 * YIELD - begun))


def energy(a: float) -> float:
    """Return the work of loading: Hertz's up to the onset, then P delta - int delta dP."""
    knee = math.exp(1.5 * (3.0 - 3.2 / 3.0))
    ends = [1.0, *([knee] if knee < a else []), a]

    def lost(c: float) -> float:
        growing = 2.0 / 3.0 * YIELD / c if c < knee else 0.0
        return depth(c) * math.pi * (c * c * growing + 2.0 * c * pressure(c))

    taken = sum(quad(lost, *pair, epsrel=1e-10)[0] for pair in itertools.pairwise(ends))
    first, last = (math.pi * c * c * pressure(c) * depth(c) for c in (1.0, a))
    return 8.0 / 15.0 + last - first - taken


@pytest.mark.parametrize("ratio", [1.5, 3.0, 10.0, 30.0, 100.0, 1000.0])
def test_estimate_agrees_with_an_impact_of_increasing_pressure(ratio: float) -> None:
    """The estimate agrees with an integrated impact whose mean pressure rises to 3 Y.

    It is a function of impact speed over yield speed. Unloading follows Hertz's law with the
    radius of the flattened sphere.
    """
    brought = 8.0 / 15.0 * ratio**2
    a = float(brentq(lambda c: energy(c) - brought, 1.0, 1e3))
    force = math.pi * a * a * pressure(a)
    e = math.sqrt(0.3 * force**2 / a / brought)
    xi = ((6.0 * ratio**2 - 1.0) / 5.0) ** (1.0 / 6.0)
    wide = np.sqrt((2.0 * xi**3 + 1.0) / 3.0)
    more_force, more_e = beyond(*risen(wide))
    assert float(more_e) == pytest.approx(e / float(plastic_restitution(xi)), rel=0.1)
    assert float(more_force) == pytest.approx(force / (4.0 / 3.0 * xi**3), rel=0.1)


def test_fully_plastic_contact_agrees_with_johnson() -> None:
    """The restitution is 3.74 (Y/E*)^(1/2) (m v^2/2/(Y R^3))^(-1/8); Johnson's book has 3.8."""
    ratio = 3e4
    brought = 8.0 / 15.0 * ratio**2
    johnson = math.sqrt(0.3 * math.pi**1.25 * 4**0.75 * 3 * YIELD)
    johnson *= (brought / (3 * YIELD)) ** -0.125
    xi = ((6.0 * ratio**2 - 1.0) / 5.0) ** (1.0 / 6.0)
    _, more = beyond(*risen(np.sqrt((2.0 * xi**3 + 1.0) / 3.0)))
    assert float(more) * float(plastic_restitution(xi)) == pytest.approx(johnson, rel=1e-3)


def at_speed(speed: float) -> tuple[str, ...]:
    texts = simulate(read(SCENE | {"impact": {"speed": speed}})).warnings
    return tuple(text for text in texts if "onset of yield" in text)


def test_warning_of_impacts_far_beyond_the_onset() -> None:
    assert at_speed(0.003) == ()
    (text,) = at_speed(1.0)
    assert re.findall(r"1\.9", text) == ["1.9"] * 3


def test_warning_of_static_contacts_far_beyond_the_onset() -> None:
    scene = read(SCENE | {"impact": {"speed": 1.0}})
    light, heavy = indent(scene, force=[0.1, 1e5])
    assert not any("onset of yield" in text for text in light.warnings)
    assert any("onset of yield" in text for text in heavy.warnings)


def test_elastic_law_gives_no_warning() -> None:
    model = Model(R=0.005, m=4e-3, v0=1.0, h=0.5, b=1.0, lam=121e9, mu=81e9, yield_stress=1e8)
    wide = 200.0 * 0.005 * 1e8 / 2e11
    assert risen_pressure(ContactLaw(model, frozenset({"hertz"})), wide) is None
    actual = risen_pressure(ContactLaw(model, frozenset({"hertz", "plasticity"})), wide)
    assert actual is not None
    assert actual.stiffness == pytest.approx(3.0 / 1.6 * 2.0, rel=1e-3)
