"""What leaving effects out of a law changes in the results at most, by the effects' bounds.

S of the whole law lies within 1 - low and 1 + up times that of the law taken, at every radius
up to 1.02 times the largest; link 18 says what this does to the results.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from derivation.scene import kernels
from derivation.scene.effects.effect import (
    Array,
    Bound,
    BoundContext,
    Effect,
    LawSamples,
    PlateEffect,
    Results,
)
from derivation.scene.effects.inertia import WIDER
from derivation.scene.law import ContactLaw, Shape
from derivation.scene.motion import largest_radius
from derivation.scene.quadrature import NODES, rule, stored
from derivation.scene.scene import OUTPUTS, SceneError

TOP = 1.02
"""Bounds are taken up to this times the largest radius."""
NEAR = 1e-6
"""How near the largest radius has to be known for that."""
MARGIN = 1.05
"""Elasticities of S are sampled at nodes and widened by this."""


@dataclass(frozen=True)
class LargestContact:
    """A law at its largest radius [m]: S_1 at the radii of `context`, and elasticities of S_1.

    `growth` is the largest elasticity of the contact radius by Hertz's radius of the force, at
    least 1. `a` is NaN if the impact exceeds the law's range.
    """

    law: ContactLaw
    a: float
    context: BoundContext
    slope: Array
    fall: float
    rise: float
    growth: float


def state_of(law: ContactLaw, top: float = TOP) -> LargestContact:
    """The law at its largest radius, or at its limit if that is beyond.

    With plate inertia that of a plate that does not deflect, and so much wider as a contact may
    become there at most.
    """
    if law.dynamic:
        stiff = law.only(lambda e: not (isinstance(e, PlateEffect) or e.dynamic))
        return replace(state_of(stiff, WIDER), law=law)
    nodes = rule(NODES[0])
    with np.errstate(all="ignore"):
        try:
            a = largest_radius(law, close=NEAR)
            top = min(top * a, law.limit)
        except SceneError:  # with more effects there may be an impact
            a, top = math.nan, law.limit
        radii = np.append(nodes.x, 1.0) * top
        shape = law.at(radii)
        # Once more without the end, where a sphere's slope may be steep: of the polynomial.
        inner, last = (Shape(*(x[part] for x in shape)) for part in (slice(-1), slice(-1, None)))
        elasticity = nodes.x * (nodes.derivative @ inner.additive) / inner.additive
        equal = np.concatenate(([0.0], radii * np.cbrt(shape.force)))
        samples = _samples(law, radii, shape)
    fall, rise = max(0.0, -float(np.min(elasticity))), max(0.0, float(np.max(elasticity)))
    # P goes with the cube of Hertz's radius, and dP = 2 E* a_H d delta/S.
    swelling = inner.slope / (inner.additive * np.cbrt(inner.force) ** 2)
    growth = 1.0 + MARGIN * max(0.0, float(np.max(1.0 / swelling)) - 1.0)
    context = BoundContext(equal, a * (a / law.model.R) * float(last.depth[0]), samples)
    slope = np.concatenate(([1.0], shape.additive))
    return LargestContact(law, a, context, slope, MARGIN * fall, MARGIN * rise, growth)


def _samples(law: ContactLaw, radii: Array, shape: Shape) -> LawSamples:
    """Force, indentation, stiffness and energy at the nodes and the largest radius."""
    nodes, top = rule(NODES[0]), radii[-1]
    power = (shape.force * shape.slope)[:-1]
    share = np.append(stored(NODES[0]) @ power, np.sum(nodes.weights * nodes.x**4 * power))
    unit = law.force(top, Shape(*np.ones(4))) * law.indentation(top, Shape(*np.ones(4)))
    return LawSamples(
        law.force(radii, shape),
        law.indentation(radii, shape),
        law.stiffness(radii, shape),
        2.0 * unit * share,
        2.0 * shape.slope / shape.depth,
    )


def bound_of(state: LargestContact, effect: Effect, stretch: float = 1.0) -> Bound:
    """An effect's bound in the state's context, whose radii the sphere's elasticity may stretch.

    That of damping, which acts over the whole contact, is taken on a quasi-static plate.
    """
    if effect.damps and state.law.dynamic:
        state = state_of(state.law.only(lambda e: not (e.dynamic or e.damps)))
        if math.isnan(state.a):
            none = np.zeros_like(state.context.radii)
            return Bound(none, none, results=5 * (math.inf,))
    with np.errstate(all="ignore"):
        found = effect.bound(state.law.model, state.context.stretched(stretch))
    if not effect.bounded(state.law):
        return found._replace(up=found.up + math.inf)
    if isinstance(effect, PlateEffect):
        part = 1.0 / (1.0 + state.law.softness)
        return found._replace(low=part * found.low, up=part * found.up)
    return found


def error_of(state: LargestContact, effects: Sequence[Effect], outputs: Sequence[str]) -> float:
    """What leaving effects out changes together at most, the worst of the outputs."""
    if not effects:
        return 0.0
    if math.isnan(state.a):
        return math.inf
    elastic = [e for e in effects if e.softness(state.law.model)]
    stretch = math.exp(bound_of(state, elastic[0]).radius) if elastic else 1.0
    bounds = [bound_of(state, e, 1.0 if e in elastic else stretch) for e in effects]
    together = Bound(
        low=np.sum([bound.low for bound in bounds], axis=0),
        # The half-space's effects multiply; a product is above the sum where they only add.
        up=np.prod([1.0 + bound.up for bound in bounds], axis=0) - 1.0,
        energy=sum(bound.energy for bound in bounds),
        radius=sum(bound.radius for bound in bounds),
        results=_sums(bound.results for bound in bounds),
    )
    return _worst(state, together, outputs)


def _sums(rows: Iterable[Results]) -> Results:
    """Sums of the rows' columns."""
    time, depth, force, radius, speed = (math.fsum(column) for column in zip(*rows, strict=True))
    return time, depth, force, radius, speed


