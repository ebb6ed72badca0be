"""Error of impacts on a plate whose curvature under the sphere is not that under a static load.

The contact law is that of a static plate. At the beginning of an impact, or if the plate stretches,
it is flatter under the sphere. With a relative change e of the force at a given contact radius, the
modes of the plate change the indentation at a given force in proportion to e, with the weights of a
narrow contact. The time elements neglect the rest of the change. It follows from `flatter_plate`.

In four impacts of light spheres on linear plates of finite elements, with contact radii of 0.4 to
0.7 thicknesses and e of 0.2 to 0.7, the largest force was smaller by 0.3 to 0.5 of its error.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

from derivation.scene import kernels
from derivation.scene.contact_law.flatter_plate import Flattening, flatter_plate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.time_element import A, C, P
from derivation.scene.scene import OUTPUTS

if TYPE_CHECKING:
    from derivation.scene.dynamic.wave_motion import DynamicImpact

HERTZ_TIME_POWER, RADIUS_POWER = 0.4, 1.0 / 3.0
"""Powers of the stiffness of a contact in its duration, and of the force in the contact radius, by
Hertz's law."""
SMALL = 1e-3
"""Change of the contact radius at a given force below which the error is neglected [1]."""
MIDDLES = (np.arange(16) + 0.5) / 16
"""Times in a contact over its duration, for a mean value."""
HALVINGS = 6
"""Number of halvings of a change of curvature for which the law has no solution."""


def flat_contact_errors(motion: "DynamicImpact") -> dict[str, float]:
    """Return the relative error of each result by the curvature under the sphere [1].

    If sphere and plate did not give way, the force would change by the neglected indentation times
    the stiffness of the contact. The plate gives way, so that it changes less.
    """
    law, model = motion.law, motion.law.model
    if not law.solved or not abs(motion.inertia.curvature) > SMALL:
        return dict.fromkeys(OUTPUTS, 0.0)
    depths, forces, changes = [], [], []
    problem = motion.impact_history.problem
    for one, rows in zip(motion.impact_history.contacts, motion.histories, strict=True):
        part = float(np.argmax(rows[P])) / (rows.shape[1] - 1)
        time = problem.T * (one.start + part * (one.end - one.start))
        a, force, radius = (float(x) for x in motion.rows(np.array([time]))[[A, P, C], 0])
        depth = neglected_depth(law, a, radius)
        depths.append(depth)
        forces.append(force)
        changes.append(_stiffness(law, radius) * depth / force)
    higher = max(p * (1.0 + x) for p, x in zip(forces, changes, strict=True))
    work = sum(p * x for p, x in zip(forces, depths, strict=True)) / (model.m * model.v0**2)
    rebound = abs(motion.restitution) if motion.inertia.complete else 1.0  # else unknown
    return {
        "contact_time": HERTZ_TIME_POWER * _mean_change(motion),
        "max_indentation": max(depths) / motion.max_indentation,
        "max_force": higher / max(forces) - 1.0,
        "max_contact_radius": RADIUS_POWER * max(changes),
        "restitution": work / max(rebound, 1e-6) ** 2,
    }


def _mean_change(motion: "DynamicImpact") -> float:
    """Return the relative change of the force in the first contact, weighted with the force [1]."""
    first, problem, law = (
        motion.impact_history.contacts[0],
        motion.impact_history.problem,
        motion.law,
    )
    times = problem.T * (first.start + (first.end - first.start) * MIDDLES)
    a, force, radius = motion.rows(times)[[A, P, C]]
    added = [
        _stiffness(law, pair[1]) * neglected_depth(law, *pair) if pair[0] > 0.0 else 0.0
        for pair in zip(a.tolist(), radius.tolist(), strict=True)
    ]
    return float(sum(added) / np.sum(force))


def _stiffness(law: ContactLaw, radius: float) -> float:
    """Return the stiffness of the contact at a radius [m], without the plate [N/m]."""
    return float(kernels.hertz_stiffness(np.array(radius), np.array(law.modulus)))


def neglected_depth(law: ContactLaw, a: float, radius: float) -> float:
    """Return the change of the indentation that the modes of the plate do not contain [m].

    Parameters
    ----------
    a, radius
        Contact radius of the static law at a force, and contact radius at this force [m].
    """
    radii = np.array([a, radius])
    of_law, flatter = law.force(radii, law.at(radii))
    change = abs(float(of_law / flatter) - 1.0)
    for halvings in range(HALVINGS):
        found = flatter_plate(law, a, Flattening(0.5**halvings * change, 0.0, a, 0.0)).depth
        if math.isfinite(found):
            return abs(found) * 4.0**halvings
    return math.inf
