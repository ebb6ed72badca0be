"""Arb reference of the paper's own motion: its correction, (16), by collocation in balls.

eta' + F eta + G = 0 from rest, with F and G of (17) and (18) as in the theory. The indentation,
delta_0 in the paper, is proportional to x^3, where F and G are smooth in x. At `last_fraction`,
where the radicand vanishes, they have the singularity of a square root, which x = x_last (1 - u^2)
removes. On panels of u that are halved towards that point, eta is collocated at Gauss' nodes. The
balls include all rounding. The collocation error is estimated with more nodes: ten times the
difference is added to the radius. Convergence is geometric; the estimate is not proved.
"""

from functools import cache

import flint
import sympy as sp
from flint import arb, arb_mat

from derivation.engine.formula.ball import Exact, enclose, to_ball
from derivation.plate.contact.oracle.balls import refine_to_digits
from derivation.plate.impact.theory.impact import linearisation
from derivation.plate.vocabulary import delta_0, m, v0, xi_k

MARGIN = 10
"""Added radius over the difference of two resolutions."""
_SPARE = 64
_STEPS = 12


def corrected(
    t: Exact, mass: Exact, speed: Exact, xi_2: Exact, xi_3: Exact, digits: int = 40
) -> arb:
    """Return the indentation delta_0 + eta at a time since first contact.

    Parameters
    ----------
    t
        Time [s]; above 0, and before the radicand vanishes.
    mass, speed
        Mass and impact speed of the sphere [kg, m/s].
    xi_2, xi_3
        Coefficients of (10) [N/m, N/m^(5/3)], above 0.
    digits
        Number of decimal digits of the ball.

    Raises
    ------
    ValueError
        If the radicand vanishes earlier.
    derivation.engine.formula.ball.PrecisionError
        If the ball does not become narrow, because the time is too close to that point.
    """
    given = (t, mass, speed, xi_2, xi_3)

    def compute(bits: int) -> tuple[arb]:
        count = bits // 3
        with flint.ctx.workprec(bits + _SPARE):
            fine, coarse = (_indentation(given, nodes) for nodes in (count + 12, count))
            return (fine + arb(0, (MARGIN * abs(fine - coarse)).upper()),)

    return refine_to_digits(compute, digits, f"the paper's motion at t = {t}")[0]


def largest(mass: Exact, speed: Exact, xi_2: Exact) -> arb:
    """Return the largest indentation of the linear motion, (15), at the current precision."""
    return to_ball(speed) * (to_ball(mass) / to_ball(xi_2)).sqrt()


def last_fraction(mass: Exact, speed: Exact, xi_2: Exact, xi_3: Exact) -> arb:
    """Return delta_0 over its largest value where the radicand vanishes, at the current precision.

    Newton's iteration from above, in y with s^2 = y^3, on midpoints; the result is not an
    enclosure.
    """
    excess = _excess(mass, speed, xi_2, xi_3)
    y = arb(min(1.0, float(excess) ** -0.25)) * (1 + arb(2) ** -40)
    for _ in range(_STEPS):
        cube = y**3
        y = (y - (cube + excess * y * cube - 1) / (3 * y**2 + 4 * excess * cube)).mid()
    return (y**3).sqrt()


def _excess(mass: Exact, speed: Exact, xi_2: Exact, xi_3: Exact) -> arb:
    """Return minus the radicand at the linear motion's turning point over the speed's square."""
    values = _values(mass, speed, xi_2, xi_3)
    return -enclose(linearisation()[2].expression, values) / to_ball(speed) ** 2


def _values(mass: Exact, speed: Exact, xi_2: Exact, xi_3: Exact) -> dict[sp.Basic, arb]:
    symbols = (m, v0, xi_k[2], xi_k[3])
    return dict(zip(symbols, map(to_ball, (mass, speed, xi_2, xi_3)), strict=True))


def _indentation(given: tuple[Exact, ...], count: int) -> arb:
    t, *motion = given
    peak, values = largest(*motion[:3]), _values(*motion)
    rate = (values[xi_k[2]] / values[m]).sqrt()
    here, end = (rate * to_ball(t)).sin(), last_fraction(*motion).mid()
    left = 1 - (here / end).root(3)
    if not left > 0:
        raise ValueError(f"the radicand of (17) has vanished before t = {t}")
    goal, start, eta = left.sqrt(), arb(1), arb(0)
    while start > goal:
        stop = goal if goal > start / 2 else start / 2
        eta = _over(eta, start, stop, count, (end, peak, rate), values)
        start = stop
    return peak * here + eta


def _over(
    eta: arb, start: arb, stop: arb, count: int, scales: tuple[arb, arb, arb],
    values: dict[sp.Basic, arb],
) -> arb:  # fmt: skip
    """Return eta at the end of a panel of u: collocation of eta' = -(F eta + G) dt/du."""
    (end, peak, rate), (F, G) = scales, (f.expression for f in linearisation()[:2])
    nodes, weights, within = _rule(count, flint.ctx.prec)
    half = (stop - start) / 2
    growth, source = [], []
    for node in nodes:
        u = (start + stop) / 2 + half * node
        x = 1 - u**2
        s = end * x**3
        # s = sin(rate t), and ds/du = -6 end u x^2.
        step = -6 * end * u * x**2 / (rate * (1 - s**2).sqrt())
        at = {**values, delta_0: peak * s}
        growth.append(enclose(F, at) * step * half)
        source.append(enclose(G, at) * step * half)
    matrix, right = arb_mat(count, count), arb_mat(count, 1)
    for i in range(count):
        right[i, 0] = eta - _dot(within[i], source)
        for k in range(count):
            matrix[i, k] = within[i][k] * growth[k] + (1 if i == k else 0)
    solution = matrix.solve(right)
    inner = [solution[i, 0] for i in range(count)]
    rises = [g * e + q for g, e, q in zip(growth, inner, source, strict=True)]
    return eta - _dot(weights, rises)


@cache
def _rule(count: int, bits: int) -> tuple[list[arb], list[arb], list[list[arb]]]:
    """Return Gauss' nodes and weights on [-1, 1], and integrals from -1 to each node.

    The integrals are linear in the values at the nodes. An interpolant is sum c_k P_k with
    c_k = (k + 1/2) sum w f P_k, and the integral of P_k is (P_(k+1) - P_(k-1))/(2k + 1).
    """
    with flint.ctx.workprec(bits):
        pairs = [arb.legendre_p_root(count, i, weight=True) for i in range(count)]
        nodes, weights = [x for x, _ in pairs], [w for _, w in pairs]
        powers = [_legendre(x, count + 1) for x in nodes]
        within = []
        for row in powers:
            integrals = [1 + row[1]] + [row[k + 1] - row[k - 1] for k in range(1, count)]
            within.append(
                [w * _dot(integrals, p[:count]) / 2 for w, p in zip(weights, powers, strict=True)]
            )
        return nodes, weights, within


def _legendre(x: arb, count: int) -> list[arb]:
    """Return P_0, ..., P_count at a number."""
    polynomials = [arb(1), x]
    for k in range(1, count):
        polynomials.append(((2 * k + 1) * x * polynomials[k] - k * polynomials[k - 1]) / (k + 1))
    return polynomials


def _dot(left: list[arb], right: list[arb]) -> arb:
    return sum((a * b for a, b in zip(left, right, strict=True)), arb(0))
