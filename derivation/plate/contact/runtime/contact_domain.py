"""Domain of the contact law: the plates of given lengths, and elastic constants.

Arithmetic: h/b, and which points are compared to find plates that occur more than once.
"""

import numpy as np

from generated import contact_kernels as kernels
from generated.arrays import Double, inside
from generated.contact_series import THICKEST, THINNEST, Plates, plates_of
from generated.ranges import moderate

_MANY = 256  # lengths from which on it pays to look for plates that occur more than once
_SAMPLE = 128


def plates_of_lengths(h: Double, b: Double) -> tuple[Plates, np.ndarray]:
    """Polynomials of the plates of the broadcast h and b, and a plate's number in that shape.

    Lengths outside the domain make a plate whose polynomials are NaN. Plates of the same h/b
    among many lengths are prepared once.
    """
    h, b = np.broadcast_arrays(h, b)
    sound = (h > 0) & (b > 0)
    eta = np.where(sound, h, np.nan) / b
    [eta] = inside([eta], eta >= THINNEST, eta <= THICKEST)
    if _repeats(eta.ravel()):
        different, number = np.unique(eta, return_inverse=True)
        return plates_of(different), number.reshape(eta.shape)
    return plates_of(eta.ravel()), np.arange(eta.size).reshape(eta.shape)


def _repeats(eta: Double) -> bool:
    """Whether some of many plates occur more than once, as a few of them tell."""
    if eta.size < _MANY:
        return False
    some = eta[:: -(-eta.size // _SAMPLE)]
    return np.unique(some).size < some.size


def elastic(lam: Double, mu: Double) -> tuple[np.ndarray, np.ndarray]:
    """Conditions on Lame's constants: a positive bulk modulus, and a positive shear modulus."""
    first, second = moderate(lam, mu)
    return 3.0 * first > -2.0 * second, mu > 0


def modulus_factors(lam: Double, mu: Double) -> tuple[Double, Double]:
    """(4/3) E*, as factors."""
    return mu, kernels.modulus_over_mu(*moderate(lam, mu))
