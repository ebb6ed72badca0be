"""Tables of doubles for the generated code of the corrected contact law.

The law is delta = (a^2/R) (1 + F), F a function of A = a/h and eta = h/b (alpha = a/b = A eta):

    F   = W(alpha) + (8 alpha/(3 pi)) sum_n w_n g(alpha j_n)
    w_n = (G(2 eta j_n) - 1)/(j_n J1(j_n)^2)
    g   = 3 (sin y - y cos y)/y^3
    W   = -(8/pi^2) sum_(k>=2) kappa_(2k-4) (2k-2)/(2k-1)! alpha^(2k-3)
    kappa_n = int_0^oo y^n K0(y)/I0(y) dy

and, up to O(e^(-4.2124/eta + 2.11 A)), with M_k = FP int_0^oo T^(2k-4) (G - 1) dT (Hadamard),

    F   ~ c1 A + c3 A^3 + Phi(A)
    Phi = (2A/(3 pi)) int_0^oo (G - 1) (g(AT/2) - 1 + (AT/2)^2/10) dT
    c1  = 1/(4 pi eta^2) + (2/(3 pi)) [M_2 + (6/5) (gE - ln 4 eta)]
    c3  = -(1/(60 pi)) [M_3 + 6 (gE - ln 4 eta)]

Every table is the interpolation polynomial of an exact function at Chebyshev nodes,
rewritten in powers and rounded once, at the end.
"""

from collections.abc import Callable, Sequence
from functools import cache
from math import ceil

import flint
from flint import arb as Ball

from derivation.engine.formula.ball import enclose
from derivation.mathematics.bessel.kernels import bessel_zero, nearest_double
from derivation.plate.contact.kernels.moments import (
    BITS,
    excess_nodes,
    finite_parts,
    kappas,
    midpoint,
)
from derivation.plate.contact.kernels.series import constant
from derivation.plate.contact.theory.thin_plate import plate_excess
from derivation.plate.vocabulary import M

REACH = 3
"""End of the first polynomial: A = REACH or alpha = 1, whichever is smaller."""
FAR_REACH = 6
"""Largest A of the second polynomial, a polynomial in A^2."""
TERMS, SHORT_TERMS, FAR_TERMS = 19, 7, 24
"""Numbers of coefficients of the first polynomial, of its beginning, and of the second."""
SHORT = 6
"""The short polynomial is used for x = A/reach up to 1/SHORT."""
MODES = 11
"""Number of modes that are needed for eta >= 1/REACH: w_n decays like e^(-4 eta j_n)."""
CELLS = ((3, 4, 20), (4, 6, 22), (6, 11, 23))
"""Ranges of 1/eta, each with the number of powers that represent the thin plate's remainder.

They represent its derivative too. Beyond the last range the remainder is negligible up to
A = FAR_REACH, and the closed form is used alone.
"""
FAR_CELLS = ((3, 4, 20), (4, 6, 21), (6, 8, 19), (8, 11, 18))
"""Ranges of 1/eta with the number of powers that represent F/A itself for A > REACH."""
WIDE_START = 2
"""Smallest A of the second polynomial in the first range of FAR_CELLS.

Otherwise its range could shrink to a point, because its end, alpha = 1, can be arbitrarily close to
REACH.
"""
IMPACT_NODES, INNER_NODES = 24, 12
"""Numbers of Gauss nodes of the integrals over the impact, enough for c1 A from -0.37 to 1e17.

The second number is for A > REACH, where the nearest singularity is farther away.
"""
_NEGLIGIBLE = 2.0**-60

Rows = tuple[tuple[float, ...], ...]


def edge_part(alpha: Ball) -> Ball:
    """Return W(alpha)/alpha, 0 <= alpha <= 1, by its series in kappa_n; terms fall like 4^-k."""
    square, total = alpha * alpha, Ball(0)
    factorial = Ball(6)
    power = Ball(1)
    for index, kappa in enumerate(kappas()[::2]):
        k = index + 2
        total += kappa * (2 * k - 2) / factorial * power
        power *= square
        factorial *= (2 * k) * (2 * k + 1)
    return -8 * total / Ball.pi() ** 2


def shape(y: Ball) -> Ball:
    """Return g(y) = 3 (sin y - y cos y)/y^3, which is 1 at y = 0."""
    if y == 0:
        return Ball(1)
    return 3 * (y.sin() - y * y.cos()) / y**3


def thin_part(A: Ball) -> Ball:
    """Return Phi(A)/A, the thin plate's universal function."""
    if A == 0:
        return Ball(0)
    total = Ball(0)
    for T, weight, excess in excess_nodes():
        if T < _NEGLIGIBLE:  # the integrand is O(T): the omitted part is O(T^2)
            continue
        y = A * T / 2
        total += weight * excess * (shape(y) - 1 + y * y / 10)
    return midpoint(2 * total / (3 * Ball.pi()))