def _worst(state: LargestContact, bound: Bound, outputs: Sequence[str]) -> float:
    """The worst of the outputs' errors by link 18, and by what changes results besides."""
    low, up, energy, radius, results = bound
    if not (np.all(np.isfinite(low)) and np.all(np.isfinite(up)) and state.slope.min() > 0.0):
        return math.inf
    below, above = float(np.max(low / state.slope)), float(np.max(up / state.slope))
    if energy:
        # The weight works along the whole law's indentation, not along this one's.
        free = kernels.law_errors(below, above, state.fall, state.rise)[1]
        share = -math.expm1(-energy) * (1.0 + free)
        energy = -math.log1p(-share) if share < 1.0 else math.inf
    found = kernels.law_errors(below, above, state.fall, state.rise, energy)
    if not math.isfinite(found[0]):
        return math.inf
    # The bound of a viscous contact, taken of this law, is widened for that of everything.
    wider = (1.0 + max(found)) ** 2
    kept = sum(bound_of(state, e).results[-1] for e in state.law.chosen if e.viscous)
    logarithms = np.log1p([*found, 0.0]) + wider * np.array(results)
    logarithms[-1] += (wider - 1.0) * kept
    if state.law.plastic:
        logarithms[-1] += _plastic_share(state) * math.log1p(max(found))
    # Link 18 speaks of Hertz's radius of the force, with which the contact's own may grow faster.
    logarithms[3] += (state.growth - 1.0) * math.log1p(found[3]) + state.growth * radius
    with np.errstate(over="ignore"):  # no bound, as good as
        errors = dict(zip(OUTPUTS, np.expm1(logarithms), strict=True))
    return float(max(errors[name] for name in outputs))


def _plastic_share(state: LargestContact) -> float:
    """How much of a change of the force the restitution of a contact that yields follows, at most.

    The work that it takes goes with the force's square at most, and e^2 is what is left of all.
    """
    [effect] = [effect for effect in state.law.chosen if effect.plastic]
    restitution = math.exp(-bound_of(state, effect).results[-1])
    return 1.0 / max(restitution, 1e-3) ** 2


def size_of(state: LargestContact, effect: Effect, outputs: Sequence[str]) -> float:
    """By how much an effect alone matters: its error, or where none is shown its share of S."""
    error = error_of(state, [effect], outputs)
    if math.isfinite(error):
        return error
    bound = bound_of(state, effect)
    share = np.maximum(bound.low, bound.up) / np.abs(state.slope)
    most = float(np.max(share, where=np.isfinite(share), initial=0.0))
    return 10.0 + most + bound.energy + bound.results[-1]


def price_of(state: LargestContact, effect: Effect, outputs: Sequence[str]) -> float:
    """What leaving out an effect that is in would change: the law with it lies beside S_1."""
    if effect.always_included or math.isnan(state.a):
        return math.inf
    if effect.dynamic:
        state = state_of(state.law.only(lambda e: not (e.dynamic or e.damps)))
        return error_of(state, [effect], outputs)
    bound = bound_of(state, effect)
    return _worst(state, bound._replace(low=bound.up, up=bound.low), outputs)
