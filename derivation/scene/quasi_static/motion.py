"""Impact by a conservative contact law: largest radius from energy, contact time by quadrature.

With q = a/a_m and E the energy of the sphere, including the work of its weight,

    E = K a_m^5 int_0^1 q^4 p S dq - m g delta_m,   K = 8 E*/(3 R^2)
    t = (8 a_m^2/(R v0)) int_0^1 q S/sqrt(r) du,   q = 1 - u^2,   r = (v/v0)^2/(1 - q)

p S and S are replaced by polynomials through n Gauss nodes. They are analytic, so that both
integrals converge geometrically. n is doubled until the results have converged; for a slow, heavy
sphere then only the number of nodes in time is doubled.
"""

import math
from collections.abc import Set
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.polynomial.legendre import leggauss, legint, legval, legvander

from derivation.scene.contact_law.law import ContactLaw, Shape
from derivation.scene.contact_law.limits import check_numbers, refuse
from derivation.scene.effects.effect import Numbers
from derivation.scene.errors import SceneError
from derivation.scene.numerics.quadrature import MORE_TIMES, NODES, Rule, mapped, rule
from derivation.scene.quantity import digits_of, upwards
from generated.arrays import Double as Array

HISTORY_NODES = (32, *MORE_TIMES)
"""Numbers of nodes of the time history, tried in this order: rounding errors grow with them."""
HISTORY_TOLERANCE = 1e-12
"""Relative difference of the contact time at which the number of nodes is sufficient."""
_SETTLED = 2e-14
"""Relative change with twice the nodes, up to the last of `NODES`, that is due to rounding only."""
_STEPS = 60
_NEWTON = 5
_CLOSE = 1e-9
"""Step below which the next one, of the size of its square, is far below rounding."""
_CLOSEST = 4e-16
"""Step of the size of rounding, for laws that need it: with non-Hertzian pressure (the slope is not
exact), with weight, and on a half-space (the contact time is a unit of time)."""
ROUGH = 1e-2
"""Step at which a start for a law that takes longer to compute is sufficient."""
_ROUNDED = 1e-12
"""Step below which the iteration ends if the step is not smaller than the one before."""
MOST_PERCENT_DIGITS = 3
"""Largest number of significant digits of an energy that are shown."""
MOST_BOUNDED = 50.0
"""Largest bound on the energy of the sphere that is stated without digits of the energies [%]."""
NOTABLE_WORK = 5e-3
"""Least work of the weight over the initial kinetic energy that is stated with the energies."""


