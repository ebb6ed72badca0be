"""Arb reference of plate waves: B_a and B_s of step 26 in ball arithmetic.

    B = -(2/kap) [(2 x^2 - kap)^2 t(p)/p - 4 x^2 q t(q)],   t = tanh for B_a, coth for B_s,

with complex p and q, for squares of either sign. A zero of B is enclosed by two numbers at which
B is certainly positive and negative. Between two poles B decreases (step 26), so there is only one.
Slopes come from the same expression by arithmetic of power series.
"""

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import flint
from flint import acb, acb_series, arb

from derivation.engine.formula.ball import LOG2_10, Exact, PrecisionError, to_ball

KINDS = ("antisymmetric", "symmetric")
Complex = Any
"""A complex ball, or a power series of them."""
_HALVINGS = 80
_NEWTON = 40
_MOST_BITS = 1 << 15


def influence(x: Exact, kap: Exact, nu: Exact, digits: int = 30) -> tuple[arb, arb]:
    """Return 1/B_a and 1/B_s.

    Parameters
    ----------
    x, kap, nu
        phi h, (omega h/c_T)^2 >= 0 and Poisson's ratio, exact numbers.
    digits
        Correct decimal digits required of the balls.
    """
    places = _next_to_cutoff(Fraction(x), Fraction(kap), digits)

    def between(kind: str) -> arb:
        values = [1 / _value(kind, x, to_ball(place), nu) for place in places]
        return values[0].union(values[-1])

    def compliance(kind: str) -> arb:
        return _refined(x, digits, lambda: between(kind))

    return compliance(KINDS[0]), compliance(KINDS[1])


def _next_to_cutoff(x: Fraction, kap: Fraction, digits: int) -> list[Fraction]:
    """Return kap, or two numbers around it where the expression has only a limit, at 0 and x^2.

    1/B increases with kap wherever it is finite (step 26), and varies on the scale of the waves.
    """
    if kap not in (0, x * x):
        return [kap]
    step = min(x**2, x**4) / 10 ** (2 * digits)
    return [kap - step, kap + step]


def condition(x: Exact, kap: Exact, nu: Exact, kind: str) -> tuple[float, float]:
    """Return sums of the condition numbers of 1/B: of the arguments, and of p and q.

    The differences use steps far below double precision.
    """
    small = -math.frexp(float(x))[1], -math.frexp(float(kap))[1]
    with flint.ctx.workprec(400 + 8 * max(0, *small)):
        shift = arb(2) ** -100
        wave, load, ratio = to_ball(x), to_ball(kap), to_ball(nu)
        p, q = _roots(wave, acb(load), _gam_of(ratio))
        here = _printed(kind, wave, acb(load), p, q)

        def sensitivity(value: acb) -> float:
            return float(abs((value / here - 1).real / shift))

        more = 1 + shift
        of_arguments = 0.0
        for a, b, c in ((more, 1, 1), (1, more, 1), (1, 1, more)):
            moved = wave * a, acb(load * b)
            roots = _roots(*moved, _gam_of(ratio * c))
            of_arguments += sensitivity(_printed(kind, *moved, *roots))
        of_roots = sensitivity(_printed(kind, wave, acb(load), p * more, q))
        return of_arguments, of_roots + sensitivity(_printed(kind, wave, acb(load), p, q * more))


def zero(x: Exact, nu: Exact, kind: str = KINDS[0], index: int = 0, digits: int = 30) -> arb:
    """Return kap of a branch: the zero of B_a or B_s between its poles `index` and `index` + 1.

    Parameters
    ----------
    x, nu
        phi h and Poisson's ratio, exact numbers.
    kind
        `antisymmetric` or `symmetric`.
    index
        Index of the branch, 0 for A0 or S0.
    digits
        Correct decimal digits required of the enclosure.

    Raises
    ------
    PrecisionError
        If two poles are too close for the sign of B between them to be determined.
    """
    return _refined(x, digits, lambda: _zero(kind, x, nu, index, digits))


def residue(x: Exact, nu: Exact, kind: str = KINDS[0], index: int = 0, digits: int = 30) -> arb:
    """Return rho h r = -1/B' at the zero."""

    def compute() -> arb:
        return -1 / _slope(kind, x, _zero(kind, x, nu, index, _finer(x, digits)), nu)

    return _refined(x, digits, compute)


def fraction(x: Exact, nu: Exact, digits: int = 30) -> arb:
    """Return the fraction of A0 in the static deflection, C = 2 G(2 x)/(E* phi) by step 7."""

    def compute() -> arb:
        kap = _zero(KINDS[0], x, nu, 0, _finer(x, digits))
        T = 2 * to_ball(x)
        G = (T.sinh() * T.cosh() + T) / (T.sinh() ** 2 - T**2)
        static = G / (2 * (1 - _gam(nu)) * to_ball(x))
        return -1 / _slope(KINDS[0], x, kap, nu) / kap / static

    return _refined(x, digits, compute)


