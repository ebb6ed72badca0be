"""Oracle 2 of the contact law: the modal sum added up in mpmath, mode by mode, then accelerated.

The N first modes are added as they stand. The rest is a sum over integers of an
analytic function, since dj/dn = 2/(j J1(j)^2) when j(n) is continued from the
zeros by the phase of the Bessel functions; Abel-Plana's formula turns it into

    sum_(n>=N) phi(n) = phi(N)/2 + int_N^oo phi dn - 2 int_0^oo Im phi(N+iy)/(e^(2 pi y)-1) dy,
    phi(n) = 1/2 f(j(n)) dj/dn,   int_N^oo phi dn = 1/2 int_(j_N)^oo f dx.

For plates that are not thin the part of G - 1 is added by brute force instead: it
dies out within some hundred modes. Nodes and weights of a plate are made once, so
indentation, slope and work are sums of one kernel each over the same nodes.
Everything is done twice, with other nodes, another N and more digits; where the two
differ there is no answer.
"""

import itertools
import math
from collections.abc import Callable, Sequence
from functools import cache
from typing import NamedTuple

import flint
from mpmath import mp, mpf
from mpmath.calculus.quadrature import GaussLegendre

from derivation.reference import contact_balls, contact_impact
from derivation.reference.routes import OracleError, RouteError, to_ball

THIN = 0.035
"""Below this h/b the poles of G beyond Re n = N weigh less than e^(-4.2/eta) < 10^-52."""

FIRST = 30
"""Modes added before the acceleration; the phase's asymptotic series needs about that many."""

MAX_DIGITS = 42

SETTINGS = ((30, 5, 56), (37, 6, 62))
"""Modes, level of the nodes and digits of the two evaluations that must agree."""


class Impact(NamedTuple):
    """What an impact comes to."""

    contact_time: mpf
    max_indentation: mpf
    max_force: mpf
    max_contact_radius: mpf


class Nodes(NamedTuple):
    """Nodes z and weights w of sum_j f(j) G/(j J1^2) = Re sum w f(z) + rest/2.

    The rest, int f dx from `start` on, has a closed form.
    """

    plain: tuple[tuple[mpf, mpf], ...]
    start: mpf


@cache
def _phase_series(dps: int) -> tuple[mpf, ...]:
    """Coefficients d_k of d theta/dx = sum d_k x^(-2k), the reciprocal of Nicholson's series.

    (pi x/2)(J0^2 + Y0^2) ~ 1 + sum_k (1*3*...(2k-1))/(2*4*...2k) prod (-(2i-1)^2)/(2x)^(2k).
    """
    with mp.workdps(dps):
        size = [mpf(1)]
        for k in range(1, dps + 10):
            factor = -(mpf(2 * k - 1) ** 3) / (2 * k) / 4
            size.append(size[-1] * factor)
        rate = [mpf(1)]
        for k in range(1, len(size)):
            rate.append(-mp.fsum(size[i] * rate[k - i] for i in range(1, k + 1)))
        return tuple(rate)


def _phase(x: mpf) -> tuple[mpf, mpf]:
    """Phase theta of H and its slope at a large x, real or complex, by the asymptotic series.

    Raises
    ------
    RouteError
        If the series turns before its terms are below the working precision.
    """
    theta, rate, power, smallest = x - mp.pi / 4, mpf(1), 1 / x, mpf(10) ** (-mp.dps - 3)
    square = 1 / (x * x)
    for k, coefficient in enumerate(_phase_series(mp.dps)[1:], start=1):
        theta -= coefficient * power / (2 * k - 1)
        power *= square
        rate += coefficient * power * x
        if abs(coefficient * power * x) < smallest:
            return theta, rate
    raise RouteError(f"the phase's series does not reach {mp.dps} digits at {mp.nstr(x)}")


def _continued_zero(n: mpf) -> tuple[mpf, mpf]:
    """j(n) and dj/dn, where theta(j) = (n - 1/2) pi, by Newton's iteration."""
    target = (n - mpf(1) / 2) * mp.pi
    x = target + mp.pi / 4 + 1 / (8 * target)
    for _ in range(12):
        theta, rate = _phase(x)
        step = (target - theta) / rate
        x += step
        if abs(step) < mpf(10) ** (-mp.dps + 8):
            return x, mp.pi / _phase(x)[1]
    raise RouteError(f"no zero of J0 continued to n = {mp.nstr(n)}")


