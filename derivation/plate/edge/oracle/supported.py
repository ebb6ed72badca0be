"""Arb reference for a simple support: modes summed in balls, remainders by an integral.

With k = g or (3/2) sinc and n = lam/(lam + 2 mu), the sums of step 19 are, for N modes,

    sum k (1 + 3 n - n Q)/(j^3 J1)
        = [N modes] + (1 + 3 n) P_N - 2 n eta E_N - n sum (Q - T) k/(j^3 J1)
    sum k H/(j^2 J1)
        = [N modes] + E_N + sum (H - 1) k/(j^2 J1)

where P_N and E_N are the remainders of P = sum k/(j^3 J1), half the coefficient of z^2 in k/J0,
and of E = sum k/(j^2 J1), an integral over the imaginary axis. The last sums run over n > N.

Bounds: |k| <= 3/2, |1/J1| < sqrt(pi j/2) (`edge.theory.sums`), and for T >= 4, where
sinh T - T >= e^T/4, 0 < Q - T <= 4 T^2 e^(-T) and 0 < 1 - H <= 4 T e^(-T). There T^2 e^(-T)
decreases at least like e^(-T/2), by e^(-3 eta) from mode to mode.
"""

import math
from collections.abc import Callable
from fractions import Fraction
from functools import cache
from typing import NamedTuple

import flint
from flint import acb, arb

from derivation.engine.formula.ball import Exact, to_ball
from derivation.mathematics.bessel.oracle import j0_zero
from derivation.plate.contact.oracle.balls import ratio_of, refine_to_digits


class EdgeKernel(NamedTuple):
    """k on the real axis, k(iy), e^(-y) k(iy), and coefficients of the power series of k(iy)."""

    real: Callable[[arb], arb]
    turned: Callable[[acb], acb]
    scaled: Callable[[acb], acb]
    power: Callable[[int], flint.fmpq]


KERNELS = {
    "indentation": EdgeKernel(
        lambda y: 3 * (y.sin() - y * y.cos()) / y**3,
        lambda y: 3 * (y * y.cosh() - y.sinh()) / y**3,
        lambda y: 3 * (y - 1 + (y + 1) * (-2 * y).exp()) / (2 * y**3),
        lambda m: flint.fmpq(6 * (m + 1), math.factorial(2 * m + 3)),
    ),
    "slope": EdgeKernel(
        lambda y: 3 * y.sin() / (2 * y),
        lambda y: 3 * y.sinh() / (2 * y),
        lambda y: 3 * (1 - (-2 * y).exp()) / (4 * y),
        lambda m: flint.fmpq(3, 2 * math.factorial(2 * m + 1)),
    ),
    "point load": EdgeKernel(
        lambda _: arb(1),
        lambda _: acb(1),
        lambda y: (-y).exp(),
        lambda m: flint.fmpq(int(m == 0), 1),
    ),
}
"""Weight functions by kind; `power(m)` is the coefficient of y^(2m) in k(iy)."""
LARGE = 64
"""Least y at which the integrand is computed without growing factors."""


def edge_part(
    kind: str, a: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact, digits: int = 30
) -> arb:
    """Return X, the change of delta R/a^2, or of (R/2a) d delta/da for kind `slope`.

    Parameters
    ----------
    kind
        `indentation` or `slope`.
    a, h, b, lam, mu
        Exact numbers; 0 < a < b.
    digits
        Correct decimal digits required of the ball.

    Raises
    ------
    ValueError
        Unless 0 < a < b.
    """
    width, eta = ratio_of(a, b), ratio_of(h, b)
    thinning = Fraction(lam) / (Fraction(lam) + 2 * Fraction(mu))
    if not width < 1:
        raise ValueError(f"expected a < b, got a/b = {float(width)}")

    def compute(bits: int) -> tuple[arb]:
        bent, stretched = sums(kind, width, eta, thinning, bits)
        x, n, alpha = to_ball(eta), to_ball(thinning), to_ball(width)
        total = (1 - 2 * n * x**2) / x**3 * bent + n**2 * stretched * 8 / 3
        return (alpha / arb.pi() * total,)

    return refine_to_digits(compute, digits, f"the edge's {kind} at a/b = {float(width)}")[0]


def curvature(h: Exact, b: Exact, lam: Exact, mu: Exact, digits: int = 30) -> arb:
    """Return the coefficient of (t^2 + s^2)/h^3 in the kernel of the integral equation."""
    eta, n = ratio_of(h, b), Fraction(lam) / (Fraction(lam) + 2 * Fraction(mu))

    def compute(bits: int) -> tuple[arb]:
        bent, _ = sums("point load", Fraction(0), eta, n, bits)
        return (-3 * to_ball(support_ratio(lam, mu)) / arb.pi() * bent,)

    return refine_to_digits(compute, digits, f"a support's curvature at h/b = {float(eta)}")[0]


def support_ratio(lam: Exact, mu: Exact) -> Fraction:
    """Return (1 - nu)/(1 + nu), the factor of X for a simple support."""
    first, second = Fraction(lam), Fraction(mu)
    return (first + 2 * second) / (3 * first + 2 * second)