@cache
def thin_constants() -> tuple[Ball, Ball]:
    """Return K1, K3: c1 = v^2/(4 pi) + K1 + 4 ln(v)/(5 pi), c3 = K3 - ln(v)/(10 pi), v = 1/eta."""
    with flint.ctx.workprec(BITS):
        known = dict(zip((M[2], M[3]), finite_parts(), strict=False))
        linear, cubic = (enclose(constant(k), known) for k in (2, 3))
        return midpoint(linear), midpoint(cubic)


def thin_numbers() -> tuple[float, float]:
    """Return K1 and K3, rounded."""
    with flint.ctx.workprec(BITS):
        linear, cubic = _round(thin_constants())
        return linear, cubic


@cache
def modes(count: int) -> tuple[tuple[Ball, Ball], ...]:
    """Return j_n and 1/(j_n J1(j_n)^2) for the first modes."""
    with flint.ctx.workprec(BITS):
        zeros = [bessel_zero(0, index) for index in range(1, count + 1)]
        return tuple(
            (midpoint(zero), midpoint(1 / (zero * zero.bessel_j(Ball(1)) ** 2))) for zero in zeros
        )


def whole_over_radius(v: Ball, radii: Sequence[Ball]) -> list[Ball]:
    """Return F/A from W and the sum over the modes.

    Parameters
    ----------
    v
        1/eta [1].
    radii
        A = a/h [1].
    """
    count = 5 * ceil(float(v)) + 8  # e^(-4 eta j) < 1e-26 beyond
    weights = [(zero / v, w * plate_excess(2 * zero / v)) for zero, w in modes(count)]
    values = []
    for A in radii:
        total = sum((weight * shape(A * phi) for phi, weight in weights), Ball(0))
        values.append((edge_part(A / v) + 8 * total / (3 * Ball.pi())) / v)
    return values


def thin_remainder(v: Ball, radii: Sequence[Ball], thin: Sequence[Ball]) -> list[Ball]:
    """Return F/A - c1 - c3 A^2 - Phi/A, the remainder of the thin plate's closed form, over A.

    Parameters
    ----------
    v
        1/eta [1].
    radii, thin
        A = a/h [1], and Phi/A there.
    """
    pi, log = Ball.pi(), v.log()
    constant, cubic = thin_constants()
    linear, cubic = v * v / (4 * pi) + constant + 4 * log / (5 * pi), cubic - log / (10 * pi)
    return [
        whole - linear - cubic * A * A - known
        for A, known, whole in zip(radii, thin, whole_over_radius(v, radii), strict=True)
    ]


def chebyshev_nodes(count: int) -> list[Ball]:
    """Return the zeros of the Chebyshev polynomial of this degree, from 1 down to -1."""
    return [((2 * i + 1) * Ball.pi() / (2 * count)).cos() for i in range(count)]


def in_powers(values: Sequence[Ball], variable: tuple[int, int] = (0, 1)) -> list[Ball]:
    """Return the coefficients in powers of z, constant first, of an interpolation polynomial.

    Parameters
    ----------
    values
        Values at `chebyshev_nodes`, in their order.
    variable
        The nodes' t in terms of z: t = variable[0] + variable[1] z.
    """
    count = len(values)
    nodes = chebyshev_nodes(count)
    shift, factor = variable
    former, latter = [Ball(0)] * count, [Ball(1)] + [Ball(0)] * (count - 1)
    at_former, at_latter = list(nodes), [Ball(1)] * count  # T_(-1) = T_1, T_0
    total = [Ball(0)] * count
    for degree in range(count):
        weight = sum((f * at for f, at in zip(values, at_latter, strict=True)), Ball(0)) / count
        total = [a + weight * b * min(degree + 1, 2) for a, b in zip(total, latter, strict=True)]
        grown = [shift * b + factor * a for a, b in zip([Ball(0), *latter], latter, strict=False)]
        double = 1 if degree == 0 else 2
        former, latter = latter, [double * a - b for a, b in zip(grown, former, strict=True)]
        at_former, at_latter = (
            at_latter,
            [2 * t * a - b for t, a, b in zip(nodes, at_latter, at_former, strict=True)],
        )
    return total


UNIT = (-1, 2)
"""Variable of polynomials in z = (1 + t)/2, which runs over [0, 1]."""


def _over_squares(function: Callable[[Ball], Ball], count: int) -> list[Ball]:
    """Return the even function of x as a polynomial in x^2, 0 <= x <= 1."""
    return in_powers([function(x) for x in _roots(count)], UNIT)


