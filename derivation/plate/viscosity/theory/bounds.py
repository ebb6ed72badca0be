"""Step 24: bounds of the effect of viscosity on an impact, from the spiral of `contact`.

The impact runs from phi = 0 over the turning point phi = pi/2 to tan(phi) = -epsilon. Below,
epsilon is its largest value for s <= v0, n the ratio of the largest d log P_e/d log z to that at
the turning point, and d log Omega/d log s lies between -nu_- and nu_+. Then

    at the turning point   0 <= -log(s/v0) <= (pi/4) epsilon,     as phi'/Omega >= 1 before it
    at the end             0 <= -log(rho/v0) <= Lambda = (pi/2) epsilon/(1 - epsilon/2)
    largest force          P_e(s) <= P <= P_m sqrt(1 + epsilon^2)
    restitution            1 >= e >= exp(-Lambda)/sqrt(1 + epsilon^2)
    contact time, over     exp(nu_+ Lambda)/(1 - epsilon/2)
      that without         (1 - n epsilon/2) exp(-nu_- Lambda)/(1 + epsilon/2)

where the remaining elastic motion from tan(phi) = -epsilon has z <= n_z A_v |v| and lasts
n_z A_v at most, while the contact lasts 2 delta_m/v0 at least. This is proved for a half-space
without weight; for a plate, whose bending is elastic, epsilon is that of the whole law.
The weight, moving down by delta_m, makes the largest U equal to that of the sphere times u > 1. The
same fraction of it is lost, so that e^2 >= 1 - u (1 - exp(-2 Lambda)/(1 + epsilon^2)). At the end
the sphere is lower than at first contact by z <= n_z A_v |v|. Because of this net work of the
weight it may leave faster: e^2 <= 1 + (u - 1) n epsilon. The time of a sphere that rises against
its weight increases with its loss of speed, by which the bound is extended. The statements about
the end assume that epsilon(s) and P_e decrease with s and that P_e is convex; with weight and
plates they are not proved but tested on random scenes.
"""

from functools import cache
from typing import NamedTuple

import sympy as sp

from derivation.engine.formula.proof import Proof, prove
from derivation.plate.viscosity.theory.contact import (
    epsilon,
    on_circle,
    phi,
    polar,
    spiral,
    viscous_number,
    weak_restitution,
)
from derivation.plate.vocabulary import Formula

steepness, fall, rise, energy = sp.symbols("steepness fall rise energy", positive=True)
"""n, nu_-, nu_+ and u."""
depth, radius = sp.symbols("depth radius", positive=True)
"""Largest d log z/d log s and d log a/d log s."""


class Bounds(NamedTuple):
    """Logarithms of the largest possible changes, and the proof.

    Attributes
    ----------
    longer, shorter
        Contact time.
    depth, radius
        Indentation and contact radius, which can only decrease.
    pull, weaker
        Largest force.
    energy_loss
        Fraction of the sphere's own energy that may be lost.
    slower, faster
        Restitution.
    end
        Fraction of the contact time that is omitted at the end.
    """

    longer: sp.Expr
    shorter: sp.Expr
    depth: sp.Expr
    radius: sp.Expr
    pull: sp.Expr
    weaker: sp.Expr
    energy_loss: sp.Expr
    slower: sp.Expr
    faster: sp.Expr
    end: sp.Expr
    proof: Proof


@cache
def bounds() -> Bounds:
    """Return all bounds in terms of the numbers of the impact without viscosity."""
    polar()
    radial, turning, force = spiral()
    least, most = (turning.subs(phi, angle * sp.pi / 4) for angle in (3, 1))
    till_turned = -sp.integrate(radial, (phi, 0, sp.pi / 2))
    whole = -sp.integrate(radial, (phi, 0, sp.pi)) / least
    amplitude = sp.sqrt(sp.trigsimp(sp.expand(force**2 + sp.diff(force, phi) ** 2)))
    end = _end()
    energy_loss = energy * (1 - (sp.exp(-whole) / amplitude) ** 2)
    return Bounds(
        rise * whole - sp.log(least),
        fall * whole + sp.log(most) - sp.log(1 - end),
        depth * till_turned,
        radius * till_turned,
        sp.log(amplitude),
        (1 + rise) * till_turned,
        energy_loss,
        -sp.log(1 - energy_loss) / 2,
        sp.log(1 + (energy - 1) * 2 * end) / 2,
        end,
        _proof(till_turned, whole, least, most, amplitude),
    )


def _end() -> sp.Expr:
    """Return n_z A_v over 2 delta_m/v0: at the turning point epsilon is A_v (P_e'/P_e) v0.

    The remaining distance there, n_z A_v v0 at most, is twice as large relative to delta_m.
    """
    A, power, deepest, speed = sp.symbols("A power deepest speed", positive=True)
    (time,) = sp.solve(A * power * speed / deepest - epsilon, A)
    return steepness * power * time / (2 * deepest / speed)


def _proof(
    till_turned: sp.Expr, whole: sp.Expr, least: sp.Expr, most: sp.Expr, amplitude: sp.Expr
) -> Proof:
    """Prove that the rates lie between the integrated ones: the differences have a known sign."""
    radial, turning, force = spiral()
    sine, cosine = sp.sin(phi), sp.cos(phi)
    per_angle = radial / turning
    factor = epsilon * cosine**2 / (turning * least)
    return prove(
        "Bounds of the viscous spiral",
        r"The differences between $\phi'/\Omega$ and its bounds are squares; over the first "
        r"quarter $\phi'/\Omega$ is at least 1. The squares of the force and of its derivative "
        r"with respect to $\phi$ add up to the square of its amplitude.",
        {
            "least": on_circle(turning - least - epsilon * (sine + cosine) ** 2 / 2),
            "most": on_circle(most - turning - epsilon * (sine - cosine) ** 2 / 2),
            "quarter": per_angle - radial - epsilon**2 * cosine**3 * sine / turning,
            "half": sp.together(per_angle - radial / least - (turning - least) * factor),
            "largest force": on_circle(amplitude**2 - force**2 - (cosine - epsilon * sine) ** 2),
            "at the turning point": till_turned - sp.pi / 4 * epsilon,
            "Lambda": whole - sp.pi / 2 * epsilon / (1 - epsilon / 2),
        },
    )  # fmt: skip


def viscosity() -> tuple[Formula, ...]:
    """Return the formulas of the step; the bounds are proved as well."""
    bounds()
    return viscous_number(), weak_restitution()
