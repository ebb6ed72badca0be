"""Arb reference of an impact's sensitivities, and the effect of rounding a scene on them.

Every result is a product of powers of the scene's numbers times f(Y, eta), Y being the energy
number and eta = h/b, so that its sensitivity to x is own_x + e_x f_Y + q_x f_eta, with the theory's
exponents and logarithmic derivatives of f. They are computed from differences by v0, because Y is
proportional to v0^2, and by b, which appears only in eta. Richardson extrapolation of two steps
leaves an error of the fourth power of the step. Its correction, with a margin, is added to the
radius: an estimate, not a proof.
"""

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import cache
from typing import Any, NamedTuple

import flint
from flint import arb

from derivation.engine.formula.ball import to_ball
from derivation.plate.impact.oracle import impact as contact_impact
from derivation.plate.impact.theory.sensitivity import RESULTS, exponents

_SPARE = 5
_SPEED, _RADIUS = 2, 4
"""Positions of v0 and b among a scene's numbers."""
_STEP, _STEP_DIGITS = Fraction(1, 2**20), 30
"""Step of second differences, which need only a few digits."""


def logarithmic(
    results: Callable[[Fraction], Sequence[arb]],
    step: Fraction,
    bits: int,
    floor: float,
) -> tuple[arb, ...]:
    """Return d log(result)/d log(parameter), from results as functions of the parameter's factor.

    Parameters
    ----------
    results
        Function that returns balls for a factor, with digits sufficient for differences of this
        step.
    step
        Step of the differences.
    bits
        Precision of the differences.
    floor
        Smallest radius added.
    """
    rows = []
    for size in (step, 2 * step):
        upper, lower = results(1 + size), results(1 - size)
        with flint.ctx.workprec(bits):
            rows.append(
                [(u / v).log() / (2 * to_ball(size)) for u, v in zip(upper, lower, strict=True)]
            )
    with flint.ctx.workprec(bits):
        return tuple(
            near + (near - far) / 3 + arb(0, floor + 1e-8 * float(abs(near - far)))
            for near, far in zip(*rows, strict=True)
        )


class _ModulusExponents(NamedTuple):
    """d log E*/d log lam, d log E*/d log mu, and d/dlog lam of the former."""

    lam: Fraction
    mu: Fraction
    bend: Fraction


def impact_sensitivities(scene: Sequence[Any], digits: int) -> tuple[arb, ...]:
    """Return logarithmic derivatives of four results with respect to seven parameters, row by row.

    The step of the differences depends on the digits, because the extrapolation error is its fourth
    power.

    Parameters
    ----------
    scene
        R, m, v0, h, b, lam, mu: exact numbers.
    digits
        Number of decimal places.
    """
    bits = 8 * digits + 64
    by_speed, by_radius = (_by(scene, place, digits, bits) for place in (_SPEED, _RADIUS))
    of_modulus, values = _modulus_exponents(scene), list[arb]()
    with flint.ctx.workprec(bits):
        for rows, speed, radius in zip(_exponents(), by_speed, by_radius, strict=True):
            *lengths, modulus = (own + e * speed / 2 - q * radius for own, e, q in rows)
            values += [
                *lengths,
                modulus * to_ball(of_modulus.lam),
                modulus * to_ball(of_modulus.mu),
            ]
    return tuple(values)


def rounding(scene: Sequence[Any], values: Sequence[arb]) -> list[arb]:
    """Return, for each sensitivity in `values`, the sum of |x d/dx| over the scene's numbers x."""
    of_modulus, roundings = _modulus_exponents(scene), list[arb]()
    lam, mu, bend = map(to_ball, of_modulus)
    with flint.ctx.workprec(4 * _STEP_DIGITS):
        for number, (rows, (YY, Y_eta, eta_eta)) in enumerate(
            zip(_exponents(), _curvatures(_rounded_scene(scene)), strict=True)
        ):
            changes = [
                [e * (x * YY + y * Y_eta) + q * (x * Y_eta + y * eta_eta) for _, x, y in rows]
                for _, e, q in rows
            ]
            # E* is the last: lam and mu act only through it.
            spread = [[*row[:-1], row[-1] * lam, row[-1] * mu] for row in changes]
            modulus = sum(values[7 * number + 5 : 7 * number + 7], arb(0))
            own = [*[arb(0)] * 5, modulus * bend, -modulus * bend]
            whole = spread.pop()
            spread += [[x * lam + y for x, y in zip(whole, own, strict=True)]]
            spread += [[x * mu - y for x, y in zip(whole, own, strict=True)]]
            roundings += [sum(map(abs, row), arb(0)) for row in spread]
    return roundings


def _modulus_exponents(scene: Sequence[Any]) -> _ModulusExponents:
    lam, mu = map(Fraction, scene[5:])
    by_lam = lam * mu / ((lam + mu) * (lam + 2 * mu))
    bend = by_lam * (1 - lam / (lam + mu) - lam / (lam + 2 * mu))
    return _ModulusExponents(by_lam, 1 - by_lam, bend)


def _exponents() -> Iterator[list[tuple[arb, ...]]]:
    """Return exponents of R, m, v0, h, b, E* for every result: its own, that of Y, of eta."""
    table = exponents()
    for name in RESULTS:
        rows = zip(table[name], table["energy"], table["eta"], strict=True)
        yield [tuple(to_ball(Fraction(int(x.p), int(x.q))) for x in row) for row in rows]


def _results(scene: Sequence[Any], speed: Fraction, radius: Fraction, digits: int) -> Any:
    """Return the impact with v0 and b multiplied by these factors."""
    moved = [Fraction(x) for x in scene]
    moved[_SPEED] *= speed
    moved[_RADIUS] *= radius
    R, m, v0, h, b, lam, mu = moved
    return contact_impact.impact(R, m, v0, h, b, lam, mu, digits)


def _by(scene: Sequence[Any], place: int, digits: int, bits: int) -> tuple[arb, ...]:
    """Return the logarithmic derivatives of every result with respect to v0 or b."""
    halvings = digits + 3 * _SPARE
    wanted, one = digits + halvings // 3 + _SPARE, Fraction(1)

    def results(factor: Fraction) -> Sequence[arb]:
        pair = (factor, one) if place == _SPEED else (one, factor)
        return tuple(_results(scene, *pair, wanted))

    return logarithmic(results, Fraction(1, 2**halvings), bits, 10.0**-digits)


def _rounded_scene(scene: Sequence[Any]) -> tuple[float, ...]:
    """Return the scene to ten digits, sufficient for tolerances, so that neighbours share them."""
    return tuple(float(f"{float(x):.10g}") for x in scene)


@cache
def _curvatures(scene: tuple[float, ...]) -> list[tuple[arb, arb, arb]]:
    """Return second derivatives of log f for every result: by Y twice, Y and eta, eta twice."""
    steps = (1 / (1 + _STEP), Fraction(1), 1 + _STEP)  # logarithms at equally spaced factors
    grid = [[_results(scene, v, b, _STEP_DIGITS) for b in steps] for v in steps]
    rows = []
    for number in range(len(RESULTS)):
        f = [[of[number].log() for of in row] for row in grid]
        square = to_ball(_STEP) ** 2
        by_speed = (f[2][1] - 2 * f[1][1] + f[0][1]) / square
        by_radius = (f[1][2] - 2 * f[1][1] + f[1][0]) / square
        mixed = (f[2][2] - f[2][0] - f[0][2] + f[0][0]) / (4 * square)
        rows.append((by_speed / 4, -mixed / 2, by_radius))
    return rows
