"""Switch points of the residues of the plate's branches, located with Arb."""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import NamedTuple

import flint
from flint import arb

from derivation.engine.formula.ball import Exact, to_ball
from derivation.engine.measure.neighbours import nearest_root
from derivation.plate.edge_modes.oracle import modes as mode_balls
from derivation.plate.edge_modes.oracle import waves as wave_balls
from derivation.plate.waves import oracle as inertia_balls
from generated.edge_mode_numbers import START
from generated.wave_numbers import CLOSE

_DIGITS, _BITS = 25, 128


class Both(NamedTuple):
    """Sizes of cosh p, sinh p, cosh q and sinh q, over e^p and e^q where real; p^2 and q^2."""

    cosh_p: arb
    sinh_p: arb
    cosh_q: arb
    sinh_q: arb
    level_p: arb
    level_q: arb


@dataclass(frozen=True)
class Crossing:
    """A switch point of a residue.

    Parameters
    ----------
    kind
        Parity of the branch.
    value
        Function that changes its sign there.
    nu, index
        Poisson's ratio, and the index of the branch that is followed.
    low, high
        Wave numbers on either side.
    """

    kind: str
    value: Callable[[Both], arb]
    nu: float
    index: int
    low: float
    high: float


def _direction(of: Both) -> arb:
    """Return the smaller of both sinh over the smaller of both cosh, minus 1."""
    return of.sinh_p.min(of.sinh_q) - of.cosh_p.min(of.cosh_q)


def _apart(of: Both) -> arb:
    return of.cosh_p - of.cosh_q


def _lift(of: Both) -> arb:
    """Return |p sinh p| - |sinh(q)/q|."""
    return of.sinh_p * abs(of.level_p).sqrt() - of.sinh_q / abs(of.level_q).sqrt()


_BENT, _STRETCHED = inertia_balls.KINDS
CROSSINGS = {
    "the smaller sinh is as small as the smaller cosh, in bending":
        Crossing(_BENT, _direction, 0.3, 1, 1.15, 1.2),
    "the smaller sinh is as small as the smaller cosh, in extension":
        Crossing(_STRETCHED, _direction, 0.3, 1, 1.1, 1.15),
    "cosh p is as small as cosh q": Crossing(_BENT, _apart, -0.2, 1, 0.83, 0.89),
    "p sinh p is as small as sinh(q)/q": Crossing(_STRETCHED, _lift, -0.2, 1, 5.1, 5.2),
    "p^2 is small, real p":
        Crossing(_BENT, lambda of: of.level_p - arb(CLOSE), 0.3, 1, 1.8, 1.85),
    "p^2 is small, imaginary p":
        Crossing(_BENT, lambda of: of.level_p + arb(CLOSE), 0.3, 1, 1.4, 1.45),
    "p is neither real nor imaginary": Crossing(_BENT, lambda of: of.level_p, 0.3, 1, 1.5, 1.7),
    "q is neither real nor imaginary":
        Crossing(_STRETCHED, lambda of: of.level_q, 0.3, 0, 3.25, 3.45),
    "q^2 is small, real q":
        Crossing(_STRETCHED, lambda of: of.level_q - arb(CLOSE), 0.3, 0, 3.4, 3.6),
    "q^2 is small, imaginary q":
        Crossing(_STRETCHED, lambda of: of.level_q + arb(CLOSE), 0.3, 0, 0.36, 0.38),
}  # fmt: skip
"""Switch points by description."""


@cache
def crossing(name: str) -> float:
    """Return the double nearest to a switch point of `CROSSINGS`."""
    of = CROSSINGS[name]
    return nearest_root(lambda x: _value(of, x), of.low, of.high)


@cache
def partner_crossing(edge: mode_balls.Edge, n: int, nu: float) -> float:
    """Return the double nearest to h/b at which k2 of a mode reaches the series of I0."""

    def excess(eta: Exact) -> arb:
        return wave_balls.wave(edge, n, eta, nu, _DIGITS).k2 - arb(START)

    return nearest_root(excess, 0.012, 0.018)


def _value(of: Crossing, x: Exact) -> arb:
    kap = inertia_balls.zero(x, of.nu, of.kind, of.index, _DIGITS)
    with flint.ctx.workprec(_BITS):
        square, ratio = to_ball(x) ** 2, Fraction(of.nu)
        level = square - to_ball((1 - 2 * ratio) / (2 * (1 - ratio))) * kap
        other = square - kap
        return of.value(Both(*_sizes(level), *_sizes(other), level, other))


def _sizes(level: arb) -> tuple[arb, arb]:
    root = abs(level).sqrt()
    if level > 0:
        fading = (-2 * root).exp()
        return (1 + fading) / 2, (1 - fading) / 2
    return abs(root.cos()), abs(root.sin())
