"""What leaving effects out of a law changes in the results at most, by the effects' bounds.

S of the whole law lies within 1 - low and 1 + up times that of the law taken, at every radius
up to 1.02 times the largest; link 18 says what this does to the results.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import reduce
from operator import add
from typing import Any

import numpy as np

from derivation.scene.effects.effect import (
    Array,
    Bound,
    BoundContext,
    Changes,
    Effect,
    LawSamples,
    Numbers,
    PlateEffect,
)
from derivation.scene.effects.inertia import WIDER
from derivation.scene.law import ContactLaw, Shape
from derivation.scene.law_errors import law_errors
from derivation.scene.motion import largest_radii
from derivation.scene.quadrature import NODES, mapped, rule, stored
from derivation.scene.scene import OUTPUTS, SceneError

TOP = 1.02
"""Bounds are taken up to this times the largest radius."""
NEAR = 1e-6
"""How near the largest radius has to be known for that."""
FEW = 3
"""Nodes of laws whose S is 1, where every bound is largest at the largest radius."""
MARGIN = 1.05
"""Elasticities of S are sampled at nodes and widened by this."""


@dataclass(frozen=True)
class LargestContact:
    """A law at its largest radius [m]: S_1 at the radii of `context`, and elasticities of S_1.

    `growth` is the largest elasticity of the contact radius by Hertz's radius of the force, at
    least 1. `a` is NaN if the impact exceeds the law's range. Of many scenes, numbers are columns.
    """

    law: ContactLaw
    a: Numbers
    context: BoundContext
    slope: Array
    fall: Array
    rise: Array
    growth: Array
    bounds: dict[tuple[str, bool], Bound] = field(default_factory=dict, compare=False)
    """Bounds of effects known so far, by name and whether radii are stretched."""


def state_of(law: ContactLaw, top: float = TOP) -> LargestContact:
    """The law at its largest radius, or at its limit if that is beyond.

    With plate inertia that of a plate that does not deflect, and so much wider as a contact may
    become there at most.
    """
    if law.dynamic:
        stiff = law.only(lambda e: not (isinstance(e, PlateEffect) or e.dynamic))
        return replace(state_of(stiff, WIDER), law=law, bounds={})
    constant = not (law.plate_effects or law.spherical or law.solved)
    count = FEW if constant else NODES[0]
    nodes = rule(count)
    with np.errstate(all="ignore"):
        try:
            a = largest_radii(law, count, close=NEAR)
        except SceneError:  # with more effects there may be an impact
            a = np.array([np.nan])
        # Beyond the law's range there may be an impact with more effects.
        upper = np.where(np.isnan(a), law.limit, np.minimum(top * a, law.limit))
        radii = np.append(nodes.x, 1.0) * upper
        shape = law.at(radii)
        # Once more without the end, where a sphere's slope may be steep: of the polynomial.
        inner = Shape(*(x[..., :-1] for x in shape))
        elasticity = nodes.x * mapped(nodes.derivative, inner.additive) / inner.additive
        own = law.spherical or law.solved  # else the contact radius is Hertz's
        equal = _begun(0.0, radii * np.cbrt(shape.force) if own else radii)
    fall, rise = np.maximum(0.0, -_least(elasticity)), np.maximum(0.0, _most(elasticity))
    growth = np.ones_like(rise)
    if own:  # P goes with the cube of Hertz's radius, and dP = 2 E* a_H d delta/S.
        swelling = inner.slope / (inner.additive * np.cbrt(inner.force) ** 2)
        growth = 1.0 + MARGIN * np.maximum(0.0, _most(1.0 / swelling) - 1.0)
    depth = a * (a / law.model.R) * shape.depth[..., -1:]
    context = BoundContext(equal, _number(depth), lambda: _samples(law, upper))
    slope = _begun(1.0, shape.additive)
    return LargestContact(law, _number(a), context, slope, MARGIN * fall, MARGIN * rise, growth)


def _begun(first: float, values: Array) -> Array:
    """Values with one more in front, of each scene."""
    start = np.full((*values.shape[:-1], 1), first)
    return np.concatenate((start, values), axis=-1)


def _number(x: Array) -> Numbers:
    """A number of one scene as a float, those of many as the column they are."""
    return float(x.item()) if x.ndim == 1 else x


def _most(values: Array) -> Array:
    """The largest of each scene."""
    return np.asarray(np.max(values, axis=-1, keepdims=True))


def _least(values: Array) -> Array:
    """The smallest of each scene."""
    return np.asarray(np.min(values, axis=-1, keepdims=True))


def _samples(law: ContactLaw, top: Array) -> LawSamples:
    """Force, indentation, stiffness and energy at the nodes and the largest radius."""
    nodes = rule(NODES[0])
    with np.errstate(all="ignore"):
        radii = np.append(nodes.x, 1.0) * top
        shape = law.at(radii)
        power = (shape.force * shape.slope)[..., :-1]
        whole = np.sum(nodes.weights * nodes.x**4 * power, axis=-1, keepdims=True)
        share = np.concatenate((mapped(stored(NODES[0]), power), whole), axis=-1)
        unit = law.force(top, Shape(*np.ones(4))) * law.indentation(top, Shape(*np.ones(4)))
        return LawSamples(
            law.force(radii, shape),
            law.indentation(radii, shape),
            law.stiffness(radii, shape),
            2.0 * unit * share,
            2.0 * shape.slope / shape.depth,
        )


def bound_of(state: LargestContact, effect: Effect, stretch: Numbers | None = None) -> Bound:
    """An effect's bound in the state's context, whose radii the sphere's elasticity may stretch."""
    key = effect.name, stretch is not None
    if key not in state.bounds:
        with np.errstate(all="ignore"):
            state.bounds[key] = _bound(state, effect, stretch)
    return state.bounds[key]


