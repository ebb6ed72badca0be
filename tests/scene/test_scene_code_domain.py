"""The domain of the generated code of a scene: its largest and its smallest indentation."""

from typing import Any

import numpy as np

from derivation.scene import indent, read
from derivation.scene_code import scene_code

SLENDER: dict[str, Any] = {
    "sphere": {"radius": 8e-3, "density": 9139.0},
    "plate": {
        "radius": 6.4e-3, "thickness": 5.15e-3, "youngs_modulus": 4e6, "poissons_ratio": -0.416,
    },
    "impact": {"speed": 5.9e-3},
    "effects": {"inertia": False, "spherical_profile": False, "bending": False},
}  # fmt: skip
"""Without bending, the indentation decreases with the radius of wide contacts."""


def test_code_ends_where_the_indentation_no_longer_grows() -> None:
    """An earlier version used the whole law, whose inverse is not unique, and rejected its code."""
    names: dict[str, Any] = {}
    exec(scene_code(read(SLENDER)), names)
    end = names["MAX_INDENTATION"]
    delta = end * np.linspace(0.01, 1.0, 50)
    effects = {"non_hertzian_pressure": False} | SLENDER["effects"]
    static = indent(read(SLENDER | {"effects": effects}), indentation=delta.tolist())
    np.testing.assert_allclose(names["force"](delta), [x.force for x in static], rtol=1e-9)
    assert np.isnan(names["force"](1.01 * end))


def test_smallest_indentation_gives_no_warning(recwarn: Any) -> None:
    """An earlier version gave a contact radius of 0 there, after a division by zero."""
    names: dict[str, Any] = {}
    exec(scene_code(read(SLENDER)), names)
    smallest = np.array([5e-324, 1e-310])
    hertz = np.sqrt(SLENDER["sphere"]["radius"]) * np.sqrt(smallest)
    np.testing.assert_allclose(names["contact_radius"](smallest), hertz, rtol=1e-12)
    assert not recwarn.list
