"""The largest tensile stress of the plate: on its far face, below the sphere.

There the modes of the contact law die like e^(-2 phi h), so that a few b/h of them are enough;
the edge's polynomial states add the stress of their bending and stretching.
"""

import math

import numpy as np

from derivation.scene.law import Law

DECAYED = 40.0
"""2 phi h beyond which modes are nothing beside the first ones."""


def far_face_stress(law: Law, a: float) -> float:
    """Radial stress in the middle of the far face at a contact radius [m], tension positive [Pa].

    The pressure is taken as Hertz's of the same force; on the far face its distribution is next
    to no matter.
    """
    from generated.modal_sum import sigma_rr

    model = law.model
    radius = np.array([a])
    force = float(law.force(radius, law.at(radius))[0])
    modes = math.ceil(DECAYED / (2.0 * math.pi * model.eta)) + 10
    # The sum's own force is that of a rigid paraboloid on this plate, at the same radius.
    wide = 4.0 * a
    own = 4.0 / 3.0 * model.modulus * (a * a * (a / wide))
    stress = sigma_rr(0.0, -model.h, model.h, model.b, wide, a, model.lam, model.mu, modes=modes)
    return float(stress) * (force / own)
