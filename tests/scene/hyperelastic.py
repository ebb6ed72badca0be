"""Isotropic hyperelastic solids: energy, second Piola-Kirchhoff stress and its derivatives.

Strains are Green's: radial, axial and hoop strain, and twice the shear strain.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from derivation.checks.finite_elements.mesh import Double


class Response(NamedTuple):
    """Response of a solid to strains.

    Attributes
    ----------
    energy
        Elastic energy per volume before the deformation [Pa].
    stresses
        Derivatives of the energy by each strain [Pa].
    moduli
        Derivatives of each stress, by the number of the strain [Pa]; those not listed are zero.
    """

    energy: Double
    stresses: list[Double]
    moduli: list[dict[int, Double]]


Solid = Callable[[Sequence[Double], float, float], Response]
"""Response to strains for Lame's constants lambda and mu [Pa]."""


def linear(strains: Sequence[Double], lam: float, mu: float) -> Response:
    """Return the response of the St. Venant-Kirchhoff solid, whose stress is linear in strain."""
    *normal, shear = strains
    trace = sum(normal, 0.0 * shear)
    stresses = [lam * trace + 2.0 * mu * e for e in normal] + [mu * shear]
    energy = 0.5 * sum((s * e for s, e in zip(stresses, strains, strict=True)), 0.0 * shear)
    one = np.ones_like(shear)
    moduli = [{j: (lam + 2.0 * mu * (i == j)) * one for j in range(3)} for i in range(3)]
    return Response(energy, stresses, [*moduli, {3: mu * one}])


def neo_hookean(strains: Sequence[Double], lam: float, mu: float) -> Response:
    """Return the response of a compressible neo-Hookean solid.

    Its energy is mu/2 (I - 3) - mu log J + lam/2 (log J)^2 (Bonet and Wood 2008, Nonlinear
    Continuum Mechanics for Finite Element Analysis).

    Raises
    ------
    ArithmeticError
        If the solid is turned inside out.
    """
    rr, zz, tt = (1.0 + 2.0 * e for e in strains[:3])
    rz = strains[3]
    plane = rr * zz - rz * rz
    if not np.all((plane > 0.0) & (tt > 0.0)):
        raise ArithmeticError("elements: expected a positive volume")
    size = 0.5 * np.log(plane * tt)
    inverse = zz / plane, rr / plane, 1.0 / tt, -rz / plane
    k = mu - lam * size
    a, b, t, c = inverse
    stresses = [mu - k * a, mu - k * b, mu - k * t, -k * c]
    products = {
        (0, 0): 2.0 * a * a, (1, 1): 2.0 * b * b, (2, 2): 2.0 * t * t, (0, 1): 2.0 * c * c,
        (0, 3): 2.0 * a * c, (1, 3): 2.0 * b * c, (3, 3): a * b + c * c,
    }  # fmt: skip
    moduli = [
        {j: lam * x * y + k * products.get((min(i, j), max(i, j)), 0.0)
         for j, y in enumerate(inverse)}
        for i, x in enumerate(inverse)
    ]  # fmt: skip
    energy = 0.5 * mu * (rr + zz + tt - 3.0) - mu * size + 0.5 * lam * size * size
    return Response(energy, stresses, moduli)