@dataclass(frozen=True)
class EnergyBalance:
    """Energy balance of an impact [J].

    Attributes
    ----------
    initial_kinetic, gravity_work
        Kinetic energy of the sphere at impact, and the work of its weight up to separation.
    rebound_kinetic
        Kinetic energy of the sphere after separation.
    viscous_loss, unrecovered_elastic
        Dissipated in the viscoelastic contact, and stored at separation in it and in the plate
        deflection that recovers with it.
    plate
        Energy of the free plate vibration, or radiated into an infinite plate.
    coupling_loss
        Spurious loss of the pointwise coupling; 0 for the variational one.
    plastic_loss
        Dissipated by plastic deformation.
    damping_loss
        Dissipated by the damping of the plate up to the last separation.
    """

    initial_kinetic: float
    gravity_work: float
    rebound_kinetic: float
    viscous_loss: float
    unrecovered_elastic: float
    plate: float = 0.0
    coupling_loss: float = 0.0
    plastic_loss: float = 0.0
    damping_loss: float = 0.0

    def in_words(self, error: float = 0.0) -> str:
        """Return the final energies in percent of the initial kinetic energy.

        Parameters
        ----------
        error
            Relative error of the restitution [1]; that of the energies is twice as large. All are
            rounded to the last significant digit of the largest one, but a smaller energy of the
            sphere is rounded to its own last significant digit. Without a digit, only a bound on
            the energy of the sphere is stated.
        """
        parts = {
            "sphere": self.rebound_kinetic,
            "plate vibration": self.plate,
            "damping of the plate": self.damping_loss,
            "viscoelastic contact": self.viscous_loss + self.unrecovered_elastic,
            "plastic deformation": self.plastic_loss,
            "lost by the pointwise coupling": self.coupling_loss,
        }
        digits = min(digits_of(2.0 * error), MOST_PERCENT_DIGITS)
        largest = 100.0 * max(map(abs, parts.values())) / self.initial_kinetic
        if not (digits and 0.0 < largest < math.inf):
            return self._bounded({name for name, energy in parts.items() if energy}, error)
        last = _last_place(largest, digits)
        places, rebound = dict.fromkeys(parts, last), 100.0 * parts["sphere"] / self.initial_kinetic
        if 0.0 < rebound < 0.5 * 10.0**last:
            places["sphere"] = _last_place(rebound, digits)
        words = ", ".join(
            f"{self._percent(energy, places[name])} {name}"
            for name, energy in parts.items()
            if energy
        )
        if abs(self.gravity_work) < NOTABLE_WORK * self.initial_kinetic:
            return words
        weight = self._percent(self.gravity_work, last)
        return f"{words}; the weight contributes {weight} (in % of the kinetic energy at impact)"

    def _bounded(self, parts: Set[str], error: float) -> str:
        """Return a bound on the energy of the sphere, if that of one other part is the rest."""
        most = 100.0 * self.rebound_kinetic / self.initial_kinetic * (1.0 + error) ** 2
        weighs = abs(self.gravity_work) >= NOTABLE_WORK * self.initial_kinetic
        if len(parts - {"sphere"}) != 1 or weighs or not most < MOST_BOUNDED:
            return "unknown"
        (rest,) = parts - {"sphere"}
        return f"up to {upwards(most, 1):g} % sphere, the rest {rest}"

    def _percent(self, energy: float, last: int) -> str:
        """Return an energy in percent, rounded to a power of ten."""
        percent, unit = 100.0 * energy / self.initial_kinetic, 10.0**last
        if abs(percent) < 0.5 * unit:
            return f"below {unit:g} %"
        return f"{round(percent, -last):.{max(0, -last)}f} %"

    @property
    def residual(self) -> float:
        """Energy-balance error over the initial kinetic energy [1]."""
        final = self.rebound_kinetic + self.viscous_loss + self.unrecovered_elastic
        final += self.plate + self.coupling_loss + self.plastic_loss + self.damping_loss
        return (self.initial_kinetic + self.gravity_work - final) / self.initial_kinetic


def _last_place(value: float, digits: int) -> int:
    """Return the power of ten of the last of some significant digits of a positive number."""
    return math.floor(math.log10(value)) + 1 - digits


@dataclass(frozen=True)
class Motion:
    """The results of an impact, here on a quasi-static plate.

    Attributes
    ----------
    contact_time, max_indentation, max_force, max_contact_radius
        Results [s], [m], [N] and [m].
    quadrature
        Relative change of the results since a run with fewer nodes [1].
    restitution
        Rebound speed over impact speed [1]; 1 for an elastic contact.
    energy_balance
        Energy balance; None for an elastic contact.
    dent
        Depth of the dent after a plastic contact [m]; 0 for an elastic one.
    """

    contact_time: float
    max_indentation: float
    max_force: float
    max_contact_radius: float
    quadrature: float
    restitution: float = 1.0
    energy_balance: EnergyBalance | None = None
    dent: float = field(default=0.0, kw_only=True)

    @property
    def numbers(self) -> tuple[float, float, float, float, float]:
        """The five outputs."""
        return (
            self.contact_time,
            self.max_indentation,
            self.max_force,
            self.max_contact_radius,
            self.restitution,
        )

    def history(self, law: ContactLaw, times: Array) -> tuple[Array, Array, Array, Array]:
        """Return indentation [m], velocity [m/s], contact radius [m] and force [N] at times [s]."""
        return _history(law, self, times)


def largest_radius(
    law: ContactLaw, n: int = NODES[0], start: float = math.inf, close: float = _CLOSE
) -> float:
    """Return the contact radius [m] at the turning point of the sphere.

    Newton's iteration uses the logarithms of energy and radius, whose relation is nearly linear. It
    starts at `start`, or at an estimate from Hertz's law and the thin plate, and ends when a step
    is below `close`. Energies are not computed, because they may overflow.

    Raises
    ------
    SceneError
        If the radius exceeds the range of the law.
    """
    [a] = largest_radii(law, n, None if start == math.inf else np.array([start]), close).tolist()
    if math.isnan(a):
        raise _beyond(law)
    return float(a)


