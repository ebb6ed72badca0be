"""Limits of the contact law: errors beyond its range, warnings where it becomes inaccurate."""

import math
from typing import Any, NamedTuple, NoReturn, TypeVar

import numpy as np

from derivation.scene import kernels, scales
from derivation.scene.contact_law.corrections import (
    correction_in_words,
    pressure_correction,
    profile_correction,
    stretching,
)
from derivation.scene.contact_law.impact_errors import EXACT, ImpactErrors
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.errors import SceneError, wide_contact
from derivation.scene.kernels import Numbers
from derivation.scene.model import Model
from derivation.scene.numerics import columns
from derivation.scene.numerics.quadrature import gauss
from derivation.scene.scales import zener_number
from generated.arrays import Double as Array

HERTZ_LIMIT = 0.15
"""Contact radius over thickness above which the pressure is no longer Hertzian."""
PARABOLOID_LIMIT = 0.3
"""Contact radius over sphere radius above which a paraboloid no longer approximates the sphere."""
STRETCH_LIMIT = 0.5
"""Plate deflection over thickness above which membrane stretching stiffens the plate."""
ZENER_LIMIT = 0.006
"""Zener parameter above which bending waves in an infinite plate take 1 % of the speed."""
QUASI_STATIC_PERIODS = 10.0
"""Contact time over first bending period above which the plate responds quasi-statically."""
DEFLECTION_LIMIT = 0.01
"""Plate deflection over indentation below which, with a small Zener parameter, the inertia of the
plate is negligible."""
SOLID_LIMIT = 1 / 3
"""Sphere mass over that of a solid sphere of its material below which it may be hollow."""
Values = TypeVar("Values", float, Array)
MARGIN = 1e-3
"""Relative quadrature error of the largest possible speed, where a law is steep."""
POINTS = 192
"""Number of Gauss points of the energy up to the limit, near which a sphere's slope is steep."""


def check_radius(law: ContactLaw, a: float, key: str, remedy: str) -> None:
    """Raise an error if a contact radius is outside the range of the law.

    Parameters
    ----------
    a
        Contact radius [m].
    key
        Key or argument that determines the radius, as the user writes it.
    remedy
        What the user can do.

    Raises
    ------
    SceneError
        If a reaches the law's limit.
    """
    if a >= law.limit:
        raise wide_contact(key, law.limit_in_words, f"{a:.6g}", remedy, a / law.limit)


def refuse(law: ContactLaw) -> NoReturn:
    """Raise the error of an impact that has no largest contact radius in the law's range.

    Raises
    ------
    SceneError
        If the speed or the weight is too large for the law, or a value for double precision.
    """
    check_energy(law, MARGIN)
    raise _no_number(law.model)


def check_energy(law: ContactLaw, margin: float = 0.0) -> None:
    """Raise an error if the sphere has more energy than the contact absorbs up to the law's limit.

    Parameters
    ----------
    margin
        Relative quadrature error of the largest possible speed [1].

    Raises
    ------
    SceneError
        If the kinetic energy or the weight is too large.
    """
    model = law.model
    last = last_radius(law)
    with np.errstate(all="ignore"):
        capacity = energy_of(law, last)
        depth = float(law.indentation(np.array([last]), law.at(np.array([last])))[0])
    weight = model.m * law.gravity * depth
    if capacity <= weight:
        raise _too_heavy(law) if weight else _no_energy(law)
    capacity -= weight
    fastest = math.sqrt(2) * math.sqrt(max(capacity, 0.0)) / math.sqrt(model.m)
    if model.v0 >= fastest * (1.0 - margin):
        fastest = min(fastest, model.v0)
        raise SceneError(
            f"impact.speed: expected less than {fastest:.6g} m/s, where the contact radius "
            f"reaches {law.limit_in_words}, got {model.v0:.6g} m/s; reduce the speed"
        )


def _too_heavy(law: ContactLaw) -> SceneError:
    """Return the error for a sphere whose weight alone exceeds the law's range, at any speed."""
    model = law.model
    return SceneError(
        f"impact.gravity: expected a weight that the plate can carry, got {model.m:.4g} kg at "
        f"{law.gravity:.4g} m/s^2: even at zero speed the contact radius exceeds "
        f"{law.limit_in_words}; use a lighter sphere, a thicker or stiffer plate, or set "
        "effects.gravity = false"
    )


