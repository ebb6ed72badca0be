"""Tables of a contact with dynamic modes, compared with the law that they represent."""

import numpy as np
import pytest

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.contact_tables import contact_of
from derivation.scene.dynamic.modal import ModalPlate, Modes
from derivation.scene.effects import WHOLE_PLATE
from derivation.scene.model import Model

NONE = np.zeros(0)
STILL = Modes(NONE, NONE, NONE, np.zeros(0, dtype=np.intp), np.zeros(0, dtype=bool))


@pytest.mark.parametrize("reach", [0.5, 0.9, 0.99])
def test_tables_resolve_the_steep_side_of_a_sphere(reach: float) -> None:
    """Force and indentation agree with Sneddon; a degree of 32 has errors of 9e-5 at 0.99 R."""
    R, lam, mu = 0.27, 2.8e6, 1.9e6
    model = Model(R=R, m=1.0, v0=1.0, h=0.5, b=1.4, lam=lam, mu=mu)
    law = ContactLaw(model, frozenset({"hertz", "spherical_profile"}))
    tables = contact_of(law, ModalPlate(STILL, STILL, None), reach * R, False)
    a = reach * R * np.linspace(0.05, 1.0, 50)
    actual, logarithm = tables.at(a), np.log((R + a) / (R - a))
    depth = a / 2.0 * logarithm
    force = model.modulus * ((a * a + R * R) / 2.0 * logarithm - a * R)
    assert np.max(np.abs(actual.depth / depth - 1.0)) < 1e-12
    assert np.max(np.abs(actual.force / force - 1.0)) < 1e-11  # the formula cancels at small radii


def test_tables_resolve_a_wide_contact_on_a_thin_plate() -> None:
    """A degree of 32 has errors of 5e-6 in force and indentation for a radius of 5.1 h."""
    h, lam, mu = 0.0012, -1.5e8, 2.7e8
    model = Model(R=0.114, m=12.0, v0=0.18, h=h, b=0.7, lam=lam, mu=mu)
    law = ContactLaw(model, frozenset({"hertz", "non_hertzian_pressure"} | WHOLE_PLATE))
    tables = contact_of(law, ModalPlate(STILL, STILL, None), 5.1 * h, False)
    a = 5.1 * h * np.linspace(0.05, 1.0, 50)
    actual, shape = tables.at(a), law.at(a)
    assert np.max(np.abs(actual.depth / law.indentation(a, shape) - 1.0)) < 1e-12
    assert np.max(np.abs(actual.force / law.force(a, shape) - 1.0)) < 1e-12
