"""The gate: which effects a scene calls for, by bounds of what leaving them out changes.

Begun with what is always in, the effect with the largest bound is taken in until the bounds
of all that is left out, together, stay within the tolerance. As S_1 grows with each effect
taken in and radii shrink, bounds are taken anew each time. The order does not depend on the
tolerance, so that a looser one never takes in more.

S of the whole law lies within 1 - low and 1 + up times that of the law taken, at every radius
up to 1.02 times the largest; link 18 says what this does to the results.
"""

import math
import time
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from derivation.scene import kernels
from derivation.scene.effects import BY_NAME, EFFECTS
from derivation.scene.effects.effect import Along, Array, Bound, Effect, Place, PlateEffect, Results
from derivation.scene.effects.inertia import WIDER
from derivation.scene.html import html_table
from derivation.scene.law import WHOLE_PLATE, Law, Shape
from derivation.scene.model import Model
from derivation.scene.motion import largest_radius
from derivation.scene.quadrature import NODES, rule, stored
from derivation.scene.scene import OUTPUTS, SceneError

SOLVED_WITH = WHOLE_PLATE | {"curvature", "sphere_elasticity"}
"""Effects that the true pressure's equation holds in itself."""
MOVED_WITH = WHOLE_PLATE | {"edge"}
"""Effects that a plate's modes hold, at rest and in motion."""
WHOLES = {"pressure": SOLVED_WITH, "inertia": MOVED_WITH}
"""Effects that hold the whole plate, and what comes in with them."""
TOP = 1.02
"""Bounds are taken up to this times the largest radius."""
NEAR = 1e-6
"""How near the largest radius has to be known for that."""
MARGIN = 1.05
"""Elasticities of S are sampled at nodes and widened by this."""
SAYS_NOTHING = 10.0
"""A bound so far above what it bounds is shown as none."""
FORCED_OUT = "false in the scene"
HEADS = ("effect", "number", "value", "if left out", "", "why")
"""Heads of the effects table."""


@dataclass(frozen=True)
class Row:
    """An effect's line of the effects table.

    Attributes
    ----------
    name, adds
        The effect, and what it adds.
    number, value
        Its dimensionless number: what it is, and how large here [1].
    bound
        Relative change of the results, the worst of them, if it is left out [1]; infinite
        where no bound is shown.
    included
        Whether it is computed.
    why
        The reason.
    """

    name: str
    adds: str
    number: str
    value: float
    bound: float
    included: bool
    why: str

    def to_json(self) -> dict[str, Any]:
        """The row under fixed keys; a number or bound that there is not is null."""
        return {
            name: None if isinstance(value, float) and not math.isfinite(value) else value
            for name, value in vars(self).items()
        }

    def cells(self) -> tuple[str, str, str, str, str, str]:
        """The row as it is shown."""
        applies = not math.isnan(self.value)
        value = f"{self.value:.3g}" if applies else "-"
        bound = f"{self.bound:.1e}" if self.bound < SAYS_NOTHING else "none"
        decided = "in" if self.included else "out"
        return self.name, self.number, value, bound if applies else "-", decided, self.why


@dataclass(frozen=True)
class Gate:
    """What the gate decided.

    Attributes
    ----------
    law
        The contact law of the effects included.
    rtol
        The tolerance it was decided for [1].
    error
        Bound of what the effects left out by the gate change together, the worst of the
        outputs [1].
    rows
        The effects table.
    outputs
        The results that the tolerance and the bounds apply to.
    """

    law: Law
    rtol: float
    error: float
    rows: tuple[Row, ...]
    outputs: tuple[str, ...] = OUTPUTS

    @property
    def forced_out(self) -> tuple[str, ...]:
        """Effects that the scene has and leaves out by itself."""
        return tuple(row.name for row in self.rows if row.why.startswith(FORCED_OUT))

    def lines(self) -> list[tuple[str, str, str, str, str, str]]:
        """Effect, number, value, bound, in or out, and why, to be read by people."""
        return [row.cells() for row in self.rows]

    def to_html(self) -> str:
        """The effects table for a notebook."""
        return html_table(HEADS, self.lines())

    _repr_html_ = to_html


