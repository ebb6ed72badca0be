"""Arb reference of the contact law: indentation, stiffness and contact radius in ball arithmetic.

With alpha = a/b, eta = h/b and L of `sums`, where the modes are not truncated,

    delta = (a^2/R) (1 + 8 alpha/(3 pi) L[hertz]),
    d delta/da = (2 a/R) (1 + 4 alpha/pi L[sinc]).

Arguments are exact: a double stands for its binary fraction. The law is defined for a < b only;
otherwise the functions of this module raise an error.
"""

import math
from collections.abc import Callable
from fractions import Fraction

import flint
from flint import acb, arb

from derivation.engine.formula.ball import LOG2_10, Exact, PrecisionError, to_ball
from derivation.plate.contact.oracle.sums import (
    COEFFICIENTS,
    Weight,
    excess,
    functional,
    plate_excess,
)

_STEP = 64
"""Precisions are multiples of this many bits, so that few sets of nodes are needed."""

_SPARE = 40
_POINT_BITS = 32
"""Relative accuracy above which a ball is evaluated like a point."""
_ATTEMPTS = 8


def refine_to_digits(
    compute: Callable[[int], tuple[arb, ...]], digits: int, what: str
) -> tuple[arb, ...]:
    """Compute with increasing precision until every ball's relative radius is below 10^-digits.

    Raises
    ------
    PrecisionError
        If that radius is not reached, as for a value that is exactly zero.
    """
    target = math.ceil(digits * LOG2_10) + 1
    bits = _STEP * math.ceil((target + _SPARE) / _STEP)
    for _ in range(_ATTEMPTS):
        with flint.ctx.workprec(bits):
            balls = compute(bits)
        if all(ball.is_finite() and ball.rel_accuracy_bits() >= target for ball in balls):
            return balls
        bits += _STEP
    raise PrecisionError(f"no {digits} digits of {what} within {bits} bits")


def ratio_of(length: Exact, b: Exact) -> Fraction:
    """Return the exact quotient of two lengths."""
    if not (length > 0 and b > 0):
        raise ValueError(f"lengths are positive, got {length} and {b}")
    return Fraction(length) / Fraction(b)


def modulus(lam: Exact, mu: Exact) -> arb:
    """Return E* = 4 mu (lam + mu)/(lam + 2 mu)."""
    first, second = to_ball(lam), to_ball(mu)
    return 4 * second * (first + second) / (first + 2 * second)


# --- constants


def scaled_i0(y: acb) -> acb:
    """Return e^-y I0(y) for a ball of arguments, which may be wide.

    f(y) = e^-y I0(y) = 1/pi int_0^pi e^(-y (1 - cos t)) dt. Hence |f'(y)| is at most
    1/pi int_0^pi (1 - cos t) e^(-x (1 - cos t)) dt = e^-x (I0(x) - I1(x)), x = Re y, which
    decreases. The value in the middle of a wide ball, with this bound on the change within the
    ball, is far narrower than a sum of powers, so that integrals need a twentieth of the points.
    """
    if y.rel_accuracy_bits() > _POINT_BITS:
        return y.bessel_i(0, scaled=True)
    middle, least = acb(y.real.mid(), y.imag.mid()), acb(y.real.lower())
    slope = least.bessel_i(0, scaled=True) - least.bessel_i(1, scaled=True)
    change = arb(0, ((y - middle).abs_upper() * slope.real).abs_upper())
    return middle.bessel_i(0, scaled=True) + acb(change, change)


def kappa(n: int, digits: int = 50) -> arb:
    """Return int_0^oo y^n K0(y)/I0(y) dy = 1/(n+1) int_0^oo y^n/I0(y)^2 dy.

    Integration by parts with (K0/I0)' = -1/(y I0^2) removes the logarithm. For y >= 1,
    pi I0 >= int_0^pi e^(y (1 - t^2/2)) dt gives I0 >= e^y/(3 sqrt y). From y >= n + 2 on, the
    integral of y^n/I0^2 <= 9 y^(n+1) e^(-2y) is below the bound's first value.
    """

    def compute(bits: int) -> tuple[arb]:
        end = n + 2 + math.ceil(0.4 * bits) + 4 * n
        body = acb.integral(lambda y, _: y**n * (-2 * y).exp() / scaled_i0(y) ** 2, 0, end).real
        rest = 9 * arb(end) ** (n + 1) * arb(-2 * end).exp()
        return ((body + arb(0, rest.abs_upper())) / (n + 1),)

    return refine_to_digits(compute, digits, f"kappa_{n}")[0]


