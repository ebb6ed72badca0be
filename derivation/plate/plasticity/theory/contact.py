"""Step 31: elastic-plastic contact with a pressure limit of 1.6 Y, and residual indentation.

Johnson (1985), Thornton (1997): the Hertz pressure reaches p_y = 1.6 Y, Y the smaller yield stress
of the two bodies, at the contact radius a_y. Beyond a_y the pressure is limited to p_y, while the
indentation stays a^2/R. With the radius a_H = a_y xi at which Hertz's law has the same force,

    P = (4/3) E* a_H^3/R,   a^2 = a_y^2 (2 xi^3 + 1)/3   on loading, xi >= 1.

Unloading from xi is elastic: Hertz's law with the flattened radius R_p = R P_e/P, where P_e is
Hertz's force at the same contact radius. Hence a_H/a stays c, R_p = R/c^3, and the indentation is
delta_p + c a_H^2/R until the force is zero. All lengths below are divided by a_y^2/R.
"""

from functools import cache
from typing import NamedTuple

import sympy as sp

from derivation.engine.formula.proof import prove
from derivation.plate.contact.theory.hertz import contact_radius, pressure
from derivation.plate.modes.theory.influence import PLANE_STRAIN_MODULUS
from derivation.plate.vocabulary import Formula, P, R, a, m, r, xi_y, yield_stress

ONSET = sp.Rational(8, 5)
"""Largest contact pressure over the yield stress at the onset of yield (Johnson 1985,
section 6.1, von Mises, Poisson's ratio 0.3)."""
_s, _modulus, _a_y, _top = sp.symbols("s modulus a_y top", positive=True)
_NEEDED = ("p", "P")


class Loading(NamedTuple):
    """Contact radius squared and force on loading, over their values at the onset."""

    area: sp.Expr
    force: sp.Expr


def _hertz() -> tuple[sp.Expr, sp.Expr]:
    """Return Hertz's force and largest pressure at a contact radius."""
    force = contact_radius().expression
    return force, -pressure().expression.subs(r, 0).subs(P, force)


@cache
def yield_radius() -> Formula:
    """Return a_y, at which the largest Hertz pressure is 1.6 Y."""
    _, peak = _hertz()
    (radius,) = sp.solve(peak - ONSET * yield_stress, a)
    proof = prove(
        "Onset of yield",
        "The largest Hertz pressure is $1.6 Y$ at this contact radius.",
        lambda radius: {"pressure": peak.subs(a, radius) - ONSET * yield_stress},
        radius,
    )
    return Formula(
        "yield_radius", "a_y", "contact radius at the onset of yield",
        radius, "m", "", _NEEDED, proof,
    )  # fmt: skip


@cache
def loading() -> Loading:
    """Prove the force of the limited pressure: Hertz pressure minus the part above p_y.

    It is above p_y for r^2 < a^2 - a_y^2, because its square is linear in r^2.
    """
    limit = sp.Symbol("p_y", positive=True)
    inner = sp.sqrt(a**2 - _a_y**2)
    slope = limit / _a_y  # p = slope sqrt(a^2 - r^2) in a growing contact
    loading_work = 2 * sp.pi * slope * a**3 / 3
    # int sqrt(a^2 - r^2) r dr from 0 to r^2 = a^2 - a_y^2
    above = 2 * sp.pi * (slope * (a**3 - _a_y**3) / 3 - limit * inner**2 / 2)
    force = sp.expand((loading_work - above) / loading_work.subs(a, _a_y))
    (area,) = sp.solve(force.subs(a, sp.sqrt(_s)) - xi_y**3, _s)
    hertz, peak = _hertz()
    prove(
        "Force of a limited pressure",
        "Beyond the onset the force increases by $p_y$ times the increase of the contact area; "
        "where it is Hertz's at the radius $a_H$ it is $\\xi^3$ times that at the onset.",
        {
            "antiderivative": sp.diff(-((a**2 - r**2) ** sp.Rational(3, 2)) / 3, r)
            - r * sp.sqrt(a**2 - r**2),
            "Hertz": sp.simplify(loading_work.subs(limit, slope * _a_y) - hertz.subs(
                R, sp.solve(peak.subs(a, _a_y) - limit, R)[0])),
            "rate of the "
            "force": sp.diff(force * loading_work.subs(a, _a_y), a) - 2 * sp.pi * a * limit,
            "onset": force.subs(a, _a_y) - 1,
        },
    )  # fmt: skip
    return Loading(sp.simplify(area / _a_y**2), force)