@dataclass(frozen=True)
class _State:
    """A law at its largest radius [m]: S_1 at the place's radii, and elasticities of S_1.

    `growth` is the largest elasticity of the contact radius by Hertz' radius of the force, at
    least 1. `a` is NaN if the law ends before.
    """

    law: Law
    a: float
    place: Place
    slope: Array
    fall: float
    rise: float
    growth: float


def decide(
    model: Model, wanted: Mapping[str, Any], rtol: float, outputs: Sequence[str] = OUTPUTS
) -> Gate:
    """Take in effects until the tolerance is met.

    Parameters
    ----------
    wanted
        "auto", True or False by effect; "auto" if left out.
    rtol
        What the effects left out may change at most, relative [1].
    outputs
        The results it applies to.

    Raises
    ------
    SceneError
        If the pressure is to be solved for, or the plate to move, without a part of it; or if
        it has to move and its density is not known.
    """
    asked = {e.name for e in EFFECTS if not e.by_itself and wanted.get(e.name) is True}
    reasons = {e.name: "" if e.name in asked else e.absent(model) for e in EFFECTS}
    missing = sorted(name for name in WHOLE_PLATE if wanted.get(name) is False)
    for name in WHOLES if missing else ():
        if wanted.get(name) is True:
            raise SceneError(
                f"effects.{name}: expected true with the whole plate only, got {missing[0]} = "
                f"false; leave out effects.{missing[0]} or effects.{name}"
            )
        reasons[name] = f"it holds the whole plate, but {', '.join(missing)} is false"
    present = [effect for effect in EFFECTS if not reasons[effect.name]]
    choice = {effect.name: wanted.get(effect.name, "auto") for effect in present}
    present = [effect for effect in present if effect.by_itself]
    free = {effect.name for effect in present if choice[effect.name] is not False}
    # What comes in with an effect costs nothing there; of pressure the bounds are Hertz'.
    along = {name: with_it & free for name, with_it in WHOLES.items()}
    included = {e.name for e in present if e.forced or choice[e.name] is True}
    included |= _all(along[name] for name in included & WHOLES.keys())
    open_ = [e for e in present if e.name not in included and choice[e.name] is not False]
    while True:
        state = _state(Law(model, frozenset(included)))
        error = _error(state, open_, outputs)
        # A plate that moves leaves modes and branches out too: half the tolerance is theirs.
        if error <= (0.5 * rtol if "inertia" in included else rtol) or not open_:
            break
        worst = max(open_, key=lambda effect: _size(state, effect, outputs))
        included |= {worst.name} | along.get(worst.name, set())
        open_ = [effect for effect in open_ if effect.name not in included]
    if "inertia" in included:
        check_movable(model, asked, "viscosity" in included)
    rows = [_row(effect, state, choice, reasons, rtol, error, outputs) for effect in EFFECTS]
    return Gate(state.law, rtol, error, tuple(rows), tuple(outputs))


def _all(sets: Iterable[Collection[str]]) -> set[str]:
    """Everything in any of them."""
    return set().union(*sets)


def check_movable(model: Model, asked: Collection[str], lagging: bool) -> None:
    """Refuse a plate that has to move and cannot.

    Raises
    ------
    SceneError
        If its density is not known; if branches beyond bending are to move under a contact that
        lags, where they would lag too.
    """
    if lagging and model.inertia.branches == "all":
        raise SceneError(
            'inertia.branches: expected "A0" under a viscous contact, where what is not bending '
            'lags, got "all"; write branches = "A0", or effects.viscosity = false'
        )
    if model.density:
        return
    why = "effects.inertia = true" if "inertia" in asked else "its inertia may change the results"
    raise SceneError(
        f"plate.density: expected a density, since {why}, got none; give plate.density "
        "[kg/m^3], or effects.inertia = false for a plate without inertia"
    )


