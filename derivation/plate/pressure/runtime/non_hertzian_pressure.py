"""Contact of a sphere and a plate with the pressure computed from an integral equation.

The pressure is q(r) = -int_r^a chi'(t)/sqrt(t^2 - r^2) dt, where chi solves::

    chi(t) + int_0^a N(t, s) chi(s) ds = (E*/pi) (delta - f(t)),   chi(a) = 0
    P = 2 pi int_0^a chi dt,   N(t, s) = [k((t + s)/b) + k((t - s)/b)]/(2 b)

f = t^2/R for a paraboloid and t artanh(t/R) for an exact sphere. k is the slope of
S = (R/2a) d delta/da for Hertz pressure, so that b k(0) = (3/2) c_1 b/h follows from the
polynomials of `contact_series`. N is a sum of cosines::

    N(t, s) - N(0, 0) = sum nu_i [cos(w_i t) cos(w_i s) - 1]

For a thick plate the sum covers its modes, w = j_n/b, and the lateral surface, w = i y/b with
nu < 0. For a thin plate it covers the nodes of an integral, and a multiple of t^2 + s^2 is added.
N(0, 0), large in a thin plate, is separated: it adds N(0, 0) P/(2 E*) to the indentation. Another
edge (`edge_curvature`) acts like a wave with 1 - 2 t^2/b^2 in place of its cosine.

A plate that bends under a wide contact is curved almost like the sphere, so that all terms with t^2
cancel. The equation is therefore solved for the curvature that remains, with a given force; each
cosine contributes its deviation from a parabola only.

Arithmetic: the equation's matrix as products of the kernel's cosines, sums by Gauss quadrature,
and the conversion of lengths to units of h or b.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from generated import pressure_kernels as kernels
from generated import pressure_numbers as numbers
from generated.arrays import Double, as_doubles, inside, quiet
from generated.contact_series import THICKEST, THINNEST, _bending, _weights, plates_of
from generated.pressure_numbers import NODES, WEIGHTS

_POINTS = np.append(NODES, 1.0)
_BLOCK = 8  # number of contacts in one block, so that intermediate arrays fit in the cache


class Plate(NamedTuple):
    """Kernel N(t, s) of the integral equation of a plate.

    Attributes
    ----------
    h, b
        Half the plate thickness and plate radius [m].
    unit
        Unit of length of the other attributes, h or b [m].
    first
        N(0, 0).
    square
        Coefficient of t^2 + s^2, in addition to the cosines.
    edge
        Coefficient of (1 - 2 t^2/b^2) (1 - 2 s^2/b^2) - 1, for another edge than the paper's.
    waves, wave_weights
        Wave numbers w_i of the cosines, and their weights.
    rises, rise_weights
        Rates y_i of the hyperbolic cosines, and their weights times e^(2 y_i).
    """

    h: float
    b: float
    unit: float
    first: float
    square: float
    edge: float
    waves: Double
    wave_weights: Double
    rises: Double
    rise_weights: Double


class Contact(NamedTuple):
    """Results at given contact radii, all of the shape of the arguments; NaN outside the domain.

    All are NaN where the pressure at the centre would be negative: contact is lost there.

    Attributes
    ----------
    a
        Contact radius [m].
    force
        Contact force P [N].
    indentation
        Indentation delta [m].
    stiffness
        dP/d delta [N/m].
    slope
        d delta/da [1].
    energy
        Work of the force since first contact [J].
    centre_pressure
        Pressure at the centre [Pa], positive.
    mean_pressure
        P/(pi a^2) [Pa].
    nodes, chi
        Points t [m] along a last axis, and chi(t) [N/m] there; chi is the Abel transform of the
        pressure.
    """

    a: Double
    force: Double
    indentation: Double
    stiffness: Double
    slope: Double
    energy: Double
    centre_pressure: Double
    mean_pressure: Double
    nodes: Double
    chi: Double


class _Waves(NamedTuple):
    """C = 1 - cos(w t) = q x^2 - e at x = t/a, scaled by e^-y; shape (contacts, points, waves)."""

    rises: Double  # C
    deviations: Double  # e
    bends: Double  # e'(x)/x
    parabolas: Double  # q, of shape (contacts, 1, waves) like the weights
    weights: Double  # with their signs and the factor a
    faded: Double  # the value of cos(0) in that scaling, of shape (waves,)


class _Solution(NamedTuple):
    """Solution with chi in E* a^2/(pi R) and depths in a^2/R; shape (contacts,) or more."""

    chi: Double
    force: Double  # int_0^1 chi dx
    depth: Double  # delta without the contribution of N(0, 0)
    work: Double  # int_0^1 chi (depth - f) dx
    firm: Double  # depth of a flat punch with int_0^1 psi dx = 1
    rim: Double  # its psi at x = 1
    bends: Double  # -chi'(x)/x at the nodes and at x = 1
    curvature: Double  # that of the sphere minus that of the plate at the centre, times R


def plate(h: float, b: float, edge: float = 0.0) -> Plate:
    """Compute the kernel of a plate, which all its contacts share.

    Parameters
    ----------
    h : float
        half the plate's thickness [m]; h > 0
    b : float
        plate radius [m]; b > 0, 1e-90 <= h/b <= 1e90
    edge : float
        coefficient of (t^2 + s^2)/h^3 by another edge [1], see `edge_curvature`

    Returns
    -------
    Plate
        Argument of `contact`. Outside the domain its numbers are NaN.

    Examples
    --------
    >>> from generated.non_hertzian_pressure import plate
    >>> print(f"{plate(0.004, 0.15).first:.6g}")
    168.576
    """
    _, [height, radius] = as_doubles(h, b)
    h, b, none = float(height), float(radius), np.zeros(0)
    if not (h > 0 and b > 0 and THINNEST <= h / b <= THICKEST):
        return Plate(*6 * (np.nan,), none, none, none, none)
    eta = h / b
    bent = -edge / (2.0 * eta * eta * eta)
    first = numbers.FIRST * float(plates_of(np.array([eta])).first.coefficients[0, 0])
    if eta * numbers.THIN < 1.0:
        # k h = 3/2 c_1 + 15/2 c_3 A^2 + the integral of cos - 1 + (A T/2)^2/2.
        square = numbers.CUBIC * float(_bending(np.array(1.0 / eta))[1]) + numbers.SQUARE
        waves = numbers.WAVES, numbers.WAVE_WEIGHTS
        return Plate(h, b, h, first, square, bent * eta, *waves, none, none)
    zeros, weights = _weights(np.asarray(eta), int(numbers.FADED / (2.0 * np.pi * eta)) + 2)
    lateral = numbers.LATERAL, numbers.LATERAL_WEIGHTS
    return Plate(h, b, b, first / eta, 0.0, bent, zeros, numbers.MODES * weights, *lateral)


@quiet
def contact(
    plate: Plate,
    a: ArrayLike,
    R: ArrayLike,
    modulus: ArrayLike,
    plate_modulus: ArrayLike | None = None,
    *,
    sphere: bool = False,
    compliance: ArrayLike = 0.0,
) -> Contact:
    """Compute force, indentation, stiffness and pressure at given contact radii.

    Formula (step 20 of the derivation)::

        (I + N) psi = 1,  (I + N) omega = f,  chi = (E*/pi) (delta psi - omega)
        dP/d delta = 2 E* int_0^a psi dt,  U = pi int_0^a chi (delta - f) dt

    Parameters
    ----------
    plate : Plate
        kernel returned by `plate`
    a : array_like
        contact radius [m]; 0 < a <= 0.95 b, a <= 7 h, a < R; for an exact sphere, a <= 0.95 R
    R : array_like
        sphere radius [m]; R > 0
    modulus : array_like
        E* of the contact [Pa]: 1/E* is the sum of those of sphere and plate; > 0
    plate_modulus : array_like, optional
        E* of the plate alone [Pa], equal to `modulus` for a rigid sphere; >= modulus
    sphere : bool
        use the profile of an exact sphere (Sneddon 1965) instead of its paraboloid
    compliance : array_like
        indentation per force that the support adds [m/N]; negative for a stiffer support

    Returns
    -------
    Contact
        Its arrays have the arguments' broadcast shape. NaN outside the domain, and where contact
        would be lost at the centre, near a = 6 h in a thin plate. Relative errors are below
        `pressure_numbers.ERROR`, those of pressures over the mean pressure, as tested.

    Examples
    --------
    >>> from generated.non_hertzian_pressure import contact, plate
    >>> result = contact(plate(0.004, 0.15), 0.01, 0.5, 75e9)
    >>> print(f"{result.force:.6g} N, {result.indentation:.6g} m")
    23003.2 N, 0.00643546 m
    """
    own_modulus = modulus if plate_modulus is None else plate_modulus
    given = np.broadcast_arrays(*as_doubles(a, R, modulus, own_modulus, compliance)[1])
    a, R, modulus, own_modulus, compliance = (np.array(x) for x in given)
    widest = np.minimum(numbers.WIDEST_OVER_B * plate.b, numbers.WIDEST * plate.h)
    holds = (a > 0, a <= widest, a <= numbers.WIDEST_OVER_R * R if sphere else a < R)
    elastic = (modulus > 0, own_modulus >= modulus, ~np.isnan(compliance))
    a, R, modulus, own_modulus = inside([a, R, modulus, own_modulus], *holds, *elastic)
    flat = [np.ravel(x) for x in (a, R, modulus / own_modulus)]
    blocks = [slice(i, i + _BLOCK) for i in range(0, a.size, _BLOCK)] or [slice(None)]
    parts = [_solve(plate, flat[0][x], flat[1][x], flat[2][x], sphere) for x in blocks]
    whole = (np.concatenate(each) for each in zip(*parts, strict=True))
    solved = _Solution(*(x.reshape((*a.shape, *x.shape[1:])) for x in whole))
    return _contact(plate, solved, (a, R, modulus, own_modulus, compliance))


def _contact(plate: Plate, solution: _Solution, given: tuple[Double, ...]) -> Contact:
    """Convert from units of the half-space to those of the arguments."""
    a, R, modulus, own_modulus, compliance = given
    centre = solution.bends[..., :-1] @ WEIGHTS
    values = kernels.contact_results(
        a, R, modulus, own_modulus, compliance, np.asarray(plate.first), np.asarray(plate.unit),
        *solution[1:6], solution.bends[..., -1], centre,
    )  # fmt: skip
    chi = solution.chi * kernels.chi_unit(a, R, modulus)[..., None]
    closed = values[5] > 0
    arrays = [np.where(closed, x, np.nan) for x in (a, *values)]
    wide = [np.where(closed[..., None], x, np.nan) for x in (a[..., None] * NODES, chi)]
    return Contact(*arrays, *wide)


def _waves(plate: Plate, a: Double, x: Double, modulus_ratio: Double) -> _Waves:
    """Return the waves at points x = t/a of shape (contacts, points)."""
    points, ratio = x[:, :, None], (a / plate.unit)[:, None, None]
    scale = ratio * modulus_ratio[:, None, None]
    shapes = kernels.wave(points, ratio * plate.waves)
    parts = [_Waves(*shapes, scale * plate.wave_weights, np.ones_like(plate.waves))]
    if plate.rises.size:
        shapes = kernels.lateral_wave(points, ratio * plate.rises, plate.rises)
        parts.append(_Waves(*shapes, -scale * plate.rise_weights, np.exp(-plate.rises)))
    if plate.edge:
        bent, parabola = kernels.edge_wave(points, (a / plate.b)[:, None, None])
        none = np.zeros_like(bent)
        parts.append(_Waves(bent, none, none, parabola, scale * plate.edge, np.ones(1)))
    if len(parts) == 1:  # without a copy
        return parts[0]
    return _Waves(*(np.concatenate(each, axis=-1) for each in zip(*parts, strict=True)))


def _solve(plate: Plate, a: Double, R: Double, modulus_ratio: Double, sphere: bool) -> _Solution:
    """Return chi at the nodes and its integrals; `modulus_ratio` is E* over the plate's.

    The sphere's curvature determines the force, and zero curvature the end of the flat punch.
    """
    x = np.broadcast_to(_POINTS, (a.size, _POINTS.size))
    waves = _waves(plate, a, x, modulus_ratio)
    square = plate.square * (a / plate.unit) ** 3 * modulus_ratio
    deviation, bend = _deviation(x, (a / R)[:, None], sphere)
    chis, ends, curvatures = _unit_solutions(waves, x, deviation)
    transforms = _transforms(waves, chis)
    bent = curvatures + (waves.parabolas @ transforms)[:, 0]
    force = (1.0 - bent[:, 2]) / (bent[:, 0] - square)
    rim = (square - bent[:, 0]) / bent[:, 1]
    rises = (waves.rises[:, :-1] @ (waves.weights * waves.faded).mT)[:, :, 0]
    depths = ends + ((WEIGHTS * (square[:, None] * NODES**2 - rises))[:, None] @ chis)[:, 0]
    firm = depths[:, 0] + rim * depths[:, 1]
    whole = np.stack((force, np.zeros_like(force), np.ones_like(force)), axis=1)[:, :, None]
    chi = (chis @ whole)[:, :, 0]
    depth, curvature = (force * part[:, 0] + part[:, 2] for part in (depths, curvatures))
    work = (chi * (depth[:, None] - x[:, :-1] ** 2 - deviation[:, :-1])) @ WEIGHTS
    bends = _bends(waves, transforms @ whole, curvature, bend)
    return _Solution(chi, force, depth, work, firm, rim, bends, curvature)


def _unit_solutions(waves: _Waves, x: Double, deviation: Double) -> tuple[Double, Double, Double]:
    """Return chi at the nodes, D and the remaining curvature, by Nystroem's method.

    Along the last axis: for int_0^1 chi dx = 1, for chi(1) = 1, and for the sphere's deviation from
    its paraboloid; the other two are zero. At a given force the equation is never singular.
    """
    count = NODES.size
    kernel = (waves.deviations * waves.weights) @ _cosines(waves)
    system = np.zeros((len(x), count + 2, count + 2))
    system[:, :-1, :-2] = np.where(np.isfinite(kernel), kernel, 0.0)
    system[:, :-2, :-2] += np.eye(count)
    system[:, :-1, -2:] = np.stack((-np.ones_like(x), x**2), axis=2)
    system[:, -1, :-2] = WEIGHTS
    sides = np.zeros((len(x), count + 2, 3))
    sides[:, -1, 0], sides[:, -2, 1], sides[:, :-1, 2] = 1.0, -1.0, -deviation
    parts = np.asarray(np.linalg.solve(system, sides), dtype=float)
    return parts[:, :-2], parts[:, -2], parts[:, -1]


def _deviation(x: Double, c: Double, sphere: bool) -> tuple[Double, Double]:
    """Return f R/a^2 - x^2, and its slope with respect to x divided by x, for c = a/R."""
    if sphere:
        return kernels.sphere(x, c)
    return np.zeros_like(x), np.zeros_like(x)


def _cosines(waves: _Waves) -> Double:
    """Return the rows of int_0^1 chi cos(w a x) dx, scaled like the waves."""
    return WEIGHTS * (waves.faded - waves.rises[:, : NODES.size]).mT


def _transforms(waves: _Waves, chis: Double) -> Double:
    """Return int_0^1 chi cos(w a x) dx times the weights; chi of shape (contacts, nodes, any)."""
    return waves.weights.mT * (_cosines(waves) @ chis)


def _bends(waves: _Waves, transforms: Double, curvature: Double, bend: Double) -> Double:
    """Return -chi'(x)/x."""
    return (waves.bends @ transforms)[:, :, 0] + (2.0 * curvature)[:, None] + bend


