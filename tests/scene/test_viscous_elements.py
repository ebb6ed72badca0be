"""Time elements of viscoelastic contacts on a plate with inertia."""

from typing import Any

import pytest

from derivation.scene import explain, read
from derivation.scene.dynamic.contact_sequence import ImpactHistory, impact_history
from derivation.scene.dynamic.integration_error import integration_error
from derivation.scene.dynamic.mode_count import branching
from derivation.scene.dynamic.wave_problem import problem_of

THIN: dict[str, Any] = {
    "sphere": {"radius": 0.00233, "density": 7940.0},
    "plate": {
        "radius": 0.02304, "thickness": 0.000337, "youngs_modulus": 95.26e9,
        "poissons_ratio": 0.034, "density": 1531.5, "edge": "simply-supported",
        "retardation_time": 1.5115e-5,
    },
    "impact": {"speed": 4.276},
    "effects": {"inertia": True, "stretching": False},
}  # fmt: skip
"""A plate that vibrates quickly: with more modes there are more contacts, with short elements."""
ONCE: dict[str, Any] = {
    "sphere": {"radius": 0.007822260676250414, "density": 3559.197100601941},
    "plate": {
        "radius": 0.5622289801546556, "thickness": 0.004661295474908538,
        "youngs_modulus": 6701614056.584227, "poissons_ratio": 0.17551907588250187,
        "density": 1845.649426524593, "edge": "simply-supported",
        "retardation_time": 6.618615569181688e-05,
    },
    "impact": {"speed": 0.7480038021791007},
    "effects": {"inertia": True, "stretching": True},
}  # fmt: skip
"""A single contact, whose force falls slowly."""


def history(data: dict[str, Any], modes: int, nodes: int, tolerance: float) -> ImpactHistory:
    """Return an impact with a number of modes of the lowest branch."""
    law = branching(explain(read(data)).effects.law, "A0")
    return impact_history(problem_of(law, modes, tolerance), nodes, tolerance)


@pytest.mark.parametrize("modes", [3, 5, 8, 13])
def test_short_elements_do_not_amplify_rounding_errors(modes: int) -> None:
    """An earlier version corrected errors of the indentation at once, by the larger forces the
    shorter an element was, so that no element was accurate enough.
    """
    found, other = history(THIN, modes, 24, 1e-11), history(THIN, modes, 32, 1e-10)
    assert found.complete
    assert len(found.contacts) == len(other.contacts)
    bound = integration_error(found) + integration_error(other)
    for one, same in zip(found.contacts, other.contacts, strict=True):
        assert one.end == pytest.approx(same.end, rel=bound)
        assert one.after.velocity == pytest.approx(same.after.velocity, abs=bound)


@pytest.mark.parametrize(("nodes", "tolerance"), [(24, 1e-8), (30, 1e-8), (24, 1e-9), (30, 1e-10)])
def test_contact_time_is_as_accurate_as_stated(nodes: int, tolerance: float) -> None:
    """An earlier version was wrong by three times the bound with 24 nodes."""
    found, accurate = history(ONCE, 75, nodes, tolerance), history(ONCE, 75, 40, 1e-11)
    [one], [same] = found.contacts, accurate.contacts
    assert one.end == pytest.approx(same.end, rel=integration_error(found))