def _no_energy(law: ContactLaw) -> SceneError:
    """Return the error for a law that absorbs no energy, so that no speed is possible."""
    return SceneError(
        f"scene: expected a contact law that absorbs energy up to {law.limit_in_words}, got the "
        f"law of {', '.join(sorted(law.effects))}, which absorbs none; use a thicker plate, or "
        "remove the keys of [effects] that are false"
    )


def check_numbers(model: Model, *values: float) -> None:
    """Raise an error if a result of an extreme scene is not a positive finite number.

    Raises
    ------
    SceneError
        If a value is NaN, infinite, or zero by underflow.
    """
    if not all(math.isfinite(value) and value > 0 for value in values):
        raise _no_number(model)


def _no_number(model: Model) -> SceneError:
    """Return the error for values so extreme that the contact law gives no finite number."""
    numbers = ", ".join(f"{name} = {x:.6g}" for name, x in model.dimensionless().items())
    return SceneError(
        f"scene: the contact law gives no finite number for {numbers}; use less extreme values"
    )


def energy_of(law: ContactLaw, a: Values) -> Values:
    """Return the energy [J] absorbed up to a contact radius [m], the integral of P over delta.

    For many scenes, radii and energies are columns.
    """
    x, weights = gauss(POINTS)
    shape = law.at(x * a)
    power = weights * x**4 * shape.force * shape.slope
    mean: Any = columns.number(np.sum(power, axis=-1, keepdims=True))
    return 8.0 / 3.0 * law.modulus * a * a * (a / law.model.R) * a * (a / law.model.R) * mean  # type: ignore[no-any-return]


def warnings_at(
    law: ContactLaw,
    a: float,
    indentation: float,
    deflection: float | None = None,
    correction: float | None = None,
    errors: ImpactErrors = EXACT,
) -> tuple[str, ...]:
    """Return warnings about a wide contact or a large deflection, or one that may be so.

    Parameters
    ----------
    a
        Largest contact radius [m].
    indentation
        Indentation at that radius [m].
    deflection
        Largest deflection of the plate at the axis [m]; by default that of the quasi-static plate.
    correction
        The `pressure_correction`, if it has been computed.
    errors
        Errors of radius and indentation.
    """
    model, notes = law.model, []
    thickness = 2 * model.h
    widest = float(errors.largest_radius(a))
    if widest / thickness > HERTZ_LIMIT and not law.solved:
        if correction is None:
            correction = float(pressure_correction(model, a, indentation))
        notes.append(
            f"contact radius over thickness a/H = "
            f"{_compared(a / thickness, widest / thickness, HERTZ_LIMIT)}: the pressure is no "
            f"longer Hertzian; "
            f"{correction_in_words(correction)}"
        )
    if widest / model.R > PARABOLOID_LIMIT and not law.spherical:
        notes.append(
            f"contact radius over sphere radius a/R = "
            f"{_compared(a / model.R, widest / model.R, PARABOLOID_LIMIT)}: the law approximates "
            "the sphere by a paraboloid; "
            f"{correction_in_words(profile_correction(model, a, indentation))}"
        )
    if deflection is None:
        deflection = indentation - float(local_indentation(law, a))
    largest = float(errors.largest_deflection(deflection, indentation))
    if largest / thickness > STRETCH_LIMIT and not law.stretches:
        ratios = _compared(deflection / thickness, largest / thickness, STRETCH_LIMIT)
        notes.append(
            f"plate deflection over thickness w/H = {ratios}: membrane stretching makes the plate "
            "stiffer than in the linear law, under a static load by a factor of about "
            f"{1.0 + stretching(model, deflection):.3g}"
        )
    return tuple(notes)


def _compared(value: float, largest: float, limit: float) -> str:
    """Return a value that exceeds a limit, or may do so within its error, in words."""
    if value > limit:
        return f"{value:.3g} exceeds {limit}"
    return f"{value:.3g}, within its error up to {largest:.3g}, may exceed {limit}"


class PlateTimes(NamedTuple):
    """Zener parameter [1], first bending period [s], time of two reflections of a wave [s]."""

    zener: float
    period: float
    echoes: float


