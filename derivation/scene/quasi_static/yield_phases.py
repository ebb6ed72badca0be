"""Impacts with plastic deformation on a quasi-static plate by quadrature, of one scene or of many.

With a the contact radius of the elastic law, the contact is elastic up to the onset of yield at
a_y, yields up to the largest radius a_m, and is elastic again on unloading. In each of these phases
the force and the slope of the indentation, over those of Hertz's law p and S, are smooth functions
of a. With s = a/a_y, f = s^4 p S and E the energy of the sphere,

    K a_y^5 (int_0^1 f ds + int_1^(s_m) f ds) = E,   K = 8 E*/(3 R^2)

As in `motion`, q = 1 - u^2 from the turning point removes the singularity of dt = d delta/v. For
the first phase this is the turning point of an elastic contact that has the same energy left at
a_y. It is near a_y if the contact just yields; the times of both phases then depend on rounding,
but in opposite ways.
"""

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import legval, legvander

from derivation.scene.contact_law.law import ContactLaw, Shape
from derivation.scene.contact_law.yielding import onset_radius
from derivation.scene.numerics.quadrature import NODES, analysis_of, gauss, mapped
from generated.arrays import Double as Array
from generated.plasticity_kernels import hertz_energy, loaded, unloaded, worked

CLOSE = 1e-9
"""Step of Newton's iteration after which the next one, of the size of its square, is negligible."""
STEPS = 60
RESULTS = 5
"""Number of the results among the fields of `YieldedImpacts`."""
ROUNDING = 1e-13
"""Tested bound on the rounding errors of the results [1]: at most 2.2e-14 on a half-space."""
SETTLED, ENOUGH = 1e-13, 1e-11
"""Relative change of the results with twice the nodes from which no more are used, and the largest
error of usable results [1]."""


class YieldedImpacts(NamedTuple):
    """Impacts of one or more scenes in which the contact yields, as columns.

    NaN where the contact does not yield, or the method fails.

    Attributes
    ----------
    contact_time, max_indentation, max_force, max_contact_radius, restitution
        The results, in s, m, N, m and 1.
    ratio
        Hertz's radius of the largest force over that at the onset of yield [1].
    """

    contact_time: Array
    max_indentation: Array
    max_force: Array
    max_contact_radius: Array
    restitution: Array
    ratio: Array


class Onset(NamedTuple):
    """The onset of yield: Hertz's radius of its force, and the radius of the law [m]."""

    hertz: Array
    a: Array


Phase = Callable[[Array], tuple[Array, Array]]
"""Force and slope over those of Hertz's law, at radii [m] of the elastic law."""


class Rule(NamedTuple):
    """Gauss' nodes and weights on [0, 1], and matrices that act on values at the nodes.

    `coefficients` gives the Legendre coefficients of a polynomial, `beyond` those of its mean over
    [q, 1]; `at_times` and `mean_at_times` give the values of both at q = 1 - x^2.
    """

    x: Array
    weights: Array
    coefficients: Array
    beyond: Array
    at_times: Array
    mean_at_times: Array


@cache
def rule(n: int) -> Rule:
    """Return the rule with n nodes."""
    (x, w), analysis = gauss(n), analysis_of(n)

    def values(q: Array) -> Array:
        return np.asarray(legvander(2.0 * q - 1.0, n - 1) @ analysis, dtype=np.float64)

    def means(q: Array) -> Array:
        beyond = values(q[:, None] + (1.0 - q)[:, None] * x)
        return np.asarray(np.einsum("j,ijk->ik", w, beyond), dtype=np.float64)

    q = 1.0 - x * x
    return Rule(x, w, analysis, analysis @ means(x), values(q), means(q))


def onset_in(law: ContactLaw) -> Onset:
    """Return the onset of yield; at an infinite radius if it is beyond the range of the law."""
    hertz, limit = np.atleast_2d(onset_radius(law)), law.limit
    a = np.minimum(hertz, limit)
    moving = np.full(a.shape, not law.hertzian)
    for _ in range(STEPS):
        if not moving.any():
            break
        shape = law.at(a)
        root = np.cbrt(shape.force)
        step = np.log(hertz / (a * root)) / (_growth(shape) / root)
        after = np.minimum(a * np.exp(np.clip(step, -1.0, 1.0)), limit)
        a = np.where(moving, after, a)
        moving &= np.abs(step) > CLOSE
    return Onset(hertz, np.where(a >= limit, np.inf, np.where(moving, np.nan, a)))


