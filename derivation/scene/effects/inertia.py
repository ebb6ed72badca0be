"""Inertia: the plate moves, takes energy along in waves, and may give some of it back."""

import math
from typing import TYPE_CHECKING

import numpy as np

from derivation.scene import kernels
from derivation.scene.effects.effect import NO_BOUND, Array, Bound, Effect, Place, Results, none_of
from derivation.scene.effects.finite_thickness import WHOLE_PLATE
from derivation.scene.model import Model
from derivation.scene.scene import SceneError

if TYPE_CHECKING:
    from derivation.scene.law import ContactLaw

SWINGS = 2.0
"""A mode is off its rest by no more than twice its deflection,"""
SMOOTH, SUDDEN, BEGUN = 16.0, 5.0, 2.0
"""by 16/(omega^2 T T_rise) of it or 5/(omega T), and where it is fast by 2/(omega T_rise)^(3/2)."""
COUNTED, ALONG = 32, 64
"""Modes taken one by one, and nodes of the integral over those beyond."""
PASSED = 3.0, 30.0
"""Up to which a phi modes feel the contact: beyond that they die like 3/(a phi)^2."""
RADIATED, RINGS = (2.0, 1.0, 2.5, 0.9, 3.0), (6.0, 0.5, 40.0, 13.0, 2.0)
"""What branches beyond the first are worth for each result: what a half-space would radiate, over
a/(c_T T), and the thickness that rings under a wide contact, over (a/H)^2 (H/(c_T T))^(3/2)."""
ALONE, EARLIER = 3.3, 3.0
"""Contact time over That, 2.94 by Hertz's law and little more where a plate hardly bends; and of
Zener's number as it shortens a force: measured."""
WIDER = 1.25
"""Contact radius that is reckoned with, over the largest on a plate that does not yield: a later
contact may be faster than the first."""
SLOWEST = 2.9
"""Contact time times speed over indentation: of Hertz's law 2.94, of a spring 3.14."""
WORTH = (12.0, 6.0, 40.0, 14.0, 30.0)
"""What a mode's share off its rest means for each result, as a logarithm: measured, and half as
much again as the worst of 500 scenes."""


class PlateInertia(Effect):
    """Bending modes that oscillate; those beyond follow at rest, as without inertia all do."""

    name = "inertia"
    adds = "the plate's own motion"
    equation = "q_j'' + omega_j^2 q_j = omega_j^2 c_j P_j"
    number = "Zener's lambda = m/(8 That sqrt(D rho H))"
    source = "Zener 1941; Rayleigh 1888 and Lamb 1917; links 26 to 29"
    contains = WHOLE_PLATE | {"edge"}
    requires = frozenset({"bending"})
    static = False
    dynamic = True

    def value(self, model: Model, a: float) -> float:  # noqa: ARG002
        """Zener's number; none without a density."""
        if not model.density:
            return math.nan
        R, m, v0, h, _, lam, mu = model.numbers
        number = float(kernels.zener_number(R, m, v0, h, lam, mu, model.density))
        return number / math.pow(1.0 + model.softness, 0.4)

    def bound(self, model: Model, place: Place) -> Bound:
        """What its modes are off their rest by, over the indentation; measured, not proved."""
        assert place.along is not None
        heavier = 1.0 + weight_share(model, place.depth)
        T = SLOWEST * place.depth / (model.v0 * math.sqrt(heavier))
        a, force = float(place.radii[-1]), float(place.along.force[-1])
        off = force / place.depth * _off_rest(model, a, T)
        more = further_branches(model, a, T) if model.density else 5 * (0.0,)
        none = none_of(place.radii)
        logs = [factor * off + part for factor, part in zip(WORTH, more, strict=True)]
        logs[0], logs[4] = heavier * logs[0], heavier * logs[4]
        return Bound(none, none, results=(logs[0], logs[1], logs[2], logs[3], logs[4]))

    def proved(self, law: "ContactLaw") -> bool:  # noqa: ARG002
        """Measured on random scenes."""
        return False

    def check(self, law: "ContactLaw", asked: bool) -> None:
        """The density has to be known, and higher branches cannot be viscoelastic."""
        model = law.model
        if law.viscous and model.inertia.branches == "all":
            raise SceneError(
                'inertia.branches: expected "A0" in a viscoelastic contact, where only bending is '
                'elastic, got "all"; write branches = "A0", or effects.viscosity = false'
            )
        if model.density:
            return
        why = "effects.inertia = true" if asked else "its inertia may change the results"
        raise SceneError(
            f"plate.density: expected a density, since {why}, got none; give plate.density "
            "[kg/m^3], or effects.inertia = false for a plate without inertia"
        )

    def check_omitted(self, part: str, error: float, rtol: float) -> None:
        """A quasi-static plate without bending is refused where bending waves may matter."""
        if error <= rtol:
            return
        size = f"by up to {error:.1e}" if error < NO_BOUND else "by more than a bound says"
        raise SceneError(
            f"effects.{part}: expected true, since the plate's inertia may change the results "
            f"{size} and needs {part}, got false; leave out effects.{part}, or set "
            "effects.inertia = false for a quasi-static plate"
        )


