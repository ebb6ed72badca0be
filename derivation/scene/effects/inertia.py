"""Inertia: the plate moves, takes energy along in waves, and may give some of it back."""

import math

import numpy as np

from derivation.scene import kernels
from derivation.scene.effects.effect import Array, Bound, Effect, Place, Results, none_of
from derivation.scene.model import Model

SWINGS = 2.0, 16.0
"""A mode is off its rest by no more than twice its deflection, and by 16/(omega T)^2 of it."""
COUNTED, ALONG = 32, 64
"""Modes taken one by one, and nodes of the integral over those beyond."""
PASSED = 3.0, 30.0
"""Up to which a phi modes feel the contact: beyond that they die like 3/(a phi)^2."""
RADIATED, RINGS = (1.3, 1.0, 2.5, 0.9, 3.0), (6.0, 0.5, 40.0, 13.0, 2.0)
"""What branches beyond the first are worth for each result: what a half-space would radiate, over
a/(c_T T), and the thickness that rings under a wide contact, over (a/H)^2 (H/(c_T T))^(3/2)."""
SLOWEST = 2.9
"""Contact time times speed over indentation: of Hertz' law 2.94, of a spring 3.14."""
WORTH = (4.0, 3.0, 10.0, 4.0, 4.0)
"""What a mode's share off its rest means for each result, as a logarithm: measured."""


class Inertia(Effect):
    """Bending modes that oscillate; those beyond follow at rest, as without inertia all do."""

    name = "inertia"
    adds = "the plate's own motion"
    equation = "q_j'' + omega_j^2 q_j = omega_j^2 c_j P_j"
    number = "Zener's lambda = m/(8 That sqrt(D rho H))"
    source = "Zener 1941; Rayleigh 1888 and Lamb 1917; links 26 to 29"

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
        T = SLOWEST * place.depth / model.v0
        a, force = float(place.radii[-1]), float(place.along.force[-1])
        off = force / place.depth * _off_rest(model, a, T)
        more = further_branches(model, a, T) if model.density else 5 * (0.0,)
        none = none_of(place.radii)
        logs = [factor * off + part for factor, part in zip(WORTH, more, strict=True)]
        return Bound(none, none, results=(logs[0], logs[1], logs[2], logs[3], logs[4]))


def further_branches(model: Model, a: float, T: float) -> Results:
    """What branches beyond the first may change in each result [1]: measured.

    Parameters
    ----------
    a, T
        Contact radius [m] and time [s].
    """
    wide, echo = a / (2.0 * model.h), 2.0 * model.h / (model.shear_speed * T)
    # Less is lost where echoes return many times in a contact.
    radiated, ring = wide * echo * min(1.0, 2.0 * echo), wide * wide * math.pow(echo, 1.5)
    time, depth, force, radius, speed = (
        one * radiated + two * ring for one, two in zip(RADIATED, RINGS, strict=True)
    )
    return time, depth, force, radius, speed


def _off_rest(model: Model, a: float, T: float) -> float:
    """How far a unit force's deflection may be off its rest [m/N], all modes together.

    Wave numbers are (n - 1/4) pi/b and frequencies those of a thin plate, held below Rayleigh's
    waves: neither a zero of J_0 nor a root of the branch is computed.
    """
    first = np.arange(1.0, COUNTED + 1.0)
    last = COUNTED + 0.5
    beyond = max(PASSED[1] * model.b / (math.pi * a), 2.0 * last)
    steps = np.linspace(math.log(last), math.log(beyond), ALONG)
    n = np.exp(steps)
    weights = np.full(ALONG, steps[1] - steps[0])
    weights[[0, -1]] /= 2.0
    one, rest = (_mode(model, a, T, k) for k in (first, n))
    return float(np.sum(one) + np.sum(weights * n * rest))


def _mode(model: Model, a: float, T: float, n: Array) -> Array:
    """The same of modes by their number."""
    j = (n - 0.25) * math.pi
    x, y = j * model.eta, j * (a / model.b)
    # Kirchhoff's plate, and no faster than a wave on a face.
    thin = x * x * math.sqrt(2.0 / (3.0 * (1.0 - model.poissons_ratio)))
    root = thin / np.sqrt(1.0 + (thin / x) ** 2)  # omega h/c_T
    at_rest = model.h / model.mu * (0.5 / root**2) * j / (2.0 * model.b * model.b)
    felt = np.minimum(1.0, PASSED[0] / (y * y))
    if not model.density:
        return at_rest * felt * SWINGS[0]
    phase = root * (model.shear_speed * T / model.h)
    return np.asarray(at_rest * felt * np.minimum(SWINGS[0], SWINGS[1] / phase**2))
