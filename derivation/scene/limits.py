"""Where the contact law ends or grows inexact: refusals and warnings, each with its number."""

import math

import numpy as np

from derivation.scene import kernels
from derivation.scene.model import Model
from derivation.scene.scene import SceneError

HERTZ_LIMIT = 0.15
"""Contact radius over thickness above which the pressure is no longer Hertz's."""
CURVATURE_LIMIT = 0.3
"""Contact radius over sphere radius above which the sphere is no longer a paraboloid."""
STRETCH_LIMIT = 0.5
"""Plate deflection over thickness above which the plate's middle surface stretches."""
MILD = 0.3
"""Relative correction above which its leading term is no estimate any more."""
POINTS = 48
"""Gauss points of the energy; the integrand is smooth, rounding is reached well before."""


def check_radius(model: Model, a: float, what: str, mend: str) -> None:
    """Refuse a contact radius beyond the law's range.

    Parameters
    ----------
    a
        Contact radius [m].
    what
        What asks for it, named as the user knows it.
    mend
        What the user can do.

    Raises
    ------
    SceneError
        If a reaches min(b, R).
    """
    if a >= model.radius_limit:
        raise SceneError(
            f"{what}: expected a contact radius below {_limit(model)}, got {a:.6g} m; {mend}"
        )


def check_range(model: Model, indentation: float) -> None:
    """Refuse an indentation beyond the one at which the contact radius reaches its limit.

    Parameters
    ----------
    indentation
        Indentation [m].

    Raises
    ------
    SceneError
        If it lies beyond.
    """
    largest = float(kernels.indentation(_last_radius(model), model.R, model.h, model.b))
    if indentation >= largest:
        raise SceneError(
            f"indentation: expected less than {largest:.6g} m, where the contact radius reaches "
            f"{_limit(model)}, got {indentation:.6g} m; give a smaller indentation"
        )


def check_energy(model: Model) -> None:
    """Refuse an impact that presses the sphere in beyond the law's range.

    Raises
    ------
    SceneError
        If the sphere's energy is more than the contact takes up to a = min(b, R).
    """
    capacity = energy_of(model, _last_radius(model))
    fastest = math.sqrt(2) * math.sqrt(max(capacity, 0.0)) / math.sqrt(model.m)
    if model.v0 >= fastest:
        raise SceneError(
            f"impact.speed: expected less than {fastest:.6g} m/s, where the contact radius "
            f"reaches {_limit(model)}, got {model.v0:.6g} m/s; lower the speed"
        )


def check_numbers(model: Model, *values: float) -> None:
    """Refuse results that are no numbers above zero, which extreme scenes lead to.

    Raises
    ------
    SceneError
        If a value is NaN, infinite, or zero by underflow.
    """
    if not all(math.isfinite(value) and value > 0 for value in values):
        numbers = ", ".join(f"{name} = {x:.6g}" for name, x in model.dimensionless().items())
        raise SceneError(
            f"scene: the contact law gives no number for {numbers}; give less extreme numbers"
        )


def energy_of(model: Model, a: float) -> float:
    """Energy the contact takes up to a contact radius, the integral of P over the indentation.

    Parameters
    ----------
    a
        Contact radius [m].

    Returns
    -------
    float
        Energy [J].
    """
    # By parts, with P growing like a^3, so that no derivative of the indentation is needed.
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    q = (1 + nodes) / 2
    with np.errstate(all="ignore"):  # extreme scenes end in NaN, which is looked for
        P = kernels.force_of_radius(a, model.R, model.lam, model.mu)
        delta = kernels.indentation(np.append(q * a, a), model.R, model.h, model.b)
    return float(P * (delta[-1] - 3 * np.sum(weights / 2 * q**2 * delta[:-1])))


def warnings_at(model: Model, a: float, indentation: float) -> tuple[str, ...]:
    """What to know about a result that is still usable.

    Parameters
    ----------
    a
        Largest contact radius [m].
    indentation
        Indentation at it [m].
    """
    found = []
    thickness = 2 * model.h
    if a / thickness > HERTZ_LIMIT:
        found.append(
            f"contact radius over thickness a/H = {a / thickness:.3g} exceeds {HERTZ_LIMIT}: the "
            f"pressure is no longer Hertz's; {_cost(hertz_cost(model, a, indentation))}"
        )
    if a / model.R > CURVATURE_LIMIT:
        found.append(
            f"contact radius over sphere radius a/R = {a / model.R:.3g} exceeds "
            f"{CURVATURE_LIMIT}: the law takes the sphere for a paraboloid; "
            f"{_cost(curvature_cost(model, a, indentation))}"
        )
    deflection = indentation - a * (a / model.R)
    if deflection / thickness > STRETCH_LIMIT:
        found.append(
            f"plate deflection over thickness w/H = {deflection / thickness:.3g} exceeds "
            f"{STRETCH_LIMIT}: the plate stretches and is stiffer than the linear law says"
        )
    return tuple(found)


def hertz_cost(model: Model, a: float, indentation: float) -> float:
    """Relative change of the indentation at a given force, were the pressure not Hertz's [1].

    To leading order the true pressure turns c3 of delta = (a^2/R) (1 + c1 A + c3 A^3 + ...),
    A = a/h, into (8/3) c3. Three terms of this law, taken at a and a/2, leave that of c3 alone:
    delta(a) - 8 delta(a/2) + a^2/R = (3/4) c3 A^3 a^2/R.
    """
    half = float(kernels.indentation(a / 2, model.R, model.h, model.b))
    cubic = 4 / 3 * (indentation - 8 * half + a * (a / model.R))
    return 5 / 3 * cubic / indentation


def curvature_cost(model: Model, a: float, indentation: float) -> float:
    """Relative change of the indentation at a given force, were the sphere not a paraboloid [1].

    To leading order Sneddon's law of the exact profile, indentation (a/2) ln((R+a)/(R-a)),
    adds (1/15) (a/R)^2 times a^2/R, the smaller contact radius at that force included.
    """
    return (a / model.R) ** 2 / 15 * a * (a / model.R) / indentation


def _cost(change: float) -> str:
    if abs(change) > MILD:
        return f"the error is too large to estimate (leading term {100 * change:+.2g} % of it)"
    return f"the indentation at this force would change by about {100 * change:+.2g} %"


def _last_radius(model: Model) -> float:
    """Largest contact radius inside the law's range [m]."""
    return float(np.nextafter(model.radius_limit, 0.0))


def _limit(model: Model) -> str:
    return f"min(b, R) = {model.radius_limit:.6g} m"
