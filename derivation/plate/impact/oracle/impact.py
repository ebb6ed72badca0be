"""Oracle 1 of the impact: the conservative law's course in ball arithmetic.

With the notation of `contact.oracle.balls` and P = 4 E* a^3/(3 R),

    int P d delta = (8 E*/(15 R^2)) a^5 (1 + 20 alpha/pi L[work]),

which gives the largest contact radius a_m. For the time, d delta/da is taken for
a polynomial on [0, a_m] with a proven error, an interpolant of the law in integrals or
the law's power series; the rest is exact in that polynomial, and the root's singularity
at a_m is taken away by a = a_m (1 - u^2).
"""

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import NamedTuple, Protocol

import flint
from flint import acb, arb

from derivation.engine.formula.ball import Exact, PrecisionError, to_ball
from derivation.plate.contact.oracle.balls import modulus, ratio_of, ratio_where, settle
from derivation.plate.contact.oracle.sums import excess, excess_bound, hankel_bound

_PIECES = (16, 256)
"""Of [0, 1], to show that the slope is positive: few, and more if they do not suffice."""


class ImpactBalls(NamedTuple):
    """What an impact comes to: balls."""

    contact_time: arb
    max_indentation: arb
    max_force: arb
    max_contact_radius: arb


class BallLaw(Protocol):
    """What a plate adds to Hertz's law up to a/b = `reach`, at the precision now set."""

    @property
    def reach(self) -> arb:
        """Largest a/b [1] served."""

    def excess(self, name: str, alpha: arb) -> arb:
        """See `contact.oracle.sums.excess`; alpha = a/b [1]."""

    def slope(self, alpha: arb) -> tuple[flint.arb_poly, arb]:
        """Exact coefficients of p(t), and a bound of p's error on [0, 1].

        (R/2a) d delta/da = 1 + q p(q^2) at a = q alpha b.
        """


class Integrals(NamedTuple):
    """The law of a plate of h/b = eta by the integrals of `sums`, whatever the contact."""

    eta: Fraction

    @property
    def reach(self) -> arb:
        """The plate's edge."""
        return arb(1)

    def excess(self, name: str, alpha: arb) -> arb:
        """See `contact.oracle.sums.excess`."""
        return excess(name, alpha, self.eta)

    def slope(self, alpha: arb) -> tuple[flint.arb_poly, arb]:
        """See `Law.slope`."""
        return _slope_polynomial(alpha, self.eta)


class Course(NamedTuple):
    """An impact's polynomials in q = a/a_m, exact ones, and what they may be wrong by.

    With S = (R/2a) d delta/da and H = int_q^1 x^4 S dx/(1 - q), the time from a to
    a_m is scale int_0^u q S/sqrt(H) du, q = 1 - u^2. `doubt` bounds its relative error.
    """

    slope: flint.acb_poly
    energy: flint.acb_poly
    scale: arb
    doubt: arb
    radius: arb


def _size(alpha: float, eta: float) -> tuple[float, float]:
    """rho of an ellipse for L[sinc] in q, foci +-1, and half the largest rate it allows.

    With half-axes A, B: |Im(alpha z)| <= alpha (sqrt(A^2 + 4 B^2) y + B) on the ray, to
    stay below 1.8 y + ..., and <= alpha B x on the axis, to stay below 3.2 eta x.
    """
    low, high = 1.0, 1e3
    for _ in range(60):
        rho = (low + high) / 2
        A, B = (rho + 1 / rho) / 2, (rho - 1 / rho) / 2
        fits = alpha * math.hypot(A, 2 * B) < 1.8 and alpha * B < 3.2 * eta
        low, high = (rho, high) if fits else (low, rho)
    return low, alpha * (low - 1 / low) / 2


def _ellipse_bound(alpha: arb, eta: arb, rate: arb) -> arb:
    """|4 alpha/pi L[sinc]| on that ellipse.

    On the axis for T <= 3 the exponential is below e^4.8 < 122 and the excess at
    most 180 * 13/T^6; for T >= 3 it is below 4.9 e^(-2T) (1 + T + T^2), which against
    e^(1.6 T) leaves an integral below 159. On the ray |H/J0| <= 3 e^(-2y) for |z| >= 4,
    y >= 1; before y = 2 balls bound it, e^4 making up for e^(-2y).
    """
    pieces = (arb((2 * k + 1) * arb(1) / 200, arb(1) / 200) for k in range(200))
    near = arb(3)
    for y in pieces:
        near = near.max(hankel_bound(acb(1 + 2 * y, y)) * arb(4).exp())
    side = rate.exp() / 2
    axis = (122 * 468 / (2 * eta) ** 6 + 159 / (2 * eta)) / 2
    ray = arb(5).sqrt() / 2 * near * rate.exp() * 5 * (1 + excess_bound(2 * eta))
    return (4 * alpha / arb.pi() * (side + axis + ray)).abs_upper()


