"""Element boundaries over radius and thickness, graded towards the contact."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Double = NDArray[np.float64]


@dataclass(frozen=True)
class Mesh:
    """Boundaries of the rectangular elements and their polynomial degree.

    Parameters
    ----------
    r_ends
        Element boundaries over the radius, from 0 to the plate radius [m].
    z_ends
        Element boundaries over the thickness, from -h to h [m].
    degree
        Polynomial degree of displacements in both directions.
    reach
        Radius up to which nodes of the contact face may touch the sphere [m].
    """

    r_ends: Double
    z_ends: Double
    degree: int
    reach: float

    @property
    def columns(self) -> int:
        """Number of nodes over the radius."""
        return (self.r_ends.size - 1) * self.degree + 1

    @property
    def rows(self) -> int:
        """Number of nodes over the thickness."""
        return (self.z_ends.size - 1) * self.degree + 1


@dataclass(frozen=True)
class Grading:
    """Mesh density of a plate.

    Parameters
    ----------
    contact
        Number of elements over the reach of the contact, before halving.
    growth
        Ratio of neighbouring element sizes away from the contact, until the largest size.
    thickness
        Largest element size over the plate thickness.
    far
        Largest radial element size over the plate thickness, away from the contact.
    degree
        Polynomial degree.
    core
        How often the element at the axis is halved; the layer at the contact face is as thin.
    edge
        How often the element at the plate's edge is halved.
    """

    contact: int = 8
    growth: float = 2.0
    thickness: float = 0.5
    far: float = 1.0
    degree: int = 4
    core: int = 0
    edge: int = 2


def graded_mesh(b: float, thickness: float, reach: float, grading: Grading) -> Mesh:
    """Return the mesh of a plate of radius b [m] and thickness [m], fine up to the reach [m]."""
    size = reach / grading.contact
    inner = _halved(np.linspace(0.0, reach, grading.contact + 1), grading.core)
    outer = _growing_intervals(
        size, b - reach, grading.growth, grading.far * thickness, grading.edge
    )
    r_ends = np.concatenate((inner, reach + outer[1:]))
    depth = _growing_intervals(
        size * 0.5**grading.core, thickness, grading.growth, grading.thickness * thickness, 0
    )
    z_ends = thickness / 2 - depth[::-1]
    r_ends[-1], z_ends[0], z_ends[-1] = b, -thickness / 2, thickness / 2
    return Mesh(r_ends, z_ends, grading.degree, reach)


def contactless_mesh(b: float, thickness: float, layers: int, degree: int) -> Mesh:
    """Return the mesh of a plate without contact; elements are halved towards edge and faces.

    `layers` is the number of halvings, from half the thickness on.
    """
    steps = thickness / 2 * 0.5 ** np.arange(layers + 1)
    h = thickness / 2
    z_ends = np.concatenate((-h + np.append(0.0, steps[::-1]), h - steps[1:], [h]))
    regular = np.linspace(0.0, b - h, max(int(np.ceil((b - h) / thickness)), 1) + 1)
    r_ends = np.concatenate((regular, b - steps[1:], [b]))
    return Mesh(r_ends, z_ends, degree, 0.0)


def _halved(ends: Double, times: int) -> Double:
    """Return the ends after halving the first interval repeatedly towards its start."""
    more = ends[1] * 0.5 ** np.arange(times, 0, -1)
    return np.concatenate((ends[:1], more, ends[1:]))


def _growing_intervals(
    first: float, length: float, growth: float, largest: float, last: int
) -> Double:
    """Return ends of intervals from 0 to a length, which grow from a first to a largest size.

    All sizes are then reduced to fit the length. The last interval is halved `last` times towards
    the end.
    """
    ends, size = [0.0], first
    while ends[-1] < length:
        ends.append(ends[-1] + size)
        size = min(size * growth, largest)
    scaled = np.array(ends) * (length / ends[-1])
    if not last:
        return scaled
    start, step = scaled[-2], scaled[-1] - scaled[-2]
    more = length - step * 0.5 ** np.arange(1, last + 1)
    return np.concatenate((scaled[:-1], more, scaled[-1:])) if start < more[0] else scaled