def closeness(law: ContactLaw) -> float:
    """Return the step at which the iteration for the largest radius ends [1]."""
    exact = law.solved or np.any(law.gravity) or not law.plate_effects
    return _CLOSEST if exact else _CLOSE


def largest_radii(
    law: ContactLaw, n: int = NODES[0], start: Array | None = None, close: float = _CLOSE
) -> Array:
    """Return the largest radii [m] of one scene, or of many as a column; NaN outside the range.

    The iteration of each scene ends separately, so that radii do not depend on other scenes.
    """
    model = law.model
    goal = math.log(3.0 / 16.0) + np.log(model.m) - np.log(law.modulus)
    goal = np.atleast_1d(goal + 2.0 * (np.log(model.v0) + np.log(model.R)))
    a = np.minimum(_start(law, goal) if start is None else start, law.limit)
    a = np.where(np.isfinite(goal), a, np.nan)
    radii, left, limit = a.copy(), np.arange(len(a)), law.limit
    before: Array = np.full(a.shape[:-1], np.inf)
    for _ in range(_STEPS):
        a, step = _step(law, goal, a, rule(n))
        radii[left], size = a, np.abs(step[..., 0])
        moving = (size > close) & ~((size < _ROUNDED) & (size >= before))
        if not moving.any():
            break
        before = size
        if a.ndim > 1 and not moving.all():
            law, goal, a, left = law.take(moving), goal[moving], a[moving], left[moving]
            before = size[moving]
    return np.where(radii < limit, radii, np.nan)


def _step(law: ContactLaw, goal: Array, a: Array, known: Rule) -> tuple[Array, Array]:
    """Return the next radius of Newton's iteration and the step; NaN if there is none."""
    model, limit = law.model, law.limit
    shape = law.at(np.append(known.x, 1.0) * a)
    power = shape.force * shape.slope
    weights = known.weights * known.x**4
    mean = np.sum(weights * power[..., :-1], axis=-1, keepdims=True)
    depth = 2.0 * law.gravity * a * (a / model.R) / model.v0 / model.v0
    work = 1.0 + depth * shape.depth[..., -1:]
    steep = power[..., -1:] / mean - depth * 2.0 * shape.slope[..., -1:] / work
    step = (goal + np.log(work) - np.log(mean) - 5.0 * np.log(a)) / steep
    after = np.minimum(a * np.exp(np.clip(step, -1.0, 1.0)), limit)
    sound = (mean > 0.0) & (work < np.inf) & (steep > 0.0) & ~((a >= limit) & (step > 0.0))
    return np.where(sound, after, np.nan), np.where(sound, step, np.nan)


def _beyond(law: ContactLaw) -> SceneError:
    """Return the error for an impact without a largest contact radius (see `limits.refuse`)."""
    return SceneError(
        f"impact.speed: expected a largest contact radius below {law.limit_in_words}, got none at "
        f"{law.model.v0:.6g} m/s; reduce the speed"
    )


def _start(law: ContactLaw, goal: Array) -> Array:
    """Return an estimate of the largest radius [m] from the logarithm of E over K.

    It is the smaller one of the radii by Hertz's law and by that of a thin plate; with non-Hertzian
    pressure, which takes long to compute, that with Hertz's pressure.
    """
    model = law.model
    if law.solved:
        hertzian = law.only(lambda effect: not effect.solved)
        radii = largest_radii(hertzian, close=ROUGH)
        return np.where(np.isnan(radii), _start(hertzian, goal), radii)
    log_radius = 0.2 * (goal + math.log(5.0))  # Hertz: the energy is K a^5/5
    if law.bends:
        # Bending: d delta/da is (3/2) a/(4 pi eta^2 h) times Hertz's; the energy is proportional to
        # a^6/6.
        steep = math.log(16.0 * math.pi) + np.log(model.h) + 2.0 * np.log(model.eta)
        log_radius = np.minimum(log_radius, (goal + steep) / 6.0)
    return np.exp(np.clip(log_radius, -700.0, 700.0))


