"""Contact of a sphere and a plate with the pressure computed from an integral equation.

The pressure is q(r) = -int_r^a chi'(t)/sqrt(t^2 - r^2) dt, where chi solves::

    chi(t) + int_0^a N(t, s) chi(s) ds = (E*/pi) (delta - f(t)),   chi(a) = 0
    P = 2 pi int_0^a chi dt,   N(t, s) = [k((t + s)/b) + k((t - s)/b)]/(2 b)

f = t^2/R for a paraboloid and t artanh(t/R) for an exact sphere. k is the slope of
S = (R/2a) d delta/da for Hertz pressure, so that b k(0) = (3/2) c_1 b/h follows from the
polynomials of `contact_series`. N is a sum of cosines; with C = 1 - cos::

    N(t, s) - N(0, 0) = sum nu_i [C(w_i t) C(w_i s) - C(w_i t) - C(w_i s)]

For a thick plate the sum covers its modes, w = j_n/b, and the lateral surface, w = i y/b with
nu < 0. For a thin plate it covers the nodes of an integral, and a multiple of t^2 + s^2 is added.
N(0, 0), large in a thin plate, is separated: it adds N(0, 0) P/(2 E*) to the indentation. The term
t^2 + s^2 acts like additional curvature, so that the pressure's shape depends on a/h alone. Another
edge (`edge_curvature`) acts like a wave with 1 - 2 t^2/b^2 in place of its cosine.

Arithmetic: the equation's matrix as products of the kernel's cosines, sums by Gauss quadrature,
and the conversion of lengths to units of h or b.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from generated import pressure_kernels as kernels
from generated.arrays import Double, as_doubles, inside, quiet
from generated.contact_series import THICKEST, THINNEST, _bending, _weights, plates_of
from generated.pressure_numbers import (
    CUBIC,
    FADED,
    FIRST,
    LATERAL,
    LATERAL_WEIGHTS,
    MODES,
    NODES,
    SQUARE,
    THIN,
    WAVE_WEIGHTS,
    WAVES,
    WEIGHTS,
    WIDEST,
    WIDEST_OVER_B,
)

_POINTS = np.append(NODES, 1.0)
_BLOCK = 8  # number of contacts in one block, so that intermediate arrays fit in the cache
_BORDER = (0, 0), (0, 1), (0, 1)  # of matrices, by one row and one column


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
    """C = 1 - cos(w t) at points t/a of shape (contacts, points, waves), scaled by e^-y.

    `bends` is dC/dx divided by x, with x = t/a. `weights` contain signs and the factor a;
    `faded` is the value of cos(0) in that scaling. Shapes: (contacts, waves) and (waves,).
    """

    rises: Double
    bends: Double
    weights: Double
    faded: Double


class _Solution(NamedTuple):
    """Solution with chi in E* a^2/(pi R) and depths in a^2/R; shape (contacts,) or more."""

    chi: Double
    force: Double  # int_0^1 chi dx
    depth: Double  # delta without the contribution of N(0, 0)
    work: Double  # int_0^1 chi (depth - f) dx
    firm: Double  # depth of a flat punch with int_0^1 psi dx = 1
    rim: Double  # its psi at x = 1
    bends: Double  # -chi'(x)/x at the nodes and at x = 1


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
    first = FIRST * float(plates_of(np.array([eta])).first.coefficients[0, 0])
    if eta * THIN < 1.0:
        # k h = 3/2 c_1 + 15/2 c_3 A^2 + the integral of cos - 1 + (A T/2)^2/2.
        square = CUBIC * float(_bending(np.array(1.0 / eta))[1]) + SQUARE
        return Plate(h, b, h, first, square, bent * eta, WAVES, WAVE_WEIGHTS, none, none)
    zeros, weights = _weights(np.asarray(eta), int(FADED / (2.0 * np.pi * eta)) + 2)
    first /= eta
    return Plate(h, b, b, first, 0.0, bent, zeros, MODES * weights, LATERAL, LATERAL_WEIGHTS)


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
        contact radius [m]; 0 < a <= 0.95 b, a <= 7 h, a < R
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
        would be lost at the centre, which happens near a = 6 h in a thin plate. Relative errors are
        below `pressure_numbers.ERROR`, as measured for h/b from 1e-4 to 1e5: 1e-15 up to a = h, and
        7e-14 near a = 6 h, where the pressure at the centre almost vanishes.

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
    holds = (a > 0, a <= WIDEST_OVER_B * plate.b, a <= WIDEST * plate.h, a < R)
    elastic = (modulus > 0, own_modulus >= modulus, ~np.isnan(compliance))
    a, R, modulus, own_modulus = inside([a, R, modulus, own_modulus], *holds, *elastic)
    flat = [np.ravel(x) for x in (a, R, modulus / own_modulus)]
    sizes: tuple[tuple[int, ...], ...] = ((NODES.size,), (), (), (), (), (), (_POINTS.size,))
    inner = [np.empty((flat[0].size, *size)) for size in sizes]
    for start in range(0, flat[0].size, _BLOCK):
        part = slice(start, start + _BLOCK)
        solution = _solve(plate, flat[0][part], flat[1][part], flat[2][part], sphere)
        for values, part_values in zip(inner, solution, strict=True):
            values[part] = part_values
    solved = _Solution(*(x.reshape((*a.shape, *x.shape[1:])) for x in inner))
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
    ratio, points = (a / plate.unit)[:, None], x[:, :, None]
    phase, rise = (ratio * plate.waves)[:, None, :], (ratio * plate.rises)[:, None, :]
    parts = [kernels.wave(points, phase), kernels.lateral_wave(points, rise, plate.rises)]
    weights = [plate.wave_weights, -plate.rise_weights]
    faded = [np.ones(plate.waves.size), np.exp(-plate.rises)]
    if plate.edge:
        width = np.broadcast_to((a / plate.b)[:, None, None], points.shape)
        parts.append(kernels.edge_wave(points, width))
        weights.append(np.array([plate.edge]))
        faded.append(np.ones(1))
    rises, bends = (np.concatenate(part, axis=2) for part in zip(*parts, strict=True))
    scaled = ratio * np.concatenate(weights) * modulus_ratio[:, None]
    return _Waves(rises, bends, scaled, np.concatenate(faded))


def _solve(plate: Plate, a: Double, R: Double, modulus_ratio: Double, sphere: bool) -> _Solution:
    """Return chi at the nodes by Nystroem's method; `modulus_ratio` is E* over the plate's.

    The force is given, 0 for the profile and 1 for the flat punch, and the depth is unknown: at a
    given depth the equation without N(0, 0) is singular at some radius.
    """
    x = np.broadcast_to(_POINTS, (a.size, _POINTS.size))
    waves = _waves(plate, a, x, modulus_ratio)
    square = plate.square * (a / plate.unit) ** 3 * modulus_ratio
    weighted = waves.rises * waves.weights[:, None, :]
    alone = weighted @ waves.faded - square[:, None] * x**2
    kernel = weighted @ np.swapaxes(waves.rises[:, :-1], 1, 2)
    kernel -= alone[:, :, None] + alone[:, None, :-1]
    kernel = np.where(np.isfinite(kernel), kernel, 0.0)
    system = np.pad(np.eye(NODES.size) + kernel[:, :-1] * WEIGHTS, _BORDER, constant_values=-1.0)
    system[:, -1] = np.append(WEIGHTS, 0.0)
    profile, bend = _profile(x, (a / R)[:, None], sphere)
    sides = np.stack((-profile, np.zeros_like(profile)), axis=2)
    sides[:, -1] = 0.0, 1.0
    parts: Double = np.linalg.solve(system, sides)
    depths: Double = parts[:, -1]
    ends = depths - (kernel[:, -1:] * WEIGHTS @ parts[:, :-1])[:, 0]
    force = (profile[:, -1] - ends[:, 0]) / ends[:, 1]
    chi: Double = parts[:, :-1, 0] + force[:, None] * parts[:, :-1, 1]
    depth = depths[:, 0] + force * depths[:, 1]
    work = (chi * (depth[:, None] - profile[:, :-1])) @ WEIGHTS
    bends = bend - _bends(waves, _transform(waves, chi)) + 2.0 * (square * force)[:, None]
    return _Solution(chi, force, depth, work, depths[:, 1], ends[:, 1], bends)


def _profile(x: Double, c: Double, sphere: bool) -> tuple[Double, Double]:
    """Return f R/a^2, and its slope with respect to x divided by x, for c = a/R."""
    if sphere:
        return kernels.sphere(x, c)
    return kernels.paraboloid(x, np.ones_like(x * c))


def _transform(waves: _Waves, chi: Double) -> Double:
    """Return int_0^1 chi cos(w a x) dx, scaled like the waves."""
    weighted = (chi * WEIGHTS)[:, None, :]
    near = waves.rises[:, : NODES.size]
    whole: Double = weighted.sum(axis=2) * waves.faded - (weighted @ near)[:, 0]
    return whole


def _bends(waves: _Waves, transform: Double) -> Double:
    """Return the contribution of the waves to chi'(x)/x."""
    return np.asarray(waves.bends @ (waves.weights * transform)[:, :, None])[:, :, 0]


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
    points = np.broadcast_to(_POINTS, (1, _POINTS.size))
    solution = _solve(plate, radius, np.array([float(R)]), modulus_ratio, sphere)
    transform = _transform(_waves(plate, radius, points, modulus_ratio), solution.chi)
    square = 2.0 * plate.square * (radius / plate.unit) ** 3 * modulus_ratio * solution.force
    ratio = np.ravel(r) / float(a)
    result = np.empty(ratio.size)
    for start in range(0, ratio.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        x, front = kernels.pressure_points(ratio[part, None], NODES)
        waves = _waves(plate, radius, x.reshape(1, -1), modulus_ratio)
        _, bend = _profile(x, np.asarray(a / R), sphere)
        bends = bend - _bends(waves, transform).reshape(x.shape) + square
        result[part] = front[:, 0] * (bends @ WEIGHTS)
    return (kernels.pressure_unit(*map(np.asarray, (a, R, modulus))) * result.reshape(r.shape))[()]