def finite_part(k: int, digits: int = 50) -> arb:
    """Return M_k = FP int_0^oo T^(2k-4) (G - 1) dT, k >= 2.

    G = n/(T^3 d) with n = 1 + sinh(2T)/(2T), d = (sinh^2 T - T^2)/T^4 even; n - (6 + 6 T^2/5) d
    begins with T^4, so G - 6/T^3 - 6/(5T) is regular. The finite part of the two terms over
    [0, 1] is -3 for k = 2, 3/5 for k = 3, and the plain integral for k > 3. For T >= 3,
    G - 1 < 7 T^2 e^(-2T), and T^(2k-2) e^(-T) decreases from T = 2k - 2 on.
    """
    if k < 2:
        raise ValueError(f"constants are counted from 2, got {k}")
    power = 2 * k - 4
    polar = {2: Fraction(-3), 3: Fraction(3, 5)}
    known = polar.get(k, Fraction(6, power - 2 or 1) + Fraction(6, 5 * (power or 1)))

    def compute(bits: int) -> tuple[arb]:
        near = acb.integral(lambda T, _: T**power * (_regular(T, bits) - 1), 0, 1).real
        end = 4 * k + math.ceil(0.5 * bits)
        far = acb.integral(lambda T, _: T**power * plate_excess(T), 1, end).real
        rest = 7 * arb(end) ** (power + 2) * arb(-2 * end).exp()
        return (near + far + to_ball(known) + arb(0, rest.abs_upper()),)

    return refine_to_digits(compute, digits, f"M_{k}")[0]


def _regular(T: acb, bits: int) -> acb:
    """Return G - 6/T^3 - 6/(5 T) for |T| <= 2: T (sum r_k T^(2k))/d.

    Terms from `count` on are below 8^k 4^k/(2k)!, each less than half of the previous one from
    k = 5 on.
    """
    count = 6
    while arb(32) ** count / math.factorial(2 * count) > arb(2) ** -bits:
        count += 1
    d = [flint.fmpq(2 ** (2 * k + 3), math.factorial(2 * k + 4)) for k in range(count)]
    n = [flint.fmpq(4**k, math.factorial(2 * k + 1)) for k in range(count)]
    n[0] += 1
    top = [n[k] - 6 * d[k] - (flint.fmpq(6, 5) * d[k - 1] if k else 0) for k in range(count)]
    if top[0] or top[1]:
        raise ArithmeticError("the polar part of G is not 6/T^3 + 6/(5T)")
    reach = T.abs_upper()
    if not reach <= 2:
        return acb(arb.nan())
    rest = (2 * arb(32) ** count / math.factorial(2 * count)).abs_upper()
    blur, square = acb(arb(0, rest), arb(0, rest)), T * T
    return T * (flint.acb_poly(top[2:])(square) + blur) / (flint.acb_poly(d)(square) + blur)


def finite_radius(alpha: Exact, digits: int = 50) -> arb:
    """Return W(alpha), the contribution of the finite radius of an infinitely thick plate."""
    return refine_to_digits(
        lambda _: (excess("hertz", to_ball(alpha), None),), digits, f"W at {alpha}"
    )[0]  # fmt: skip


def coefficient(order: int, h: Exact, b: Exact, digits: int = 50) -> arb:
    """Return c_order of delta = (a^2/R) (1 + c_1 a/h + c_3 (a/h)^3 + ...), for an odd order."""
    if order < 1 or order % 2 == 0:
        raise ValueError(f"only odd powers follow the Hertz term, got {order}")
    eta, m = ratio_of(h, b), (order - 1) // 2

    def compute(_: int) -> tuple[arb]:
        weight = Weight(lambda z: z ** (2 * m), 2 * m, 0.0)
        factor = (-1) ** m * arb(COEFFICIENTS["hertz"](m)) * 8 / (3 * arb.pi())
        return (factor * to_ball(eta) ** order * functional(weight, eta),)

    return refine_to_digits(compute, digits, f"c_{order} at h/b = {float(eta)}")[0]


# --- the law


def relative_correction(a: Exact, h: Exact, b: Exact, digits: int = 50) -> arb:
    """Return F = delta R/a^2 - 1 with a small relative radius; raises an error where F vanishes."""
    alpha, eta = ratio_of(a, b), ratio_of(h, b)
    return refine_to_digits(
        lambda _: (excess("hertz", to_ball(alpha), eta),), digits, f"F at {a, h, b}"
    )[0]


