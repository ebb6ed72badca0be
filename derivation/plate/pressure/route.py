"""mpmath reference of the non-Hertzian contact: Galerkin's method with Hertz-like pressures.

The pressure is a sum of q_k = (1 - r^2/a^2)^(k + 1/2), that is chi = sum c_k (1 - x^2)^(k+1) with
x = t/a, and the surface condition is tested with 1, 1 - x^2, ..., (1 - x^2)^m. Everything is in
closed form: with z = a phi a mode has the integrals

    int_0^1 (1 - x^2)^n cos(z x) dx = B_n 0F1(n + 3/2, -z^2/4)

with B_n = sqrt(pi) n!/(2 Gamma(n + 3/2)), a spherical Bessel function; the half-space is given
by these B_n, and the lateral surface by a power series in the moments kappa_(2p) and (a/b)^2,
for a <= b/2. There are no quadrature nodes in the contact and no kernel N; everything is computed
with mpmath. Stiffness and slope are finite differences.
"""

import math
from fractions import Fraction
from functools import cache
from typing import NamedTuple

from mpmath import mp, mpf

from derivation.engine.oracle.agreement import RouteError
from derivation.plate.contact.route.modes import excess, mode
from derivation.plate.contact.route.moments import lateral_moments

WIDEST = 0.5
"""Largest a/b: above, too many moments would be needed."""


class RouteState(NamedTuple):
    """P R/(E* a^3), delta R/a^2 and q(0) R/(E* a) [1], E* of the contact."""

    force: mpf
    depth: mpf
    centre: mpf


def solve(
    a_ratio: Fraction,
    eta: Fraction,
    curvature: Fraction = Fraction(0),
    modulus_ratio: Fraction = Fraction(1),
    digits: int = 25,
) -> RouteState:
    """Return the contact for a/h, h/b, a/R (0 for a paraboloid) and E* over the plate's.

    Raises
    ------
    RouteError
        If the contact is too wide, or two sizes of the basis differ by more than the digits allow.
    """
    if a_ratio * eta > WIDEST:
        raise RouteError(f"a/b = {float(a_ratio * eta):.3g} is above {WIDEST}")
    size = _size(a_ratio, eta, curvature, digits)
    few, many = _solve((a_ratio, eta, curvature, modulus_ratio), (size, size + 4), digits)
    with mp.workdps(digits + 10):
        for one, other in zip(few, many, strict=True):
            if not abs(one - other) < mpf(10) ** -digits * (abs(other) + mpf(2) ** -10):
                raise RouteError(f"two bases differ by {mp.nstr(one - other, 3)}")
    return many


