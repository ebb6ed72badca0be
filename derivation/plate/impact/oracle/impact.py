"""Arb reference of the impact: the motion by the conservative law, in ball arithmetic.

With the notation of `contact.oracle.balls` and P = 4 E* a^3/(3 R),

    int P d delta = (8 E*/(15 R^2)) a^5 (1 + 20 alpha/pi L[work]),

which gives the largest contact radius a_m. For the time, d delta/da is approximated by a polynomial
on [0, a_m] with a proved error bound, see `ball_law`. All else is exact for that polynomial; the
substitution a = a_m (1 - u^2) removes the singularity of the root at a_m.
"""

import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import NamedTuple

import flint
from flint import acb, arb

from derivation.engine.formula.ball import Exact, PrecisionError, to_ball
from derivation.plate.contact.oracle.balls import modulus, ratio_of, ratio_where, refine_to_digits
from derivation.plate.contact.oracle.sums import excess
from derivation.plate.impact.oracle.ball_law import BallLaw, Integrals, law_of

_MARGIN = 1 + 2.0**-30
"""The law is computed for contacts larger than the largest one by this factor."""

_MOTIONS = 256
"""Number of cached largest contacts."""

_PIECES = (16, 256)
"""Numbers of parts of [0, 1] in the proof that the slope is positive, tried in this order."""


class ImpactBalls(NamedTuple):
    """Contact time [s], and largest indentation [m], force [N] and contact radius [m], as balls."""

    contact_time: arb
    max_indentation: arb
    max_force: arb
    max_contact_radius: arb


class ImpactPolynomials(NamedTuple):
    """An impact's exact polynomials in q = a/a_m, with a bound of their error.

    With S = (R/2a) d delta/da and H = int_q^1 x^4 S dx/(1 - q), the time from a to
    a_m is scale int_0^u q S/sqrt(H) du, q = 1 - u^2. `error_bound` bounds its relative error.
    """

    slope: flint.acb_poly
    energy: flint.acb_poly
    scale: arb
    error_bound: arb
    radius: arb


def _spread(polynomial: flint.arb_poly) -> flint.arb_poly:
    """Return 1 + q p(q^2)."""
    spread = [arb(1)]
    for term in polynomial.coeffs():
        spread += [term, arb(0)]
    return flint.arb_poly(spread)