def _state(law: Law, top: float = TOP) -> _State:
    """The law at its largest radius, or at its limit if that is beyond.

    Of a plate that moves that of a plate that does not yield, and so much wider as a contact may
    become there at most.
    """
    if "inertia" in law.effects:
        stiff = replace(law, effects=law.effects - MOVED_WITH - {"inertia"})
        return replace(_state(stiff, WIDER), law=law)
    nodes = rule(NODES[0])
    with np.errstate(all="ignore"):
        a = largest_radius(law, close=NEAR)
        top = min(top * a, law.limit) if a < law.limit else law.limit
        radii = np.append(nodes.x, 1.0) * top
        shape = law.at(radii)
        # Once more without the end, where a sphere's slope may be steep: of the polynomial.
        inner, last = (Shape(*(x[part] for x in shape)) for part in (slice(-1), slice(-1, None)))
        elasticity = nodes.x * (nodes.derivative @ inner.additive) / inner.additive
        equal = np.concatenate(([0.0], radii * np.cbrt(shape.force)))
        along = _along(law, radii, shape)
    fall, rise = max(0.0, -float(np.min(elasticity))), max(0.0, float(np.max(elasticity)))
    # P goes with the cube of Hertz' radius, and dP = 2 E* a_H d delta/S.
    swelling = inner.slope / (inner.additive * np.cbrt(inner.force) ** 2)
    growth = 1.0 + MARGIN * max(0.0, float(np.max(1.0 / swelling)) - 1.0)
    place = Place(equal, a * (a / law.model.R) * float(last.depth[0]), along)
    slope = np.concatenate(([1.0], shape.additive))
    reached = a if a < law.limit else math.nan
    return _State(law, reached, place, slope, MARGIN * fall, MARGIN * rise, growth)


def _along(law: Law, radii: Array, shape: Shape) -> Along:
    """Force, indentation, stiffness and energy at the nodes and the largest radius."""
    nodes, top = rule(NODES[0]), radii[-1]
    power = (shape.force * shape.slope)[:-1]
    share = np.append(stored(NODES[0]) @ power, np.sum(nodes.weights * nodes.x**4 * power))
    unit = law.force(top, Shape(*np.ones(4))) * law.indentation(top, Shape(*np.ones(4)))
    return Along(
        law.force(radii, shape),
        law.indentation(radii, shape),
        law.stiffness(radii, shape),
        2.0 * unit * share,
        2.0 * shape.slope / shape.depth,
    )


def _bound(state: _State, effect: Effect, stretch: float = 1.0) -> Bound:
    """An effect's bound at the state's place, whose radii the sphere's elasticity may stretch."""
    with np.errstate(all="ignore"):
        found = effect.bound(state.law.model, state.place.stretched(stretch))
    if effect.name == "curvature" and "pressure" in state.law.effects:
        return found._replace(up=found.up + math.inf)  # known under Hertz' pressure alone
    if effect.name == "bending" and {"edge", "viscosity"} <= state.law.effects:
        return found._replace(up=found.up + math.inf)  # without it the edge lags too
    if isinstance(effect, PlateEffect):
        part = 1.0 / (1.0 + state.law.softness)
        return found._replace(low=part * found.low, up=part * found.up)
    return found


def _error(state: _State, effects: Sequence[Effect], outputs: Sequence[str]) -> float:
    """What leaving effects out changes together at most, the worst of the outputs."""
    if not effects:
        return 0.0
    if math.isnan(state.a):
        return math.inf
    elastic = [e for e in effects if e.name == "sphere_elasticity"]
    stretch = math.exp(_bound(state, elastic[0]).radius) if elastic else 1.0
    bounds = [_bound(state, e, 1.0 if e in elastic else stretch) for e in effects]
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