def _slope_polynomial(alpha: arb, eta: Fraction) -> tuple[flint.arb_poly, arb]:
    """Exact coefficients of p(t), where S(q) = 1 + q p(q^2) on [0, 1], and a bound of p's error.

    L[sinc] is even in alpha, hence analytic in t = q^2 inside an ellipse of
    parameter rho^2, foci 0 and 1. Interpolation in n + 1 Chebyshev nodes misses at
    most 4 M rho^(-2n)/(rho^2 - 1), and errors of the values (taken at their
    midpoints) count (2/pi) log(n + 1) + 1 times (Trefethen, ATAP, 8.2 and 15.2).
    """
    bits = flint.ctx.prec
    root, rate = _size(float(alpha), float(eta))
    rho = arb(root) ** 2
    bound = _ellipse_bound(alpha, to_ball(eta), arb(rate) * (1 + arb(2) ** -40))
    n = 2 + math.ceil((bits * math.log(2) + max(0.0, float(bound.log()))) / float(rho.log()))
    count, error = n + 1, 4 * bound * rho**-n / (rho - 1)
    xs = [arb.cos_pi_fmpq(flint.fmpq(2 * i + 1, 2 * count)) for i in range(count)]
    values = [excess("sinc", alpha * ((1 + x) / 2).sqrt(), eta) / ((1 + x) / 2).sqrt() for x in xs]
    widest = max((value.rad() for value in values), key=float)
    error += widest * (2 / arb.pi() * arb(count).log() + 1)
    with flint.ctx.workprec(bits + 4 * count + 64):
        polynomial = flint.arb_poly([0])
        before, now = flint.arb_poly([1]), flint.arb_poly([-1, 2])
        for k in range(count):
            cosines = (
                arb.cos_pi_fmpq(flint.fmpq(k * (2 * i + 1), 2 * count)) for i in range(count)
            )
            share = sum((v.mid() * c for v, c in zip(values, cosines, strict=True)), arb(0))
            polynomial += before * (share * (2 if k else 1) / count)
            before, now = now, flint.arb_poly([-2, 4]) * now - before
        return polynomial, error.abs_upper()


def _spread(polynomial: flint.arb_poly) -> flint.arb_poly:
    """1 + q p(q^2)."""
    spread = [arb(1)]
    for term in polynomial.coeffs():
        spread += [term, arb(0)]
    return flint.arb_poly(spread)


def _doubt(polynomial: flint.arb_poly, error: arb) -> arb:
    """Bound of the relative error of S and of every integral of it, where p errs by `error`.

    S errs by q error, and S/q = 1/q + p >= 1 + p: in thin plates, where p is large,
    nothing is lost against S(0) = 1.
    """
    p = flint.acb_poly(polynomial)
    for count in _PIECES:
        half = arb(1) / (2 * count)
        cover = (_at(p, acb(arb((2 * k + 1) * half, half))) for k in range(count))
        least = min((1 + value.real.lower() for value in cover), key=float) - error
        if least > 0:
            return (error / least).abs_upper()
    raise PrecisionError("the slope could not be shown to be positive")


def _at(polynomial: flint.acb_poly, q: acb) -> acb:
    """A polynomial on a ball, around its midpoint unless it is narrow."""
    if max(float(q.real.rad()), float(q.imag.rad())) < 1e-30:
        return polynomial(q)
    middle = q.mid()
    return polynomial(flint.acb_poly([middle, 1]))(q - middle)


def _duration(course: Course, u: arb, bits: int) -> arb:
    """Time between a_m (1 - u^2) and a_m."""

    def integrand(v: acb, analytic: bool) -> acb:
        q = 1 - v * v
        return q * _at(course.slope, q) / _at(course.energy, q).sqrt(analytic=analytic)

    with flint.ctx.workprec(bits + 2 * course.slope.degree() + 64):
        tolerance = arb(2) ** -bits
        body = acb.integral(integrand, 0, acb(u), rel_tol=tolerance, abs_tol=tolerance).real
        return course.scale * body * arb(1, course.doubt)


def _course(alpha: arb, R: Exact, m: Exact, b: Exact, stiff: arb, law: BallLaw) -> Course:
    """Polynomials at a largest a/b; `stiff` is C = 4 E*/(3R)."""
    bits = flint.ctx.prec
    bare, error = law.slope(alpha)
    polynomial = _spread(bare)
    with flint.ctx.workprec(bits + 2 * polynomial.degree() + 64):
        work = (flint.arb_poly([0, 0, 0, 0, 1]) * polynomial).integral().coeffs()
        energy, tail = [arb(0)] * (len(work) - 1), arb(0)
        for power in range(len(work) - 1, 0, -1):
            tail += work[power]
            energy[power - 1] = tail
        radius = alpha * to_ball(b)
        scale = 2 * radius**2 / to_ball(R)
        scale *= (to_ball(m) * to_ball(R) / (stiff * radius**5)).sqrt()
        # Relative errors below d of S and H make one of S/sqrt(H) below 2 d.
        doubt = (3 * _doubt(bare, error)).abs_upper()
        return Course(flint.acb_poly(polynomial), flint.acb_poly(energy), scale, doubt, radius)


