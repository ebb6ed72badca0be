"""The base of all effects: whether one applies, its parameter, its bound, its part of the law.

The rest of `scene` asks these questions and knows no effect by its name: what is particular to an
effect is in its file.

Contributions and bounds are parts of F and S: at equal force P, a being Hertz's radius with the
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

if TYPE_CHECKING:
    from derivation.scene.law import ContactLaw

NO_BOUND = 10.0
"""A bound from here on is so far above what it bounds that it is shown as no bound."""
Array = NDArray[np.float64]
Numbers = kernels.Numbers


class Contribution(NamedTuple):
    """What an effect adds to F and to S at contact radii [1]."""

    depth: Array
    slope: Array


class LawSamples(NamedTuple):
    """Samples of a contact law at contact radii up to its largest.

    Force [N], indentation [m], stiffness [N/m], energy [J] and d log delta/d log a [1].
    """

    force: Array
    depth: Array
    stiffness: Array
    energy: Array
    growth: Array


@dataclass(frozen=True)
class BoundContext:
    """Where a bound is evaluated; of many scenes a row of radii for each, and columns of numbers.

    Attributes
    ----------
    radii
        Hertz's radii of the force [m], from 0 on, growing.
    depth
        Largest indentation [m], of an impact.
    sampled
        Samples the law of the included effects, of an impact: only some bounds need that.
    """

    radii: Array
    depth: Numbers = 0.0
    sampled: Callable[[], LawSamples] | None = None

    @cached_property
    def samples(self) -> LawSamples:
        """Samples of the law of the included effects."""
        assert self.sampled is not None
        return self.sampled()

    def row(self, index: int) -> "BoundContext":
        """That of one of many scenes."""
        depth = np.asarray(self.depth)[index].item()
        if self.sampled is None:
            return BoundContext(self.radii[index], depth)
        samples = LawSamples(*(x[index] for x in self.samples))
        return BoundContext(self.radii[index], depth, lambda: samples)

    def stretched(self, factor: Numbers | None) -> "BoundContext":
        """The same with all radii larger."""
        return self if factor is None else replace(self, radii=self.radii * factor)

    def sphere_force(self, R: Numbers) -> Array:
        """Force of a sphere over that of a paraboloid at the radii; NaN from the sphere's on."""
        if not self._forces:
            rho = self.radii / R
            self._forces.append(kernels.sphere_contact(np.where(rho < 1, rho, np.nan)).force)
        return self._forces[0]

    @cached_property
    def _forces(self) -> list[Array]:
        """What `sphere_force` returns, once it is known."""
        return []


Results = tuple[float, float, float, float, float]
"""A number for each of the outputs."""
Changes = tuple[Numbers, Numbers, Numbers, Numbers, Numbers]
"""The same of one scene or of many."""


class Bound(NamedTuple):
    """What leaving an effect out changes at most.

    Attributes
    ----------
    low, up
        How far S may be below and above the law without the effect, at the radii given and
        all smaller ones; not negative [1].
    energy
        Logarithm of the factor by which more energy may go into the contact [1].
    radius
        Logarithm of the factor by which the contact radius may differ besides [1].
    results
        The same of every result, in the order of the outputs [1].
    """

    low: Array
    up: Array
    energy: Numbers = 0.0
    radius: Numbers = 0.0
    results: Changes = (0.0, 0.0, 0.0, 0.0, 0.0)


class Reach(NamedTuple):
    """Largest contact radius over the radii of plate and sphere and the half-thickness [1]."""

    plate: float = 1.0
    sphere: float = 1.0
    thickness: float = math.inf


class Effect:
    """An effect: a base whose answers are those of one that always applies and changes nothing.

    Attributes
    ----------
    name
        As the scene file calls it.
    adds
        What it adds, in a few words.
    equation
        Its equation.
    parameter
        The dimensionless parameter that shows when it matters.
    source
        Who derived it, and the link of the chain that proves it here.
    always_included
        Whether it cannot be omitted.
    selectable
        Whether the selection may include it. If not, it is no part of the law; its parameter and
        bound are shown if a scene asks for it.
    contains, requires
        Names of the effects that it takes into its own equation, and so includes, and of those
        without which it cannot be computed.
    reach
        The contacts it can be computed for.
    static
        Whether it acts in a static contact too.
    hertzian
        Whether the elastic contact keeps the form of Hertz's law.
    spherical
        Whether the profile is a sphere's, not a paraboloid's.
    bends
        Whether the plate deflects in proportion to the force.
    other_edge
        Whether the plate's edge is another than the paper's.
    solved
        Whether the pressure is solved for, so that the law is not a sum of the effects' parts.
    viscous
        Whether the contact is viscoelastic.
    plastic
        Whether the contact yields.
    dynamic
        Whether the plate has inertia.
    damps
        Whether the plate's modes are damped.
    takes_rows
        Whether its bound takes many scenes at once; if not, it is asked of one after the other.
    within
        Name of an effect that it is a part of: if the scene disables that, it does not apply.
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
    takes_rows: ClassVar[bool] = True
    within: ClassVar[str] = ""

    def not_applicable_reason(self, model: Model) -> str:  # noqa: ARG002
        """Return why the effect does not apply to a scene; empty if it does."""
        return "" if self.selectable else "shown only if the scene asks for it"

    def softness(self, model: Model) -> float:  # noqa: ARG002
        """What it adds to E* of the plate over that of the sphere [1]."""
        return 0.0

    def gravity(self, model: Model) -> float:  # noqa: ARG002
        """What it adds to the acceleration that presses the sphere on [m/s^2]."""
        return 0.0

    def value(self, model: Model, a: float) -> float:
        """Return the dimensionless parameter at a largest contact radius [m]."""
        raise NotImplementedError

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """Return a bound on the change of the results if the effect is omitted."""
        raise NotImplementedError

    def bounded(self, law: "ContactLaw") -> bool:  # noqa: ARG002
        """Whether the bound holds beside the effects of a law."""
        return True

    def proved(self, law: "ContactLaw") -> bool:  # noqa: ARG002
        """Whether the bound is proved beside the effects of a law."""
        return True

    def check(self, law: "ContactLaw", asked: bool) -> None:
        """Refuse a scene that includes it and lacks what it takes to compute it.

        Parameters
        ----------
        law
            The law, this effect included.
        asked
            Whether the scene asks for it.

        Raises
        ------
        SceneError
            If a key is missing or conflicts with another effect.
        """

    def check_omitted(self, part: str, error: float, rtol: float) -> None:
        """Refuse a scene that disables a part of it and must not omit it.

        Parameters
        ----------
        part
            Name of an effect that it requires and that the scene disables.
        error
            What omitting it changes at most [1].
        rtol
            What the omitted effects may change at most [1].

        Raises
        ------
        SceneError
            If the error is too large for an effect that nothing else warns of.
        """


class PlateEffect(Effect):
    """An effect that adds to the deflection of the plate under the contact force.

    Attributes
    ----------
    difference
        Whether its part is computed as the whole plate's less that of others.
    """

    difference: ClassVar[bool] = False

    def contribution(self, model: Model, a: Array) -> Contribution:
        """Return its part of F and S at Hertz's radii [m], of a rigid sphere."""
        raise NotImplementedError


def none_of(a: Array) -> Array:
    """Zeros at radii."""
    return np.zeros_like(a)
