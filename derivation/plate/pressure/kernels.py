"""Numbers that the generated solution for the true pressure needs: its quadratures.

With lengths in units of b the kernel is

    k(x) = (4/pi) sum w_n cos(x j_n) - (4/pi^2) int_0^oo K0(y)/I0(y) cosh(x y) dy.

For 1/eta up to THIN few modes count; beyond it the sum is the thin plate's integral
(1/pi) int (G - 1) cos(A T/2) dT with its c_1 and c_3, up to e^(-4.2124/eta + 2.11 x/h) as in
the contact law. Either way k is a sum of cosines, so that its matrices are products.
"""

import flint
from flint import arb as Ball

from derivation.mathematics.bessel.kernels import nearest_double, wrapped
from derivation.plate.contact.kernels.moments import BITS
from derivation.plate.contact.theory.thin_plate import plate_excess

NODES = 24
"""Collocation points: the positive ones of a rule on (-a, a) exact up to the degree 95."""
THIN = 16
"""1/eta beyond which a plate is thin: e^(-4.2124 THIN + 2.11 * 2 WIDEST) is below 1e-16."""
WIDEST = 7
"""Largest a/h. In a thin plate the contact opens before that."""
DIRECTIONS, LARGEST_T = 80, 24
"""Gauss' nodes for a thin plate, where 4 T^2 e^(-2T), which is G - 1 there, is below 1e-17."""
FADED = 23
"""Modes count up to T = 2 eta j_n = FADED in plates that are not thin."""
WIDEST_SHARE = "0.95"
"""Largest a/b: the kernel is singular where t + s = 2 b."""
WALL_STEPS, WALL_FIRST, WALL_LAST = 5, -12, 30
"""Trapezoids in u, this many to 1, of the side wall's integral, y = exp(u - e^(-u)).

What is integrated goes like y^2 log y, and is below 1e-20 before the first; the last y is 400.
"""


def pressure_context() -> dict[str, object]:
    """Tables as text: collocation, the thin plate's wave numbers, the side wall's places."""
    found: dict[str, object] = {}
    with flint.ctx.workprec(3 * BITS):
        for name, pairs in (("nodes", _collocation()), ("waves", _waves()), ("wall", _wall())):
            places, weights = zip(*pairs, strict=True)
            found[f"{name}_places"] = wrapped(repr(nearest_double(x)) for x in places)
            found[f"{name}_weights"] = wrapped(repr(nearest_double(x)) for x in weights)
    return found | {
        "thin": str(THIN),
        "widest": str(WIDEST),
        "faded": str(FADED),
        "widest_share": WIDEST_SHARE,
        "points": str(NODES),
    }


def _collocation() -> list[tuple[Ball, Ball]]:
    """x = t/a, rising, with the weights of int_0^1."""
    pairs = [Ball.legendre_p_root(2 * NODES, i, weight=True) for i in reversed(range(NODES))]
    return [(x, w) for x, w in pairs]


def _waves() -> list[tuple[Ball, Ball]]:
    """Wave numbers times h, T/2, and weights of the thin plate's integral, (G - 1)/pi in them."""
    half = Ball(LARGEST_T) / 2
    pairs = [Ball.legendre_p_root(DIRECTIONS, i, weight=True) for i in reversed(range(DIRECTIONS))]
    places = [(half * (1 + x), half * w) for x, w in pairs]
    return [(T / 2, w * plate_excess(T) / Ball.pi()) for T, w in places]


def wall_places() -> list[float]:
    """Places y of the side wall's integral, rising."""
    with flint.ctx.workprec(3 * BITS):
        return [nearest_double(y) for y, _ in _wall()]


def _wall() -> list[tuple[Ball, Ball]]:
    """Places y and weights of the side wall's integral, times e^(2y): (4/pi^2) K0/I0 in them."""
    found = []
    for index in range(WALL_FIRST, WALL_LAST + 1):
        u = Ball(index) / WALL_STEPS
        fade = (-u).exp()
        y = (u - fade).exp()
        bessel = y.bessel_k(Ball(0)) / y.bessel_i(Ball(0)) * (2 * y).exp()
        found.append((y, y * (1 + fade) / WALL_STEPS * bessel * 4 / Ball.pi() ** 2))
    return found