def _roots(count: int) -> list[Ball]:
    """Return the values of x for which x^2 is a Chebyshev node of [0, 1]."""
    return [((1 + t) / 2).sqrt() for t in chebyshev_nodes(count)]


def _round(balls: Sequence[Ball]) -> tuple[float, ...]:
    return tuple(nearest_double(ball) for ball in balls)


@cache
def tables() -> dict[str, Rows]:
    """Return every table by name: rows of correctly rounded coefficients, constant terms first.

    thin, far_thin
        Phi/A in powers of (A/3)^2, and of t = (A^2 - 22.5)/13.5.
    edge, modes
        W/alpha in powers of alpha^2, and (8/(3 pi)) g(alpha j_n) for each n.
    cell_0, ...
        The thin plate's remainder over A: for each power of tau (1/eta, scaled to [-1, 1])
        a row in powers of (A/3)^2.
    far_0, ...
        F/A itself for A > 3: likewise, in powers of t in [-1, 1], A^2 scaled.
    short
        Row j: the contributions of x^(2k), k = SHORT_TERMS, ..., to the coefficient of x^(2j) of
        the short polynomial, 0 <= x <= 1/SHORT.
    """
    with flint.ctx.workprec(BITS):
        rows = {
            "thin": (_round(_over_squares(lambda x: thin_part(REACH * x), TERMS)),),
            "far_thin": (_round(_far_thin()),),
            "edge": (_round(_over_squares(edge_part, TERMS)),),
            "modes": tuple(_round(_mode(zero)) for zero, _ in modes(MODES)),
            "short": tuple(
                zip(*map(_round, map(_shortened, range(SHORT_TERMS, TERMS))), strict=True)
            ),
        }
        cells = {f"cell_{index}": _cell(*cell) for index, cell in enumerate(CELLS)}
        return rows | cells | {f"far_{i}": _far_cell(*cell) for i, cell in enumerate(FAR_CELLS)}


def _far_radii(top: Ball, start: int = REACH) -> list[Ball]:
    """Return the values of A whose squares are Chebyshev nodes between start^2 and top^2."""
    low, high = start**2, top * top
    return [((low + high + (high - low) * t) / 2).sqrt() for t in chebyshev_nodes(FAR_TERMS)]


def _far_thin() -> list[Ball]:
    return in_powers([thin_part(A) for A in _far_radii(Ball(FAR_REACH))])


def _mode(zero: Ball) -> list[Ball]:
    return _over_squares(lambda x: 8 * shape(x * zero) / (3 * Ball.pi()), TERMS)


def _shortened(power: int) -> list[Ball]:
    """Return z^power, 0 <= z <= 1/SHORT^2, in terms of fewer powers of z."""
    scale = SHORT**2
    row = _over_squares(lambda x: (x * x / scale) ** power, SHORT_TERMS)
    return [a * scale**j for j, a in enumerate(row)]


def _cell(first: int, last: int, count: int) -> Rows:
    """Return the thin plate's remainder for first <= 1/eta <= last."""
    radii = [REACH * x for x in _roots(TERMS)]
    thin = [thin_part(A) for A in radii]
    return _in_thickness(
        [in_powers(thin_remainder(v, radii, thin), UNIT) for v in _cell_nodes(first, last, count)]
    )


def _far_cell(first: int, last: int, count: int) -> Rows:
    """Return F/A for A > REACH, up to A = FAR_REACH or alpha = 1, for first <= 1/eta <= last."""
    start = WIDE_START if first == REACH else REACH
    return _in_thickness(
        [
            in_powers(whole_over_radius(v, _far_radii(v.min(Ball(FAR_REACH)), start)))
            for v in _cell_nodes(first, last, count)
        ]
    )


def _cell_nodes(first: int, last: int, count: int) -> list[Ball]:
    middle, half = Ball(first + last) / 2, Ball(last - first) / 2
    return [middle + half * t for t in chebyshev_nodes(count)]


def _in_thickness(rows: Sequence[Sequence[Ball]]) -> Rows:
    """Return the rows at the nodes of a cell as powers of tau, rounded."""
    powers = [in_powers(column) for column in zip(*rows, strict=True)]
    return tuple(_round(row) for row in zip(*powers, strict=True))


def gauss_legendre(count: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return Gauss-Legendre nodes and weights on [0, 1], correctly rounded."""
    with flint.ctx.workprec(BITS):
        pairs = [Ball.legendre_p_root(count, i, weight=True) for i in reversed(range(count))]
        return _round([(1 + x) / 2 for x, _ in pairs]), _round([w / 2 for _, w in pairs])
