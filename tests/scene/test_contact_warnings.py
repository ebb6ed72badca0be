"""Warnings about a sphere that its weight returns to a plate that still vibrates."""

import math
from dataclasses import replace

import numpy as np
import platecontact as pc
import pytest

from derivation.scene.dynamic.contact_warnings import duration_warnings, fall_warnings

G = 1.3174
"""Gravitational acceleration at which the sphere rises less than the plate deflects [m/s^2]."""


def _pane(gravity: float) -> pc.Scene:
    """Return a heavy, soft sphere on a wide, thin plate."""
    return pc.Scene(
        sphere=pc.Sphere(
            radius=0.0393, density=11400.0, youngs_modulus=0.2e9, poissons_ratio=0.24
        ),
        plate=pc.Plate(
            radius=0.795, thickness=0.021, youngs_modulus=1.21e9, poissons_ratio=0.255,
            density=1694.0, edge="simply-supported",
        ),
        impact=pc.Impact(speed=0.2243, gravity=gravity),
        accuracy=pc.Accuracy(rtol=0.1),
        inertia=pc.Inertia(branches="A0"),
    )  # fmt: skip


@pytest.mark.parametrize("gravity", [0.0, 1e-3 * G, G])
def test_a_warning_is_given_if_the_falling_sphere_meets_the_vibrating_plate(
    gravity: float,
) -> None:
    result = pc.simulate(_pane(gravity))
    assert result.dynamics is not None
    history = result.dynamics.impact_history
    flying = replace(
        history.problem, weight=gravity * history.problem.T / result.scene.impact.speed
    )
    # On a static plate, the sphere would fall back after the time 2 v/g.
    aloft = 2.0 * result.restitution / flying.weight if gravity else 1e3
    times = np.linspace(0.0, min(aloft, 1e3), 5000)[1:]
    after = history.contacts[-1].after
    meets = any(flying.flown(after, float(t)).approach > 0.0 for t in times)
    assert meets == (gravity == G)
    assert any("the weight returns the sphere" in text for text in result.warnings) == meets


def test_a_fall_within_the_error_of_the_speed_is_possible() -> None:
    rise = 0.5 * 0.1**2 / 9.81
    assert not fall_warnings(9.81, 0.1, 0.9 * rise)
    [text] = fall_warnings(9.81, 0.1, 0.9 * rise, error=0.06)
    assert "may return (speed known to 6 %) the sphere to a moving plate" in text
    assert not fall_warnings(9.81, 0.1, 0.9 * rise, error=0.05)
    [text] = fall_warnings(9.81, 0.1, 0.1 * rise, error=12.0)
    assert "may return (speed unknown) the sphere" in text
    assert not fall_warnings(0.0, 0.1, rise, error=2.0)
    [text] = fall_warnings(9.81, 0.1, 1.1 * rise, error=0.06)
    assert "the weight returns the sphere" in text


def test_a_jump_of_the_duration_is_part_of_its_error_only_if_it_has_one() -> None:
    scene = pc.Scene(
        sphere=pc.Sphere(radius=0.02, material="steel"),
        plate=pc.Plate(radius=0.2, thickness=0.01, material="PMMA", edge="clamped"),
        impact=pc.Impact(speed=1.5),
        inertia=pc.Inertia(modes=10, branches="A0"),
    )
    result = pc.simulate(scene)
    assert math.isinf(result.bound_of("contact_time"))
    [text] = [text for text in result.warnings if "the omitted modes" in text]
    assert "error" not in text
    [text] = duration_warnings(0.1, bounded=True)
    assert text.endswith("change by 10 %, which its error includes")
