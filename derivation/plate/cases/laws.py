"""References for the hard cases of functions without a closed formula in the derivation: balls."""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import cache, partial
from typing import Any

import flint
from flint import arb

from derivation.engine.formula.ball import Exact, enclose, evaluate, to_ball
from derivation.engine.formula.ulp import upper_float
from derivation.engine.measure.suite import Given, HardLaw
from derivation.plate import vocabulary as symbols
from derivation.plate.back_face import oracle as back_face_balls
from derivation.plate.contact.cases.reference_values import tolerance
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle import forces as contact_forces
from derivation.plate.contact.theory import spherical_profile
from derivation.plate.edge.oracle import clamped as clamp_balls
from derivation.plate.edge.oracle import supported as edge_balls
from derivation.plate.edge.theory import clamped as clamp
from derivation.plate.edge.theory import sums as edge_sums
from derivation.plate.impact.oracle import impact as contact_impact
from derivation.plate.impact.oracle import printed_motion as printed_motion_balls
from derivation.plate.impact.oracle import quantities as contact_quantities
from derivation.plate.impact.oracle import sensitivity, state_rounding
from derivation.plate.pressure import oracle as pressure_balls
from derivation.plate.subjects import exports

_SPARE, _FEW, _FEW_OF_RADIUS = 8, 20, 15
"""Additional digits; and digits of magnitudes and radii, which only determine tolerances."""

_RADIUS: Callable[..., arb] = contact_balls.contact_radius
_SERIES: Callable[..., tuple[arb, arb]] = contact_quantities.truncated_series

Scale = Callable[[Given, arb], float]
"""As `HardLaw.scale`."""


def _bits(digits: int) -> int:
    return 4 * digits + 64


def _one(function: Callable[..., arb], scale: Scale | None = None) -> HardLaw:
    return HardLaw(
        lambda given, digits: (function(*given, digits=digits),),
        scale=scale,
        oracle=(function.__module__,),
    )


def _of_sum(name: str) -> Scale:
    """Return the factor of the budget of a sum whose parts cancel, see `tolerance`."""
    return lambda given, value: tolerance(name, tuple(given), float(value))


def _of_radius(given: Given, _: arb) -> float:
    """Return the same factor for a force, from its contact radius."""
    radius = float(_RADIUS(*given[:4], digits=_FEW_OF_RADIUS))
    return tolerance("contact_radius", tuple(given[:4]), radius)


def _series(given: Given, digits: int) -> tuple[arb]:
    return (_SERIES(*given, digits=digits)[0],)


def _of_series(given: Given, _: arb) -> float:
    return upper_float(_SERIES(*given)[1])


# --- the edge


@cache
def _mean_edge_motion(kind: str, given: tuple[Any, ...], digits: int) -> arb:
    """Return the edge's mean motion; cached, because a support's part is a multiple of it."""
    a, h, b, lam, mu = given
    return edge_balls.edge_part(kind, a, h, b, lam, mu, digits)


def _supported_edge(kind: str) -> HardLaw:
    def values(given: Given, digits: int) -> tuple[arb]:
        taken = _mean_edge_motion(kind, tuple(given), digits)
        with flint.ctx.workprec(_bits(digits)):
            return (to_ball(edge_balls.support_ratio(*given[3:])) * taken,)

    return HardLaw(values, oracle=(edge_balls.__name__,))


def _clamped_edge(kind: str) -> HardLaw:
    def values(given: Given, digits: int) -> tuple[arb]:
        a, h, b, lam, mu = given
        taken = clamp_balls.clamp_part(kind, a, h, b, lam, mu, digits)
        with flint.ctx.workprec(_bits(digits)):
            return (-taken,)

    return HardLaw(values, oracle=(clamp_balls.__name__,))


def _edge_bound(support: str) -> HardLaw:
    names = (symbols.alpha, symbols.eta, symbols.lam, symbols.mu)

    def values(given: Given, digits: int) -> tuple[arb]:
        bound = edge_sums.edge_bound if support == "supported" else clamp.clamp_bound
        a, h, b, lam, mu = (Fraction(x) for x in given)
        known = dict(zip(names, (a / b, h / b, lam, mu), strict=True))
        value = evaluate(bound().expression, known, digits)
        with flint.ctx.workprec(_bits(digits)):
            ratio = edge_balls.support_ratio(lam, mu) if support == "supported" else Fraction(1)
            return (to_ball(ratio) * value,)

    supported = (edge_sums.__name__, edge_balls.__name__)
    return HardLaw(values, oracle=supported if support == "supported" else (clamp.__name__,))


# --- the back face