def _growth(shape: Shape) -> Array:
    """Return the derivative of Hertz's radius of the force with respect to the radius [1]."""
    return np.asarray(shape.slope / (shape.additive * np.cbrt(shape.force)))


def elastic(law: ContactLaw) -> Phase:
    """Return the elastic phase."""

    def at(a: Array) -> tuple[Array, Array]:
        shape = law.at(a)
        return shape.force, shape.slope

    return at


def loading(law: ContactLaw, onset: Onset) -> Phase:
    """Return the phase of plastic loading."""

    def at(a: Array) -> tuple[Array, Array]:
        shape = law.at(a)
        _, added = loaded(a * np.cbrt(shape.force) / onset.hertz)
        return shape.force, shape.slope + 0.5 * added * (onset.hertz / a) * _growth(shape)

    return at


def unloading(law: ContactLaw, flattening: Array) -> Phase:
    """Return the phase of unloading; `flattening` is Hertz's over the actual contact radius."""

    def at(a: Array) -> tuple[Array, Array]:
        shape = law.at(a)
        return shape.force, shape.slope - (1.0 - flattening) * np.cbrt(shape.force) * _growth(shape)

    return at


def _power(phase: Phase, a: Array) -> Array:
    force, slope = phase(a)
    return force * slope


def _fourth(x: Array) -> Array:
    """Return the fourth power, with rounding errors that do not depend on the number of values."""
    square = x * x
    return square * square


def _stretch(phase: Phase, onset: Onset, energy: Array, limit: Array, known: Rule) -> Array:
    """Return by how much a phase from s = 1 on lengthens s until it has taken an energy.

    It is found by Newton's iteration for the logarithms, from above; NaN beyond the range of the
    law.
    """
    room = limit / onset.a - 1.0
    first = _power(phase, onset.a)
    length = np.minimum(np.expm1(np.log1p(5.0 * energy / first) / 5.0), room)
    moving = np.ones(length.shape, dtype=bool)
    for _ in range(STEPS):
        s = 1.0 + length * np.append(known.x, 1.0)
        f = _fourth(s) * _power(phase, onset.a * s)
        taken = length * np.sum(known.weights * f[..., :-1], axis=-1, keepdims=True)
        step = np.log(energy / taken) * taken / (length * f[..., -1:])
        step = np.where(np.isfinite(step) & (length > 0.0), step, np.nan)
        length = np.where(moving, length * np.exp(np.clip(step, -2.0, 2.0)), length)
        beyond = length > room
        length = np.where(beyond, np.where(step > CLOSE, np.nan, room), length)
        moving &= np.abs(step) > CLOSE
        if not moving.any():
            break
    return np.where(moving, np.nan, length)


def without_plasticity(law: ContactLaw) -> ContactLaw:
    """Return the law of the same contact without yield."""
    return law.only(lambda effect: not effect.plastic)


def impacts(law: ContactLaw) -> tuple[YieldedImpacts, Array]:
    """Return the impacts and the relative errors of their results, as columns.

    The error is the change since half as many nodes and, since both may have the same error, that
    of the energy balance over the energy of the rebound.

    Parameters
    ----------
    law
        A law with plasticity and without gravity or viscosity, of one scene or of many as columns.
    """
    found = yielded(law, NODES[0])
    error = np.full_like(found.ratio, np.nan)
    left = np.flatnonzero(np.isfinite(found.contact_time))
    for n in NODES[1:]:
        if not left.size:
            break
        after = yielded(law.take(left), n)
        pairs = zip(after[:RESULTS], found[:RESULTS], strict=True)
        error[left] = np.maximum.reduce([np.abs(new / old[left] - 1.0) for new, old in pairs])
        for column, values in zip(found, after, strict=True):
            column[left] = values
        left = left[error[left, 0] > SETTLED]  # not where NaN
    return found, error + _unbalanced(law, found)