@quiet
def pressure(
    r: ArrayLike,
    plate: Plate,
    a: float,
    R: float,
    modulus: float,
    plate_modulus: float | None = None,
    *,
    sphere: bool = False,
) -> np.ndarray:
    """Compute the contact pressure q(r) = -sigma_zz >= 0 of one contact.

    Formula (step 20 of the derivation)::

        q(r) = sqrt(a^2 - r^2) int_0^1 -chi'(t)/t du,  t = sqrt(r^2 + (a^2 - r^2) u^2)

    Parameters
    ----------
    r : array_like
        distance from the axis [m]; 0 <= r <= a
    plate, a, R, modulus, plate_modulus, sphere
        as in `contact`, one value each

    Returns
    -------
    float or ndarray
        Pressure [Pa] in the shape of r; NaN outside the domain, and for all r if contact would
        be lost at the centre.

    Examples
    --------
    >>> from generated.non_hertzian_pressure import plate, pressure
    >>> print(pressure([0.0, 0.005], plate(0.004, 0.15), 0.01, 0.5, 75e9).round(-3))
    [79788000. 85992000.]
    """
    state = contact(plate, a, R, modulus, plate_modulus, sphere=sphere)
    _, [r] = as_doubles(r)
    [r] = inside([r], r >= 0, r <= float(state.a))
    if not state.force > 0:
        return np.full(r.shape, np.nan)[()]
    own_modulus = float(modulus if plate_modulus is None else plate_modulus)
    radius, modulus_ratio = np.array([float(a)]), np.array([float(modulus) / own_modulus])
    solution = _solve(plate, radius, np.array([float(R)]), modulus_ratio, sphere)
    nodes = _waves(plate, radius, _POINTS[None], modulus_ratio)
    transforms = _transforms(nodes, solution.chi[:, :, None])
    ratio = np.ravel(r) / float(a)
    result = np.empty(ratio.size)
    for start in range(0, ratio.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        x, front = kernels.pressure_points(ratio[part, None], NODES)
        places = x.reshape(1, -1)
        waves = _waves(plate, radius, places, modulus_ratio)
        _, bend = _deviation(places, np.asarray(a / R), sphere)
        bends = _bends(waves, transforms, solution.curvature, bend)
        result[part] = front[:, 0] * (bends.reshape(x.shape) @ WEIGHTS)
    return (kernels.pressure_unit(*map(np.asarray, (a, R, modulus))) * result.reshape(r.shape))[()]
