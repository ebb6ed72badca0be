"""Where the contact law ends or grows inexact: refusals and warnings, each with its number."""

import math
from collections.abc import Sequence
from typing import NamedTuple, NoReturn, TypeVar

import numpy as np

from derivation.scene import kernels
from derivation.scene.effects.effect import Array
from derivation.scene.law import ContactLaw
from derivation.scene.model import Model
from derivation.scene.quadrature import gauss
from derivation.scene.scene import SceneError

HERTZ_LIMIT = 0.15
"""Contact radius over thickness above which the pressure is no longer Hertz's."""
CURVATURE_LIMIT = 0.3
"""Contact radius over sphere radius above which the sphere is no longer a paraboloid."""
STRETCH_LIMIT = 0.5
"""Plate deflection over thickness above which the plate's middle surface stretches."""
ZENER_LIMIT = 0.006
"""Zener's number above which an infinite plate's waves carry off 1 % of the speed."""
QUASI_STATIC_PERIODS = 10.0
"""Contact time over the first bending period from which the plate follows without inertia."""
SHARE_LIMIT = 0.01
"""Share of the plate's deflection in the indentation below which its inertia is no matter."""
SOLID_LIMIT = 1 / 3
"""Mass of a sphere over that of a solid one of its material below which it may be hollow."""
GRAZING = 1e-3
"""Approach speed over the impact speed, or force over the largest, below which a contact grazes."""
SMALL_CORRECTION = 0.3
"""Relative correction above which its leading term is no estimate any more."""
Values = TypeVar("Values", float, Array)
MARGIN = 1e-3
"""Relative error that quadratures may make in the fastest speed, where a law is steep."""
POINTS = 192
"""Gauss points of the energy up to the law's limit, close to which a sphere's slope is steep."""


def check_radius(law: ContactLaw, a: float, what: str, mend: str) -> None:
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
        If a reaches the law's limit.
    """
    if a >= law.limit:
        raise SceneError(
            f"{what}: expected a contact radius below {law.limit_in_words}, got {a:.6g} m; {mend}"
        )


def refuse(law: ContactLaw) -> NoReturn:
    """Refuse an impact that has no largest contact radius in the law's range.

    Raises
    ------
    SceneError
        Of what is too large for the law, or for doubles.
    """
    check_energy(law, MARGIN)
    raise _no_number(law.model)


def check_energy(law: ContactLaw, margin: float = 0.0) -> None:
    """Refuse an impact that presses the sphere in beyond the law's range.

    Parameters
    ----------
    margin
        Share of the speed [1] by which quadratures may differ on what is too fast.

    Raises
    ------
    SceneError
        If the sphere's energy is more than the contact takes up to the law's limit.
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
            f"reaches {law.limit_in_words}, got {model.v0:.6g} m/s; lower the speed"
        )


def _too_heavy(law: ContactLaw) -> SceneError:
    """Of a sphere whose weight alone presses it in beyond the law's range, at any speed."""
    model = law.model
    return SceneError(
        f"impact.gravity: expected a sphere whose weight the plate carries, got {model.m:.4g} kg "
        f"at {law.gravity:.4g} m/s^2, which press it in beyond {law.limit_in_words} even at zero "
        "speed; give a lighter sphere, a thicker or stiffer plate, or effects.gravity = false"
    )


def _no_energy(law: ContactLaw) -> SceneError:
    """Of a law that takes up no energy, which no speed can satisfy."""
    return SceneError(
        f"scene: expected a contact law that takes up energy up to {law.limit_in_words}, got one "
        f"of {', '.join(sorted(law.effects))} that takes up none; give a thicker plate, or leave "
        "out what [effects] switches off"
    )


def check_numbers(model: Model, *values: float) -> None:
    """Refuse results that are no numbers above zero, which extreme scenes lead to.

    Raises
    ------
    SceneError
        If a value is NaN, infinite, or zero by underflow.
    """
    if not all(math.isfinite(value) and value > 0 for value in values):
        raise _no_number(model)


def _no_number(model: Model) -> SceneError:
    """Of numbers so extreme that the contact law gives none."""
    numbers = ", ".join(f"{name} = {x:.6g}" for name, x in model.dimensionless().items())
    return SceneError(
        f"scene: the contact law gives no number for {numbers}; give less extreme numbers"
    )


def energy_of(law: ContactLaw, a: float) -> float:
    """Energy [J] the contact takes up to a contact radius [m], the integral of P over delta."""
    x, weights = gauss(POINTS)
    shape = law.at(x * a)
    mean = float(np.sum(weights * x**4 * shape.force * shape.slope))
    return 8.0 / 3.0 * law.modulus * a * a * (a / law.model.R) * a * (a / law.model.R) * mean


