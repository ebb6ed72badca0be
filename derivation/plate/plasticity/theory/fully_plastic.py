"""Model error of the limit 1.6 Y: in a metal the contact pressure rises above it.

This is not part of step 31 but estimates its model error. As the plastic zone spreads, the mean
pressure rises from 1.07 Y at the onset to about 3 Y, the fully plastic contact (Johnson 1985,
sections 6.3 and 11.5), and stays there. In between a cavity expands in a plastic core: the
pressure rises by 2 Y ln(c/a), c the radius of the plastic zone, and c^3/a^3 is proportional to a/R:

    dp/d(ln a) = 2 Y/3.

From the onset this reaches 3 Y at E* a/(Y R) = 46; according to Johnson the contact is fully
plastic from about 30 on. There the indentation is a^2/(2 R) instead of a^2/R: the surface neither
sinks in nor piles up. A contact of constant pressure p and indentation a^2/(s R) has P = pi a^2 p.
Its results at a given energy show the effect of p and s.
"""

from typing import NamedTuple

import sympy as sp

from derivation.engine.formula.proof import prove
from derivation.plate.plasticity.theory.contact import (
    ONSET,
    loading,
    plastic_restitution,
    plastic_work,
)
from derivation.plate.vocabulary import R, a, xi_y

FULLY_PLASTIC = sp.Integer(3)
"""Mean pressure of a fully plastic contact over the yield stress (Johnson 1985, section 6.3)."""
wide, pressure, steep, energy = sp.symbols("wide pressure steep energy", positive=True)
_modulus, _core, _stress = sp.symbols("modulus core Y", positive=True)
_area, _times, _small = sp.symbols("area times small", positive=True)


class Beyond(NamedTuple):
    """Results with the increased pressure, over those at 1.6 Y and indentation a^2/R."""

    force: sp.Expr
    restitution: sp.Expr


def mean_pressure() -> sp.Expr:
    """Return the mean pressure of step 31 over Y, by the contact radius over that at the onset."""
    pressure = ONSET * (1 - 1 / (3 * wide**2))
    onset = sp.Rational(2, 3) * ONSET  # the mean of Hertz pressure is two thirds of the largest
    at = {wide: sp.sqrt(loading().area)}
    prove(
        "Mean pressure of a limited pressure",
        "It is the force divided by the area of the contact.",
        {"mean": sp.simplify((pressure - onset * xi_y**3 / wide**2).subs(at))},
    )
    return pressure


def risen_pressure() -> sp.Expr:
    """Return the mean pressure of the expanding cavity over Y, by the radius over the onset's."""
    pressure = sp.Rational(2, 3) * (ONSET + sp.log(wide))
    zone = _core * sp.cbrt(wide**4)  # c^3 is proportional to a^3 a/R
    prove(
        "Pressure of an expanding cavity",
        "At the onset it is Hertz's mean pressure; beyond, it increases by $2 Y \\ln(c/a)$.",
        {
            "onset": pressure.subs(wide, 1) - mean_pressure().subs(wide, 1),
            "growth": sp.simplify(sp.diff(pressure - 2 * sp.log(zone / wide), wide)),
        },
    )
    return pressure


def steepness() -> sp.Expr:
    """Return s from 1 to 2, assumed to be linear in the mean pressure over Y."""
    onset = risen_pressure().subs(wide, 1)
    return 1 + (pressure - onset) / (FULLY_PLASTIC - onset)


def beyond() -> Beyond:
    """Return the changes at a given energy by a pressure p and an indentation a^2/(s R)."""
    brought = sp.integrate(sp.pi * a**2 * pressure * sp.diff(a**2 / (steep * R), a), (a, 0, a))
    top = sp.root(sp.solve(brought.subs(a, sp.root(_area, 4)) - energy, _area)[0], 4)
    force = sp.pi * top**2 * pressure
    # Unloading is Hertz's for a flatter sphere, which returns 2/5 P a^2/radius.
    flatter = sp.Rational(4, 3) * _modulus * top**3 / force
    square = sp.Rational(2, 5) * force * top**2 / flatter / energy
    calm = {pressure: 1, steep: 1}
    changed = Beyond(sp.sqrt(pressure * steep), (pressure**5 * steep**3) ** sp.Rational(1, 8))
    prove(
        "Results of a constant pressure",
        "At a given energy the force is proportional to $(p s)^{1/2}$, indentation and time to its "
        "inverse, and the restitution to $p^{5/8} s^{3/8}$; far beyond the onset step 31 has "
        "$1.6 Y$ and $s = 1$.",
        {
            "force": sp.simplify(force / force.subs(calm) / changed.force) - 1,
            "restitution": sp.simplify(square / square.subs(calm) / changed.restitution**2) - 1,
            "limit of step 31": sp.simplify((square.subs(_at_onset()) / _limit()) ** 4) - 1,
        },
    )
    return changed


def _at_onset() -> dict[sp.Symbol, sp.Expr]:
    """Return step 31's pressure at the onset, and its energy for a large multiple of it.

    The energy is that of the Hertz contact there times that of `_limit`, whose scale is free.
    """
    top = ONSET * _stress
    a_y = sp.pi * top * R / (2 * _modulus)
    onset = sp.Rational(8, 15) * _modulus * a_y**5 / R**2
    return {pressure: top, steep: sp.Integer(1), energy: onset * _times}


def _limit() -> sp.Expr:
    """Return e^2 of step 31 far beyond the onset, by the energy over that at the onset."""
    restitution = plastic_restitution().expression
    whole = plastic_work().expression / (1 - restitution**2)
    limit = sp.limit((restitution**8 * whole).subs(xi_y, 1 / _small), _small, 0)
    return sp.root(limit / _times, 4)
