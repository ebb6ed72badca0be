"""Domain of the contact law: plate dimensions and elastic constants.

Arithmetic: h/b, and the choice of points at which plates are compared for repetition.
"""

import numpy as np

from generated import contact_kernels as kernels
from generated.arrays import Double, inside
from generated.contact_series import THICKEST, THINNEST, Plates, plates_of
from generated.ranges import moderate

_MANY = 256  # number of plates from which a search for repeated plates saves time
_SAMPLE = 128


def plates_of_lengths(h: Double, b: Double) -> tuple[Plates, np.ndarray]:
    """Return the polynomials of the plates h and b, broadcast, and the index of each plate.

    Dimensions outside the domain give polynomials of NaN. Among many plates, those with equal
    h/b are prepared once.
    """
    h, b = np.broadcast_arrays(h, b)
    valid = (h > 0) & (b > 0)
    eta = np.where(valid, h, np.nan) / b
    [eta] = inside([eta], eta >= THINNEST, eta <= THICKEST)
    if _repeats(eta.ravel()):
        different, number = np.unique(eta, return_inverse=True)
        return plates_of(different), number.reshape(eta.shape)
    return plates_of(eta.ravel()), np.arange(eta.size).reshape(eta.shape)


def _repeats(eta: Double) -> bool:
    """Return whether some of many plates are repeated, judged by a sample of them."""
    if eta.size < _MANY:
        return False
    some = eta[:: -(-eta.size // _SAMPLE)]
    return np.unique(some).size < some.size


def elastic(lam: Double, mu: Double) -> tuple[np.ndarray, np.ndarray]:
    """Return conditions on the Lame constants: positive bulk modulus and shear modulus."""
    first, second = moderate(lam, mu)
    return 3.0 * first > -2.0 * second, mu > 0


def modulus_factors(lam: Double, mu: Double) -> tuple[Double, Double]:
    """Return (4/3) E* as factors."""
    return mu, kernels.modulus_over_mu(*moderate(lam, mu))
