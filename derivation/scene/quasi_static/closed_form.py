"""Impacts in closed form: by Hertz's law, and on a plate that only bends."""

import numpy as np

from derivation.scene import kernels
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.quasi_static import simple_laws
from generated.arrays import Double as Array


def closed_form(law: ContactLaw) -> kernels.Estimate | None:
    """Return the impact by a law with a closed form; None for other laws and extreme values."""
    if law.viscous or law.plastic or law.gravity:
        return None
    R, m, v0, h, b, lam, mu = law.model.numbers
    ratio = 1.0 / (1.0 + law.softness)
    numbers = R, m, v0, h, b, ratio * lam, ratio * mu
    if law.hertzian:
        return simple_laws.single(simple_laws.hertz, *numbers)
    if only_bends(law):
        return simple_laws.single(simple_laws.bent, *numbers, float(bend_of(law)[0]))
    return None


def only_bends(law: ContactLaw) -> bool:
    """Return whether the elastic contact has the form of Hertz's law on a plate that bends."""
    return law.bends and all(effect.hertzian or effect.bends for effect in law.chosen)


def bend_of(law: ContactLaw) -> Array:
    """Return the bending deflection over Hertz's indentation at a contact radius h [1]."""
    return law.deflection(np.atleast_1d(law.model.h)).depth / (1.0 + law.softness)