def warnings_at(
    law: ContactLaw, a: float, indentation: float, deflection: float | None = None
) -> tuple[str, ...]:
    """What to know about a result that is still usable.

    Parameters
    ----------
    a
        Largest contact radius [m].
    indentation
        Indentation at it [m].
    deflection
        Largest deflection of the plate at the axis [m], where its motion was computed; without
        it that of the quasi-static plate.
    """
    model, found = law.model, []
    thickness = 2 * model.h
    if a / thickness > HERTZ_LIMIT and not law.solved:
        found.append(
            f"contact radius over thickness a/H = {a / thickness:.3g} exceeds {HERTZ_LIMIT}: the "
            f"pressure is no longer Hertz's; {_cost(hertz_cost(model, a, indentation))}"
        )
    if a / model.R > CURVATURE_LIMIT and not law.spherical:
        found.append(
            f"contact radius over sphere radius a/R = {a / model.R:.3g} exceeds "
            f"{CURVATURE_LIMIT}: the law takes the sphere for a paraboloid; "
            f"{_cost(curvature_cost(model, a, indentation))}"
        )
    if deflection is None:
        deflection = indentation - float(local_indentation(law, a))
    if deflection / thickness > STRETCH_LIMIT:
        found.append(
            f"plate deflection over thickness w/H = {deflection / thickness:.3g} exceeds "
            f"{STRETCH_LIMIT}: the plate stretches and is stiffer than the linear law says"
        )
    return tuple(found)


def zener_number(model: Model) -> float:
    """Zener's number of the contact's own modulus, the sphere's elasticity included [1]."""
    R, m, v0, h, _, lam, mu = model.numbers
    found = kernels.zener_number(R, m, v0, h, lam, mu, model.density)
    number: float = found / np.power(1.0 + model.softness, 0.4)
    return number


class PlateTimes(NamedTuple):
    """Zener's number [1], the first bending period and the time of two echoes [s] of a plate."""

    zener: float
    period: float
    echoes: float


def plate_times(model: Model) -> PlateTimes:
    """What tells whether the plate's inertia matters; the density has to be known."""
    h, b, lam, mu = model.numbers[3:]
    period: float = kernels.bending_period(h, b, lam, mu, model.density)  # type: ignore[assignment]
    echoes: float = kernels.echo_time(h, lam, mu, model.density)  # type: ignore[assignment]
    return PlateTimes(zener_number(model), period, echoes)


def contact_warnings(speeds: Sequence[float], least: float) -> tuple[str, ...]:
    """Warn of grazing contacts, where the number of contacts is sensitive to rounding.

    Parameters
    ----------
    speeds
        Relative approach speeds of the contacts over the impact speed [1].
    least
        Smallest force between two maxima of it, over the largest [1]; 1 if there is none.
    """
    slow = min(speeds)
    if slow >= GRAZING and least >= GRAZING:
        return ()
    how = f"grazing contact: the force falls to {least:.2g} of its largest value"
    if slow < GRAZING:
        how = f"grazing re-contact at {slow:.2g} of the impact speed"
    text = (
        f"{how}; the number of contacts and the restitution are sensitive to rounding of the input"
    )
    return (text,)


def neglects_inertia(
    model: Model,
    contact_time: float,
    deflection: float,
    dynamic: bool = False,
    known: PlateTimes | None = None,
) -> bool:
    """Whether the plate's inertia is neglected and may matter, as far as its density is known.

    The arguments are those of `motion_warnings`.
    """
    if dynamic or not model.density:
        return False
    zener, period, _ = known or plate_times(model)
    slow = contact_time >= QUASI_STATIC_PERIODS * period
    return not slow and (zener > ZENER_LIMIT or deflection > SHARE_LIMIT)


def motion_warnings(
    model: Model,
    contact_time: float,
    deflection: float,
    dynamic: bool = False,
    known: PlateTimes | None = None,
) -> tuple[str, ...]:
    """Where the plate's own motion, which is left out, is not small; needs its density.

    Parameters
    ----------
    contact_time
        Contact time [s].
    deflection
        Share of the plate's deflection in the largest indentation [1].
    dynamic
        Whether the plate has inertia.
    known
        The plate's times, if they are known already.
    """
    if not model.density:
        return ()
    zener, period, echoes = times = known or plate_times(model)
    found = []
    if neglects_inertia(model, contact_time, deflection, dynamic, times):
        found.append(
            f"plate inertia is neglected but may matter: Zener's number lambda = {zener:.3g} "
            f"(negligible below {ZENER_LIMIT}), contact time over the first bending period on the "
            f"paper's edge = {contact_time / period:.3g} (quasi-static above "
            f"{QUASI_STATIC_PERIODS:g}), plate deflection {100 * deflection:.3g} % of the "
            "indentation"
        )
    plate = model.inertia
    echoing = dynamic and plate.branches == "all" and not plate.infinite_plate
    if contact_time < echoes and not echoing:
        found.append(
            f"the contact time is below 4 H/c_P = {echoes:.3g} s: echoes through the thickness, "
            "which are left out, return during the contact"
        )
    return tuple(found)