def _error_bound(polynomial: flint.arb_poly, error: arb) -> arb:
    """Return a bound of the relative error of S and its integrals, if p has the error `error`.

    The error of S is q error, and S/q = 1/q + p >= 1 + p. Hence the bound is small for thin plates
    too, where p is large.
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
    """Return a polynomial on a ball, expanded about its midpoint unless the ball is narrow."""
    if max(float(q.real.rad()), float(q.imag.rad())) < 1e-30:
        return polynomial(q)
    middle = q.mid()
    return polynomial(flint.acb_poly([middle, 1]))(q - middle)


def _duration(polynomials: ImpactPolynomials, u: arb, bits: int) -> arb:
    """Return the time between a_m (1 - u^2) and a_m."""

    def integrand(v: acb, analytic: bool) -> acb:
        q = 1 - v * v
        return q * _at(polynomials.slope, q) / _at(polynomials.energy, q).sqrt(analytic=analytic)

    with flint.ctx.workprec(bits + 2 * polynomials.slope.degree() + 64):
        tolerance = arb(2) ** -bits
        body = acb.integral(integrand, 0, acb(u), rel_tol=tolerance, abs_tol=tolerance).real
        return polynomials.scale * body * arb(1, polynomials.error_bound)


def _polynomials(
    alpha: arb, R: Exact, m: Exact, b: Exact, stiff: arb, law: BallLaw
) -> ImpactPolynomials:
    """Return the polynomials at a largest a/b; `stiff` is C = 4 E*/(3R)."""
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
        # Relative errors below d of S and H cause a relative error below 2 d of S/sqrt(H).
        error_bound = (3 * _error_bound(bare, error)).abs_upper()
        return ImpactPolynomials(
            flint.acb_poly(polynomial), flint.acb_poly(energy), scale, error_bound, radius
        )


def impact(
    R: Exact, m: Exact, v0: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact, digits: int = 40,
    law: Callable[[int], BallLaw] | None = None,
) -> ImpactBalls:  # fmt: skip
    """Return the results of an elastic impact of a sphere of mass m [kg] at speed v0 [m/s].

    `law` returns the plate's law at a given precision in bits; the default is that of `law_for`.

    Raises
    ------
    ValueError
        If the contact reaches the plate's edge before the sphere has stopped.
    """
    chosen = law or law_for((R, m, v0, h, b, lam, mu), digits)

    def compute(bits: int) -> ImpactBalls:
        return _impact(R, m, v0, h, b, lam, mu, (), chosen(bits))[0]

    return ImpactBalls(*refine_to_digits(compute, digits, "impact"))


def stored_energy(
    a: Exact, R: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact, digits: int = 40
) -> arb:
    """Return int P d delta up to a contact radius: m v0^2/2 of the impact that just reaches it."""
    alpha, eta = ratio_of(a, b), ratio_of(h, b)

    def compute(_: int) -> tuple[arb]:
        hertz = 8 * modulus(lam, mu) * to_ball(a) ** 5 / (15 * to_ball(R) ** 2)
        return (hertz * (1 + excess("work", to_ball(alpha), eta)),)

    return refine_to_digits(compute, digits, f"energy at {a, R, h, b}")[0]


def history(
    radii: Sequence[Exact],
    R: Exact, m: Exact, v0: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact,
    digits: int = 40,
) -> tuple[arb, ...]:  # fmt: skip
    """Return the times since first contact at which the growing contact reaches the given radii."""
    chosen = law_for((R, m, v0, h, b, lam, mu), digits)

    def compute(bits: int) -> tuple[arb, ...]:
        return _impact(R, m, v0, h, b, lam, mu, radii, chosen(bits))[1]

    return refine_to_digits(compute, digits, "history")


def law_for(motion: Sequence[Exact], digits: int) -> Callable[[int], BallLaw]:
    """Return a function of the precision: the law up to the largest contact of an exact impact."""
    return law_of(ratio_of(motion[3], motion[4]), reach_of(tuple(motion)), digits)


@lru_cache(maxsize=_MOTIONS)
def reach_of(motion: tuple[Exact, ...]) -> float:
    """Return a number slightly above the largest a/b of an impact, and below 1."""
    R, m, v0, h, b, lam, mu = motion
    with flint.ctx.workprec(64):
        largest = largest_ratio(R, m, v0, h, b, lam, mu, Integrals(ratio_of(h, b)))
    return min(float(largest.upper()) * _MARGIN, math.nextafter(1.0, 0.0))


def largest_ratio(
    R: Exact, m: Exact, v0: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact, law: BallLaw
) -> arb:
    """Return the largest a/b of an impact, at the current precision.

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
    # Hertz's radius, or that of bending alone, 5 x^6/(16 pi eta^3) = target, if it is smaller.
    # Roots are those of balls: for a slow impact the target is below the range of doubles.
    bent = (3.2 * math.pi) ** (1 / 6) * float(target.root(6)) * float(eta) ** 0.5
    start = min(float(target.root(5)), bent, float(law.reach))
    return ratio_where(value, steepness, target, start, f"the sphere stops from {v0}")


def _impact(
    R: Exact, m: Exact, v0: Exact, h: Exact, b: Exact, lam: Exact, mu: Exact,
    radii: Sequence[Exact], law: BallLaw,
) -> tuple[ImpactBalls, tuple[arb, ...]]:  # fmt: skip
    stiff, bits = 4 * modulus(lam, mu) / (3 * to_ball(R)), flint.ctx.prec
    alpha = largest_ratio(R, m, v0, h, b, lam, mu, law)
    polynomials = _polynomials(alpha, R, m, b, stiff, law)
    whole = _duration(polynomials, arb(1), bits)
    deepest = polynomials.radius**2 / to_ball(R) * (1 + law.excess("hertz", alpha))
    force = stiff * polynomials.radius**3
    impact_balls = ImpactBalls(2 * whole, deepest, force, polynomials.radius)
    return impact_balls, tuple(
        whole - _duration(polynomials, _left(a, polynomials), bits) for a in radii
    )


def _left(a: Exact, polynomials: ImpactPolynomials) -> arb:
    """Return u of a contact radius, 1 - u^2 = a/a_m."""
    if not to_ball(a) < polynomials.radius:
        raise ValueError(f"a contact radius below {polynomials.radius.str(8)} is expected, got {a}")
    return (1 - to_ball(a) / polynomials.radius).sqrt()
