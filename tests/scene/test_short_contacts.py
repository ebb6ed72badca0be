"""Contacts that are too short for all wave branches of a wide plate: an infinite one has them."""

import platecontact as pc
import pytest

BEAD = pc.Sphere(radius=5e-5, material="alumina")
BLAST = pc.Impact(speed=50.0)
ENDLESS = pc.Inertia(extent="infinite")


def blasted(radius: float = 0.05, inertia: pc.Inertia | None = None) -> pc.Scene:
    plate = pc.Plate(radius=radius, thickness=0.004, material="glass")
    return pc.Scene(sphere=BEAD, plate=plate, impact=BLAST, inertia=inertia)


def test_infinite_plate_includes_the_branches_that_a_wide_one_omits() -> None:
    wide, endless, narrow = map(pc.simulate, (blasted(), blasted(inertia=ENDLESS), blasted(0.005)))
    assert wide.accuracy.bound > 0.1
    assert any('set extent = "infinite" in [inertia]' in text for text in wide.warnings)
    for other in endless, narrow:  # no wave returns from either edge
        assert other.accuracy.bound < 0.02
        assert not any("branches" in text for text in other.warnings)
        assert abs(wide.restitution / other.restitution - 1.0) < wide.accuracy.bound
    bounds = endless.accuracy.bound + narrow.accuracy.bound
    assert abs(endless.restitution / narrow.restitution - 1.0) < bounds


def test_waves_across_the_thickness_of_an_infinite_plate_are_not_called_neglected() -> None:
    """An earlier warning stated that the thickness responds without delay."""
    result = pc.simulate(blasted(inertia=ENDLESS))
    assert result.dynamics is not None
    assert result.dynamics.law.model.inertia.branches == "all"
    assert not any("without delay" in text for text in result.warnings)
    assert any("without delay" in text for text in pc.simulate(blasted()).warnings)


def test_rejected_tolerance_names_an_infinite_plate_that_meets_it() -> None:
    with pytest.raises(pc.SceneError, match='or set extent = "infinite" in'):
        pc.simulate(blasted(), rtol=0.03)
    assert pc.simulate(blasted(inertia=ENDLESS), rtol=0.03).accuracy.bound <= 0.03


def test_too_few_modes_are_named_as_the_reason_for_no_bound() -> None:
    """With the number in the message there is a bound; with fewer there is none."""

    def pane(modes: int) -> pc.Result:
        plate = pc.Plate(radius=0.3, thickness=0.008, material="glass", edge="simply-supported")
        sphere = pc.Sphere(radius=0.01, material="steel")
        chosen = pc.Inertia(modes=modes)
        return pc.simulate(
            pc.Scene(sphere=sphere, plate=plate, impact=pc.Impact(speed=2.0), inertia=chosen)
        )

    text = " ".join(str(pane(3)).split())
    assert "because the 3 modes of inertia.modes are slower than the contact" in text
    enough = int(text.split("needs about ")[1].split(")")[0])
    assert pane(enough).accuracy.bound < 0.1
    assert "no error bound" in str(pane(enough // 3))