@cache
def plastic_indentation() -> Formula:
    """Return the plastic part of the indentation at a force, on loading: (a^2 - a_H^2)/R."""
    extra = loading().area - xi_y**2
    proof = prove(
        "Indentation of an elastic-plastic contact",
        "The indentation is $a^2/R$, with the larger contact radius of the limited pressure. At "
        "the onset, value and slope are those of Hertz's law.",
        lambda extra: {
            "force": loading().force.subs(a, sp.sqrt(xi_y**2 + extra) * _a_y) - xi_y**3,
            "onset": extra.subs(xi_y, 1),
            "slope at the onset": sp.diff(extra, xi_y).subs(xi_y, 1),
        },
        extra,
    )
    return Formula(
        "plastic_indentation", r"\Delta",
        "plastic part of the indentation on loading, divided by $a_y^2/R$",
        extra, "1", "", ("yield_radius",), proof,
    )  # fmt: skip


@cache
def flattening() -> Formula:
    """Return c = a_H/a at the beginning of unloading; the flattened radius is R/c^3."""
    ratio = xi_y / sp.sqrt(loading().area)
    hertz, _ = _hertz()
    top = sp.sqrt(loading().area) * _a_y
    equivalent = hertz.subs(a, top)
    unloaded = hertz.subs(R, R * equivalent / hertz.subs(a, xi_y * _a_y))
    proof = prove(
        "Flattened radius",
        "Thornton's radius $R_p = R P_e/P$ gives the force and contact radius at which "
        "unloading begins.",
        lambda ratio: {
            "radius": sp.simplify((equivalent / hertz.subs(a, xi_y * _a_y)) - ratio**-3),
            "force": sp.simplify(unloaded.subs(a, top) / hertz.subs(a, xi_y * _a_y) - 1),
            "at every force of unloading": sp.simplify(unloaded / hertz.subs({a: ratio * a}) - 1),
        },
        ratio,
    )
    return Formula(
        "flattening", "c", "Hertz radius of the force divided by the contact radius, at unloading",
        ratio, "1", "", ("plastic_indentation",), proof,
    )  # fmt: skip


@cache
def dent() -> Formula:
    """Return the residual indentation, (a^2/R) (1 - c^3) at the beginning of unloading."""
    ratio, area = flattening().expression, loading().area
    depth = area * (1 - ratio**3)
    proof = prove(
        "Dent",
        "At the beginning of unloading the indentation is that of loading.",
        lambda depth: {"continuous": sp.simplify(depth + ratio * xi_y**2 - area)},
        depth,
    )
    return Formula(
        "dent", r"\delta_p", "residual indentation divided by $a_y^2/R$", depth, "1", "",
        ("flattening",), proof,
    )  # fmt: skip