def _refined(x: Exact, digits: int, compute: Callable[[], arb]) -> arb:
    """Repeat with more bits until the ball is narrow.

    For thin plates up to eight powers cancel; for large x all branches are near x^2.
    """
    target = math.ceil(digits * LOG2_10) + 1
    bits = target + 64 + 8 * abs(math.frexp(float(x))[1])
    while bits < _MOST_BITS:
        with flint.ctx.workprec(bits):
            ball = compute()
            if ball.is_finite() and ball.rel_accuracy_bits() >= target:
                return ball
        bits *= 2
    raise PrecisionError(f"no {digits} digits at x = {float(x)}")


def _finer(x: Exact, digits: int) -> int:
    """Return the digits of kap that are needed for the requested digits of the slope.

    The width of kap enters divided by x^2, and for large x by the distance of a pole.
    """
    return 2 * digits + 4 * math.ceil(abs(math.log10(x)))


def _gam(nu: Exact) -> arb:
    return _gam_of(to_ball(nu))


def _gam_of(ratio: arb) -> arb:
    return (1 - 2 * ratio) / (2 * (1 - ratio))


def _roots(x: arb, kap: Complex, gam: arb) -> tuple[Complex, Complex]:
    """Return p and q."""
    square = acb(x**2)
    return (square - kap * acb(gam)).sqrt(), (square - kap).sqrt()


def _printed(kind: str, x: arb, kap: Complex, p: Complex, q: Complex) -> Complex:
    """Return B_a or B_s."""
    square = acb(x**2)
    sign = 1 if kind == KINDS[0] else -1
    t_p, t_q = (_tanh(y, sign) for y in (p, q))
    bracket = (2 * square - kap) ** 2 * t_p / p - 4 * square * q * t_q
    return -2 * bracket / kap


def _tanh(y: Complex, sign: int) -> Complex:
    """Return tanh y for sign 1, coth y for -1, for any size of y."""
    fading = sign * (-2 * y).exp()
    return (1 - fading) / (1 + fading)


def _stiffness(kind: str, x: Exact, kap: Complex, nu: Exact) -> Complex:
    wave = to_ball(x)
    return _printed(kind, wave, kap, *_roots(wave, kap, _gam(nu)))


def _value(kind: str, x: Exact, kap: arb, nu: Exact) -> arb:
    return _stiffness(kind, x, acb(kap), nu).real


def _slope(kind: str, x: Exact, kap: arb, nu: Exact) -> arb:
    if not kap.is_finite():  # a series cannot be divided by it
        return kap
    return _stiffness(kind, x, acb_series([acb(kap), 1], 2), nu)[1].real


def _zero(kind: str, x: Exact, nu: Exact, index: int, digits: int) -> arb:
    """Return the enclosure at the current precision; not finite if that is not sufficient."""
    poles, fall = _poles(kind, x, nu, index), 4
    low, high = poles
    # A branch is as close to a pole as powers of x or 1/x are to 0; in soft plates, as gam is.
    close = abs(math.frexp(float(x))[1]) + abs(math.frexp(float(_gam(nu)))[1])
    for _ in range(_HALVINGS + 4 * close):
        # For A0, whose kap may be x^2 times a small number, the logarithm is bisected.
        geometric = low > 0 and bool(high > 2 * low)
        middle = ((low * high).sqrt() if geometric else (low + high) / 2).mid()
        if not low > 0:
            middle, fall = (high * arb(2) ** -fall).mid(), 2 * fall
        value = _value(kind, x, middle, nu)
        if value > 0:
            low = middle
        elif value < 0:
            high = middle
        else:
            break
    place = ((low + high) / 2).mid()
    for _ in range(_NEWTON):
        step = _value(kind, x, place, nu) / _slope(kind, x, place, nu)
        new = (place - step).mid()
        if not (new > low and new < high):
            return arb("nan")
        moved, place = abs(new - place), new
        if moved < abs(place) * arb(10) ** -(digits + 4):
            break
    width = abs(place) * arb(10) ** -(digits + 3)
    width = width.min((place - poles[0]) / 4).min((poles[1] - place) / 4)
    before, after = place - width, place + width
    certain = _value(kind, x, before.mid(), nu) > 0 and _value(kind, x, after.mid(), nu) < 0
    return before.union(after) if certain else arb("nan")


def _poles(kind: str, x: Exact, nu: Exact, index: int) -> tuple[arb, arb]:
    """Return kap of the two poles around a branch, 0 before the first."""
    square, gam = to_ball(x) ** 2, _gam(nu)
    half = Fraction(1, 2) if kind == KINDS[0] else Fraction(0)
    angles = [(to_ball(n + half) * arb.pi()) ** 2 for n in range(index + 2)]
    poles = [square + angle for angle in angles if kind == KINDS[0] or angle != 0]
    poles += [(square + angle) / gam for angle in angles]
    edges = [arb(0), *sorted(poles, key=float)]
    return edges[index].upper(), edges[index + 1].lower()