def impact(
    R: Exact, m: Exact, v0: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact, digits: int = 40,
    law: Callable[[int], BallLaw] | None = None,
) -> ImpactBalls:  # fmt: skip
    """The conservative impact of a sphere of mass m at speed v0.

    `law` gives the plate's law at so many bits; without it integrals serve.

    Raises
    ------
    ValueError
        If the contact reaches the plate's edge before the sphere has stopped.
    """
    chosen = law or (lambda _: Integrals(ratio_of(h, b)))

    def compute(bits: int) -> ImpactBalls:
        return _impact(R, m, v0, h, b, lam, mu, (), chosen(bits))[0]

    return ImpactBalls(*settle(compute, digits, "impact"))


def stored_energy(
    a: Exact, R: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact, digits: int = 40
) -> arb:
    """int P d delta up to a contact radius: m v0^2/2 of the impact that just reaches it."""
    alpha, eta = ratio_of(a, b), ratio_of(h, b)

    def compute(_: int) -> tuple[arb]:
        hertz = 8 * modulus(lam, mu) * to_ball(a) ** 5 / (15 * to_ball(R) ** 2)
        return (hertz * (1 + excess("work", to_ball(alpha), eta)),)

    return settle(compute, digits, f"energy at {a, R, h, b}")[0]


def history(
    radii: Sequence[Exact],
    R: Exact, m: Exact, v0: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact,
    digits: int = 40, law: Callable[[int], BallLaw] | None = None,
) -> tuple[arb, ...]:  # fmt: skip
    """Times since first touch at which the growing contact reaches the given radii.

    `law` is as for `impact`.
    """
    chosen = law or (lambda _: Integrals(ratio_of(h, b)))

    def compute(bits: int) -> tuple[arb, ...]:
        return _impact(R, m, v0, h, b, lam, mu, radii, chosen(bits))[1]

    return settle(compute, digits, "history")


def largest_ratio(
    R: Exact, m: Exact, v0: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact, law: BallLaw
) -> arb:
    """Largest a/b of an impact, at the precision now set.

    Raises
    ------
    ValueError
        If the contact reaches the plate's edge before the sphere has stopped.
    """
    eta, stiff = ratio_of(h, b), 4 * modulus(lam, mu) / (3 * to_ball(R))

    def value(x: arb) -> arb:
        return x**5 * (1 + law.excess("work", x))

    def steepness(x: arb, here: arb) -> arb:
        return 5 * x**5 * (1 + law.excess("sinc", x)) / here

    target = to_ball(m) * to_ball(v0) ** 2 / 4 * 5 * to_ball(R) / stiff / to_ball(b) ** 5
    # Hertz's, or that of a bent plate, 5 x^6/(16 pi eta^3) = target, if it is smaller.
    # Roots are taken of the ball: of a slow impact no double holds the target.
    bent = (3.2 * math.pi) ** (1 / 6) * float(target.root(6)) * float(eta) ** 0.5
    start = min(float(target.root(5)), bent, float(law.reach))
    return ratio_where(value, steepness, target, start, f"the sphere stops from {v0}")


def _impact(
    R: Exact, m: Exact, v0: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact,
    radii: Sequence[Exact], law: BallLaw,
) -> tuple[ImpactBalls, tuple[arb, ...]]:  # fmt: skip
    stiff, bits = 4 * modulus(lam, mu) / (3 * to_ball(R)), flint.ctx.prec
    alpha = largest_ratio(R, m, v0, h, b, lam, mu, law)
    course = _course(alpha, R, m, b, stiff, law)
    whole = _duration(course, arb(1), bits)
    deepest = course.radius**2 / to_ball(R) * (1 + law.excess("hertz", alpha))
    force = stiff * course.radius**3
    found = ImpactBalls(2 * whole, deepest, force, course.radius)
    return found, tuple(whole - _duration(course, _left(a, course), bits) for a in radii)


def _left(a: Exact, course: Course) -> arb:
    """u of a contact radius, 1 - u^2 = a/a_m."""
    if not to_ball(a) < course.radius:
        raise ValueError(f"a contact radius below {course.radius.str(8)} is expected, got {a}")
    return (1 - to_ball(a) / course.radius).sqrt()