def _unbalanced(law: ContactLaw, found: YieldedImpacts) -> Array:
    """Return the error of the energy balance over the energy of the rebound [1]."""
    model = law.model
    onset = hertz_energy(onset_radius(law), np.asarray(model.R), np.asarray(law.modulus))
    lost = onset * worked(found.ratio)[0] / (0.5 * model.m * model.v0 * model.v0)
    kept = found.restitution * found.restitution
    return np.asarray(np.abs(1.0 - lost - kept) / kept)


def yielded(law: ContactLaw, n: int) -> YieldedImpacts:
    """Return the impacts by n nodes in each phase."""
    model, known, onset, limit = law.model, rule(n), onset_in(law), np.asarray(law.limit)
    power = _fourth(known.x) * _power(elastic(law), onset.a * known.x)
    first = np.sum(known.weights * power, axis=-1, keepdims=True)
    pace = model.v0 * (model.R / onset.a / onset.a)
    energy = 0.1875 * (model.m / law.modulus / onset.a) * (pace * pace)  # over K a_y^5
    left = np.where(energy > first, energy - first, np.nan)
    more = _stretch(loading(law, onset), onset, left, limit, known)
    turning = _stretch(elastic(law), onset, left, limit, known)
    widest = onset.a * (1.0 + more)
    shape = law.at(widest)
    ratio = widest * np.cbrt(shape.force) / onset.hertz
    flattening, _ = unloaded(ratio)
    times = _first_time(elastic(law), onset, turning, energy, known)
    times = times + _loading_time(loading(law, onset), onset, more, energy, known)
    back, kept = _unloading(unloading(law, flattening), 1.0 + more, widest, energy, known)
    unit = 4.0 * onset.a * (onset.a / model.R) / model.v0
    plastic = onset.hertz * (onset.hertz / model.R) * loaded(ratio)[0]
    return YieldedImpacts(
        unit * (times + back),
        law.indentation(widest, shape) + plastic,
        law.force(widest, shape),
        widest / flattening,
        np.sqrt(kept),
        ratio,
    )


def _first_time(phase: Phase, onset: Onset, turning: Array, energy: Array, known: Rule) -> Array:
    """Return the time up to the onset of yield."""
    size = 1.0 + turning
    last = np.sqrt(turning / size)
    u = last + (1.0 - last) * known.x
    force, slope = phase(onset.a * size * known.x)
    z = 1.0 - 2.0 * u * u
    coefficients = mapped(known.coefficients, slope).T[..., None]
    rate = legval(z, coefficients, tensor=False)
    coefficients = mapped(known.beyond, _fourth(known.x) * force * slope).T[..., None]
    left = legval(z, coefficients, tensor=False) * (size * _fourth(size) / energy)
    mean = np.sum(known.weights * (1.0 - u * u) * rate / np.sqrt(left), axis=-1, keepdims=True)
    return np.asarray(size * size * (1.0 - last) * mean)


def _loading_time(phase: Phase, onset: Onset, more: Array, energy: Array, known: Rule) -> Array:
    """Return the time from the onset of yield to the largest radius."""
    s = 1.0 + more * known.x
    force, slope = phase(onset.a * s)
    rate = mapped(known.at_times, s * slope)
    left = mapped(known.mean_at_times, _fourth(s) * force * slope) / energy
    mean = np.sum(known.weights * rate / np.sqrt(left), axis=-1, keepdims=True)
    return np.asarray(np.sqrt(more) * mean)


def _unloading(
    phase: Phase, size: Array, widest: Array, energy: Array, known: Rule
) -> tuple[Array, Array]:
    """Return the time of unloading, and the energy of the rebound over that of the impact.

    `size` is the largest radius of the law over that at the onset of yield.
    """
    force, slope = phase(widest * known.x)
    unit = size * _fourth(size) / energy
    power = _fourth(known.x) * force * slope
    rate = mapped(known.at_times, known.x * slope)
    left = mapped(known.mean_at_times, power) * unit
    mean = np.sum(known.weights * rate / np.sqrt(left), axis=-1, keepdims=True)
    return size * size * mean, unit * np.sum(known.weights * power, axis=-1, keepdims=True)
