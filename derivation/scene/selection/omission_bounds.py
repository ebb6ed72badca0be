"""Bounds on the change of the results if effects are omitted, from the bounds of the effects.

S of the whole law is between 1 - low and 1 + up times S_1 of the law with the included effects, for
all radii up to 1.02 times the largest; derivation step 18 gives the change of the results.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial, reduce
from typing import Any

import numpy as np

from derivation.scene.contact_law.law import ContactLaw, Shape
from derivation.scene.contact_law.law_errors import law_errors
from derivation.scene.effects.effect import (
    Bound,
    BoundContext,
    Changes,
    Effect,
    LawSamples,
    Numbers,
    PlateEffect,
    bounded_where,
    weight_work_ratio,
)
from derivation.scene.effects.inertia import WIDER, least_restitution
from derivation.scene.effects.plasticity import plastic_depth
from derivation.scene.effects.viscosity import (
    inverse_restitution,
    on_vibrating_plate,
    viscous_number,
)
from derivation.scene.errors import SceneError
from derivation.scene.numerics import columns
from derivation.scene.numerics.quadrature import NODES, mapped, rule, stored
from derivation.scene.quasi_static.motion import largest_radii
from derivation.scene.scene import OUTPUTS
from generated.arrays import Double as Array

TOP = 1.02
"""Bounds cover radii up to this times the largest radius."""
NEAR = 1e-4
"""Last step of the iteration for the largest radius, whose error is about the square of it."""
FEW = 3
"""Number of nodes for laws with S = 1, whose bounds are largest at the largest radius."""
MARGIN = 1.05
"""Factor on elasticities of S, which are sampled at nodes."""
PLASTIC_GROWTH = 1.5
"""Largest d log(contact radius)/d log(Hertz's radius of the force) of a contact that yields."""
VIBRATING = 6.0, 30.0
"""Increase of the changes of a result by vibration of the plate: the smaller one of the first
number, and of the second times the change by inertia (at most 1). In 392 random scenes the increase
was at most 2.1, but once the number of contacts changed and with it the time of the first."""
RADIATED, REMAINING = 3.0, 0.75
"""Change of the logarithm of the restitution e on a plate with inertia, over that of the worst
other result, the change by inertia (at most 1) and 1 + work of the weight over kinetic energy: the
larger one of both numbers, the second divided by e. Fitted: in 300 random scenes whose sphere was
given another radius the change of an elastic contact was at most 2.0. In seven scenes that yield
or are viscoelastic it was 5 to 312, which `_plastic_sensitivity` and the bound of viscosity cover:
in all random scenes the restitution changed by at most 0.54 of its whole bound."""
WEIGHT = 8.0
"""Change of the restitution e by the impulse of the weight, over its work over the kinetic energy.
It is large because the sphere may stay on the plate for a long time: at most 5.0 in 326 random
scenes with e below 0.12."""


@dataclass(frozen=True)
class LargestContact:
    """A law at its largest contact radius, for one scene or, with columns of numbers, for many.

    Attributes
    ----------
    law
        The law with the included effects.
    a
        Largest contact radius [m]; NaN if the impact exceeds the range of the law.
    context
        Radii at which the bounds are evaluated, and samples of the law there.
    slope
        S_1 at these radii [1].
    fall, rise
        d log S_1/d log a is between -fall and rise [1].
    growth
        Largest d log(contact radius)/d log(Hertz's radius of the force), at least 1 [1].
    """

    law: ContactLaw
    a: Numbers
    context: BoundContext
    slope: Array
    fall: Array
    rise: Array
    growth: Array
    bounds: dict[tuple[str, bool], Bound] = field(default_factory=dict, compare=False)
    """Bounds computed so far, by effect and whether the radii were scaled."""
    errors: dict[tuple[str, ...], Array] = field(default_factory=dict, compare=False)
    """Bounds on the change of each output computed so far, by the effects omitted together."""

    @cached_property
    def quasi_static(self) -> "LargestContact":
        """The largest contact on the plate without inertia."""
        return state_of(_quasi_static(self.law))

    @cached_property
    def by_inertia(self) -> Changes:
        """Logarithms of the factors by which plate inertia may change the results [1]."""
        [inertia] = [effect for effect in self.law.chosen if effect.dynamic]
        return bound_of(self.quasi_static, inertia).results

    @cached_property
    def steepness(self) -> Changes:
        """Factors on the changes of the results by derivation step 18 [1].

        That step is for an elastic contact on a quasi-static plate. The force of a viscoelastic
        contact depends more on its stiffness, and the sphere leaves it slowly, so that the weight
        has more effect. Vibration of the plate can add to any change.
        """
        one: Numbers = 1.0
        time: Numbers = 1.0
        if any(effect.viscous for effect in self.law.chosen):
            one = inverse_restitution(viscous_number(self.law.model))
            time = one * one
        if self.law.dynamic:
            most, steep = VIBRATING
            changed = columns.at_most_one(reduce(np.maximum, self.by_inertia))
            moving = 1.0 + np.minimum(most, steep * changed)
            one, time = moving * one, moving * time
        return time, one, one, one, one

    @cached_property
    def vibration(self) -> tuple[Numbers, Numbers]:
        """Factors of force and weight on the change of the restitution by vibration [1].

        The force determines how much energy the vibration of the plate takes.
        """
        model = self.law.model
        heavier = 1.0 + weight_work_ratio(model, plastic_depth(model, self.context))
        least, most = least_restitution(model), columns.at_most_one(self.by_inertia[-1])
        return np.maximum(RADIATED, REMAINING / least) * heavier * most, WEIGHT / least * most


def state_of(law: ContactLaw, top: float = TOP) -> LargestContact:
    """Return the law at its largest radius, or at its limit if the impact exceeds that.

    With plate inertia, the radius is that on a plate that does not deflect, times a factor by which
    the contact may be wider. Its law is that of a half-space: a plate that deflects in its law
    would make the contact narrower than it is before the plate has moved.
    """
    if law.dynamic:
        stiff = law.only(lambda e: not (isinstance(e, PlateEffect) or e.solved or e.dynamic))
        wider = state_of(stiff, WIDER)
        # The sphere moves with the plate, as far as on a quasi-static one, during all contacts.
        still = state_of(_quasi_static(law))
        depth = np.fmax(wider.context.depth, still.context.depth)
        context = replace(wider.context, depth=float(depth) if np.ndim(depth) == 0 else depth)
        moving = replace(wider, law=law, context=context, bounds={}, errors={})
        vars(moving)["quasi_static"] = still  # known already
        return moving
    constant = not (law.plate_effects or law.spherical or law.solved)
    count = FEW if constant else NODES[0]
    nodes = rule(count)
    with np.errstate(all="ignore"):
        try:
            a = largest_radii(law, count, close=NEAR)
        except SceneError:
            a = np.array([np.nan])
        # With more effects the impact may be within the range.
        upper = np.where(np.isnan(a), law.limit, np.minimum(top * a, law.limit))
        radii = np.append(nodes.x, 1.0) * upper
        shape = law.at(radii)
        # The polynomial omits the largest radius, where the slope of a sphere may be very steep.
        inner = Shape(*(x[..., :-1] for x in shape))
        elasticity = nodes.x * mapped(nodes.derivative, inner.additive) / inner.additive
        own = law.spherical or law.solved  # else the contact radius is Hertz's
        equal = columns.prepended(0.0, radii * np.cbrt(shape.force) if own else radii)
    fall, rise = (
        np.maximum(0.0, -columns.least(elasticity)),
        np.maximum(0.0, columns.most(elasticity)),
    )
    growth = np.ones_like(rise)
    if law.plastic:  # derivation step 31: S grows with xi, and a^2 with xi^3
        rise, growth = rise + 1.0, PLASTIC_GROWTH * growth
    if own:  # P is proportional to the cube of Hertz's radius, and dP = 2 E* a_H d delta/S.
        with np.errstate(all="ignore"):  # extreme scenes give NaN, which is checked
            swelling = inner.slope / (inner.additive * np.cbrt(inner.force) ** 2)
            growth = growth * (1.0 + MARGIN * np.maximum(0.0, columns.most(1.0 / swelling) - 1.0))
    depth = a * (a / law.model.R) * shape.depth[..., -1:]
    context = BoundContext(equal, columns.number(depth), partial(_samples, law, upper, shape))
    slope = columns.prepended(1.0, shape.additive)
    return LargestContact(
        law, columns.number(a), context, slope, MARGIN * fall, MARGIN * rise, growth
    )


def _quasi_static(law: ContactLaw) -> ContactLaw:
    """Return the law on a plate without inertia."""
    return law.only(lambda e: not (e.dynamic or e.damps or e.stretches))


def _samples(law: ContactLaw, top: Array, shape: Shape) -> LawSamples:
    """Return force, indentation, stiffness and energy at the nodes and the largest radius.

    `shape` is that of the law there, or at `FEW` nodes if it is the same at all radii.
    """
    nodes = rule(NODES[0])
    with np.errstate(all="ignore"):
        radii = np.append(nodes.x, 1.0) * top
        if shape.force.shape != radii.shape:
            shape = law.at(radii)
        power = (shape.force * shape.slope)[..., :-1]
        total_work = np.sum(nodes.weights * nodes.x**4 * power, axis=-1, keepdims=True)
        work = np.concatenate((mapped(stored(NODES[0]), power), total_work), axis=-1)
        unit = law.force(top, Shape(*np.ones(4))) * law.indentation(top, Shape(*np.ones(4)))
        return LawSamples(
            law.force(radii, shape),
            law.indentation(radii, shape),
            law.stiffness(radii, shape),
            2.0 * unit * work,
            2.0 * shape.slope / shape.depth,
        )


def bound_of(state: LargestContact, effect: Effect, scale: Numbers | None = None) -> Bound:
    """Return the bound of an effect; `scale` multiplies the radii (elasticity of the sphere)."""
    key = effect.name, scale is not None
    if key not in state.bounds:
        with np.errstate(all="ignore"):
            state.bounds[key] = _bound(state, effect, scale)
    return state.bounds[key]


def _bound(state: LargestContact, effect: Effect, scale: Numbers | None) -> Bound:
    """Compute the bound of an effect.

    Damping does not change the slope of the law at any radius. Its bound is one of the results
    alone, and is computed on a quasi-static plate.
    """
    if effect.damps and state.law.dynamic:
        still = state.quasi_static
        none = np.zeros_like(state.context.radii)
        bound = _bound(still, effect, scale)
        known = ~np.isnan(still.a) & np.all(np.isfinite(bound.up), axis=-1, keepdims=True)
        return Bound(none, none, results=bounded_where(known, bound.results))
    context, model = state.context.scaled(scale), state.law.model
    bound = effect.bound(model, context)
    if effect.viscous and state.law.dynamic:
        most = columns.at_most_one(reduce(np.maximum, state.by_inertia))
        bound = bound._replace(results=on_vibrating_plate(bound.results, most))
    if effect.other_edge and state.law.dynamic:
        # Waves return from the edge. Both edges are compared with their quasi-static plates.
        bound = bound._replace(results=_sums((state.by_inertia, state.by_inertia)))
    if not effect.bounded(state.law):
        return bound._replace(up=bound.up + math.inf)
    if isinstance(effect, PlateEffect):
        part = 1.0 / (1.0 + state.law.softness)
        return bound._replace(low=part * bound.low, up=part * bound.up)
    return bound


def error_of(state: LargestContact, effects: Sequence[Effect], outputs: Sequence[str]) -> float:
    """Return the bound on the change of the worst output if effects are omitted together."""
    return float(errors_of(state, effects, outputs).item())


def errors_of(state: LargestContact, effects: Sequence[Effect], outputs: Sequence[str]) -> Array:
    """Return the bounds of `error_of` for one scene, or for many as a column."""
    return _worst(each_error_of(state, effects), outputs)


def each_error_of(state: LargestContact, effects: Sequence[Effect]) -> Array:
    """Return the bounds on the change of each output, in the order of `OUTPUTS`."""
    names = tuple(effect.name for effect in effects)
    if names not in state.errors:
        state.errors[names] = _each_error(state, effects)
    return state.errors[names]


def _each_error(state: LargestContact, effects: Sequence[Effect]) -> Array:
    """Compute the bounds on the change of each output."""
    shape = len(OUTPUTS), *state.growth.shape
    if not effects:
        return np.zeros(shape)
    lost = np.isnan(state.a)
    if lost.all():
        return np.full(shape, np.inf)
    elastic = [e for e in effects if np.any(e.softness(state.law.model))]
    scale = np.exp(bound_of(state, elastic[0]).radius) if elastic else None
    bounds = [bound_of(state, e, None if e in elastic else scale) for e in effects]
    # Half-space effects multiply; for the others the product is an upper bound of the sum.
    with np.errstate(over="ignore"):
        up = np.asarray(math.prod(1.0 + bound.up for bound in bounds))
    whole = Bound(
        low=_sum(bound.low for bound in bounds),
        up=up - 1.0,
        energy=_sum(bound.energy for bound in bounds),
        radius=_sum(bound.radius for bound in bounds),
        results=_sums(bound.results for bound in bounds),
    )
    return np.where(lost, np.inf, _each_change(state, whole))


def _sum(numbers: Iterable[Numbers]) -> Any:
    """Return the sum of numbers and arrays."""
    return sum(numbers, 0.0)


def _sums(rows: Iterable[Changes]) -> Changes:
    """Return the sums of each output."""
    time, depth, force, radius, speed = map(_sum, zip(*rows, strict=True))
    return time, depth, force, radius, speed


def _worst(errors: Array, outputs: Sequence[str]) -> Array:
    """Return the largest of the errors of some outputs."""
    return np.asarray(errors[[OUTPUTS.index(name) for name in outputs]].max(axis=0))


def _each_change(state: LargestContact, bound: Bound) -> Array:
    """Return the error of each output, by derivation step 18 and by direct changes."""
    low, up, energy, radius, results = bound
    with np.errstate(all="ignore"):  # overflow means that there is no bound
        below, above = columns.most(low / state.slope), columns.most(up / state.slope)
        known = np.isfinite(below) & np.isfinite(above) & (columns.least(state.slope) > 0.0)
        below, above = np.where(known, below, 0.0), np.where(known, above, 0.0)
        if np.any(energy):
            # The work of the weight depends on the indentation of the whole law.
            free = law_errors(below, above, state.fall, state.rise)[1]
            work = -np.expm1(-np.asarray(energy)) * (1.0 + free)
            energy = np.where(work < 1.0, -np.log1p(-np.minimum(work, 1.0)), np.inf)
        change = law_errors(below, above, state.fall, state.rise, energy)
        largest = np.maximum.reduce(change)
        # The bound of a viscoelastic contact by this law is increased to cover the whole law.
        wider = (1.0 + largest) ** 2
        others = (*change, np.zeros_like(largest))
        logs = [x * np.log1p(y) for x, y in zip(state.steepness, others, strict=True)]
        logs = [x + wider * y for x, y in zip(logs, results, strict=True)]
        kept = [bound_of(state, e).results[-1] for e in state.law.chosen if e.viscous]
        if kept:
            # Without a change of the law this bound does not change, even if it is infinite.
            logs[-1] = logs[-1] + np.where(wider > 1.0, (wider - 1.0) * _sum(kept), 0.0)
        if state.law.dynamic:
            taken, pressed = state.vibration
            logs[-1] = logs[-1] + taken * np.log1p(largest) + pressed * energy
        if state.law.plastic:
            logs[-1] = logs[-1] + _plastic_sensitivity(state) * np.log1p(largest)
        # Derivation step 18 is for Hertz's radius of the force; the contact radius may grow faster.
        logs[3] = logs[3] + (state.growth - 1.0) * np.log1p(change[3]) + state.growth * radius
        errors = np.array(np.broadcast_arrays(*map(np.expm1, logs))) + 0.0 * largest
        return np.where(known & np.isfinite(change[0]) & ~np.isnan(errors), errors, np.inf)


def _plastic_sensitivity(state: LargestContact) -> Numbers:
    """Return a bound on d log(restitution)/d log(force) of a plastic contact.

    The plastic work grows at most with the square of the force; e^2 is the fraction of the energy
    that remains.
    """
    [effect] = [effect for effect in state.law.chosen if effect.plastic]
    restitution = np.maximum(np.exp(-bound_of(state, effect).results[-1]), 1e-3)
    return 1.0 / (restitution * restitution)


def size_of(state: LargestContact, effect: Effect, outputs: Sequence[str]) -> float:
    """Return the size of an effect in one scene, by which the selection ranks it.

    It is the error bound if the effect is omitted, or without a bound a measure of its part of S.
    """
    return float(sizes_of(state, effect, outputs).item())


def sizes_of(state: LargestContact, effect: Effect, outputs: Sequence[str]) -> Array:
    """Return the sizes of `size_of` for one scene, or for many as a column."""
    error = errors_of(state, [effect], outputs)
    if np.isfinite(error).all():
        return error
    bound = bound_of(state, effect)
    with np.errstate(all="ignore"):
        part = np.maximum(bound.low, bound.up) / np.abs(state.slope)
    most = columns.most(np.where(np.isfinite(part), part, 0.0))
    return np.where(
        np.isfinite(error), error, 10.0 + np.maximum(most, 0.0) + bound.energy + bound.results[-1]
    )


def each_change_of(state: LargestContact, effects: Sequence[Effect]) -> Array:
    """Return the bounds on the changes if an included effect is omitted, with its parts."""
    effect = effects[0]
    if effect.always_included or np.isnan(state.a):
        return np.full((len(OUTPUTS), 1), np.inf)
    if effect.dynamic:
        return each_error_of(state.quasi_static, effects)
    bound = bound_of(state, effect)
    return _each_change(state, bound._replace(low=bound.up, up=bound.low))
