"""Link 24: what a viscous contact can change of an impact at most, by the spiral of `contact`.

The impact runs from phi = 0 over the turning point phi = pi/2 to tan(phi) = -epsilon. Let
epsilon stand for its largest value below, s <= v0; n = d log P_e/d log z at its largest over
that at the turning point; and d log Omega/d log s lie between -nu_- and nu_+. Then

    at the turning point   0 <= -log(s/v0) <= (pi/4) epsilon,     as phi'/Omega >= 1 till there
    in the end             0 <= -log(rho/v0) <= Lambda = (pi/2) epsilon/(1 - epsilon/2)
    largest force          P_e(s) <= P <= P_m sqrt(1 + epsilon^2)
    restitution            1 >= e >= exp(-Lambda)/sqrt(1 + epsilon^2)
    contact time, over     exp(nu_+ Lambda)/(1 - epsilon/2)
      that without         (1 - n epsilon/2) exp(-nu_- Lambda)/(1 + epsilon/2)

where the elastic motion from tan(phi) = -epsilon on, left out, has z <= n_z A_v |v| to go and
lasts n_z A_v at most, while the whole lasts 2 delta_m/v0 at least. Proved for a half-space
without weight; with a plate, whose bending is elastic, epsilon is taken of the whole law.
The weight, sinking by delta_m, makes the largest U that of the sphere times u > 1. Of this the
same share is lost, so that e^2 >= 1 - u (1 - exp(-2 Lambda)/(1 + epsilon^2)); and what sinks less
than it rises, z <= n_z A_v |v| at the end, may leave faster: e^2 <= 1 + (u - 1) n epsilon.
The time of a sphere that rises against its weight grows like what it lost of its speed, by which
its bound is widened. What is said of the end takes epsilon(s) and P_e to fall with s, P_e
convex; with weight and plates these are no proofs, and random scenes hold them.
"""

from functools import cache
from typing import NamedTuple

import sympy as sp

from derivation.engine.formula.proof import Proof, prove
from derivation.plate.viscosity.theory.contact import (
    epsilon,
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
"""d log z/d log s and d log a/d log s at their largest."""


class Bounds(NamedTuple):
    """Logarithms of what can change at most, and the proof.

    Attributes
    ----------
    longer, shorter
        Contact time.
    depth, radius
        Indentation and contact radius, which can only be less.
    pull, weaker
        Largest force.
    gone
        Share of the sphere's own energy that may be lost.
    slower, faster
        Restitution.
    end
        Part of the time, left out at the end, over all of it.
    """

    longer: sp.Expr
    shorter: sp.Expr
    depth: sp.Expr
    radius: sp.Expr
    pull: sp.Expr
    weaker: sp.Expr
    gone: sp.Expr
    slower: sp.Expr
    faster: sp.Expr
    end: sp.Expr
    proof: Proof


@cache
def bounds() -> Bounds:
    """All of them by the numbers of the course without viscosity."""
    polar()
    radial, turning, force = spiral()
    least, most = (turning.subs(phi, angle * sp.pi / 4) for angle in (3, 1))
    till_turned = -sp.integrate(radial, (phi, 0, sp.pi / 2))
    whole = -sp.integrate(radial, (phi, 0, sp.pi)) / least
    amplitude = sp.sqrt(sp.trigsimp(sp.expand(force**2 + sp.diff(force, phi) ** 2)))
    end = _end()
    gone = energy * (1 - (sp.exp(-whole) / amplitude) ** 2)
    return Bounds(
        rise * whole - sp.log(least),
        fall * whole + sp.log(most) - sp.log(1 - end),
        depth * till_turned,
        radius * till_turned,
        sp.log(amplitude),
        (1 + rise) * till_turned,
        gone,
        -sp.log(1 - gone) / 2,
        sp.log(1 + (energy - 1) * 2 * end) / 2,
        end,
        _proof(till_turned, whole, least, most, amplitude),
    )


def _end() -> sp.Expr:
    """n_z A_v over 2 delta_m/v0: at the turning point epsilon is A_v d log P_e/d log z v0/delta_m.

    The way z left there, n_z A_v v0 at most, is twice as much of delta_m.
    """
    A, power, deepest, speed = sp.symbols("A power deepest speed", positive=True)
    (time,) = sp.solve(A * power * speed / deepest - epsilon, A)
    return steepness * power * time / (2 * deepest / speed)


def _proof(
    till_turned: sp.Expr, whole: sp.Expr, least: sp.Expr, most: sp.Expr, amplitude: sp.Expr
) -> Proof:
    """The rates lie between those that are integrated: what differs has a known sign."""
    radial, turning, force = spiral()
    sine, cosine = sp.sin(phi), sp.cos(phi)
    per_angle = radial / turning
    return prove(
        "Bounds of the viscous spiral",
        r"What $\phi'/\Omega$ has over its least and lacks of its largest value are squares; over "
        "the first quarter it is 1 at least. The square of the force and that of its slope by "
        r"$\phi$ add up to that of its amplitude.",
        {
            "least": turning - least - epsilon * (sine + cosine) ** 2 / 2,
            "most": most - turning - epsilon * (sine - cosine) ** 2 / 2,
            "quarter": per_angle - radial - epsilon**2 * cosine**3 * sine / turning,
            "half": per_angle - radial / least
            - epsilon**2 * cosine**2 * (sine + cosine) ** 2 / 2 / (turning * least),
            "largest force": amplitude**2 - force**2 - (cosine - epsilon * sine) ** 2,
            "at the turning point": till_turned - sp.pi / 4 * epsilon,
            "Lambda": whole - sp.pi / 2 * epsilon / (1 - epsilon / 2),
        },
    )  # fmt: skip


def viscosity() -> tuple[Formula, ...]:
    """The formulas of the link; the bounds are proved with them."""
    bounds()
    return viscous_number(), weak_restitution()