def hollow_warnings(model: Model) -> tuple[str, ...]:
    """Whether the sphere is far too light to be solid, if its material's density is known."""
    solid = 4 / 3 * math.pi * model.R * model.R * model.R * model.solid_density
    if model.m >= SOLID_LIMIT * solid:
        return ()
    text = (
        f"the sphere's mass is {model.m / solid:.2g} of that of a solid one of its material, "
        f"{solid:.4g} kg: if it is hollow it bends like a shell, which the model leaves out"
    )
    return (text,)


def pressure_warnings(
    pressure: float, yield_stress: float | None, viscous: bool = False, body: str = "plate"
) -> tuple[str, ...]:
    """Whether the body that yields first does below the contact, if its yield stress is known."""
    if yield_stress is not None and viscous:
        text = (
            f"whether the {body} yields is not judged: the largest pressure is that of the elastic "
            "part, beside which a viscous contact has more while it grows"
        )
        return (text,)
    if yield_stress is None or pressure <= kernels.YIELD_LIMIT * yield_stress:
        return ()
    text = (
        f"largest pressure over yield stress = {pressure / yield_stress:.3g} exceeds "
        f"{kernels.YIELD_LIMIT}: the {body} yields below the contact, and takes energy"
    )
    return (text,)


def stress_warnings(
    stress: float, strength: float | None, yield_stress: float | None = None
) -> tuple[str, ...]:
    """Whether the back face fails or yields, by its largest tensile stress.

    Parameters
    ----------
    stress
        Largest tensile stress on the back face [Pa].
    strength, yield_stress
        Of the plate [Pa], if they are given. Under the axis the stress is the same in both
        directions of the face, so that it alone says when the face yields.
    """
    found = []
    if strength is not None and stress > strength:
        found.append(
            f"the largest tensile stress on the back face is {stress / strength:.3g} times the "
            "strength: the plate is predicted to fail (quasi-static stress under the peak force), "
            "and the results assume that it does not"
        )
    if yield_stress is not None and stress > yield_stress:
        found.append(
            f"the largest tensile stress on the back face is {stress / yield_stress:.3g} times "
            "the yield stress: the plate is predicted to yield in bending (quasi-static stress "
            "under the peak force), and the results assume that it does not"
        )
    return tuple(found)


def local_indentation(law: ContactLaw, a: Values) -> Values:
    """Indentation [m] of a half-space at contact radii [m], which is no deflection."""
    R = law.model.R
    depth = kernels.sphere_contact(a / R).depth if law.spherical else 1.0
    found: Values = a * (a / R) * depth  # type: ignore[assignment]
    return found


def hertz_cost(model: Model, a: float, indentation: float) -> float:
    """Relative change of the indentation at a given force, were the pressure not Hertz's [1].

    To leading order the true pressure turns c3 of delta = (a^2/R) (1 + c1 A + c3 A^3 + ...),
    A = a/h, into (8/3) c3. Three terms of this law, taken at a and a/2, leave that of c3 alone:
    delta(a) - 8 delta(a/2) + a^2/R = (3/4) c3 A^3 a^2/R.
    """
    half, whole = (float(kernels.indentation(x, model.R, model.h, model.b)) for x in (a / 2, a))
    cubic = 4 / 3 * (whole - 8 * half + a * (a / model.R))
    return 5 / 3 * cubic / indentation


def curvature_cost(model: Model, a: float, indentation: float) -> float:
    """Relative change of the indentation at a given force, were the sphere not a paraboloid [1].

    To leading order Sneddon's law of the exact profile, indentation (a/2) ln((R+a)/(R-a)),
    adds (1/15) (a/R)^2 times a^2/R, the smaller contact radius at that force included.
    """
    return (a / model.R) ** 2 / 15 * a * (a / model.R) / indentation


def _cost(change: float) -> str:
    if abs(change) > SMALL_CORRECTION:
        return f"the error is too large to estimate (leading term {100 * change:+.2g} % of it)"
    return f"the indentation at this force would change by about {100 * change:+.2g} %"


def last_radius(law: ContactLaw) -> float:
    """Largest contact radius inside the law's range [m]."""
    return float(np.nextafter(law.limit, 0.0))
