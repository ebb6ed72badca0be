"""Base class of the effects: applicability, parameter, error bound, contribution to the law.

The rest of `scene` uses this interface and no names of effects; everything specific to an effect is
in its module.

Contributions and bounds are parts of F and S: at equal force P, with Hertz's radius a for the
modulus E* of the law, a^3 = 3 P R/(4 E*),

    delta = (a^2/R) (1 + F),   d delta/da = (2a/R) S.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from derivation.scene import kernels
from derivation.scene.model import Model
from derivation.scene.numerics import columns
from derivation.scene.scene import Scene

if TYPE_CHECKING:
    from derivation.scene.contact_law.law import ContactLaw

NO_BOUND = 10.0
"""Bound on a relative change from which the bound is not useful and is shown as 'no bound'."""
Array = NDArray[np.float64]
Numbers = kernels.Numbers


class Contribution(NamedTuple):
    """Contribution of an effect to F (`depth`) and S (`slope`) at contact radii [1]."""

    depth: Array
    slope: Array


class LawSamples(NamedTuple):
    """Samples of a contact law at contact radii up to the largest one.

    Force [N], indentation [m], stiffness [N/m], energy [J] and d log delta/d log a [1].
    """

    force: Array
    depth: Array
    stiffness: Array
    energy: Array
    growth: Array


@dataclass(frozen=True)
class BoundContext:
    """The contacts for which a bound is evaluated; for many scenes, a row of radii for each.

    Attributes
    ----------
    radii
        Hertz's radii of the force [m], increasing from 0.
    depth
        Largest indentation of the impact [m].
    sampled
        Function that samples the law with the included effects; only some bounds call it.
    """

    radii: Array
    depth: Numbers = 0.0
    sampled: Callable[[], LawSamples] | None = None

    @cached_property
    def samples(self) -> LawSamples:
        """Samples of the law with the included effects."""
        assert self.sampled is not None
        return self.sampled()

    def scaled(self, factor: Numbers | None) -> "BoundContext":
        """Return the context with all radii multiplied by a factor."""
        return self if factor is None else replace(self, radii=self.radii * factor)

    def sphere_force(self, R: Numbers) -> Array:
        """Return the force of a sphere over that of a paraboloid; NaN from the sphere radius on."""
        if not self._forces:
            rho = self.radii / R
            self._forces.append(kernels.sphere_contact(np.where(rho < 1, rho, np.nan)).force)
        return self._forces[0]

    @cached_property
    def _forces(self) -> list[Array]:
        """Cache of `sphere_force`."""
        return []


Results = tuple[float, float, float, float, float]
"""A number for each output, in the order of `OUTPUTS`."""
Changes = tuple[Numbers, Numbers, Numbers, Numbers, Numbers]
"""A number for each output of one scene, or a column for each output of many scenes."""


class Bound(NamedTuple):
    """Bound on the changes if an effect is omitted.

    Attributes
    ----------
    low, up
        Largest decrease and increase of S by the effect, at the given radii and all smaller ones;
        not negative [1].
    energy
        Logarithm of the factor by which the energy of the contact may increase [1].
    radius
        Logarithm of the factor by which the contact radius may change in addition [1].
    results
        Logarithm of the factor by which each output may change in addition, in their order [1].
    """

    low: Array
    up: Array
    energy: Numbers = 0.0
    radius: Numbers = 0.0
    results: Changes = (0.0, 0.0, 0.0, 0.0, 0.0)


def bounded_where(known: NDArray[np.bool_], changes: Changes) -> Changes:
    """Return the changes of the results where they are known, and infinity elsewhere."""
    time, depth, force, radius, speed = (
        columns.number(np.where(known, change, np.inf)) for change in changes
    )
    return time, depth, force, radius, speed


LENGTHS = {"b": "plate radius", "R": "sphere radius", "h": "half the plate thickness"}
"""The lengths that limit a contact radius, in the order of `Reach`."""


class Reach(NamedTuple):
    """Largest contact radius over plate radius, sphere radius and half-thickness [1]."""

    plate: float = 1.0
    sphere: float = 1.0
    thickness: float = math.inf

    def shortest(self, model: Model) -> Numbers:
        """Return the largest contact radius [m] in all three lengths."""
        reach: Numbers = np.minimum(self.plate * model.b, self.sphere * model.R)
        return np.minimum(reach, self.thickness * model.h)

    def in_words(self, limit: float) -> str:
        """Return the shortest of the lengths that count as symbols, value [m] and meaning."""
        counting = [pair for pair in zip(self, LENGTHS, strict=True) if pair[0] < math.inf]
        lengths = ", ".join(x if reach == 1.0 else f"{reach:g} {x}" for reach, x in counting)
        symbols = ", ".join(f"{x} {LENGTHS[x]}" for _, x in counting)
        return f"min({lengths}) = {limit:.6g} m ({symbols})"


class Effect:
    """A physical effect; the base class describes one that always applies and changes nothing.

    Attributes
    ----------
    name
        Name of the effect in scene files.
    adds
        What it adds to the model, in a few words.
    equation
        Its equation.
    parameter
        The dimensionless parameter that shows when it matters.
    source
        Its authors, and the derivation step that proves it.
    always_included
        Whether it cannot be omitted.
    selectable
        Whether the selection may include it. If not, it is not part of the law; its parameter and
        bound are shown if the scene requests it.
    contains, requires
        Names of the effects that are included with it because its equation contains them, and of
        those without which it cannot be computed.
    reach
        The contacts for which it can be computed.
    static
        Whether it also acts in a static contact.
    hertzian
        Whether the elastic contact keeps the form of Hertz's law.
    spherical
        Whether the profile is a sphere's, not a paraboloid's.
    bends
        Whether the plate deflects in proportion to the force.
    other_edge
        Whether the edge of the plate differs from the paper's.
    solved
        Whether the pressure follows from an integral equation, so that the law is not a sum of
        contributions.
    viscous
        Whether the contact is viscoelastic.
    plastic
        Whether the contact deforms plastically.
    dynamic
        Whether the plate has inertia.
    damps
        Whether the plate modes are damped.
    stretches
        Whether the middle plane of the plate stretches.
    within
        Name of an effect that it is a part of; if the scene disables that, it does not apply.
    remedy
        What to add to a scene to which it does not apply.
    cause
        Why it is included automatically; empty if the tolerance is the reason.
    """

    name: ClassVar[str]
    adds: ClassVar[str]
    equation: ClassVar[str]
    parameter: ClassVar[str]
    source: ClassVar[str]
    always_included: ClassVar[bool] = False
    selectable: ClassVar[bool] = True
    contains: ClassVar[frozenset[str]] = frozenset()
    requires: ClassVar[frozenset[str]] = frozenset()
    reach: ClassVar[Reach] = Reach()
    static: ClassVar[bool] = True
    hertzian: ClassVar[bool] = False
    spherical: ClassVar[bool] = False
    bends: ClassVar[bool] = False
    other_edge: ClassVar[bool] = False
    solved: ClassVar[bool] = False
    viscous: ClassVar[bool] = False
    plastic: ClassVar[bool] = False
    dynamic: ClassVar[bool] = False
    damps: ClassVar[bool] = False
    stretches: ClassVar[bool] = False
    within: ClassVar[str] = ""
    remedy: ClassVar[str] = ""
    cause: ClassVar[str] = ""

    def not_applicable_reason(self, model: Model) -> str:  # noqa: ARG002
        """Return why the effect does not apply to a scene; empty if it applies."""
        return "" if self.selectable else "shown only if the scene requests it"

    def without_change(self, scene: Scene) -> bool:  # noqa: ARG002
        """Return whether a scene gives the key of the effect, with a value that changes nothing."""
        return False

    def softness(self, model: Model) -> float:  # noqa: ARG002
        """Return what it adds to E/(1 - nu^2) of the plate over that of the sphere [1]."""
        return 0.0

    def gravity(self, model: Model) -> float:  # noqa: ARG002
        """Return what it adds to the gravitational acceleration during contact [m/s^2]."""
        return 0.0

    def value(self, model: Model, a: float) -> float:
        """Return the dimensionless parameter at a largest contact radius [m]."""
        raise NotImplementedError

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """Return a bound on the change of the results if the effect is omitted."""
        raise NotImplementedError

    def bounded(self, law: "ContactLaw") -> bool:  # noqa: ARG002
        """Return whether the bound is valid together with the effects of a law."""
        return True

    def proved(self, law: "ContactLaw") -> bool:  # noqa: ARG002
        """Return whether the bound is proved together with the effects of a law."""
        return True

    def check(self, law: "ContactLaw", enabled: bool) -> None:
        """Raise an error if a scene includes the effect and cannot compute it.

        The message depends on the keys that the scene gives, not on their numbers: it is the same
        for many scenes that are simulated together.

        Parameters
        ----------
        law
            The law, with this effect.
        enabled
            Whether the scene enables it.

        Raises
        ------
        SceneError
            If a key is missing or conflicts with another effect.
        """

    def check_omitted(self, part: str, error: float, rtol: float) -> None:
        """Raise an error if the effect must not be omitted but a required effect is disabled.

        Parameters
        ----------
        part
            Name of the required effect that the scene disables.
        error
            Bound on the change if this effect is omitted [1].
        rtol
            Largest relative change by the omitted effects [1].

        Raises
        ------
        SceneError
            If the error is too large.
        """


class PlateEffect(Effect):
    """An effect that adds to the deflection of the plate under the contact force.

    Attributes
    ----------
    difference
        Whether its contribution is computed as that of the whole plate minus those of others.
    """

    difference: ClassVar[bool] = False

    def contribution(self, model: Model, a: Array) -> Contribution:
        """Return its contribution to F and S at Hertz's radii [m], for a rigid sphere."""
        raise NotImplementedError


def weight_work_ratio(model: Model, depth: Numbers) -> Numbers:
    """Return the work of the weight over the kinetic energy [1], at a largest indentation [m].

    The weight accelerates the sphere during contact. The plate takes a fraction of the kinetic
    energy and of this work, but the restitution refers to the initial kinetic energy alone.
    """
    return 2.0 * model.gravity * depth / model.v0 / model.v0


def none_of(a: Array) -> Array:
    """Return zeros for all radii."""
    return np.zeros_like(a)
