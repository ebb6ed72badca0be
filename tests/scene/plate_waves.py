"""Stress on the back face of a plate by all its waves under a given force: a separate simulation.

The plate has the paper's edge. Each Bessel mode of its radius has displacements over the thickness
that are polynomials, with stiffness and mass by Gauss's rule; the eigenvectors are the modes of
all wave branches. Each is driven by the force, which is linear in each time step.
"""

import math
from itertools import pairwise

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.special import j1, jn_zeros

from derivation.scene.model import Model

Array = NDArray[np.float64]
ORDER = 36
"""Number of polynomials over the thickness."""
DEEPEST = 14.0
"""Wave number times half-thickness from which on a mode does not reach the back face."""


class PlateWaves:
    """Frequencies, compliances and stresses on the back face of the modes of a plate.

    Attributes
    ----------
    static
        Stress [Pa] under a static point force of 1 N.
    """

    def __init__(self, model: Model, highest: float) -> None:
        """Compute the modes with angular frequencies up to `highest` [1/s]."""
        h, b, lam, mu = (float(x) for x in model.numbers[3:])
        x, weights = legendre.leggauss(ORDER + 4)
        value = legendre.legvander(x, ORDER - 1)
        slope = np.stack([legendre.legval(x, legendre.legder(e)) for e in np.eye(ORDER)], 1) / h
        weights = (h * weights)[:, None]
        mass, stiff, mixed = (
            one.T @ (weights * two) for one, two in ((value, value), (slope, slope), (slope, value))
        )
        face, back = np.ones(ORDER), (-1.0) ** np.arange(ORDER)
        back_slope = -back * np.arange(ORDER) * (np.arange(ORDER) + 1.0) / (2.0 * h)
        self.static, found, lowest = 0.0, [], 0.0
        for root in jn_zeros(0, 400):
            k, area = root / b, math.pi * b**2 * j1(root) ** 2
            deep = k * h > DEEPEST
            if deep and lowest > highest:
                break
            coupled = lam * k * mixed.T - mu * k * mixed
            stiffness = np.block([
                [(lam + 2.0 * mu) * k**2 * mass + mu * stiff, coupled],
                [coupled.T, (lam + 2.0 * mu) * stiff + mu * k**2 * mass],
            ])  # fmt: skip
            stress = np.concatenate([(lam + mu) * k * back, lam * back_slope])
            load = np.concatenate([0.0 * face, face])
            if not deep:
                self.static -= float(stress @ np.linalg.solve(stiffness, load)) / area
            if lowest > highest:
                continue
            inertia = model.density * np.kron(np.eye(2), mass)
            squares, shapes = eigh(stiffness, inertia)
            omega = np.sqrt(np.maximum(squares, 0.0))
            lowest, kept = omega[0], omega < highest
            found.append((omega[kept], -(stress @ shapes * (load @ shapes))[kept] / area))
        self.omega, self.drive = (np.concatenate(one) for one in zip(*found, strict=True))

    def largest_stress(self, times: Array, force: Array, further: float) -> float:
        """Return the largest stress [Pa] under a force [N], and a time [s] after it."""
        step = times[1] - times[0]
        force = np.concatenate([force, np.zeros(math.ceil(further / step))])
        omega, turn = self.omega, np.exp(1j * self.omega * step)
        # z = deviation from the static response, and its rate over omega.
        z, part = np.zeros(omega.size, dtype=complex), self.drive / omega**2
        lag = (turn - 1.0) / (1j * omega * step)
        largest = -math.inf
        for before, now in pairwise(force):
            z = turn * z - lag * part * (now - before)
            largest = max(largest, self.static * now + float(np.sum(z.real)))
        return largest