def _stress_unit(P: Exact, h: Exact, lam: Exact, mu: Exact) -> arb:
    """Return (1 + nu) P/(2 pi H^2) at the current precision."""
    first, second = Fraction(lam), Fraction(mu)
    factor = (3 * first + 2 * second) * Fraction(P) / (16 * (first + second) * Fraction(h) ** 2)
    return to_ball(factor) / arb.pi()


def _back_face(support: str) -> HardLaw:
    def of_edge(given: Given, digits: int) -> tuple[arb, arb]:
        """Return the contributions of the states of bending and of extension to S."""
        _, a, h, b, lam, mu = given
        if support == "clamped":
            bent, stretched = clamp_balls.back_face_clamp(a, h, b, lam, mu)
            return -to_ball(bent), -to_ball(stretched)
        eta, alpha = Fraction(h) / Fraction(b), Fraction(a) / Fraction(b)
        n = Fraction(lam) / (Fraction(lam) + 2 * Fraction(mu))
        bent, stretched = edge_balls.sums("indentation", alpha, eta, n, _bits(digits))
        ratio = to_ball(edge_balls.support_ratio(lam, mu))
        return 12 * ratio * bent, 8 * ratio * to_ball(n * eta) * stretched

    def values(given: Given, digits: int) -> tuple[arb]:
        P, a, h, b, lam, mu = given
        total = back_face_balls.back_face_sum(a, h, b, digits + _SPARE)
        if support == "supported":
            moved = back_face_balls.back_face_edge(a, h, b, lam, mu, digits + _SPARE)
        with flint.ctx.workprec(_bits(digits)):
            if support == "supported":
                total += to_ball(edge_balls.support_ratio(lam, mu)) * moved
            elif support:
                total += sum(of_edge(given, digits))
            return (_stress_unit(P, h, lam, mu) * total,)

    def sizes(given: Given, _: Sequence[arb]) -> tuple[arb]:
        """Return the sum of the magnitudes of the parts: the paper's edge, extension, bending."""
        P, a, h, b, lam, mu = given
        plain = back_face_balls.back_face_sum(a, h, b, _FEW)
        with flint.ctx.workprec(_bits(_FEW)):
            states = sum((abs(x) for x in of_edge(given, _FEW)), arb(0))
            return (abs(_stress_unit(P, h, lam, mu)) * (abs(plain) + states),)

    oracle = (back_face_balls.__name__, *([clamp_balls.__name__] if support == "clamped" else []))
    return HardLaw(values, sizes if support else None, oracle=oracle)


# --- the sphere and the pressure


def _sphere(given: Given, digits: int) -> tuple[arb, ...]:
    """Return P, delta and its slope over those of Hertz, by the theory for R = 1, E* = 1."""
    x = Fraction(given[0])
    depth, force = (formula.expression for formula in spherical_profile.spherical_contact())
    # E* is 1 for lam = 0 and mu = 1/2.
    at: dict[Any, Exact] = {symbols.a: x, symbols.R: 1, symbols.lam: 0, symbols.mu: Fraction(1, 2)}
    rise = depth.diff(symbols.a)

    def compute(_: int) -> tuple[arb, ...]:
        known = {symbol: to_ball(value) for symbol, value in at.items()}
        P, delta, slope = (enclose(value, known) for value in (force, depth, rise))
        a = known[symbols.a]
        return P * 3 / (4 * a**3), delta / a**2, slope / (2 * a)

    return contact_balls.refine_to_digits(compute, digits, f"a sphere at a/R = {float(x)}")


def _contact(given: Given, digits: int) -> tuple[arb, ...]:
    """Return force, indentation, stiffness, slope, central and mean pressure of a paraboloid."""
    a, R, h, b, modulus = given
    state = pressure_balls.solve(pressure_balls.case(a, h, b), digits)
    with flint.ctx.workprec(_bits(digits)):
        a, R, E = to_ball(a), to_ball(R), to_ball(modulus)
        return (
            E * a**3 / R * state.force,
            a**2 / R * state.depth,
            E * a * state.stiffness,
            a / R * state.slope,
            E * a / R * state.centre,
            E * a / R * state.force / arb.pi(),
        )


def _of_means(_: Given, values: Sequence[arb]) -> tuple[arb, ...]:
    """Return magnitudes: the mean pressure for the central one, else each result itself."""
    sizes = [abs(value) for value in values]
    return (*sizes[:4], sizes[5], sizes[5])