def sums(
    kind: str, width: Fraction, eta: Fraction, thinning: Fraction, bits: int
) -> tuple[arb, arb]:
    """Return both sums over the modes."""
    kernel = KERNELS[kind]
    count = math.ceil((0.7 * bits + 12) / (2 * math.pi * float(eta))) + 1
    spare = 3 * max(0, -math.frexp(float(width))[1]) + 4 * max(0, -math.frexp(float(eta))[1])
    # In steps, so that few tables of modes are sufficient for all calls.
    working = bits + 64 * (2 + spare // 64)
    with flint.ctx.workprec(working):
        alpha, x, n = to_ball(width), to_ball(eta), to_ball(thinning)
        bent, stretched = arb(0), arb(0)
        third, square = plain_sum(kernel, alpha), alternating_sum(kind, width, bits)
        for j, slope in modes(count, working):
            value, T = kernel.real(alpha * j) / slope, 2 * x * j
            growth = T.exp()
            cosh, sinh = (growth + 1 / growth) / 2, (growth - 1 / growth) / 2
            first, second = value / j**3, value / j**2
            bent += first * (1 + 3 * n - n * T * (cosh - 1) / (sinh - T))
            stretched += second * (cosh - 1) / (sinh + T)
            third -= first
            square -= second
        left = _rest(2 * x * (count + arb(3) / 4) * arb.pi(), x)
        bent += (1 + 3 * n) * third - 2 * n * x * square + abs(n) * left
        return bent, stretched + square + left


@cache
def modes(count: int, bits: int) -> tuple[tuple[arb, arb], ...]:
    """Return the first zeros of J0, and J1 at them."""
    terms = []
    for index in range(1, count + 1):
        j = j0_zero(index, bits + index.bit_length())
        terms.append((j, j.bessel_j(1)))
    return tuple(terms)


def _rest(T: arb, eta: arb) -> arb:
    """Return a ball that contains either last sum, T > 4: k/(j^2 |J1|) < 1.5 1.26 j^(-3/2) < 1."""
    if not T > 4:
        raise ValueError(f"expected more modes in the sum, which ends at T = {T}")
    bound = 4 * T**2 * (-T).exp() / (1 - (-3 * eta).exp())
    return arb(0, bound.abs_upper())


def plain_sum(kernel: EdgeKernel, alpha: arb) -> arb:
    """Return P: half the coefficient of z^2 in k(alpha z)/J0(z), J0 = 1 - z^2/4 + ..."""
    return (arb(kernel.power(0)) / 4 - arb(kernel.power(1)) * alpha**2) / 2


@cache
def alternating_sum(kind: str, width: Fraction, bits: int) -> arb:
    """Return E = (1/pi) int_0^oo (k(0) - k(i alpha y)/I0(y))/y^2 dy.

    From 0 to 1 by power series. From 1 on, the first term gives k(0); the part of the second
    beyond `end` is below (9/2) e^(-(1 - alpha) y)/((1 - alpha) y^(3/2)) there, because
    |k(iy)| <= (3/2) e^y and I0 >= e^y/(3 sqrt y). Without their growth, k and I0 have narrow balls
    in wide intervals, so that few intervals are needed.
    """
    kernel = KERNELS[kind]
    left = 1 - width
    end = math.ceil((0.7 * bits + 8) / float(left)) + 1
    spare = 3 * max(0, -math.frexp(float(width))[1]) + 16
    with flint.ctx.workprec(bits + spare):
        alpha, last = to_ball(width), arb(end)

        def plain(y: acb, _: bool) -> acb:
            return kernel.turned(alpha * y) / (y * y * y.bessel_i(0))

        def decaying(y: acb, _: bool) -> acb:
            fading = (-to_ball(left) * y).exp()
            return kernel.scaled(alpha * y) * fading / (y * y * y.bessel_i(0, scaled=True))

        near = acb.integral(lambda y, _: _near(kernel, alpha, y), 0, 1).real
        cut, total = 1, near + arb(kernel.power(0))
        while cut < end:  # panels of growing size: on a single one the balls are too wide
            upto = min(2 * cut, end)
            total -= acb.integral(decaying if cut >= LARGE else plain, cut, upto).real
            cut = upto
        rest = 9 * (-to_ball(left) * last).exp() / (2 * to_ball(left) * last**2 / last.sqrt())
        return (total + arb(0, rest.abs_upper())) / arb.pi()


def _near(kernel: EdgeKernel, alpha: arb, y: acb) -> acb:
    """Return (k(0) - k(i alpha y)/I0(y))/y^2 for |y| < 4, else NaN.

    It is (k(0) (I0 - 1) - (k(i alpha y) - k(0)))/(y^2 I0), with power series in the numerator.

    The coefficients of y^(2m) in both series are below 3/2 1/m!^2, and terms beyond `count`
    decrease by more than half.
    """
    size = y.abs_upper()
    if not size < 4:
        return acb("nan")
    count = 20 + flint.ctx.prec // 6
    first = kernel.power(0)
    terms = []
    for m in range(1, count):
        bessel = first * flint.fmpq(1, 4**m * math.factorial(m) ** 2)
        terms.append(arb(bessel) - arb(kernel.power(m)) * alpha ** (2 * m))
    square = y * y
    total = acb(0)
    for term in reversed(terms):
        total = total * square + term
    tail = 3 * arb(size) ** (2 * count - 2) / arb(math.factorial(count)) ** 2
    spread = arb(0, tail.abs_upper())
    return (total + acb(spread, spread)) / y.bessel_i(0)
