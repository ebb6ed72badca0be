"""Inertia: plate vibration, which takes energy from the sphere and may return part of it."""

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from derivation.scene import scales
from derivation.scene.effects.effect import (
    NO_BOUND,
    Bound,
    BoundContext,
    Changes,
    Effect,
    Numbers,
    none_of,
    weight_work_ratio,
)
from derivation.scene.effects.finite_thickness import WHOLE_PLATE
from derivation.scene.effects.plasticity import plastic_restitution
from derivation.scene.effects.viscosity import inverse_restitution, viscous_number
from derivation.scene.errors import SceneError
from derivation.scene.model import Model
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from derivation.scene.contact_law.law import ContactLaw

# The coefficients below are fitted, with no value from the literature unless one is named. Tested:
# `check inertia` compares the bounds that follow from them with simulations of random scenes;
# reports/data/inertia.json contains 600 of them.
MAX_DYNAMIC_FACTOR = 2.0
"""Largest deviation of a mode from its quasi-static response, over its static deflection: that of
an undamped oscillator under a step force."""
SMOOTH_FORCE = 16.0
"""Bound on this deviation, times omega^2 T T_rise, for a force with a smooth onset."""
STEP_FORCE = 5.0
"""Bound on this deviation, times omega T, for a force that rises suddenly."""
HERTZ_ONSET = 2.0
"""Bound on this deviation, times (omega T_rise)^(3/2) T/T_rise, for a force that begins as
t^(3/2), as by Hertz's law."""
VISCOUS_ONSET = 0.5
"""Bound on this deviation, over x_v/sqrt(omega T), for a viscoelastic force, which begins as
t^(1/2)."""
MOST_VISCOUS = 2.0
"""Largest x_v with a bound. Beyond it the sphere nearly stops in the contact, and the vibration of
the plate may change the little that remains of its speed by any factor."""
LOSS_BY_ZENER, LEAST = 2.0, 0.03
"""Coefficient of the Zener parameter lambda in the logarithm of a small restitution, 1.72 on an
infinite plate with a small lambda (Zener 1941), and the least restitution that bounds assume."""
FLIGHT_GROWTH, LATER_PEAK = (1.0, 1.0 / 6.0), 0.5
"""Growth of the bounds on the largest values and on the restitution by the time between contacts,
over the contact time on a plate without deflection; and the force of a later contact over the
largest force from which the bounds on the largest values grow. Without growth, changes were up to
2.1 times the bounds."""
SPLIT = 0.4
"""Deviation of the modes over the local indentation from which the first contact may split, so that
its duration jumps. It split in 15 of 626 random scenes with Zener parameters up to 1600, at ratios
of at least 0.57, and in none of 222 of these with a ratio of 0.03 to 0.5. The limit is lower,
because the local indentation is smaller when the vibration begins."""
NOTHING = 1e-30
"""Smallest fraction of the kinetic energy that counts as remaining."""
COUNTED, NODES_BEYOND = 32, 64
"""Number of modes that are summed, and of nodes of the integral over higher modes."""
CONTACT_DECAY, CONTACT_END = 3.0, 30.0
"""A wide contact excites a mode by 3/(a phi)^2 of a point force; the sum ends at a phi = 30."""
RADIATION = (2.0, 1.0, 2.5, 0.9, 3.0)
"""Change of each result by the higher wave branches, over a/(c_T T): radiation of a half-space."""
THICKNESS_RINGING = (6.0, 0.5, 40.0, 13.0, 2.0)
"""Change of each result by the higher wave branches, over (a/H)^2 (H/(c_T T))^(3/2): thickness
resonance under a wide contact."""
HERTZ_TIME = 3.3
"""Contact time over (m^2/(K^2 v0))^(1/5): 3.22 by Hertz's law, slightly more with bending."""
RISE_BY_ZENER = 3.0
"""Coefficient of the Zener parameter in the rise time of the force."""
WIDER = 1.25
"""Largest radius of contact tables over that on a plate that does not deflect, because a later
contact may be faster than the first."""
SLOWEST = 2.9
"""Contact time times speed over indentation: 2.94 by Hertz's law, 3.14 of a linear spring."""
SENSITIVITY = (12.0, 6.0, 40.0, 14.0, 30.0)
"""Change of the logarithm of each result by the relative deviation of the modes from their
quasi-static response: 1.5 times the largest ratio in 500 random scenes."""