@cache
def _mode(n: int, dps: int) -> tuple[mpf, mpf]:
    """j_n and 1/(j_n J1(j_n)^2)."""
    with mp.workdps(dps):
        if n >= FIRST:
            zero, rate = _continued_zero(mpf(n))
            return zero, rate / 2
        zero = mp.besseljzero(0, n)
        return zero, 1 / (zero * mp.besselj(1, zero) ** 2)


@cache
def _gauss(level: int, dps: int) -> tuple[tuple[mpf, mpf], ...]:
    """3 * 2^(level - 1) Gauss-Legendre nodes on [-1, 1]."""
    with mp.workdps(dps):
        rule = GaussLegendre(mp)
        return tuple(rule.calc_nodes(level, mp.prec))


def _spread(edges: Sequence[mpf], level: int) -> list[tuple[mpf, mpf]]:
    """Gauss-Legendre nodes and weights on consecutive intervals."""
    found = []
    for low, high in itertools.pairwise(edges):
        middle, half = (low + high) / 2, (high - low) / 2
        found += [(middle + half * x, half * w) for x, w in _gauss(level, mp.dps)]
    return found


def _excess(T: mpf) -> mpf:
    """G(T) - 1, with as many digits more as its two cancellations take."""
    lost = max(0, math.ceil(-4 * math.log10(float(abs(T)))))
    with mp.workdps(mp.dps + lost + 5):
        decay = mp.exp(-2 * T)
        numerator = 2 * decay * (1 - decay + 2 * T + 2 * T * T)
        return +(numerator / ((1 - decay) ** 2 - 4 * T * T * decay))


@cache
def _upright(first: int, level: int, dps: int) -> tuple[tuple[mpf, mpf], ...]:
    """Abel-Plana's integral on Re n = N, without f; |f| grows by e^(pi y) at most."""
    with mp.workdps(dps):
        end = mpf(dps) * mp.log(10) / mp.pi + 5
        heights = [mpf(0), mpf(1) / 2, *(mpf(2) ** k for k in range(5)), end]
        found = []
        for y, w in _spread(heights, level):
            z, slope = _continued_zero(mp.mpc(first, y))
            found.append((z, mp.mpc(0, 1) * w * slope / mp.expm1(2 * mp.pi * y)))
        return tuple(found)


@cache
def _nodes(eta: mpf, first: int, level: int, dps: int) -> Nodes:
    """Everything about a plate that does not depend on the contact."""
    with mp.workdps(dps):
        reach = mpf(dps) * mp.log(10)
        factor: Callable[[mpf], mpf] = lambda z: 1 + _excess(2 * eta * z)  # noqa: E731
        thin = eta < THIN
        modes = [_mode(n, dps) for n in range(1, first)]
        found = [(z, w * factor(z)) for z, w in modes]
        edge, rate = _continued_zero(mpf(first))
        late = factor if thin else (lambda _: mpf(1))
        found.append((edge, rate / 4 * late(edge)))
        found += [(z, w * late(z)) for z, w in _upright(first, level, dps)]
        if thin:
            edges = [2 * eta * edge]
            while edges[-1] < reach / 2 + 5:
                edges.append(min(2 * edges[-1], edges[-1] + 3))
            smooth = _spread(edges, level)
            found += [(T / (2 * eta), w / (4 * eta) * _excess(T)) for T, w in smooth]
        else:
            n = first
            while 4 * eta * n * 3 < reach + 15:
                z, w = _mode(n, dps)
                found.append((z, w * _excess(2 * eta * z)))
                n += 1
        return Nodes(tuple(found), edge)


def _sine(y: mpf) -> mpf:
    """sin y - y cos y, with the digits its cancellation takes."""
    with mp.workdps(mp.dps + _lost(y, 3)):
        return +(mp.sin(y) - y * mp.cos(y))


def _moment(y: mpf) -> mpf:
    """int_0^1 t^4 sin(y t) dt, with the digits its cancellation takes."""
    with mp.workdps(mp.dps + _lost(y, 6)):
        sine, cosine = mp.sin(y), mp.cos(y)
        total = (4 / y**2 - 24 / y**4) * sine + (12 / y**3 - 24 / y**5 - 1 / y) * cosine
        return +(total + 24 / y**5)


