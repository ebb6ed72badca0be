"""A static contact on a plate that is flatter under the sphere than in the linear law.

A plate that stretches bends less. If the change of its curvature is the same everywhere under the
contact, the sphere is pressed into the linear plate like one of another radius. At a given contact
radius, force, pressure and indentation of the law are then multiplied by the same factor.
"""

import math
from typing import NamedTuple

import numpy as np

from derivation.scene import kernels
from derivation.scene.contact_law.law import ContactLaw

STEPS, CLOSE, LONGEST = 40, 1e-13, 0.5
"""Largest number of Newton's steps; relative step that ends the iteration; longest one."""
SMALLEST = 0.5
"""Smallest contact radius over that of the law at the same force."""


class FlatterPlate(NamedTuple):
    """A contact over the one of the law at the same force.

    Attributes
    ----------
    factor
        Force over that of the law at the same contact radius [1].
    radius
        Ratio of the contact radii [1]; NaN below `SMALLEST`.
    depth
        Change of the indentation besides that by the modes of the plate [m].
    compliance
        Its derivative with respect to the force [m/N].
    """

    factor: float
    radius: float
    depth: float
    compliance: float


def flatter_plate(
    law: ContactLaw, a: float, change: float, rate: float, of_modes: float
) -> FlatterPlate:
    """Return the contact whose radius in the law is a [m].

    Parameters
    ----------
    law
        The law. With Hertz pressure nothing changes.
    change
        Relative change of the force at a given contact radius [1].
    rate
        Its derivative with respect to the force [1/N].
    of_modes
        Contact radius for the weights of the modes [m].

    Notes
    -----
    With the force P, the indentation D and the stiffness k of the law, and the factor f = 1 + e,
    the contact radius x at the force P(a) satisfies f P(x) = P(a), and the indentation is f D(x).
    Its derivative with respect to e is D(x) - P(x)/k(x). The modes of the plate contain the change
    of first order, but with the weights of a flat punch on a half-space: e times D - P/k of Hertz's
    law.
    """
    factor = 1.0 + change
    if not law.solved:
        return FlatterPlate(1.0, 1.0, 0.0, 0.0)
    x, R, modulus = np.array([a, a * factor ** (-1.0 / 3.0)]), law.model.R, law.modulus
    for _ in range(STEPS):
        if not SMALLEST * a <= x[1] <= a:
            return FlatterPlate(factor, *3 * (math.nan,))
        # The law takes increasing radii.
        at = law.at(x[::-1])
        force, stiffness = law.force(x[::-1], at)[::-1], law.stiffness(x[::-1], at)[::-1]
        growth = stiffness * 2.0 * at.slope[::-1] * (x / R)
        step = math.log(force[0] / factor / force[1]) * force[1] / (x[1] * growth[1])
        if not abs(step) > CLOSE:
            break
        x[1] *= math.exp(max(-LONGEST, min(LONGEST, step)))
    depth = law.indentation(x[::-1], at)[::-1]
    hertz = of_modes * (of_modes / R) - (
        kernels.hertz_force(of_modes, R, modulus) / kernels.hertz_stiffness(of_modes, modulus)
    )
    by_change = depth[1] - force[1] / stiffness[1] - hertz
    slower = 1.0 / stiffness[1] - 1.0 / stiffness[0]
    return FlatterPlate(
        factor,
        float(x[1]) / a,
        float(factor * depth[1] - depth[0] - change * hertz),
        float(slower + rate * by_change - 2.0 * change * hertz / (a * growth[0])),
    )
