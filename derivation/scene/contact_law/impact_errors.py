"""Errors of results that are compared with limits: the extreme values within these errors."""

import math
from typing import NamedTuple

import numpy as np

from derivation.scene.kernels import Numbers


class ImpactErrors(NamedTuple):
    """Bounds on the relative errors of the results of an impact, without those of the model [1].

    A result without a bound is compared with a limit without an error.
    """

    contact_time: Numbers = 0.0
    max_indentation: Numbers = 0.0
    max_contact_radius: Numbers = 0.0

    def shortest_time(self, contact_time: Numbers) -> Numbers:
        """Return the shortest contact time [s] within its error."""
        return contact_time / (1.0 + _known(self.contact_time))

    def largest_radius(self, a: Numbers) -> Numbers:
        """Return the largest contact radius [m] within its error."""
        return a * (1.0 + _known(self.max_contact_radius))

    def largest_deflection(self, deflection: Numbers, indentation: Numbers) -> Numbers:
        """Return the largest deflection of the plate [m] within the errors of the results.

        It is the indentation without the local one, which grows with the square of the radius.
        """
        local = np.maximum(indentation - deflection, 0.0)
        by_radius = 2.0 * _known(self.max_contact_radius) * local
        return deflection + _known(self.max_indentation) * indentation + by_radius


EXACT = ImpactErrors()


def _known(error: Numbers) -> Numbers:
    """Return an error, 0 where it is unknown."""
    if isinstance(error, float):  # arrays of one number take 20 times as long
        return error if math.isfinite(error) else 0.0
    return np.where(np.isfinite(error), error, 0.0)
