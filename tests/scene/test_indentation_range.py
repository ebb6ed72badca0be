"""Static contacts near the end of the law: a contact is found again from each of its quantities."""

import re
from typing import Any

import pytest

from derivation.scene import SceneError, read
from derivation.scene.indentation import indent

STIFF_EDGE: dict[str, Any] = {
    "sphere": {"radius": 0.02, "material": "steel"},
    "plate": {"radius": 0.0053, "thickness": 0.0018, "material": "glass", "edge": "clamped"},
    "impact": {"speed": 1.0},
    "effects": {"spherical_profile": False},
}
"""The indentation of this law is negative at its limit, a contact radius of 0.9 b."""
THICK: dict[str, Any] = {
    "sphere": {"radius": 0.1, "material": "PMMA"},
    "plate": {"radius": 0.1, "thickness": 0.08, "material": "glass", "edge": "simply-supported"},
    "impact": {"speed": 1.0},
}
"""The indentation of this law is NaN at its limit."""


@pytest.mark.parametrize("tables", [STIFF_EDGE, THICK], ids=["negative", "nan"])
@pytest.mark.parametrize("a_over_b", [1e-3, 1e-2, 0.1])
def test_contacts_are_found_where_the_law_ends_early(
    tables: dict[str, Any], a_over_b: float
) -> None:
    scene = read(tables)
    [contact] = indent(scene, contact_radius=a_over_b * scene.plate.radius)
    for name in ("force", "indentation"):
        [again] = indent(scene, **{name: getattr(contact, name)})
        assert again.contact_radius == pytest.approx(contact.contact_radius, rel=1e-12)


@pytest.mark.parametrize("tables", [STIFF_EDGE, THICK], ids=["negative", "nan"])
def test_indentation_beyond_the_law_is_rejected_with_the_largest_one(
    tables: dict[str, Any],
) -> None:
    scene = read(tables)
    with pytest.raises(SceneError) as caught:
        indent(scene, indentation=1.0)
    search_result = re.search(r"expected less than (\S+) m", str(caught.value))
    assert search_result
    [contact] = indent(scene, indentation=0.999 * float(search_result[1]))
    assert 0.0 < contact.contact_radius < scene.plate.radius