def _lost(y: mpf, power: int) -> int:
    return 5 + max(0, math.ceil(-power * math.log10(float(abs(y)))))


class Law(NamedTuple):
    """One evaluation of the law for a plate of h/b = eta, lengths in units of b and R."""

    eta: mpf
    first: int
    level: int
    dps: int

    def _sum(self, f: Callable[[mpf], mpf], rest: Callable[[mpf], mpf]) -> mpf:
        nodes = _nodes(self.eta, self.first, self.level, self.dps)
        return mp.fsum(mp.re(w * f(z)) for z, w in nodes.plain) + rest(nodes.start) / 2

    def indentation(self, x: mpf) -> mpf:
        """delta R/b^2 at a/b = x: f = s(x z)/z^3."""

        def rest(start: mpf) -> mpf:
            y = x * start
            with mp.workdps(mp.dps + _lost(y, 3)):
                head = -mp.sin(y) / (2 * y * y) + mp.cos(y) / (2 * y) + mp.si(y) / 2
                return x * x * (mp.pi / 4 - head)

        return 8 / mp.pi * self._sum(lambda z: _sine(x * z) / z**3, rest)

    def slope(self, x: mpf) -> mpf:
        """Its derivative to x: f = x sin(x z)/z."""
        return (
            8 / mp.pi
            * self._sum(
                lambda z: x * mp.sin(x * z) / z, lambda start: x * (mp.pi / 2 - mp.si(x * start))
            )
        )  # fmt: skip

    def work(self, x: mpf) -> mpf:
        """int_0^x t^3 slope dt: f = (1/z) int_0^x t^4 sin(z t) dt."""

        def rest(start: mpf) -> mpf:
            return x**5 / 5 * (mp.pi / 2 - mp.si(x * start) + _moment(x * start))

        return 8 / mp.pi * self._sum(lambda z: x**5 * _moment(x * z) / z, rest)


def _twice(compute: Callable[[Law], Sequence[mpf]], eta: mpf, digits: int) -> list[mpf]:
    """Both settings' results, or none.

    Raises
    ------
    RouteError
        If they differ by more than 10^-(digits + 1), or more digits are asked than this
        route is set for.
    """
    if digits > MAX_DIGITS:
        raise RouteError(f"this route is set for {MAX_DIGITS} digits, got {digits}")
    results = []
    for first, level, dps in SETTINGS:
        with mp.workdps(dps):
            results.append(list(compute(Law(eta, first, level, dps))))
    with mp.workdps(SETTINGS[-1][2]):
        for one, other in zip(*results, strict=True):
            if not abs(one - other) <= abs(other) * mpf(10) ** (-digits - 1):
                differ = mp.nstr((one - other) / other, 3)
                raise RouteError(f"two evaluations differ by {differ} at h/b = {float(eta)}")
    return results[-1]


def _quotient(one: float, other: float) -> mpf:
    with mp.workdps(SETTINGS[-1][2] + 10):
        return mpf(one) / mpf(other)


def _inside(x: mpf) -> mpf:
    if not 0 < x < 1:
        raise ValueError(f"the law has meaning for 0 < a/b < 1, got {mp.nstr(x)}")
    return x


def indentation(a: float, R: float, h: float, b: float, digits: int = 40) -> mpf:
    """Indentation at a contact radius."""
    x = _inside(_quotient(a, b))
    return _twice(
        lambda law: [mpf(b) ** 2 / mpf(R) * law.indentation(x)], _quotient(h, b), digits
    )[0]  # fmt: skip


def slope(a: float, R: float, h: float, b: float, digits: int = 40) -> mpf:
    """d delta/da at a contact radius."""
    x = _inside(_quotient(a, b))
    return _twice(lambda law: [mpf(b) / mpf(R) * law.slope(x)], _quotient(h, b), digits)[0]