def indentation(a: Exact, R: Exact, h: Exact, b: Exact, digits: int = 50) -> arb:
    """Return the indentation at a contact radius."""
    alpha, eta = ratio_of(a, b), ratio_of(h, b)

    def compute(_: int) -> tuple[arb]:
        return (to_ball(a) ** 2 / to_ball(R) * (1 + excess("hertz", to_ball(alpha), eta)),)

    return refine_to_digits(compute, digits, f"delta at {a, R, h, b}")[0]


def slope(a: Exact, R: Exact, h: Exact, b: Exact, digits: int = 50) -> arb:
    """Return d delta/da at a contact radius."""
    alpha, eta = ratio_of(a, b), ratio_of(h, b)

    def compute(_: int) -> tuple[arb]:
        return (2 * to_ball(a) / to_ball(R) * (1 + excess("sinc", to_ball(alpha), eta)),)

    return refine_to_digits(compute, digits, f"d delta/da at {a, R, h, b}")[0]


def stiffness(
    a: Exact, R: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact, digits: int = 50
) -> arb:
    """Return dP/d delta at a contact radius: 2 E* a over the ratio of the slope to Hertz's."""
    alpha, eta = ratio_of(a, b), ratio_of(h, b)
    if not R > 0:  # R cancels; it is an argument because the generated function has it
        raise ValueError(f"a radius is positive, got {R}")

    def compute(_: int) -> tuple[arb]:
        return (2 * modulus(lam, mu) * to_ball(a) / (1 + excess("sinc", to_ball(alpha), eta)),)

    return refine_to_digits(compute, digits, f"stiffness at {a, h, b}")[0]


def ratio_where(
    value: Callable[[arb], arb],
    steepness: Callable[[arb, arb], arb],
    target: arb,
    start: float,
    what: str,
) -> arb:
    """Return alpha in (0, 1) where an increasing function equals `target`, at current precision.

    Newton's iteration in logarithms on midpoints, `steepness` being d log value/d log alpha. The
    ball is certified because the value is below the target at the ball's left end and above it at
    the right end.

    Raises
    ------
    ValueError
        If the value at the edge of the plate is below the target.
    PrecisionError
        If the ends do not enclose the target.
    """
    bits = flint.ctx.prec
    edge = 1 - arb(2) ** -50
    x, working, step = arb(min(start, 0.5)), _STEP, arb(1)
    for _ in range(200):
        with flint.ctx.workprec(working):
            here = value(x)
            step = ((target / here).log() / steepness(x, here)).mid()
            proposed = (x * step.min(arb(1)).max(arb(-20)).exp()).mid()
            if proposed > edge and not value(edge) > target:
                raise ValueError(f"the contact reaches the plate's edge before {what}")
            x = proposed.min(((x + edge) / 2).mid())
        if working == bits and abs(step) < arb(2) ** -(bits // 2 + 8):
            break
        if abs(step) < arb(2) ** -20:
            working = bits
    else:
        raise PrecisionError(f"no convergence towards {what}")
    # Allow for the radius of the value itself; too wide a value leads to too wide a ball.
    radius = x * (arb(2) ** (16 - bits) + 8 * (value(x) / target - 1).abs_upper())
    low, high = (x - radius).mid(), (x + radius).mid()
    if not (value(low) < target and value(high) > target):
        raise PrecisionError(f"{what} is not enclosed by {low} and {high}")
    return low.union(high)


def contact_radius(delta: Exact, R: Exact, h: Exact, b: Exact, digits: int = 50) -> arb:
    """Return the contact radius at an indentation."""
    eta = ratio_of(h, b)

    def value(x: arb) -> arb:
        return x**2 * (1 + excess("hertz", x, eta))

    def steepness(x: arb, here: arb) -> arb:
        return 2 * x**2 * (1 + excess("sinc", x, eta)) / here

    def compute(_: int) -> tuple[arb]:
        target = to_ball(delta) * to_ball(R) / to_ball(b) ** 2
        # Hertz's radius, or that of bending alone, x^3/(4 pi eta^3) = target, if it is smaller.
        start = min(float(target) ** (1 / 2), (4 * math.pi * float(target)) ** (1 / 3) * float(eta))
        return (to_ball(b) * ratio_where(value, steepness, target, start, f"delta = {delta}"),)

    return refine_to_digits(compute, digits, f"a at {delta, R, h, b}")[0]
