"""How far the limit of 1.6 Y falls short of a metal's contact, whose pressure rises beyond it.

Not in link 31, but beside it: an estimate of its model error. As the plastic zone spreads, the
mean pressure rises from 1.07 Y at the onset to about 3 Y, the fully plastic contact (Johnson 1985,
sections 6.3 and 11.5), and stays. In between it follows a cavity that grows in a plastic core: the
pressure rises by 2 Y ln(c/a), c the radius of the plastic zone, and c^3/a^3 with a/R, so that

    dp/d(ln a) = 2 Y/3.

From the onset this reaches 3 Y at E* a/(Y R) = 46; Johnson has the fully plastic contact from
about 30 on. There the indentation is a^2/(2 R), and not a^2/R: the surface neither sinks in nor
piles up. A contact of constant pressure p and indentation a^2/(s R) has P = pi a^2 p. Its results
at a given energy show what p and s change.
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
    """What the risen pressure changes: over the values at 1.6 Y and indentation a^2/R."""

    force: sp.Expr
    restitution: sp.Expr


def mean_pressure() -> sp.Expr:
    """The mean pressure of link 31 over Y, by the contact radius over that at the onset."""
    found = ONSET * (1 - 1 / (3 * wide**2))
    onset = sp.Rational(2, 3) * ONSET  # of Hertz's pressure the mean is two thirds of the largest
    at = {wide: sp.sqrt(loading().area)}
    prove(
        "Mean pressure of a limited pressure",
        "The force over the area of the contact.",
        {"mean": sp.simplify((found - onset * xi_y**3 / wide**2).subs(at))},
    )
    return found


def risen_pressure() -> sp.Expr:
    """The mean pressure of the growing cavity over Y, by the contact radius over the onset's."""
    found = sp.Rational(2, 3) * (ONSET + sp.log(wide))
    zone = _core * sp.cbrt(wide**4)  # c^3 goes with a^3 a/R
    prove(
        "Pressure of a growing cavity",
        "At the onset it is Hertz's mean pressure; then it rises by $2 Y \\ln(c/a)$.",
        {
            "onset": found.subs(wide, 1) - mean_pressure().subs(wide, 1),
            "growth": sp.simplify(sp.diff(found - 2 * sp.log(zone / wide), wide)),
        },
    )
    return found


def steepness() -> sp.Expr:
    """How s goes from 1 to 2 with the mean pressure over Y: in proportion, which is assumed."""
    onset = risen_pressure().subs(wide, 1)
    return 1 + (pressure - onset) / (FULLY_PLASTIC - onset)


def beyond() -> Beyond:
    """What a pressure p and an indentation a^2/(s R) change at a given energy."""
    brought = sp.integrate(sp.pi * a**2 * pressure * sp.diff(a**2 / (steep * R), a), (a, 0, a))
    top = sp.root(sp.solve(brought.subs(a, sp.root(_area, 4)) - energy, _area)[0], 4)
    force = sp.pi * top**2 * pressure
    # Unloading is Hertz's with the radius of a flatter sphere, which returns 2/5 P a^2/radius.
    flatter = sp.Rational(4, 3) * _modulus * top**3 / force
    square = sp.Rational(2, 5) * force * top**2 / flatter / energy
    calm = {pressure: 1, steep: 1}
    changed = Beyond(sp.sqrt(pressure * steep), (pressure**5 * steep**3) ** sp.Rational(1, 8))
    prove(
        "Results of a constant pressure",
        "At a given energy the force goes with $(p s)^{1/2}$, indentation and time against it, "
        "and the restitution with $p^{5/8} s^{3/8}$; link 31's in the end is that of $1.6 Y$ and "
        "$s = 1$.",
        {
            "force": sp.simplify(force / force.subs(calm) / changed.force) - 1,
            "restitution": sp.simplify(square / square.subs(calm) / changed.restitution**2) - 1,
            "link 31": sp.simplify((square.subs(_at_onset()) / _limit()) ** 4) - 1,
        },
    )
    return changed


def _at_onset() -> dict[sp.Symbol, sp.Expr]:
    """Link 31's pressure, which Hertz's contact of radius a_y reaches, and many times its energy.

    The energy is that of Hertz's contact there times that of `_limit`, whose scale is free.
    """
    top = ONSET * _stress
    a_y = sp.pi * top * R / (2 * _modulus)
    onset = sp.Rational(8, 15) * _modulus * a_y**5 / R**2
    return {pressure: top, steep: sp.Integer(1), energy: onset * _times}


def _limit() -> sp.Expr:
    """e^2 of link 31 far beyond the onset, by the energy over that at the onset."""
    own = plastic_restitution().expression
    whole = plastic_work().expression / (1 - own**2)
    found = sp.limit((own**8 * whole).subs(xi_y, 1 / _small), _small, 0)
    return sp.root(found / _times, 4)