def _root(function: Callable[[mpf], mpf], target: mpf, high: mpf) -> mpf:
    """x in (0, high] where an increasing function reaches its target: secants in logarithms.

    The last two points must enclose it: to within 10^-(dps - 8) of x.
    """
    low, steps = high / 2, 0
    below, above = function(low) / target, function(high) / target
    if not above > 1:
        raise ValueError("the contact would reach the edge of the plate")
    while below > 1:
        low, high, above = low / 16, low, below
        below = function(low) / target
    narrow = mpf(10) ** (12 - mp.dps)
    while (high - low) > high * narrow:
        steps += 1
        if steps > 200:
            raise RouteError("no root found")
        span = mp.log(high / low)
        guess = low * mp.exp(-mp.log(below) / (mp.log(above) - mp.log(below)) * span)
        # A step beyond the guess on both sides closes the bracket from its far end too.
        margin = span * span * span * high / 8 + high * narrow / 4
        for x in (guess - margin, guess + margin):
            if low < x < high:
                value = function(x) / target
                if value < 1:
                    low, below = x, value
                else:
                    high, above = x, value
        if mp.log(high / low) > span / 2:
            x = mp.sqrt(low * high)
            value = function(x) / target
            low, below, high, above = (
                (x, value, high, above) if value < 1 else (low, below, x, value)
            )
    return (low + high) / 2


def contact_radius(delta: float, R: float, h: float, b: float, digits: int = 40) -> mpf:
    """Contact radius at an indentation."""

    def compute(law: Law) -> list[mpf]:
        target = mpf(delta) * mpf(R) / mpf(b) ** 2
        # delta > 0.5 a^2/R for every a < b: the side wall takes at most 0.36 away.
        high = min(mp.sqrt(2 * target), mpf("0.9999"))
        return [mpf(b) * _root(law.indentation, target, high)]

    return _twice(compute, _quotient(h, b), digits)[0]


def impact(
    R: float, m: float, v0: float, h: float, b: float, lam: float, mu: float, digits: int = 30
) -> Impact:
    """The conservative impact: a = a_m sin t takes the root's singularity away."""

    def compute(law: Law) -> list[mpf]:
        modulus = 4 * mpf(mu) * (mpf(lam) + mpf(mu)) / (mpf(lam) + 2 * mpf(mu))
        stiff = 4 * modulus / (3 * mpf(R))
        unit = stiff * mpf(b) ** 5 / mpf(R)
        target = mpf(m) * mpf(v0) ** 2 / 2 / unit
        largest = _root(law.work, target, min((5 * target) ** (mpf(1) / 5), mpf("0.9999")))
        total, time = law.work(largest), mpf(0)
        for t, w in _spread([mp.pi / 2 * k / 2 for k in range(3)], law.level - 1):
            x = largest * mp.sin(t)
            speed = mp.sqrt(2 * unit * (total - law.work(x)) / mpf(m))
            time += w * law.slope(x) * largest * mp.cos(t) / speed
        depth = mpf(b) ** 2 / mpf(R)
        radius = mpf(b) * largest
        return [2 * depth * time, depth * law.indentation(largest), stiff * radius**3, radius]

    return Impact(*_twice(compute, _quotient(h, b), digits))


def agree(name: str, arguments: Sequence[float], digits: int = 40) -> tuple[mpf, ...]:
    """What both oracles give for `indentation`, `slope`, `contact_radius` or `impact`.

    Raises
    ------
    OracleError
        If they differ by more than 10^-digits.
    """
    own = ROUTES[name](*arguments, digits=digits)
    first = _FIRST_ORACLE[name](*arguments, digits=digits + 2)
    ours = own if isinstance(own, tuple) else (own,)
    balls = first if isinstance(first, tuple) else (first,)
    for ball, other in zip(balls, ours, strict=True):
        with flint.ctx.workprec(400):
            if not abs(ball - to_ball(other)) <= abs(ball) * flint.arb(10) ** -digits:
                raise OracleError(f"{name} at {tuple(arguments)}: {ball} against {other}")
    return tuple(ours)


ROUTES: dict[str, Callable[..., mpf | Impact]] = {
    "indentation": indentation,
    "slope": slope,
    "contact_radius": contact_radius,
    "impact": impact,
}
_FIRST_ORACLE: dict[str, Callable[..., object]] = {
    "indentation": contact_balls.indentation,
    "slope": contact_balls.slope,
    "contact_radius": contact_balls.contact_radius,
    "impact": contact_impact.impact,
}