def _bound(state: LargestContact, effect: Effect, stretch: Numbers | None) -> Bound:
    """The same, computed. That of damping, which acts over the whole contact, is taken on a
    quasi-static plate.
    """
    if effect.damps and state.law.dynamic:
        state = state_of(state.law.only(lambda e: not (e.dynamic or e.damps)))
        if np.all(np.isnan(state.a)):
            none = np.zeros_like(state.context.radii)
            return Bound(none, none, results=5 * (math.inf,))
    context, model = state.context.stretched(stretch), state.law.model
    if effect.takes_rows or context.radii.ndim == 1:
        found = effect.bound(model, context)
    else:
        rows = range(len(context.radii))
        found = _together([effect.bound(model.take(i), context.row(i)) for i in rows])
    if not effect.bounded(state.law):
        return found._replace(up=found.up + math.inf)
    if isinstance(effect, PlateEffect):
        part = 1.0 / (1.0 + state.law.softness)
        return found._replace(low=part * found.low, up=part * found.up)
    return found


def _together(bounds: Sequence[Bound]) -> Bound:
    """Bounds of single scenes as those of many."""
    low, up = (np.array([bound[i] for bound in bounds]) for i in (0, 1))
    energy = _column(bound.energy for bound in bounds)
    radius = _column(bound.radius for bound in bounds)
    time, depth, force, width, speed = (
        _column(bound.results[i] for bound in bounds) for i in range(len(OUTPUTS))
    )
    return Bound(low, up, energy, radius, (time, depth, force, width, speed))


def _column(numbers: Iterable[Numbers]) -> Array:
    """Single numbers as a column."""
    return np.array([np.asarray(number).item() for number in numbers])[:, None]


def error_of(state: LargestContact, effects: Sequence[Effect], outputs: Sequence[str]) -> float:
    """What leaving effects out of one scene changes together at most, the worst of the outputs."""
    return float(errors_of(state, effects, outputs).item())


def errors_of(state: LargestContact, effects: Sequence[Effect], outputs: Sequence[str]) -> Array:
    """The same of one scene, or of many as a column."""
    if not effects:
        return np.zeros_like(state.growth)
    lost = np.isnan(state.a)
    if lost.all():
        return np.full_like(state.growth, np.inf)
    elastic = [e for e in effects if np.any(e.softness(state.law.model))]
    stretch = np.exp(bound_of(state, elastic[0]).radius) if elastic else None
    bounds = [bound_of(state, e, None if e in elastic else stretch) for e in effects]
    up = 1.0 + bounds[0].up
    for bound in bounds[1:]:
        # The half-space's effects multiply; a product is above the sum where they only add.
        up = up * (1.0 + bound.up)
    together = Bound(
        low=_sum(bound.low for bound in bounds),
        up=up - 1.0,
        energy=_sum(bound.energy for bound in bounds),
        radius=_sum(bound.radius for bound in bounds),
        results=_sums(bound.results for bound in bounds),
    )
    return np.where(lost, np.inf, _worst(state, together, outputs))


