"""Arb reference of the non-Hertzian contact: Nystroem's method in balls, without splitting.

    chi(t) + int_0^a N(t, s) chi(s) ds = (E*/pi) (delta - f(t)),   chi(a) = 0

with N from the sum over the modes and the integral of the lateral surface. The balls contain all
rounding errors and the remainder of the modal sum. They do not contain the errors of collocation
and of the trapezoidal rule, which are estimated by repeating the computation with more nodes and
finer steps: ten times the difference is added to the radius. This is an estimate by geometric
convergence, not a proof.
"""

import math
from collections.abc import Sequence
from fractions import Fraction
from functools import cache
from typing import NamedTuple

import flint
from flint import arb, arb_mat

from derivation.engine.formula.ball import LOG2_10, Exact, PrecisionError, to_ball
from derivation.plate.contact.oracle.points import mode_points

MARGIN = 10
"""Added radius divided by the difference of two resolutions."""
_SPARE = 40
_Column = list[arb]


class PressureState(NamedTuple):
    """A contact in units of a, R and the contact's E*."""

    force: arb
    """P R/(E* a^3) [1], 4/3 with Hertz."""
    depth: arb
    """delta R/a^2 [1], 1 with Hertz."""
    stiffness: arb
    """dP/d delta/(E* a) [1], 2 with Hertz."""
    slope: arb
    """(R/a) d delta/da [1], 2 with Hertz."""
    centre: arb
    """q(0) R/(E* a) [1], 2/pi with Hertz."""
    pressures: tuple[arb, ...]
    """q R/(E* a) [1] at the requested points."""


class Case(NamedTuple):
    """A contact: a/h, h/b, a/R (0 for a paraboloid), E* of the contact over the plate's [1]."""

    a_ratio: Fraction
    eta: Fraction
    curvature: Fraction = Fraction(0)
    modulus_ratio: Fraction = Fraction(1)
    places: tuple[Fraction, ...] = ()
    """r/a < 1 at which the pressure is requested."""


def case(
    a: Exact,
    h: Exact,
    b: Exact,
    R: Exact = 0,
    modulus_ratio: Exact = 1,
    places: Sequence[Exact] = (),
) -> Case:
    """Return the case of the given lengths; R = 0 stands for a paraboloid.

    Raises
    ------
    ValueError
        Unless 0 < a < b, h > 0, and a < R if R is given.
    """
    if not (0 < a < b and h > 0 and (R == 0 or a < R)):
        raise ValueError(f"expected 0 < a < b, h > 0, a < R, got a={a}, h={h}, b={b}, R={R}")
    a, h, b = Fraction(a), Fraction(h), Fraction(b)
    curvature = a / Fraction(R) if R else Fraction(0)
    return Case(
        a / h, h / b, curvature, Fraction(modulus_ratio), tuple(Fraction(x) for x in places)
    )


def solve(case: Case, digits: int = 25) -> PressureState:
    """Return the contact, each result with a relative radius below 10^-digits.

    Raises
    ------
    PrecisionError
        If that is not reached, which happens close to the plate's edge.
    """
    count, step = _resolution(case, digits)
    bits = int(digits * LOG2_10) + _SPARE + _lost(case)
    coarse, fine = (
        _solve(case, n, fineness, bits)
        for n, fineness in ((count, step), (count + 8, step * Fraction(8, 7)))
    )
    with flint.ctx.workprec(bits):
        state = [_wider(x, y, digits) for x, y in zip(coarse[:5], fine[:5], strict=True)]
        pressures = zip(coarse.pressures, fine.pressures, strict=True)
        force, depth, stiffness, slope, centre = state
        values = tuple(_wider(x, y, digits) for x, y in pressures)
        return PressureState(force, depth, stiffness, slope, centre, values)


def _wider(coarse: arb, fine: arb, digits: int) -> arb:
    ball = fine + arb(0, (MARGIN * abs(fine - coarse)).upper())
    # Where the pressure almost vanishes its relative radius is not used.
    if not ball.rad() < arb(10) ** -digits * (abs(fine) + arb(2) ** -10):
        raise PrecisionError(f"two resolutions of the contact differ by {abs(fine - coarse)}")
    return ball


def _resolution(case: Case, digits: int) -> tuple[int, Fraction]:
    """Return numbers of nodes on (0, a) and of trapezoids per unit for the requested digits.

    The kernel is singular at t + s = 2 b and |t +- s| = 4 i h; the even rule's error falls with
    the fourth power of the ellipse's parameter per node. The trapezoids' strip is 1.2 wide.
    """
    beyond = 2 / float(case.a_ratio * case.eta) - 1
    upright = 4 / float(case.a_ratio)
    sphere = 1 / float(case.curvature) if case.curvature else math.inf
    least = min(beyond, sphere)
    rho = min(least + math.sqrt(least**2 - 1), upright + math.hypot(1, upright))
    need = digits * math.log(10)
    return math.ceil(1.1 * need / (4 * math.log(rho))) + 6, Fraction(math.ceil(need / 7.5) + 2)


def _lost(case: Case) -> int:
    """Return bits lost to the thin plate's large constant kernel, and near loss of contact."""
    return max(0, math.ceil(-2 * math.log2(float(case.eta)))) + 24


@cache
def _rule(count: int, bits: int) -> tuple[_Column, _Column]:
    """Return positive nodes of the even rule, and weights of int_0^1."""
    with flint.ctx.workprec(bits):
        pairs = [arb.legendre_p_root(2 * count, i, weight=True) for i in range(count)]
        return [x for x, _ in pairs], [w for _, w in pairs]


