"""What the plate's waves and the modes of held plates are held to in the hard cases: balls."""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any

import flint
from flint import arb

from derivation.engine.formula.ball import to_ball
from derivation.plate.edge_modes.oracle import modes as held_balls
from derivation.plate.edge_modes.oracle import waves as held_wave_balls
from derivation.plate.hard.law import Given, Law, Values
from derivation.plate.waves import oracle as inertia_balls

_STEP, _DIGITS = Fraction(1, 2**40), 30
_FREE = 1e-9
"""1 + nu below which a support resists hardly: a kernel that takes 1 + nu exactly loses nothing
there, whatever the condition number of nu."""

_AT_REST = Fraction(1, 2**60)
"""For the condition of a load at rest, whose frequency does nothing."""


def _slopes(values: Values, *places: int) -> Callable[[Given, Sequence[arb]], Sequence[arb]]:
    """Of every result the sum of |x df/dx| over the arguments at these places, by differences."""

    def slopes(given: Given, _: Sequence[arb]) -> list[arb]:
        here = values(given, _DIGITS)
        totals = [arb(0)] * len(here)
        for place in places:
            moved: list[Any] = list(given)
            moved[place] = Fraction(given[place]) * (1 - _STEP)
            there = values(moved, _DIGITS)
            with flint.ctx.workprec(4 * _DIGITS):
                totals = [
                    total + abs(new - old) / to_ball(_STEP)
                    for total, new, old in zip(totals, there, here, strict=True)
                ]
        return totals

    return slopes


# --- the plate's waves


def _of_lowest(function: Callable[..., arb], root: bool = False) -> Law:
    """A number of A0 at x and nu, or its square root."""

    def values(given: Given, digits: int) -> tuple[arb]:
        found = function(*given, digits=digits)
        with flint.ctx.workprec(4 * digits + 64):
            return (found.sqrt() if root else found,)

    return Law(values, slopes=_slopes(values, 0, 1), oracle=(inertia_balls.__name__,))


def _influence(given: Given, digits: int) -> tuple[arb, ...]:
    x, kap, nu = given
    return inertia_balls.influence(x, kap, nu, digits)


def _conditions(given: Given, values: Sequence[arb]) -> list[arb]:
    """Arguments', and beyond x^2 those of p and q, as the budget's rule has them."""
    x, kap, nu = map(Fraction, given)
    load = kap or min(x**2, x**4) * _AT_REST
    found = []
    for kind, value in zip(inertia_balls.KINDS, values, strict=True):
        of_arguments, of_roots = inertia_balls.condition(x, load, nu, kind)
        found.append(abs(value) * (of_arguments + (2 * of_roots if kap > x * x else 0)))
    return found


def _of_branch(kind: str, function: Callable[..., arb], root: bool = False) -> Law:
    """Frequency or residue of a branch, counted from 0."""

    def values(given: Given, digits: int) -> tuple[arb]:
        x, nu, index = given
        found = function(x, nu, kind, int(index), digits)
        with flint.ctx.workprec(4 * digits + 64):
            return (found.sqrt() if root else found,)

    def sizes(given: Given, found: Sequence[arb]) -> tuple[arb]:
        """Residues are counted in the largest, which is among the first two."""
        x, nu, _ = given
        first, second = (values((x, nu, index), _DIGITS)[0] for index in (0, 1))
        return (abs(found[0]).max(first).max(second),)

    return Law(values, None if root else sizes, conditioned=False, oracle=(inertia_balls.__name__,))


# --- held plates


def _of_waves(edge: held_balls.Edge) -> Law:
    """A mode of a plate with a thickness, by its number; c and k2 are counted as budgets say."""

    def values(given: Given, digits: int) -> tuple[arb, ...]:
        count, eta, nu = given
        return held_wave_balls.wave(edge, int(count), eta, nu, digits)

    def sizes(_: Given, found: Sequence[arb]) -> tuple[arb, ...]:
        mode = held_wave_balls.Wave(*found)
        counted = mode._replace(k2=mode.k**2 / mode.k2, c=mode.c * (1 + mode.k))
        return tuple(abs(x) for x in counted._replace(t=abs(mode.t).max(arb(1))))

    def slopes(given: Given, found: Sequence[arb]) -> Sequence[arb]:
        if 1 + Fraction(given[2]) < _FREE:
            return _slopes(values, 1)(given, found)
        return _slopes(values, 1, 2)(given, found)

    return Law(values, sizes, slopes=slopes, oracle=(held_wave_balls.__name__,))


def _of_face(punch: bool) -> Law:
    """The loaded face, or its mean under a punch less 1, of a mode's numbers.

    Counted in the largest of its parts.
    """

    def values(given: Given, digits: int) -> tuple[arb]:
        with flint.ctx.workprec(8 * digits + 64):
            return (held_wave_balls.on_face(punch, *given),)

    def sizes(_: Given, found: Sequence[arb]) -> tuple[arb]:
        return (abs(found[0]) if punch else abs(found[0]).max(arb(1)),)

    return Law(
        values, sizes, slopes=_slopes(values, 0, 1, 2, 3), oracle=(held_wave_balls.__name__,)
    )


_FREQUENCY, _RESIDUE = inertia_balls.zero, inertia_balls.residue
WAVES: Mapping[str, Law] = {
    "bending_frequency": _of_lowest(_FREQUENCY, root=True),
    "bending_residue": _of_lowest(_RESIDUE),
    "bending_share": _of_lowest(inertia_balls.share),
    "dynamic_influence": Law(_influence, slopes=_conditions, oracle=(inertia_balls.__name__,)),
    "clamped_waves": _of_waves("clamped"),
    "supported_waves": _of_waves("supported"),
    "wave_shape": _of_face(punch=False),
    "wave_share": _of_face(punch=True),
} | {
    f"{kind}_{name}": _of_branch(kind, function, root)
    for kind in inertia_balls.KINDS
    for name, function, root in (("frequency", _FREQUENCY, True), ("residue", _RESIDUE, False))
}
"""By kernel."""