def derivatives(a_ratio: Fraction, eta: Fraction, digits: int = 20) -> tuple[mpf, mpf]:
    """Return dP/d delta over E* a, and (R/a) d delta/da, by fourth-order central differences."""
    step = Fraction(1, 10 ** (digits // 4 + 2))
    factors = [1 + k * step for k in (-2, -1, 1, 2)]
    states = [solve(a_ratio * f, eta, digits=2 * digits) for f in factors]
    with mp.workdps(2 * digits):
        scales = [mpf(f.numerator) / f.denominator for f in factors]
        force = [s.force * f**3 for s, f in zip(states, scales, strict=True)]
        depth = [s.depth * f**2 for s, f in zip(states, scales, strict=True)]
        rises = [8 * (y[2] - y[1]) - (y[3] - y[0]) for y in (force, depth)]
        return rises[0] / rises[1], rises[1] / (12 * mpf(step.numerator) / step.denominator)


def _size(a_ratio: Fraction, eta: Fraction, curvature: Fraction, digits: int) -> int:
    """Return the number of functions for the digits: singularities at 2 b/a - 1 and 4 i h/a.

    Errors of chi decrease with the square of the ellipse's parameter, those of its means with
    the fourth power, as in every variational method.
    """
    upright = 4 / float(a_ratio)
    rho = upright + math.hypot(1, upright)
    least = min(2 / float(a_ratio * eta) - 1, 1 / float(curvature) if curvature else math.inf)
    rho = min(rho, least + math.sqrt(least**2 - 1))
    return math.ceil(1.3 * digits * math.log(10) / (4 * math.log(rho))) + 7


def _number(x: Fraction) -> mpf:
    return mpf(x.numerator) / x.denominator


@cache
def _beta(n: int, dps: int) -> mpf:
    """Return B_n."""
    with mp.workdps(dps):
        return mp.sqrt(mp.pi) * mp.factorial(n) / (2 * mp.gamma(n + mpf(3) / 2))


def _cosine_means(z: mpf, count: int) -> list[mpf]:
    """Return int_0^1 (1 - x^2)^n cos(z x) dx for n = 0 ... count - 1.

    z^2 q_(n+1) = 2 (n+1) [(2n+1) q_n - 2n q_(n-1)], upwards while n < z and downwards from two
    power series beyond: in both directions the required solution does not decay.
    """
    if z >= count:
        transforms = [mp.sin(z) / z, 2 * (mp.sin(z) - z * mp.cos(z)) / z**3]
        for n in range(1, count - 1):
            transforms.append(
                2 * (n + 1) * ((2 * n + 1) * transforms[n] - 2 * n * transforms[n - 1]) / z**2
            )
        return transforms
    square = -z * z / 4
    transforms = [
        _beta(n, mp.dps) * mp.hyp0f1(n + mpf(3) / 2, square) for n in (count - 1, count - 2)
    ]
    for n in range(count - 2, 0, -1):
        transforms.append(
            ((2 * n + 1) * transforms[-1] - z * z * transforms[-2] / (2 * (n + 1))) / (2 * n)
        )
    return transforms[::-1]


def _modal(eta: mpf, alpha: mpf, count: int, goal: int) -> list[list[mpf]]:
    """Return sum (4/pi) alpha (G - 1)/(j J1^2) q_k(alpha j) q_l(alpha j) over the modes."""
    rows, weights = [], []
    n, T = 1, mpf(0)
    while goal * mp.log(10) + 2 * mp.log(2 + T) > 2 * T:
        zero, weight = mode(n, mp.dps)
        T = 2 * eta * zero
        rows.append(_cosine_means(alpha * zero, count))
        weights.append(4 / mp.pi * alpha * weight * excess(T))
        n += 1
    columns = list(zip(*rows, strict=True))
    shared = [[w * q for w, q in zip(weights, column, strict=True)] for column in columns]
    return [[mp.fdot(one, other) for other in columns] for one in shared]


def _lateral(alpha: mpf, count: int, goal: int) -> list[list[mpf]]:
    """Return (4/pi^2) alpha int K0/I0 times the same with imaginary arguments, a power series.

    0F1(a, z) 0F1(b, z) = sum (a + b - 1 + p)_p z^p/(p! (a)_p (b)_p), z = (alpha y)^2/4.
    """
    terms = math.ceil(goal / (-2 * math.log10(float(alpha)))) + 3
    factor = 4 / mp.pi**2 * alpha
    moments = [
        factor * (alpha * alpha / 4) ** p * kappa
        for p, kappa in enumerate(lateral_moments(terms, mp.dps))
    ]
    matrix = [[mpf(0)] * count for _ in range(count)]
    for k in range(count):
        for n in range(k + 1):
            coefficient = _beta(k, mp.dps) * _beta(n, mp.dps)
            coefficients = []
            for p in range(terms):
                coefficients.append(coefficient)
                s = k + n + 2 + p
                over = (p + 1) * (k + p + mpf(3) / 2) * (n + p + mpf(3) / 2) * s
                coefficient *= (s + p) * (s + p + 1) / over
            matrix[k][n] = matrix[n][k] = mp.fdot(moments, coefficients)
    return matrix


def _profile(test: int, curvature: mpf, goal: int) -> mpf:
    """Return int_0^1 (1 - x^2)^n f R/a^2 dx, with artanh as a power series."""
    total, power, p = mpf(0), mpf(1), 0
    while True:
        # int (1 - x^2)^n x^(2p+2) dx is half a Beta function.
        total += power / (2 * p + 1) * mp.beta(p + mpf(3) / 2, test + 1) / 2
        power *= curvature**2
        p += 1
        if power < mpf(10) ** -goal:
            return total


def _solve(
    case: tuple[Fraction, Fraction, Fraction, Fraction], sizes: tuple[int, ...], digits: int
) -> list[RouteState]:
    """Return the contact for each size of the basis.

    The matrices are as ill-conditioned as for Bernstein's powers.
    """
    a_ratio, eta, curvature, modulus_ratio = case
    most = max(sizes)
    goal = digits + 10 + most + math.ceil(max(0.0, -2 * math.log10(float(eta))))
    with mp.workdps(goal + most):
        alpha, part = _number(a_ratio * eta), _number(modulus_ratio)
        modal = _modal(_number(eta), alpha, most + 1, goal)
        lateral = _lateral(alpha, most + 1, goal)
        half = [_beta(n, mp.dps) for n in range(2 * most + 2)]
        sides = [_profile(n, _number(curvature), goal) for n in range(most + 1)]
        states = []
        for size in sizes:
            matrix = mp.zeros(size + 1)
            for n in range(size + 1):
                for k in range(size):
                    matrix[n, k] = half[n + k + 1] + part * (modal[n][k + 1] - lateral[n][k + 1])
                matrix[n, size] = -half[n]
            solution = mp.lu_solve(matrix, mp.matrix([-x for x in sides[: size + 1]]))
            chi = [solution[k] for k in range(size)]
            force = mp.fsum(c * half[k + 1] for k, c in enumerate(chi))
            centre = mp.fsum(2 * (k + 1) * c * half[k] for k, c in enumerate(chi))
            states.append(RouteState(2 * force, solution[size], centre / mp.pi))
        return states