class _Waves(NamedTuple):
    """a k(x a/b)/b = sum weight cos(rate x), x = t/a; `lateral` rates stand for imaginary ones.

    Their cosines are divided by e^y and their weights multiplied by e^(2y), `fades` being e^-y:
    sums of products in fixed point keep the digits of the largest term only.
    """

    rates: _Column
    weights: _Column
    lateral_rates: _Column
    lateral_weights: _Column
    fades: _Column
    rest: arb


def _waves(case: Case, fineness: Fraction, bits: int) -> _Waves:
    alpha = to_ball(case.a_ratio * case.eta)
    pi = arb.pi()
    factor = alpha * to_ball(case.modulus_ratio)
    modes = mode_points(case.eta, bits - _SPARE // 2, bits)
    lateral_rates, lateral_weights, fades = [], [], []
    first, last = _span(case, bits)
    for index in range(math.floor(first * fineness), math.ceil(last * fineness) + 1):
        u = arb(index) / to_ball(fineness)
        fade = (-u).exp()
        y = (u - fade).exp().mid()
        lateral_rates.append(alpha * y)
        fades.append((-y).exp())
        with flint.ctx.workprec(bits + 8 + 3 * math.ceil(float(y))):  # K0 cancels like e^(2y)
            bessel = y.bessel_k(arb(0)) / y.bessel_i(arb(0)) / (-2 * y).exp()
        lateral_weights.append(-4 * factor / pi**2 * y * (1 + fade) / to_ball(fineness) * bessel)
    return _Waves(
        [alpha * j for j in modes.places],
        [4 * factor / pi * q for q in modes.weights],
        lateral_rates,
        lateral_weights,
        fades,
        arb(0, (4 * factor / pi * modes.rest).upper()),
    )


def _span(case: Case, bits: int) -> tuple[float, float]:
    """Return the u at which y = exp(u - e^-u) is 2^-bits, and where e^(-2 (1 - alpha) y) is."""
    decay = bits * math.log(2)
    return -math.log(decay + 5), math.log(decay / (2 * float(1 - case.a_ratio * case.eta)) + 5)


def _cosines(waves: _Waves, x: arb) -> _Column:
    lateral = zip(waves.lateral_rates, waves.fades, strict=True)
    return [(r * x).cos() for r in waves.rates] + [(r * x).cosh() * fade for r, fade in lateral]


def _slopes(waves: _Waves, x: arb) -> _Column:
    """Return -d/dx of the same, divided by x."""
    turning = [r * r * (r * x).sinc() for r in waves.rates]
    lateral = zip(waves.lateral_rates, waves.fades, strict=True)
    rising = [-r * (r * x).sinh() / x * fade for r, fade in lateral]
    return turning + rising


def _table(rows: Sequence[_Column]) -> arb_mat:
    return arb_mat(len(rows), len(rows[0]), [x for row in rows for x in row])


def _solve(case: Case, count: int, fineness: Fraction, bits: int) -> PressureState:
    """Solve at one resolution; the balls contain rounding and the modes' remainder alone."""
    with flint.ctx.workprec(bits):
        x, w = _rule(count, bits)
        waves = _waves(case, fineness, bits)
        kernel_weights = waves.weights + waves.lateral_weights
        rows = [_cosines(waves, t) for t in [*x, arb(1)]]
        near = _table(rows[:-1]).transpose()
        kernel = _table([_times(row, kernel_weights) for row in rows]) * near
        matrix = arb_mat(count, count)
        for i in range(count):
            for j in range(count):
                matrix[i, j] = (kernel[i, j] + waves.rest) * w[j] + (1 if i == j else 0)
        curvature = to_ball(case.curvature)
        sides = _table([[arb(1), _profile(t, curvature)[0]] for t in x])
        solution = matrix.solve(sides)
        psi, omega = ([solution[i, k] for i in range(count)] for k in (0, 1))
        ends = []
        for column, side in ((psi, arb(1)), (omega, _profile(arb(1), curvature)[0])):
            row = [(kernel[count, j] + waves.rest) * w[j] for j in range(count)]
            ends.append(side - _dot(row, column))
        depth = ends[1] / ends[0]
        chi = [depth * p - o for p, o in zip(psi, omega, strict=True)]
        weighted = _times(chi, w)
        # int_0^1 chi cos(rate x) dx, with the kernel's weights, determines chi'.
        transform = [
            value[0] * weight
            for value, weight in zip(
                (near * _table([[c] for c in weighted])).tolist(), kernel_weights, strict=True
            )
        ]

        def bend(t: arb) -> arb:
            """Return -chi'(x)/x."""
            return _profile(t, curvature)[1] - _dot(_slopes(waves, t), transform)

        def pressure(place: Fraction) -> arb:
            ratio = to_ball(place)
            gap = 1 - ratio * ratio
            values = [bend((ratio**2 + gap * u * u).sqrt()) for u in x]
            return gap.sqrt() * _dot(values, w) / arb.pi()

        flat = _dot(psi, w)
        return PressureState(
            2 * _dot(chi, w),
            depth,
            2 * flat,
            bend(arb(1)) / ends[0],
            pressure(Fraction(0)),
            tuple(pressure(place) for place in case.places),
        )


def _dot(left: _Column, right: _Column) -> arb:
    return sum((a * b for a, b in zip(left, right, strict=True)), arb(0))


def _times(left: _Column, right: _Column) -> _Column:
    return [a * b for a, b in zip(left, right, strict=True)]


def _profile(x: arb, curvature: arb) -> tuple[arb, arb]:
    """Return f R/a^2 and its slope with respect to x divided by x."""
    if curvature == 0:
        return x * x, arb(2)
    y = curvature * x
    arctanh_ratio = y.atanh() / y
    return x * x * arctanh_ratio, arctanh_ratio + 1 / (1 - y * y)
