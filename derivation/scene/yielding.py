"""A contact that yields: what it adds to the elastic law at a force, and what it remembers.

Beyond the onset, where Hertz's pressure reaches 1.6 Y, loading adds plastic indentation; unloading
is elastic with a flattened radius, and leaves a dent (see `generated.plasticity`). What is added
depends on the force and on the largest force there was, and stands beside any elastic law. Depths
are counted from the dent that was there when the branch began.
"""

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from derivation.scene import motion
from derivation.scene.effects.effect import Array
from derivation.scene.effects.inertia import SLOWEST
from derivation.scene.law import ContactLaw
from generated.plasticity_kernels import (
    hertz_energy,
    hertz_radius,
    loaded,
    reached,
    unloaded,
    widening,
    worked,
)

_HALVINGS = 80


class Added(NamedTuple):
    """Indentation [m] that yielding adds, and its slope by the contact radius of the law [1]."""

    depth: Array
    depth_a: Array


@dataclass(frozen=True)
class Yielding:
    """The branch that a contact is on.

    Attributes
    ----------
    onset
        Hertz's radius of the force at which the contact begins to yield [m].
    R, modulus
        Sphere radius [m] and E* of the contact [Pa].
    end
        Radius of the elastic law [m] at which the contact yields (further).
    ratio
        Hertz's radius of that force over `onset`: 1 as long as it has not yielded.
    loading
        Whether it yields now.
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
        """Depth of the dent, elastic indentation gone [m]."""
        return self.onset * (self.onset / self.R) * float(unloaded(np.array(self.ratio))[1])

    @property
    def work(self) -> float:
        """Plastic work [J]."""
        return self.onset_energy * float(worked(np.array(self.ratio))[0])

    @property
    def onset_energy(self) -> float:
        """Energy of Hertz's contact at the onset [J]."""
        return float(hertz_energy(*_arrays(self.onset, self.R, self.modulus)))

    def hertz_radius(self, force: Array) -> Array:
        """Hertz's radius of a force [m]."""
        return hertz_radius(force, *_arrays(self.R, self.modulus))

    def added(self, force: Array, force_a: Array) -> Added:
        """What is added at elastic forces [N], given their slope by the law's radius [N/m]."""
        u = self.hertz_radius(force)
        u_a = u * np.divide(force_a, 3.0 * force, np.zeros_like(force), where=force > 0.0)
        if not self.loading:
            share = 1.0 - self.flattening
            return Added(-share * u * (u / self.R), -2.0 * share * (u / self.R) * u_a)
        depth, slope = loaded(u / self.onset)
        unit = self.onset / self.R
        return Added(unit * self.onset * depth - self.dent, unit * slope * u_a)

    def widened(self, a: Array, force: Array) -> Array:
        """Contact radius [m], given that of the elastic law [m] and the force there [N]."""
        if not self.loading:
            return a / self.flattening
        ratio = self.hertz_radius(force) / self.onset
        return a / np.asarray(unloaded(ratio)[0], dtype=np.float64)

    def widening(self, radius: Array) -> Array:
        """Growth of the contact radius [m] with the force on loading [m/N], at such radii."""
        return widening(radius, *_arrays(self.onset, self.R, self.modulus))

    def begun(self) -> "Yielding":
        """The same where it begins to yield (further)."""
        return replace(self, loading=True)

    def turned(self, a: float, force: float) -> "Yielding":
        """The same where it ceases to, at a radius of the law [m] and its force [N]."""
        reached = float(self.hertz_radius(np.array(force))) / self.onset
        return replace(self, end=a, ratio=max(self.ratio, reached), loading=False)


def yielding_of(law: ContactLaw) -> Yielding | None:
    """The contact of a law before it yields; None if it does not."""
    if not law.plastic:
        return None
    onset = onset_of(law)
    return Yielding(onset, law.model.R, law.modulus, _end(law, onset))


def onset_of(law: ContactLaw) -> float:
    """Hertz's radius [m] of the force at which the contact of a law begins to yield."""
    from generated.plasticity import yield_radius

    model = law.model
    rigid = float(yield_radius(model.R, model.lam, model.mu, model.yield_stress))
    return rigid * (1.0 + law.softness)


@lru_cache(maxsize=4)
def units_of(law: ContactLaw) -> tuple[float, float]:
    """Largest radius of the elastic law [m] and contact time [s] on a plate that does not deflect.

    The time of a contact that yields is a guess.
    """
    branch, model = yielding_of(law), law.model
    if branch is not None:
        energy = 0.5 * model.m * model.v0 * model.v0
        share = energy / branch.onset_energy
        if share > 1.0:
            u = branch.onset * float(reached(np.array(share)))
            widest = u / float(unloaded(np.array(u / branch.onset))[0])
            return u, SLOWEST * widest * (widest / model.R) / model.v0
    elastic = motion.impact(law.half_space)
    return elastic.max_contact_radius, elastic.contact_time


def _end(law: ContactLaw, onset: float) -> float:
    """Radius [m] at which the law has Hertz's force of another."""
    if law.hertzian:
        return onset
    low, high = 0.0, law.limit
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        a = np.array([middle])
        below = float(law.hertz_radius(law.force(a, law.at(a)))[0]) < onset
        low, high = (middle, high) if below else (low, middle)
    return high


def _arrays(*numbers: float) -> tuple[Array, ...]:
    """Numbers as kernels take them."""
    return tuple(np.array(number) for number in numbers)