@cache
def plastic_work() -> Formula:
    """Return the energy dissipated in a cycle up to xi, over Hertz's energy at the onset."""
    extra, ratio = plastic_indentation().expression, flattening().expression
    # P over that at the onset is xi^3; Hertz's energy at the onset is int xi^3 d(xi^2) = 2/5.
    brought = sp.integrate(_top**3 * sp.diff(extra, xi_y).subs(xi_y, _top), (_top, 1, xi_y))
    elastic = sp.integrate(2 * _top**4, (_top, 0, xi_y))
    work = sp.expand((brought + elastic) / sp.Rational(2, 5)) - ratio * xi_y**5
    returned = sp.integrate(
        _top**3 * sp.diff(ratio * _top**2, _top), (_top, 0, xi_y)
    ) / sp.Rational(2, 5)
    proof = prove(
        "Plastic work",
        "The plastic work is the work of loading minus the energy returned on unloading.",
        lambda work: {
            "rebound energy": sp.simplify(returned - ratio * xi_y**5),
            "loading": sp.diff(work + ratio * xi_y**5, xi_y)
            - sp.Rational(5, 2) * xi_y**3 * sp.diff(xi_y**2 + extra, xi_y),
            "onset": sp.simplify(work.subs(xi_y, 1)),
        },
        work,
    )
    return Formula(
        "plastic_work", "W_p", "plastic work divided by Hertz's energy at the onset of yield",
        work, "1", "", ("dent",), proof,
    )  # fmt: skip


@cache
def yield_speed() -> Formula:
    """Return the impact speed at the onset of yield of a half-space."""
    force, _ = _hertz()
    energy = sp.integrate(force * sp.diff(a**2 / R, a), (a, 0, _a_y))
    energy = energy.subs(_a_y, yield_radius().expression)
    speed = sp.powdenest(sp.simplify(sp.sqrt(2 * energy / m)), force=True)
    limit = ONSET * yield_stress
    thornton = (sp.pi * limit / (2 * PLANE_STRAIN_MODULUS)) ** 2 * sp.sqrt(
        8 * sp.pi * limit * R**3 / (15 * m)
    )
    proof = prove(
        "Yield speed",
        "The energy of the Hertz contact at the onset of yield gives the speed, which equals "
        "Thornton's (1997) formula.",
        lambda speed: {
            "energy": m * speed**2 / 2 - energy,
            "Thornton": sp.simplify((thornton / speed) ** 2 - 1),
        },
        speed,
    )
    return Formula(
        "yield_speed", "v_y", "impact speed at the onset of yield for a half-space",
        speed, "m/s", "", ("yield_radius",), proof,
    )  # fmt: skip


@cache
def plastic_restitution() -> Formula:
    """Return e of a half-space as a function of xi: Thornton's formula in another variable."""
    work, ratio = plastic_work().expression, flattening().expression
    whole = work + ratio * xi_y**5
    square = ratio * xi_y**5 / whole
    value = sp.sqrt(square)
    slow = 1 / sp.sqrt(whole)  # v_y/v0
    part = slow / (slow + 2 * sp.sqrt(sp.Rational(6, 5) - slow**2 / 5))
    thornton = sp.Rational(6, 5) * sp.sqrt(3) * (1 - slow**2 / 6) * sp.sqrt(part)
    ends = sp.limit(square / slow ** sp.Rational(1, 2), xi_y, sp.oo)
    proof = prove(
        "Restitution of an elastic-plastic contact",
        "The coefficient is the square root of the returned energy divided by the initial energy. "
        "It equals Thornton's (1997) formula in $v_y/v_0$, which tends to $1.185 (v_y/v_0)^{1/4}$.",
        lambda value: {
            "energy": value**2 * whole - ratio * xi_y**5,
            "Thornton": sp.simplify((thornton / square) ** 4 - 1),
            "fast impact": sp.simplify(
                ends - sp.Rational(6, 5) * sp.sqrt(3) / sp.sqrt(2 * sp.sqrt(sp.Rational(6, 5)))
            ),
        },
        value,
    )
    return Formula(
        "plastic_restitution", "e", "restitution of an elastic-plastic contact on a half-space",
        value, "1", "", ("plastic_work",), proof,
    )  # fmt: skip


def yielding() -> tuple[Formula, ...]:
    """Return the formulas of the step."""
    return (
        yield_radius(), yield_speed(), plastic_indentation(), flattening(), dent(),
        plastic_work(), plastic_restitution(),
    )  # fmt: skip
