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
from generated.arrays import Double as Array

STEPS, CLOSE, LONGEST = 40, 1e-13, 0.5
"""Largest number of Newton's steps; relative step that ends the iteration; longest one."""
SMALLEST = 0.5
"""Smallest contact radius over that of the law at the same force."""


class Flattening(NamedTuple):
    """Change of the curvature of a plate under the sphere, at a given force.

    Attributes
    ----------
    change
        Relative change of the force at a given contact radius [1].
    rate
        Its derivative with respect to the force [1/N].
    radius
        Contact radius for the weights of the modes of the plate [m].
    radius_rate
        Its derivative with respect to the force [m/N].
    """

    change: float
    rate: float
    radius: float
    radius_rate: float

    def times(self, part: float) -> "Flattening":
        """Return a part of this change."""
        return self._replace(change=part * self.change, rate=part * self.rate)


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


def flatter_plate(law: ContactLaw, a: float, flattening: Flattening) -> FlatterPlate:
    """Return the contact whose radius in the law is a [m].

    With Hertz pressure the contact does not depend on the curvature of the plate.

    Notes
    -----
    With the force P, the indentation D and the stiffness k of the law, and the factor f = 1 + e,
    the contact radius x at the force P(a) satisfies f P(x) = P(a), and the indentation is f D(x).
    Its derivative with respect to e is D(x) - P(x)/k(x). The modes of the plate contain the change
    of first order, but with the weights of a flat punch on a half-space: e times D - P/k of Hertz's
    law.
    """
    if not law.solved:
        return FlatterPlate(1.0, 1.0, 0.0, 0.0)
    change, rate, of_modes, of_modes_rate = flattening
    factor, ratio = 1.0 + change, (1.0 + change) ** (-1.0 / 3.0)
    for _ in range(STEPS):
        if not SMALLEST <= ratio <= 1.0:
            return FlatterPlate(factor, *3 * (math.nan,))
        radii = a * np.array([ratio, 1.0])
        shape = law.at(radii)
        force, stiffness = law.force(radii, shape), law.stiffness(radii, shape)
        growth = stiffness * 2.0 * shape.slope * (radii / law.model.R)  # dP/da
        step = math.log(force[1] / factor / force[0]) * force[0] / (radii[0] * growth[0])
        if not abs(step) > CLOSE:
            break
        ratio *= math.exp(max(-LONGEST, min(LONGEST, step)))
    depth, hertz = law.indentation(radii, shape), _of_hertz(law, np.array(of_modes))
    by_change = depth[0] - force[0] / stiffness[0] - hertz
    slower = 1.0 / stiffness[0] - 1.0 / stiffness[1]
    return FlatterPlate(
        factor,
        ratio,
        float(factor * depth[0] - depth[1] - change * hertz),
        float(slower + rate * by_change - 2.0 * change * hertz / of_modes * of_modes_rate),
    )


def _of_hertz(law: ContactLaw, a: Array) -> float:
    """Return D - P/k of Hertz's law [m] at a contact radius [m]."""
    R, modulus = np.asarray(law.model.R), np.asarray(law.modulus)
    bent = kernels.hertz_force(a, R, modulus) / kernels.hertz_stiffness(a, modulus)
    return float(a * (a / R) - bent)
