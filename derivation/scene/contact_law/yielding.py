"""Plastic contact: the indentation that yielding adds to an elastic law, by loading history.

Beyond the onset, where Hertz's pressure reaches 1.6 Y, loading adds plastic indentation. Unloading
is elastic with a flattened radius and leaves a dent (see `generated.plasticity`). The added
indentation depends on the force and on the largest force so far, so that it can be combined with
any elastic law. Depths are measured from the dent at the beginning of the current branch.
"""

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.effects.inertia import SLOWEST
from derivation.scene.numerics.crossing import rise
from derivation.scene.quasi_static import motion
from generated.arrays import Double as Array
from generated.plasticity_kernels import (
    hertz_energy,
    hertz_radius,
    loaded,
    reached,
    unloaded,
    widening,
    worked,
)


class Added(NamedTuple):
    """Indentation [m] added by yielding, and its derivative for the elastic radius [1]."""

    depth: Array
    depth_a: Array


@dataclass(frozen=True)
class Yielding:
    """The current loading or unloading branch of a plastic contact.

    Attributes
    ----------
    onset
        Hertz's radius [m] of the force at the onset of yield.
    R, modulus
        Sphere radius [m] and E* of the contact [Pa].
    end
        Radius of the elastic law [m] at which yielding begins or continues.
    ratio
        Hertz's radius of that force over `onset` [1]; 1 before the first yielding.
    loading
        Whether the contact is yielding.
    """

    onset: float
    R: float
    modulus: float
    end: float
    ratio: float = 1.0
    loading: bool = False

    @property
    def flattening(self) -> float:
        """Hertz's radius of the force over the contact radius on unloading [1]."""
        return float(unloaded(np.array(self.ratio))[0])

    @property
    def dent(self) -> float:
        """Depth of the dent after unloading [m]."""
        return self.onset * (self.onset / self.R) * float(unloaded(np.array(self.ratio))[1])

    @property
    def work(self) -> float:
        """Plastic work up to the last yielding [J]."""
        return self.onset_energy * float(worked(np.array(self.ratio))[0])

    @property
    def onset_energy(self) -> float:
        """Elastic energy of Hertz's contact at the onset of yield [J]."""
        return float(hertz_energy(*_arrays(self.onset, self.R, self.modulus)))

    def hertz_radius(self, force: Array) -> Array:
        """Return Hertz's radius of a force [m]."""
        return hertz_radius(force, *_arrays(self.R, self.modulus))

    def added(self, force: Array, force_a: Array) -> Added:
        """Return the added indentation at forces P [N]; `force_a` is dP/da [N/m]."""
        u = self.hertz_radius(force)
        u_a = u * np.divide(force_a, 3.0 * force, np.zeros_like(force), where=force > 0.0)
        if not self.loading:
            less = 1.0 - self.flattening
            return Added(-less * u * (u / self.R), -2.0 * less * (u / self.R) * u_a)
        depth, slope = loaded(u / self.onset)
        unit = self.onset / self.R
        return Added(unit * self.onset * depth - self.dent, unit * slope * u_a)

    def widened(self, a: Array, force: Array) -> Array:
        """Return the contact radius [m] from that of the elastic law [m] and the force [N]."""
        if not self.loading:
            return a / self.flattening
        ratio = self.hertz_radius(force) / self.onset
        return a / np.asarray(unloaded(ratio)[0], dtype=np.float64)

    def widening(self, a: Array, force: Array, force_a: Array) -> Array:
        """Return the derivative of `widened` with respect to the elastic radius on loading [1].

        `widened` is `a` times the ratio of the radii of a paraboloid on a half-space at this force,
        after yielding and without it.
        """
        u = self.hertz_radius(force)
        ratio = self.widened(np.ones_like(a), force)
        by_force = widening(ratio * u, *_arrays(self.onset, self.R, self.modulus))
        rate: Array = ratio + force_a * (a / u * by_force - ratio * a / (3.0 * force))
        return rate

    def begun(self) -> "Yielding":
        """Return the branch on which the contact begins or continues to yield."""
        return replace(self, loading=True)

    def turned(self, a: float, force: float) -> "Yielding":
        """Return the unloading branch from a radius of the elastic law [m] and its force [N]."""
        reached = float(self.hertz_radius(np.array(force))) / self.onset
        return replace(self, end=a, ratio=max(self.ratio, reached), loading=False)


@lru_cache(maxsize=4)
def yielding_of(law: ContactLaw) -> Yielding | None:
    """Return the branch of a law before yielding; None for an elastic law."""
    if not law.plastic:
        return None
    onset = onset_of(law)
    return Yielding(onset, law.model.R, law.modulus, _end(law, onset))


def onset_of(law: ContactLaw) -> float:
    """Return Hertz's radius [m] of the force at the onset of yield."""
    return float(onset_radius(law))


def onset_radius(law: ContactLaw) -> Array:
    """Return Hertz's radius [m] of the force at the onset of yield, of one scene or as a column."""
    from generated.plasticity import yield_radius

    model = law.model
    rigid = yield_radius(model.R, model.lam, model.mu, model.yield_stress)
    return np.asarray(rigid * (1.0 + law.softness))


@lru_cache(maxsize=4)
def units_of(law: ContactLaw) -> tuple[float, float]:
    """Return largest radius of the elastic law [m] and contact time [s] without plate deflection.

    The time of a plastic contact is an estimate.
    """
    branch, model = yielding_of(law), law.model
    if branch is not None:
        energy = 0.5 * model.m * model.v0 * model.v0
        ratio = energy / branch.onset_energy
        if ratio > 1.0:
            u = branch.onset * float(reached(np.array(ratio)))
            widest = u / float(unloaded(np.array(u / branch.onset))[0])
            return u, SLOWEST * widest * (widest / model.R) / model.v0
    elastic = motion.impact(law.half_space)
    return elastic.max_contact_radius, elastic.contact_time


def dent_error(law: ContactLaw, force: float, change: float) -> float:
    """Return the relative error of the dent after a largest force [N] [1]; infinite if unknown.

    Just beyond the onset of yield the dent grows as the square of the distance from it.

    Parameters
    ----------
    change
        Error of the logarithm of Hertz's radius of this force over that at the onset of yield [1].
    """
    branch = yielding_of(law)
    if branch is None:
        return 0.0
    ratio = float(branch.hertz_radius(np.array(force))) / branch.onset
    ratios = (max(1.0, ratio * math.exp(change * sign)) for sign in (-1.0, 0.0, 1.0))
    low, dent, high = (replace(branch, ratio=x).dent for x in ratios)
    return max(high - dent, dent - low) / dent if dent else high and math.inf


def _end(law: ContactLaw, onset: float) -> float:
    """Return the radius [m] at which the law has the force of Hertz's law at `onset` [m]."""
    if law.hertzian:
        return onset

    def beyond(radius: float) -> float:
        a = np.array([radius])
        return float(law.hertz_radius(law.force(a, law.at(a)))[0]) - onset

    return rise(beyond, 0.0, law.limit)


def _arrays(*numbers: float) -> tuple[Array, ...]:
    """Return numbers as arrays, for generated functions."""
    return tuple(np.array(number) for number in numbers)
