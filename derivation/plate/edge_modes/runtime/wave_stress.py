"""Stress on the back face of a plate by its free waves and modes, on the axis.

A wave that deflects the contact face by w(+h) on the axis, along the load, causes the stress::

    sigma = (mu/h) S w(+h),   Sa = (3 - 4 gam) (2 x^2 - kap) tanh(p)/(2 p)     bending
                              Ss = (4 gam - 3) (2 x^2 - kap) coth(p)/(2 p)     extension

with x, kap, gam and p as in `inertia`; tension is positive. The mode J0(k r) - c I0(k2 r) of a
clamped or supported plate, with the numbers of `edge_modes`, has Sa of its part J0 times::

    [1 + c g2 k2^2/(g1 k^2)]/(1 - c t)

Arithmetic: x = k eta, and kap - x^2 from the frequency.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from generated import edge_mode_kernels
from generated.arrays import as_doubles, as_result, inside, quiet
from generated.edge_modes import Waves
from generated.wave_kernels import bending_stress, extension_stress, material

_STRESS = {"antisymmetric": bending_stress, "symmetric": extension_stress}


@quiet
def wave_stress(
    x: ArrayLike, frequency: ArrayLike, nu: ArrayLike, parity: str = "antisymmetric"
) -> np.ndarray:
    """Compute the stress of a wave on the axis of the back face, over its deflection.

    Formula (step 34 of the derivation)::

        h sigma/(mu w) = Sa or Ss

    Parameters
    ----------
    x : array_like
        Wave number times half-thickness, phi h [1]; 1e-40 <= x <= 1e40.
    frequency : array_like
        Frequency omega h/c_T [1] of a branch at x, as `plate_waves.branches` returns it.
    nu : array_like
        Poisson's ratio [1]; -1 < nu < 0.5.
    parity : str
        "antisymmetric" for A0, A1, ... (bending), "symmetric" for S0, S1, ... (extension).

    Returns
    -------
    float or ndarray
        h sigma/(mu w) [1] in the arguments' broadcast shape; NaN outside the domain.

    Raises
    ------
    ValueError
        If `parity` is not one of these.

    Examples
    --------
    >>> from generated.plate_waves import branches
    >>> from generated.wave_stress import wave_stress
    >>> print(f"{wave_stress(0.01, branches(0.01, 0.22, 1)[0][0], 0.22):.5e}")
    1.56398e-04
    """
    if parity not in _STRESS:
        raise ValueError(f"parity is 'antisymmetric' or 'symmetric', got {parity!r}")
    kind, [x, frequency, nu] = as_doubles(x, frequency, nu)
    [x] = inside([x], x >= 1e-40, x <= 1e40)
    [nu] = inside([nu], nu > -1, nu < 0.5)
    over = (frequency - x) * (frequency + x)
    return as_result(_STRESS[parity](over, x, *material(nu), nu), kind)


@quiet
def mode_stress(waves: Waves, eta: float, nu: float) -> np.ndarray:
    """Compute the stress of modes on the axis of the back face, over their deflection there.

    Formula (step 34 of the derivation)::

        h sigma/(mu w) = Sa [1 + c g2 k2^2/(g1 k^2)]/(1 - c t)

    Parameters
    ----------
    waves : Waves
        modes of a clamped or supported plate
    eta : float
        half-thickness over radius h/b [1] for which the modes were computed
    nu : float
        Poisson's ratio [1] for which they were computed

    Returns
    -------
    ndarray
        h sigma/(mu w) [1] of each mode, w the deflection of the contact face on the axis

    Examples
    --------
    >>> from generated.edge_modes import clamped_waves
    >>> from generated.wave_stress import mode_stress
    >>> print(mode_stress(clamped_waves(3, 0.03, 0.22), 0.03, 0.22).round(4))
    [0.0127 0.0545 0.1174]
    """
    _, [size, ratio] = as_doubles(eta, nu)
    state = edge_mode_kernels.wave(waves.k, size, ratio, waves.root)
    _, _, bending_part, turned, _ = state
    of_part = wave_stress(waves.k * size, waves.root, ratio)
    return edge_mode_kernels.mode_stress(of_part, bending_part, turned, waves.c, waves.t)
