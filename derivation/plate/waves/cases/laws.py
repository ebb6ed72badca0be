"""Arb references of the plate's waves for the hard cases."""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any

import flint
from flint import arb

from derivation.engine.formula.ball import to_ball
from derivation.engine.measure.suite import Given, HardLaw, Values
from derivation.plate.waves import oracle as inertia_balls

_STEP, _DIGITS = Fraction(1, 2**40), 30
_STATIC_KAP = Fraction(1, 2**60)
"""kap over min(x^2, x^4) for condition numbers of a static load, where it has no effect."""


def differences(values: Values, *indices: int) -> Callable[[Given, Sequence[arb]], Sequence[arb]]:
    """Return for each result the sum of |x df/dx| over these arguments, by differences."""

    def slopes(given: Given, _: Sequence[arb]) -> list[arb]:
        here = values(given, _DIGITS)
        totals = [arb(0)] * len(here)
        for index in indices:
            moved: list[Any] = list(given)
            moved[index] = Fraction(given[index]) * (1 - _STEP)
            changed = values(moved, _DIGITS)
            with flint.ctx.workprec(4 * _DIGITS):
                totals = [
                    total + abs(new - old) / to_ball(_STEP)
                    for total, new, old in zip(totals, changed, here, strict=True)
                ]
        return totals

    return slopes


# --- the plate's waves


def _of_lowest(function: Callable[..., arb], root: bool = False) -> HardLaw:
    """Return the reference of a quantity of A0 at x and nu, or of its square root."""

    def values(given: Given, digits: int) -> tuple[arb]:
        value = function(*given, digits=digits)
        with flint.ctx.workprec(4 * digits + 64):
            return (value.sqrt() if root else value,)

    return HardLaw(values, slopes=differences(values, 0, 1), oracle=(inertia_balls.__name__,))


def _influence(given: Given, digits: int) -> tuple[arb, ...]:
    x, kap, nu = given
    return inertia_balls.influence(x, kap, nu, digits)


def _conditions(given: Given, values: Sequence[arb]) -> list[arb]:
    """Return condition numbers of the arguments and, above x^2, of p and q, as budgeted."""
    x, kap, nu = map(Fraction, given)
    load = kap or min(x**2, x**4) * _STATIC_KAP
    residuals = []
    for kind, value in zip(inertia_balls.KINDS, values, strict=True):
        of_arguments, of_roots = inertia_balls.condition(x, load, nu, kind)
        residuals.append(abs(value) * (of_arguments + (2 * of_roots if kap > x * x else 0)))
    return residuals


def _of_branch(kind: str, function: Callable[..., arb], root: bool = False) -> HardLaw:
    """Return the reference of a branch's frequency or residue; branches are counted from 0."""

    def values(given: Given, digits: int) -> tuple[arb]:
        x, nu, index = given
        value = function(x, nu, kind, int(index), digits)
        with flint.ctx.workprec(4 * digits + 64):
            return (value.sqrt() if root else value,)

    def sizes(given: Given, wave_values: Sequence[arb]) -> tuple[arb]:
        """Return residues relative to the largest, which is among the first two."""
        x, nu, _ = given
        first, second = (values((x, nu, index), _DIGITS)[0] for index in (0, 1))
        return (abs(wave_values[0]).max(first).max(second),)

    return HardLaw(
        values, None if root else sizes, conditioned=False, oracle=(inertia_balls.__name__,)
    )


_FREQUENCY, _RESIDUE = inertia_balls.zero, inertia_balls.residue
LAWS: Mapping[str, HardLaw] = {
    "bending_frequency": _of_lowest(_FREQUENCY, root=True),
    "bending_residue": _of_lowest(_RESIDUE),
    "bending_fraction": _of_lowest(inertia_balls.fraction),
    "dynamic_influence": HardLaw(
        _influence, slopes=_conditions, results=2, oracle=(inertia_balls.__name__,)
    ),
} | {
    f"{kind}_{name}": _of_branch(kind, function, root)
    for kind in inertia_balls.KINDS
    for name, function, root in (("frequency", _FREQUENCY, True), ("residue", _RESIDUE, False))
}
"""References by function."""