def _sum(numbers: Iterable[Numbers]) -> Any:
    """The sum, of whatever shape each has."""
    return reduce(add, numbers)


def _sums(rows: Iterable[Changes]) -> Changes:
    """Sums of the rows' columns."""
    time, depth, force, radius, speed = map(_sum, zip(*rows, strict=True))
    return time, depth, force, radius, speed


def _worst(state: LargestContact, bound: Bound, outputs: Sequence[str]) -> Array:
    """The worst of the outputs' errors by link 18, and by what changes results besides."""
    low, up, energy, radius, results = bound
    with np.errstate(all="ignore"):  # no bound, as good as
        below, above = _most(low / state.slope), _most(up / state.slope)
        known = np.isfinite(below) & np.isfinite(above) & (_least(state.slope) > 0.0)
        below, above = np.where(known, below, 0.0), np.where(known, above, 0.0)
        if np.any(energy):
            # The weight works along the whole law's indentation, not along this one's.
            free = law_errors(below, above, state.fall, state.rise)[1]
            share = -np.expm1(-np.asarray(energy)) * (1.0 + free)
            energy = np.where(share < 1.0, -np.log1p(-np.minimum(share, 1.0)), np.inf)
        found = law_errors(below, above, state.fall, state.rise, energy)
        largest = np.maximum.reduce(found)
        # The bound of a viscous contact, taken of this law, is widened for that of everything.
        wider = (1.0 + largest) ** 2
        others = (*found, np.zeros_like(largest))
        logs = [np.log1p(x) + wider * y for x, y in zip(others, results, strict=True)]
        kept = [bound_of(state, e).results[-1] for e in state.law.chosen if e.viscous]
        if kept:
            # What does not change the law does not change that bound, be it none at all.
            logs[-1] = logs[-1] + np.where(wider > 1.0, (wider - 1.0) * _sum(kept), 0.0)
        if state.law.plastic:
            logs[-1] = logs[-1] + _plastic_share(state) * np.log1p(largest)
        # Link 18 speaks of Hertz's radius of the force, with which the contact's own may grow
        # faster.
        logs[3] = logs[3] + (state.growth - 1.0) * np.log1p(found[3]) + state.growth * radius
        errors = [np.expm1(log) for name, log in zip(OUTPUTS, logs, strict=True) if name in outputs]
        worst = np.maximum.reduce(errors) + 0.0 * largest
        return np.where(known & np.isfinite(found[0]) & ~np.isnan(worst), worst, np.inf)


def _plastic_share(state: LargestContact) -> float:
    """How much of a change of the force the restitution of a contact that yields follows, at most.

    The work that it takes goes with the force's square at most, and e^2 is what is left of all.
    """
    [effect] = [effect for effect in state.law.chosen if effect.plastic]
    restitution = math.exp(-bound_of(state, effect).results[-1])
    return 1.0 / max(restitution, 1e-3) ** 2


def size_of(state: LargestContact, effect: Effect, outputs: Sequence[str]) -> float:
    """By how much an effect of one scene matters alone.

    That is its error, or where none is shown its share of S.
    """
    return float(sizes_of(state, effect, outputs).item())


def sizes_of(state: LargestContact, effect: Effect, outputs: Sequence[str]) -> Array:
    """The same of one scene, or of many as a column."""
    error = errors_of(state, [effect], outputs)
    if np.isfinite(error).all():
        return error
    bound = bound_of(state, effect)
    with np.errstate(all="ignore"):
        share = np.maximum(bound.low, bound.up) / np.abs(state.slope)
    most = _most(np.where(np.isfinite(share), share, 0.0))
    return np.where(
        np.isfinite(error), error, 10.0 + np.maximum(most, 0.0) + bound.energy + bound.results[-1]
    )


def price_of(state: LargestContact, effect: Effect, outputs: Sequence[str]) -> float:
    """What leaving out an effect that is in would change: the law with it lies beside S_1."""
    if effect.always_included or np.isnan(state.a):
        return math.inf
    if effect.dynamic:
        state = state_of(state.law.only(lambda e: not (e.dynamic or e.damps)))
        return error_of(state, [effect], outputs)
    bound = bound_of(state, effect)
    return float(_worst(state, bound._replace(low=bound.up, up=bound.low), outputs).item())