class PlateInertia(Effect):
    """Dynamic bending modes; higher modes respond quasi-statically."""

    name = "inertia"
    adds = "inertia of the plate (vibration)"
    equation = "q_j'' + omega_j^2 q_j = omega_j^2 c_j P_j"
    parameter = "Zener parameter lambda = m/(8 That sqrt(D rho H))"
    source = "Zener 1941; Rayleigh 1888 and Lamb 1917; steps 26 to 29"
    contains = WHOLE_PLATE | {"edge"}
    requires = frozenset({"bending"})
    static = False
    dynamic = True

    def value(self, model: Model, a: float) -> float:  # noqa: ARG002
        """Return the Zener parameter; NaN without a density."""
        if not np.all(model.density):
            return math.nan
        return scales.zener_number(model)

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """Return the tested bound: deviation of the modes from their quasi-static response."""
        heavier = 1.0 + weight_work_ratio(model, context.depth)
        T = SLOWEST * context.depth / (model.v0 * np.sqrt(heavier))
        a, force = context.radii[..., -1:], context.samples.force[..., -1:]
        viscous = viscous_number(model)

        def deviation(phase: Array, rise: Numbers) -> Array:
            return dynamic_deviation(phase, rise, viscous)

        off = force / context.depth * total_deviation(model, a, T, deviation)
        if model.inertia.infinite_plate and not np.all(model.density):
            off = np.full_like(off, np.inf)  # the lighter the plate, the further it deflects
        more = higher_branch_error(model, a, T) if np.all(model.density) else 5 * (0.0,)
        none = none_of(context.radii)
        logs: list[Numbers] = [
            factor * off + part for factor, part in zip(SENSITIVITY, more, strict=True)
        ]
        local = a * (a / model.R) / context.depth
        logs[0] = np.where(off < SPLIT * local, logs[0], np.inf)
        logs[0], logs[4] = heavier * logs[0], heavier * logs[4]
        logs = after_yield(logs, plastic_restitution(model, context))
        return Bound(none, none, results=dissipated(logs, viscous))

    def proved(self, law: "ContactLaw") -> bool:  # noqa: ARG002
        """Return False: tested on random scenes."""
        return False

    def check(self, law: "ContactLaw", enabled: bool) -> None:
        """Require the density, and only the lowest branch in a viscoelastic contact."""
        model = law.model
        if law.viscous and model.inertia.branches == "all":
            raise SceneError(
                'inertia.branches: expected "A0" for a viscoelastic contact, in which only bending '
                'is elastic, got "all"; set branches = "A0", or effects.viscosity = false'
            )
        if model.density:
            return
        why = "effects.inertia is true" if enabled else "plate inertia may change the results"
        raise SceneError(
            f"plate.density: expected a density because {why}, got none; give plate.density "
            "[kg/m^3], or set effects.inertia = false for a quasi-static plate"
        )

    def check_omitted(self, part: str, error: float, rtol: float) -> None:
        """Reject a scene without bending if plate inertia may matter."""
        if error <= rtol:
            return
        size = f" by up to {error:.1e}" if error < NO_BOUND else ""
        raise SceneError(
            f"effects.{part}: expected true because plate inertia may change the results{size} and "
            f"requires {part}, got false; remove effects.{part}, or set effects.inertia = false "
            "for a quasi-static plate"
        )


def least_restitution(model: Model) -> Numbers:
    """Return a small value of the restitution of an elastic contact on a plate with inertia [1].

    Beyond lambda = 1.7 waves that return from the edge determine the restitution.
    """
    number = PlateInertia().value(model, 0.0)
    restitution: Numbers = np.maximum(LEAST, np.exp(-LOSS_BY_ZENER * number))
    return restitution


def higher_branch_error(model: Model, a: Numbers, T: Numbers, loss_factor: float = 0.0) -> Changes:
    """Return the change of each result by the branches beyond the first [1]: fitted, tested.

    Parameters
    ----------
    a, T
        Contact radius [m] and time [s]. Bending lengthens the contact, but the force starts as
        suddenly as without bending: P'' is of the order of P/(T T_alone). On a compliant plate the
        force rises and falls in a fraction lambda^(-2/3) of that time. This excites thickness
        vibration, which decreases with the duration of the contact if the contact continues.
    loss_factor
        Loss factor of the plate modes [1]; it dissipates part of the returning waves, at most all.
        The change grows with it: with a loss factor of 1.5 one random scene exceeded the bound
        without this growth by a third.
    """
    transit, number = 2.0 * model.h / model.shear_speed, PlateInertia().value(model, 0.0)
    wide, echo = a / (2.0 * model.h), transit / np.sqrt(T * np.minimum(T, _alone(model)))
    # Less energy is lost if waves return many times during the contact.
    radiated = wide * echo * np.minimum(1.0, 2.0 * echo + loss_factor)
    whole = np.power(transit / T, 1.5) * np.sqrt(np.maximum(1.0, number))
    sudden = transit / np.minimum(T, _rise(model))
    ring = wide * wide * np.maximum(whole, sudden * sudden * sudden)
    time, depth, force, radius, speed = (
        (1.0 + loss_factor) * (one * radiated + two * ring)
        for one, two in zip(RADIATION, THICKNESS_RINGING, strict=True)
    )
    return time, depth, force, radius, speed