def _worst(state: _State, bound: Bound, outputs: Sequence[str]) -> float:
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
    # Viscosity's own bound, taken of this law, is widened for that of everything.
    wider = (1.0 + max(found)) ** 2
    kept = (
        _bound(state, BY_NAME["viscosity"]).results[-1] if "viscosity" in state.law.effects else 0.0
    )
    logarithms = np.log1p([*found, 0.0]) + wider * np.array(results)
    logarithms[-1] += (wider - 1.0) * kept
    # Link 18 speaks of Hertz' radius of the force, with which the contact's own may grow faster.
    logarithms[3] += (state.growth - 1.0) * math.log1p(found[3]) + state.growth * radius
    with np.errstate(over="ignore"):  # no bound, as good as
        errors = dict(zip(OUTPUTS, np.expm1(logarithms), strict=True))
    return float(max(errors[name] for name in outputs))


def _size(state: _State, effect: Effect, outputs: Sequence[str]) -> float:
    """By how much an effect alone matters: its error, or where none is shown its share of S."""
    error = _error(state, [effect], outputs)
    if math.isfinite(error):
        return error
    bound = _bound(state, effect)
    share = np.maximum(bound.low, bound.up) / np.abs(state.slope)
    most = float(np.max(share, where=np.isfinite(share), initial=0.0))
    return 10.0 + most + bound.energy + bound.results[-1]


def _price(state: _State, effect: Effect, outputs: Sequence[str]) -> float:
    """What leaving out an effect that is in would change: the law with it lies beside S_1."""
    if effect.forced or math.isnan(state.a):
        return math.inf
    if effect.name == "inertia":
        law = state.law
        state = _state(replace(law, effects=law.effects - {"inertia"}))
        return _error(state, [effect], outputs)
    bound = _bound(state, effect)
    return _worst(state, bound._replace(low=bound.up, up=bound.low), outputs)


def _row(
    effect: Effect,
    state: _State,
    choice: Mapping[str, Any],
    reasons: Mapping[str, str],
    rtol: float,
    error: float,
    outputs: Sequence[str],
) -> Row:
    """The effect's line, at the largest radius of the law decided on."""
    model, name = state.law.model, effect.name
    radius = state.law.limit if math.isnan(state.a) else state.a
    included = name in state.law.effects or not effect.by_itself
    if reasons[name]:
        return Row(name, effect.adds, effect.number, math.nan, 0.0, False, reasons[name])
    value = effect.value(model, radius)
    bound = _price(state, effect, outputs) if included else _error(state, [effect], outputs)
    if effect.forced:
        why = "always"
    elif choice[name] != "auto":
        worst = max(outputs, key=lambda output: _error(state, [effect], [output]))
        why = _forced(bool(choice[name]), bound, worst)
    elif included:
        why = f"left out it could exceed rtol = {rtol:.3g}"
    else:
        why = f"all that is left out changes {error:.1e} at most"
    return Row(name, effect.adds, effect.number, value, bound, included, why)


def _forced(included: bool, bound: float, output: str) -> str:
    """What the scene's own choice means, and in which result most."""
    if included:
        return "true in the scene"
    known = bound < SAYS_NOTHING
    price = f"up to {100 * bound:.2g} % in {output}" if known else "more than a bound can say"
    return f"{FORCED_OUT}: costs {price}"


def cost(law: Law, effect: Effect, repeats: int = 3) -> float:
    """Time [s] that a law with this effect alone takes at an impact's nodes, the least of a few.

    Of inertia what its oscillators and tables take.
    """
    a = rule(NODES[0]).x * min(law.limit, law.model.h)
    alone = Law(law.model, frozenset({"hertz", effect.name}))
    best = math.inf
    with np.errstate(all="ignore"):
        for _ in range(repeats):
            start = time.perf_counter()
            if effect.name == "inertia":
                from derivation.scene import waves

                waves.problem_of(law, 2 * waves.count_of(law))
            else:
                alone.at(a)
            best = min(best, time.perf_counter() - start)
    return best