def weight_share(model: Model, depth: float) -> float:
    """Work of the weight over the energy brought [1], at a largest indentation [m].

    A sphere that sinks in by its weight is faster on its way than where it meets the plate, and
    what the plate takes is a part of the energy of both, but misses in that brought alone.
    """
    return 2.0 * model.gravity * depth / model.v0 / model.v0


def further_branches(model: Model, a: float, T: float) -> Results:
    """What branches beyond the first may change in each result [1]: measured.

    Parameters
    ----------
    a, T
        Contact radius [m] and time [s]. A plate that bends keeps a sphere long, and feels it as
        suddenly as another: P'' is of the order of P/(T T_alone). One that gives way makes the
        force come and go in a part of that time, by lambda^(-2/3); if the contact goes on, the
        thickness rings by that, all the less the slower it is.
    """
    transit, number = 2.0 * model.h / model.shear_speed, PlateInertia().value(model, 0.0)
    wide, echo = a / (2.0 * model.h), transit / math.sqrt(T * min(T, _alone(model)))
    # Less is lost where echoes return many times in a contact.
    radiated = wide * echo * min(1.0, 2.0 * echo)
    whole = math.pow(transit / T, 1.5) * math.sqrt(max(1.0, number))
    ring = wide * wide * max(whole, math.pow(transit / min(T, _rise(model)), 3.0))
    time, depth, force, radius, speed = (
        one * radiated + two * ring for one, two in zip(RADIATED, RINGS, strict=True)
    )
    return time, depth, force, radius, speed


def _alone(model: Model) -> float:
    """Contact time [s] were it not for the bending."""
    stiffness = 4.0 / 3.0 * model.modulus / (1.0 + model.softness) * math.sqrt(model.R)
    return ALONE * math.pow(model.m / stiffness, 0.4) / math.pow(model.v0, 0.2)


def _rise(model: Model) -> float:
    """Time in which the force comes and goes [s]: Hertz's, shorter where the plate gives way.

    It yields as fast as the sphere comes on where lambda P = v0, P^(2/3) by then being v0 t: after
    lambda^(-2/3) of That, whenever the sphere may leave.
    """
    number = PlateInertia().value(model, 0.0)
    return _alone(model) / math.pow(max(1.0, EARLIER * number), 2.0 / 3.0)


def _off_rest(model: Model, a: float, T: float) -> float:
    """How far a unit force's deflection may be off its rest [m/N], all modes together.

    Wave numbers are (n - 1/4) pi/b and frequencies those of a thin plate, held below Rayleigh's
    waves: neither a zero of J_0 nor a root of the branch is computed. A mode follows a force as
    fast as it turns: P'' is of the order of P/T^2 by Hertz's law, and P/(T T_rise) of a plate that
    bends, whose force begins as if suddenly. That it begins as t^(3/2) makes a fast mode ring.
    """
    rise = min(T, _rise(model)) / T if model.density else 1.0
    first = np.arange(1.0, COUNTED + 1.0)
    last = COUNTED + 0.5
    beyond = max(PASSED[1] * model.b / (math.pi * a), 2.0 * last)
    steps = np.linspace(math.log(last), math.log(beyond), ALONG)
    n = np.exp(steps)
    weights = np.full(ALONG, steps[1] - steps[0])
    weights[[0, -1]] /= 2.0
    one, rest = (_mode(model, a, T, rise, k) for k in (first, n))
    return float(np.sum(one) + np.sum(weights * n * rest))


def _mode(model: Model, a: float, T: float, rise: float, n: Array) -> Array:
    """The same of modes by their number; the force rises in a part of T."""
    j = (n - 0.25) * math.pi
    x, y = j * model.eta, j * (a / model.b)
    # Kirchhoff's plate, and no faster than a wave on a face.
    thin = x * x * math.sqrt(2.0 / (3.0 * (1.0 - model.poissons_ratio)))
    root = thin / np.sqrt(1.0 + (thin / x) ** 2)  # omega h/c_T
    at_rest = model.h / model.mu * (0.5 / root**2) * j / (2.0 * model.b * model.b)
    felt = np.minimum(1.0, PASSED[0] / (y * y))
    if not model.density:
        return at_rest * felt * SWINGS
    phase = root * (model.shear_speed * T / model.h)
    late = np.minimum(SMOOTH / (phase * phase * rise), SUDDEN / phase)
    late = np.maximum(late, BEGUN * rise / (phase * rise) ** 1.5)
    return np.asarray(at_rest * felt * np.minimum(SWINGS, late))