def _alone(model: Model) -> Numbers:
    """Return the contact time [s] without bending."""
    return HERTZ_TIME * scales.time_unit(model)


def _rise(model: Model) -> Numbers:
    """Return the time [s] in which the force rises and falls; it is shorter on a compliant plate.

    The plate deflects as fast as the sphere approaches when lambda P = v0, with P^(2/3) = v0 t,
    after lambda^(-2/3) of That, independent of the time of separation.
    """
    number = PlateInertia().value(model, 0.0)
    rise: Numbers = _alone(model) / np.cbrt(np.maximum(1.0, RISE_BY_ZENER * number)) ** 2
    return rise


def total_deviation(
    model: Model, a: Numbers, T: Numbers, deviation: Callable[[Array, Numbers], Array]
) -> Array:
    """Return a deviation from the quasi-static response to a unit force [m/N], of all modes.

    Wave numbers are approximated by (n - 1/4) pi/b, and frequencies by those of a thin plate,
    limited by those of Rayleigh waves. Neither zeros of J_0 nor roots of the branch are computed.

    Parameters
    ----------
    a, T
        Contact radius [m] and time [s].
    deviation
        Deviation of a mode over its static deflection, as a function of omega T and the fraction of
        T in which the force rises.
    """
    dynamic = np.all(model.density)
    rise = np.minimum(T, _rise(model)) / T if dynamic else 1.0
    first = np.arange(1.0, COUNTED + 1.0)
    last = COUNTED + 0.5
    span = np.log(np.maximum(CONTACT_END * model.b / (math.pi * a), 2.0 * last) / last)
    n = last * np.exp(span * np.linspace(0.0, 1.0, NODES_BEYOND))
    weights = np.full(NODES_BEYOND, 1.0 / (NODES_BEYOND - 1.0))
    weights[[0, -1]] /= 2.0

    def of_mode(n: Array) -> Array:
        """Return the deviation of modes by their number."""
        j = (n - 0.25) * math.pi
        x, y = j * model.eta, j * (a / model.b)
        # Kirchhoff plate, limited by the speed of Rayleigh waves.
        thin = x * x * np.sqrt(2.0 / (3.0 * (1.0 - model.poissons_ratio)))
        root = thin / np.sqrt(1.0 + (thin / x) ** 2)  # omega h/c_T
        static = model.h / model.mu * (0.5 / root**2) * j / (2.0 * model.b * model.b)
        weight = np.minimum(1.0, CONTACT_DECAY / (y * y))
        if not dynamic:
            return np.asarray(static * weight * MAX_DYNAMIC_FACTOR)
        phase = root * (model.shear_speed * T / model.h)
        return np.asarray(static * weight * deviation(phase, rise))

    counted = np.sum(of_mode(first), axis=-1, keepdims=True)
    return np.asarray(counted + span * np.sum(weights * n * of_mode(n), axis=-1, keepdims=True))


def after_yield(logs: Sequence[Numbers], restitution: Numbers) -> list[Numbers]:
    """Return the changes of a plastic contact by its restitution e.

    Unloading takes e times as long as loading, and a change of the speed of the sphere is relative
    to the speed that remains, e times the impact speed.
    """
    time, depth, force, radius, speed = logs
    steeper = 1.0 / np.maximum(restitution * restitution, NOTHING)
    return [time * steeper, depth, force, radius, speed * steeper]


def dissipated(logs: Sequence[Numbers], viscous: Numbers) -> Changes:
    """Return the changes of a viscoelastic contact by its x_v; infinite beyond `MOST_VISCOUS`.

    A change of the speed of the sphere is relative to the speed that remains, 1/e times as much.
    """
    known = np.asarray(viscous) <= MOST_VISCOUS
    factor = np.where(known, inverse_restitution(viscous), np.inf)
    time, depth, force, radius, speed = (_number(log * factor) for log in logs)
    return time, depth, force, radius, speed


def _number(x: Array) -> Numbers:
    """Return an array of one number without dimensions as a float."""
    return float(x) if x.ndim == 0 else x


def dynamic_deviation(phase: Array, rise: Numbers, viscous: Numbers = 0.0) -> Array:
    """Return a mode's deviation from its quasi-static response over its static deflection.

    The deviation depends on P'', which is of the order of P/T^2 by Hertz's law, and of P/(T T_rise)
    on a plate that bends, where the force starts suddenly. The onset as t^(3/2) excites fast modes,
    more so that as t^(1/2) of a viscoelastic contact, with its parameter x_v.
    """
    slow = np.minimum(SMOOTH_FORCE / (phase * phase * rise), STEP_FORCE / phase)
    onset = phase * rise
    slow = np.maximum(slow, HERTZ_ONSET * rise / (onset * np.sqrt(onset)))
    slow = np.maximum(slow, VISCOUS_ONSET * viscous / np.sqrt(phase))
    return np.asarray(np.minimum(MAX_DYNAMIC_FACTOR, slow))
