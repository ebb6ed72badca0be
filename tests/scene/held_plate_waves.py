"""Stress on the back face of a clamped or simply supported plate: a separate simulation.

Spectral elements over the meridian of the plate, with u = w = 0 or w = 0 on the whole edge, give
its modes. The force is distributed over the radius 0.2 h as in Hertz's law.
"""

import math
from itertools import pairwise

import numpy as np
from numpy.polynomial import legendre
from plate_waves import Array, PlateWaves
from scipy.linalg import eigh

from derivation.scene.model import Model

NODES = 7
"""Number of nodes of an element in each direction."""
LOADED = 0.2
"""Radius of the loaded circle over the half-thickness [1]."""


GAUSS, WEIGHTS = legendre.leggauss(NODES + 3)


def polynomials(x: Array) -> tuple[Array, Array]:
    """Return the values and slopes of the polynomials of an element at points from -1 to 1."""
    inner = legendre.legroots(legendre.legder([0.0] * (NODES - 1) + [1.0])).real
    to_nodes = np.linalg.inv(legendre.legvander(np.concatenate([[-1.0], inner, [1.0]]), NODES - 1))
    slopes = np.stack([legendre.legval(x, legendre.legder(e)) for e in np.eye(NODES)], 1)
    return legendre.legvander(x, NODES - 1) @ to_nodes, slopes @ to_nodes


def assembled(breaks: Array, power: int, left: bool, right: bool) -> Array:
    """Return the integrals of x^power f_i f_j; of the slopes f' where `left` or `right`."""
    value, slope = polynomials(GAUSS)
    whole = np.zeros((1 + (breaks.size - 1) * (NODES - 1),) * 2)
    for i, (low, high) in enumerate(pairwise(breaks)):
        half = 0.5 * (high - low)
        at = WEIGHTS * half * (low + half * (GAUSS + 1.0)) ** power
        one, two = (slope / half if each else value for each in (left, right))
        part = slice(i * (NODES - 1), i * (NODES - 1) + NODES)
        whole[part, part] += one.T @ (at[:, None] * two)
    return whole


class HeldPlateWaves(PlateWaves):
    """Frequencies and stresses of the modes of a plate with the edge of its model."""

    def __init__(self, model: Model, highest: float) -> None:
        """Compute the modes with angular frequencies up to `highest` [1/s]."""
        h, b, lam, mu = (float(x) for x in model.numbers[3:])
        inner, outer = h * np.array([0.0, LOADED, 0.5, 1.1]), h * np.array([0.6, 0.2, 0.05, 0.0])
        count = math.ceil((b - 1.7 * h) / (1.5 * h)) + 1
        radii = np.concatenate([inner, np.linspace(1.1 * h, b - 0.6 * h, count)[1:-1], b - outer])
        depths = h * np.array([-1.0, -0.6, 0.6, 1.0])
        r = {  # by the power of r, and the slopes of the first and the second function
            key: assembled(radii, key[0], key[1], key[2])
            for key in (
                (1, False, False), (1, True, True), (1, True, False),
                (0, False, False), (0, True, False), (-1, False, False),
            )
        }  # fmt: skip
        z, zz, zs = (
            assembled(depths, 0, *each) for each in ((False, False), (True, True), (True, False))
        )
        rigid, mixed = lam + 2.0 * mu, r[0, True, False]
        along = rigid * (r[1, True, True] + r[-1, False, False]) + lam * (mixed + mixed.T)
        both = lam * np.kron(r[1, True, False] + r[0, False, False], zs.T)
        both += mu * np.kron(r[1, True, False].T, zs)
        stiffness = np.block([
            [np.kron(along, z) + mu * np.kron(r[1, False, False], zz), both],
            [both.T, rigid * np.kron(r[1, False, False], zz) + mu * np.kron(r[1, True, True], z)],
        ])  # fmt: skip
        mass = model.density * np.kron(np.eye(2), np.kron(r[1, False, False], z))
        rows, columns = r[0, False, False].shape[0], z.shape[0]
        size, [end] = rows * columns, polynomials(np.array([-1.0]))[1]
        load, stress = np.zeros(2 * size), np.zeros(2 * size)
        # With s^2 = 1 - (r/a)^2, Hertz's pressure over the circle is 3 s^2 ds times the force.
        s = 0.5 * (GAUSS + 1.0)
        pressed = (1.5 * WEIGHTS * s * s) @ polynomials(2.0 * np.sqrt(1.0 - s * s) - 1.0)[0]
        load[size + columns * np.arange(NODES) + columns - 1] = -pressed
        stress[columns * np.arange(NODES)] = 4.0 * (lam + mu) * end / radii[1]
        stress[size + np.arange(NODES)] = 2.0 * lam * end / (depths[1] - depths[0])
        on_edge = np.arange(size - columns, size)
        held = [np.arange(columns), size + on_edge]
        held += [on_edge] if model.edge == "clamped" else []
        free = np.delete(np.arange(2 * size), np.concatenate(held))
        stiffness, mass = (2.0 * math.pi * part[np.ix_(free, free)] for part in (stiffness, mass))
        load, stress = load[free], stress[free]
        squares, shapes = eigh(stiffness, mass, subset_by_value=(0.0, highest**2))
        self.static = float(stress @ np.linalg.solve(stiffness, load))
        self.omega, self.drive = np.sqrt(squares), (stress @ shapes) * (load @ shapes)