def _pressure(given: Given, digits: int) -> tuple[arb, ...]:
    r, a, R, h, b, modulus = given
    ratio = Fraction(r) / Fraction(a)
    state = pressure_balls.solve(pressure_balls.case(a, h, b, places=(ratio,)), digits)
    with flint.ctx.workprec(_bits(digits)):
        return (to_ball(modulus) * to_ball(a) / to_ball(R) * state.pressures[0],)


def _mean(given: Given, _: Sequence[arb]) -> tuple[arb, ...]:
    return (_contact(given[1:], _FEW)[5],)


# --- impacts


@cache
def _impact(given: tuple[Any, ...], digits: int) -> tuple[arb, ...]:
    """Return the impact; cached, because several functions are compared with it."""
    R, m, v0, h, b, lam, mu = given
    return tuple(contact_impact.impact(R, m, v0, h, b, lam, mu, digits))


def _state(given: Given, digits: int) -> tuple[arb, ...]:
    """Return the state from the power series of the law, which is fast for many times."""
    t, *motion = given
    R, m, v0, h, b, lam, mu = motion
    return contact_quantities.state(t, R, m, v0, h, b, lam, mu, digits)


_ESTIMATE = HardLaw(
    lambda given, digits: _impact(tuple(given), digits),
    conditioned=False,
    results=4,
    oracle=(contact_impact.__name__,),
)
"""References of the stated error of a simple law, relative to the impact by the corrected law."""


def _first_coefficient(given: Given, digits: int) -> tuple[arb]:
    (eta,) = given
    return (contact_balls.coefficient(1, eta, 1, digits),)


def _corrected(given: Given, digits: int) -> tuple[arb]:
    t, m, v0, xi_2, xi_3 = given
    return (printed_motion_balls.corrected(t, m, v0, xi_2, xi_3, digits),)


def _largest(given: Given, _: Sequence[arb]) -> tuple[arb, ...]:
    with flint.ctx.workprec(_bits(_FEW)):
        return (printed_motion_balls.largest(*given[1:4]),)


LAWS: Mapping[str, HardLaw] = {
    "indentation": _one(contact_balls.indentation, _of_sum("indentation")),
    "indentation_slope": _one(contact_balls.slope),
    "contact_radius": _one(contact_balls.contact_radius, _of_sum("contact_radius")),
    "stiffness": _one(contact_balls.stiffness, _of_sum("stiffness")),
    "force": _one(contact_forces.force, _of_radius),
    "force_of_radius": _one(contact_forces.force_of_radius),
    "radius_of_force": _one(contact_forces.radius_of_force),
    "max_pressure": _one(contact_forces.max_pressure),
    "force_by_series": HardLaw(_series, scale=_of_series, oracle=(contact_quantities.__name__,)),
    "impact": HardLaw(
        lambda given, digits: _impact(tuple(given), digits),
        results=4,
        oracle=(contact_impact.__name__,),
    ),
    "history": HardLaw(
        _state,
        slopes=partial(state_rounding.rounding, _state),
        results=4,
        oracle=(contact_quantities.__name__,),
    ),
    "impact_sensitivities": HardLaw(
        sensitivity.impact_sensitivities,
        lambda _, values: tuple(abs(value).max(arb(1)) for value in values),
        slopes=sensitivity.rounding,
        results=28,
        oracle=(sensitivity.__name__,),
    ),
    "supported_edge": _supported_edge("indentation"),
    "clamped_edge": _clamped_edge("indentation"),
    "supported_edge_slope": _supported_edge("slope"),
    "clamped_edge_slope": _clamped_edge("slope"),
    "supported_edge_bound": _edge_bound("supported"),
    "clamped_edge_bound": _edge_bound("clamped"),
    "supported_edge_curvature": _one(edge_balls.curvature),
    "clamped_edge_curvature": _one(clamp_balls.curvature),
    "back_face_stress": _back_face(""),
    "supported_back_face_stress": _back_face("supported"),
    "clamped_back_face_stress": _back_face("clamped"),
    "sphere_contact": HardLaw(_sphere, results=3, oracle=(spherical_profile.__name__,)),
    "contact": HardLaw(
        _contact, _of_means, conditioned=False, results=6, oracle=(pressure_balls.__name__,)
    ),
    "pressure": HardLaw(_pressure, _mean, conditioned=False, oracle=(pressure_balls.__name__,)),
    "plate_of": HardLaw(_first_coefficient, conditioned=False, oracle=(contact_balls.__name__,)),
    "hertz": _ESTIMATE,
    "leading": _ESTIMATE,
    "corrected": HardLaw(_corrected, _largest, oracle=(printed_motion_balls.__name__,)),
} | {name: law for laws in exports("cases", "LAWS") for name, law in laws.items()}
"""References by function."""
