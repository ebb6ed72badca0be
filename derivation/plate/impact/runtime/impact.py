"""Impact of a sphere on a quasi-static plate: extremes and time history, without time stepping.

With q = a/a_m, the ratio of the contact radius to its largest value, and delta_m the largest
indentation, energy conservation gives every time as an integral of a smooth function::

    t = (delta_m/v0) int 2 (d(delta/delta_m)/dq)/sqrt((1 - E(q)/E_m)/(1 - q)) dw,   q = w (2 - w)

Arithmetic: Newton's and Halley's iterations with their starting values; the sums of the quadrature;
powers that scale the polynomials' terms; scaling of times and results; q = w (2 - w).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from generated import impact_kernels as kernels
from generated.arrays import Double, as_doubles, as_result, in_manifest, inside, quiet
from generated.contact_domain import elastic, modulus_factors, plates_of_lengths
from generated.contact_points import pieces
from generated.contact_series import ROUNDED, Piece, Plates, columns, far_piece, with_slope
from generated.impact_numbers import (
    COARSE_QUADRATURE,
    FULL_QUADRATURE,
    INNER_NODES,
    INNER_WEIGHTS,
    NODES,
    ROUNDING,
    WEIGHTS,
)
from generated.impact_shapes import Beyond, Scenes, cut, mean_work, shapes, time_rate
from generated.ranges import Factors, product

__all__ = [
    "COARSE_QUADRATURE",
    "FULL_QUADRATURE",
    "ROUNDING",
    "History",
    "Impact",
    "history",
    "impact",
]
_STEPS = 60  # largest number of Newton steps; four to six are usual
_CLOSE = 1e-9  # relative residual whose square is far below rounding
_SCENES = 512  # number of impacts in one block, so that intermediate arrays fit in the cache
_BATCH = 32 * _SCENES  # number of impacts solved together, which limits the memory


class Impact(NamedTuple):
    """Results of impacts, in the shape of the arguments; NaN outside the domain.

    Attributes
    ----------
    contact_time
        Contact time [s].
    max_indentation
        Largest indentation [m], plate deflection included.
    max_force
        Largest contact force [N].
    max_contact_radius
        Largest contact radius [m].
    """

    contact_time: np.ndarray
    max_indentation: np.ndarray
    max_force: np.ndarray
    max_contact_radius: np.ndarray


class History(NamedTuple):
    """Motion of impacts at given times.

    Attributes
    ----------
    indentation
        Indentation [m], plate deflection included.
    velocity
        Rate of the indentation [m/s].
    contact_radius
        Contact radius [m].
    force
        Contact force [N].
    """

    indentation: np.ndarray
    velocity: np.ndarray
    contact_radius: np.ndarray
    force: np.ndarray


@in_manifest(
    "",
    equation="13",
    domain="m > 0, v0 > 0, R > 0, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, "
    "3 * lam > -2 * mu, mu > 0, a < R, a <= b, a <= 6 * h for the largest a",
)
@quiet
def impact(
    R: ArrayLike,
    m: ArrayLike,
    v0: ArrayLike,
    h: ArrayLike,
    b: ArrayLike,
    lam: ArrayLike,
    mu: ArrayLike,
    *,
    coarse: bool = False,
) -> Impact:
    """Compute contact time and peak values of an impact that conserves energy.

    Formula::

        (4/3) E* h^5/R^2 int_0^(A_m) A^3 d(A^2 (1 + F)) = m v0^2/2

    Any consistent units are possible (SI, or mm, t, s).

    Parameters
    ----------
    R : array_like
        sphere radius [m]; R > 0
    m : array_like
        sphere mass [kg]; m > 0
    v0 : array_like
        impact speed of the sphere [m/s]; v0 > 0
    h : array_like
        half the plate's thickness [m]; h > 0
    b : array_like
        plate radius [m]; b > 0, 1e-90 <= h/b <= 1e90
    lam : array_like
        first Lame constant [Pa]; 3 lam > -2 mu
    mu : array_like
        second Lame constant (shear modulus) [Pa]; mu > 0
    coarse : bool
        use half the number of quadrature nodes; the relative error of the contact time is
        then at most COARSE_QUADRATURE

    Returns
    -------
    Impact
        Contact time [s], peak indentation [m], peak force [N] and largest contact radius [m]:
        arrays in the arguments' broadcast shape. NaN outside the domain, and where the contact
        radius would exceed R, b or 6 h.

    Examples
    --------
    >>> from generated.impact import impact
    >>> result = impact(0.01, 0.0327, 2.0, 0.004, 0.15, 22.5e9, 28.7e9)
    >>> print(f"{result.contact_time:.6g} s, {result.max_force:.6g} N")
    0.000318047 s, 653.198 N
    """
    kind, given = as_doubles(R, m, v0, h, b, lam, mu)
    shape = np.broadcast_shapes(*(x.shape for x in given))
    results = np.empty((4, int(np.prod(shape))))
    for part in _parts(results.shape[1], _BATCH // _SCENES):
        results[:, part] = _results(pieces(given, shape, part), coarse)
    return Impact(*(as_result(row.reshape(shape), kind) for row in results))


@in_manifest(
    "",
    equation="13",
    domain="m > 0, v0 > 0, R > 0, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, "
    "3 * lam > -2 * mu, mu > 0, a < R, a <= b, a <= 6 * h for the largest a",
)
@quiet
def history(
    t: ArrayLike,
    R: ArrayLike,
    m: ArrayLike,
    v0: ArrayLike,
    h: ArrayLike,
    b: ArrayLike,
    lam: ArrayLike,
    mu: ArrayLike,
) -> History:
    """Compute the state at given times of an impact that begins at t = 0.

    For each time, Newton's method inverts t(q); there is no time stepping.

    Parameters
    ----------
    t : array_like
        time since first contact [s]
    R : array_like
        sphere radius [m]; R > 0
    m : array_like
        sphere mass [kg]; m > 0
    v0 : array_like
        impact speed of the sphere [m/s]; v0 > 0
    h : array_like
        half the plate's thickness [m]; h > 0
    b : array_like
        plate radius [m]; b > 0, 1e-90 <= h/b <= 1e90
    lam : array_like
        first Lame constant [Pa]; 3 lam > -2 mu
    mu : array_like
        second Lame constant (shear modulus) [Pa]; mu > 0

    Returns
    -------
    History
        Indentation [m], indentation rate [m/s], contact radius [m] and force [N]: arrays in
        the arguments' broadcast shape; NaN outside the domain. Before and after the contact
        the velocity is v0 and -v0, and the other values are 0.

    Examples
    --------
    >>> from generated.impact import history
    >>> motion = history([1e-4, 2e-4], 0.01, 0.0327, 2.0, 0.004, 0.15, 22.5e9, 28.7e9)
    >>> print(motion.force.round(3))
    [541.95  598.708]
    """
    kind, [t, R, m, v0, h, b, lam, mu] = as_doubles(t, R, m, v0, h, b, lam, mu)
    scenes, radius, depth, load, ok = _solve(R, m, v0, h, b, lam, mu)
    shape = np.broadcast_shapes(t.shape, ok.shape)
    owner = np.ravel(np.broadcast_to(np.arange(ok.size).reshape(ok.shape), shape))
    whole = np.empty(ok.size)
    for part in _parts(ok.size):
        nodes = np.broadcast_to(NODES, (scenes.A[part].size, NODES.size))
        whole[part] = 2.0 * (time_rate(nodes, scenes, part) * WEIGHTS).sum(axis=1)
    since = np.ravel(np.broadcast_to(np.where(t > 0, product((t, v0), depth), t), shape))
    left = whole[owner] - since
    state = np.empty((4, since.size))
    for part in _parts(since.size):
        state[:, part] = _state(since[part], left[part], scenes, owner[part], whole)

    def spread(*scales: Double | float) -> list[Double]:
        return [np.ravel(np.broadcast_to(x, ok.shape))[owner] for x in scales]

    values = (
        product((state[0], *spread(*depth))),
        state[1] * spread(v0)[0],
        state[2] * spread(radius)[0],
        product((state[3], *spread(*load))),
    )
    return History(*(as_result(value.reshape(shape), kind) for value in values))


def _results(given: list[Double], coarse: bool) -> Double:
    """Return contact time, peak indentation, force and contact radius of a batch, as rows."""
    scenes, radius, depth, load, _ = _solve(*given)
    integral = np.empty_like(scenes.A)
    nodes, weights = (INNER_NODES, INNER_WEIGHTS) if coarse else (NODES, WEIGHTS)
    for part in _parts(scenes.A.size):
        rate = time_rate(np.broadcast_to(nodes, (scenes.A[part].size, nodes.size)), scenes, part)
        integral[part] = (rate * weights).sum(axis=1)
    time = product((2.0, *depth, integral.reshape(radius.shape)), (given[2],))
    several = np.broadcast_arrays(time, product(depth), product(load), radius)
    return np.stack([np.ravel(x) for x in several])


def _state(since: Double, left: Double, scenes: Scenes, owner: np.ndarray, whole: Double) -> Double:
    """Return indentation, velocity, contact radius and force relative to their largest values.

    sqrt(t(w)) is inverted, because t is proportional to w^2 for small w and smooth up to w = 1.
    """
    nearest = np.minimum(since, left)
    inside_contact = nearest > 0
    half = 0.5 * whole[owner]
    goal = np.sqrt(np.where(inside_contact, nearest, half))
    w, moving = goal / np.sqrt(half), np.ones(goal.shape, dtype=bool)
    for _ in range(_STEPS):
        rate = time_rate(w[:, None] * NODES, scenes, owner)
        time = np.sqrt(w * (rate * WEIGHTS).sum(axis=1))
        residual = goal - time
        slope = time_rate(w[:, None], scenes, owner)[:, 0]
        w = np.where(moving, np.clip(w + 2.0 * time * residual / slope, 0.1 * w, 1.0), w)
        moving &= np.abs(residual) > _CLOSE * goal
        if not moving.any():
            break
    lift, _, quotient = (shape[:, 0] for shape in shapes(w[:, None], scenes, owner))
    q = np.where(inside_contact, w * (2.0 - w), 0.0)
    depth, speed, load = kernels.state(q, 1.0 - w, lift, quotient)
    sign = np.where(since < left, 1.0, -1.0)
    state = np.stack((depth, sign * np.where(inside_contact, speed, 1.0), q, load))
    return np.where(np.isnan(nearest), np.nan, state)


def _solve(
    R: Double, m: Double, v0: Double, h: Double, b: Double, lam: Double, mu: Double
) -> tuple[Scenes, Double, Factors, Factors, np.ndarray]:
    """Return the impacts, their largest radius, indentation and force, and the domain mask.

    Indentation and force are those of Hertz's impact times powers of the ratio of the radii,
    so that the error of the radius is not multiplied by two or three.
    """
    ok = (R > 0) & (m > 0) & (v0 > 0) & (h > 0) & (b > 0)
    for condition in elastic(lam, mu):
        ok = ok & condition
    plates, numbers = plates_of_lengths(h, b)
    given = np.broadcast_arrays(R, m, v0, h, b, lam, mu)
    [R, m, v0, h, b, lam, mu] = inside([*given], ok)
    _, modulus = modulus_factors(lam, mu)  # divided by mu
    hertz, *factors = kernels.hertz_impact(R, m, v0, mu, modulus)
    over_h = np.minimum(np.ravel(hertz / h), 1e200)  # larger values lie outside the domain
    owner = np.ravel(np.broadcast_to(numbers, ok.shape))
    pieces = plates.first.coefficients
    work_factors = kernels.work_factor(np.arange(3.0, 2.0 * pieces.shape[0] + 3.0, 2.0))
    energy = Piece(pieces * work_factors[:, None], plates.first.middle, plates.first.half)
    radius_ratio, far = np.empty(over_h.size), np.zeros(over_h.size, dtype=bool)
    for part in _parts(over_h.size, 8):
        radius_ratio[part], far[part] = _deepest(over_h[part], energy, plates, owner[part])
    near = np.where(far, plates.reach[owner], radius_ratio * over_h)
    terms, tails = _scaled(pieces[:, owner], near, plates.reach[owner], work_factors)
    A, lift, whole = near.copy(), 1.0 + terms[::-1].sum(axis=0), kernels.whole_work(tails[0])
    far_ones, slot = np.flatnonzero(far), np.full(over_h.size, -1)
    slot[far_ones] = np.arange(far_ones.size)
    number = np.ravel(kernels.number_of_energy(R, m, v0, h, mu, modulus))
    whole[far_ones], lift[far_ones], A[far_ones], beyond = _far_deepest(
        number[far_ones], near[far_ones], whole[far_ones], plates, owner[far_ones]
    )
    final_ratio = np.where(far, A / over_h, radius_ratio).reshape(ok.shape)
    radius = final_ratio * hertz
    radius = np.where(radius <= ROUNDED * b, np.minimum(radius, b), np.nan)
    [radius] = inside([radius], radius < R)
    lift = np.where(np.isnan(radius.ravel()), np.nan, lift)
    x = np.where(np.isnan(radius), np.nan, final_ratio)
    deep, loaded = kernels.peak_ratios(x, lift.reshape(ok.shape))
    scenes = Scenes(A, lift, whole, terms, tails, slot, beyond)
    return scenes, radius, (*factors[:3], deep), (*factors[3:], loaded), ok


def _scaled(
    pieces: Double, near: Double, reach: Double, work_factors: Double
) -> tuple[Double, Double]:
    """Return terms and tails of `Scenes` from coefficients of powers of A/reach."""
    terms = pieces * near
    ratio = (near / reach) ** 2
    power = ratio.copy()
    for k in range(1, terms.shape[0]):
        terms[k] *= power
        power *= ratio
    tails = terms * work_factors[:, None]
    for k in range(terms.shape[0] - 2, -1, -1):
        tails[k] += tails[k + 1]
    return terms, tails


def _deepest(
    hertz: Double, energy: Piece, plates: Plates, owner: np.ndarray
) -> tuple[Double, np.ndarray]:
    """Return A_m/hertz from E(A) = 2 hertz^5/5, and whether A_m exceeds the first polynomial."""
    piece, end = columns(energy, owner), plates.reach[owner]
    bending = np.maximum(np.asarray(piece.coefficients[0]), 0.0)
    value, _ = with_slope(end, piece)
    most = end / hertz
    far = most < kernels.ratio_of_work(value)
    # For a thin plate, from 2 hertz^5/5 = bending A^6.
    thin = (0.4 / bending / hertz) ** (1.0 / 6.0)
    radius_ratio = np.where(far, np.nan, np.minimum(np.minimum(thin, 1.0), most))
    moving = np.ones(radius_ratio.shape, dtype=bool)  # each impact ends separately from the others
    for _ in range(_STEPS):
        residual, step = kernels.deeper_step(radius_ratio, *with_slope(radius_ratio * hertz, piece))
        after = np.minimum(radius_ratio * np.clip(1.0 + step, 0.3, 3.0), most)
        radius_ratio = np.where(moving, after, radius_ratio)
        moving &= np.abs(residual) > _CLOSE
        if not moving.any():
            break
    return radius_ratio, far


def _far_deepest(
    goal: Double, near: Double, inner: Double, plates: Plates, owner: np.ndarray
) -> tuple[Double, Double, Double, Beyond]:
    """Return E/A^5, 1 + F and A where E(A) = goal beyond the first polynomial, and `Beyond`.

    `inner` is E/A^5 at A = near, the end of that polynomial.
    """
    which, position = np.unique(owner, return_inverse=True)
    piece = columns(far_piece(plates.eta[which]), position)
    end, known = plates.far[owner], inner * near**5

    def rise(A: Double) -> Double:
        """Return (E - E_near)/A^5."""
        rises = np.empty_like(A)
        for part in _parts(A.size, 2):
            mean = mean_work((near[part] / A[part])[:, None], A[part], cut(piece, part))[:, 0]
            rises[part] = kernels.work_beyond(A[part], near[part], mean)
        return rises

    limit = kernels.far_work(known, end, rise(end)) * ROUNDED
    [goal] = inside([goal], end > near, goal <= limit)
    A = np.minimum(near * (goal / known) ** 0.2, end)
    moving = np.ones(A.shape, dtype=bool)
    for _ in range(_STEPS):
        fifth, residual, step = kernels.far_step(A, goal, known, rise(A), *with_slope(A, piece))
        A = np.where(moving, np.clip(A * (1.0 + step), near, end), A)
        moving &= np.abs(residual) > _CLOSE * goal / fifth
        if not moving.any():
            break
    added, ratio = rise(A), near / A
    whole, lift = kernels.far_whole(inner, ratio, added), 1.0 + with_slope(A, piece)[0]
    return whole, lift, A, Beyond(ratio, (A - near) / A, added, piece)


def _parts(size: int, factor: int = 1) -> list[slice]:
    step = _SCENES * factor
    return [slice(start, start + step) for start in range(0, size, step)]