def plate_times(model: Model) -> PlateTimes:
    """Return the quantities that show whether plate inertia matters; requires the density."""
    h, b, lam, mu = model.numbers[3:]
    period: float = kernels.bending_period(h, b, lam, mu, model.density)  # type: ignore[assignment]
    echoes: float = kernels.echo_time(h, lam, mu, model.density)  # type: ignore[assignment]
    return PlateTimes(zener_number(model), period, echoes)


def neglects_inertia(
    model: Model,
    contact_time: float,
    deflection: float,
    dynamic: bool = False,
    known: PlateTimes | None = None,
    errors: ImpactErrors = EXACT,
) -> bool:
    """Return whether plate inertia is neglected but may matter; False if the density is unknown.

    The arguments are those of `motion_warnings`.
    """
    if dynamic or not model.density:
        return False
    times = known or plate_times(model)
    if slow_for(model, errors.shortest_time(contact_time), times):
        return False
    return bool(times.zener > ZENER_LIMIT or deflection > DEFLECTION_LIMIT)


def slow_for(model: Model, contact_time: Numbers, known: PlateTimes | None = None) -> bool:
    """Return whether an impact is slow enough for a plate to be quasi-static."""
    period = (known or plate_times(model)).period
    return bool(contact_time >= QUASI_STATIC_PERIODS * period)


def motion_warnings(
    model: Model,
    contact_time: float,
    deflection: float,
    dynamic: bool = False,
    known: PlateTimes | None = None,
    errors: ImpactErrors = EXACT,
) -> tuple[str, ...]:
    """Return warnings about neglected inertia and wave reflections; none without a density.

    Parameters
    ----------
    contact_time
        Contact time [s].
    deflection
        Plate deflection over the largest indentation [1].
    dynamic
        Whether plate inertia is included.
    known
        Characteristic times of the plate, if they have been computed.
    errors
        Error of the contact time.
    """
    if not model.density:
        return ()
    zener, period, echoes = times = known or plate_times(model)
    notes = []
    if neglects_inertia(model, contact_time, deflection, dynamic, times, errors):
        notes.append(
            f"plate inertia is neglected but may matter: Zener parameter {zener:.3g} (negligible "
            f"below {ZENER_LIMIT}); contact time / first bending period "
            f"{contact_time / period:.3g} (quasi-static above {QUASI_STATIC_PERIODS:g}); "
            f"plate deflection {100 * deflection:.3g} % of the indentation"
        )
    plate = model.inertia
    echoing = dynamic and plate.branches == "all"
    if float(errors.shortest_time(contact_time)) < echoes and not echoing:
        waves = (
            "through-thickness wave reflections return during the contact, but the model neglects "
            "them"
        )
        if contact_time < echoes / 2.0:
            waves = (
                "the contact ends before through-thickness waves return from the back face, but "
                "in the model the thickness responds without delay"
            )
        notes.append(
            f"the contact time {'is' if contact_time < echoes else 'may be'} below 4 H/c_P = "
            f"{echoes:.3g} s (H thickness, c_P speed of "
            f"compressional waves): {waves}"
        )
    return tuple(notes)


def hollow_warnings(model: Model) -> tuple[str, ...]:
    """Return a warning if the sphere is far too light to be solid."""
    volume = scales.volume(model.R)
    solid = volume * model.solid_density
    if model.m < SOLID_LIMIT * solid:
        light = (
            f"mass is {model.m / solid:.2g} times that of a solid sphere of its material "
            f"({solid:.4g} kg)"
        )
    elif model.m < volume * model.lightest_density:
        light = (
            f"density, {model.m / volume:.3g} kg/m^3, is below that of all solids with these "
            "elastic constants"
        )
    else:
        return ()
    return (f"the sphere {light}: the model does not include the bending of a hollow sphere",)


def local_indentation(law: ContactLaw, a: Values) -> Values:
    """Return the local indentation [m], that of a half-space, at contact radii [m]."""
    R = law.model.R
    depth = kernels.sphere_contact(a / R).depth if law.spherical else 1.0
    indentation: Values = a * (a / R) * depth  # type: ignore[assignment]
    return indentation


def last_radius(law: ContactLaw) -> float:
    """Return the largest contact radius [m] within the range of the law."""
    return float(np.nextafter(law.limit, 0.0))