def impact(law: ContactLaw) -> Motion:
    """Return the impact by a law.

    Raises
    ------
    SceneError
        If the contact radius reaches the limit of the law, or a result is not a positive number.
    """
    before: Motion | None = None
    a, close = math.inf, closeness(law)
    for n, times in [(n, n) for n in NODES] + [(NODES[1], n) for n in MORE_TIMES]:
        try:
            a = largest_radius(law, n, a, close)
        except SceneError:
            refuse(law)
        motion = _results(law, a, n, times)
        check_numbers(law.model, *motion.numbers)
        if before is not None:
            pairs = zip(motion.numbers, before.numbers, strict=True)
            change = max(abs(new / old - 1.0) for new, old in pairs)
            before = replace(motion, quadrature=change)
            if change <= settled(times):
                return before
        before = before or motion
    assert before is not None
    return before


def settled(times: int) -> float:
    """Return the relative change of the results that is due to rounding with nodes in time."""
    return _SETTLED * max(1.0, times / NODES[-1])


def _results(law: ContactLaw, a: float, n: int, times: int) -> Motion:
    """Return the impact with a largest radius [m], by n nodes and `times` nodes in time."""
    time, depth, force = (number.item() for number in results_at(law, np.array([a]), n, times))
    return Motion(time, depth, force, a, 0.0)


def results_at(law: ContactLaw, a: Array, n: int, times: int) -> tuple[Array, Array, Array]:
    """Return contact time, largest indentation and force for a largest radius [m], or a column."""
    known = rule(n, times)
    shape = law.at(np.append(known.x, 1.0) * a)
    last = Shape(*(x[..., -1:] for x in shape))
    rate, _ = _rates(law, a, shape, known)
    mean = np.sum(known.u_weights * rate, axis=-1, keepdims=True)
    time = 8.0 * a * (a / law.model.R) / law.model.v0 * mean
    return time, law.indentation(a, last), law.force(a, last)


def _rates(law: ContactLaw, a: Numbers, shape: Shape, known: Rule) -> tuple[Array, Array]:
    """Return q S/sqrt(r) and sqrt(r) at the nodes in time."""
    model = law.model
    slope, sunk = shape.slope[..., :-1], shape.depth[..., -1:]
    power = shape.force[..., :-1] * slope
    whole = np.sum(known.weights * known.x**4 * power, axis=-1, keepdims=True)
    weight = 2.0 * law.gravity * a * (a / model.R) / model.v0 / model.v0
    ratio = mapped(known.work, power) / whole
    if np.any(weight):
        ratio = (1.0 + weight * sunk) * ratio - 2.0 * weight * mapped(known.path, slope)
    q, root = 1.0 - known.u * known.u, np.sqrt(ratio)
    return q * mapped(known.at_times, slope) / root, root


def _history(law: ContactLaw, motion: Motion, times: Array) -> tuple[Array, Array, Array, Array]:
    """Return the time history of an impact at times [s].

    The time since the turning point is a polynomial in u, which Newton's iteration inverts.
    """
    model, a = law.model, motion.max_contact_radius
    shape = law.at(np.append(rule(HISTORY_NODES[0]).x, 1.0) * a)
    unit = 8.0 * a * (a / model.R) / model.v0
    for n in HISTORY_NODES:
        known = rule(HISTORY_NODES[0], n)
        rates = _rates(law, a, shape, known)
        time = unit * float(known.u_weights @ rates[0])
        if abs(time / motion.contact_time - 1.0) <= HISTORY_TOLERANCE:
            break
    nodes, weights = leggauss(n)
    rate, root = (
        (legvander(nodes, n - 1) * weights[:, None] * (np.arange(n) + 0.5)).T @ values
        for values in rates
    )
    elapsed = legint(rate, lbnd=-1.0) / 2.0
    whole = float(legval(1.0, elapsed))
    since = np.abs(2.0 * times / motion.contact_time - 1.0) * whole
    grid = np.linspace(-1.0, 1.0, 401)
    u = np.interp(since, legval(grid, elapsed), grid)
    for _ in range(_NEWTON):
        # At both ends the rate may be exactly zero, and u is exact.
        off, slope = legval(u, elapsed) - since, legval(u, rate)
        step = np.divide(off, slope, np.zeros_like(u), where=slope != 0.0)
        u = np.clip(u - 2.0 * step, -1.0, 1.0)
    half = (1.0 + u) / 2.0
    radii = a * (1.0 - half) * (1.0 + half)
    states = law.at(radii)
    velocity = np.sign(motion.contact_time / 2.0 - times) * model.v0 * half * legval(u, root)
    return law.indentation(radii, states), velocity, radii, law.force(radii, states)
